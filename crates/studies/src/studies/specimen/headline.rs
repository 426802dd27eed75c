//! The main results of a specimen.

use super::problem::Specimen;
use super::results::models::Models;
use crate::results::{Block, digits};
use crate::statistics::larger;
use crate::studies::ModelKind;

/// The groups' forces and displacements at every load factor and the largest values at the largest one, by the finite elements, or else by the
/// corrected field or the springs.
pub fn headline(specimen: &Specimen, models: &Models) -> Vec<Block> {
    let Some(kind) = models.best() else {
        return Vec::new();
    };
    let model = match kind {
        ModelKind::MassSpring => "springs".to_owned(),
        ModelKind::Corrected => "corrected field".to_owned(),
        ModelKind::FiniteElement => finite_elements(models),
    };
    let (series, along) = (models.series(kind), specimen.along);
    let steps = 0..series.states.len();
    let size = |step: &usize| series.states[*step].at.abs();
    let largest = steps.clone().max_by(|a, b| size(a).total_cmp(&size(b)));
    let largest = largest.unwrap_or_default();
    series.headline(
        specimen,
        (&model, along.head(), specimen.groups()),
        steps.map(|step| (step, along.value(series.states[step].at))),
        (largest, along.describe(series.states[largest].at)),
    )
}

/// The finite elements with their own error, where it is known.
fn finite_elements(models: &Models) -> String {
    const LEAST: f64 = 1e-3;
    let reference = &models.reference;
    let errors = (0..reference.reached()).filter_map(|step| reference.measured_percent(step));
    match errors.reduce(larger) {
        None => "finite elements".to_owned(),
        Some(error) => {
            let least = if error < LEAST { "less than " } else { "" };
            format!(
                "finite elements (estimated error of the {}: {least}{} %)",
                reference.measured.name(),
                digits(error.max(LEAST), 2)
            )
        }
    }
}
