//! What is fitted with a law: the law alone, or what depends on time or on the load history too.

use super::data::{Test, TestData};
use super::fit::fit;
use super::fitted::Fit;
use super::relaxation::{Terms, fit_relaxation};
use super::settings::FitSettings;
use super::softening::{Base, fit_softening};
use crate::error::Error;
use crate::material::registry::Law;

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
