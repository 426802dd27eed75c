//! One model of a study alone.

use super::specimen::Specimen;
use crate::corrector::Multipliers;
use crate::error::Error;
use crate::problem::Solution;
use crate::results::locking;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING, ModelStyle};

/// A model of a plate or a specimen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelKind {
    /// The lattice of springs.
    MassSpring,
    /// The field of the springs, corrected.
    Corrected,
    /// The finite elements, on the finest mesh of the study.
    FiniteElement,
}

impl ModelKind {
    /// All models.
    pub const ALL: [Self; 3] = [Self::MassSpring, Self::Corrected, Self::FiniteElement];

    /// All models with their names.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("mass-spring", Self::MassSpring),
        ("corrected", Self::Corrected),
        ("finite-element", Self::FiniteElement),
    ];
}

/// What one model finds without the others.
#[derive(Debug)]
pub struct OneModel {
    /// Its equilibria, one at each load factor or stretch that it reaches.
    pub solution: Solution,
    /// The force that is measured in each of them, in N: that on the moving grip of a plate, or on the measured group of a
    /// specimen along the axis of its larger component.
    pub forces: Vec<f64>,
    /// The multipliers of the correction of each, condition after condition; none where nothing is told of them.
    pub multipliers: Vec<Vec<Multipliers>>,
    /// Why it has no equilibrium at the others.
    pub ends: Vec<Error>,
    /// What deserves attention in the states.
    pub warnings: Vec<String>,
}

impl ModelKind {
    /// Its name and colour.
    pub fn style(self) -> ModelStyle {
        match self {
            Self::MassSpring => MASS_SPRING,
            Self::Corrected => CORRECTED,
            Self::FiniteElement => FINITE_ELEMENTS,
        }
    }

    /// What deserves attention in the states of this model alone: cells that lock, and what is said of the states of any sheet.
    pub(super) fn warnings(self, specimen: &Specimen, solution: &Solution) -> Vec<String> {
        let remedy = match self {
            Self::MassSpring => None,
            Self::Corrected => Some("Take the finite elements"),
            Self::FiniteElement => Some(locking::SECOND_DEGREE),
        };
        let remedy = remedy.filter(|_| locking::locks(&solution.mesh));
        let locking = remedy.and_then(|remedy| {
            locking::warning(&*specimen.problem.law, &[(self.style().name, remedy)])
        });
        let of_states = specimen.warnings_of_states(self.style().name, solution);
        locking.into_iter().chain(of_states).collect()
    }
}
