//! The residuals of a fit, judged in the same way for laws, Prony series and softening.

use nalgebra::{DMatrix, DVector};

use super::quality::{Quality, rounded, stable_ranges, stretch_range, untested};
use super::verdict::{FitResiduals, Verdict};
use crate::calibration::data::TestData;
use crate::calibration::least_squares::{self, Residuals};
use crate::calibration::regression::{Estimated, Misfit, Response, Row};
use crate::calibration::settings::{SMALLEST_SHARE, Weighting};
use crate::material::HyperelasticLaw;
use crate::statistics::{CurveNoise, Estimate, corrected_akaike_criterion};

/// The size of the noise that the other weighting would suit: the same everywhere where weights are relative, else proportional to the
/// stress.
fn other_size(rows: &[Row], residual: &DVector<f64>, weighting: Weighting) -> DVector<f64> {
    if weighting == Weighting::Relative {
        return DVector::from_iterator(rows.len(), rows.iter().map(Row::observation_weight));
    }
    let pairs = rows.iter().zip(residual.iter());
    let modelled = pairs.map(|(row, residual)| (row.stress - residual / row.weight).abs());
    let modelled = DVector::from_iterator(rows.len(), modelled);
    let least = SMALLEST_SHARE * modelled.iter().copied().fold(0.0, f64::max);
    modelled.map(|stress| stress.max(least))
}

/// The noise of a fit and what the stresses move that were subtracted from tests: with the weights w of a test's rows
///
/// ```text
/// β moves by (JᵀJ)⁻¹ Jᵀ w s          s: the standard error of the test's stress without load
/// ```
fn with_offsets<R: Response>(
    noise: CurveNoise,
    design: &DMatrix<f64>,
    misfit: &Misfit<R>,
) -> CurveNoise {
    let tests = misfit.response.data().iter().enumerate();
    let subtracted = tests.filter(|(_, test)| test.offset_error() > 0.0);
    subtracted.fold(noise, |noise, (number, test)| {
        let weights = misfit.rows.iter().map(|row| {
            let is_of_test = f64::from(u8::from(row.test == number));
            is_of_test * row.weight * test.offset_error()
        });
        let weights = DVector::from_iterator(misfit.rows.len(), weights);
        match least_squares::linear(design, &weights) {
            Some(moved) => noise.with_moved(&moved),
            None => noise,
        }
    })
}

/// The statistics of the residuals of a fit.
pub struct Judged {
    /// Which values are at a bound.
    pub at_bound: Vec<bool>,
    /// Which values are not estimated at all.
    pub fixed: Vec<bool>,
    /// Which values are stated rather than fitted.
    held: Vec<bool>,
    /// `None` where nothing is estimated, or there are no degrees of freedom.
    pub verdict: Option<Verdict>,
    /// The noise, which gives the uncertainty of the estimated values; `None` likewise.
    pub noise: Option<CurveNoise>,
    /// The sum of squares of the residuals.
    sum_of_squares: f64,
    /// −2 ln of the likelihood of the measured stresses.
    deviance: f64,
    rows: usize,
}

impl Judged {
    /// Of the residuals of a model at some values within their bounds.
    pub fn of<R: Response>(misfit: &Misfit<R>, values: &[f64], bounds: &[[f64; 2]]) -> Self {
        let response = &misfit.response;
        let Estimated {
            mut at_bound,
            mut fixed,
            least,
        } = response.estimated(values, bounds);
        let held: Vec<bool> = bounds.iter().map(|[low, high]| low == high).collect();
        for (index, held) in held.iter().enumerate() {
            at_bound[index] &= !held;
            fixed[index] |= held;
        }
        let mut residual = DVector::zeros(misfit.count());
        misfit.evaluate(values, residual.as_mut_slice());
        let (rows, sum_of_squares) = (residual.len() as f64, residual.norm_squared());
        let jacobian = least_squares::jacobian(misfit, values, &fixed, &least);
        let free: Vec<usize> = (0..values.len()).filter(|index| !fixed[*index]).collect();
        let design = jacobian.map(|jacobian| jacobian.select_columns(&free));
        let judged = design.as_ref().and_then(|design| {
            let law = response.law(values);
            let rounded = rounded(&response.moved_tests(values), &*law, misfit.weighting);
            let residuals = FitResiduals {
                curves: misfit.curves(),
                design,
                residual: &residual,
                other_size: &other_size(&misfit.rows, &residual, misfit.weighting),
                rounded: rounded.map(|mean| mean * rows),
            };
            residuals.judge()
        });
        let (verdict, noise): (_, Option<CurveNoise>) = judged.unzip();
        let noise = noise.zip(design.as_ref());
        let noise = noise.map(|(noise, design)| with_offsets(noise, design, misfit));
        let white = || rows * (sum_of_squares / rows).ln();
        let of_residuals = noise.as_ref().map_or_else(white, CurveNoise::deviance);
        // The residuals of a relative fit are those of the stresses times their weights.
        let weights = misfit.rows.iter().map(|row| row.observation_weight().ln());
        Self {
            at_bound,
            fixed,
            held,
            verdict,
            noise,
            sum_of_squares,
            deviance: of_residuals - 2.0 * weights.sum::<f64>(),
            rows: residual.len(),
        }
    }

    /// Corrects the number of independent points where neighbouring ones were averaged; `square` is the weighted sum of squares of all points.
    pub fn count_gathered(&mut self, points: usize, square: f64) {
        let (rows, estimates) = (self.rows, self.fixed.len());
        if let Some(verdict) = &mut self.verdict
            && rows < points
            && verdict.answer.has_intervals()
        {
            let sums = [(square, points), (self.sum_of_squares, rows)];
            let [of_points, of_means] =
                sums.map(|(sum, count)| sum / (count - estimates.min(count - 1)) as f64);
            let gathered = points as f64 / rows as f64;
            verdict.effective_points *= gathered * (of_points / of_means).min(1.0);
        }
    }

    /// AICc of the rows, with the fitted values and the variance.
    pub fn aicc(&self) -> f64 {
        let fitted = self.held.iter().filter(|held| !**held).count();
        corrected_akaike_criterion(self.deviance, (fitted + 1) as f64, self.rows as f64)
    }

    /// Whether the residuals are noise.
    pub fn is_noise(&self) -> bool {
        self.verdict
            .is_some_and(|verdict| verdict.answer.has_intervals())
    }

    /// The values with their uncertainty, NaN where they are at a bound, and their correlation.
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
            // From the interval, because the mean of the covariances is dominated by improbable noises with large lengths.
            let reach = noise.reach();
            // By rounding, the variance of a value that the data do not determine may be negative.
            let standard_error = if error(i).is_finite() {
                noise.half_width(&unit) / reach
            } else {
                f64::NAN
            };
            estimates[*row] = Estimate::new(values[*row], standard_error, reach);
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
        predicted: &[Vec<f64>],
        (estimates, correlation): (Vec<Estimate>, DMatrix<f64>),
    ) -> Quality {
        let pairs = tests.iter().zip(predicted);
        let all: Vec<[f64; 3]> = pairs
            .flat_map(|(test, predicted)| {
                let least = SMALLEST_SHARE * test.largest_stress;
                let rows = test.observations.iter().zip(predicted);
                rows.map(move |(one, fitted)| [one.stress, *fitted, least])
            })
            .collect();
        let sum = |value: &dyn Fn(&[f64; 3]) -> f64| all.iter().map(value).sum::<f64>();
        let absolute = |[measured, fitted, _]: &[f64; 3]| (measured - fitted).abs();
        let (points, squares) = (all.len() as f64, sum(&|one| absolute(one).powi(2)));
        let mean = sum(&|one| one[0]) / points;
        let sizes = sum(&|one| one[0].abs()).max(sum(&|one| one[1].abs()));
        let counting = all
            .iter()
            .filter(|[measured, _, least]| measured.abs() > *least);
        let relative = counting
            .map(|one| absolute(one) / one[0].abs())
            .fold(0.0, f64::max);
        Quality {
            points: all.len(),
            sum_of_squares: squares,
            rmse: (squares / points).sqrt(),
            nmad_percent: 100.0 * sum(&absolute) / sizes,
            r_squared: 1.0 - squares / sum(&|one| (one[0] - mean).powi(2)),
            aicc: self.aicc(),
            largest_relative_error_percent: 100.0 * relative,
            verdict: self.verdict,
            estimates,
            correlation,
            at_bound: self.at_bound,
            held: self.held,
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
