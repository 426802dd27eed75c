//! The fit of a law to tests: of homogeneous specimens, or of a sheet on its mounting; of the law alone, or of what depends on time or on the
//! load history too.

use super::data::{Test, TestData};
use super::fitted::Fit;
use super::mounted::{mounting, nearest_mounted};
use super::nearest::nearest;
use super::protocols::protocols;
use super::relaxation::{Terms, fit_relaxation};
use super::settings::FitSettings;
use super::softening::{Base, fit_softening};
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

/// What a fit finds in addition to the parameters of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// Nothing.
    None,
    /// A Prony series.
    Relaxation(Terms),
    /// Softening by the largest previous load.
    Softening,
}

impl Memory {
    /// Fits a law with it to some tests together.
    ///
    /// # Errors
    /// As [`fit`], [`fit_relaxation`] and [`fit_softening`]; [`Error::Input`] for relaxation or softening in simple shear.
    pub fn fit(
        self,
        law: &'static Law,
        tests: &[TestData],
        settings: &FitSettings,
    ) -> Result<Fit, Error> {
        let sheared = tests.iter().find(|data| data.test == Test::SimpleShear);
        if let Some(data) = sheared.filter(|_| self != Self::None) {
            let message = format!(
                "{}: relaxation and softening are not fitted to simple shear",
                data.name
            );
            return Err(Error::input(
                message,
                "fit the law alone, or give tests of tension",
            ));
        }
        match self {
            Self::None => fit(law, tests, settings),
            Self::Relaxation(terms) => fit_relaxation(law, tests, settings, terms),
            Self::Softening => fit_softening(Base::Law(law), tests, settings),
        }
    }
}
