//! The parameters of a law that come nearest to some tests.
//!
//! ```text
//! min Σᵢ (wᵢ (σᵢ − σ(p; λᵢ)))²,   w = 1 (absolute)   or   w = 1/max(|σᵢ|, 1 % of the test's largest) (relative)
//! ```
//!
//! σ is the stress that the test measured, nominal or Cauchy. Energies are proportional to their parameters
//! of the dimension of a stress; given the others, these follow by linear least squares. Starts are drawn for
//! the others alone (a fixed sequence, the same on every machine), completed linearly, and the best of them
//! are improved by Levenberg–Marquardt.
//!
//! # References
//! G. H. Golub, V. Pereyra, Inverse Problems 19, R1 (2003), doi:10.1088/0266-5611/19/2/201

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::least_squares::{self, Precision, Residuals};
use super::misfit::Misfit;
use super::quality::{self, Quality};
use super::test_data::{Observation, Test, TestData};
use crate::document::{Bound, name_of};
use crate::error::{Error, suggestion};
use crate::material::HyperelasticLaw;
use crate::material::marlow::{Marlow, TableCurve};
use crate::material::parameters::{Parameter, StrainMeasure, StressMeasure};
use crate::material::registry::{LAWS, Law, MARLOW_TABLE};

/// What a residual is measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// All differences of stress count alike.
    Absolute,
    /// All relative differences count alike: a residual is divided by the measured stress, but by no less than
    /// a hundredth of the largest one of its test, so that a stress near zero does not outweigh all others.
    Relative,
}

impl Weighting {
    /// The names that cards and the command line use.
    pub const NAMES: [(&'static str, Self); 2] =
        [("absolute", Self::Absolute), ("relative", Self::Relative)];

    /// The name that cards use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }

    /// The name, and the floor of what relative residuals are divided by.
    pub fn describe(self) -> String {
        match self {
            Self::Absolute => self.name().into(),
            Self::Relative => format!(
                "{} (to {} % of its test's largest stress where a stress is smaller)",
                self.name(),
                100.0 * SMALLEST_SHARE
            ),
        }
    }

    /// The weight of an observation.
    pub(super) fn weight(self, data: &TestData, observation: &Observation) -> f64 {
        match self {
            Self::Absolute => 1.0,
            Self::Relative => {
                let least = SMALLEST_SHARE * data.largest_stress;
                1.0 / observation.stress.abs().max(least)
            }
        }
    }
}

/// Limits of parameters by key, in internal units.
pub type Bounds = Vec<(String, [f64; 2])>;

/// How a fit is made.
#[derive(Clone, Debug)]
pub struct FitSettings {
    /// What a residual is measured by.
    pub weighting: Weighting,
    /// Limits beside those that the law has.
    pub bounds: Bounds,
    /// How many of the best starts are improved.
    pub starts: usize,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            weighting: Weighting::Absolute,
            bounds: Vec::new(),
            starts: 8,
        }
    }
}

/// The smallest stress that a relative residual is divided by, as a share of its test's largest one.
pub const SMALLEST_SHARE: f64 = 0.01;

/// Points above this number are thinned while starts are compared; the last improvement uses all of them.
const THINNED: usize = 400;
/// How many of the improved starts are improved to the end.
const REFINED: usize = 2;
/// Draws for each parameter that is no stress.
const DRAWS: usize = 80;

/// A law fitted to tests.
#[derive(Debug)]
pub struct Fit {
    /// The law's entry in the registry.
    pub law: &'static Law,
    /// The law with its parameters.
    pub fitted: Box<dyn HyperelasticLaw>,
    /// The parameters, in internal units.
    pub parameters: Vec<Parameter>,
    /// What else a card of the law states: key and choice.
    pub choices: Vec<(&'static str, String)>,
    /// The points (λ − 1, nominal stress in MPa) of a law that takes the curve as it is.
    pub curve: Vec<[f64; 2]>,
    stress_measure: StressMeasure,
    /// The settings.
    pub settings: FitSettings,
    /// How far the fit can be trusted.
    pub quality: Quality,
}

impl Fit {
    /// The stress measure of the data.
    pub fn stress_measure(&self) -> StressMeasure {
        self.stress_measure
    }

    /// Half the widths of the 95 % intervals of the fitted curve at some observations, in MPa.
    pub fn half_widths(&self, data: &TestData, at: &[Observation]) -> Vec<f64> {
        let values: Vec<f64> = self.parameters.iter().map(|one| one.value).collect();
        let curve = Curve {
            fit: self,
            data,
            at,
        };
        let gradients = least_squares::jacobian(&curve, &values, &vec![false; values.len()]);
        let spread = &gradients * &self.quality.covariance;
        let variance = |point: usize| spread.row(point).dot(&gradients.row(point));
        let half = |point: usize| self.quality.student * variance(point).max(0.0).sqrt();
        (0..at.len()).map(half).collect()
    }
}

/// The stresses of the fitted law at some observations as a function of its parameters.
struct Curve<'a> {
    fit: &'a Fit,
    data: &'a TestData,
    at: &'a [Observation],
}

impl Residuals for Curve<'_> {
    fn count(&self) -> usize {
        self.at.len()
    }

    fn evaluate(&self, parameters: &[f64], stresses: &mut [f64]) -> bool {
        let Fit {
            law,
            stress_measure,
            ..
        } = self.fit;
        let (law, _) = law.with_values(parameters, *stress_measure, MEASURE);
        for (stress, one) in stresses.iter_mut().zip(self.at) {
            *stress = self.data.stress_of(&*law, one);
        }
        stresses.iter().all(|stress| stress.is_finite())
    }
}

/// The strain measure that laws of a curve take in a fit.
pub(super) const MEASURE: StrainMeasure = StrainMeasure::Nominal;

/// Fits a law to some tests together.
///
/// # Errors
/// [`Error::Input`] when there are too few points, when a bound names no parameter, or when no parameters
/// within the bounds describe the data at all.
pub fn fit(law: &'static Law, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    if let Some(other) = tests
        .iter()
        .find(|test| test.stress_measure != tests[0].stress_measure)
    {
        let message = format!(
            "{} gives {} stress and {} gives {} stress",
            tests[0].name,
            tests[0].stress_measure.name(),
            other.name,
            other.stress_measure.name()
        );
        return Err(Error::input(
            message,
            "turn one of them with `gelbench materials convert`",
        ));
    }
    let whole = Misfit::new(law, tests, settings.weighting);
    if law.name == MARLOW_TABLE {
        return take_curve(law, tests, settings, &whole);
    }
    let parameters = whole.build(&[]).1.parameters;
    let bounds = limits(law, &parameters, &settings.bounds, whole.stiffness())?;
    let points: usize = tests.iter().map(|test| test.observations.len()).sum();
    if points <= parameters.len() {
        let message = format!(
            "{}: {} parameters need at least {} points, and there are {}",
            law.name,
            parameters.len(),
            parameters.len() + 1,
            points
        );
        return Err(Error::input(
            message,
            "measure more points, or choose a law with fewer parameters",
        ));
    }
    let thinned = whole.thinned(THINNED);
    let mut best_starts = starts(&thinned, &parameters, &bounds);
    best_starts.truncate(settings.starts);
    let mut minima: Vec<(f64, Vec<f64>)> = best_starts
        .into_par_iter()
        .filter_map(|(_, start)| {
            let found = least_squares::minimise(&thinned, &start, &bounds, Precision::Rough)?;
            Some((least_squares::sum_of_squares(&thinned, &found), found))
        })
        .collect();
    minima.sort_by(|a, b| a.0.total_cmp(&b.0));
    let refined = minima.iter().take(REFINED).map(|(sum, rough)| {
        // A minimum that is far above the best one cannot become it.
        let rough = rough.clone();
        if *sum > 1.2 * minima[0].0 {
            rough
        } else {
            refine(&whole, rough, &parameters, &bounds)
        }
    });
    let sum = |values: &Vec<f64>| least_squares::sum_of_squares(&whole, values);
    let Some(best) = refined.min_by(|a, b| sum(a).total_cmp(&sum(b))) else {
        let message = format!(
            "{}: no parameters within the bounds describe the data",
            law.name
        );
        return Err(Error::input(
            message,
            "widen the bounds, or choose another law",
        ));
    };
    let best = ordered(&parameters, best);
    let (fitted, asked) = whole.build(&best);
    let parameters = asked.parameters;
    // Another minimum counts as one when it is still elsewhere after the same care.
    let near = |sum: f64| sum <= 1.05 * least_squares::sum_of_squares(&thinned, &best);
    let elsewhere = minima.iter().find(|(sum, values)| {
        near(*sum) && quality::differs(&ordered(&parameters, values.clone()), &parameters)
    });
    let other = elsewhere
        .and_then(|(_, values)| least_squares::minimise(&thinned, values, &bounds, Precision::Full))
        .map(|values| ordered(&parameters, values))
        .filter(|values| quality::differs(values, &parameters));
    let quality = quality::assess(
        &whole,
        settings.weighting,
        tests,
        &*fitted,
        &parameters,
        &bounds,
        other.as_deref(),
    );
    Ok(Fit {
        law,
        fitted,
        parameters,
        choices: asked.choices,
        curve: Vec::new(),
        stress_measure: tests[0].stress_measure,
        settings: settings.clone(),
        quality,
    })
}

/// Improves parameters until neither the linear ones alone nor all together can be improved: narrow valleys
/// need several turns.
fn refine(
    misfit: &Misfit,
    mut values: Vec<f64>,
    parameters: &[Parameter],
    bounds: &[[f64; 2]],
) -> Vec<f64> {
    let stresses = stresses(parameters);
    let sum = |values: &[f64]| least_squares::sum_of_squares(misfit, values);
    for _ in 0..5 {
        let before = sum(&values);
        let mut linear = values.clone();
        let completed = misfit.complete(&mut linear, &stresses).is_some();
        if completed && within(&linear, bounds) && sum(&linear) < before {
            values = linear;
        }
        if let Some(better) = least_squares::minimise(misfit, &values, bounds, Precision::Full) {
            values = better;
        }
        if sum(&values) > (1.0 - 1e-9) * before {
            break;
        }
    }
    values
}

/// The parameters that are stresses.
fn stresses(parameters: &[Parameter]) -> Vec<usize> {
    let all = 0..parameters.len();
    all.filter(|index| parameters[*index].is_stress()).collect()
}

fn within(values: &[f64], bounds: &[[f64; 2]]) -> bool {
    values
        .iter()
        .zip(bounds)
        .all(|(value, [low, high])| (low..=high).contains(&value))
}

/// Marlow's law of one measured tension curve: nothing is fitted.
fn take_curve(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
    misfit: &Misfit,
) -> Result<Fit, Error> {
    let [test] = tests else {
        let hint = "the others can be compared with `gelbench materials plot`";
        return Err(Error::input(format!("{}: takes one file", law.name), hint));
    };
    if test.test != Test::Uniaxial {
        let hint = "give the file of a uniaxial test, or choose another law";
        return Err(Error::input(
            format!("{}: takes a uniaxial test", law.name),
            hint,
        ));
    }
    if let Some((key, _)) = settings.bounds.first() {
        return Err(Error::input(
            format!("{} has no parameter `{key}`", law.name),
            "leave the bound out",
        ));
    }
    let measure = test.stress_measure;
    let point = |one: &Observation| {
        let x = test.drawn_strain(one);
        [x, measure.to_nominal(one.stress, x)]
    };
    let points: Vec<[f64; 2]> = test.observations.iter().map(point).collect();
    let curve = TableCurve::new(&points, true).map_err(|reason| {
        let hint = "cut the file to the loading branch from rest on, or fit another law";
        Error::input(format!("{}: {reason}", law.name), hint)
    })?;
    let fitted: Box<dyn HyperelasticLaw> = Box::new(Marlow { curve });
    let mut quality = quality::assess(misfit, settings.weighting, tests, &*fitted, &[], &[], None);
    if let [x, at_rest] = points[0]
        && x == 0.0
        && at_rest != 0.0
    {
        let said = format!("the stress at rest, {at_rest:.4e} MPa, is subtracted from the curve");
        quality.warnings.push(said);
    }
    Ok(Fit {
        law,
        fitted,
        parameters: Vec::new(),
        choices: vec![("extrapolation", "linear".to_owned())],
        curve: points,
        stress_measure: StressMeasure::Nominal,
        settings: settings.clone(),
        quality,
    })
}

/// All laws that can be fitted to some tests, the one with the smallest AICc first; laws that cannot be are
/// left out with their reasons.
pub fn rank(tests: &[TestData], settings: &FitSettings) -> (Vec<Fit>, Vec<String>) {
    // A fibre law needs to see two directions.
    let axis = |axis: usize| {
        tests
            .iter()
            .flat_map(|test| &test.observations)
            .any(|one| one.axis == axis)
    };
    let (both_axes, measure) = (axis(0) && axis(1), StressMeasure::Nominal);
    let eligible: Vec<&'static Law> = LAWS
        .iter()
        .filter(|law| law.name != MARLOW_TABLE)
        .filter(|law| both_axes || law.with_values(&[], measure, MEASURE).0.is_isotropic())
        .collect();
    let outcomes: Vec<Result<Fit, Error>> = eligible
        .into_par_iter()
        .map(|law| fit(law, tests, settings))
        .collect();
    let (mut fits, mut reasons) = (Vec::new(), Vec::new());
    for outcome in outcomes {
        match outcome {
            Ok(fit) => fits.push(fit),
            Err(reason) => reasons.push(reason.to_string()),
        }
    }
    fits.sort_by(|a, b| a.quality.aicc.total_cmp(&b.quality.aicc));
    (fits, reasons)
}

/// Lower and upper limit of each parameter.
fn limits(
    law: &Law,
    parameters: &[Parameter],
    bounds: &Bounds,
    scale: f64,
) -> Result<Vec<[f64; 2]>, Error> {
    for (key, [low, high]) in bounds {
        let known: Vec<_> = parameters.iter().map(|parameter| parameter.key).collect();
        if !known.contains(&&**key) {
            let message = format!("{} has no parameter `{key}`", law.name);
            return Err(Error::input(
                message,
                suggestion(key, &known, "its parameters are"),
            ));
        }
        if bounds.iter().filter(|(other, _)| other == key).count() > 1 {
            return Err(Error::input(format!("{key} has two bounds"), "give one"));
        }
        if low >= high {
            let message = format!("the bounds {low} … {high} of {key} are not in order");
            return Err(Error::input(message, "write the lower one first"));
        }
    }
    let limit = |parameter: &Parameter| {
        let [low, high] = match parameter.bound {
            Bound::Any => [f64::NEG_INFINITY, f64::INFINITY],
            // Next to nothing beside what the data speak of.
            Bound::Positive if parameter.is_stress() => [1e-9 * scale, f64::INFINITY],
            Bound::Positive => [1e-9, f64::INFINITY],
            Bound::NonNegative => [0.0, f64::INFINITY],
            Bound::Within(low, high) | Bound::Range(low, high, _) => [low, high],
        };
        let given = bounds.iter().find(|(key, _)| key == parameter.key);
        let [from, to] = given.map_or([low, high], |(_, [l, h])| [low.max(*l), high.min(*h)]);
        if from >= to {
            let message = format!("the bounds of {} leave no value of the law", parameter.key);
            return Err(Error::input(
                message,
                format!("the law takes values from {low:.1e} to {high:.1e}"),
            ));
        }
        Ok([from, to])
    };
    parameters.iter().map(limit).collect()
}

/// Starts within the bounds, the best first.
fn starts(misfit: &Misfit, parameters: &[Parameter], bounds: &[[f64; 2]]) -> Vec<(f64, Vec<f64>)> {
    let stresses = stresses(parameters);
    let free = parameters.len() - stresses.len();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let scale = misfit.stiffness();
    let draws = if free == 0 { 1 } else { DRAWS * free };
    let mut starts = Vec::new();
    for _ in 0..draws {
        let mut values: Vec<f64> = parameters
            .iter()
            .zip(bounds)
            .map(|(parameter, [low, high])| {
                let share: f64 = random.random();
                let [from, to] = parameter.usual;
                let drawn = if parameter.is_stress() {
                    scale * 0.01_f64.powf(share)
                } else if from > 0.0 {
                    from * (to / from).powf(share)
                } else {
                    from + (to - from) * share
                };
                drawn.clamp(*low, *high)
            })
            .collect();
        let drawn = values.clone();
        if misfit.complete(&mut values, &stresses).is_none() {
            values = drawn;
        }
        for (value, [low, high]) in values.iter_mut().zip(bounds) {
            // A start on a bound could never leave it: stay a little inside.
            let width = (high - low).min(scale.max(value.abs()));
            *value = value.max(low + 1e-3 * width).min(high - 1e-3 * width);
        }
        let sum = least_squares::sum_of_squares(misfit, &values);
        if sum.is_finite() && within(&values, bounds) {
            starts.push((sum, values));
        }
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts
}

/// Terms of Ogden's law in the order of their exponents: the same fit always has the same face.
fn ordered(parameters: &[Parameter], mut values: Vec<f64>) -> Vec<f64> {
    let is_term =
        |pair: &[Parameter]| pair[0].key.starts_with("mu_") && pair[1].key.starts_with("alpha_");
    if parameters.len().is_multiple_of(2) && parameters.chunks(2).all(is_term) {
        let mut terms: Vec<[f64; 2]> = values.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        terms.sort_by(|a, b| b[1].total_cmp(&a[1]));
        values = terms.concat();
    }
    values
}
