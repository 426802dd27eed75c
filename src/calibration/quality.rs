//! How far a fit can be trusted.

use nalgebra::DMatrix;

use super::fit::{SMALLEST_SHARE, Weighting};
use super::least_squares;
use super::misfit::Misfit;
use super::test_data::{Test, TestData};
use crate::material::HyperelasticLaw;
use crate::material::curve::Mode;
use crate::material::parameters::Parameter;
use crate::material::stability::stable_range;
use crate::statistics::{self, Estimate, student_reach};

/// Whether the interval of an estimate does not hold zero.
fn knows_sign(estimate: &Estimate) -> bool {
    let [low, high] = estimate.interval;
    if estimate.value > 0.0 {
        low >= 0.0
    } else {
        high <= 0.0
    }
}

/// The stretches within which the fitted law is stable in one test (Drucker).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StableRange {
    /// The test.
    pub mode: Mode,
    /// First and last stretch.
    pub stretches: [f64; 2],
    /// The stretches within which it should be: those of the data of this test, or of all data where there are none.
    pub needed: [f64; 2],
}

impl StableRange {
    /// Whether the law is stable as far as it should be; pressing counts in uniaxial tests alone.
    pub fn is_enough(&self) -> bool {
        let ([low, high], [from, to]) = (self.stretches, self.needed);
        high >= to && (self.mode != Mode::Uniaxial || low <= from)
    }
}

/// The figures of a fit.
#[derive(Clone, Debug)]
pub struct Quality {
    /// Number of observations.
    pub points: usize,
    /// Σ (σᵢ − σ)² in MPa², without weights.
    pub sum_of_squares: f64,
    /// √(Σ (σᵢ − σ)²/n) in MPa.
    pub rmse: f64,
    /// Normalised mean absolute difference of all observations, 100 Σ |σᵢ − σ| / max(Σ |σᵢ|, Σ |σ|): the larger of the means of
    /// data and law normalises it (J. Bergström, Mechanics of Solid Polymers, 2015, chapter 9).
    pub nmad_percent: f64,
    /// 1 − Σ (σᵢ − σ)² / Σ (σᵢ − mean)².
    pub r_squared: f64,
    /// n ln(S/n) + 2k + 2k(k + 1)/(n − k − 1), S the weighted sum of squares and k the parameters and the variance.
    pub aicc: f64,
    /// Largest |σᵢ − σ|/|σᵢ| in %, of the stresses above a hundredth of their test's largest.
    pub largest_relative_error_percent: f64,
    /// One for each parameter; uncertainties are NaN where a bound holds it.
    pub estimates: Vec<Estimate>,
    /// Whether a bound holds it, for each parameter.
    pub at_bound: Vec<bool>,
    /// Correlation of the parameters.
    pub correlation: DMatrix<f64>,
    /// Covariance of the parameters.
    pub covariance: DMatrix<f64>,
    /// Half the width of 95 % intervals over standard errors.
    pub student: f64,
    /// The stable ranges.
    pub stable: Vec<StableRange>,
    /// The stretches between which the data lie.
    pub stretch_range: [f64; 2],
    /// Tests that no data cover: their stresses are predictions.
    pub untested: Vec<Mode>,
    /// What a user must know before using the fit.
    pub warnings: Vec<String>,
}

impl Quality {
    /// Whether no parameter is held by a bound or has an interval that holds zero.
    pub fn is_identifiable(&self) -> bool {
        self.estimates.iter().all(knows_sign)
    }

    /// Whether the law is stable in the uniaxial, planar and equibiaxial tests as far as the data go.
    pub fn is_stable(&self) -> bool {
        self.stable.iter().all(StableRange::is_enough)
    }
}

pub(super) fn assess(
    misfit: &Misfit,
    weighting: Weighting,
    tests: &[TestData],
    law: &dyn HyperelasticLaw,
    parameters: &[Parameter],
    bounds: &[[f64; 2]],
    other: Option<&[f64]>,
) -> Quality {
    let values: Vec<f64> = parameters.iter().map(|parameter| parameter.value).collect();
    let points = tests.iter().map(|test| test.observations.len()).sum();
    let deviations = Deviations::of(tests, weighting, law);
    let at_bound: Vec<bool> = values
        .iter()
        .zip(bounds)
        .map(|(value, [low, high])| {
            let near = |limit: f64| (value - limit).abs() <= 1e-9 * value.abs().max(1e-300);
            near(*low) || near(*high)
        })
        .collect();
    let weighted = deviations.weighted;
    let freedom = points - parameters.len();
    let covariance = covariance(misfit, &values, &at_bound, weighted / freedom as f64);
    let student = student_reach(freedom as f64);
    let estimates: Vec<Estimate> = values
        .iter()
        .enumerate()
        .map(|(i, value)| {
            let error = if at_bound[i] {
                f64::NAN
            } else {
                covariance[(i, i)].sqrt()
            };
            Estimate::new(*value, error, student)
        })
        .collect();
    let correlation = DMatrix::from_fn(values.len(), values.len(), |i, j| {
        covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
    });
    let k = (parameters.len() + 1) as f64;
    let n = points as f64;
    let range = |tests: &mut dyn Iterator<Item = &TestData>| {
        let ranges = tests.map(TestData::stretch_range);
        ranges.fold([1.0_f64, 1.0_f64], |all, one| {
            [all[0].min(one[0]), all[1].max(one[1])]
        })
    };
    let stretch_range = range(&mut tests.iter());
    let stable = Mode::ALL.map(|(_, mode)| {
        let mut own = tests.iter().filter(|data| is_of(data, mode)).peekable();
        let needed = if own.peek().is_some() {
            range(&mut own)
        } else {
            stretch_range
        };
        StableRange {
            mode,
            stretches: stable_range(law, mode),
            needed,
        }
    });
    let mut quality = Quality {
        points,
        sum_of_squares: deviations.squares,
        rmse: (deviations.squares / n).sqrt(),
        nmad_percent: 100.0 * deviations.absolute / deviations.measured.max(deviations.predicted),
        r_squared: 1.0 - deviations.squares / deviations.spread,
        aicc: n * (weighted / n).ln() + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0),
        largest_relative_error_percent: 100.0 * deviations.largest_relative,
        estimates,
        at_bound,
        correlation,
        covariance,
        student,
        stable: stable.to_vec(),
        stretch_range,
        untested: untested(tests),
        warnings: Vec::new(),
    };
    if n - k - 1.0 <= 0.0 {
        quality.aicc = f64::INFINITY;
    }
    quality.warnings = warnings(&quality, parameters, other);
    quality
}

/// Sums over all observations.
struct Deviations {
    squares: f64,
    weighted: f64,
    absolute: f64,
    /// Σ |σᵢ|.
    measured: f64,
    /// Σ |σ|.
    predicted: f64,
    spread: f64,
    largest_relative: f64,
}

impl Deviations {
    fn of(tests: &[TestData], weighting: Weighting, law: &dyn HyperelasticLaw) -> Self {
        let mut sums = Self {
            squares: 0.0,
            weighted: 0.0,
            absolute: 0.0,
            measured: 0.0,
            predicted: 0.0,
            spread: 0.0,
            largest_relative: 0.0,
        };
        let all = || tests.iter().flat_map(|test| &test.observations);
        let mean = all().map(|one| one.stress).sum::<f64>() / all().count() as f64;
        for test in tests {
            let least = SMALLEST_SHARE * test.largest_stress;
            for one in &test.observations {
                let predicted = test.stress_of(law, one);
                let difference = (one.stress - predicted).abs();
                sums.squares += difference * difference;
                sums.weighted += (weighting.weight(test, one) * difference).powi(2);
                sums.absolute += difference;
                sums.measured += one.stress.abs();
                sums.predicted += predicted.abs();
                sums.spread += (one.stress - mean).powi(2);
                if one.stress.abs() > least {
                    sums.largest_relative =
                        sums.largest_relative.max(difference / one.stress.abs());
                }
            }
        }
        sums
    }
}

/// The covariance of the parameters that no bound holds; NaN for the others.
fn covariance(misfit: &Misfit, values: &[f64], fixed: &[bool], variance: f64) -> DMatrix<f64> {
    let size = values.len();
    let free: Vec<usize> = (0..size).filter(|index| !fixed[*index]).collect();
    let mut covariance = DMatrix::from_element(size, size, f64::NAN);
    if free.is_empty() {
        return covariance;
    }
    let jacobian = least_squares::jacobian(misfit, values, fixed).select_columns(&free);
    if let Some(own) = statistics::covariance(jacobian, variance) {
        for (i, row) in free.iter().enumerate() {
            for (j, column) in free.iter().enumerate() {
                covariance[(*row, *column)] = own[(i, j)];
            }
        }
    }
    covariance
}

/// The usual tests that no data cover.
fn untested(tests: &[TestData]) -> Vec<Mode> {
    let modes = Mode::ALL.into_iter().map(|(_, mode)| mode);
    let untested = modes.filter(|mode| !tests.iter().any(|data| is_of(data, *mode)));
    untested.collect()
}

/// Whether data are of one of the usual tests.
fn is_of(data: &TestData, mode: Mode) -> bool {
    match data.test {
        Test::Uniaxial => mode == Mode::Uniaxial,
        Test::Planar => mode == Mode::Planar,
        Test::Equibiaxial => mode == Mode::Equibiaxial,
        Test::Biaxial => false,
    }
}

fn warnings(quality: &Quality, parameters: &[Parameter], other: Option<&[f64]>) -> Vec<String> {
    let mut warnings = Vec::new();
    let key = |index: usize| parameters[index].key;
    if quality.nmad_percent > 20.0 {
        warnings.push(format!(
            "the law does not follow the data: they are {:.0} % apart in the mean",
            quality.nmad_percent
        ));
    }
    let mut vague = Vec::new();
    for (index, estimate) in quality.estimates.iter().enumerate() {
        if quality.at_bound[index] {
            let value = estimate.value;
            warnings.push(format!("{} = {value:.4e} is held by a bound", key(index)));
        } else if !knows_sign(estimate) {
            vague.push(key(index));
        }
    }
    if !vague.is_empty() {
        warnings.push(format!(
            "not identifiable from these data: {}, whose 95 % intervals hold zero",
            vague.join(", ")
        ));
    }
    let pairs = (0..parameters.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
    let mut close: Vec<(f64, (usize, usize))> = pairs
        .map(|pair| (quality.correlation[pair], pair))
        .filter(|(correlation, _)| correlation.abs() >= 0.99)
        .collect();
    close.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    if let Some((correlation, (j, i))) = close.first() {
        let more = match close.len() - 1 {
            0 => String::new(),
            more => format!(", and {more} more pairs above 0.99"),
        };
        warnings.push(format!(
            "{} and {} are hardly told apart: their correlation is {correlation:.4}{more}",
            key(*j),
            key(*i)
        ));
    }
    if let Some(other) = other {
        let values: Vec<_> = parameters
            .iter()
            .zip(other)
            .map(|(parameter, value)| format!("{} = {value:.4}", parameter.key))
            .collect();
        warnings.push(format!(
            "the fit is not unique: {} is at most 5 % worse",
            values.join(", ")
        ));
    }
    for range in &quality.stable {
        let ([low, high], [from, to]) = (range.stretches, range.needed);
        let name = range.mode.name();
        if high <= 1.0 || low >= 1.0 {
            warnings.push(format!("the law is unstable from rest in {name} tests"));
        } else if !range.is_enough() {
            warnings.push(format!(
                "the law is stable (Drucker) in {name} tests from λ = {low:.3} to {high:.3} only, the data go from {from:.3} to {to:.3}"
            ));
        }
    }
    if !quality.untested.is_empty() {
        let untested: Vec<_> = quality.untested.iter().map(|mode| mode.name()).collect();
        let all_uniaxial = !quality.untested.contains(&Mode::Uniaxial) && untested.len() == 2;
        warnings.push(format!(
            "{}{} stresses are predictions that no data support",
            if all_uniaxial { "uniaxial only: " } else { "" },
            untested.join(" and ")
        ));
    }
    warnings
}

/// Whether a parameter of another minimum is a tenth away.
pub(super) fn differs(other: &[f64], parameters: &[Parameter]) -> bool {
    let pairs = other.iter().zip(parameters);
    pairs
        .map(|(value, parameter)| {
            (value - parameter.value).abs() / parameter.value.abs().max(1e-300)
        })
        .any(|change| change > 0.1)
}
