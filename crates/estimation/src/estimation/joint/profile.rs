//! Intervals of the parameters by profile likelihood.

use nalgebra::DMatrix;

use super::descent::{Course, Descent};
use super::direction::Direction;
use super::estimate::Step;
use crate::statistics::Estimate;

/// The tolerance of the root of the likelihood ratio at an end, relative to the reach.
const NEAR: f64 = 0.05;

/// The largest number of ends that are tried on one side.
const MOST_ENDS: usize = 3;

/// Where the search has ended, with what the intervals follow from.
pub struct Ends<'a> {
    pub descent: &'a Descent<'a>,
    pub course: &'a Course,
    /// S⁻¹.
    pub inverse: &'a DMatrix<f64>,
    /// Cov(θ).
    pub covariance: &'a DMatrix<f64>,
    /// Half the width of an interval in standard errors.
    pub reach: f64,
    /// The error of each parameter due to errors that all frames have in common: those of forces, of pictures, and of meshes.
    pub common_error: &'a Step,
    /// Combinations of parameters.
    pub directions: &'a [Direction],
}

impl Ends<'_> {
    /// The values found with their intervals: where the misfit, the other parameters following, has risen by the square of the
    /// reach; by more where the noise correlates. Where no equilibrium is found on the way, the end is that of the standard error.
    /// Errors that all frames have in common are added as if they were noise.
    pub fn intervals(&self, profiles: bool) -> Vec<Estimate> {
        let indices = 0..self.course.values.len();
        indices
            .map(|index| self.estimate(index, profiles))
            .collect()
    }

    fn estimate(&self, index: usize, profiles: bool) -> Estimate {
        let value = self.course.values[index];
        if !self.is_determined(index) {
            return Estimate::exact(value);
        }
        let (variance, common_error) = (self.variance(index), self.common_error[index]);
        let mut estimate = Estimate::new(value, variance.sqrt().hypot(common_error), self.reach);
        if profiles && variance > 0.0 {
            let first = self.reach * variance.sqrt();
            let [low, high] = self.descent.law.parameters()[index].bound.ends();
            estimate.interval = [-first, first].map(|first| {
                let off = self.end(index, first) - value;
                let end = value + off.hypot(self.reach * common_error).copysign(first);
                end.clamp(low, high)
            });
        }
        estimate
    }

    /// Whether a parameter lies more in the combinations that are determined than in the others.
    fn is_determined(&self, index: usize) -> bool {
        let vague = self.directions.iter().filter(|one| !one.is_determined());
        vague.map(|one| one.weights[index].powi(2)).sum::<f64>() < 0.5
    }

    /// The variance of a parameter due to noise.
    fn variance(&self, index: usize) -> f64 {
        self.covariance[(index, index)].max(0.0)
    }

    /// The end of a parameter's interval; the search begins at this distance from the value found.
    fn end(&self, index: usize, first: f64) -> f64 {
        let value = self.course.values[index];
        let [low, high] = self.descent.law.parameters()[index].bound.ends();
        let mut distance = first;
        for _ in 0..MOST_ENDS {
            if !(low < value + distance && value + distance < high) {
                return (value + distance).clamp(low, high);
            }
            let Some(root) = self.root(index, value + distance) else {
                return (value + first).clamp(low, high);
            };
            if (root / self.reach - 1.0).abs() < NEAR {
                return value + distance;
            }
            distance *= (self.reach / root.max(0.1 * self.reach)).clamp(0.4, 2.5);
        }
        value + distance
    }

    /// √(rise of the misfit) at another value of a parameter, relative to the deviation due to all noise over that due to white noise.
    fn root(&self, index: usize, value: f64) -> Option<f64> {
        let mut from = self.course.clone();
        from.values[index] = value;
        let course = self.descent.descend(from, Some(index), &|_| ()).ok()?;
        if course.ended.is_some() {
            return None;
        }
        let variance_ratio = self.variance(index) / self.inverse[(index, index)];
        let rise = course.misfit() - self.course.misfit();
        (rise > 0.0).then(|| (rise / variance_ratio).sqrt())
    }
}
