//! What deserves attention in the finite elements' states: compression, loss of stability, the range of the card.

use super::problem::Specimen;
use super::results::models::Models;
use crate::mass_spring;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::results::models::FINITE_ELEMENTS;
use crate::results::strained::{self, StrainedSheet};
use crate::results::{is_one_of_several, locking, one_of_several};
use crate::units::number;

/// All warnings, each in a sentence.
pub fn warnings(specimen: &Specimen, models: &Models) -> Vec<String> {
    let Solution { mesh, states, .. } = &models.reference.finest;
    let loads = || {
        states.iter().map(|state| {
            (
                format!("load factor {}", state.factor),
                &*state.displacement,
            )
        })
    };
    let mut all: Vec<String> = mass_spring::warning(&*specimen.problem.law)
        .into_iter()
        .collect();
    let [_, corrected, finite_elements] = models.named();
    let locking = [corrected, finite_elements].into_iter();
    let locking = locking.filter(|model| locking::locks(&model.solution.mesh));
    let locking = locking.map(|model| (model.name, locking::SECOND_DEGREE));
    let locking: Vec<_> = locking.collect();
    all.extend(locking::warning(&*specimen.problem.law, &locking));
    let left_out = specimen.card.viscosity.left_out();
    all.extend(left_out.map(|told| format!("{told}.")));
    all.extend(idle_loads(specimen, mesh));
    all.extend(loads_on_points(specimen, mesh));
    all.extend(moved_points(specimen, mesh));
    all.extend(several(models));
    all.extend(overlap(mesh, loads()));
    let strained = loads().map(|(load, displacement)| StrainedSheet {
        load,
        sheet: specimen.sheet(),
        displacement,
    });
    all.extend(strained::warnings(
        &specimen.card,
        FINITE_ELEMENTS.name,
        mesh,
        &strained.collect::<Vec<_>>(),
    ));
    all
}

/// How deep in a cell a node of the boundary must lie, in natural coordinates, for the sheet to overlap.
const OVERLAP: f64 = 0.05;

/// The warning about the first state in which the sheet passes through itself.
fn overlap<'a>(
    mesh: &Mesh,
    mut states: impl Iterator<Item = (String, &'a [f64])>,
) -> Option<String> {
    let (load, [x, y]) = states.find_map(|(load, u)| Some((load, mesh.overlap(u, OVERLAP)?)))?;
    Some(format!(
        "the sheet passes through itself at {load}, near ({}, {}) mm at rest: parts of the boundary have no contact with each other, and the \
         state is impossible where they overlap",
        number(x),
        number(y)
    ))
}

/// The warning about loads that supports take up at once.
fn idle_loads(specimen: &Specimen, mesh: &Mesh) -> Option<String> {
    let idle = specimen.problem.idle_loads(mesh).unwrap_or_default();
    (!idle.is_empty()).then(|| {
        format!(
            "the load on {} has no effect on the field: supports fix these nodes in its direction and carry it directly. Support another group, or \
             take a support that leaves the load's direction free, such as a grip with a force.",
            idle.join(", ")
        )
    })
}

/// The warning about forces on single points, under which displacements have no limit.
fn loads_on_points(specimen: &Specimen, mesh: &Mesh) -> Option<String> {
    let named = quoted(&specimen.problem.forces_on_points(mesh))?;
    Some(format!(
        "the force on {named} acts on single points, where displacement and stress grow without limit as the mesh is refined: their values and own \
         errors there are meaningless. Put it on edges, on a line or on an area."
    ))
}

/// The warning about single points that supports move, which takes no force in a sheet.
fn moved_points(specimen: &Specimen, mesh: &Mesh) -> Option<String> {
    let named = quoted(&specimen.problem.moved_points(mesh))?;
    Some(format!(
        "the support on {named} moves single points: as the mesh is refined, their force tends to zero, and the field with it, so that force, field \
         and own errors are meaningless. Move edges, a line or an area."
    ))
}

/// Names of groups in words; `None` where there are none.
fn quoted(names: &[&str]) -> Option<String> {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    (!quoted.is_empty()).then(|| quoted.join(", "))
}

/// The warning about states that may be one of several.
fn several(models: &Models) -> Option<String> {
    let named = models.named();
    let solutions = named.iter().map(|model| (model.name, model.solution));
    // Finer meshes begin with the states of coarser ones.
    let coarser = models.reference.coarser().iter();
    let solutions = solutions.chain(coarser.map(|own| ("coarser finite elements", own)));
    let states = solutions.flat_map(|(name, solution)| {
        let found = solution.states.iter();
        let found = found.filter(|state| is_one_of_several(state));
        found.map(move |state| format!("{name} at load factor {}", state.factor))
    });
    one_of_several(&states.collect::<Vec<_>>())
}
