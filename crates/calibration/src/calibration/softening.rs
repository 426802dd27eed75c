//! Softening: a law with the pseudo-elasticity of Ogden and Roxburgh fitted to loading and unloading.
//!
//! The rows of a test are its history, in the order of the file: Wₘ of a row is the largest W₀ of this row and those before. The
//! law's parameters are found together with r, m and β; or they are those of a card, and r, m and β alone are found.

use std::sync::Arc;

use super::data::{Observation, TestData};
use super::fitted::Fit;
use super::least_squares::{Residuals, descend};
use super::mounted::refuse_mounted;
use super::nearest::{check_measures, nearest};
use super::regression::{Misfit, improved};
use super::settings::{FitSettings, limits};
use super::softened::{Softened, cycles};
use super::solution::Solution;
use super::trust::taken_zeros;
use crate::error::Error;
use crate::material::parameters::Parameter;
use crate::material::registry::{Law, MARLOW_TABLE};
use crate::material::{Card, HyperelasticLaw, SoftenedLaw, Softening};
use crate::statistics::farthest;

mod misfit;
#[cfg(test)]
mod tests;

pub use misfit::Base;

use misfit::{SOFTENING, Softens, softening_parameters};

/// Fits a law that softens to some tests together.
///
/// # Errors
/// [`Error::Input`] where the tests never unload, where there are too few points, and as [`fit`](super::fit()).
pub fn fit_softening(base: Base, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    check_measures(tests)?;
    refuse_mounted(tests)?;
    check_cycles(tests)?;
    let first = first_loading(base, tests, settings)?;
    let of_law = first.parameters.len();
    let response = Softens {
        base,
        of_law,
        tests,
    };
    let largest = response.largest_energy(&*first.fitted);
    let misfit = Misfit::new(response, settings.weighting);
    let mut parameters = first.parameters;
    parameters.extend(softening_parameters(largest));
    let rows = misfit.count();
    if rows <= parameters.len() + 1 {
        let message = format!(
            "{} parameters need more than {rows} points",
            parameters.len()
        );
        return Err(Error::input(message, "measure more points"));
    }
    let scale = first.fitted.youngs_modulus();
    let bounds = limits(first.law, tests, &parameters, &settings.bounds, scale)?;
    let start: Vec<f64> = parameters.iter().map(|one| one.value).collect();
    let starts = starts(&start[..of_law], &bounds, largest);
    let minima = improved(&misfit, starts, &bounds);
    let (_, rough) = minima.into_iter().next().ok_or_else(|| {
        let message = format!("{}: no softening describes the data", first.law.name);
        Error::input(message, "look at the strains, or choose another law")
    })?;
    let values = descend(&misfit, &rough, &bounds).unwrap_or(rough);
    let solution = Solution {
        misfit,
        values,
        bounds,
    }
    .checked(first.law, &parameters)?
    .settled();
    let mut fit = solution.fit(first.law, &parameters, settings, None);
    fit.quality.warnings.extend(taken_zeros(tests));
    let softening = solution.misfit.response.softening(&solution.values);
    fit.of_law = of_law;
    fit.choices = first.choices;
    softened(fit, base, tests, softening).that_follows(tests)
}

/// Starts of the search: values of the law, followed by r, m and β; `largest` is the largest energy of the tests in mJ/mm³.
fn starts(of_law: &[f64], bounds: &[[f64; 2]], largest: f64) -> Vec<Vec<f64>> {
    let mut starts = Vec::new();
    for r in [1.3, 2.0, 4.0] {
        for width in [0.05, 0.3] {
            for beta in [0.01, 0.3] {
                let values = [of_law, &[r, width * largest, beta]].concat();
                let pairs = values.iter().zip(bounds);
                let within = pairs.map(|(value, [low, high])| value.clamp(*low, *high));
                starts.push(within.collect());
            }
        }
    }
    starts
}

/// The fit of the law of the first loading with its softening.
fn softened(fit: Fit, base: Base, tests: &[TestData], softening: Softening) -> Fit {
    let virgin = fit.fitted;
    let records = tests.iter().zip(&fit.predicted);
    let cycles = records.flat_map(|(data, predicted)| cycles(data, &*virgin, softening, predicted));
    let softened = Softened {
        softening,
        card: match base {
            Base::Law(_) => None,
            Base::Card(card) => Some(card.text.clone()),
        },
        cycles: cycles.collect(),
    };
    Fit {
        fitted: Arc::new(SoftenedLaw::unloaded(virgin, softening)),
        softened: Some(softened),
        ..fit
    }
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
        let decrease = after.fold(0.0, f64::max);
        decrease > 0.1 * most
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
    let rising: Vec<TestData> = tests.iter().map(rising).collect();
    let fit = nearest(law, &rising, &settings.without(&SOFTENING))?;
    Ok(First {
        law,
        fitted: fit.fitted,
        parameters: fit.parameters,
        choices: fit.choices,
    })
}

/// A card as the law of the first loading, without parameters to be found.
fn of_card(card: &Card) -> Result<First, Error> {
    let law = Law::of_card(&card.law_name, &card.choices).ok_or_else(|| {
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
