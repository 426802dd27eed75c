//! What tests of fits have in common.

use std::path::Path;

use rayon::prelude::*;

use crate::calibration::{Answer, Fit, FitSettings, Quality, TestData, Weighting, fit};
use crate::document::Statements;
use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::material::registry::Law;

/// Protocols of a real tissue.
pub const TISSUE: &str = "../../validation/measured/tissue_biaxial/protocols.csv";

/// The test of a file.
pub fn read(path: &str) -> TestData {
    TestData::read(Path::new(path), &Statements::new()).unwrap()
}

/// The test of a table.
pub fn parsed(text: &str) -> TestData {
    TestData::parse("a.csv", text, &Statements::new()).unwrap()
}

/// A uniaxial test of rows of stretch and nominal stress in MPa.
pub fn uniaxial(rows: &str) -> TestData {
    let head = "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n";
    parsed(&format!("{head}{rows}"))
}

/// A law of the registry with some values.
pub fn law(name: &str, values: &[f64]) -> Box<dyn HyperelasticLaw> {
    let law = Law::named(name).unwrap();
    law.with_values(values, StressMeasure::Nominal, StrainMeasure::Nominal)
        .0
}

/// The nominal stress of a law in a uniaxial, planar or equibiaxial test.
pub fn stress(law: &dyn HyperelasticLaw, test: &str, x: f64) -> f64 {
    match test {
        "uniaxial" => law.tension([1.0, 0.0], x).nominal_stress,
        "planar" => law.biaxial([x, 0.0])[0],
        _ => law.biaxial([x, x])[0],
    }
}

pub fn weighted(weighting: Weighting) -> FitSettings {
    FitSettings {
        weighting,
        ..FitSettings::default()
    }
}

pub fn bounded(key: &str, bounds: [f64; 2]) -> FitSettings {
    FitSettings {
        bounds: vec![(key.to_owned(), bounds)],
        ..FitSettings::default()
    }
}

/// The fit of a law of the registry.
pub fn fit_with(law: &str, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    fit(Law::named(law).unwrap(), tests, settings)
}

/// The fit by the usual settings.
pub fn fitted(law: &str, tests: &[TestData]) -> Fit {
    fit_with(law, tests, &FitSettings::default()).unwrap()
}

/// Asserts that the parameters of a fit have some values, but for a relative deviation.
#[track_caller]
pub fn assert_parameters(fit: &Fit, expected: &[f64], tolerance: f64) {
    for (parameter, expected) in fit.parameters.iter().zip(expected) {
        let (key, value) = (parameter.key, parameter.value);
        let deviation = (value / expected - 1.0).abs();
        assert!(deviation < tolerance, "{key} = {value} is not {expected}");
    }
}

/// Counts over fits of laws with known values.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coverage {
    /// Fits with intervals.
    pub fits: usize,
    /// Fits whose residuals are called systematic.
    pub systematic: usize,
    /// Fits with intervals whose parameters are not identifiable.
    pub vague: usize,
    /// Intervals, and those that hold the true values.
    pub intervals: usize,
    pub held: usize,
    /// Parameters without an interval, of fits with intervals.
    pub unknown: usize,
}

impl Coverage {
    /// Over forty seeds.
    pub fn over_seeds(truth: &[f64], quality: impl Fn(u64) -> Quality + Sync) -> Self {
        const SEEDS: u64 = 40;
        let seeds = (0..SEEDS).into_par_iter();
        let each = seeds.map(|seed| Self::of(&quality(seed), truth));
        each.reduce(Self::default, Self::plus)
    }

    fn of(quality: &Quality, truth: &[f64]) -> Self {
        let answer = quality.verdict.map(|verdict| verdict.answer);
        let systematic = usize::from(answer == Some(Answer::Systematic));
        if !quality.has_intervals() {
            return Self {
                systematic,
                ..Self::default()
            };
        }
        let pairs = quality.estimates.iter().zip(truth);
        let known = pairs.filter(|(one, _)| one.standard_error.is_finite());
        let held = known.clone().filter(|(one, truth)| one.holds(**truth));
        Self {
            fits: 1,
            systematic,
            vague: usize::from(!quality.is_identifiable()),
            held: held.count(),
            intervals: known.clone().count(),
            unknown: truth.len() - known.count(),
        }
    }

    pub fn plus(self, other: Self) -> Self {
        Self {
            fits: self.fits + other.fits,
            systematic: self.systematic + other.systematic,
            vague: self.vague + other.vague,
            intervals: self.intervals + other.intervals,
            held: self.held + other.held,
            unknown: self.unknown + other.unknown,
        }
    }

    /// The share of the intervals that hold the true values.
    pub fn share(self) -> f64 {
        self.held as f64 / self.intervals as f64
    }
}
