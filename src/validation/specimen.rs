//! A specimen of any shape in all three models: springs, corrected springs, finite elements.

use std::path::Path;

use crate::boundary::{BoundaryProblem, Discretised};
use crate::compare::imported::ModelField;
use crate::corrector::{CorrectorSettings, Solver, specimen::correct};
use crate::document::Section;
use crate::error::{Diagnostic, Error};
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::output::vtk;
use crate::solve::{NewtonSettings, Potential, State};
use crate::validation::{Case, Outcome, Prepared, Progress};

mod end;
mod files;
mod outcome;
mod read;
mod reference;

use end::End;
use read::Measured;
pub use read::{Refinement, Specimen, Tolerances};
use reference::Reference;

/// The `kind` of these studies.
pub const KIND: &str = "specimen";

/// A specimen's study: its title, the specimen, and what deserves attention.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Case,
    file: &Path,
    text: &str,
) -> Result<(String, Specimen, Vec<Diagnostic>), Error> {
    let (title, specimen, warnings) = case.read_with(file, text, read::read)?;
    let specimen = specimen.expect("a study without faults has a specimen");
    Ok((title, specimen, warnings))
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let specimen = read::read(root, folder);
    Box::new(move |progress| {
        specimen.map_or(Ok(Outcome::default()), |read| compute(read, progress))
    })
}

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

const CORRECTOR: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-8,
    movement: 1e-9,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// The states of one model and what is measured at each load factor: force in N or displacement in mm.
struct Solved {
    states: Vec<State>,
    measured: Vec<f64>,
}

impl Solved {
    fn new(specimen: &Specimen, model: &Discretised, states: Vec<State>) -> Self {
        let measured = states.iter().map(|state| specimen.measure(model, state));
        Self {
            measured: measured.collect(),
            states,
        }
    }
}

/// Solves as many load factors as can be reached; where others cannot, the end is told.
fn solve(
    specimen: &Specimen,
    model: &Discretised,
    names: [&str; 2],
    mesh: &Mesh,
    ends: &mut Vec<End>,
) -> Solved {
    let states = match model.solve(&specimen.factors, NEWTON, &|_| ()) {
        Ok(states) => states,
        Err(end) => {
            let last = end.last.as_deref().or(end.states.last());
            let measured = last.map_or(0.0, |state| specimen.measure(model, state));
            ends.push(End::of_path(names, mesh, &end, measured));
            end.states
        }
    };
    Solved::new(specimen, model, states)
}

impl Specimen {
    /// What is measured, with its axis: the larger component of the force on the measured group in N with its sign, or the
    /// displacement in mm of a grip with a given force.
    fn component(&self, model: &Discretised, state: &State) -> (usize, f64) {
        if let Measured::Displacement(axis) = self.measured() {
            return (axis, model.displacement(state, &self.measured)[axis]);
        }
        let [x, y] = model.reaction(state, &self.measured);
        if x.abs() >= y.abs() { (0, x) } else { (1, y) }
    }

    fn measure(&self, model: &Discretised, state: &State) -> f64 {
        self.component(model, state).1
    }

    /// What stresses follow from.
    fn sheet(&self) -> vtk::Sheet<'_> {
        vtk::Sheet {
            law: &*self.problem.law,
            thickness: self.problem.thickness,
        }
    }

    /// The problem on a mesh; groups were checked when the study was read.
    fn on<'a>(
        &self,
        problem: &BoundaryProblem,
        mesh: &'a Mesh,
        energy: &'a dyn Potential,
    ) -> Result<Discretised<'a>, Error> {
        problem
            .on(mesh, energy)
            .map_err(|found| Error::Input(vec![found]))
    }
}

/// The three models of a specimen, as far as their paths go.
struct Models {
    reference: Reference,
    springs: MassSpring,
    uncorrected: Solved,
    corrected: Solved,
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
    let force = reference.solved.measured[last];
    Ok((force, reference.measured_percent(last)))
}

/// The mesh of the finest finite elements; a specimen that refines itself is solved for it.
///
/// # Errors
/// [`Error::Solve`] when it must be solved and has no solution.
pub fn finest_mesh(specimen: &Specimen) -> Result<Mesh, Error> {
    if specimen.refinement.is_none() {
        let [_, _, mesh] = specimen.reference_meshes();
        return Ok(mesh);
    }
    let mut ends = Vec::new();
    let (mesh, _) = reference::finest(specimen, &mut ends)?;
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
    let (mesh, reference) = reference::finest(&specimen, &mut ends)?;
    let (springs, [uncorrected, corrected]) = on_lattice(&specimen, &mut ends, progress)?;
    if let Some(end) = ends.first() {
        return Err(end.error());
    }
    let field = |model, mesh: Mesh, mut solved: Solved| ModelField {
        model,
        mesh,
        displacement: solved.states.pop().expect("the last factor").displacement,
    };
    Ok([
        field("finite elements", mesh, reference),
        field("mass-spring", springs.mesh.clone(), uncorrected),
        field("corrected", springs.mesh, corrected),
    ])
}

fn compute(mut specimen: Specimen, progress: Progress) -> Result<Outcome, Error> {
    let mut ends = Vec::new();
    progress("finite elements");
    let reference = Reference::solve(&specimen, &mut ends)?;
    let (springs, [uncorrected, corrected]) = on_lattice(&specimen, &mut ends, progress)?;
    let on_lattice = uncorrected.states.len().min(corrected.states.len());
    specimen
        .factors
        .truncate(reference.reached().min(on_lattice));
    let mut outcome = if specimen.factors.is_empty() {
        end::without_state(&ends)?
    } else {
        let models = Models {
            reference,
            springs,
            uncorrected,
            corrected,
        };
        outcome::outcome(&specimen, &models)
    };
    end::tell(&specimen, ends, &mut outcome);
    Ok(outcome)
}

/// The springs, and the states of them before and after the correction.
fn on_lattice(
    specimen: &Specimen,
    ends: &mut Vec<End>,
    progress: Progress,
) -> Result<(MassSpring, [Solved; 2]), Error> {
    let problem = &specimen.problem;
    progress("mass-spring");
    let springs = MassSpring::on_mesh(&problem.law, problem.thickness, specimen.lattice());
    let lattice = &springs.mesh;
    let model = specimen.on(problem, lattice, springs.potential())?;
    let model = model.named(|element| springs.describe_element(element));
    let names = ["mass-spring", "mass_spring"];
    let uncorrected = solve(specimen, &model, names, lattice, ends);
    drop(model);

    progress("corrector");
    let energy = problem.finite_elements(lattice);
    let model = specimen.on(problem, lattice, &energy)?;
    let corrected = correct_all(specimen, &model, lattice, &uncorrected, ends);
    drop(model);
    Ok((springs, [uncorrected, corrected]))
}

/// Corrects the states of the springs as far as they can be.
fn correct_all(
    specimen: &Specimen,
    model: &Discretised,
    lattice: &Mesh,
    uncorrected: &Solved,
    ends: &mut Vec<End>,
) -> Solved {
    let mut states: Vec<State> = Vec::new();
    let mut change = vec![0.0; 2 * lattice.nodes.len()];
    for state in &uncorrected.states {
        // What the correction has changed at the load factor before is nearly right at this one.
        let data = &state.displacement;
        let pairs = data.iter().zip(&change);
        let start: Vec<f64> = pairs.map(|(u, change)| u + change).collect();
        match correct(lattice, model, data, &start, state.factor, CORRECTOR) {
            Ok(field) => {
                let pairs = field.state.displacement.iter().zip(data);
                change = pairs.map(|(corrected, u)| corrected - u).collect();
                states.push(field.state);
            }
            Err(fault) => {
                ends.push(End::at("corrector", state.factor, fault));
                break;
            }
        }
    }
    Solved::new(specimen, model, states)
}
