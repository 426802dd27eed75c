//! How far a fit can be trusted.

use nalgebra::DMatrix;

use super::verdict::Verdict;
use crate::calibration::data::{Observation, Test, TestData};
use crate::calibration::regression::{MovedZero, Zero};
use crate::calibration::settings::Weighting;
use crate::material::HyperelasticLaw;
use crate::material::curve::Mode;
use crate::material::stability::{SEARCHED, stable_range};
use crate::statistics::{CurveNoise, Estimate, extremes, farthest};

/// Whether the interval of an estimate excludes the opposite sign.
pub fn has_known_sign(estimate: &Estimate) -> bool {
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

/// One less rounding.
const BARELY: f64 = 1.0 - 1e-9;

impl StableRange {
    /// Whether the law is stable in the needed range, as far as stability is searched for; compression counts in uniaxial tests alone.
    pub fn is_enough(&self) -> bool {
        let ([low, high], [from, to]) = (self.stretches, self.needed);
        let [least, most] = SEARCHED;
        high >= to.min(BARELY * most)
            && (self.mode != Mode::Uniaxial || low <= from.max(least / BARELY))
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
    /// −2 ln L + 2k + 2k(k + 1)/(n − k − 1), L the likelihood of the stresses by noise that may correlate
    /// ([`CurveResiduals`](crate::statistics::CurveResiduals)), n the rows that are fitted, and k the parameters and the variance; infinite
    /// where there are too few rows.
    pub aicc: f64,
    /// Largest |σᵢ − σ|/|σᵢ| in %, of the stresses above a hundredth of their test's largest.
    pub largest_relative_error_percent: f64,
    /// The verdict on the residuals; `None` where no parameter is estimated.
    pub verdict: Option<Verdict>,
    /// One for each parameter; uncertainties are NaN where it is at a bound. They are valid where [`Self::has_intervals`].
    pub estimates: Vec<Estimate>,
    /// Whether it is at a bound, for each parameter.
    pub at_bound: Vec<bool>,
    /// Whether it is held at a value that was stated or that no test determines, for each parameter.
    pub held: Vec<bool>,
    /// Whether a value is not estimated at all, for each parameter and zero.
    pub(in crate::calibration) fixed: Vec<bool>,
    /// Zeros of the tests that were found again with the law.
    pub zeros: Vec<MovedZero>,
    /// Correlation of the parameters.
    pub correlation: DMatrix<f64>,
    /// The noise, which gives the uncertainty of the estimated values: parameters, followed by zeros.
    pub noise: Option<CurveNoise>,
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
    /// Whether the residuals are noise, so that there are intervals.
    pub fn has_intervals(&self) -> bool {
        self.verdict
            .is_none_or(|verdict| verdict.answer.has_intervals())
    }

    /// The same with the last estimates taken as those of zeros.
    pub(in crate::calibration) fn with_zeros(mut self, zeros: &[Zero]) -> Self {
        let parameters = self.estimates.len() - zeros.len();
        let of_zeros = self.estimates.drain(parameters..);
        let pairs = zeros.iter().zip(of_zeros);
        self.zeros = pairs
            .map(|(zero, value)| MovedZero::new(*zero, &value))
            .collect();
        self.at_bound.truncate(parameters);
        self.held.truncate(parameters);
        self.correlation = self.correlation.resize(parameters, parameters, f64::NAN);
        self
    }

    /// Whether the law is nearer to the data than their mean is, or nearer than no stress at all, whose mean deviation is 100 %.
    pub fn follows_data(&self) -> bool {
        const FAR_PERCENT: f64 = 90.0;
        self.r_squared >= 0.0 || self.nmad_percent < FAR_PERCENT
    }

    /// The number of independent points with the same information on the noise.
    pub fn effective_points(&self) -> f64 {
        let effective = self.verdict.map(|verdict| verdict.effective_points);
        effective.unwrap_or(self.points as f64)
    }

    /// Whether no fitted parameter is at a bound or has an interval that includes zero.
    pub fn is_identifiable(&self) -> bool {
        let mut pairs = self.estimates.iter().zip(&self.held);
        pairs.all(|(estimate, held)| *held || has_known_sign(estimate))
    }

    /// Whether the law is stable in the uniaxial, planar and equibiaxial tests as far as the data go.
    pub fn is_stable(&self) -> bool {
        self.stable.iter().all(StableRange::is_enough)
    }
}

/// The mean squares of the weighted residuals by rounding of the stresses (at least a negligible one), and by rounding of strains and
/// stresses.
pub fn rounded(tests: &[TestData], law: &dyn HyperelasticLaw, weighting: Weighting) -> [f64; 2] {
    const NEGLIGIBLE: f64 = 1e-6;
    let (mut sums, mut count) = ([0.0; 2], 0);
    for test in tests {
        let [strain, stress] = test.rounding;
        for one in &test.observations {
            let size = farthest(one.strains).abs();
            let moved = Observation {
                strains: one.strains.map(|x| x * (1.0 + strain / size.max(strain))),
                ..*one
            };
            let by_strain = if strain > 0.0 {
                test.stress_of(law, &moved) - test.stress_of(law, one)
            } else {
                0.0
            };
            let negligible = NEGLIGIBLE * test.largest_stress;
            let square = stress * stress + negligible * negligible;
            let weight = weighting.weight_of(test, one.stress).powi(2);
            sums[0] += weight * square;
            sums[1] += weight * (square + by_strain.powi(2));
            count += 1;
        }
    }
    sums.map(|sum| sum / f64::from(count))
}

/// The stretches within which a law is stable in the usual tests.
pub fn stable_ranges(law: &dyn HyperelasticLaw, tests: &[TestData]) -> Vec<StableRange> {
    let range = |(_, mode): (&str, Mode)| {
        let of_mode = || tests.iter().filter(|data| is_of(data, mode));
        StableRange {
            mode,
            stretches: stable_range(law, mode),
            needed: match of_mode().next() {
                Some(_) => stretch_range(of_mode()),
                None => stretch_range(tests.iter()),
            },
        }
    };
    Mode::ALL.into_iter().map(range).collect()
}

/// The stretches between which the data of some tests lie.
pub fn stretch_range<'a>(tests: impl Iterator<Item = &'a TestData>) -> [f64; 2] {
    extremes(tests.flat_map(TestData::stretch_range).chain([1.0]))
}

/// The usual tests that no data cover.
pub fn untested(tests: &[TestData]) -> Vec<Mode> {
    let modes = Mode::ALL.into_iter().map(|(_, mode)| mode);
    let untested = modes.filter(|mode| !tests.iter().any(|data| is_of(data, *mode)));
    untested.collect()
}

/// Whether data are of one of the usual tests, or of a biaxial one whose protocols lie on both sides of it.
fn is_of(data: &TestData, mode: Mode) -> bool {
    match data.test {
        Test::Uniaxial => mode == Mode::Uniaxial,
        Test::Planar => mode == Mode::Planar,
        Test::Equibiaxial => mode == Mode::Equibiaxial,
        Test::Biaxial => covers(data, mode),
        Test::SimpleShear => false,
    }
}

/// Whether the protocols of a biaxial test cover a mode by k = ln λ₂/ln λ₁, λ₁ the stretch that is farther from rest.
fn covers(data: &TestData, mode: Mode) -> bool {
    /// Grips and slack move a protocol by as much.
    const NEAR: f64 = 0.1;
    let wanted = match mode {
        Mode::Uniaxial => -0.5,
        Mode::Planar => 0.0,
        Mode::Equibiaxial => 1.0,
    };
    let ratios = data.protocols().into_iter().map(|protocol| {
        let [a, b] = Observation::farthest_strains(protocol).map(|x| x.ln_1p());
        if a.abs() >= b.abs() { b / a } else { a / b }
    });
    let [low, high] = extremes(ratios.filter(|ratio| ratio.is_finite()));
    (low - NEAR..=high + NEAR).contains(&wanted)
}
