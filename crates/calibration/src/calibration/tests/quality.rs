//! Figures of a fit compared with their definitions.

use std::path::Path;

use nalgebra::{DMatrix, DVector};

use super::helpers::{bounded, fit_with, fitted, uniaxial, weighted};
use crate::assertions::assert_contains;
use crate::calibration::*;
use crate::document::Statements;
use crate::material::curve::Mode;
use crate::statistics::{Curve, CurveResiduals};

fn tests(points: &[(f64, f64)]) -> [TestData; 1] {
    let rows: String = points.iter().map(|(l, s)| format!("{l},{s}\n")).collect();
    [uniaxial(&rows)]
}

/// 2 (λ − λ⁻²), which the neo-Hookean C₁₀ is multiplied by.
fn slope(stretch: f64) -> f64 {
    2.0 * (stretch - stretch.powi(-2))
}

/// AICc after Hurvich and Tsai, Biometrika 76, 297 (1989), with the variance as a parameter.
#[test]
fn the_figures_of_a_fit_are_as_defined() {
    // The last two stresses are below a hundredth, and above one but below a tenth, of the largest.
    let points = [
        (1.2, 0.05),
        (1.6, 0.13),
        (2.0, 0.16),
        (1.001, 0.0012),
        (1.01, 0.004),
    ];
    for weighting in [Weighting::Absolute, Weighting::Relative] {
        let data = tests(&points);
        let actual = fit_with("neo-hooke", &data, &weighted(weighting)).unwrap();
        let c10 = actual.parameters[0].value;
        let off: Vec<f64> = points.iter().map(|(l, s)| s - c10 * slope(*l)).collect();
        let squares: f64 = off.iter().map(|d| d * d).sum();
        let mean = points.iter().map(|(_, s)| s).sum::<f64>() / 5.0;
        let spread: f64 = points.iter().map(|(_, s)| (s - mean).powi(2)).sum();
        let counted = off.iter().zip(&points).filter(|(_, (_, s))| *s > 0.0016);
        let largest = counted.map(|(d, (_, s))| (d / s).abs()).fold(0.0, f64::max);
        let quality = &actual.quality;
        // n = 5 points, k = 2: −2 ln L + 2k + 2k(k + 1)/(n − k − 1) = −2 ln L + 10.
        let weights = points.map(|(_, s): (f64, f64)| match weighting {
            Weighting::Absolute => 1.0,
            Weighting::Relative => s.max(0.0016).recip(),
        });
        let deviance = quality.noise.as_ref().unwrap().deviance();
        let aicc = deviance - 2.0 * weights.iter().map(|w| w.ln()).sum::<f64>() + 10.0;
        let is_measured = weighting == Weighting::Absolute;
        for (what, actual, expected) in [
            ("S", quality.sum_of_squares, squares),
            ("rmse", quality.rmse, (squares / 5.0).sqrt()),
            ("R²", quality.r_squared, 1.0 - squares / spread),
            // Relative weights are those of the fitted stresses.
            (
                "AICc",
                quality.aicc,
                if is_measured { aicc } else { quality.aicc },
            ),
            (
                "largest",
                quality.largest_relative_error_percent,
                100.0 * largest,
            ),
        ] {
            assert!(
                (actual / expected - 1.0).abs() < 1e-9,
                "{what}: {actual} {expected}"
            );
        }
    }
    // Three points, k = 2: n − k − 1 is zero, and nothing can be said.
    let few = fitted("neo-hooke", &tests(&points[..2]));
    assert_eq!(few.quality.aicc, f64::INFINITY);
}

/// σ = C₁₀ f + C₀₁ f/λ is linear: two columns give the uncertainty of both parameters by the noise along the curve.
#[test]
fn two_parameters_have_the_uncertainty_of_linear_regression() {
    for sign in [1.0, -1.0] {
        let wiggle = |i: i32| sign * 2e-3 * (1.7 * f64::from(i)).sin();
        let row = |i: i32| {
            let stretch = 1.0 + 0.1 * f64::from(i);
            (stretch, 0.05 * slope(stretch) + wiggle(i))
        };
        let points: Vec<_> = (1..=12).map(row).collect();
        let data = tests(&points);
        let actual = fitted("mooney-rivlin", &data);
        let [c10, c01] = [0, 1].map(|index| actual.parameters[index].value);
        let design = DMatrix::from_fn(12, 2, |i, j| {
            let (stretch, _) = points[i];
            -slope(stretch) / [1.0, stretch][j]
        });
        let residual =
            |i: usize, _| points[i].1 + (design.row(i) * DVector::from_vec(vec![c10, c01]))[0];
        let residuals = CurveResiduals {
            design: &design,
            residual: &DVector::from_fn(12, residual),
            orders: &[vec![Curve::even((0..12).collect())]],
            sizes: &DVector::from_element(12, 1.0),
        };
        let expected = residuals.noise().unwrap();
        for (i, estimate) in actual.quality.estimates.iter().enumerate() {
            let unit = DVector::from_fn(2, |j, _| f64::from(u8::from(i == j)));
            let half = (estimate.interval[1] - estimate.interval[0]) / 2.0;
            assert!((half / expected.half_width(&unit) - 1.0).abs() < 1e-5);
            // The standard error is that of the interval, not of the mean covariance, in which improbable noises count most.
            assert!((estimate.standard_error * expected.reach() / half - 1.0).abs() < 1e-12);
        }
        let correlation = actual.quality.correlation[(0, 1)];
        // C₀₁, whose true value is zero, has either sign and is not known to have it.
        assert!(!actual.quality.is_identifiable());
        let warnings = &actual.quality.warnings;
        let vague = warnings
            .iter()
            .find(|warning| warning.contains("not identifiable"));
        assert!(vague.unwrap().contains("c01"), "{warnings:?}");
        let close = warnings
            .iter()
            .any(|warning| warning.contains("hardly be distinguished"));
        assert_eq!(close, correlation.abs() >= 0.99, "{correlation}");
    }
}

#[test]
fn a_bound_nearby_does_not_hold_a_parameter() {
    let settings = bounded("c10", [0.0, 0.052]);
    let points = [
        (1.2, 0.05 * slope(1.2) + 1e-4),
        (1.6, 0.05 * slope(1.6)),
        (2.0, 0.05 * slope(2.0)),
    ];
    let actual = fit_with("neo-hooke", &tests(&points), &settings).unwrap();
    let estimate = actual.quality.estimates[0];
    assert!((actual.parameters[0].value - 0.05).abs() < 1e-3);
    assert!(!actual.quality.at_bound[0] && estimate.standard_error > 0.0);
}

#[test]
fn pressing_counts_in_uniaxial_tests_alone() {
    for (mode, stretches, enough) in [
        (Mode::Uniaxial, [0.9, 2.0], false),
        (Mode::Uniaxial, [0.7, 2.0], true),
        (Mode::Uniaxial, [0.7, 1.4], false),
        (Mode::Planar, [0.9, 2.0], true),
    ] {
        let range = StableRange {
            mode,
            stretches,
            needed: [0.8, 1.5],
        };
        assert_eq!(range.is_enough(), enough, "{mode:?} {stretches:?}");
    }
}

#[test]
fn stress_measures_are_not_mixed() {
    let read = |name: &str, measure: &str| {
        let text = format!(
            "# test: uniaxial\nstretch [-],{measure}_stress [MPa]\n1.1,0.1\n1.2,0.2\n1.3,0.3\n"
        );
        TestData::parse(name, &text, &Statements::new()).unwrap()
    };
    let tests = [read("a.csv", "nominal"), read("b.csv", "cauchy")];
    let refused = fit_with("neo-hooke", &tests, &FitSettings::default());
    let refused = refused.unwrap_err().to_string();
    assert_contains(
        &refused,
        "a.csv gives nominal stress and b.csv gives cauchy",
    );
}

/// Stresses that fall while the strain grows, as those of an unloading from whose peak forces were counted.
#[test]
fn a_law_that_does_not_follow_the_data_at_all_is_refused_with_what_was_read() {
    let points: Vec<(f64, f64)> = (1..=20)
        .map(|i| (1.0 + 0.05 * f64::from(i), 0.11 - 0.1 * f64::from(i)))
        .collect();
    let settings = FitSettings::default();
    let refused = fit_with("neo-hooke", &tests(&points), &settings).unwrap_err();
    let message = refused.to_string();
    assert_eq!(refused.exit_code(), 2);
    assert!(
        message.contains("does not follow the data at all") && message.contains("lines 3 to 22"),
        "{message}"
    );
    let (fits, reasons) = rank(&tests(&points), &settings);
    assert!(fits.iter().all(|fit| fit.quality.follows_data()));
    assert!(
        reasons
            .iter()
            .any(|reason| reason.contains("does not follow"))
    );
}

/// The protocols of the record are pulled at the ratios 1 : 1, 2 : 1 and 1 : 2.
#[test]
fn protocols_of_a_biaxial_test_support_the_tests_that_they_cover() {
    let reading = [("thickness".to_owned(), "0.8 mm".to_owned())].into();
    let path = Path::new("../../examples/biaxial_record.csv");
    let data = [TestData::read(path, &reading).unwrap()];
    let actual = fitted("neo-hooke", &data);
    assert_eq!(actual.quality.untested, [Mode::Uniaxial, Mode::Planar]);
    let warnings = &actual.quality.warnings;
    let expected = "uniaxial and planar stresses are predictions that no data support";
    assert!(
        warnings.iter().any(|warning| warning == expected),
        "{warnings:?}"
    );
}

#[test]
fn a_card_is_called_by_the_names_of_its_files() {
    let data = tests(&[(1.1, 0.03), (1.2, 0.05), (1.5, 0.1)]);
    let actual = fitted("neo-hooke", &data);
    let provenance = Provenance {
        files: vec!["../../export.csv".to_owned()],
        ..Provenance::default()
    };
    let card = card_text(&actual, &tests(&[(1.1, 0.03)]), &provenance);
    assert_contains(&card, "title = \"neo-hooke fitted to export.csv\"");
    assert_contains(&card, "data = [\"../../export.csv\"]");
}
