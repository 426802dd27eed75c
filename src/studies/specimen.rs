//! A specimen of any shape in all three models: springs, corrected springs, finite elements.

use std::path::Path;

use crate::compare::imported::ModelField;
use crate::document::Section;
use crate::error::{Diagnostic, Error};
use crate::mesh::Mesh;
use crate::problem::Model;
use crate::results::{Outcome, Sheet};
use crate::solve::Potential;
use crate::studies::{Kind, Prepared, Progress};

mod end;
mod files;
mod forces;
mod measured;
mod outcome;
mod outline;
mod paths;
mod read;
mod reference;
mod solved;
mod statement;
mod supports;
mod verdict;
mod warnings;

use paths::OnLattice;
pub use read::{Refinement, Specimen};
use reference::{OnMesh, Reference};
use solved::Solved;

/// The `kind` of these studies.
pub const KIND: &str = "specimen";

/// A specimen's study: its title, the specimen, and what deserves attention.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Kind,
    file: &Path,
    text: &str,
) -> Result<(String, Specimen, Vec<Diagnostic>), Error> {
    let read = case.read_with(file, text, read::read)?;
    let specimen = read.made.expect("a study without faults has a specimen");
    Ok((read.title, specimen, read.warnings))
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let specimen = read::read(root, folder);
    Box::new(move |progress| {
        specimen.map_or(Ok(Outcome::default()), |read| compute(&read, progress))
    })
}

impl Specimen {
    /// What stresses follow from.
    fn sheet(&self) -> Sheet<'_> {
        Sheet {
            law: &*self.problem.law,
            thickness: self.problem.thickness,
        }
    }

    /// The problem on a mesh; groups were checked when the study was read.
    fn on<'a>(&self, mesh: &'a Mesh, energy: &'a dyn Potential) -> Result<Model<'a>, Error> {
        let found = self.problem.on(mesh, energy);
        found.map_err(|fault| Error::Input(vec![fault]))
    }
}

/// The three models of a specimen, each as far as its path goes.
struct Models {
    reference: Reference,
    on_lattice: OnLattice,
}

impl Models {
    fn solve(
        specimen: &Specimen,
        ends: &mut Vec<end::End>,
        progress: Progress,
    ) -> Result<Self, Error> {
        progress("finite elements");
        let reference = Reference::solve(specimen, ends)?;
        let on_lattice = OnLattice::solve(specimen, ends, progress)?;
        Ok(Self {
            reference,
            on_lattice,
        })
    }

    /// The models with their names for people and for files: springs, corrected, finite elements.
    fn named(&self) -> [(&'static str, &'static str, &Mesh, &Solved); 3] {
        let OnLattice {
            springs,
            uncorrected,
            corrected,
            ..
        } = &self.on_lattice;
        let Reference { mesh, solved, .. } = &self.reference;
        [
            ("mass-spring", "mass_spring", &springs.mesh, uncorrected),
            ("corrected", "corrected", &springs.mesh, corrected),
            ("finite elements", "finite_element", mesh, solved),
        ]
    }

    /// How many load factors at least one model has reached.
    fn reached(&self) -> usize {
        let reached = self.named().map(|(_, _, _, solved)| solved.reached());
        reached.into_iter().max().unwrap_or(0)
    }
}

/// What is measured on the finest finite elements at the last load factor, and its own error in %.
///
/// # Errors
/// [`Error::Solve`] when they have no solution.
pub fn force_with_error(specimen: &Specimen) -> Result<(f64, f64), Error> {
    let mut ends = Vec::new();
    let reference = Reference::solve(specimen, &mut ends)?;
    if let Some(end) = ends.pop() {
        return Err(end.error());
    }
    let last = specimen.factors.len() - 1;
    let force = reference.solved.measured(&reference.measured, last);
    let own = reference.measured_percent(last);
    Ok((force.unwrap_or(f64::NAN), own.unwrap_or(f64::NAN)))
}

/// The mesh of the finest finite elements; a specimen that refines itself is solved for it.
///
/// # Errors
/// [`Error::Solve`] when it must be solved and has no solution.
pub fn finest_mesh(specimen: &Specimen) -> Result<Mesh, Error> {
    if specimen.refinement.is_none() {
        let [_, _, mesh] = specimen.outline.reference_meshes();
        return Ok(mesh);
    }
    let mut ends = Vec::new();
    let OnMesh { mesh, .. } = reference::finest(specimen, &mut ends)?;
    ends.pop().map_or(Ok(mesh), |end| Err(end.error()))
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
    progress("finite elements");
    let OnMesh { mesh, solved } = reference::finest(&specimen, &mut ends)?;
    let OnLattice {
        springs,
        uncorrected,
        corrected,
        ..
    } = OnLattice::solve(&specimen, &mut ends, progress)?;
    if let Some(end) = ends.first() {
        return Err(end.error());
    }
    let field = |model, mesh: Mesh, mut solved: Solved| ModelField {
        model,
        mesh,
        displacement: solved.states.pop().expect("the last factor").displacement,
    };
    Ok([
        field("finite elements", mesh, solved),
        field("mass-spring", springs.mesh.clone(), uncorrected),
        field("corrected", springs.mesh, corrected),
    ])
}

fn compute(specimen: &Specimen, progress: Progress) -> Result<Outcome, Error> {
    let mut ends = Vec::new();
    let mut models = Models::solve(specimen, &mut ends, progress)?;
    if models.reference.may_be_finer(specimen) && outcome::is_open(specimen, &models) {
        progress("finer finite elements");
        models.reference = models.reference.finer(specimen, &mut ends)?;
    }
    if models.reached() == 0 && ends.iter().all(end::End::is_empty) {
        // Not even an equilibrium on the way to the first load factor.
        let first = ends.first().map(end::End::error);
        return first.map_or(Ok(Outcome::default()), Err);
    }
    let mut outcome = outcome::outcome(specimen, &models);
    end::tell(specimen, &models.reference.measured, ends, &mut outcome);
    Ok(outcome)
}
