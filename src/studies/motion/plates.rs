//! The plates of a motion as pictures and grids show them: their fields at the instants, and what follows from them.

use super::corrected::CorrectedInstants;
use super::problem::MovingPlate;
use super::solution::ModelMotion;
use crate::mesh::Mesh;
use crate::results::wrinkling::{Wrinkling, of_parts};
use crate::results::{ViscousStress, cell_states, number};

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
    match springs.len() < elements.len() {
        true => elements,
        false => springs,
    }
}

/// All plates; the corrected one between the models, where there is one, and the finite elements last.
pub fn shown<'a>(
    plate: &MovingPlate,
    models: &'a [ModelMotion; 2],
    corrected: &'a CorrectedInstants,
) -> Vec<PlateMotion<'a>> {
    let times = times(models);
    let material = (&*plate.problem.law, &plate.viscosity);
    let shown = |[name, file]: [&'static str; 2], mesh: &'a Mesh, motion: Vec<[&'a [f64]; 2]>| {
        PlateMotion {
            name,
            file,
            mesh,
            viscous: ViscousStress::over_time(material, mesh, &times, &motion),
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

/// The warning of a thin sheet under compression: the instant at which the largest part of it is.
pub fn compression(plate: &MovingPlate, times: &[f64], plates: &[PlateMotion]) -> Option<String> {
    let law = &*plate.problem.law;
    let own = plates.iter().find(|own| own.is_reference)?;
    let shares = own.motion.iter().zip(&own.viscous).zip(times);
    let shares = shares.map(|(([u, _], viscous), time)| {
        let states = cell_states(law, own.mesh, &[u], &viscous.in_cells);
        let share = Wrinkling::of_cells(law, own.mesh, &states).area_percent;
        (share, *time)
    });
    let (share, time) = shares.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let most = || format!("up to {share:.1} % of the area, at {} s", number(time));
    (share > 0.0).then(|| of_parts(&most()))
}
