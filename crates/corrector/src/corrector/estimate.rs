//! The uncertainty of the corrected field and of its parameters.
//!
//! With data of equal but unknown precision, ū = u + noise of variance s²/w, the corrected field is the
//! maximum-likelihood estimate, and
//!
//! ```text
//! s² = ‖u − ū‖²_W / (m − q)                   m conditions, q unknowns without data
//! Cov(u) = s² Z (Zᵀ W Z)⁻¹ Zᵀ                 the columns of Z span what the conditions allow
//! ```
//!
//! to first order in the noise. The interval uses Student's distribution with m − q degrees of freedom.

use super::correction::Correction;
use super::system::Corrector;
use crate::error::SolveFault;
use crate::solve::vector::difference;
use crate::statistics::{Estimate, student_reach};

impl Corrector<'_> {
    /// The uncertainty of one unknown of a corrected field: an entry of the field, or a parameter.
    ///
    /// # Errors
    /// [`SolveFault::Singular`] when the conditions do not determine the unknown, or leave no degree of
    /// freedom to estimate the noise from.
    pub fn estimate(
        &self,
        data: &[f64],
        correction: &Correction,
        unknown: usize,
    ) -> Result<Estimate, SolveFault> {
        let parameters = self.weights.iter().filter(|weight| **weight == 0.0).count();
        let rows = correction.factor.jacobian().len();
        if rows <= parameters {
            return Err(SolveFault::Singular);
        }
        let freedom = (rows - parameters) as f64;
        let changes = difference(correction.field(), data)
            .into_iter()
            .zip(&self.weights);
        let variance = changes.map(|(d, weight)| weight * d * d).sum::<f64>() / freedom;
        let column = correction.factor.covariance_column(unknown)?;
        let standard_error = (variance * column[unknown].max(0.0)).sqrt();
        let value = correction.field()[unknown];
        Ok(Estimate::new(value, standard_error, student_reach(freedom)))
    }
}
