//! The residuals of a model of tests: measured less modelled stresses by their weights.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::DVector;

use super::zero::Zero;
use crate::calibration::data::{Observation, TestData};
use crate::calibration::least_squares::{LEAST_SIZE, Residuals};
use crate::calibration::settings::Weighting;
use crate::material::HyperelasticLaw;

/// Rows of the residuals along a curve, with the strain that they are drawn over or their number.
pub type Rows = Vec<(usize, f64)>;

/// A measured stress, or the mean of some neighbouring ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The test, by its number.
    pub test: usize,
    /// 0 or 1.
    pub axis: usize,
    /// The strain that it is drawn over, or its number in the file.
    pub position: f64,
    /// In MPa.
    pub stress: f64,
    /// How many observations it is the mean of.
    pub count: f64,
    /// The measured stress over the one that is fitted in its place, whose noise is smaller by this factor.
    pub factor: f64,
    /// The weight of its residual: that of one observation times √count.
    pub weight: f64,
}

impl Row {
    /// A measured stress of a test, by a weight of one.
    pub fn of(test: usize, one: &Observation, position: f64, count: f64) -> Self {
        Self {
            test,
            axis: one.axis,
            position,
            stress: one.stress,
            count,
            factor: 1.0,
            weight: 1.0,
        }
    }

    /// The weight of one observation.
    pub fn observation_weight(&self) -> f64 {
        self.weight / self.count.sqrt()
    }
}

/// The distance to a bound within which a value counts as at the bound: a share of its size, and the least size.
const AT_BOUND: [f64; 2] = [1e-6, 1e-9];

/// What is estimated of some values.
pub struct Estimated {
    /// Which of them a bound holds.
    pub at_bound: Vec<bool>,
    /// Which of them are not estimated at all.
    pub fixed: Vec<bool>,
    /// The least significant size of each.
    pub least: Vec<f64>,
}

/// Which values lie at their bounds, within a share of their size and of the least size that counts.
pub fn at_bound(values: &[f64], bounds: &[[f64; 2]], [share, least]: [f64; 2]) -> Vec<bool> {
    let held = |(value, [low, high]): (&f64, &[f64; 2])| {
        let near = |limit: f64| (value - limit).abs() <= share * value.abs().max(least);
        near(*low) || near(*high)
    };
    values.iter().zip(bounds).map(held).collect()
}

/// A model of the stresses in some tests: a law, alone or with what depends on time or on the load history.
pub trait Response: Clone + Sync {
    /// The tests as they are written.
    fn data(&self) -> &[TestData];

    /// The rows that are fitted, with weights of one.
    fn rows(&self) -> Vec<Row>;

    /// The law at some values: that of long times, or of the first loading.
    fn law(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw>;

    /// The stresses at all rows in the measure of the data, in MPa; not finite where the values are impossible.
    fn stresses(&self, values: &[f64]) -> Vec<f64>;

    /// The stresses at all observations of each test.
    fn predicted(&self, values: &[f64]) -> Vec<Vec<f64>>;

    /// The tests with the zeros that the values give them.
    fn moved_tests(&self, _values: &[f64]) -> Cow<'_, [TestData]> {
        Cow::Borrowed(self.data())
    }

    /// Zeros that are values, after all others.
    fn zeros(&self) -> &[Zero] {
        &[]
    }

    /// The measured stress of a row with the zeros that the values give it, in MPa; asked for where there are zeros.
    fn measured(&self, _values: &[f64], _row: usize) -> f64 {
        f64::NAN
    }

    /// What the test measured of a row over [`Self::measured`], where there are zeros.
    fn scale(&self, _values: &[f64], _row: usize) -> f64 {
        1.0
    }

    /// Whether a value is the logarithm of a parameter.
    fn is_logarithmic(&self, _value: usize) -> bool {
        false
    }

    /// What is estimated: all values that no bound holds.
    fn estimated(&self, values: &[f64], bounds: &[[f64; 2]]) -> Estimated {
        let at_bound = at_bound(values, bounds, AT_BOUND);
        Estimated {
            fixed: at_bound.clone(),
            at_bound,
            least: vec![LEAST_SIZE; values.len()],
        }
    }
}

/// The residuals of a model.
#[derive(Clone)]
pub struct Misfit<R> {
    /// The model.
    pub response: R,
    /// How residuals are weighted.
    pub weighting: Weighting,
    /// What is fitted.
    pub rows: Vec<Row>,
}

impl<R: Response> Misfit<R> {
    /// Residuals weighted by the measured stresses.
    pub fn new(response: R, weighting: Weighting) -> Self {
        let rows = response.rows();
        let measured = rows.iter().map(|row| row.stress).collect();
        Self {
            response,
            weighting,
            rows,
        }
        .weighted(measured)
    }

    /// The same with the weights of the stresses at some values.
    pub fn reweighed(&self, values: &[f64]) -> Self {
        self.clone().weighted(self.response.stresses(values))
    }

    /// The same with the weights of some stresses.
    fn weighted(mut self, stresses: Vec<f64>) -> Self {
        for (row, stress) in self.rows.iter_mut().zip(stresses) {
            let data = &self.response.data()[row.test];
            row.weight = row.factor * self.weighting.weight_of(data, stress) * row.count.sqrt();
        }
        self
    }

    /// Some stresses, one for each row, by the weights.
    pub fn weighed(&self, stresses: Vec<f64>) -> DVector<f64> {
        let pairs = self.rows.iter().zip(stresses);
        let weighed = pairs.map(|(row, stress)| row.weight * stress);
        DVector::from_iterator(self.rows.len(), weighed)
    }

    /// The rows along each axis of each test.
    pub fn curves(&self) -> Vec<Rows> {
        let mut curves: Vec<([usize; 2], Rows)> = Vec::new();
        for (index, row) in self.rows.iter().enumerate() {
            let key = [row.test, row.axis];
            match curves.iter_mut().rfind(|(known, _)| *known == key) {
                Some((_, rows)) => rows.push((index, row.position)),
                None => curves.push((key, vec![(index, row.position)])),
            }
        }
        curves.into_iter().map(|(_, rows)| rows).collect()
    }
}

impl<R: Response> Residuals for Misfit<R> {
    fn count(&self) -> usize {
        self.rows.len()
    }

    fn evaluate(&self, values: &[f64], residuals: &mut [f64]) -> bool {
        let stresses = self.response.stresses(values);
        let has_zeros = !self.response.zeros().is_empty();
        let rows = self.rows.iter().zip(stresses).enumerate();
        for (residual, (index, (row, stress))) in residuals.iter_mut().zip(rows) {
            // The noise is that of what the test measured: divided by a value, it would make its derivative a noise too.
            let (measured, scale) = if has_zeros {
                let response = &self.response;
                (
                    response.measured(values, index),
                    response.scale(values, index),
                )
            } else {
                (row.stress, 1.0)
            };
            *residual = row.weight * scale * (measured - stress);
        }
        residuals.iter().all(|residual| residual.is_finite())
    }
}
