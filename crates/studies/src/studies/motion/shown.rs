//! The sheets of a motion as pictures and grids show them: their fields at the instants, and what follows from them.

use super::problem::MovingSheet;
use super::solution::{ModelMotion, Motions};
use crate::mesh::Mesh;
use crate::results::ViscousStress;
use crate::results::models::{FINITE_ELEMENTS, ModelStyle};

/// A sheet whose motion is shown.
pub struct ShownSheet<'a> {
    /// Its model.
    pub style: ModelStyle,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Displacement and velocity at the first instants.
    pub motion: Vec<[&'a [f64]; 2]>,
    /// The viscous stresses at these instants.
    pub viscous: Vec<ViscousStress>,
}

impl ShownSheet<'_> {
    /// Whether it is what the others are compared with.
    pub fn is_reference(&self) -> bool {
        self.style == FINITE_ELEMENTS
    }
}

/// All sheets, the finite elements last.
pub fn shown<'a>(sheet: &MovingSheet, motions: &'a Motions) -> Vec<ShownSheet<'a>> {
    let times = motions.times();
    let (law, material) = (&*sheet.specimen.problem.law, &sheet.viscosity);
    let shown = |model: &'a ModelMotion| {
        let instants = model.instants().iter();
        let motion: Vec<[&[f64]; 2]> = instants
            .map(|now| [&now.displacement[..], &now.velocity])
            .collect();
        ShownSheet {
            style: model.style,
            mesh: &model.mesh,
            viscous: ViscousStress::over_time(law, material, &model.mesh, &times, &motion),
            motion,
        }
    };
    motions.all().into_iter().map(shown).collect()
}
