//! What tests of fits have in common.

use crate::calibration::{Fit, FitSettings, TestData, Weighting, fit};
use crate::document::Statements;
use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::material::registry::Law;

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
