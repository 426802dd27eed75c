//! Relaxation: a law with a Prony series fitted to measurements over time.
//!
//! The measured strains are followed as they are: stress relaxation, creep, cycles and pulls at several rates are all
//! histories of strain with stresses, and are fitted together. The law is that of long times. Terms are added as long
//! as AICc falls; relaxation times lie between the shortest interval of the data and their longest duration: others
//! are not resolved.

use super::data::{Branches, TestData, Times};
use super::fitted::{Fit, Relaxed};
use super::least_squares::Residuals;
use super::mounted::refuse_mounted;
use super::nearest::{check_measures, nearest};
use super::regression::Misfit;
use super::settings::{FitSettings, limits};
use super::solution::Solution;
use super::trust::taken_zeros;
use crate::error::Error;
use crate::material::parameters::Parameter;
use crate::material::registry::{Law, MARLOW_TABLE};
use crate::material::viscosity::Covered;
use crate::statistics::extremes;

mod history;
mod prony;
mod terms;
#[cfg(test)]
mod tests;

pub use terms::Terms;

use history::History;
use prony::Viscous;
use terms::{TERM_KEYS, parameters, transformed};

/// Fits a law with a Prony series to some tests together.
///
/// # Errors
/// [`Error::Input`] where a test has no times, where the law has no parameters or changes its volume, when there are too few points,
/// and as [`fit`](super::fit()).
pub fn fit_relaxation(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
    terms: Terms,
) -> Result<Fit, Error> {
    check_measures(tests)?;
    refuse_mounted(tests)?;
    let histories = History::all(tests, true)?;
    let elastic = elastic(law, tests, settings)?;
    let of_law = elastic.of_law;
    let response = Viscous {
        law,
        of_law,
        tests,
        histories,
    };
    let misfit = Misfit::new(response, settings.weighting);
    let resolved = resolved(&misfit.response.histories)?;
    let (series, tried) = best_series(&misfit, &elastic, settings, terms, resolved)?;
    let parameters = series.parameters;
    let solution = Solution {
        misfit,
        ..series.solution
    }
    .checked(law, &parameters)?
    .settled();
    let terms = (parameters.len() - of_law) / 2;
    let used = settings.without(TERM_KEYS[terms..].as_flattened());
    let mut fit = solution.fit(law, &parameters, &used, None);
    let mut material = solution.misfit.response.material(&solution.values);
    material.covered = Covered {
        times: Some(resolved.map(without_rounding)),
        rates: rates(tests),
    };
    let more = series_warnings(&fit, &solution.misfit.response, resolved);
    fit.quality.warnings.extend(more);
    fit.quality.warnings.extend(taken_zeros(tests));
    let fit = Fit {
        of_law,
        choices: elastic.choices,
        relaxed: Some(Relaxed { material, tried }),
        ..fit
    };
    fit.that_follows(tests)
}

/// A law with a number of terms.
struct Series<'a> {
    criterion: f64,
    parameters: Vec<Parameter>,
    solution: Solution<Viscous<'a>>,
}

/// The numbers of terms that were tried with their AICc.
type Tried = Vec<(usize, f64)>;

/// The series with the smallest AICc.
fn best_series<'a>(
    misfit: &Misfit<Viscous<'a>>,
    elastic: &Fit,
    settings: &FitSettings,
    terms: Terms,
    resolved: [f64; 2],
) -> Result<(Series<'a>, Tried), Error> {
    let of_law = elastic.of_law;
    let mut laws = vec![elastic.parameters.iter().map(|one| one.value).collect()];
    let mut best: Option<Series> = None;
    let mut tried = Vec::new();
    for number in terms.tried() {
        let parameters = parameters(&elastic.parameters, number, resolved);
        if misfit.count() <= parameters.len() + 1 {
            break;
        }
        let scale = elastic.fitted.youngs_modulus();
        // While terms are counted, bounds of further ones wait for a longer series.
        let stated = match terms {
            Terms::Automatic => settings.without(TERM_KEYS[number..].as_flattened()),
            Terms::Exactly(_) => settings.clone(),
        };
        let bounds = limits(
            elastic.law,
            misfit.response.tests,
            &parameters,
            &stated.bounds,
            scale,
        )?;
        let bounds = transformed(bounds, of_law);
        let Some(values) = misfit.minimum(&laws, &parameters, &bounds) else {
            continue;
        };
        laws.truncate(1);
        laws.push(values[..of_law].to_vec());
        let solution = Solution {
            misfit: misfit.reweighed(&values),
            values,
            bounds,
        };
        let criterion = solution.judged().aicc();
        tried.push((number, criterion));
        let is_worse = |known: &Series| criterion.total_cmp(&known.criterion).is_lt();
        if best.as_ref().is_none_or(is_worse) {
            best = Some(Series {
                criterion,
                parameters,
                solution,
            });
        }
    }
    let best = best.ok_or_else(|| {
        let message = format!("{}: no Prony series describes the data", elastic.law.name);
        let hint = "give fewer terms, or look at the times and the strains";
        Error::input(message, hint)
    })?;
    Ok((best, tried))
}

/// The fit of the law without relaxation, at whose parameters the search begins.
fn elastic(law: &'static Law, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    if law.name == MARLOW_TABLE {
        let message = format!("{} takes a curve as it is, at one rate", law.name);
        let hint = "fit the relaxation with a law that has parameters";
        return Err(Error::input(message, hint));
    }
    let (unknown, _) = law.unknown();
    if unknown.bulk_modulus().is_some() {
        let message = format!("{} is compressible", law.name);
        let hint = "relaxation is fitted to incompressible laws only: choose another law";
        return Err(Error::input(message, hint));
    }
    nearest(law, tests, &settings.without(TERM_KEYS.as_flattened()))
}

/// The shortest interval between rows and the longest duration of a history, in s.
fn resolved(histories: &[History]) -> Result<[f64; 2], Error> {
    let steps = histories.iter().flat_map(|history| {
        let pairs = history.states.windows(2);
        pairs.map(|pair| pair[1].time - pair[0].time)
    });
    let [shortest, _] = extremes(steps.filter(|step| *step > 0.0));
    let [_, longest] = extremes(histories.iter().map(History::duration));
    if shortest < longest {
        return Ok([shortest, longest]);
    }
    let hint = "relaxation needs several rows at different times";
    Err(Error::input("the times of the tests do not differ", hint))
}

/// The warnings about the series.
fn series_warnings(fit: &Fit, response: &Viscous, [low, high]: [f64; 2]) -> Vec<String> {
    let mut warnings = Vec::new();
    let is_time = |key: &str| TERM_KEYS.iter().any(|[_, time]| *time == key);
    let pairs = fit.parameters.iter().zip(&fit.quality.at_bound);
    let at_bound = pairs.filter_map(|(parameter, held)| held.then_some(parameter.key));
    let held: Vec<&str> = at_bound.filter(|key| is_time(key)).collect();
    if !held.is_empty() {
        warnings.push(format!(
            "{} at the limit of what the data resolve, {low:.4} to {high:.4} s: faster or slower relaxation cannot be distinguished from it",
            held.join(", ")
        ));
    }
    if fit.parameters.len() == response.of_law {
        warnings.push("no relaxation is seen: the law alone has the smallest AICc".to_owned());
    }
    let histories = response.histories.iter();
    for history in histories.filter(|history| history.begins_stretched) {
        let data = &response.tests[history.test];
        let assumed = if data.rise > 0.0 {
            format!("a linear rise over the {} s before is assumed", data.rise)
        } else {
            "a sudden rise is assumed; state with `--ramp` how long it took".to_owned()
        };
        warnings.push(format!("{} begins stretched: {assumed}", data.name));
    }
    warnings
}

/// A difference of times without the rounding of the subtraction.
fn without_rounding(time: f64) -> f64 {
    format!("{time:.11e}").parse().unwrap_or(time)
}

/// The slowest and the fastest stretching and letting back of some tests, in 1/s.
fn rates(tests: &[TestData]) -> Option<[f64; 2]> {
    let mut rates = Vec::new();
    for data in tests {
        let Times::Known(times) = &data.times else {
            continue;
        };
        let axis = data.axes[0];
        let timed = data.observations.iter().zip(times);
        let rows: Vec<(f64, f64)> = timed
            .filter(|(one, _)| one.axis == axis)
            .map(|(one, time)| (*time, data.drawn_strain(one)))
            .collect();
        let strains: Vec<f64> = rows.iter().map(|(_, x)| *x).collect();
        for branch in Branches::of(&strains).loading {
            let [(begin, low), (end, high)] = [rows[branch.start], rows[branch.end - 1]];
            if end > begin && high != low {
                rates.push(((high - low) / (end - begin)).abs());
            }
        }
    }
    let [slowest, fastest] = extremes(rates);
    (slowest <= fastest).then_some([slowest, fastest])
}
