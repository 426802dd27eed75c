//! Fits whose minimum was missed, and laws that were chosen or judged by too few independent points.

use super::helpers::{TISSUE, fit_with, fitted, read, uniaxial, weighted};
use crate::calibration::least_squares::{Residuals, lower};
use crate::calibration::*;
use crate::statistics::normal_numbers;

/// The optimum of trust-region least squares from several random starts. A fit that once ended at 15.7 rad had a k₁ of 0.17314 MPa.
#[test]
fn fibres_in_tissue_are_found_within_one_period_and_at_the_optimum() {
    let result = fitted("holzapfel-gasser-ogden", &[read(TISSUE)]);
    let optimum = [0.068298, 0.174202, 58.5944, 0.307137, 0.0];
    for (parameter, optimum) in result.parameters.iter().zip(optimum) {
        let off = (parameter.value - optimum).abs();
        assert!(
            off <= 1e-5 * optimum,
            "{} {}",
            parameter.key,
            parameter.value
        );
    }
    let sum = result.quality.sum_of_squares;
    assert!((sum / 0.007_040_684_567_6 - 1.0).abs() < 1e-9, "{sum}");
    let message = result.quality.warnings.join("; ");
    assert!(!message.contains("not unique"), "{message}");
}

/// A valley, r = (a − 1, 30 (b − a²)): nothing there but (1, 1) is a minimum, however small the steps of a search are.
struct Valley;

impl Residuals for Valley {
    fn count(&self) -> usize {
        4
    }

    fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool {
        let [a, b] = [parameters[0], parameters[1]];
        residuals.copy_from_slice(&[a - 1.0, 30.0 * (b - a * a), 0.1, 0.1]);
        true
    }
}

#[test]
fn a_point_in_a_valley_is_no_minimum() {
    let free = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
    assert!(lower(&Valley, &[0.9, 0.81], &free).is_some());
    assert!(lower(&Valley, &[1.0, 1.0], &free).is_none());
    // At a bound beyond which the sum falls, and at one from which it falls inwards.
    assert!(lower(&Valley, &[0.5, 0.25], &[[0.0, 0.5], [0.0, 0.25]]).is_none());
    assert!(lower(&Valley, &[1.5, 2.25], &[[0.5, 1.5], free[1]]).is_some());
}

/// Terms of Ogden's law stand in the order of their exponents, also where weights are repeated.
#[test]
fn terms_of_a_sum_of_powers_are_in_order() {
    let data = super::data(&["treloar_1944_uniaxial"]);
    for weighting in [Weighting::Absolute, Weighting::Relative] {
        let result = fit_with("ogden-2", &data, &weighted(weighting)).unwrap();
        assert!(result.parameters[1].value > result.parameters[3].value);
    }
}

/// Gent's law runs through twelve points in a row below all of them. The points scatter most where the stress is large: noise that is
/// the same everywhere would hide that.
#[test]
fn a_smooth_trend_is_a_misfit_of_the_law_where_noise_is_smallest() {
    let result = fitted("gent", &super::data(&["treloar_1944_uniaxial"])).quality;
    let verdict = result.verdict.unwrap();
    assert_eq!(verdict.answer, Answer::Systematic, "{verdict:?}");
    assert!(verdict.suits_other_weights && !result.has_intervals());
}

/// Noise of neo-Hooke that is the same everywhere, by relative weights: large only where the stress is small.
#[test]
fn even_noise_by_relative_weights_is_no_pattern() {
    let settings = weighted(Weighting::Relative);
    let systematic = (0..60).filter(|seed| {
        let mut normal = normal_numbers(*seed);
        let rows = (1..=60).map(|row| {
            let stretch = 1.0 + f64::from(row) / 60.0;
            let stress = 0.1 * (stretch - stretch.powi(-2)) + 0.001 * normal();
            format!("{stretch},{stress}\n")
        });
        let rows: String = rows.collect();
        let result = fit_with("neo-hooke", &[uniaxial(&rows)], &settings).unwrap();
        result.quality.verdict.unwrap().answer == Answer::Systematic
    });
    let count = systematic.count();
    assert!(count <= 3, "{count} of 60");
}
