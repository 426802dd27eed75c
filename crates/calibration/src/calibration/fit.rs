//! The fit of a law to tests: of homogeneous specimens, or of a sheet on its mounting.

use super::data::TestData;
use super::fitted::Fit;
use super::mounted::{mounting, nearest_mounted};
use super::nearest::nearest;
use super::protocols::protocols;
use super::settings::FitSettings;
use crate::error::Error;
use crate::material::registry::Law;

/// Fits a law to some tests together.
///
/// # Errors
/// [`Error::Input`] when there are too few points, when a bound names no parameter, or when no parameters
/// within the bounds describe the data at all; [`Error::Solve`] when the search ends at no minimum.
pub fn fit(law: &'static Law, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    let mut fit = match mounting(tests)? {
        Some(mounting) => nearest_mounted(law, tests, mounting, settings),
        None => nearest(law, tests, settings),
    }?;
    if tests.iter().any(|test| test.mounted.estimates_stretches()) {
        let as_mounted = tests.iter().map(TestData::as_mounted);
        let as_mounted = nearest(law, &as_mounted.collect::<Vec<_>>(), settings)?;
        let at_rest = (as_mounted.parameters, as_mounted.quality.r_squared);
        fit.at_rest_as_mounted = Some(at_rest);
    }
    fit.protocols = protocols(&fit, tests);
    fit.that_follows(tests)
}
