//! A moving body at one time: its forces, its energies, the data for its next step, and the methods to take it.

use super::history::{EnergyBalance, Instant};
use super::motion::{Motion, MovingSupport, Start};
use super::step_forces::StepForces;
use super::viscosity::Memory;
use crate::error::SolveFault;
use crate::solve::{Assembly, Inadmissible};

/// A time before the start in s.
const BEFORE_START: f64 = -1.0;

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

/// A moving body at one time, with the data for its next step.
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
    /// The body at time 0, accelerations included; where the velocity of a support jumps then, it is the one before.
    pub(super) fn begin(&self) -> Result<BodyState, SolveFault> {
        let Start {
            displacement,
            velocity,
            relaxed,
        } = self.start.clone();
        let rest = vec![0.0; self.energy.unknowns()];
        let motion = [displacement, velocity, rest.clone()];
        let mut state = BodyState::unloaded(0.0, motion, Memory::default());
        state.impose(self, 0.0, BEFORE_START);
        if let Some(viscosity) = self.viscosity {
            let past = if relaxed { &state.displacement } else { &rest };
            let memory = Memory::relaxed(self.energy.connectivity(), viscosity, past);
            state.memory = memory.map_err(|fault| self.inverted(fault))?;
        }
        self.evaluate(&mut state, 0.0)?;
        // The elements take the step to the start at once; from now on they remember it.
        state.memory = self.memory_after(&state.memory, &state, 0.0)?;
        self.accelerate(&mut state, &self.held(0.0))?;
        state.energy.kinetic = self.kinetic(&state.velocity);
        Ok(state)
    }

    /// The fault of an inverted element, with its name.
    pub(super) fn inverted(&self, fault: Inadmissible) -> SolveFault {
        fault.named(&self.describe)
    }

    /// The memory of the elements after a step of a length in s that ends at a state.
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

    /// Computes the forces and the stored energy of a state that lies `elapsed` after the memory's.
    pub(super) fn evaluate(&self, at: &mut BodyState, elapsed: f64) -> Result<(), SolveFault> {
        let stored = Assembly::residual(self.energy, &at.displacement, &mut at.forces.elastic);
        at.energy.stored = stored.map_err(|fault| self.inverted(fault))?;
        at.forces.external = self.external_forces(at.time);
        self.evaluate_viscous(at, elapsed)
    }

    /// Computes the viscous forces alone.
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
    pub(super) fn accelerate(&self, at: &mut BodyState, held: &[bool]) -> Result<(), SolveFault> {
        let f = &at.forces;
        for i in (0..held.len()).filter(|i| !held[*i]) {
            at.acceleration[i] = (f.external[i] - f.elastic[i] - f.viscous[i]) / self.mass[i];
        }
        if at.acceleration.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(SolveFault::NotFinite("the acceleration".into()))
        }
    }

    pub(super) fn kinetic(&self, velocity: &[f64]) -> f64 {
        let pairs = self.mass.iter().zip(velocity);
        0.5 * pairs.map(|(m, v)| m * v * v).sum::<f64>()
    }

    /// The force of each support on the body in N along both axes at a time in s, from displacement, velocity and the acceleration that
    /// supports impose, where stresses have no memory. Where a support's velocity jumps, an earlier `within` selects the force before;
    /// see [`Motion::impose`].
    ///
    /// # Errors
    /// [`SolveFault::Inverted`].
    pub fn support_forces(
        &self,
        time: f64,
        within: f64,
        [displacement, velocity]: [&[f64]; 2],
    ) -> Result<Vec<[f64; 2]>, SolveFault> {
        let rest = vec![0.0; displacement.len()];
        let motion = [displacement.to_vec(), velocity.to_vec(), rest];
        let mut at = BodyState::unloaded(time, motion, Memory::default());
        at.impose(self, time, within);
        self.evaluate(&mut at, 0.0)?;
        Ok(self.forces_of_supports(&at))
    }

    fn forces_of_supports(&self, at: &BodyState) -> Vec<[f64; 2]> {
        let f = &at.forces;
        let reaction = |i: usize| {
            self.mass[i] * at.acceleration[i] + f.elastic[i] + f.viscous[i] - f.external[i]
        };
        let force = |support: &MovingSupport| {
            let mut sum = [0.0; 2];
            if support.holds(at.time) {
                for unknown in &support.unknowns {
                    sum[unknown % 2] += reaction(*unknown);
                }
            }
            sum
        };
        self.supports.iter().map(force).collect()
    }

    /// The instant of a state.
    pub(super) fn instant(&self, at: &BodyState) -> Instant {
        Instant {
            time: at.time,
            displacement: at.displacement.clone(),
            velocity: at.velocity.clone(),
            acceleration: at.acceleration.clone(),
            energy: at.energy,
            support_forces: self.forces_of_supports(at),
        }
    }

    /// Updates the energy balance from the state `before` a step to the one after it, by the trapezoidal rule: powers
    /// are integrated for the viscous forces, which take energy at every instant, and forces over their displacements
    /// for the others. The work that moves the mass of held unknowns is the change of its kinetic energy.
    pub(super) fn account(
        &self,
        before: &BodyState,
        after: &mut BodyState,
        held: &[bool],
        step: f64,
    ) {
        let (mut work, mut viscous_work) = (0.0, 0.0);
        for (i, held) in held.iter().enumerate() {
            let change = after.displacement[i] - before.displacement[i];
            let mean = |force: fn(&Forces) -> &[f64]| {
                0.5 * (force(&before.forces)[i] + force(&after.forces)[i])
            };
            let viscous = mean(|forces| &forces.viscous);
            let power = |at: &BodyState| at.forces.viscous[i] * at.velocity[i];
            viscous_work += 0.5 * step * (power(before) + power(after));
            work += if *held {
                let speeds = after.velocity[i].powi(2) - before.velocity[i].powi(2);
                (viscous + mean(|forces| &forces.elastic)) * change + 0.5 * self.mass[i] * speeds
            } else {
                mean(|forces| &forces.external) * change
            };
        }
        let energy = &mut after.energy;
        energy.viscous_work = before.energy.viscous_work + viscous_work;
        energy.external_work = before.energy.external_work + work;
        energy.kinetic = self.kinetic(&after.velocity);
    }

    /// Gives held unknowns the velocities with which an interval begins: at a kink the work of the supports makes them jump.
    pub(super) fn enter(&self, at: &mut BodyState) {
        let before = self.kinetic(&at.velocity);
        at.impose(self, at.time, at.time);
        at.energy.kinetic = self.kinetic(&at.velocity);
        at.energy.external_work += at.energy.kinetic - before;
    }
}

impl BodyState {
    /// A body at a time in s with its displacements, velocities and accelerations; its forces are zero.
    fn unloaded(time: f64, motion: [Vec<f64>; 3], memory: Memory) -> Self {
        let [displacement, velocity, acceleration] = motion;
        let zeros = || vec![0.0; displacement.len()];
        let forces = Forces {
            elastic: zeros(),
            viscous: zeros(),
            external: Vec::new(),
        };
        Self {
            time,
            displacement,
            velocity,
            acceleration,
            memory,
            forces,
            energy: EnergyBalance::default(),
        }
    }

    /// Moves the held unknowns according to [`Motion::impose`].
    pub fn impose(&mut self, motion: &Motion, time: f64, within: f64) {
        let (u, v, a) = (
            &mut self.displacement,
            &mut self.velocity,
            &mut self.acceleration,
        );
        motion.impose(time, within, [u, v, a]);
    }

    /// The state a step later as far as supports determine it; everything else is as before.
    pub fn moved(&self, motion: &Motion, step: f64) -> Self {
        let mut next = self.clone();
        next.time = self.time + step;
        next.impose(motion, next.time, self.time);
        next
    }
}

/// A method to take a step.
pub(super) trait Stepper {
    /// Prepares for the supports that hold after a time.
    fn prepare(&mut self, motion: &Motion, held: &[bool]) -> Result<(), SolveFault>;

    /// The longest step in s that is safe at a state; `None` where any is.
    fn longest(&mut self, motion: &Motion, at: &BodyState) -> Result<Option<f64>, SolveFault>;

    /// The state a step later. `held` are the unknowns that supports hold in the step.
    fn step(
        &mut self,
        motion: &Motion,
        before: &BodyState,
        step: f64,
        held: &[bool],
    ) -> Result<BodyState, SolveFault>;

    /// Whether an exact step would conserve the sum of the energies; otherwise it may lose some.
    fn conserves(&self) -> bool;

    /// Factorisations so far.
    fn factorisations(&self) -> usize;
}
