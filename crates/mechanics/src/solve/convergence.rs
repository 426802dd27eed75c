//! When an iteration ends, and how it went.

use serde::{Deserialize, Serialize};

/// Stopping criteria.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Largest residual of a free unknown relative to the largest reaction. Default: 1e-10.
    pub tolerance: f64,
    /// Iterations allowed. Default: 40.
    pub max_iterations: usize,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            max_iterations: 40,
        }
    }
}

/// How a solution was reached.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Convergence {
    /// Relative residual before each iteration and after the last.
    pub residuals: Vec<f64>,
    /// The potential at the solution.
    pub energy: f64,
    /// Iterations in which the full step was shortened.
    pub cut_steps: usize,
    /// Iterations in which the tangent was not positive definite and was shifted.
    pub shifted_steps: usize,
    /// Load steps of the shortest length in which the body moved farther than predicted: it snapped to another branch.
    pub snaps: usize,
}

impl Convergence {
    /// Number of iterations.
    pub fn iterations(&self) -> usize {
        self.residuals.len().saturating_sub(1)
    }
}
