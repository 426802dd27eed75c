//! The plates of a motion as pictures and grids show them: their fields at the instants, and what follows from them.

use super::corrected::CorrectedInstants;
use super::problem::MovingPlate;
use super::solution::ModelMotion;
use crate::mesh::Mesh;
use crate::results::ViscousStress;

/// A plate whose motion is shown.
pub struct PlateMotion<'a> {
    /// Its name.
    pub name: &'static str,
    /// Its name in names of files.
    pub file: &'static str,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Displacement and velocity at the first instants.
    pub motion: Vec<[&'a [f64]; 2]>,
    /// The viscous stresses at these instants.
    pub viscous: Vec<ViscousStress>,
    /// Whether it is what the others are compared with.
    pub is_reference: bool,
}

/// The instants of the model that has more of them: all, unless both ended before.
pub fn times(models: &[ModelMotion; 2]) -> Vec<f64> {
    let [springs, elements] = models.each_ref().map(|model| model.history.times());
    if springs.len() < elements.len() {
        elements
    } else {
        springs
    }
}

/// All plates; the corrected one between the models, where there is one, and the finite elements last.
pub fn shown<'a>(
    plate: &MovingPlate,
    models: &'a [ModelMotion; 2],
    corrected: &'a CorrectedInstants,
) -> Vec<PlateMotion<'a>> {
    let times = times(models);
    let (law, material) = (&*plate.problem.law, &plate.viscosity);
    let shown = |[name, file]: [&'static str; 2], mesh: &'a Mesh, motion: Vec<[&'a [f64]; 2]>| {
        PlateMotion {
            name,
            file,
            mesh,
            viscous: ViscousStress::over_time(law, material, mesh, &times, &motion),
            motion,
            is_reference: false,
        }
    };
    let model = |model: &'a ModelMotion| {
        let instants = model.history.instants.iter();
        let motion = instants.map(|now| [&now.displacement[..], &now.velocity]);
        shown([model.name, model.file], &model.mesh, motion.collect())
    };
    let [springs, elements] = models;
    let fields = corrected.displacement.iter().zip(&corrected.velocity);
    let motion = fields.map(|(u, v)| [&u[..], &v[..]]).collect();
    let between = shown(["corrected"; 2], &springs.mesh, motion);
    let reference = PlateMotion {
        is_reference: true,
        ..model(elements)
    };
    let mut all = vec![model(springs), between, reference];
    all.retain(|plate| !plate.motion.is_empty());
    all
}
