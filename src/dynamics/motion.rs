//! What moves: energy, mass, viscous forces, supports, loads and the start.

use super::history::{EnergyBalance, Instant};
use super::step_forces::StepForces;
use super::time_function::TimeFunction;
use super::viscosity::{Memory, Viscosity};
use crate::error::SolveFault;
use crate::solve::vector::add_scaled;
use crate::solve::{Assembly, Inadmissible, Potential};

/// A body and everything that moves it.
pub struct Motion<'a> {
    /// Its strain energy; elements and unknowns are those of this.
    pub energy: &'a dyn Potential,
    /// Its viscous forces.
    pub viscosity: Option<&'a dyn Viscosity>,
    /// The mass of each unknown in tonne.
    pub mass: Vec<f64>,
    /// What moves held unknowns; an unknown must have one support at most.
    pub supports: Vec<MovingSupport>,
    /// What pushes.
    pub forces: Vec<MovingForce>,
    /// Where it starts.
    pub start: Start,
    /// Names an element of the energy with its place, for messages.
    pub describe: Box<dyn Fn(usize) -> String + Sync + 'a>,
}

/// A support that moves held unknowns in time.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingSupport {
    /// The unknowns that it holds.
    pub unknowns: Vec<usize>,
    /// The displacement of each in mm at the time function's 1.
    pub displacement: Vec<f64>,
    /// How much of it is imposed.
    pub time: TimeFunction,
    /// The time in s at which it lets go; `None` where it never does.
    pub until: Option<f64>,
}

/// Dead forces that change in time, gravity among them.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingForce {
    /// The force on each unknown in N at the time function's 1.
    pub force: Vec<f64>,
    /// How much of it acts.
    pub time: TimeFunction,
}

/// A body's state at time 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// In mm; held unknowns are imposed.
    pub displacement: Vec<f64>,
    /// In mm/s; held unknowns are imposed.
    pub velocity: Vec<f64>,
    /// Whether it has rested there so long that its viscous stresses have relaxed; otherwise it was brought there at
    /// once from rest.
    pub relaxed: bool,
}

impl Start {
    /// The undeformed body at rest.
    pub fn at_rest(unknowns: usize) -> Self {
        Self::held_at(vec![0.0; unknowns])
    }

    /// A body that has been held for long.
    pub fn held_at(displacement: Vec<f64>) -> Self {
        Self {
            velocity: vec![0.0; displacement.len()],
            displacement,
            relaxed: true,
        }
    }
}

impl MovingSupport {
    /// A support that holds unknowns where they are at rest.
    pub fn fixed(unknowns: Vec<usize>) -> Self {
        Self {
            displacement: vec![0.0; unknowns.len()],
            unknowns,
            time: TimeFunction::Constant(1.0),
            until: None,
        }
    }

    /// Whether it holds in the time after `time`.
    pub fn holds(&self, time: f64) -> bool {
        self.until.is_none_or(|until| time < until)
    }
}

/// The forces of a state in N, on all unknowns.
#[derive(Clone, Debug, Default)]
pub(super) struct Forces {
    /// ∂Π/∂u.
    pub elastic: Vec<f64>,
    /// f_v.
    pub viscous: Vec<f64>,
    /// f(t).
    pub external: Vec<f64>,
}

/// A moving body at one time, with what its next step needs.
#[derive(Clone, Debug)]
pub(super) struct BodyState {
    pub time: f64,
    pub displacement: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub memory: Memory,
    pub forces: Forces,
    pub energy: EnergyBalance,
}

impl Motion<'_> {
    /// Marks the unknowns that are held in the time after `time`.
    pub fn held(&self, time: f64) -> Vec<bool> {
        let mut held = vec![false; self.energy.unknowns()];
        let supports = self.supports.iter().filter(|support| support.holds(time));
        for unknown in supports.flat_map(|support| &support.unknowns) {
            held[*unknown] = true;
        }
        held
    }

    /// Writes displacement, velocity and acceleration of the unknowns that are held after the time `within`, at a time
    /// in s that is not before it; see [`TimeFunction::at`].
    pub fn impose(&self, time: f64, within: f64, motion: [&mut [f64]; 3]) {
        let [u, v, a] = motion;
        for support in self.supports.iter().filter(|support| support.holds(within)) {
            let [value, rate, second] = support.time.at(time, within);
            for (unknown, amplitude) in support.unknowns.iter().zip(&support.displacement) {
                u[*unknown] = value * amplitude;
                v[*unknown] = rate * amplitude;
                a[*unknown] = second * amplitude;
            }
        }
    }

    /// The loads f(t) on all unknowns in N.
    pub fn external_forces(&self, time: f64) -> Vec<f64> {
        let mut sum = vec![0.0; self.energy.unknowns()];
        for load in &self.forces {
            add_scaled(&mut sum, load.time.value(time), &load.force);
        }
        sum
    }

    /// The times up to `duration` in s at which something lets go, or at which the rate of a support or load jumps.
    pub(super) fn marks(&self, duration: f64) -> Vec<f64> {
        let supports = self.supports.iter();
        let mut marks: Vec<f64> = supports
            .flat_map(|support| support.time.kinks().into_iter().chain(support.until))
            .chain(self.forces.iter().flat_map(|load| load.time.kinks()))
            .filter(|time| *time > 0.0 && *time < duration)
            .collect();
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        marks
    }

    /// The body at time 0, accelerations included.
    pub(super) fn begin(&self) -> Result<BodyState, SolveFault> {
        let size = self.energy.unknowns();
        let mut start = self.start.clone();
        let mut acceleration = vec![0.0; size];
        let imposed = [
            &mut start.displacement,
            &mut start.velocity,
            &mut acceleration,
        ];
        self.impose(0.0, 0.0, imposed.map(|values| &mut values[..]));
        let rest = vec![0.0; size];
        let past = match start.relaxed {
            true => &start.displacement,
            false => &rest,
        };
        let memory = self.viscosity.map_or(Ok(Memory::default()), |viscosity| {
            Memory::relaxed(self.energy.connectivity(), viscosity, past)
        });
        let mut state = BodyState {
            time: 0.0,
            displacement: start.displacement,
            velocity: start.velocity,
            acceleration,
            memory: memory.map_err(|fault| self.inverted(fault))?,
            forces: Forces {
                elastic: vec![0.0; size],
                viscous: vec![0.0; size],
                external: Vec::new(),
            },
            energy: EnergyBalance::default(),
        };
        self.evaluate(&mut state, 0.0)?;
        // The elements have taken the step to the start at once; from now on they remember it.
        state.memory = self.memory_after(&state.memory, &state, 0.0)?;
        self.accelerate(&mut state, &self.held(0.0))?;
        state.energy.kinetic = self.kinetic(&state.velocity);
        Ok(state)
    }

    /// An element's fault with its name.
    pub(super) fn inverted(&self, fault: Inadmissible) -> SolveFault {
        SolveFault::Inverted {
            element: (self.describe)(fault.element),
        }
    }

    /// What the elements remember after a step of a length in s that ends at a state.
    pub(super) fn memory_after(
        &self,
        before: &Memory,
        at: &BodyState,
        step: f64,
    ) -> Result<Memory, SolveFault> {
        let Some(viscosity) = self.viscosity else {
            return Ok(Memory::default());
        };
        let connectivity = self.energy.connectivity();
        let after = before.after(
            connectivity,
            viscosity,
            [&at.displacement, &at.velocity],
            step,
        );
        after.map_err(|fault| self.inverted(fault))
    }

    /// The viscous forces of a state that lies `elapsed` after the memory's, whose tangent is ∂f_v/∂u̇.
    fn viscous_forces<'s>(&'s self, at: &'s BodyState, elapsed: f64) -> StepForces<'s> {
        StepForces {
            energy: self.energy,
            viscosity: self.viscosity,
            velocity: &at.velocity,
            memory: &at.memory,
            elapsed,
            elastic: false,
            by_displacement: 0.0,
            by_velocity: 1.0,
        }
    }

    /// Takes the forces and the stored energy of a state that lies `elapsed` after the memory's.
    pub(super) fn evaluate(&self, at: &mut BodyState, elapsed: f64) -> Result<(), SolveFault> {
        let stored = Assembly::residual(self.energy, &at.displacement, &mut at.forces.elastic);
        at.energy.stored = stored.map_err(|fault| self.inverted(fault))?;
        at.forces.external = self.external_forces(at.time);
        self.evaluate_viscous(at, elapsed)
    }

    /// Takes the viscous forces alone.
    pub(super) fn evaluate_viscous(
        &self,
        at: &mut BodyState,
        elapsed: f64,
    ) -> Result<(), SolveFault> {
        if self.viscosity.is_some() {
            let mut viscous = std::mem::take(&mut at.forces.viscous);
            let forces = self.viscous_forces(at, elapsed);
            let evaluated = Assembly::residual(&forces, &at.displacement, &mut viscous);
            evaluated.map_err(|fault| self.inverted(fault))?;
            at.forces.viscous = viscous;
        }
        Ok(())
    }

    /// ∂f_v/∂u̇ over the free unknowns, in N·s/mm.
    pub(super) fn damping(
        &self,
        assembly: &Assembly,
        at: &BodyState,
        elapsed: f64,
    ) -> Result<Vec<f64>, SolveFault> {
        self.assemble(assembly, &self.viscous_forces(at, elapsed), at)
    }

    /// ∂Π/∂u + ∂f_v/∂u + c ∂f_v/∂u̇ over the free unknowns, in N/mm.
    pub(super) fn tangent(
        &self,
        assembly: &Assembly,
        at: &BodyState,
        elapsed: f64,
        c: f64,
    ) -> Result<Vec<f64>, SolveFault> {
        let forces = StepForces {
            elastic: true,
            by_displacement: 1.0,
            by_velocity: c,
            ..self.viscous_forces(at, elapsed)
        };
        self.assemble(assembly, &forces, at)
    }

    fn assemble(
        &self,
        assembly: &Assembly,
        forces: &StepForces,
        at: &BodyState,
    ) -> Result<Vec<f64>, SolveFault> {
        let (mut residual, mut values) = (vec![0.0; at.displacement.len()], Vec::new());
        let linearised = assembly.linearise(forces, &at.displacement, &mut residual, &mut values);
        linearised.map_err(|fault| self.inverted(fault))?;
        Ok(values)
    }

    /// ü = M⁻¹ (f − ∂Π/∂u − f_v) of the free unknowns.
    pub(super) fn accelerate(
        &self,
        moving: &mut BodyState,
        held: &[bool],
    ) -> Result<(), SolveFault> {
        let Forces {
            elastic,
            viscous,
            external,
        } = &moving.forces;
        for i in (0..held.len()).filter(|i| !held[*i]) {
            moving.acceleration[i] = (external[i] - elastic[i] - viscous[i]) / self.mass[i];
        }
        match moving.acceleration.iter().all(|value| value.is_finite()) {
            true => Ok(()),
            false => Err(SolveFault::NotFinite("the acceleration".into())),
        }
    }

    pub(super) fn kinetic(&self, velocity: &[f64]) -> f64 {
        let pairs = self.mass.iter().zip(velocity);
        0.5 * pairs.map(|(m, v)| m * v * v).sum::<f64>()
    }

    /// The instant of a state.
    pub(super) fn instant(&self, moving: &BodyState) -> Instant {
        let Forces {
            elastic,
            viscous,
            external,
        } = &moving.forces;
        let reaction = |unknown: usize| {
            self.mass[unknown] * moving.acceleration[unknown] + elastic[unknown] + viscous[unknown]
                - external[unknown]
        };
        let force = |support: &MovingSupport| {
            let mut sum = [0.0; 2];
            if support.holds(moving.time) {
                for unknown in &support.unknowns {
                    sum[unknown % 2] += reaction(*unknown);
                }
            }
            sum
        };
        Instant {
            time: moving.time,
            displacement: moving.displacement.clone(),
            velocity: moving.velocity.clone(),
            acceleration: moving.acceleration.clone(),
            energy: moving.energy,
            support_forces: self.supports.iter().map(force).collect(),
        }
    }

    /// Brings the energy balance from the state `before` a step to the one after it, by the trapezoidal rule; the
    /// work that moves the mass of held unknowns is the change of its kinetic energy.
    pub(super) fn account(&self, before: &BodyState, after: &mut BodyState, held: &[bool]) {
        let (mut work, mut dissipated) = (0.0, 0.0);
        for (i, held) in held.iter().enumerate() {
            let change = after.displacement[i] - before.displacement[i];
            let mean = |force: fn(&Forces) -> &[f64]| {
                0.5 * (force(&before.forces)[i] + force(&after.forces)[i])
            };
            let viscous = mean(|forces| &forces.viscous);
            dissipated += viscous * change;
            work += if *held {
                let speeds = after.velocity[i].powi(2) - before.velocity[i].powi(2);
                (viscous + mean(|forces| &forces.elastic)) * change + 0.5 * self.mass[i] * speeds
            } else {
                mean(|forces| &forces.external) * change
            };
        }
        let energy = &mut after.energy;
        energy.dissipated = before.energy.dissipated + dissipated;
        energy.external_work = before.energy.external_work + work;
        energy.kinetic = self.kinetic(&after.velocity);
    }

    /// Gives held unknowns the velocities with which an interval begins: at a kink the supports' work makes them
    /// jump.
    pub(super) fn enter(&self, moving: &mut BodyState) {
        let before = self.kinetic(&moving.velocity);
        moving.impose(self, moving.time, moving.time);
        moving.energy.kinetic = self.kinetic(&moving.velocity);
        moving.energy.external_work += moving.energy.kinetic - before;
    }
}

impl BodyState {
    /// Moves the held unknowns as [`Motion::impose`] says.
    pub fn impose(&mut self, motion: &Motion, time: f64, within: f64) {
        let Self {
            displacement,
            velocity,
            acceleration,
            ..
        } = self;
        motion.impose(time, within, [displacement, velocity, acceleration]);
    }

    /// The state a step later as far as supports say; everything else is as before.
    pub fn moved(&self, motion: &Motion, step: f64) -> Self {
        let mut next = self.clone();
        next.time = self.time + step;
        next.impose(motion, next.time, self.time);
        next
    }
}
