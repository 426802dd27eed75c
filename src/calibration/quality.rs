//! How far a fit can be trusted.

use nalgebra::DMatrix;

use super::least_squares;
use super::misfit::Misfit;
use super::settings::{SMALLEST_SHARE, Weighting};
use super::test_data::{Test, TestData};
use crate::material::HyperelasticLaw;
use crate::material::curve::Mode;
use crate::material::stability::stable_range;
use crate::statistics::{self, Estimate, student_reach};

/// Whether the interval of an estimate does not hold zero.
pub(super) fn knows_sign(estimate: &Estimate) -> bool {
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

/// What is assessed: a law with its values and the tests that it was fitted to.
pub(super) struct Assessment<'a> {
    pub misfit: &'a Misfit<'a>,
    pub weighting: Weighting,
    pub tests: &'a [TestData],
    pub law: &'a dyn HyperelasticLaw,
    pub values: &'a [f64],
    /// Lower and upper limit of each value.
    pub bounds: &'a [[f64; 2]],
}

impl Assessment<'_> {
    /// The figures of the fit, without warnings.
    pub fn quality(&self) -> Quality {
        let values = self.values;
        let points = self.tests.iter().map(|test| test.observations.len()).sum();
        let deviations = Deviations::of(self.tests, self.weighting, self.law);
        let freedom = (points - values.len()) as f64;
        let student = student_reach(freedom);
        let at_bound = self.at_bound();
        let covariance = self.covariance(&at_bound, deviations.weighted / freedom);
        let error = |i: usize| match at_bound[i] {
            true => f64::NAN,
            false => covariance[(i, i)].sqrt(),
        };
        let estimates = values.iter().enumerate();
        let estimates = estimates.map(|(i, value)| Estimate::new(*value, error(i), student));
        let n = points as f64;
        Quality {
            points,
            sum_of_squares: deviations.squares,
            rmse: (deviations.squares / n).sqrt(),
            nmad_percent: 100.0 * deviations.absolute
                / deviations.measured.max(deviations.predicted),
            r_squared: 1.0 - deviations.squares / deviations.spread,
            aicc: aicc(deviations.weighted, n, (values.len() + 1) as f64),
            largest_relative_error_percent: 100.0 * deviations.largest_relative,
            estimates: estimates.collect(),
            correlation: DMatrix::from_fn(values.len(), values.len(), |i, j| {
                covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
            }),
            at_bound,
            covariance,
            student,
            stable: self.stable(),
            stretch_range: stretch_range(self.tests.iter()),
            untested: untested(self.tests),
            warnings: Vec::new(),
        }
    }

    fn at_bound(&self) -> Vec<bool> {
        let at_bound = |(value, [low, high]): (&f64, &[f64; 2])| {
            let near = |limit: f64| (value - limit).abs() <= 1e-9 * value.abs().max(1e-300);
            near(*low) || near(*high)
        };
        self.values.iter().zip(self.bounds).map(at_bound).collect()
    }

    /// The covariance of the values that no bound holds; NaN for the others.
    fn covariance(&self, fixed: &[bool], variance: f64) -> DMatrix<f64> {
        let size = self.values.len();
        let free: Vec<usize> = (0..size).filter(|index| !fixed[*index]).collect();
        let mut covariance = DMatrix::from_element(size, size, f64::NAN);
        if free.is_empty() {
            return covariance;
        }
        let jacobian = least_squares::jacobian(self.misfit, self.values, fixed);
        if let Some(own) = statistics::covariance(jacobian.select_columns(&free), variance) {
            for (i, row) in free.iter().enumerate() {
                for (j, column) in free.iter().enumerate() {
                    covariance[(*row, *column)] = own[(i, j)];
                }
            }
        }
        covariance
    }

    fn stable(&self) -> Vec<StableRange> {
        let range = |(_, mode): (&str, Mode)| {
            let own = || self.tests.iter().filter(|data| is_of(data, mode));
            StableRange {
                mode,
                stretches: stable_range(self.law, mode),
                needed: match own().next() {
                    Some(_) => stretch_range(own()),
                    None => stretch_range(self.tests.iter()),
                },
            }
        };
        Mode::ALL.into_iter().map(range).collect()
    }
}

/// n ln(S/n) + 2k + 2k(k + 1)/(n − k − 1); infinite where there are too few points.
fn aicc(sum: f64, n: f64, k: f64) -> f64 {
    match n - k - 1.0 > 0.0 {
        true => n * (sum / n).ln() + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0),
        false => f64::INFINITY,
    }
}

/// The stretches between which the data of some tests lie.
fn stretch_range<'a>(tests: impl Iterator<Item = &'a TestData>) -> [f64; 2] {
    tests
        .map(TestData::stretch_range)
        .fold([1.0, 1.0], |all, one| {
            [all[0].min(one[0]), all[1].max(one[1])]
        })
}

/// Sums over all observations.
#[derive(Default)]
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
        let mut sums = Self::default();
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
