//! The models of a study, and the results of one of them alone.

use crate::corrector::Multipliers;
use crate::error::Error;
use crate::problem::Solution;
use crate::results::Finding;
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

    /// Its name and colour.
    pub fn style(self) -> ModelStyle {
        match self {
            Self::MassSpring => MASS_SPRING,
            Self::Corrected => CORRECTED,
            Self::FiniteElement => FINITE_ELEMENTS,
        }
    }
}

/// The results of one model without the others.
#[derive(Debug)]
pub struct OneModel {
    /// Its equilibria, one at each load factor or stretch that it reaches.
    pub solution: Solution,
    /// The force that is measured in each of them, in N: that on the moving grip of a plate, or on the measured group of a
    /// specimen along the axis of its larger component.
    pub forces: Vec<f64>,
    /// The multipliers of the correction of each, condition after condition; empty where they were not computed.
    pub multipliers: Vec<Vec<Multipliers>>,
    /// Why it has no equilibrium at the others.
    pub ends: Vec<Error>,
    /// What deserves attention in the states.
    pub warnings: Vec<Finding>,
}
