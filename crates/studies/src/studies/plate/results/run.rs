//! The flow of a study: problem, models, corrector, comparison.

use std::cell::Cell;

use rayon::prelude::*;
use web_time::Instant;

use super::{ReferenceMesh, Results};
use crate::compare::imported::{ModelField, ModelFields};
use crate::compare::{Reference, StepComparison};
use crate::corrector::PlateCorrector;
use crate::corrector::climb::{Climb, between_nodes};
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::error::Error;
use crate::finite_element::error_estimate::ErrorEstimate;
use crate::finite_element::recovery::Recovery;
use crate::finite_element::{FiniteElements, Quarter};
use crate::mass_spring::MassSpring;
use crate::material::softened_law::check_memory;
use crate::mesh::Mesh;
use crate::problem::{ClampedPlate, Measures, Model, Solution};
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::solve::{NewtonSettings, State};
use crate::studies::plate::problem::Study;
use crate::studies::{ModelKind, OneModel, Progress};

/// How many times [`run`] reports progress for a study.
pub fn progress_steps(study: &Study) -> usize {
    5 * study.problem.stretches.len()
}

/// Computes a study. Each model and stretch that is done is told. A model that ends early leaves the others
/// their way: the results hold what there is, and why there is no more.
///
/// # Errors
/// [`Error::Solve`] of the first model where no model has any solution.
pub fn run(study: &Study, progress: Progress) -> Result<Results, Error> {
    if study.lattice.area_term {
        check_memory(&*study.problem.law, "the area term of the lattice")?;
    }
    let mut run = Run::new(study, progress);
    let plate = &study.problem;
    let springs = MassSpring::new(plate, study.cells, study.lattice);
    let uncorrected = run.solve(MASS_SPRING.name, &springs.model(plate), study.mass_spring);
    let corrected_mesh = study.corrected_mesh();
    let corrected = run.timed("corrector", |run| {
        run.correct(&uncorrected, &corrected_mesh)
    });
    let reference = run.reference();
    let [.., finest] = &reference;
    let estimates = run.timed("finite elements' error", |_| estimates(plate, finest));
    let meshes = reference.each_ref();
    let meshes = meshes.map(|mesh| (&mesh.model, &mesh.solution.states[..]));
    let reference_field = Reference::new(plate, meshes);
    let lattice = &springs.mesh;
    let compare = |(step, stretch): (usize, &f64)| {
        let deviation = |mesh, state, past: &[&[f64]], measures| {
            reference_field.deviation(mesh, state, past, measures, step)
        };
        let springs = uncorrected.states.get(step);
        let past = corrected[..step].iter().flatten();
        let past: Vec<&[f64]> = past.map(|own| &own.state.displacement[..]).collect();
        StepComparison {
            stretch: *stretch,
            mass_spring: springs.and_then(|state| {
                let measures = Measures::of(lattice, state);
                deviation(lattice, state, &uncorrected.past(step), measures)
            }),
            corrected: corrected[step]
                .as_ref()
                .and_then(|own| deviation(&corrected_mesh, &own.state, &past, own.measures)),
            reference: reference_field.self_convergence(step),
        }
    };
    Ok(Results {
        reference_on: [lattice, &corrected_mesh].map(|mesh| reference_field.displacements_on(mesh)),
        comparison: (plate.stretches.par_iter().enumerate())
            .map(compare)
            .collect(),
        remembers: plate.law.softening().is_some(),
        springs,
        corrected_mesh,
        uncorrected,
        corrected,
        reference,
        estimates,
        ends: run.ends,
        times: run.times,
    })
}

/// The estimated errors of the finest finite elements; `None` where the tangent cannot be factorised.
fn estimates(plate: &ClampedPlate, finest: &ReferenceMesh) -> Vec<Option<ErrorEstimate>> {
    let states = &finest.solution.states;
    if plate.law.softening().is_some() {
        // Recovery knows no history.
        return vec![None; states.len()];
    }
    let recovery = Recovery::new(&finest.model.mesh);
    let found = finest.model.estimates(plate, states, &recovery);
    let complete =
        |found: Result<ErrorEstimate, _>| found.ok().filter(|own| own.energy.is_complete);
    found.into_iter().map(complete).collect()
}

/// One model of a study alone.
pub fn one_model(study: &Study, kind: ModelKind, progress: Progress) -> OneModel {
    let mut run = Run::new(study, progress);
    let plate = &study.problem;
    if kind == ModelKind::FiniteElement {
        // The first guesses come from the coarser meshes, as in a run.
        let [.., finest] = run.reference();
        let is_whole = finest.solution.reached() == plate.stretches.len();
        let ends = run.ends.pop().filter(|_| !is_whole);
        return of_solution(study, kind, finest.solution, ends.into_iter().collect());
    }
    let springs = MassSpring::new(plate, study.cells, study.lattice);
    let uncorrected = run.solve(MASS_SPRING.name, &springs.model(plate), study.mass_spring);
    if kind == ModelKind::MassSpring {
        return of_solution(study, kind, uncorrected, run.ends);
    }
    // Where the springs end early the correction goes on.
    run.ends.clear();
    let mesh = study.corrected_mesh();
    let found = run.correct(&uncorrected, &mesh).into_iter();
    let found: Vec<CorrectedState> = found.flatten().collect();
    let energy = study.corrector.scheme.energy(plate, &mesh);
    let forces = found.iter().map(|own| own.measures.force).collect();
    let (states, multipliers) = found
        .into_iter()
        .map(|own| (own.state, own.multipliers))
        .unzip();
    let solution = Solution::new(&plate.on(&mesh, &energy), &GRIPS, states);
    OneModel {
        forces,
        multipliers,
        ends: run.ends,
        warnings: warnings(study, kind, &solution),
        solution,
    }
}

/// The names of the grips.
const GRIPS: [&str; 2] = ["left", "right"];

fn warnings(study: &Study, kind: ModelKind, solution: &Solution) -> Vec<String> {
    let describe = ClampedPlate::describe_step;
    kind.warnings(&study.card, study.sheet(), solution, describe)
}

fn of_solution(study: &Study, kind: ModelKind, solution: Solution, ends: Vec<Error>) -> OneModel {
    let states = solution.states.iter();
    let forces = states.map(|state| Measures::of(&solution.mesh, state).force);
    OneModel {
        forces: forces.collect(),
        multipliers: vec![Vec::new(); solution.reached()],
        warnings: warnings(study, kind, &solution),
        solution,
        ends,
    }
}

/// A study under way.
struct Run<'a> {
    study: &'a Study,
    progress: Progress<'a>,
    /// What was done, and how long it took in s.
    times: Vec<(&'static str, f64)>,
    /// Why models have no solution at stretches of the study.
    ends: Vec<Error>,
}

impl<'a> Run<'a> {
    fn new(study: &'a Study, progress: Progress<'a>) -> Self {
        Self {
            study,
            progress,
            times: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// The finite elements on three meshes, each beginning with the equilibria of the one before.
    fn reference(&mut self) -> [ReferenceMesh; 3] {
        let names = [
            "finite elements, coarse",
            "finite elements, middle",
            "finite elements, fine",
        ];
        let mut names = names.into_iter();
        let mut coarser: Option<(Mesh, Vec<State>)> = None;
        self.study.finite_elements().map(|elements| {
            let name = names.next().expect("three meshes");
            let before = coarser.as_ref();
            let before = before.map(|(mesh, states)| (mesh, &states[..]));
            let solution = self.solve_elements(name, &elements, before);
            coarser = Some((solution.mesh.clone(), solution.states.clone()));
            ReferenceMesh {
                model: elements,
                solution,
            }
        })
    }

    /// Solves finite elements at the study's stretches, as far as there are solutions: by a quarter of them where that serves.
    fn solve_elements(
        &mut self,
        name: &'static str,
        elements: &FiniteElements,
        coarser: Option<(&Mesh, &[State])>,
    ) -> Solution {
        let (plate, settings) = (&self.study.problem, self.study.reference.newton);
        let mut model = elements.model(plate);
        if let Some((mesh, states)) = coarser {
            model = model.near(mesh, states);
        }
        let states = self.timed(name, |run| {
            // What the quarter has told of is not told again.
            let (progress, farthest) = (run.progress, Cell::new(0.0));
            let told = |stretch: f64| {
                if stretch.abs() > farthest.get() {
                    farthest.set(stretch.abs());
                    tell(progress, name, stretch);
                }
            };
            let quarter = Quarter::of(plate, elements);
            let by_quarter = quarter.and_then(|quarter| {
                let attendance = progress.along(&told);
                quarter.states(&model, &plate.stretches, coarser, settings, attendance)
            });
            by_quarter.unwrap_or_else(|| run.path(&model, settings, &told))
        });
        Solution::new(&model, &GRIPS, states)
    }

    /// Solves a model at the study's stretches, as far as there are solutions.
    fn solve(&mut self, name: &'static str, model: &Model, settings: NewtonSettings) -> Solution {
        let states = self.timed(name, |run| {
            let progress = run.progress;
            run.path(model, settings, &|stretch| tell(progress, name, stretch))
        });
        Solution::new(model, &GRIPS, states)
    }

    /// The states of a model as far as there are some; the end is kept.
    fn path(&mut self, model: &Model, settings: NewtonSettings, told: &dyn Fn(f64)) -> Vec<State> {
        let attendance = self.progress.along(told);
        let states = model.attended(&self.study.problem.stretches, settings, attendance);
        states.unwrap_or_else(|end| {
            self.ends.push(model.error(&end));
            end.states
        })
    }

    /// The corrected field at every stretch, on a mesh to whose nodes the springs' is interpolated. Where the springs have no field the
    /// affine stretch takes its place: it has a say in the multipliers, and in where the direct method begins.
    fn correct(&mut self, springs: &Solution, mesh: &Mesh) -> Vec<Option<CorrectedState>> {
        let (study, plate) = (self.study, &self.study.problem);
        let settings = &study.corrector;
        let mut corrector = Some(PlateCorrector::new(
            plate,
            mesh,
            settings.scheme,
            settings.direct,
        ));
        let mut climb = settings.climb.map(|climb| {
            Climb::graded(plate, study.cells, settings.scheme, settings.grading, climb)
        });
        let remembers = plate.law.softening().is_some();
        let mut correct = |(step, stretch): (usize, &f64)| {
            let affine = || plate.affine(mesh, *stretch);
            let on_nodes = |field: &[f64]| {
                if settings.is_graded() {
                    springs.mesh.displacement_on(field, mesh)
                } else {
                    field.to_vec()
                }
            };
            let data = springs.displacement(step).map_or_else(affine, on_nodes);
            let own = corrector.take()?;
            let corrected = match &mut climb {
                Some(climb) => own.climb(climb, &data, *stretch),
                None => own.correct(&data, *stretch, KnownConditions::ALL),
            };
            // What a body remembers of a state that was not found is not known: nothing follows it.
            corrector = match &corrected {
                Ok(found) => Some(own.after(&found.state)),
                Err(_) => (!remembers).then_some(own),
            };
            tell(self.progress, "corrector", *stretch);
            corrected.map_err(|end| self.ends.push(end)).ok()
        };
        let stretches = plate.stretches.iter().enumerate();
        stretches.map(&mut correct).collect()
    }

    fn timed<T>(&mut self, what: &'static str, work: impl FnOnce(&mut Self) -> T) -> T {
        let start = Instant::now();
        let result = work(self);
        self.times.push((what, start.elapsed().as_secs_f64()));
        result
    }
}

/// Says that a model is solved at a stretch.
fn tell(progress: Progress, model: &str, stretch: f64) {
    let step = ClampedPlate::describe_step(stretch);
    progress.tell(&format!("{model}, {step}"));
}

/// The fields of all models of a plate at a stretch: finite elements on the finest mesh, springs, corrected springs.
/// The study's stretches before it are steps on the way.
///
/// # Errors
/// [`Error::Solve`] with the model and the stretch at which no solution was found.
pub fn fields(mut study: Study, stretch: f64, progress: Progress) -> Result<ModelFields, Error> {
    check_memory(
        &*study.problem.law,
        "a comparison with another program's field",
    )?;
    let stretches = &mut study.problem.stretches;
    stretches.retain(|before| *before * stretch > 0.0 && before.abs() < stretch.abs());
    stretches.push(stretch);
    let last = stretches.len() - 1;
    let mut results = run(&study, progress)?;
    let ends = std::mem::take(&mut results.ends);
    let field = |model, mesh: &Mesh, displacement: Option<Vec<f64>>| {
        Some(ModelField {
            model,
            mesh: mesh.clone(),
            displacement: displacement?,
        })
    };
    let displacement = |state: Option<&State>| state.map(|state| state.displacement.clone());
    let [springs, corrected, elements] = results.models(last);
    let [lattice, cells, finest] = results.meshes();
    // Between its nodes the corrected field is what its differences take it for.
    let scheme = study.corrector.scheme;
    let between = corrected.map(|state| between_nodes(scheme, cells, &state.displacement));
    let fields = [
        field(FINITE_ELEMENTS.name, finest, displacement(elements)),
        field(MASS_SPRING.name, lattice, displacement(springs)),
        field(CORRECTED.name, &scheme.mesh(cells), between),
    ];
    let own = results.comparison[last].reference;
    ModelFields::of(fields, ends, own.map(|own| own.displacement_percent))
}

#[cfg(test)]
mod tests;
