//! What a specimen is computed for at a glance.

use super::problem::{Outline, Specimen};
use super::results::models::Models;
use crate::mesh::{Mesh, Shape};
use crate::results::{Block, Deformed, Gauge, Headline, LoadedSheet};
use crate::studies::ModelKind;

/// The groups' forces and displacements at every load factor and the largest values at the largest one, by the finite elements, or else by the
/// corrected field or the springs.
pub fn headline(specimen: &Specimen, models: &Models) -> Vec<Block> {
    let Some(model) = models.best() else {
        return Vec::new();
    };
    let solution = model.solution;
    let along = specimen.along;
    let (mesh, reached) = (&solution.mesh, 0..solution.reached());
    let states = reached.clone().filter_map(|step| {
        let groups = solution.groups(step)?.to_vec();
        Some((along.value(specimen.factors[step]), groups))
    });
    let size = |step: &usize| specimen.factors[*step].abs();
    let largest = reached
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .unwrap_or_default();
    let mut fields = solution.past(largest);
    fields.extend(solution.displacement(largest));
    let headline = Headline {
        model: match model.kind {
            ModelKind::MassSpring => "springs",
            ModelKind::Corrected => "corrected field",
            ModelKind::FiniteElement => "finite elements",
        },
        along: along.head(),
        groups: specimen.groups(),
        steps: states.collect(),
        state: LoadedSheet {
            at: along.describe(specimen.factors[largest]),
            laws: specimen.problem.laws(),
            deformed: Deformed::elastic(model.style.name, mesh, fields),
            // Supports were checked when the study was read.
            singular: specimen.problem.singular_points(mesh).unwrap_or_default(),
            gauge: gauge(&specimen.outline, mesh),
        },
    };
    headline.blocks()
}

/// The gauge section of a strip or a dog-bone.
pub fn gauge(outline: &Outline, mesh: &Mesh) -> Option<Gauge> {
    let shape = match outline {
        Outline::Shape { shape, .. } => *shape,
        Outline::Grid(grids) => Shape::Strip { size: grids.size },
        Outline::File { .. } => return None,
    };
    match shape {
        Shape::Strip { size } => {
            let words = "the middle half of the length";
            Some(Gauge::middle_half(mesh, size[0], words))
        }
        Shape::DogBone { narrow, .. } => {
            let words = "the middle half of the narrow part";
            Some(Gauge::middle_half(mesh, narrow[0], words))
        }
        Shape::StripWithHole { .. } | Shape::NotchedStrip { .. } | Shape::RingSector { .. } => None,
    }
}
