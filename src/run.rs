//! The flow of a study: problem, models, corrector, comparison.

use std::time::Instant;

use crate::compare::{Reference, StepComparison};
use crate::corrector::PlateCorrector;
use crate::corrector::plate::KnownConditions;
use crate::error::Error;
use crate::finite_element::FiniteElements;
use crate::mass_spring::MassSpring;
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
pub fn run(study: &Study, progress: &dyn Fn(&str, f64)) -> Result<Results, Error> {
    let problem = &study.problem;
    let mut times = Vec::new();

    let springs = MassSpring::new(problem, study.cells, study.lattice);
    let uncorrected = timed(&mut times, "mass-spring", || {
        springs.solve(problem, study.mass_spring, &|stretch| {
            progress("mass-spring", stretch)
        })
    })?;

    let corrected = timed(&mut times, "corrector", || {
        let corrector = PlateCorrector::new(problem, &springs.mesh, study.scheme, study.corrector);
        let correct = |field: &crate::problem::Solution| {
            let data = &field.displacement;
            let corrected = corrector.correct(data, field.stretch, KnownConditions::ALL)?;
            progress("corrector", field.stretch);
            Ok(corrected)
        };
        uncorrected
            .iter()
            .map(correct)
            .collect::<Result<Vec<_>, Error>>()
    })?;

    let names = [
        "finite elements, coarse",
        "finite elements, middle",
        "finite elements, fine",
    ];
    let [coarse, middle, fine] = study.reference_meshes();
    let mut solve = |name, cells| -> Result<ReferenceMesh, Error> {
        let model = FiniteElements::new(problem, cells, study.element);
        let told = |stretch: f64| progress(name, stretch);
        let solutions = timed(&mut times, name, || {
            model.solve(problem, study.finite_element, &told)
        })?;
        Ok(ReferenceMesh { model, solutions })
    };
    let meshes = [
        solve(names[0], coarse)?,
        solve(names[1], middle)?,
        solve(names[2], fine)?,
    ];

    let reference = Reference::new(
        problem,
        meshes
            .each_ref()
            .map(|mesh| (&mesh.model, &mesh.solutions[..])),
    );
    let compare = |(step, stretch): (usize, &f64)| StepComparison {
        stretch: *stretch,
        mass_spring: reference.deviation(&springs.mesh, &uncorrected[step], step),
        corrected: reference.deviation(&springs.mesh, &corrected[step].solution, step),
        reference: reference.self_convergence(step),
    };
    let comparison = problem.stretches.iter().enumerate().map(compare).collect();
    let on_lattice = |step| reference.displacement_on(&springs.mesh, step);
    Ok(Results {
        reference_on_lattice: (0..problem.stretches.len()).map(on_lattice).collect(),
        springs,
        uncorrected,
        corrected,
        reference: meshes,
        comparison,
        times,
    })
}

fn timed<T>(
    times: &mut Vec<(&'static str, f64)>,
    what: &'static str,
    work: impl FnOnce() -> T,
) -> T {
    let start = Instant::now();
    let result = work();
    times.push((what, start.elapsed().as_secs_f64()));
    result
}
