//! What is said of the residuals of curves whose noise is known.

use rayon::prelude::*;

use super::helpers::{fitted, law, uniaxial};
use crate::calibration::*;
use crate::statistics::normal_numbers;

const YEOH: [f64; 3] = [0.05, 0.02, 0.002];

/// A uniaxial test of Yeoh's law to λ = 2, a point for each value of noise in MPa, its stresses with `decimals` decimals.
fn curve(noise: &[f64], decimals: usize) -> [TestData; 1] {
    let law = law("yeoh", &YEOH);
    let count = noise.len() as f64;
    let row = |(index, noise): (usize, &f64)| {
        let x = (1 + index) as f64 / count;
        let stress = law.tension([1.0, 0.0], x).nominal_stress + noise;
        format!("{},{stress:.decimals$}\n", 1.0 + x)
    };
    let rows: String = noise.iter().enumerate().map(row).collect();
    [uniaxial(&rows)]
}

/// Noise of 0.005 MPa, about 1 % of the largest stress, whose neighbours have a correlation.
fn noise(count: usize, correlation: f64, seed: u64) -> Vec<f64> {
    let mut normal = normal_numbers(seed);
    let mut last = normal();
    let fresh = (1.0 - correlation * correlation).sqrt();
    let mut next = || {
        last = correlation * last + fresh * normal();
        0.005 * last
    };
    (0..count).map(|_| next()).collect()
}

fn answers(law: &str, correlation: f64) -> Vec<Answer> {
    let one = |seed| {
        let actual = fitted(law, &curve(&noise(60, correlation, seed), 17));
        actual.quality.verdict.unwrap().answer
    };
    (0..10).map(one).collect()
}

#[test]
fn white_noise_correlated_noise_and_a_wrong_law_are_told_apart() {
    let count = |answers: &[Answer], wanted| answers.iter().filter(|one| **one == wanted).count();
    assert!(count(&answers("yeoh", 0.0), Answer::White) >= 9);
    assert!(count(&answers("yeoh", 0.9), Answer::Correlated) >= 9);
    assert!(count(&answers("neo-hooke", 0.0), Answer::Systematic) >= 9);
    assert!(count(&answers("neo-hooke", 0.9), Answer::Systematic) >= 9);
}

#[test]
fn a_curve_without_noise_has_no_intervals() {
    for decimals in [3, 5, 17] {
        let tests = curve(&[0.0; 60], decimals);
        let actual = fitted("yeoh", &tests);
        let verdict = actual.quality.verdict.unwrap();
        assert_eq!(verdict.answer, Answer::Rounding, "{decimals}: {verdict:?}");
        assert!(actual.half_widths(&tests[0], &tests[0].observations)[0].is_nan());
        assert!(card_text(&actual, &tests, &Provenance::default()).contains("MPa\" # no interval"));
    }
    let coarse = fitted("yeoh", &curve(&noise(60, 0.0, 1), 3));
    assert!(coarse.quality.has_intervals());
}

/// The curve is linear in the parameters of Yeoh's law: its slope by them is a difference of curves.
#[test]
fn the_band_of_a_curve_is_that_of_its_combination_of_parameters() {
    let tests = curve(&noise(60, 0.5, 3), 17);
    let actual = fitted("neo-hooke", &curve(&noise(60, 0.5, 3), 17)[..]);
    assert!(actual.half_widths(&tests[0], &tests[0].observations)[0].is_nan());
    let actual = fitted("yeoh", &tests);
    let at = tests[0].observations[30];
    let stretch = 1.0 + at.strains[0];
    let slope = 2.0 * (stretch - stretch.powi(-2));
    let invariant = stretch * stretch + 2.0 / stretch - 3.0;
    let by = [1.0, 2.0 * invariant, 3.0 * invariant * invariant];
    let gradient = nalgebra::DVector::from_iterator(3, by.map(|factor| slope * factor));
    let noise = actual.quality.noise.as_ref().unwrap();
    let band = actual.half_widths(&tests[0], &[at])[0];
    assert!((band / noise.half_width(&gradient) - 1.0).abs() < 1e-5);
}

/// Forty times as many points: bins preserve the law, and the information of so many points.
#[test]
fn many_points_are_gathered_without_loss() {
    let [many, few] =
        [40_000, 1_000].map(|count| fitted("yeoh", &curve(&noise(count, 0.0, 5), 17)));
    for (index, truth) in YEOH.iter().enumerate() {
        let [a, b] = [&many, &few].map(|fit| fit.quality.estimates[index]);
        assert!((a.value - truth).abs() < 4.0 * a.standard_error, "{a:?}");
        let ratio = a.standard_error / b.standard_error * 40_f64.sqrt();
        assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    }
    assert!(many.quality.effective_points() > 0.95 * 40_000.0);
    // Within a bin noise correlates: its means scatter more than those of white noise.
    let correlated = fitted("yeoh", &curve(&noise(40_000, 0.9, 5), 17)).quality;
    let effective = correlated.effective_points();
    assert!(effective > 1_500.0 && effective < 6_000.0, "{effective}");
}

/// A file whose rows are in no order: neighbours in strain correlate, neighbours in the file do not.
#[test]
fn noise_that_correlates_along_the_strain_is_found_in_any_order_of_rows() {
    let actual = (0..5).filter(|seed| {
        let mut tests = curve(&noise(61, 0.9, *seed), 17);
        let sorted = tests[0].observations.clone();
        for (index, observation) in tests[0].observations.iter_mut().enumerate() {
            *observation = sorted[index * 23 % 61];
        }
        let verdict = fitted("yeoh", &tests).quality.verdict.unwrap();
        verdict.answer == Answer::Correlated && verdict.effective_points < 30.0
    });
    assert!(actual.count() >= 4);
}

/// The noise of a strain along a steady pull, in the order of time: its stress is the law's at another strain than the one that stands there.
#[test]
fn noise_of_the_strain_along_a_pull_is_white() {
    let white = (0..10).filter(|seed| {
        let jitter = noise(170, 0.0, *seed);
        let mut tests = curve(&[0.0; 170], 17);
        for (observation, jitter) in tests[0].observations.iter_mut().zip(jitter) {
            observation.strains[0] += jitter;
        }
        let quality = fitted("yeoh", &tests).quality;
        quality.verdict.unwrap().answer == Answer::White && quality.has_intervals()
    });
    let count = white.count();
    assert!(count >= 9, "{count} of 10");
}

/// Intervals of thousands of rows whose noise drifts over a tenth of the curve.
#[test]
fn intervals_of_many_rows_with_drifting_noise_hold_the_truth() {
    let held = (0..16).into_par_iter().filter(|seed| {
        let (count, length) = (3000, 300.0_f64);
        let tests = curve(&noise(count, (-length.recip()).exp(), *seed), 17);
        fitted("yeoh", &tests).quality.estimates[0].holds(YEOH[0])
    });
    let count = held.count();
    assert!(count >= 13, "{count} of 16");
}
