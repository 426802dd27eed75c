//! How far a law that was fitted can be trusted.

use super::judged::{Judged, Values, at_bound};
use super::quality::{Deviations, Quality, rounded};
use crate::calibration::data::{Observation, TestData};
use crate::calibration::least_squares::{LEAST_SIZE, Residuals};
use crate::calibration::regression::Misfit;
use crate::calibration::settings::Weighting;
use crate::material::HyperelasticLaw;

/// What is assessed: a law with its values and the tests that it was fitted to.
pub struct Assessment<'a> {
    pub misfit: &'a Misfit<'a>,
    pub weighting: Weighting,
    pub tests: &'a [TestData],
    pub law: &'a dyn HyperelasticLaw,
    pub values: &'a [f64],
    /// Lower and upper limit of each value.
    pub bounds: &'a [[f64; 2]],
    /// The least size of each parameter of the law that counts.
    pub least: &'a [f64],
}

impl Assessment<'_> {
    /// The figures of the fit, without warnings.
    pub fn quality(&self) -> Quality {
        let points: usize = self.tests.iter().map(|test| test.observations.len()).sum();
        let deviations = Deviations::of(self.tests, &|test, row| {
            let data = &self.tests[test];
            data.stress_of(self.law, &data.observations[row])
        });
        let judged = self.judge(points);
        let estimates = judged.estimates(self.values);
        let quality = judged.quality(self.law, self.tests, &deviations, estimates);
        quality.with_zeros(self.misfit.zeros())
    }

    /// Whether the residuals are noise.
    pub fn is_noise(&self) -> bool {
        self.judged().is_noise()
    }

    /// What the residuals are, and what the values are worth. A value that a bound holds may lie elsewhere, as far as the data say:
    /// the others are as uncertain as if it were free. Only what bounds leave no room is known.
    fn judged(&self) -> Judged {
        let at_bound = at_bound(self.values, self.bounds, [1e-9, 1e-300]);
        let rounded = rounded(self.tests, self.law, self.weighting);
        let mut least = self.least.to_vec();
        least.resize(self.values.len(), LEAST_SIZE);
        let found = Values {
            values: self.values,
            at_bound,
            fixed: self.fixed(),
            least,
        };
        Judged::of(self.misfit, self.misfit.curves(), found, rounded)
    }

    /// Which values are known: bounds leave them no room, or nothing depends on them to first order.
    fn fixed(&self) -> Vec<bool> {
        let mut fixed: Vec<bool> = self.bounds.iter().map(|[low, high]| low == high).collect();
        let parameters = self.misfit.build(self.values).1.parameters;
        for (fixed, parameter) in fixed.iter_mut().zip(parameters) {
            *fixed |= parameter.is_symmetric_at(parameter.value);
        }
        fixed
    }

    /// The same with all points counted, where they were gathered.
    fn judge(&self, points: usize) -> Judged {
        let mut judged = self.judged();
        let Some(verdict) = &mut judged.verdict else {
            return judged;
        };
        // Points that were gathered count as many as their means are the less scattered.
        let (rows, estimates) = (self.misfit.count(), self.values.len());
        if rows < points && verdict.answer.has_intervals() {
            let sums = [(self.weighted(), points), (judged.sum_of_squares, rows)];
            let [own, of_means] =
                sums.map(|(sum, count)| sum / (count - estimates.min(count - 1)) as f64);
            let gathered = points as f64 / rows as f64;
            verdict.effective_points *= gathered * (own / of_means).min(1.0);
        }
        judged
    }

    /// Σ (w (σᵢ − σ))² of all points by the weights of the fitted stresses.
    fn weighted(&self) -> f64 {
        let square = |data: &TestData, one: &Observation| {
            let fitted = data.stress_of(self.law, one);
            (self.weighting.weight_of(data, fitted) * (one.stress - fitted)).powi(2)
        };
        let of_test = |data: &TestData| -> f64 {
            let rows = data.observations.iter();
            rows.map(|one| square(data, one)).sum()
        };
        self.tests.iter().map(of_test).sum()
    }
}
