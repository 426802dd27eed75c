//! What `gelbench materials fit` fits with a law: the law alone, or what depends on time and load history too.

use crate::calibration::{self, Base, Fit, FitSettings, Terms, TestData};
use crate::error::Error;
use crate::material::registry::Law;

/// How many terms a Prony series is asked for.
pub fn terms(text: &str) -> Result<Terms, Error> {
    let number = text.parse().ok().filter(|terms| *terms <= Terms::MOST);
    match (text, number) {
        ("automatic", _) => Ok(Terms::Automatic),
        (_, Some(terms)) => Ok(Terms::Exactly(terms)),
        _ => Err(Error::input(
            format!("--relaxation {text} is not a number of terms"),
            format!(
                "a number up to {}, or nothing, for as many as AICc selects",
                Terms::MOST
            ),
        )),
    }
}

/// What is fitted with a law.
pub enum InTime {
    Nothing,
    Relaxation(Terms),
    Softening,
}

/// A law fitted to tests, with what is wanted besides.
pub fn fitted(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
    wanted: InTime,
) -> Result<Fit, Error> {
    match wanted {
        InTime::Relaxation(terms) => calibration::fit_relaxation(law, tests, settings, terms),
        InTime::Softening => calibration::fit_softening(Base::Law(law), tests, settings),
        InTime::Nothing => calibration::fit(law, tests, settings),
    }
}
