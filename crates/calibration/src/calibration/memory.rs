//! What is fitted with a law: the law alone, or what depends on time or on the load history too.

use super::data::TestData;
use super::fit::fit;
use super::fitted::Fit;
use super::relaxation::{Terms, fit_relaxation};
use super::settings::FitSettings;
use super::softening::{Base, fit_softening};
use crate::error::Error;
use crate::material::registry::Law;

/// What a fit finds beside the parameters of a law.
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
    /// As [`fit`], [`fit_relaxation`] and [`fit_softening`].
    pub fn fit(
        self,
        law: &'static Law,
        tests: &[TestData],
        settings: &FitSettings,
    ) -> Result<Fit, Error> {
        match self {
            Self::None => fit(law, tests, settings),
            Self::Relaxation(terms) => fit_relaxation(law, tests, settings, terms),
            Self::Softening => fit_softening(Base::Law(law), tests, settings),
        }
    }
}
