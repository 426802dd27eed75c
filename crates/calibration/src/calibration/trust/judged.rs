//! What a fit has left, judged alike for laws, Prony series and softening.

use nalgebra::{DMatrix, DVector};

use super::quality::{Deviations, Quality, aicc, stable_ranges, stretch_range, untested};
use super::verdict::{LeftOver, Verdict};
use crate::calibration::data::TestData;
use crate::calibration::least_squares::{self, LEAST_SIZE, Measured};
use crate::calibration::regression::{Reweighed, Rows};
use crate::calibration::settings::SMALLEST_SHARE;
use crate::material::HyperelasticLaw;
use crate::statistics::{CurveNoise, Estimate};

/// How near to its bound a value is held by it where the search ends a little inside: a share, and the least size that counts.
pub const AT_BOUND: [f64; 2] = [1e-6, 1e-9];

/// Which values lie at their bounds, within a share of their size and of the least size that counts.
pub fn at_bound(values: &[f64], bounds: &[[f64; 2]], [share, least]: [f64; 2]) -> Vec<bool> {
    let held = |(value, [low, high]): (&f64, &[f64; 2])| {
        let near = |limit: f64| (value - limit).abs() <= share * value.abs().max(least);
        near(*low) || near(*high)
    };
    values.iter().zip(bounds).map(held).collect()
}

/// The values of a fit.
pub struct Values<'a> {
    pub values: &'a [f64],
    /// Which of them a bound holds.
    pub at_bound: Vec<bool>,
    /// Which of them are not estimated at all.
    pub fixed: Vec<bool>,
    /// The least size of each that counts.
    pub least: Vec<f64>,
}

impl<'a> Values<'a> {
    /// Values of which those at bounds are not estimated.
    pub fn held(values: &'a [f64], at_bound: Vec<bool>) -> Self {
        Self {
            values,
            fixed: at_bound.clone(),
            at_bound,
            least: vec![LEAST_SIZE; values.len()],
        }
    }
}

/// The size of the noise that the weights do not suit: one that is the same everywhere where they are relative, else one that is
/// proportional to the stress.
fn other_size(measured: &[Measured], residual: &DVector<f64>, is_relative: bool) -> DVector<f64> {
    let rows = measured.iter().zip(residual.iter());
    let stresses: Vec<f64> = rows.map(|(one, own)| one.modelled(*own).abs()).collect();
    let least = SMALLEST_SHARE * stresses.iter().copied().fold(0.0, f64::max);
    DVector::from_fn(measured.len(), |row, _| {
        if is_relative {
            measured[row].weight
        } else {
            stresses[row].max(least)
        }
    })
}

/// What the residuals of a fit are.
pub struct Judged {
    /// Which values a bound holds.
    pub at_bound: Vec<bool>,
    /// Which values are not estimated at all.
    pub fixed: Vec<bool>,
    /// `None` where nothing is estimated, or no freedom is left.
    pub verdict: Option<Verdict>,
    /// What the values are worth that are estimated; `None` likewise.
    pub noise: Option<CurveNoise>,
    /// The sum of squares of the residuals.
    pub sum_of_squares: f64,
    /// −2 ln of the likelihood of the measured stresses.
    surprise: f64,
    rows: usize,
}

impl Judged {
    /// Of the residuals at some values, in the order of their curves; `rounded` are the mean squares that
    /// rounding alone leaves, see [`LeftOver`].
    pub fn of<M: Reweighed>(
        misfit: &M,
        curves: Vec<Rows>,
        found: Values,
        rounded: [f64; 2],
    ) -> Self {
        let Values {
            values,
            at_bound,
            fixed,
            least,
        } = found;
        let jacobian = least_squares::jacobian(misfit, values, &fixed, &least);
        let free: Vec<usize> = (0..values.len()).filter(|index| !fixed[*index]).collect();
        let mut residual = DVector::zeros(misfit.count());
        misfit.evaluate(values, residual.as_mut_slice());
        let measured = misfit.measured();
        let judged = jacobian.and_then(|jacobian| {
            let left_over = LeftOver {
                curves,
                design: &jacobian.select_columns(&free),
                residual: &residual,
                other_size: &other_size(&measured, &residual, misfit.is_relative()),
                rounded: rounded.map(|mean| mean * residual.len() as f64),
            };
            left_over.judge()
        });
        let (verdict, noise): (_, Option<CurveNoise>) = judged.unzip();
        let (rows, sum_of_squares) = (residual.len(), residual.norm_squared());
        let white = || rows as f64 * (sum_of_squares / rows as f64).ln();
        let of_residuals = noise.as_ref().map_or_else(white, CurveNoise::surprise);
        // The residuals of a relative fit are those of the stresses times their weights.
        let weights = measured.iter().map(|one| one.weight.ln());
        Self {
            at_bound,
            fixed,
            verdict,
            noise,
            sum_of_squares,
            surprise: of_residuals - 2.0 * weights.sum::<f64>(),
            rows,
        }
    }

    /// AICc of so many estimates and the variance.
    pub fn aicc(&self, estimates: usize) -> f64 {
        aicc(self.surprise, self.rows as f64, (estimates + 1) as f64)
    }

    /// Whether they are noise.
    pub fn is_noise(&self) -> bool {
        self.verdict
            .is_some_and(|verdict| verdict.answer.has_intervals())
    }

    /// The number of independent points that tell as much of the noise as so many do.
    pub fn effective(&self, points: f64) -> f64 {
        self.verdict
            .map_or(points, |verdict| verdict.effective_points)
    }

    /// The values with their uncertainty, NaN where a bound holds them, and their correlation.
    pub fn estimates(&self, values: &[f64]) -> (Vec<Estimate>, DMatrix<f64>) {
        let size = values.len();
        let mut correlation = DMatrix::from_element(size, size, f64::NAN);
        let mut estimates: Vec<Estimate> = values
            .iter()
            .map(|value| Estimate::new(*value, f64::NAN, f64::NAN))
            .collect();
        let Some(noise) = &self.noise else {
            return (estimates, correlation);
        };
        let free: Vec<usize> = (0..size).filter(|index| !self.fixed[*index]).collect();
        let covariance = noise.covariance();
        let error = |i: usize| covariance[(i, i)].sqrt();
        let is_known = |(_, index): &(usize, &usize)| !self.at_bound[**index];
        for (i, row) in free.iter().enumerate().filter(is_known) {
            let unit = DVector::from_fn(free.len(), |j, _| f64::from(u8::from(i == j)));
            let reach = noise.half_width(&unit) / error(i);
            estimates[*row] = Estimate::new(values[*row], error(i), reach);
            for (j, column) in free.iter().enumerate().filter(is_known) {
                correlation[(*row, *column)] = covariance[(i, j)] / (error(i) * error(j));
            }
        }
        (estimates, correlation)
    }

    /// The figures of a fit of a law to tests, without warnings.
    pub fn quality(
        self,
        law: &dyn HyperelasticLaw,
        tests: &[TestData],
        deviations: &Deviations,
        (estimates, correlation): (Vec<Estimate>, DMatrix<f64>),
    ) -> Quality {
        let points: usize = tests.iter().map(|test| test.observations.len()).sum();
        Quality {
            points,
            sum_of_squares: deviations.squares,
            rmse: (deviations.squares / points as f64).sqrt(),
            nmad_percent: deviations.nmad_percent(),
            r_squared: 1.0 - deviations.squares / deviations.spread,
            aicc: self.aicc(estimates.len()),
            largest_relative_error_percent: 100.0 * deviations.largest_relative,
            verdict: self.verdict,
            estimates,
            correlation,
            at_bound: self.at_bound,
            fixed: self.fixed,
            zeros: Vec::new(),
            noise: self.noise,
            stable: stable_ranges(law, tests),
            stretch_range: stretch_range(tests.iter()),
            untested: untested(tests),
            warnings: Vec::new(),
        }
    }
}
