//! The runs: every combination of the listed values, each with the points that are drawn.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;

use super::points::Points;
use super::variable::{MOST_RUNS, Setting, Values, Variable};
use gelbench_base::error::Diagnostic;
use gelbench_base::statistics::{normal_quantile, normal_reach};

/// Most points, and dimensions, of the scrambled sequence.
const MOST_OF_SOBOL: usize = 1 << 16;
const SOBOL_DIMENSIONS: usize = 256;

/// The way in which points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Sobol's sequence with Owen's scrambling.
    Sobol,
    /// Random points, independent of each other.
    Random,
}

/// The number of points that are drawn, and the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// The number of points; `None` where none are drawn.
    pub samples: Option<usize>,
    /// The way.
    pub method: Method,
    /// The seed of the drawing.
    pub seed: u32,
}

/// One run: its number from 1 on, and the values of each variable.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its number.
    pub number: usize,
    /// The values, in the order of [`Sweep::keys`](super::Sweep::keys).
    pub settings: Vec<Setting>,
}

/// Parameters of a law with their covariance, of the JSON file of `gelbench materials fit`.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedParameters {
    keys: Vec<String>,
    units: Vec<String>,
    values: DVector<f64>,
    /// L with Cov = L Lᵀ.
    factor: DMatrix<f64>,
}

impl FittedParameters {
    /// Reads the parameters.
    ///
    /// # Errors
    /// A description of a text that is not a fit, or of a fit without uncertainty.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostic> {
        const HINT: &str =
            "take the JSON file that `gelbench materials fit` writes beside the card";
        let wrong = |what: &str| Diagnostic::error(file, what.to_owned()).hint(HINT);
        let fit: Value = serde_json::from_str(text).map_err(|_| wrong("is not JSON"))?;
        let parameters = fit["parameters"].as_array();
        let parameters = parameters.ok_or_else(|| wrong("contains no `parameters`"))?;
        // What was held and not fitted has no uncertainty.
        let numbered = parameters.iter().enumerate();
        let fitted = numbered.filter(|(_, one)| one["held"] != true);
        let (indices, parameters): (Vec<usize>, Vec<Value>) =
            fitted.map(|(index, one)| (index, one.clone())).unzip();
        let parameters = &parameters[..];
        let texts = |key: &str| -> Option<Vec<String>> {
            let all = parameters
                .iter()
                .map(|one| Some(one[key].as_str()?.to_owned()));
            all.collect()
        };
        let numbers = |key: &str| -> Option<Vec<f64>> {
            parameters.iter().map(|one| one[key].as_f64()).collect()
        };
        let (keys, units) = texts("key")
            .zip(texts("unit"))
            .ok_or_else(|| wrong("contains parameters without keys or units"))?;
        let values = numbers("value").ok_or_else(|| wrong("contains parameters without values"))?;
        let errors =
            numbers("standard_error").ok_or_else(|| without_errors(file, &fit, parameters))?;
        let errors = widened(&errors, parameters);
        let correlation = |i: usize, j: usize| fit["correlation"][indices[i]][indices[j]].as_f64();
        let count = keys.len();
        let mut covariance = DMatrix::zeros(count, count);
        for i in 0..count {
            for j in 0..count {
                let coefficient = correlation(i.max(j), i.min(j))
                    .ok_or_else(|| wrong("contains no complete `correlation`"))?;
                covariance[(i, j)] = errors[i] * coefficient * errors[j];
            }
        }
        let factor = covariance.cholesky();
        let factor =
            factor.ok_or_else(|| wrong("contains a covariance that is not positive definite"))?;
        Ok(Self {
            units: units
                .into_iter()
                .map(|unit| if unit == "–" { String::new() } else { unit })
                .collect(),
            keys,
            values: values.into(),
            factor: factor.l(),
        })
    }

    /// The keys of a study for them.
    pub fn keys(&self) -> impl Iterator<Item = String> {
        self.keys.iter().map(|key| format!("material.{key}"))
    }

    fn at(&self, point: &[f64]) -> Vec<Setting> {
        let quantiles = point.iter().map(|share| normal_quantile(*share));
        let normal = DVector::from_iterator(self.values.len(), quantiles);
        let values = &self.values + &self.factor * normal;
        let units = self.units.iter().cloned();
        values
            .iter()
            .zip(units)
            .map(|(value, unit)| Setting::Number(*value, unit))
            .collect()
    }
}

/// Standard deviations of normal distributions with the 95 % intervals of a fit, which reach farther than 1.96 standard errors where data are few.
fn widened(errors: &[f64], parameters: &[Value]) -> Vec<f64> {
    let deviation = |(error, one): (&f64, &Value)| {
        let end = |index: usize| one["interval_95_percent"][index].as_f64();
        let half = end(1).zip(end(0)).map(|(high, low)| 0.5 * (high - low));
        half.map_or(*error, |half| half / normal_reach())
    };
    errors.iter().zip(parameters).map(deviation).collect()
}

/// Why the parameters of a fit have no standard errors, and what to do.
fn without_errors(file: &str, fit: &Value, parameters: &[Value]) -> Diagnostic {
    let held: Vec<&str> = parameters
        .iter()
        .filter(|one| one["at_bound"] == true)
        .filter_map(|one| one["key"].as_str())
        .collect();
    let (reason, hint) = match fit["verdict"]["answer"].as_str() {
        Some("systematic") => (
            "the residual is systematic, not noise".to_owned(),
            "fit a law that follows the data, or vary its parameters by ranges of your own",
        ),
        Some("rounding") => (
            "the residual is no more than the rounding of its data".to_owned(),
            "without noise in its data there is no standard error: vary its parameters by ranges of your own",
        ),
        _ if !held.is_empty() => (
            format!("{} at a bound", held.join(", ")),
            "widen the bound, or fit a law with fewer parameters",
        ),
        _ => (
            "the scatter of its data is not known".to_owned(),
            "fit it to more points, or vary its parameters by ranges of your own",
        ),
    };
    let message = format!("its parameters have no standard errors: {reason}");
    Diagnostic::error(file, message).hint(hint)
}

/// Refuses an empty list of keys, a key twice, and a key within another.
pub fn check_keys(keys: &[String]) -> Result<(), Diagnostic> {
    if keys.is_empty() {
        let fault = Diagnostic::error("", "nothing is varied");
        return Err(
            fault.hint("give --vary KEY=VALUES, such as --vary \"material.c10=0.04..0.06 MPa:20\"")
        );
    }
    for (index, key) in keys.iter().enumerate() {
        let within = |other: &String| {
            let rest = other.strip_prefix(key.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        if keys
            .iter()
            .enumerate()
            .any(|(at, other)| at != index && within(other))
        {
            let fault = Diagnostic::error("", format!("`{key}` is varied twice"));
            return Err(fault.hint("give every key once"));
        }
    }
    Ok(())
}

/// What is set in every run: combinations in the order of the variables, the last one changing fastest, and for each of them the
/// same points, which are drawn or given.
pub fn rows(
    variables: &[Variable],
    points: Option<&Points>,
    fitted: Option<&FittedParameters>,
    sampling: Sampling,
) -> Result<Vec<Vec<Setting>>, Diagnostic> {
    let drawn = variables
        .iter()
        .filter(|variable| !matches!(variable.values, Values::Listed(_)));
    let fitted_count = fitted.map_or(0, |fitted| fitted.keys.len());
    let dimensions = drawn.count() + fitted_count;
    let samples = match points {
        Some(points) if dimensions == 0 && sampling.samples.is_none() => points.rows().len(),
        Some(_) => {
            let fault = Diagnostic::error("", "points are given, and others are to be drawn");
            return Err(fault.hint("leave out distributions, --samples and --fit, or --points"));
        }
        None => points_to_draw(sampling, dimensions)?,
    };
    let runs = variables.iter().try_fold(samples, |count, variable| {
        count.checked_mul(match &variable.values {
            Values::Listed(values) => values.len(),
            _ => 1,
        })
    });
    if runs.is_none_or(|count| count > MOST_RUNS) {
        let fault = Diagnostic::error("", "there are more than a million runs");
        return Err(fault.hint("take fewer values, or draw points of distributions"));
    }
    let shares: Vec<Vec<f64>> = (0..samples)
        .map(|index| point(index, dimensions, sampling))
        .collect();
    let mut all = Vec::new();
    for combination in &combinations(variables) {
        for (index, shares) in shares.iter().enumerate() {
            let mut settings = row(variables, fitted, combination, shares);
            settings.extend(
                points
                    .iter()
                    .flat_map(|points| points.rows()[index].clone()),
            );
            all.push(settings);
        }
    }
    Ok(all)
}

/// The combinations of all listed values, those of the last variable changing fastest.
fn combinations(variables: &[Variable]) -> Vec<Vec<Setting>> {
    let mut all: Vec<Vec<Setting>> = vec![Vec::new()];
    for variable in variables {
        if let Values::Listed(values) = &variable.values {
            all = all
                .iter()
                .flat_map(|before| {
                    values
                        .iter()
                        .map(move |value| [&before[..], std::slice::from_ref(value)].concat())
                })
                .collect();
        }
    }
    all
}

/// The number of points drawn from so many distributions: one where there are none.
fn points_to_draw(sampling: Sampling, dimensions: usize) -> Result<usize, Diagnostic> {
    let samples = match (sampling.samples, dimensions) {
        (None, 0) => 1,
        (Some(0), _) => {
            let fault = Diagnostic::error("", "no points are to be drawn");
            return Err(fault.hint("give --samples a number above zero, such as --samples 256"));
        }
        (Some(samples), 1..) => samples,
        (None, _) => {
            let fault = Diagnostic::error(
                "",
                "distributions are given, but not how many points to draw from them",
            );
            return Err(fault.hint(
                "give --samples, such as --samples 256, or a number of values: LOW..HIGH:20",
            ));
        }
        (Some(_), 0) => {
            let fault =
                Diagnostic::error("", "points are to be drawn, but there is no distribution");
            return Err(fault
                .hint("leave out --samples, or give KEY=LOW..HIGH, KEY=MEAN+-DEVIATION or --fit"));
        }
    };
    if sampling.method == Method::Sobol
        && (samples > MOST_OF_SOBOL || dimensions > SOBOL_DIMENSIONS)
    {
        let message = format!(
            "Sobol's sequence has at most {MOST_OF_SOBOL} points of {SOBOL_DIMENSIONS} distributions here"
        );
        return Err(Diagnostic::error("", message).hint("draw them with --method random"));
    }
    Ok(samples)
}

fn row(
    variables: &[Variable],
    fitted: Option<&FittedParameters>,
    listed: &[Setting],
    point: &[f64],
) -> Vec<Setting> {
    let (mut listed, mut shares) = (listed.iter(), point.iter());
    let mut settings: Vec<Setting> = Vec::with_capacity(variables.len());
    for variable in variables {
        let drawn = match &variable.values {
            Values::Listed(_) => listed.next().cloned(),
            Values::Between([low, high], unit) => shares
                .next()
                .map(|share| Setting::Number(low + share * (high - low), unit.clone())),
            Values::Normal([mean, deviation], unit) => shares.next().map(|share| {
                Setting::Number(mean + deviation * normal_quantile(*share), unit.clone())
            }),
        };
        settings.extend(drawn);
    }
    settings.extend(
        fitted
            .iter()
            .flat_map(|fitted| fitted.at(shares.as_slice())),
    );
    settings
}

/// A point of (0, 1)ⁿ.
fn point(index: usize, dimensions: usize, sampling: Sampling) -> Vec<f64> {
    const INSIDE: f64 = 1e-9;
    let share = |dimension: usize| match sampling.method {
        Method::Sobol => f64::from(sobol_burley::sample(
            index as u32,
            dimension as u32,
            sampling.seed,
        )),
        Method::Random => {
            let mut random = ChaCha8Rng::seed_from_u64(u64::from(sampling.seed));
            random.set_stream(dimension as u64);
            random.set_word_pos(2 * index as u128);
            random.random()
        }
    };
    (0..dimensions)
        .map(|dimension| share(dimension).clamp(INSIDE, 1.0 - INSIDE))
        .collect()
}
