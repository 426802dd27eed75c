//! What a specimen's models find: solutions, own errors, what the study requires.

use super::problem::Specimen;
use crate::compare::imported::ModelField;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::studies::Progress;

pub mod end;
pub mod lattice;
pub mod measured;
pub mod models;
pub mod reference;
mod refine;
pub mod verdict;

use lattice::OnLattice;
use reference::Reference;

/// What is measured on the finest finite elements at the last load factor, and its own error in %.
///
/// # Errors
/// [`Error::Solve`] when they have no solution.
pub fn force_with_error(specimen: &Specimen) -> Result<(f64, f64), Error> {
    let mut ends = Vec::new();
    let reference = Reference::solve(specimen, &mut ends, Progress::silent())?;
    if let Some(end) = ends.pop() {
        return Err(end.error());
    }
    let last = specimen.factors.len() - 1;
    let force = reference.measured.at(&reference.finest, last);
    let own = reference.measured_percent(last);
    Ok((force.unwrap_or(f64::NAN), own.unwrap_or(f64::NAN)))
}

/// The mesh of the finest finite elements; a specimen that refines itself is solved for it.
///
/// # Errors
/// [`Error::Solve`] when it must be solved and has no solution.
pub fn finest_mesh(specimen: &Specimen) -> Result<Mesh, Error> {
    if specimen.refinement.is_none() {
        return Ok(specimen.outline.finest_mesh());
    }
    let mut ends = Vec::new();
    let finest = refine::finest(specimen, &mut ends, Progress::silent())?;
    ends.pop().map_or(Ok(finest.mesh), |end| Err(end.error()))
}

/// The fields of all models at a load factor: finite elements on the finest mesh, springs, corrected springs. The
/// study's load factors before it are steps on the way.
///
/// # Errors
/// [`Error::Solve`] when a model has no solution.
pub fn fields(
    mut specimen: Specimen,
    factor: f64,
    progress: Progress,
) -> Result<[ModelField; 3], Error> {
    specimen.factors.retain(|before| *before < factor);
    specimen.factors.push(factor);
    let mut ends = Vec::new();
    progress.tell("finite elements");
    let elements = refine::finest(&specimen, &mut ends, progress)?;
    let OnLattice {
        uncorrected,
        corrected,
        ..
    } = OnLattice::solve(&specimen, &mut ends, progress)?;
    if let Some(end) = ends.first() {
        return Err(end.error());
    }
    let field = |model, mut solution: Solution| ModelField {
        model,
        mesh: solution.mesh,
        displacement: solution.states.pop().expect("the last factor").displacement,
    };
    Ok([
        field("finite elements", elements),
        field("mass-spring", uncorrected),
        field("corrected", corrected),
    ])
}
