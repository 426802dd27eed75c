//! One model of a study alone.

use crate::corrector::Multipliers;
use crate::error::Error;
use crate::material::Card;
use crate::problem::Solution;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::results::strained::{self, StrainedSheet};
use crate::results::{Sheet, locking};

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
    /// What deserves attention in the states of this model: cells that lock, and what is said of the states of any sheet.
    pub(super) fn warnings(
        self,
        card: &Card,
        sheet: Sheet,
        solution: &Solution,
        describe: fn(f64) -> String,
    ) -> Vec<String> {
        let (name, remedy) = match self {
            Self::MassSpring => (MASS_SPRING.name, None),
            Self::Corrected => (CORRECTED.name, Some("Take the finite elements")),
            Self::FiniteElement => (FINITE_ELEMENTS.name, Some(locking::SECOND_DEGREE)),
        };
        let remedy = remedy.filter(|_| locking::locks(&solution.mesh));
        let locking = remedy.and_then(|remedy| locking::warning(sheet.law, &[(name, remedy)]));
        let states = solution.states.iter().map(|state| StrainedSheet {
            load: describe(state.factor),
            sheet,
            displacement: &state.displacement,
        });
        let states: Vec<_> = states.collect();
        let of_states = strained::warnings(card, name, &solution.mesh, &states);
        locking.into_iter().chain(of_states).collect()
    }
}
