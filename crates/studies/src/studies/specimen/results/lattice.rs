//! Springs on the lattice of a specimen and their correction, each as far as its path goes.

use super::end::End;
use crate::corrector::nested::{NestedCorrection, NestedMeshes};
use crate::corrector::specimen::{correct, correct_without_multipliers};
use crate::corrector::{CorrectorSettings, Solver};
use crate::error::{Error, SolveFault};
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::problem::{Model, Solution};
use crate::results::models::{CORRECTED, MASS_SPRING};
use crate::solve::vector::difference;
use crate::solve::{Attendance, Loading, NewtonSettings, PathEnd, Stage, State};
use crate::studies::Progress;
use crate::studies::specimen::problem::{LARGE, Specimen};

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

const CORRECTOR: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-10,
    movement: 1e-9,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// Where the corrector began at a load factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// At springs on a coarser mesh.
    Nested,
    /// At the springs' field, with what the correction had changed at the load factor before.
    Springs,
    /// At the equilibrium of the elements, which Newton's method reached from rest in load steps; ū is the
    /// springs' field.
    LoadSteps,
    /// The same, where the springs have no field: ū is that equilibrium itself, and nothing is left to correct.
    Alone,
}

/// Springs on the lattice, and the corrected field on the mesh of the coarsest finite elements.
pub struct OnLattice {
    /// The lattice.
    pub springs: MassSpring,
    /// Before the correction.
    pub uncorrected: Solution,
    /// After it.
    pub corrected: Solution,
    /// Where the corrector began at each load factor that it reached.
    pub starts: Vec<Start>,
    /// The discretisation errors in mm of those that began at springs on a coarser mesh.
    pub discretisation_errors: Vec<f64>,
}

/// Solves as many load factors as can be reached; where others cannot, the end is told. `file` is what the model's files
/// begin with.
pub fn solve(
    specimen: &Specimen,
    model: &Model,
    file: &str,
    ends: &mut Vec<End>,
    progress: Progress,
) -> Solution {
    let told = |factor: f64| progress.tell(&format!("{}, load factor {factor} solved", model.name));
    let on_the_way = |factor: f64| {
        progress.tell(&format!(
            "{}, load factor {factor:.4}, one of many short steps",
            model.name
        ));
    };
    let attendance = Attendance {
        on_the_way: &on_the_way,
        ..progress.along(&told)
    };
    let states = model.attended(&specimen.factors, NEWTON, attendance);
    let states = states.unwrap_or_else(|end| {
        ends.push(End::of_path(specimen, model, file, &end));
        end.states
    });
    Solution::new(model, &specimen.groups(), states)
}

/// The springs on the lattice, as far as they go.
pub fn solve_springs(
    specimen: &Specimen,
    ends: &mut Vec<End>,
    progress: Progress,
) -> Result<(MassSpring, Solution), Error> {
    let problem = &specimen.problem;
    progress.tell(MASS_SPRING.name);
    let lattice = specimen.outline.lattice();
    let springs = MassSpring::on_mesh(&problem.law, problem.thickness, lattice);
    let model = specimen.on(&springs.mesh, springs.potential())?;
    let model = model.named(MASS_SPRING.name);
    let model = model.describing(|element| springs.describe_element(element));
    let uncorrected = solve(specimen, &model, MASS_SPRING.key, ends, progress);
    drop(model);
    Ok((springs, uncorrected))
}

impl OnLattice {
    /// Solves the springs and corrects them; each goes as far as it can, whatever the other does.
    pub fn solve(
        specimen: &Specimen,
        ends: &mut Vec<End>,
        progress: Progress,
    ) -> Result<Self, Error> {
        let (springs, uncorrected) = solve_springs(specimen, ends, progress)?;
        progress.tell("corrector");
        let mesh = specimen.outline.corrected_mesh();
        let nested = correct_nested(specimen, &mesh, progress)?;
        Self::correct(
            specimen,
            &mesh,
            (springs, uncorrected),
            nested,
            ends,
            progress,
        )
    }

    /// Corrects the springs where nested meshes do not lead.
    fn correct(
        specimen: &Specimen,
        mesh: &Mesh,
        (springs, uncorrected): (MassSpring, Solution),
        nested: Vec<NestedCorrection>,
        ends: &mut Vec<End>,
        progress: Progress,
    ) -> Result<Self, Error> {
        let energy = specimen.problem.finite_elements(mesh);
        let model = specimen.on(mesh, &energy)?.named("corrector");
        let (states, discretisation_errors) = nested
            .into_iter()
            .map(|field| (field.state, field.discretisation_error))
            .unzip();
        let corrections = Corrections::new(specimen, &model, progress);
        let (states, starts) = corrections.all(&uncorrected, states, ends);
        let corrected = Solution::new(&model, &specimen.groups(), states);
        drop(model);
        Ok(Self {
            springs,
            uncorrected,
            corrected,
            starts,
            discretisation_errors,
        })
    }
}

/// The corrections on nested meshes at the load factors, as far as they lead; none where the study has no such meshes.
fn correct_nested(
    specimen: &Specimen,
    mesh: &Mesh,
    progress: Progress,
) -> Result<Vec<NestedCorrection>, Error> {
    if !specimen.is_nested(2 * mesh.nodes.len()) {
        return Ok(Vec::new());
    }
    let meshes = specimen.outline.nested_meshes();
    let nested = NestedMeshes::new(&specimen.problem, &meshes);
    let mut fields = Vec::new();
    for factor in &specimen.factors {
        match nested.correct(*factor) {
            Ok(field) => fields.push(field),
            // The rest goes by load steps, which state how far they came.
            Err(Error::Solve { .. }) => break,
            Err(other) => return Err(other),
        }
        progress.tell(&format!("corrector, load factor {factor} solved"));
    }
    Ok(fields)
}

/// The corrected field alone: on nested meshes the lattice's own springs are not needed.
pub fn solve_corrected(
    specimen: &Specimen,
    ends: &mut Vec<End>,
    progress: Progress,
) -> Result<Solution, Error> {
    progress.tell("corrector");
    let mesh = specimen.outline.corrected_mesh();
    let nested = correct_nested(specimen, &mesh, progress)?;
    if nested.len() == specimen.factors.len() {
        let energy = specimen.problem.finite_elements(&mesh);
        let model = specimen.on(&mesh, &energy)?;
        let states = nested.into_iter().map(|field| field.state);
        return Ok(Solution::new(&model, &specimen.groups(), states.collect()));
    }
    let springs = solve_springs(specimen, ends, progress)?;
    let found = OnLattice::correct(specimen, &mesh, springs, nested, ends, progress)?;
    // Where the springs end early the correction goes on.
    ends.retain(|end| !end.is_of(MASS_SPRING.name));
    Ok(found.corrected)
}

/// The corrections at all load factors.
struct Corrections<'a> {
    specimen: &'a Specimen,
    model: &'a Model<'a>,
    progress: Progress<'a>,
    /// The equilibria of the elements by load steps from rest, once they are wanted.
    steps: Option<Result<Vec<State>, PathEnd>>,
}

impl<'a> Corrections<'a> {
    fn new(specimen: &'a Specimen, model: &'a Model<'a>, progress: Progress<'a>) -> Self {
        Self {
            specimen,
            model,
            progress,
            steps: None,
        }
    }

    /// Corrects as many load factors as can be, beyond the states that nested meshes have led to.
    fn all(
        mut self,
        uncorrected: &Solution,
        mut states: Vec<State>,
        ends: &mut Vec<End>,
    ) -> (Vec<State>, Vec<Start>) {
        let mut starts = vec![Start::Nested; states.len()];
        let mut change = vec![0.0; 2 * self.model.mesh.nodes.len()];
        let onto_mesh = uncorrected.mesh.interpolation_on(self.model.mesh);
        let factors = self.specimen.factors.iter().enumerate();
        for (step, factor) in factors.skip(starts.len()) {
            let springs = uncorrected.displacement(step);
            let springs = springs.map(|u| onto_mesh.apply(u));
            let springs = springs.as_deref();
            let history = states.last().map(|before| self.model.remembered(before));
            let history = history.unwrap_or_default();
            let (factor, history) = (*factor, &*history);
            let stage = Stage { factor, history };
            match self.at(step, stage, springs, &change) {
                Ok((state, start)) => {
                    if let Some(data) = springs {
                        change = difference(&state.displacement, data);
                    }
                    states.push(state);
                    starts.push(start);
                }
                Err(end) => {
                    ends.push(*end);
                    break;
                }
            }
        }
        (states, starts)
    }

    /// Corrects the springs' field at a load factor; where there is none, or no way from it, load steps lead there.
    fn at(
        &mut self,
        step: usize,
        stage: Stage<'_>,
        springs: Option<&[f64]>,
        change: &[f64],
    ) -> Result<(State, Start), Box<End>> {
        if let Some(data) = springs {
            // What the correction has changed at the load factor before is nearly right at this one.
            let near: Vec<f64> = data
                .iter()
                .zip(change)
                .map(|(u, change)| u + change)
                .collect();
            if let Ok(field) = self.correct(data, &near, stage) {
                return Ok((field, Start::Springs));
            }
        }
        let (specimen, model) = (self.specimen, self.model);
        let factors = &specimen.factors;
        let steps = self
            .steps
            .get_or_insert_with(|| model.attended(factors, NEWTON, self.progress.along(&|_| ())));
        let reached = match steps {
            Ok(states) => &states[step],
            Err(end) => match end.states.get(step) {
                Some(state) => state,
                None => {
                    let end = End::of_path(specimen, model, CORRECTED.key, end);
                    return Err(Box::new(end));
                }
            },
        };
        let (reached, snaps) = (reached.displacement.clone(), reached.convergence.snaps);
        let start = springs.map_or(Start::Alone, |_| Start::LoadSteps);
        let found = self.correct(springs.unwrap_or(&reached), &reached, stage);
        let found = found.map_err(|fault| Box::new(End::at(&model.name, stage.factor, fault)));
        found.map(|mut field| {
            field.convergence.snaps = snaps;
            (field, start)
        })
    }

    fn correct(&self, data: &[f64], start: &[f64], stage: Stage) -> Result<State, SolveFault> {
        if data.len() >= LARGE {
            return correct_without_multipliers(self.model, start, stage, NEWTON);
        }
        Ok(correct(self.model, data, start, stage, CORRECTOR)?.state)
    }
}
