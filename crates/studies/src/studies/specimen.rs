//! A specimen of any shape in all three models: springs, corrected springs, finite elements.

use std::path::Path;

use crate::budget::Budget;
use crate::compare::imported::{ModelField, ModelFields};
use crate::corrector::climb::between_nodes;
use crate::document::Section;
use crate::error::Error;
use crate::material::softened_law::check_memory;
use crate::mesh::MeshData;
use crate::results::Outcome;
use crate::studies::{
    Computation, Kind, Loaded, ModelKind, PreparedStudy, Progress, SOUND, file_stem,
};

pub mod along;
mod files;
pub(super) mod forces;
mod headline;
mod history;
mod measured_curve;
mod measured_fields;
mod measurements;
mod outcome;
pub(super) mod problem;
mod read;
pub(super) mod results;
mod statement;

pub use along::Along;
pub(crate) use measured_curve::{check_extensometer, read_measured_curve};
pub use problem::{
    GridCorrection, GridElements, Method, NEWTON, Outline, PlateGrids, Refinement, Specimen,
};
pub(crate) use read::{read_measurements, read_moving};
use results::end::{End, Run};
use results::models::Models;
use results::verdict;
pub use results::{finest_mesh, force_with_error, one_model};
pub use statement::{load_words, support_words};

/// The `kind` of these studies.
pub const KIND: &str = "specimen";

/// A specimen's study.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<Loaded<Specimen>, Error> {
    case.load(file, text, budget, read::read)
}

/// The same on a mesh in memory, which replaces the one that the study names as `file`.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load_on(
    mesh: &MeshData,
    case: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<Loaded<Specimen>, Error> {
    case.load(file, text, budget, |root, folder| {
        read::read_with(root, folder, &|_, reading| mesh.read(reading))
    })
}

/// A specimen or a plate that was read, ready to be computed.
pub fn ready(kind: &Kind, name: String, text: &str, loaded: Loaded<Specimen>) -> PreparedStudy {
    let (about, progress_steps) = (loaded.content.describe(), loaded.content.progress_steps());
    let stem = file_stem(&name);
    let read = loaded.map(|mut specimen| -> Computation {
        specimen.name = stem;
        Box::new(move |progress| compute(&specimen, progress))
    });
    PreparedStudy {
        about,
        progress_steps,
        ..PreparedStudy::new(kind, name, text, read)
    }
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let specimen = read::read(root, folder);
    Box::new(move |progress| compute(&specimen.expect(SOUND), progress))
}

/// Solves the three models of a specimen; its material may be that of [`Specimen::with_card`].
///
/// # Errors
/// [`Error::Solve`] where no model has an equilibrium at all.
pub fn compute(specimen: &Specimen, progress: Progress) -> Result<Outcome, Error> {
    let mut run = Run::new(specimen, progress);
    let models = solved(&mut run)?;
    let ends = run.ends;
    // There is not even an equilibrium on the way to the first load factor.
    let is_nothing = models.reached() == 0 && ends.iter().all(End::is_empty);
    if let Some(first) = ends.first().filter(|_| is_nothing) {
        return Err(first.error());
    }
    let mut outcome = outcome::outcome(specimen, &models);
    results::end::report(specimen, &models.reference.measured, ends, &mut outcome);
    Ok(outcome)
}

/// The models; with finer finite elements where those of the study are too coarse to judge the others.
fn solved(run: &mut Run) -> Result<Models, Error> {
    let models = Models::solve(run)?;
    if models.reference.may_be_finer(run.specimen) && verdict::is_open(run.specimen, &models) {
        run.progress.tell("finer finite elements");
        return models.with_finer_elements(run);
    }
    Ok(models)
}

/// The fields of all models at a load factor: finite elements as a run has them, springs, corrected springs. The study's load
/// factors before it are steps on the way.
///
/// # Errors
/// [`Error::Solve`] when the finite elements have no solution.
pub fn fields(
    mut specimen: Specimen,
    factor: f64,
    progress: Progress,
) -> Result<ModelFields, Error> {
    for law in specimen.problem.laws().all() {
        check_memory(&**law, "a comparison with another program's field")?;
    }
    let factors = &mut specimen.factors;
    factors.retain(|before| *before * factor > 0.0 && before.abs() < factor.abs());
    factors.push(factor);
    let last = factors.len() - 1;
    let mut run = Run::new(&specimen, progress);
    let models = solved(&mut run)?;
    let field = |kind: ModelKind| {
        let solution = models.of(kind);
        let displacement = solution.displacement(last)?.to_vec();
        let mesh = solution.mesh.clone();
        let (mesh, displacement) = match specimen.grids() {
            // Between its nodes the corrected field is what its differences take it for.
            Some(grids) if kind == ModelKind::Corrected => {
                let scheme = grids.correction.scheme;
                let between = between_nodes(scheme, &mesh, &displacement);
                (scheme.mesh(&mesh), between)
            }
            _ => (mesh, displacement),
        };
        Some(ModelField {
            model: kind.style().name,
            mesh,
            displacement,
        })
    };
    let order = [
        ModelKind::FiniteElement,
        ModelKind::MassSpring,
        ModelKind::Corrected,
    ];
    let ends = run.ends.iter().map(End::error).collect();
    ModelFields::of(order.map(field), ends, models.reference.field_percent(last))
}
