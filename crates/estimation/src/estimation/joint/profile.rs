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
        let estimate = |index: usize| {
            let value = self.course.values[index];
            if !self.is_determined(index) {
                return Estimate::exact(value);
            }
            let variance = self.covariance[(index, index)].max(0.0);
            let common_error = self.common_error[index];
            let mut estimate =
                Estimate::new(value, variance.sqrt().hypot(common_error), self.reach);
            if profiles && variance > 0.0 {
                let side = Side {
                    ends: self,
                    index,
                    variance_ratio: variance / self.inverse[(index, index)],
                };
                let first = self.reach * variance.sqrt();
                let [low, high] = self.descent.law.parameters()[index].bound.ends();
                estimate.interval = [-first, first].map(|first| {
                    let off = side.end(first) - value;
                    let end = value + off.hypot(self.reach * common_error).copysign(first);
                    end.clamp(low, high)
                });
            }
            estimate
        };
        (0..self.course.values.len()).map(estimate).collect()
    }

    /// Whether a parameter lies more in the combinations that are determined than in the others.
    fn is_determined(&self, index: usize) -> bool {
        let vague = self.directions.iter().filter(|one| !one.is_determined());
        vague.map(|one| one.weights[index].powi(2)).sum::<f64>() < 0.5
    }
}

/// The search for the end of one parameter's interval.
struct Side<'a> {
    ends: &'a Ends<'a>,
    index: usize,
    /// The variance over that due to white noise.
    variance_ratio: f64,
}

impl Side<'_> {
    /// The end of the interval; the search begins at this distance from the value found.
    fn end(&self, first: f64) -> f64 {
        let value = self.ends.course.values[self.index];
        let bound = self.ends.descent.law.parameters()[self.index].bound;
        let [low, high] = bound.ends();
        let mut distance = first;
        for _ in 0..MOST_ENDS {
            if !(low < value + distance && value + distance < high) {
                return (value + distance).clamp(low, high);
            }
            let Some(root) = self.root(value + distance) else {
                return (value + first).clamp(low, high);
            };
            if (root / self.ends.reach - 1.0).abs() < NEAR {
                return value + distance;
            }
            let ratio = (self.ends.reach / root.max(0.1 * self.ends.reach)).clamp(0.4, 2.5);
            distance *= ratio;
        }
        value + distance
    }

    /// √(rise of the misfit) at another value of the parameter.
    fn root(&self, value: f64) -> Option<f64> {
        let mut from = self.ends.course.clone();
        from.values[self.index] = value;
        let course = self
            .ends
            .descent
            .descend(from, Some(self.index), &|_| ())
            .ok()?;
        if course.ended.is_some() {
            return None;
        }
        let rise = course.misfit() - self.ends.course.misfit();
        (rise > 0.0).then(|| (rise / self.variance_ratio).sqrt())
    }
}
