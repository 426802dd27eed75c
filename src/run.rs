//! The flow of a study: problem, models, corrector, comparison.

use std::time::Instant;

use crate::compare::imported::ModelField;
use crate::compare::{Reference, StepComparison};
use crate::corrector::PlateCorrector;
use crate::corrector::climb::Climb;
use crate::corrector::plate::KnownConditions;
use crate::error::Error;
use crate::finite_element::FiniteElements;
use crate::finite_element::recovery::Recovery;
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::problem::Solution;
use crate::results::{ReferenceMesh, Results};
use crate::study::Study;

/// How many times [`run`] reports progress for a study.
pub fn progress_steps(study: &Study) -> usize {
    5 * study.problem.stretches.len()
}

/// Computes a study. `progress` is told each model and stretch that is done.
///
/// # Errors
/// [`Error::Solve`] with the model and the stretch at which no solution was found.
pub fn run(study: &Study, progress: Progress) -> Result<Results, Error> {
    let problem = &study.problem;
    let mut times = Vec::new();

    let springs = MassSpring::new(problem, study.cells, study.lattice);
    let uncorrected = timed(&mut times, "mass-spring", || {
        let told = |stretch: f64| progress("mass-spring", stretch);
        springs.solve(problem, study.mass_spring, &told)
    })?;
    let corrected = timed(&mut times, "corrector", || {
        let corrector = PlateCorrector::new(problem, &springs.mesh, study.scheme, study.corrector);
        let mut climb = study
            .climb
            .map(|settings| Climb::even(problem, study.cells, study.scheme, settings));
        let correct = |field: &Solution| {
            let (data, stretch) = (&field.displacement, field.stretch);
            let state = match &mut climb {
                Some(climb) => corrector.climb(climb, data, stretch)?,
                None => corrector.correct(data, stretch, KnownConditions::ALL)?,
            };
            progress("corrector", field.stretch);
            Ok(state)
        };
        uncorrected
            .iter()
            .map(correct)
            .collect::<Result<Vec<_>, Error>>()
    })?;
    let reference = finite_elements(study, &mut times, progress)?;
    let estimates = timed(&mut times, "finite elements' error", || {
        let [.., finest] = &reference;
        let recovery = Recovery::new(&finest.model.mesh);
        let estimate = |solution| finest.model.estimate(problem, solution, &recovery);
        let estimates = finest.solutions.iter().map(estimate);
        estimates.collect::<Result<Vec<_>, Error>>()
    })?;

    let measure = Reference::new(
        problem,
        reference
            .each_ref()
            .map(|mesh| (&mesh.model, &mesh.solutions[..])),
    );
    let steps = 0..problem.stretches.len();
    let compare = |step: usize| StepComparison {
        stretch: problem.stretches[step],
        mass_spring: measure.deviation(&springs.mesh, &uncorrected[step], step),
        corrected: measure.deviation(&springs.mesh, &corrected[step].solution, step),
        reference: measure.self_convergence(step),
    };
    let comparison = steps.clone().map(compare).collect();
    let on_lattice = |step| measure.displacement_on(&springs.mesh, step);
    Ok(Results {
        reference_on_lattice: steps.map(on_lattice).collect(),
        springs,
        uncorrected,
        corrected,
        reference,
        estimates,
        comparison,
        times,
    })
}

/// The fields of all models of a plate at a stretch: finite elements on the finest mesh, springs, corrected springs.
/// The study's stretches before it are steps on the way.
///
/// # Errors
/// [`Error::Solve`] with the model and the stretch at which no solution was found.
pub fn fields(
    mut study: Study,
    stretch: f64,
    progress: Progress,
) -> Result<[ModelField; 3], Error> {
    let stretches = &mut study.problem.stretches;
    stretches.retain(|before| *before < stretch);
    stretches.push(stretch);
    let results = run(&study, progress)?;
    let finest = results.finest();
    let field = |model, mesh: &Mesh, solution: Option<&Solution>| ModelField {
        model,
        mesh: mesh.clone(),
        displacement: solution.expect("the last stretch").displacement.clone(),
    };
    let lattice = &results.springs.mesh;
    let corrected = results.corrected.last().map(|state| &state.solution);
    Ok([
        field(
            "finite elements",
            &finest.model.mesh,
            finest.solutions.last(),
        ),
        field("mass-spring", lattice, results.uncorrected.last()),
        field("corrected", lattice, corrected),
    ])
}

/// Is told each model and stretch that is done.
type Progress<'a> = &'a dyn Fn(&str, f64);
/// What was done, and how long it took in s.
type Times = Vec<(&'static str, f64)>;

/// The reference on three meshes, coarse to fine.
fn finite_elements(
    study: &Study,
    times: &mut Times,
    progress: Progress,
) -> Result<[ReferenceMesh; 3], Error> {
    let mut solve = |name, cells| -> Result<ReferenceMesh, Error> {
        let model = FiniteElements::graded(&study.problem, cells, study.element, study.grading);
        let told = |stretch: f64| progress(name, stretch);
        let solve = || model.solve(&study.problem, study.finite_element, &told);
        let solutions = timed(times, name, solve)?;
        Ok(ReferenceMesh { model, solutions })
    };
    let [coarse, middle, fine] = study.reference_meshes();
    Ok([
        solve("finite elements, coarse", coarse)?,
        solve("finite elements, middle", middle)?,
        solve("finite elements, fine", fine)?,
    ])
}

fn timed<T>(times: &mut Times, what: &'static str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    times.push((what, start.elapsed().as_secs_f64()));
    result
}
