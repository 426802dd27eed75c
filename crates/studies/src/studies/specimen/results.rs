//! The results of a specimen's models: solutions, their errors, the requirements of the study.

use super::problem::Specimen;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::studies::findings::{Examined, findings};
use crate::studies::series::ModelSeries;
use crate::studies::{ModelKind, OneModel, Progress};

pub mod end;
pub mod lattice;
pub mod measured;
pub mod models;
pub mod reference;
mod refine;
mod rounds;
pub mod verdict;

use end::{End, Run};
use reference::Reference;

/// What is measured on the finest finite elements at the last load factor, and its own error in %.
///
/// # Errors
/// [`Error::Solve`] when they have no solution.
pub fn force_with_error(specimen: &Specimen) -> Result<(f64, f64), Error> {
    let mut run = Run::new(specimen, Progress::silent());
    let reference = Reference::solve(&mut run)?;
    if let Some(end) = run.ends.pop() {
        return Err(end.error());
    }
    let last = specimen.factors.len() - 1;
    let force = reference.measured.at(&reference.finest, last);
    let error = reference.measured_percent(last);
    Ok((force.unwrap_or(f64::NAN), error.unwrap_or(f64::NAN)))
}

/// One model of a specimen alone; finite elements on the finest mesh of the study.
///
/// # Errors
/// [`Error::Input`] when a group of a mesh cannot be held or loaded as the study says.
pub fn one_model(
    specimen: &Specimen,
    kind: ModelKind,
    progress: Progress,
) -> Result<OneModel, Error> {
    let mut run = Run::new(specimen, progress);
    let (solution, mut multipliers) = match kind {
        ModelKind::MassSpring => (lattice::solve_springs(&mut run)?.1, Vec::new()),
        ModelKind::FiniteElement => (refine::finest(&mut run)?, Vec::new()),
        ModelKind::Corrected => lattice::solve_corrected(&mut run)?,
    };
    multipliers.resize_with(solution.reached(), Vec::new);
    Ok(OneModel {
        forces: measured_forces(specimen, &solution),
        multipliers,
        ends: run.ends.iter().map(End::error).collect(),
        warnings: findings(Examined {
            specimen,
            series: &[ModelSeries::of(kind, &solution, &[])],
            models: None,
            has_springs: kind == ModelKind::MassSpring,
            is_motion: false,
        }),
        solution,
    })
}

/// The force of supports and loads on the measured group in each state, along the axis of the larger component in the last one.
fn measured_forces(specimen: &Specimen, solution: &Solution) -> Vec<f64> {
    let force = |step: usize| {
        let displacement = &solution.states[step].displacement;
        let groups = solution.groups(step)?;
        Some(specimen.force_on_group(step, &solution.mesh, displacement, groups))
    };
    let forces: Vec<[f64; 2]> = (0..solution.reached()).filter_map(force).collect();
    let axis = forces
        .last()
        .map_or(0, |[x, y]| usize::from(y.abs() > x.abs()));
    forces.iter().map(|force| force[axis]).collect()
}

/// The mesh of the finest finite elements; a specimen that refines itself is solved for it.
///
/// # Errors
/// [`Error::Solve`] when it must be solved and has no solution.
pub fn finest_mesh(specimen: &Specimen) -> Result<Mesh, Error> {
    if specimen.refinement.is_none() {
        return Ok(specimen.outline.finest_mesh());
    }
    let mut run = Run::new(specimen, Progress::silent());
    let finest = refine::finest(&mut run)?;
    run.ends
        .pop()
        .map_or(Ok(finest.mesh), |end| Err(end.error()))
}
