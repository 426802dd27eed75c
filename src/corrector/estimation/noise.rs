//! What noise that correlates, or is not what was stated, does to an estimate.
//!
//! ```text
//! Cov(p) = M⁻¹ (τ² ÃᵀRÃ + S) M⁻¹,   Ã = √(W/v) A                  M⁻¹ where the noise is white: R = 1, τ² = 1
//! ```
//!
//! The field stays the one nearest to the data; its covariance is that of this field under the noise that was found.

use nalgebra::{DMatrix, DVector};

use super::field_estimate::MarkerEstimate;
use super::judge::Judgement;
use super::marker_rows::MarkerRows;
use super::regression::Trade;
use super::search::NearestField;
use crate::statistics::{Sites, robust_deviation};

/// Noise farther from what was stated than this factor contradicts it, if it is by four standard errors too.
const OFF: f64 = 1.25;

impl NearestField<'_> {
    /// The scatter of the markers over their stated noise, from the median of the standardised residuals, where it is far from one.
    pub(super) fn contradicted_noise(&self, markers: &[Option<MarkerEstimate>]) -> Option<f64> {
        // The standard error of ln of a deviation from the median.
        const ERROR: f64 = 0.72;
        const SURE: f64 = 4.0;
        let lengths = markers.iter().flatten();
        let lengths: Vec<f64> = lengths.map(|marker| marker.standardised_residual).collect();
        if !self.observations().known_noise || lengths.is_empty() {
            return None;
        }
        let sure = SURE * ERROR / (lengths.len() as f64).sqrt();
        let ratio = self.trade.sound.sqrt() * robust_deviation(lengths);
        (ratio.ln().abs() > OFF.ln().max(sure)).then_some(ratio)
    }

    /// The noise's standard deviation of a marker of mean weight in mm, as if it were white.
    pub(super) fn deviation(&self) -> f64 {
        let weights = &self.observations().weights;
        (self.trade.sound * weights.len() as f64 / weights.iter().sum::<f64>()).sqrt()
    }

    /// The slope of what holds the parameters, which at the best fit is that of the data: −AᵀWr/v.
    pub(super) fn slope(
        &self,
        design: &DMatrix<f64>,
        residual: &DVector<f64>,
        trade: &Trade,
    ) -> DVector<f64> {
        let weights = &self.observations().weights;
        let weight = |row: usize| weights[row / 2] * trade.trust[row / 2] / trade.variance;
        let pull = DVector::from_fn(residual.len(), |row, _| -weight(row) * residual[row]);
        design.tr_mul(&pull)
    }

    /// Takes the covariance under the noise that was found, and with what smoothing takes away; the degrees of freedom of the noise's
    /// size where it correlates.
    pub(super) fn widen(&mut self, judged: &Judgement) -> Option<f64> {
        let smoothed_away = self.smoothed_away();
        let freedom = self.take_noise(judged);
        self.fit.covariance += smoothed_away;
        freedom
    }

    /// The covariance under the noise that was found; the degrees of freedom of its size where it correlates.
    fn take_noise(&mut self, judged: &Judgement) -> Option<f64> {
        const LEAST: f64 = 3.0;
        let noise = judged.noise?;
        let observations = self.observations();
        let sites = Sites::new(observations.places.clone());
        let rows = MarkerRows {
            design: &self.linear.design,
            weights: &observations.weights,
            trade: &self.trade,
        };
        let middle = rows.spread(&noise, &sites) + &self.fit.held;
        let independent = noise.correlation.independent(sites.places());
        self.fit.covariance = &self.fit.covariance * middle * &self.fit.covariance;
        Some((2.0 * independent - self.fit.effective).max(LEAST))
    }
}
