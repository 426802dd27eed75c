//! Relaxation: a law with a Prony series fitted to measurements over time.
//!
//! The measured strains are followed as they are: stress relaxation, creep, cycles and pulls at several rates are all
//! histories of strain with stresses, and are fitted together. The law is that of long times. Terms are added as long
//! as AICc falls; relaxation times lie between the shortest interval of the data and their longest duration, outside
//! of which the data resolve nothing.

use std::fmt::Write;

use super::data::{Branches, TestData, Times};
use super::fit::{Fit, Relaxed, check_measures, nearest};
use super::least_squares::Residuals;
use super::regression::{Reweighed, check_minimum, settled};
use super::settings::{FitSettings, MEASURE, limits};
use super::trust::{
    AT_BOUND, Deviations, Judged, Quality, Values, at_bound, rounded, taken_zeros, warnings,
};
use crate::error::Error;
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::{Law, MARLOW_TABLE};
use crate::material::viscosity::Covered;
use crate::statistics::{Estimate, extremes};
use nalgebra::DMatrix;

mod history;
mod prony;
mod terms;
#[cfg(test)]
mod tests;

pub use terms::Terms;

use history::History;
use prony::{Found, ViscousMisfit};
use terms::{SHARES, TIMES, parameters, transformed};

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
    let histories = History::all(tests, true)?;
    let elastic = elastic(law, tests, settings)?;
    let law_parameters = elastic.parameters.clone();
    let of_law = law_parameters.len();
    let misfit = ViscousMisfit::new(law, of_law, tests, histories, settings.weighting);
    let resolved = resolved(&misfit.histories)?;
    let start: Vec<f64> = law_parameters.iter().map(|one| one.value).collect();
    let mut laws = vec![start];
    let mut candidates: Vec<(usize, Found)> = Vec::new();
    let scale = elastic.fitted.youngs_modulus();
    for terms in terms.tried() {
        let parameters = parameters(&law_parameters, terms, resolved);
        if misfit.count() <= parameters.len() + 1 {
            break;
        }
        let bounds = transformed(limits(law, &parameters, &settings.bounds, scale), of_law)?;
        if let Some(found) = misfit.minimum(&laws, &parameters, &bounds) {
            laws.truncate(1);
            laws.push(found.1[..of_law].to_vec());
            candidates.push((terms, found));
        }
    }
    if candidates.is_empty() {
        let message = format!("{}: no Prony series describes the data", law.name);
        let hint = "give fewer terms, or look at the times and the strains";
        return Err(Error::input(message, hint));
    }
    let whole = Whole {
        misfit: &misfit,
        tests,
        settings,
        law_parameters: &law_parameters,
        resolved,
    };
    whole.chosen(elastic, candidates)
}

/// The law without relaxation, whose parameters the search begins with.
fn elastic(law: &'static Law, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    if law.name == MARLOW_TABLE {
        let message = format!("{} takes a curve as it is, at one rate", law.name);
        return Err(Error::input(
            message,
            "fit the relaxation with a law that has parameters",
        ));
    }
    let nominal = StressMeasure::Nominal;
    if law
        .with_values(&[], nominal, MEASURE)
        .0
        .bulk_modulus()
        .is_some()
    {
        let message = format!("{} is compressible", law.name);
        let hint = "relaxation is fitted to incompressible laws only: choose another law";
        return Err(Error::input(message, hint));
    }
    let own =
        |(key, _): &&(String, [f64; 2])| !SHARES.contains(&&**key) && !TIMES.contains(&&**key);
    let settings = FitSettings {
        bounds: settings.bounds.iter().filter(own).cloned().collect(),
        ..settings.clone()
    };
    nearest(law, tests, &settings)
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

/// The data by which a chosen series is judged.
struct Whole<'a> {
    misfit: &'a ViscousMisfit<'a>,
    tests: &'a [TestData],
    settings: &'a FitSettings,
    law_parameters: &'a [Parameter],
    resolved: [f64; 2],
}

impl Whole<'_> {
    /// The fit with the smallest AICc.
    fn chosen(&self, elastic: Fit, candidates: Vec<(usize, Found)>) -> Result<Fit, Error> {
        let mut judged = Vec::new();
        for (terms, (_, values)) in candidates {
            let criterion = self.judged(terms, &values)?.aicc(values.len());
            judged.push((criterion, terms, values));
        }
        let tried = judged
            .iter()
            .map(|(criterion, terms, _)| (*terms, *criterion));
        let tried: Vec<(usize, f64)> = tried.collect();
        let best = judged.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((_, terms, values)) => self.finished(elastic, terms, values, tried),
            None => Ok(elastic),
        }
    }

    /// The fit with so many terms.
    fn finished(
        &self,
        elastic: Fit,
        terms: usize,
        values: Vec<f64>,
        tried: Vec<(usize, f64)>,
    ) -> Result<Fit, Error> {
        let bounds = self.limits(terms)?;
        let mut parameters = parameters(self.law_parameters, terms, self.resolved);
        check_minimum(self.misfit, self.law(), &parameters, &values, &bounds)?;
        let is_noise = |misfit: &ViscousMisfit, values: &[f64]| {
            self.judged_by(misfit, &bounds, values).is_noise()
        };
        let (misfit, values) = settled(self.misfit, values, &bounds, is_noise);
        let judged = self.judged_by(&misfit, &bounds, &values);
        for (index, (parameter, value)) in parameters.iter_mut().zip(&values).enumerate() {
            parameter.value = if self.is_logarithmic(index) {
                value.exp()
            } else {
                *value
            };
        }
        let estimated = self.estimated(&values, &judged);
        let fitted = self.misfit.law(&values);
        let relaxed = self.relaxed(&values, tried)?;
        let predicted = |test: usize, row: usize| relaxed.predicted[test][row];
        let deviations = Deviations::of(self.tests, &predicted);
        let mut quality = judged.quality(&*fitted, self.tests, &deviations, estimated);
        quality.warnings = warnings(&quality, &parameters, None);
        quality
            .warnings
            .extend(self.warnings(&parameters, &quality, terms));
        quality.warnings.extend(taken_zeros(self.tests));
        Ok(Fit {
            fitted,
            parameters,
            quality,
            settings: self.settings.clone(),
            relaxed: Some(relaxed),
            ..elastic
        })
    }

    /// Whether a value is the logarithm of a time.
    fn is_logarithmic(&self, index: usize) -> bool {
        let of_law = self.law_parameters.len();
        index > of_law && (index - of_law) % 2 == 1
    }

    /// The values with their uncertainty and correlation, with times instead of their logarithms.
    fn estimated(&self, values: &[f64], judged: &Judged) -> (Vec<Estimate>, DMatrix<f64>) {
        let (mut estimated, correlation) = judged.estimates(values);
        for (index, estimate) in estimated.iter_mut().enumerate() {
            if self.is_logarithmic(index) {
                *estimate = Estimate {
                    value: estimate.value.exp(),
                    standard_error: estimate.value.exp() * estimate.standard_error,
                    interval: estimate.interval.map(f64::exp),
                };
            }
        }
        (estimated, correlation)
    }

    /// The limits of all values with so many terms.
    fn limits(&self, terms: usize) -> Result<Vec<[f64; 2]>, Error> {
        let all = parameters(self.law_parameters, terms, self.resolved);
        let scale = 1.0;
        let limits = limits(self.law(), &all, &self.settings.bounds, scale);
        transformed(limits, self.law_parameters.len())
    }

    /// The values at a bound, and the residuals with the weights of the fitted stresses.
    fn judged(&self, terms: usize, values: &[f64]) -> Result<Judged, Error> {
        let own = self.misfit.reweighed(values);
        Ok(self.judged_by(&own, &self.limits(terms)?, values))
    }

    /// The same with the weights of a misfit.
    fn judged_by(&self, misfit: &ViscousMisfit, limits: &[[f64; 2]], values: &[f64]) -> Judged {
        let at_bound = at_bound(values, limits, AT_BOUND);
        let law = misfit.law(values);
        let rounded = rounded(self.tests, &*law, self.settings.weighting);
        Judged::of(
            misfit,
            misfit.curves(),
            Values::held(values, at_bound),
            rounded,
        )
    }

    fn law(&self) -> &'static Law {
        self.misfit.entry()
    }

    /// The series, its stresses at every row, and the range of the data.
    fn relaxed(&self, values: &[f64], tried: Vec<(usize, f64)>) -> Result<Relaxed, Error> {
        let histories = History::all(self.tests, false)?;
        let law = self.misfit.law(values);
        let mut material = self.misfit.material(values);
        let mut predicted: Vec<Vec<f64>> = self
            .tests
            .iter()
            .map(|test| vec![f64::NAN; test.observations.len()])
            .collect();
        for history in &histories {
            let data = &self.tests[history.test];
            let long = history.long_time_stress(data, &*law);
            let axis = history.states[0].observation.axis;
            let rows = data.observations.iter().enumerate();
            let rows = rows.filter(|(_, one)| one.axis == axis).map(|(row, _)| row);
            for (row, stress) in rows.zip(history.stresses(data, &long, &material)) {
                predicted[history.test][row] = stress;
            }
        }
        material.covered = Covered {
            times: Some(self.resolved.map(without_rounding)),
            rates: rates(self.tests),
        };
        Ok(Relaxed {
            material,
            of_law: self.law_parameters.len(),
            predicted,
            tried,
        })
    }

    /// The warnings about the series.
    fn warnings(&self, parameters: &[Parameter], quality: &Quality, terms: usize) -> Vec<String> {
        let mut found = Vec::new();
        let [low, high] = self.resolved;
        let held: Vec<&str> = parameters
            .iter()
            .zip(&quality.at_bound)
            .filter(|(parameter, held)| **held && TIMES.contains(&parameter.key))
            .map(|(parameter, _)| parameter.key)
            .collect();
        if !held.is_empty() {
            found.push(format!(
                "{} at the limit of what the data resolve, {low:.4} to {high:.4} s: faster or slower relaxation cannot be distinguished from it",
                held.join(", ")
            ));
        }
        if terms == 0 {
            found.push("no relaxation is seen: the law alone has the smallest AICc".to_owned());
        }
        let begun = self
            .misfit
            .histories
            .iter()
            .filter(|history| history.begins_stretched);
        for history in begun {
            let data = &self.tests[history.test];
            let mut text = format!("{} begins stretched: ", data.name);
            let _ = if data.rise > 0.0 {
                write!(
                    text,
                    "a linear rise over the {} s before is assumed",
                    data.rise
                )
            } else {
                write!(
                    text,
                    "a sudden rise is assumed; state with `--ramp` how long it took"
                )
            };
            found.push(text);
        }
        found
    }
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
        let rows = data.observations.iter().zip(times);
        let rows: Vec<(f64, f64)> = rows
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
