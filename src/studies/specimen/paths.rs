//! The paths of a specimen's models, each as far as it goes.

use super::end::End;
use super::read::Specimen;
use super::solved::Solved;
use crate::corrector::specimen::{CorrectedField, correct};
use crate::corrector::{CorrectorSettings, Solver};
use crate::error::{Error, SolveFault};
use crate::mass_spring::MassSpring;
use crate::mesh::Mesh;
use crate::problem::Model;
use crate::solve::{NewtonSettings, PathEnd, State};
use crate::studies::Progress;

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

/// Names of models: for people, and at the begin of files' names.
const SPRINGS: [&str; 2] = ["mass-spring", "mass_spring"];
const CORRECTED: [&str; 2] = ["corrector", "corrected"];

/// Where the corrector began at a load factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// At the springs' field, with what the correction had changed at the load factor before.
    Springs,
    /// At the equilibrium of the lattice's cells, which Newton's method reached from rest in load steps; ū is the
    /// springs' field.
    LoadSteps,
    /// The same, where the springs have no field: ū is that equilibrium itself, and nothing is left to correct.
    Alone,
}

/// Springs and corrected springs on the lattice.
pub struct OnLattice {
    /// The lattice.
    pub springs: MassSpring,
    /// Before the correction.
    pub uncorrected: Solved,
    /// After it.
    pub corrected: Solved,
    /// Where the corrector began at each load factor that it reached.
    pub starts: Vec<Start>,
}

/// Solves as many load factors as can be reached; where others cannot, the end is told.
pub fn solve(
    specimen: &Specimen,
    model: &Model,
    names: [&str; 2],
    mesh: &Mesh,
    ends: &mut Vec<End>,
) -> Solved {
    let states = match model.solve(&specimen.factors, NEWTON, &|_| ()) {
        Ok(states) => states,
        Err(end) => {
            ends.push(End::of_path(names, specimen, (mesh, model), &end));
            end.states
        }
    };
    Solved::new(specimen, model, states)
}

impl OnLattice {
    /// Solves the springs and corrects them; each goes as far as it can, whatever the other does.
    pub fn solve(
        specimen: &Specimen,
        ends: &mut Vec<End>,
        progress: Progress,
    ) -> Result<Self, Error> {
        let problem = &specimen.problem;
        progress("mass-spring");
        let lattice = specimen.outline.lattice();
        let springs = MassSpring::on_mesh(&problem.law, problem.thickness, lattice);
        let lattice = &springs.mesh;
        let model = specimen.on(lattice, springs.potential())?;
        let model = model.describing(|element| springs.describe_element(element));
        let uncorrected = solve(specimen, &model, SPRINGS, lattice, ends);
        drop(model);

        progress("corrector");
        let energy = problem.finite_elements(lattice);
        let model = specimen.on(lattice, &energy)?;
        let (states, starts) = Corrections::new(specimen, &model, lattice).all(&uncorrected, ends);
        let corrected = Solved::new(specimen, &model, states);
        drop(model);
        Ok(Self {
            springs,
            uncorrected,
            corrected,
            starts,
        })
    }
}

/// The corrections at all load factors.
struct Corrections<'a> {
    specimen: &'a Specimen,
    model: &'a Model<'a>,
    lattice: &'a Mesh,
    /// The equilibria of the lattice's cells by load steps from rest, once they are wanted.
    steps: Option<Result<Vec<State>, PathEnd>>,
}

impl<'a> Corrections<'a> {
    fn new(specimen: &'a Specimen, model: &'a Model<'a>, lattice: &'a Mesh) -> Self {
        Self {
            specimen,
            model,
            lattice,
            steps: None,
        }
    }

    /// Corrects as many load factors as can be.
    fn all(mut self, uncorrected: &Solved, ends: &mut Vec<End>) -> (Vec<State>, Vec<Start>) {
        let (mut states, mut starts) = (Vec::new(), Vec::new());
        let mut change = vec![0.0; 2 * self.lattice.nodes.len()];
        for (step, factor) in self.specimen.factors.iter().enumerate() {
            let springs = uncorrected
                .states
                .get(step)
                .map(|state| &*state.displacement);
            match self.at(step, *factor, springs, &change) {
                Ok((field, start)) => {
                    if let Some(data) = springs {
                        change = difference(&field.state.displacement, data);
                    }
                    states.push(field.state);
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
        factor: f64,
        springs: Option<&[f64]>,
        change: &[f64],
    ) -> Result<(CorrectedField, Start), Box<End>> {
        if let Some(data) = springs {
            // What the correction has changed at the load factor before is nearly right at this one.
            let near: Vec<f64> = data
                .iter()
                .zip(change)
                .map(|(u, change)| u + change)
                .collect();
            if let Ok(field) = self.correct(data, &near, factor) {
                return Ok((field, Start::Springs));
            }
        }
        let (specimen, model, lattice) = (self.specimen, self.model, self.lattice);
        let factors = &specimen.factors;
        let steps = self
            .steps
            .get_or_insert_with(|| model.solve(factors, NEWTON, &|_| ()));
        let reached = match steps {
            Ok(states) => &states[step],
            Err(end) => match end.states.get(step) {
                Some(state) => state,
                None => {
                    let end = End::of_path(CORRECTED, specimen, (lattice, model), end);
                    return Err(Box::new(end));
                }
            },
        };
        let reached = reached.displacement.clone();
        let start = springs.map_or(Start::Alone, |_| Start::LoadSteps);
        let found = self.correct(springs.unwrap_or(&reached), &reached, factor);
        let found = found.map_err(|fault| Box::new(End::at(CORRECTED[0], factor, fault)));
        found.map(|field| (field, start))
    }

    fn correct(
        &self,
        data: &[f64],
        start: &[f64],
        factor: f64,
    ) -> Result<CorrectedField, SolveFault> {
        correct(self.lattice, self.model, data, start, factor, CORRECTOR)
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
