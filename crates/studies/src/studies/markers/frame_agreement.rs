//! Whether the parameters that are found in the frames of a series, each alone, can be those of one material.
//!
//! ```text
//! χ² = Σ (pᵢ − p̄)²/sᵢ²,   p̄ = Σ pᵢ/sᵢ² / Σ 1/sᵢ²          with one degree of freedom fewer than frames
//! ```
//!
//! What all frames have in common, such as the scale of the pictures, moves all pᵢ alike, and makes χ² smaller: the test is careful.

use crate::error::Diagnostic;
use crate::estimation::{FieldEstimate, FoundParameter};
use crate::statistics::{Estimate, chi_squared_tail, cochran, extremes, small_probability};
use crate::units::number;

/// The probability by noise below which parameters of frames exclude one another.
const LEVEL: f64 = 1e-3;

/// A doubt for every parameter whose values in the frames exclude one another.
pub fn doubts(estimates: &[FieldEstimate]) -> Vec<Diagnostic> {
    let explained = || estimates.iter().filter(|own| own.is_explained());
    let Some(first) = explained().next() else {
        return Vec::new();
    };
    let doubt = |(index, (key, unit, _)): (usize, &FoundParameter)| {
        let found = explained().filter_map(|own| own.parameters.get(index));
        let found: Vec<&Estimate> = found
            .filter(|own| own.0 == *key)
            .map(|own| &own.2)
            .collect();
        let probability = agreement(&found).filter(|own| *own < LEVEL)?;
        let [low, high] = extremes(found.iter().map(|own| own.value));
        let message = format!(
            "the frames exclude one another: {key} is {} to {} {unit}, which noise alone would give with probability {}",
            number(low),
            number(high),
            small_probability(probability)
        );
        Some(Diagnostic::warning("", message).hint(
            "check that forces and frames belong together (times, numbers), the zero of the force and a preload in the reference picture; \
             else the law does not hold at all of these strains. --together fits all frames at once",
        ))
    };
    first
        .parameters
        .iter()
        .enumerate()
        .filter_map(doubt)
        .collect()
}

/// The probability by noise of such differences; `None` for fewer than two values.
fn agreement(found: &[&Estimate]) -> Option<f64> {
    let known = found.iter().filter(|own| own.standard_error > 0.0);
    let known: Vec<[f64; 2]> = known
        .map(|own| [own.value, own.standard_error.powi(2)])
        .collect();
    (known.len() > 1).then(|| chi_squared_tail((known.len() - 1) as f64, cochran(&known)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_agree_as_far_as_their_errors_reach() {
        let of = |values: [f64; 3], error: f64| {
            let found = values.map(|value| Estimate::new(value, error, 1.96));
            agreement(&found.iter().collect::<Vec<_>>()).unwrap()
        };
        // χ² = 2 with two degrees of freedom: e^(−1).
        assert!((of([1.0, 2.0, 3.0], 1.0) - (-1.0_f64).exp()).abs() < 1e-12);
        assert!(of([1.0, 2.0, 3.0], 0.1) < 1e-20);
        assert_eq!(agreement(&[&Estimate::new(1.0, 0.1, 1.96)]), None);
    }
}
