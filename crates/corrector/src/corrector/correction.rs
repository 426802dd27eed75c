//! The settings and the result of a correction.

use super::factor::{Factor, Solver};
use crate::solve::Convergence;

/// How a correction is computed, and when it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorrectorSettings {
    /// Largest scaled residual relative to the largest displacement; see [`Step::residual`]. Default: 1e-10.
    pub tolerance: f64,
    /// Largest remaining move of the field, relative to the largest displacement, where the data influence the
    /// result: a small part of their noise is enough. Default: 1e-9.
    pub movement: f64,
    /// Steps allowed. Default: 40.
    pub max_steps: usize,
    /// The form of the projection. Default: [`Solver::Automatic`].
    pub solver: Solver,
}

impl Default for CorrectorSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            movement: 1e-9,
            max_steps: 40,
            solver: Solver::Automatic,
        }
    }
}

/// Names elements and unknowns in messages.
pub trait Describe {
    /// An element of a potential.
    fn element(&self, element: usize) -> String {
        format!("element {element}")
    }

    /// An entry of the field.
    fn unknown(&self, unknown: usize) -> String {
        format!("unknown {unknown}")
    }
}

/// Names by number.
impl Describe for () {}

/// The Lagrange multipliers of one condition.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Multipliers {
    /// The condition's name.
    pub name: String,
    /// The unknown of each row, where each row belongs to one.
    pub unknowns: Option<Vec<usize>>,
    /// One number per row, in the unit of ½ ‖u − ū‖²_W over the unit of the row.
    pub values: Vec<f64>,
}

/// A field of the iteration from ū to u.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The field.
    pub field: Vec<f64>,
    /// Largest residual: each row c divided by √(B W⁻¹ Bᵀ) of its gradient B, which makes it a distance
    /// in the unit of the field, over the largest entry of the field.
    pub residual: f64,
    /// Share of the linearised step that was taken to get here; 1 for the start.
    pub length: f64,
}

/// The result of a correction.
#[derive(Debug)]
#[non_exhaustive]
pub struct Correction {
    /// The start and the field after each step; the last one is the result.
    pub steps: Vec<Step>,
    /// The multipliers, condition after condition.
    pub multipliers: Vec<Multipliers>,
    /// The conditions at the result, factorised.
    pub factor: Factor,
}

impl Correction {
    /// The corrected field.
    pub fn field(&self) -> &[f64] {
        &self.steps[self.steps.len() - 1].field
    }

    /// How the field was reached, with the energy there in mJ.
    pub fn convergence(&self, energy: f64) -> Convergence {
        let steps = self.steps.iter();
        Convergence {
            residuals: steps.clone().map(|step| step.residual).collect(),
            energy,
            cut_steps: steps.filter(|step| step.length < 1.0).count(),
            ..Convergence::default()
        }
    }
}
