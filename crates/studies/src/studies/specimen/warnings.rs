//! What deserves attention in the finite elements' states: compression, loss of stability, the range of the card.

use super::problem::Specimen;
use super::results::models::Models;
use crate::mass_spring;
use crate::material::Card;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::results::strained::{self, StrainedSheet};
use crate::results::{is_one_of_several, locking, one_of_several};
use crate::studies::ModelKind;
use crate::units::number;

/// All warnings, each in a sentence.
pub fn warnings(specimen: &Specimen, models: &Models) -> Vec<String> {
    let solution = models
        .best()
        .map(|model| (model.style.name, model.solution));
    let mut all = of_materials(specimen, |card| match specimen.grids() {
        Some(grids) if grids.lattice.area_term => None,
        Some(_) => mass_spring::warning_of_plate(&*card.law),
        None => mass_spring::warning(&*card.law),
    });
    all.extend(locking_cells(specimen, models));
    all.extend(of_materials(specimen, |card| {
        let told = card.viscosity.left_out()?;
        Some(format!("{told}."))
    }));
    if let Some((_, solution)) = solution {
        let mesh = &solution.mesh;
        all.extend(idle_loads(specimen, mesh));
        all.extend(loads_on_points(specimen, mesh));
        all.extend(moved_points(specimen, mesh));
    }
    all.extend(several(specimen, models));
    if let Some((name, solution)) = solution {
        all.extend(overlap(specimen, solution));
        all.extend(specimen.warnings_of_states(name, solution));
    }
    all
}

/// What is to be said of the material; of several, with the name of the region.
fn of_materials(specimen: &Specimen, say: impl Fn(&Card) -> Option<String>) -> Vec<String> {
    let regions = specimen.numbered_regions();
    if regions.is_empty() {
        return say(&specimen.card).into_iter().collect();
    }
    let told = |(_, name, card): (usize, &str, &Card)| Some(format!("{name}: {}", say(card)?));
    regions.into_iter().filter_map(told).collect()
}

/// The warnings about corrected field and finite elements whose cells lock.
fn locking_cells(specimen: &Specimen, models: &Models) -> Vec<String> {
    let of_plate = specimen.grids().map(|grids| {
        let scheme = grids.correction.scheme.side() == 1;
        let remedy = "Take the scheme \"biquadratic\" for the corrected field";
        (scheme, remedy)
    });
    let corrected = models.of(ModelKind::Corrected);
    let (locks, remedy) = of_plate.unwrap_or_else(|| {
        let locks = locking::locks(&corrected.solution.mesh);
        (locks, locking::SECOND_DEGREE)
    });
    let elements = models.of(ModelKind::FiniteElement);
    let of_elements = locking::locks(&elements.solution.mesh);
    let both = [
        (corrected, locks, remedy),
        (elements, of_elements, locking::SECOND_DEGREE),
    ];
    let both = both
        .into_iter()
        .filter(|(model, locks, _)| *locks && model.solution.reached() > 0);
    let named: Vec<_> = both
        .map(|(model, _, remedy)| (model.style.name, remedy))
        .collect();
    of_materials(specimen, |card| locking::warning(&*card.law, &named))
}

impl Specimen {
    /// What deserves attention in the states of a model alone: cells that lock, and what is said of the states of any sheet.
    pub(super) fn warnings_of_model(&self, kind: ModelKind, solution: &Solution) -> Vec<String> {
        let remedy = match kind {
            ModelKind::MassSpring => None,
            ModelKind::Corrected => Some("Take the finite elements"),
            ModelKind::FiniteElement => Some(locking::SECOND_DEGREE),
        };
        let name = kind.style().name;
        let remedy = remedy.filter(|_| locking::locks(&solution.mesh));
        let mut all = of_materials(self, |card| {
            locking::warning(&*card.law, &[(name, remedy?)])
        });
        all.extend(self.warnings_of_states(name, solution));
        all
    }

    /// What is said of the states of one model: compression, loss of stability, the range of the card.
    fn warnings_of_states(&self, model: &str, solution: &Solution) -> Vec<String> {
        let states = solution.states.iter().map(|state| StrainedSheet {
            load: self.along.describe(state.factor),
            sheet: self.sheet(),
            displacement: &state.displacement,
        });
        let states: Vec<_> = states.collect();
        strained::warnings(&self.cards(), model, &solution.mesh, &states)
    }
}

/// How deep in a cell a node of the boundary must lie, in natural coordinates, for the sheet to overlap.
const OVERLAP: f64 = 0.05;

/// The warning about the first state in which the sheet passes through itself.
fn overlap(specimen: &Specimen, solution: &Solution) -> Option<String> {
    let mut states = solution.states.iter();
    let (factor, [x, y]) = states.find_map(|state| {
        let place = solution.mesh.overlap(&state.displacement, OVERLAP)?;
        Some((state.factor, place))
    })?;
    let load = specimen.along.describe(factor);
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
fn several(specimen: &Specimen, models: &Models) -> Option<String> {
    let all = models.all();
    let solutions = all.iter().map(|model| (model.style.name, model.solution));
    // Finer meshes begin with the states of coarser ones.
    let coarser = models.reference.coarser().iter();
    let solutions = solutions.chain(coarser.map(|own| ("coarser finite elements", own)));
    let states = solutions.flat_map(|(name, solution)| {
        let states = solution.states.iter();
        let several = states.filter(|state| is_one_of_several(state));
        several.map(move |state| format!("{name} at {}", specimen.along.describe(state.factor)))
    });
    one_of_several(&states.collect::<Vec<_>>())
}
