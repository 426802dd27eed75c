//! Softening: a law with the pseudo-elasticity of Ogden and Roxburgh fitted to loading and unloading.
//!
//! The rows of a test are its history, in the order of the file: Wₘ of a row is the largest W₀ of this row and those before. The
//! law's parameters are found together with r, m and β; or they are those of a card, and r, m and β alone are found.

use std::sync::Arc;

use super::data::{Observation, TestData};
use super::fit::{Fit, check_measures, nearest};
use super::least_squares::Residuals;
use super::regression::{check_minimum, settled};
use super::settings::{FitSettings, limits};
use super::softened::{Softened, cycles};
use super::trust::{Deviations, Quality, taken_zeros, warnings};
use crate::error::Error;
use crate::material::parameters::Parameter;
use crate::material::registry::{Law, MARLOW_TABLE};
use crate::material::{Card, HyperelasticLaw, SoftenedLaw};
use crate::statistics::farthest;

mod earlier;
mod misfit;
mod search;
#[cfg(test)]
mod tests;

pub use misfit::Base;

use earlier::Search;
use misfit::{SOFTENING, SofteningMisfit, softening_parameters};
use search::{judged, minimum};

/// Fits a law that softens to some tests together.
///
/// # Errors
/// [`Error::Input`] where the tests never unload, where there are too few points, and as [`fit`](super::fit()).
pub fn fit_softening(base: Base, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    check_measures(tests)?;
    check_cycles(tests)?;
    let first = first_loading(base, tests, settings)?;
    let (of_law, scale) = (first.parameters.clone(), first.fitted.youngs_modulus());
    let misfit = SofteningMisfit::new(base, of_law.len(), tests, settings.weighting);
    let largest = misfit.largest_energy(&*first.fitted);
    let mut parameters = of_law;
    parameters.extend(softening_parameters(largest));
    let rows = misfit.count();
    if rows <= parameters.len() + 1 {
        let message = format!(
            "{} parameters need more than {rows} points",
            parameters.len()
        );
        return Err(Error::input(message, "measure more points"));
    }
    let bounds = limits(first.law, &parameters, &settings.bounds, scale)?;
    let start: Vec<f64> = parameters.iter().map(|one| one.value).collect();
    let values = minimum(&misfit, &start, &bounds, largest).ok_or_else(|| {
        let message = format!("{}: no softening describes the data", first.law.name);
        Error::input(message, "look at the strains, or choose another law")
    })?;
    check_minimum(&misfit, first.law, &parameters, &values, &bounds)?;
    let search = Search {
        base,
        tests,
        start: &start,
        bounds: &bounds,
        largest,
        weighting: settings.weighting,
    };
    let doubts = search.doubts(&misfit, &values);
    let is_noise = |misfit: &SofteningMisfit, values: &[f64]| {
        judged(misfit, tests, values, &bounds, settings.weighting).is_noise()
    };
    let (misfit, values) = settled(&misfit, values, &bounds, is_noise);
    let whole = Whole {
        misfit: &misfit,
        tests,
        settings,
        bounds: &bounds,
    };
    let mut fit = whole.finished(first, parameters, &values);
    fit.quality.warnings.extend(doubts);
    Ok(fit)
}

/// Checks that the tests unload somewhere: softening does not show in a first loading.
fn check_cycles(tests: &[TestData]) -> Result<(), Error> {
    let falls = |data: &TestData| {
        let strain = |one: &Observation| data.drawn_strain(one).abs();
        let mut most = 0.0_f64;
        let after = data.observations.iter().map(|one| {
            most = most.max(strain(one));
            most - strain(one)
        });
        let fall = after.fold(0.0, f64::max);
        fall > 0.1 * most
    };
    if tests.iter().any(falls) {
        return Ok(());
    }
    let hint =
        "softening is fitted to loading and unloading: give the whole record, with `--cycle all`";
    Err(Error::input("no test unloads", hint))
}

/// The law with which the search begins.
struct First {
    law: &'static Law,
    fitted: Arc<dyn HyperelasticLaw>,
    /// The parameters that are found together with the softening.
    parameters: Vec<Parameter>,
    choices: Vec<(&'static str, String)>,
}

/// The law of the first loading: fitted to the rows that no earlier one exceeds, or that of a card.
fn first_loading(base: Base, tests: &[TestData], settings: &FitSettings) -> Result<First, Error> {
    let law = match base {
        Base::Law(law) => law,
        Base::Card(card) => return of_card(card),
    };
    if law.name == MARLOW_TABLE {
        let message = format!("{MARLOW_TABLE} takes a curve as it is, without unloading");
        let hint =
            "choose a law with parameters, or give a card of the first loading with `--card`";
        return Err(Error::input(message, hint));
    }
    let own = |(key, _): &&(String, [f64; 2])| !SOFTENING.contains(&&**key);
    let of_law = FitSettings {
        bounds: settings.bounds.iter().filter(own).cloned().collect(),
        ..settings.clone()
    };
    let rising: Vec<TestData> = tests.iter().map(rising).collect();
    let found = nearest(law, &rising, &of_law)?;
    Ok(First {
        law,
        fitted: found.fitted.into(),
        parameters: found.parameters,
        choices: found.choices,
    })
}

/// A card as the law of the first loading, without parameters to be found.
fn of_card(card: &Card) -> Result<First, Error> {
    let law = Law::named(&card.law_name).ok_or_else(|| {
        let message = format!(
            "the law of the card `{}` is not one of gelbench's",
            card.name
        );
        Error::input(
            message,
            "take a card with a law of `gelbench materials list`",
        )
    })?;
    Ok(First {
        law,
        fitted: Arc::clone(&card.law),
        parameters: Vec::new(),
        choices: Vec::new(),
    })
}

/// The rows of a test that no earlier state exceeds by more than a hundredth; all of them where the specimen was stretched further before.
fn rising(data: &TestData) -> TestData {
    let far = farthest(data.observations.iter().map(|one| data.drawn_strain(one)));
    let before = data.preconditioned.unwrap_or_default().abs();
    if before >= far.abs() {
        return data.clone();
    }
    let mut most = before;
    let mut rows = Vec::new();
    for one in &data.observations {
        let strain = data.drawn_strain(one).abs();
        most = most.max(strain);
        if strain >= 0.99 * most {
            rows.push(*one);
        }
    }
    TestData {
        observations: rows,
        // The zero stays where the record has it.
        found_zero: None,
        ..data.clone()
    }
}

/// The data by which the values found are judged.
struct Whole<'a> {
    misfit: &'a SofteningMisfit<'a>,
    tests: &'a [TestData],
    settings: &'a FitSettings,
    bounds: &'a [[f64; 2]],
}

impl Whole<'_> {
    fn finished(&self, first: First, mut parameters: Vec<Parameter>, values: &[f64]) -> Fit {
        for (parameter, value) in parameters.iter_mut().zip(values) {
            parameter.value = *value;
        }
        let fitted = self.misfit.law(values);
        let predicted = self.misfit.stresses(values);
        let softening = self.misfit.softening(values);
        let mut quality = self.quality(&*fitted, values, &predicted);
        quality.warnings = warnings(&quality, &parameters, None);
        quality.warnings.extend(taken_zeros(self.tests));
        let tests = self.tests.iter().zip(&predicted);
        let of_tests = tests.flat_map(|(data, own)| cycles(data, &*fitted, softening, own));
        let softened = Softened {
            softening,
            of_law: self.misfit.of_law,
            card: match self.misfit.base {
                Base::Law(_) => None,
                Base::Card(card) => Some(card.text.clone()),
            },
            cycles: of_tests.collect(),
            predicted,
        };
        Fit {
            law: first.law,
            fitted: Box::new(SoftenedLaw::unloaded(fitted, softening)),
            parameters,
            choices: first.choices,
            curve: Vec::new(),
            stress_measure: self.misfit.measure(),
            settings: self.settings.clone(),
            quality,
            relaxed: None,
            softened: Some(softened),
        }
    }

    fn quality(
        &self,
        law: &dyn HyperelasticLaw,
        values: &[f64],
        predicted: &[Vec<f64>],
    ) -> Quality {
        let weighting = self.settings.weighting;
        let judged = judged(self.misfit, self.tests, values, self.bounds, weighting);
        let estimates = judged.estimates(values);
        let deviations = Deviations::of(self.tests, &|test, row| predicted[test][row]);
        judged.quality(law, self.tests, &deviations, estimates)
    }
}
