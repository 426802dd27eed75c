//! A boundary value problem on a mesh: its solution, and what follows from its states.

use super::boundary_conditions::LONGEST_TURN;
use super::constraints::{Constraints, Motion};
use super::loads::Loads;
use super::rigid::free_motions;
use super::ties::TiedPotential;
use crate::error::{Diagnostic, Error, SolveFault};
use crate::mesh::Mesh;
use crate::solve::vector::add_scaled;
use crate::solve::{
    After, Assembly, Attendance, LinearSolver, Loading, NewtonSettings, PathEnd, Potential,
    Remembering, State, follow,
};

/// Names an element or the end of a path.
type Name<'a, T> = Box<dyn Fn(T) -> String + Sync + 'a>;

/// The work done on a body whose material has a memory, stored and dissipated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    /// The energy that unloading recovers, in mJ.
    pub stored: f64,
    /// The energy that softening has dissipated, in mJ.
    pub dissipated: f64,
}

/// A boundary value problem on a mesh, ready to be solved with any energy of its nodes.
pub struct Model<'a> {
    /// The model's name for messages, such as `mass-spring (60 × 20 cells)`.
    pub name: String,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Its strain energy.
    pub energy: &'a dyn Remembering,
    /// Names an element of the energy with its position, for messages.
    pub describe: Name<'a, usize>,
    pub(super) constraints: Constraints,
    pub(super) loads: Loads,
    /// E t in N/mm.
    pub(super) stiffness: f64,
    /// The field at load factor 1 of which every first guess is a multiple; `None` where the tangent predicts it.
    guess: Option<Vec<f64>>,
    /// Fields near the equilibria at some load factors.
    near: Vec<(f64, Vec<f64>)>,
    linear_solver: LinearSolver,
    /// Describes the load factor in messages.
    describe_end: fn(&PathEnd) -> String,
}

impl<'a> Model<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        energy: &'a dyn Remembering,
        constraints: Constraints,
        mut loads: Loads,
        stiffness: f64,
    ) -> Self {
        loads.close(&constraints);
        Self {
            name: format!("finite elements ({})", mesh.describe()),
            mesh,
            energy,
            describe: Box::new(|cell| mesh.describe_cell(cell)),
            constraints,
            loads,
            stiffness,
            guess: None,
            near: Vec::new(),
            linear_solver: LinearSolver::Automatic,
            describe_end: PathEnd::describe,
        }
    }

    /// Sets the name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Sets the names of the elements of an energy whose elements are not the cells.
    #[must_use]
    pub fn describing(mut self, describe: impl Fn(usize) -> String + Sync + 'a) -> Self {
        self.describe = Box::new(describe);
        self
    }

    /// Takes as first guess the state before, scaled with the load factor; at first, a multiple of a field that is given at load factor 1.
    #[must_use]
    pub fn guessing(mut self, field: Vec<f64>) -> Self {
        self.guess = Some(field);
        self
    }

    /// Takes first guesses, where they are known, from equilibria u of the same problem on another mesh, such as a coarser one:
    ///
    /// ```text
    /// I uₖ + (sₖ / sₖ₋₁) (vₖ₋₁ − I uₖ₋₁)
    /// ```
    ///
    /// I interpolates onto this mesh, v is its own equilibrium at the load factor s before. Where such a guess leads to no
    /// equilibrium, as may happen with cells that keep their volume, the path goes on in shorter steps without these guesses.
    #[must_use]
    pub fn near(mut self, mesh: &Mesh, states: &[State]) -> Self {
        let interpolation = mesh.interpolation_on(self.mesh);
        let near = states.iter().map(|state| {
            let field = interpolation.apply(&state.displacement);
            (state.factor, field)
        });
        self.near = near.collect();
        self
    }

    /// Sets the linear solver.
    #[must_use]
    pub fn solved_by(mut self, linear_solver: LinearSolver) -> Self {
        self.linear_solver = linear_solver;
        self
    }

    /// Sets another name for the load factor in messages.
    #[must_use]
    pub(super) fn describing_ends(mut self, describe_end: fn(&PathEnd) -> String) -> Self {
        self.describe_end = describe_end;
        self
    }

    /// Imposes a displacement field in mm, complete at load factor 1, on the nodes of a group.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn impose_field(&mut self, name: &str, field: impl Fn([f64; 2]) -> [f64; 2]) {
        for node in &self.mesh.groups()[name].nodes {
            for (axis, value) in field(self.mesh.nodes[*node]).into_iter().enumerate() {
                let motion = Motion::Straight(value);
                self.constraints.held.insert(2 * node + axis, motion);
            }
        }
        self.constraints.holds(&self.mesh.groups()[name], [true; 2]);
        self.loads.close(&self.constraints);
    }

    /// Adds forces in N at load factor 1, one for each unknown: a body force, for instance.
    pub fn add_forces(&mut self, forces: &[f64]) {
        self.loads.add_forces(forces);
    }

    /// A potential whose tied unknowns follow their masters.
    pub(super) fn tied<'b>(
        &'b self,
        potential: Box<dyn Potential + 'b>,
    ) -> Box<dyn Potential + 'b> {
        if self.constraints.ties.is_empty() {
            potential
        } else {
            Box::new(TiedPotential::new(potential, &self.constraints.ties))
        }
    }

    /// The strain energy of the body with a history.
    pub(super) fn energy_after<'b>(&'b self, history: &'b [f64]) -> After<'b> {
        After::new(self.energy, history)
    }

    /// The strain energy in mJ that is stored in an equilibrium up to which `work` was done, without what is dissipated and without the
    /// potential of loads; NaN where it is inverted. Without memory and loads it is the potential.
    pub(super) fn strain_energy(&self, equilibrium: &State, work: Option<Work>) -> f64 {
        match work {
            Some(work) => work.stored,
            None if self.loads.is_empty() => equilibrium.convergence.energy,
            None => self.energy_with(&[], equilibrium),
        }
    }

    /// The energy in mJ of a state with a history; NaN where the state is inverted.
    fn energy_with(&self, history: &[f64], state: &State) -> f64 {
        let mut residual = vec![0.0; state.displacement.len()];
        let energy = self.energy_after(history);
        Assembly::residual(&energy, &state.displacement, &mut residual).unwrap_or(f64::NAN)
    }

    /// The work done on the material up to a state; `None` where it has no memory.
    pub fn work(&self, state: &State) -> Option<Work> {
        let history = self.remembered(state);
        if history.is_empty() {
            return None;
        }
        let dissipated = self.energy.dissipated(&history);
        Some(Work {
            stored: self.energy_with(&history, state) - dissipated,
            dissipated,
        })
    }

    /// Solves for load factors, one after the other. One that cannot be reached from the one before in a single step
    /// is approached by shorter steps.
    ///
    /// # Errors
    /// [`PathEnd`] with the load factor that could not be reached and the states before it.
    pub fn solve(
        &self,
        factors: &[f64],
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<State>, PathEnd> {
        self.attended(factors, settings, Attendance::reporting(progress))
    }

    /// Solves for load factors as [`Model::solve`] with attendance: equilibria may be kept, and resumed from where they were kept.
    ///
    /// # Errors
    /// As [`Model::solve`].
    pub fn attended(
        &self,
        factors: &[f64],
        settings: NewtonSettings,
        attendance: Attendance,
    ) -> Result<Vec<State>, PathEnd> {
        if let (Some(free), Some(factor)) =
            (self.free_motions().into_iter().next(), factors.first())
        {
            return Err(PathEnd {
                factor: *factor,
                fault: SolveFault::FreeMotion(free.message),
                states: Vec::new(),
                last: None,
            });
        }
        follow(self, factors, settings, attendance)
    }

    /// The states at all of some load factors.
    ///
    /// # Errors
    /// [`Error::Solve`] with the load factor that could not be reached.
    pub fn reach_all(
        &self,
        factors: &[f64],
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<State>, Error> {
        let states = self.solve(factors, settings, progress);
        states.map_err(|end| Error::Solve {
            model: self.name.clone(),
            step: (self.describe_end)(&end),
            fault: end.fault,
        })
    }

    /// The state at the last of some load factors.
    ///
    /// # Errors
    /// [`Error::Solve`] with the load factor that could not be reached.
    ///
    /// # Panics
    /// When there is no load factor.
    pub fn reach(&self, factors: &[f64], settings: NewtonSettings) -> Result<State, Error> {
        let states = self.reach_all(factors, settings, &|_| ())?;
        Ok(states.into_iter().last().expect("a load factor"))
    }

    /// The parts that can move without strain, each with its motion.
    pub fn free_motions(&self) -> Vec<Diagnostic> {
        free_motions(self.mesh, &self.constraints)
    }
}

impl Loading for Model<'_> {
    fn held(&self) -> Vec<bool> {
        let unknowns = 0..2 * self.mesh.nodes.len();
        unknowns
            .map(|unknown| {
                let Constraints { held, ties, .. } = &self.constraints;
                held.contains_key(&unknown) || ties.contains_key(&unknown)
            })
            .collect()
    }

    fn impose(&self, factor: f64, displacement: &mut [f64]) {
        for (unknown, motion) in &self.constraints.held {
            displacement[*unknown] = motion.at(factor);
        }
        for (unknown, tie) in &self.constraints.ties {
            displacement[*unknown] = tie.share * displacement[tie.master];
        }
    }

    fn remembered(&self, state: &State) -> Vec<f64> {
        let mut history = state.history.clone();
        self.energy.remember(&mut history, &state.displacement);
        history
    }

    fn potential<'b>(&'b self, factor: f64, history: &'b [f64]) -> Box<dyn Potential + 'b> {
        self.tied(self.loads.on(self.energy_after(history), factor))
    }

    fn linear_solver(&self) -> LinearSolver {
        self.linear_solver
    }

    fn guess(&self, factor: f64, previous: Option<&State>) -> Option<Vec<f64>> {
        // The state at rest cannot be scaled.
        let previous = previous.filter(|state| state.factor != 0.0);
        let near = |factor: f64| {
            let mut known = self.near.iter();
            known.find(|(at, _)| *at == factor).map(|(_, field)| field)
        };
        let known = near(factor).and_then(|field| {
            let mut guess = field.clone();
            if let Some(state) = previous {
                // From an intermediate state, at which no field is known, no guess has led to the load factor.
                let before = near(state.factor)?;
                let ratio = factor / state.factor;
                add_scaled(&mut guess, ratio, &state.displacement);
                add_scaled(&mut guess, -ratio, before);
            }
            Some(guess)
        });
        if known.is_some() {
            return known;
        }
        let first = self.guess.as_ref()?;
        let (ratio, field) = match previous {
            Some(previous) => (factor / previous.factor, &previous.displacement),
            None => (factor, first),
        };
        Some(field.iter().map(|u| ratio * u).collect())
    }

    fn longest_step(&self, factor: f64) -> f64 {
        if self.near.iter().any(|(known, _)| *known == factor) {
            return f64::INFINITY;
        }
        let held = self.constraints.held.values();
        let most = held.fold(0.0, |most: f64, motion| most.max(motion.angle().abs()));
        LONGEST_TURN / most
    }

    fn describe(&self, element: usize) -> String {
        if element < self.energy.elements() {
            (self.describe)(element)
        } else {
            "an edge under a pressure or traction".to_owned()
        }
    }

    fn describe_unknown(&self, unknown: usize) -> String {
        self.mesh.describe_unknown(unknown)
    }
}
