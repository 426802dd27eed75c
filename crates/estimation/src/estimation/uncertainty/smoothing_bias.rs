//! The local features that the smoothness chosen by the data may remove.
//!
//! ```text
//! dⱼ = (M − (1 − ε) λⱼ BⱼᵀBⱼ)⁻¹ (1 − ε) λⱼ Bⱼᵀρⱼ,   Cov(p) ← Cov(p) + Σ dⱼ dⱼᵀ
//! ```
//!
//! with M, λ, B, ρ of [`crate::estimation::regression`]: dⱼ is the change of the parameters if prior j lost the share
//! ε of its weight. M⁻¹ includes the bias of smoothing only on the average over an edge: where an edge bends in one place and is
//! straight elsewhere, its intervals are too narrow at the bend and too wide elsewhere. Less smoothing reveals such bends.
//!
//! # References
//! G. Wahba, J. R. Stat. Soc. B 45, 133 (1983), doi:10.1111/j.2517-6161.1983.tb01239.x (intervals across the function);
//! P. Hall, Ann. Stat. 20, 675 (1992), doi:10.1214/aos/1176348651 (less smoothing for intervals)

use nalgebra::{DMatrix, DVector};

use crate::estimation::regression::Form;
use crate::estimation::search::NearestField;

/// ε.
const EASED: f64 = 0.03;

impl NearestField<'_> {
    /// Σ dⱼ dⱼᵀ at the nearest field, whose covariance is M⁻¹.
    pub(in crate::estimation) fn smoothing_bias(&self) -> DMatrix<f64> {
        let size = self.parameters.len();
        let priors = self.equations.priors(&self.parameters);
        let eased = priors.iter().map(Form::new).zip(&self.variances.smoothing);
        let changes = eased.filter_map(|(form, weight)| self.eased(&form, (1.0 - EASED) * weight));
        changes.fold(DMatrix::zeros(size, size), |sum, change| {
            sum + &change * change.transpose()
        })
    }

    /// The change of the parameters if a prior loses a part of its weight.
    fn eased(&self, form: &Form, lost_weight: f64) -> Option<DVector<f64>> {
        let covariance = &self.fit.covariance;
        let pull = covariance * &form.slope * lost_weight;
        let square = covariance * &form.square * lost_weight;
        let size = self.parameters.len();
        (DMatrix::identity(size, size) - square).lu().solve(&pull)
    }
}
