//! Relative residuals that are judged as noise: their weights are those of the fitted stresses.
//!
//! ```text
//! rᵢ = (σᵢ − σ(p; λᵢ))/σ(p₀; λᵢ),   p₀ = p at the end
//! ```
//!
//! Weights 1/σᵢ share the noise of the stresses that they weigh. A stress is of the first degree in the parameters that are
//! stresses, σ = Σ p ∂σ/∂p, so that (σᵢ − σ)/σᵢ = 1 − Σ p ∂(σ/σᵢ)/∂p: a constant and the derivatives take all of it, whatever the
//! noise, and no test tells noise from pattern. And what is measured too low weighs more: a noise of s makes stresses too
//! small by 2 s². Fitted stresses as weights have neither; where the residuals are noise, the fit is repeated with them until
//! it comes out as it went in (quasi-likelihood). A law that misses the data keeps the weights of the data for its values.
//!
//! # References
//! R. W. M. Wedderburn, Biometrika 61, 439 (1974), doi:10.1093/biomet/61.3.439

use crate::calibration::least_squares::{Measured, Precision, Residuals, minimise, sum_of_squares};

/// Residuals whose weights may be those of fitted stresses.
pub trait Reweighed: Residuals + Sized {
    /// The same with the weights of the stresses at some values; with all weights alike, the same.
    fn reweighed(&self, values: &[f64]) -> Self;

    /// Whether weights follow stresses at all.
    fn is_relative(&self) -> bool;

    /// What each residual is made of.
    fn measured(&self) -> Vec<Measured>;
}

/// The residuals by the weights of their own stresses, and the values, repeated within bounds where `is_noise`.
pub fn settled<M: Reweighed>(
    measured: &M,
    values: Vec<f64>,
    bounds: &[[f64; 2]],
    is_noise: impl Fn(&M, &[f64]) -> bool,
) -> (M, Vec<f64>) {
    let own = measured.reweighed(&values);
    if !measured.is_relative() || !is_noise(&own, &values) {
        return (own, values);
    }
    match repeated(measured, &values, bounds) {
        Some(found) => (measured.reweighed(&found), found),
        None => (own, values),
    }
}

/// The values that are the best ones by the weights of their own stresses; `None` where they do not come to rest.
fn repeated<M: Reweighed>(measured: &M, values: &[f64], bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
    const REPEATS: usize = 20;
    const SAME: f64 = 1e-8;
    let mut found = values.to_vec();
    let mut own = measured.reweighed(&found);
    for _ in 0..REPEATS {
        found = minimise(&own, &found, bounds, Precision::Full)?;
        let before = sum_of_squares(&own, &found);
        own = measured.reweighed(&found);
        let now = sum_of_squares(&own, &found);
        if (now - before).abs() <= SAME * now {
            return Some(found);
        }
    }
    None
}
