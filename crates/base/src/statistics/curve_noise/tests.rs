//! Coverage of intervals, and the formulas with full matrices.

use super::*;
use crate::statistics::normal_numbers;

/// Slopes of the neo-Hookean and the Mooney-Rivlin curve to λ = 2.
fn design(points: usize) -> DMatrix<f64> {
    DMatrix::from_fn(points, 2, |i, j| {
        let stretch = 1.0 + (i + 1) as f64 / points as f64;
        (stretch - stretch.powi(-2)) / [1.0, stretch][j]
    })
}

/// The residual of a fit to noise whose neighbours have a correlation, and the errors of its estimates.
fn residual_and_errors(design: &DMatrix<f64>, correlation: f64, seed: u64) -> [DVector<f64>; 2] {
    let mut normal = normal_numbers(seed);
    let mut last = normal();
    let noise = DVector::from_fn(design.nrows(), |_, _| {
        last = correlation * last + (1.0 - correlation * correlation).sqrt() * normal();
        last
    });
    let errors = (design.tr_mul(design)).cholesky().unwrap();
    let errors = errors.solve(&design.tr_mul(&noise));
    [noise - design * &errors, errors]
}

/// Noise of one size in all rows.
fn alike(rows: usize) -> DVector<f64> {
    DVector::from_element(rows, 1.0)
}

/// Of 100 seeds, intervals that take the noise as white hold both truths in 95, 75 and 30 %.
#[test]
fn intervals_hold_the_truth_however_the_noise_correlates() {
    let design = design(40);
    let orders = [vec![Curve::even((0..40).collect())]];
    for correlation in [0.0, 0.5, 0.9] {
        let mut held = 0;
        for seed in 0..100 {
            let [residual, errors] = residual_and_errors(&design, correlation, seed);
            let residuals = CurveResiduals {
                design: &design,
                residual: &residual,
                orders: &orders,
                sizes: &alike(residual.len()),
            };
            let noise = residuals.noise().unwrap();
            for i in 0..2 {
                let unit = DVector::from_fn(2, |j, _| f64::from(u8::from(i == j)));
                held += i32::from(errors[i].abs() <= noise.half_width(&unit));
            }
        }
        assert!((180..=198).contains(&held), "{correlation}: {held}");
    }
}

/// The formulas of this file's head with full matrices, for white noise and one correlation alone.
#[test]
fn one_noise_has_the_covariance_and_the_likelihood_of_full_matrices() {
    let design = design(12);
    let [residual, _] = residual_and_errors(&design, 0.5, 4);
    let orders = [vec![Curve::even((0..12).collect())]];
    let residuals = CurveResiduals {
        design: &design,
        residual: &residual,
        orders: &orders,
        sizes: &alike(residual.len()),
    };
    let actual = residuals.noise().unwrap();
    let projector = (design.tr_mul(&design)).try_inverse().unwrap() * design.transpose();
    let exact = |correlation: Correlation| {
        let r = DMatrix::from_fn(12, 12, |i, j| match i.abs_diff(j) {
            0 => 1.0,
            gap => correlation.at(gap as f64),
        });
        let inverse = r.clone().try_inverse().unwrap();
        let weighted = design.tr_mul(&(&inverse * &design));
        let taken = design.tr_mul(&(&inverse * &residual));
        let sum_of_squares = residual.dot(&(&inverse * &residual))
            - taken.dot(&weighted.clone().cholesky().unwrap().solve(&taken));
        let likelihood =
            (r.determinant() * weighted.determinant()).powf(-0.5) * sum_of_squares.powi(-5);
        (
            &projector * r * projector.transpose() * (sum_of_squares / 10.0),
            likelihood,
        )
    };
    let white = actual
        .parts
        .iter()
        .find(|part| part.correlation.share == 0.0);
    let white = white.unwrap();
    for part in &actual.parts {
        let (covariance, likelihood) = exact(part.correlation);
        let difference = (&part.covariance - &covariance).amax();
        assert!(difference < 1e-9 * covariance.amax(), "{part:?}");
        let prior = residuals.candidates();
        let prior = prior.iter().find(|one| one.correlation == part.correlation);
        let expected = prior.unwrap().weight / WHITE * likelihood / exact(white.correlation).1;
        assert!(
            (part.weight / white.weight / expected - 1.0).abs() < 1e-6,
            "{part:?}"
        );
    }
    assert!(actual.parts.len() > 5);
}

#[test]
fn a_smooth_pattern_is_told_from_noise_that_correlates() {
    let design = design(40);
    let orders = [vec![Curve::even((0..40).collect())]];
    let functions = DMatrix::from_fn(40, 6, |i, j| (i as f64 / 39.0 - 0.5).powi(j as i32));
    let probability = |residual: &DVector<f64>| {
        let residuals = CurveResiduals {
            design: &design,
            residual,
            orders: &orders,
            sizes: &alike(residual.len()),
        };
        residuals.pattern(&functions).unwrap()
    };
    for correlation in [0.0, 0.9] {
        let doubted = (0..40).filter(|seed| {
            let [residual, _] = residual_and_errors(&design, correlation, *seed);
            probability(&residual) < 0.01
        });
        assert!(doubted.count() <= 4, "{correlation}");
    }
    // Six times the noise.
    let [noise, _] = residual_and_errors(&design, 0.0, 1);
    let wave = DVector::from_fn(40, |i, _| 20.0 * (0.15 * i as f64).sin());
    assert!(probability(&(noise + wave)) < 1e-6);
}
