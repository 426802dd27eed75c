//! The flow of a study: problem, models, corrector, comparison.

use std::time::Instant;

use crate::compare::imported::ModelField;
use crate::compare::{Reference, StepComparison};
use crate::corrector::PlateCorrector;
use crate::corrector::climb::Climb;
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::error::Error;
use crate::finite_element::FiniteElements;
use crate::finite_element::recovery::Recovery;
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::problem::{Measures, Model};
use crate::solve::{NewtonSettings, State};
use crate::studies::plate::Study;
use crate::studies::plate::results::{ReferenceMesh, Results};

/// How many times [`run`] reports progress for a study.
pub fn progress_steps(study: &Study) -> usize {
    5 * study.problem.stretches.len()
}

/// Computes a study. `progress` is told each model and stretch that is done. A model that ends early leaves the others
/// their way: the results hold what there is, and why there is no more.
///
/// # Errors
/// [`Error::Solve`] of the first model where no model has any solution.
pub fn run(study: &Study, progress: Progress) -> Result<Results, Error> {
    let problem = &study.problem;
    let (mut times, mut ends) = (Vec::new(), Vec::new());

    let springs = MassSpring::new(problem, study.cells, study.lattice);
    let uncorrected = timed(&mut times, "mass-spring", || {
        let told = |stretch: f64| progress("mass-spring", stretch);
        as_far(
            &springs.model(problem),
            study,
            study.mass_spring,
            &mut ends,
            &told,
        )
    });
    let corrected = timed(&mut times, "corrector", || {
        let mut keep = |state: Result<_, Error>| state.map_err(|end| ends.push(end)).ok();
        let states = correct(study, &springs.mesh, &uncorrected, progress).into_iter();
        states.map(&mut keep).collect::<Vec<_>>()
    });
    let reference = finite_elements(study, &mut times, &mut ends, progress);
    let estimates = timed(&mut times, "finite elements' error", || {
        let [.., finest] = &reference;
        let recovery = Recovery::new(&finest.model.mesh);
        let estimate = |solution| finest.model.estimate(problem, solution, &recovery).ok();
        finest.solutions.iter().map(estimate).collect()
    });

    let nothing = uncorrected.is_empty() && corrected.iter().all(Option::is_none);
    if nothing && reference[2].solutions.is_empty() {
        return Err(ends.swap_remove(0));
    }
    let measure = Reference::new(
        problem,
        reference
            .each_ref()
            .map(|mesh| (&mesh.model, &mesh.solutions[..])),
    );
    let compare = |(step, stretch): (usize, &f64)| {
        let lattice = &springs.mesh;
        let springs = |state| measure.deviation(lattice, state, Measures::of(lattice, state), step);
        let state: Option<&CorrectedState> = corrected[step].as_ref();
        StepComparison {
            stretch: *stretch,
            mass_spring: uncorrected.get(step).and_then(springs),
            corrected: state
                .and_then(|own| measure.deviation(lattice, &own.state, own.measures, step)),
            reference: measure.self_convergence(step),
        }
    };
    let comparison = problem.stretches.iter().enumerate().map(compare).collect();
    Ok(Results {
        reference_on_lattice: measure.displacements_on(&springs.mesh),
        comparison,
        springs,
        uncorrected,
        corrected,
        reference,
        estimates,
        ends,
        times,
    })
}

/// The corrected field at every stretch. Where the springs have no field the affine stretch takes its place: it has a
/// say in the multipliers, and in where the direct method begins.
fn correct(
    study: &Study,
    lattice: &Mesh,
    springs: &[State],
    progress: Progress,
) -> Vec<Result<CorrectedState, Error>> {
    let problem = &study.problem;
    let corrector = PlateCorrector::new(
        problem,
        lattice,
        study.corrector.scheme,
        study.corrector.direct,
    );
    let mut climb = study
        .corrector
        .climb
        .map(|settings| Climb::even(problem, study.cells, study.corrector.scheme, settings));
    let mut state = |(step, stretch): (usize, &f64)| {
        let affine = || problem.affine(lattice, *stretch);
        let own = springs.get(step).map(|solution| &solution.displacement);
        let data = own.map_or_else(affine, Clone::clone);
        let state = match &mut climb {
            Some(climb) => corrector.climb(climb, &data, *stretch),
            None => corrector.correct(&data, *stretch, KnownConditions::ALL),
        };
        progress("corrector", *stretch);
        state
    };
    let stretches = problem.stretches.iter().enumerate();
    stretches.map(&mut state).collect()
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
    stretches.retain(|before| *before * stretch > 0.0 && before.abs() < stretch.abs());
    stretches.push(stretch);
    let last = stretches.len() - 1;
    let mut results = run(&study, progress)?;
    if let Some(end) = results.ends.pop() {
        return Err(end);
    }
    let field = |model, mesh: &Mesh, solution: Option<&State>| ModelField {
        model,
        mesh: mesh.clone(),
        displacement: solution.expect("no model ended").displacement.clone(),
    };
    let [springs, corrected, elements] = results.models(last);
    let lattice = &results.springs.mesh;
    Ok([
        field("finite elements", &results.finest().model.mesh, elements),
        field("mass-spring", lattice, springs),
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
    ends: &mut Vec<Error>,
    progress: Progress,
) -> [ReferenceMesh; 3] {
    let names = [
        "finite elements, coarse",
        "finite elements, middle",
        "finite elements, fine",
    ];
    let [coarse, middle, fine] = study.reference.meshes();
    [(names[0], coarse), (names[1], middle), (names[2], fine)].map(|(name, cells)| {
        let problem = &study.problem;
        let model = FiniteElements::graded(
            problem,
            cells,
            study.reference.element,
            study.reference.grading,
        );
        let told = |stretch: f64| progress(name, stretch);
        let solutions = timed(times, name, || {
            as_far(
                &model.model(problem),
                study,
                study.reference.newton,
                ends,
                &told,
            )
        });
        ReferenceMesh { model, solutions }
    })
}

/// The states of a model at the study's stretches as far as there are any; its end is told where there are no more.
fn as_far(
    model: &Model,
    study: &Study,
    settings: NewtonSettings,
    ends: &mut Vec<Error>,
    progress: &dyn Fn(f64),
) -> Vec<State> {
    let states = model.solve(&study.problem.stretches, settings, progress);
    states.unwrap_or_else(|end| {
        ends.push(model.error(&end));
        end.states
    })
}

fn timed<T>(times: &mut Times, what: &'static str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    times.push((what, start.elapsed().as_secs_f64()));
    result
}
