//! Generalised-α with a retained factor.
//!
//! ```text
//! (1 − αₘ) M ü₁ + αₘ M ü₀ + (1 − α_f) r₁ + α_f r₀ = 0,   r = ∂Π/∂u + f_v − f            [N]
//! u₁ = u₀ + h u̇₀ + h² ((½ − β) ü₀ + β ü₁),   u̇₁ = u̇₀ + h ((1 − γ) ü₀ + γ ü₁)
//! αₘ = (2ρ∞ − 1)/(ρ∞ + 1),  α_f = ρ∞/(ρ∞ + 1),  γ = ½ − αₘ + α_f,  β = ¼ (1 − αₘ + α_f)²
//! ```
//!
//! With ρ∞ = 1 every instant is in balance, and the method is Newmark's with the average acceleration. u₁ is found by
//! Newton's method with the factor of an earlier tangent as long as it converges quickly.
//!
//! # References
//! J. Chung, G. M. Hulbert, J. Appl. Mech. 60, 371 (1993), doi:10.1115/1.2900803

use super::frequency;
use super::motion::Motion;
use super::state::{BodyState, Stepper};
use crate::error::SolveFault;
use crate::solve::vector::largest;
use crate::solve::{Assembly, Cholesky};

/// The constants of generalised-α.
#[derive(Clone, Copy, Debug)]
struct Constants {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Constants {
    fn new(rho: f64) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        Self {
            alpha_m,
            alpha_f,
            beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2),
            gamma: 0.5 - alpha_m + alpha_f,
        }
    }
}

/// Generalised-α.
pub(super) struct Implicit {
    constants: Constants,
    tolerance: f64,
    system: Option<(Assembly, Cholesky)>,
    /// The step in s whose matrix is factorised.
    factorised: Option<f64>,
    factorisations: usize,
    /// A hundredth of the slowest period, or of the period of oscillating supports or forces, in s.
    longest: Option<f64>,
}

/// Most iterations of a step.
const ITERATIONS: usize = 25;

/// A factor is renewed when the residual after an iteration exceeds this share of the one before: a new one costs as much as five iterations.
const SLOW_CONVERGENCE: f64 = 0.5;

/// Relative residual at which an iteration that stagnates has converged by rounding.
const ROUNDING_FLOOR: f64 = 1e-9;

/// Steps in the slowest period, and in that of oscillating supports or forces, where the step is chosen here: the period is accurate to 3e-4.
const STEPS_IN_PERIOD: f64 = 100.0;

impl Implicit {
    pub fn new(spectral_radius: f64, tolerance: f64) -> Self {
        Self {
            constants: Constants::new(spectral_radius),
            tolerance,
            system: None,
            factorised: None,
            factorisations: 0,
            longest: None,
        }
    }

    /// Whether there is a factor for a step of this length, up to rounding of times.
    fn has_factor(&self, step: f64) -> bool {
        self.factorised
            .is_some_and(|factor_step| (factor_step / step - 1.0).abs() < 1e-6)
    }

    /// Factorises K + γ/(β h) C + (1 − αₘ)/((1 − α_f) β h²) M at a state.
    fn factorise(&mut self, motion: &Motion, at: &BodyState, step: f64) -> Result<(), SolveFault> {
        let c = self.constants;
        let (assembly, cholesky) = self.system.as_mut().expect("prepared");
        let mut values = motion.tangent(assembly, at, step, c.gamma / (c.beta * step))?;
        let inertia = (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * step * step);
        for (i, position) in assembly.free().iter().zip(assembly.pattern().diagonal()) {
            values[*position] += inertia * motion.mass[*i];
        }
        self.factorised = None;
        cholesky
            .factorise(&values)
            .map_err(|fault| fault.or(SolveFault::NotPositiveDefinite))?;
        self.factorised = Some(step);
        self.factorisations += 1;
        Ok(())
    }

    /// Writes u₁ and u̇₁ of the free unknowns that follow from ü₁, which is the unknown: from differences of
    /// displacements it would lose its digits.
    fn follow(&self, before: &BodyState, after: &mut BodyState, step: f64) {
        let Constants { beta, gamma, .. } = self.constants;
        let (assembly, _) = self.system.as_ref().expect("prepared");
        for i in assembly.free().iter().copied() {
            let (v, a, next) = (
                before.velocity[i],
                before.acceleration[i],
                after.acceleration[i],
            );
            let mean = (0.5 - beta) * a + beta * next;
            after.displacement[i] = before.displacement[i] + step * (v + step * mean);
            after.velocity[i] = v + step * ((1.0 - gamma) * a + gamma * next);
        }
    }

    /// −1/(1 − α_f) times the residual of the free unknowns, and its size relative to the largest force.
    fn defect(&self, motion: &Motion, before: &BodyState, after: &BodyState) -> (Vec<f64>, f64) {
        let Constants {
            alpha_m, alpha_f, ..
        } = self.constants;
        let (assembly, _) = self.system.as_ref().expect("prepared");
        let imbalance = |at: &BodyState, i: usize| {
            let forces = &at.forces;
            forces.elastic[i] + forces.viscous[i] - forces.external[i]
        };
        let defect = |i: &usize| {
            let inertia =
                (1.0 - alpha_m) * after.acceleration[*i] + alpha_m * before.acceleration[*i];
            let force = (1.0 - alpha_f) * imbalance(after, *i) + alpha_f * imbalance(before, *i);
            -(motion.mass[*i] * inertia + force) / (1.0 - alpha_f)
        };
        let defect: Vec<f64> = assembly.free().iter().map(defect).collect();
        let scale = after
            .largest_force(motion)
            .max(before.largest_force(motion));
        let most = largest(&defect);
        let relative = if most == 0.0 { 0.0 } else { most / scale };
        (defect, relative)
    }

    /// The state a step later by the tangent before the step: the response to the motion of the supports and to the imbalance.
    fn predict(
        &mut self,
        motion: &Motion,
        before: &BodyState,
        step: f64,
        held: &[bool],
    ) -> Result<BodyState, SolveFault> {
        let beta = self.constants.beta;
        let mut after = before.moved(motion, step);
        let target = std::mem::replace(&mut after.displacement, before.displacement.clone());
        for i in (0..held.len()).filter(|i| !held[*i]) {
            let flown = before.velocity[i] + step * (0.5 - beta) * before.acceleration[i];
            after.acceleration[i] = -flown / (beta * step);
        }
        self.follow(before, &mut after, step);
        motion.evaluate(&mut after, step)?;
        let mut support = vec![0.0; held.len()];
        for i in (0..held.len()).filter(|i| held[*i]) {
            support[i] = target[i] - before.displacement[i];
        }
        let mut forces = vec![0.0; held.len()];
        Assembly::add_product(motion.energy, &after.displacement, &support, &mut forces)
            .map_err(|fault| motion.inverted(fault))?;
        self.factorise(motion, &after, step)?;
        let (mut change, _) = self.defect(motion, before, &after);
        let (assembly, cholesky) = self.system.as_mut().expect("prepared");
        for (change, i) in change.iter_mut().zip(assembly.free()) {
            *change -= forces[*i];
        }
        cholesky.substitute(&mut change);
        for (i, change) in assembly.free().iter().zip(change) {
            after.acceleration[*i] += change / (beta * step * step);
        }
        for i in (0..held.len()).filter(|i| held[*i]) {
            after.displacement[i] = target[i];
        }
        Ok(after)
    }

    /// Newton's method from a first guess.
    fn iterate(
        &mut self,
        motion: &Motion,
        before: &BodyState,
        mut after: BodyState,
        step: f64,
    ) -> Result<BodyState, SolveFault> {
        let (mut last, mut fresh) = (f64::INFINITY, false);
        let by_acceleration = self.constants.beta * step * step;
        for iteration in 0..ITERATIONS {
            self.follow(before, &mut after, step);
            motion.evaluate(&mut after, step)?;
            let (mut change, relative) = self.defect(motion, before, &after);
            let stagnant = fresh && relative > 0.5 * last;
            if relative <= self.tolerance || (stagnant && relative < ROUNDING_FLOOR) {
                return Ok(after);
            }
            if !relative.is_finite() || (stagnant && relative > 2.0 * last && iteration > 2) {
                break;
            }
            fresh = !self.has_factor(step) || relative > SLOW_CONVERGENCE * last;
            if fresh {
                self.factorise(motion, &after, step)?;
            }
            last = relative;
            let (assembly, cholesky) = self.system.as_mut().expect("prepared");
            cholesky.substitute(&mut change);
            for (i, change) in assembly.free().iter().zip(change) {
                after.acceleration[*i] += change / by_acceleration;
            }
        }
        Err(SolveFault::Explodes {
            time: before.time,
            step,
        })
    }
}

impl BodyState {
    /// The largest force on an unknown in N, including reactions and inertia.
    fn largest_force(&self, motion: &Motion) -> f64 {
        let inertia = motion.mass.iter().zip(&self.acceleration);
        let inertia: Vec<f64> = inertia.map(|(m, a)| m * a).collect();
        let forces = &self.forces;
        let all = [&inertia, &forces.elastic, &forces.viscous, &forces.external];
        all.map(|forces| largest(forces))
            .into_iter()
            .fold(0.0, f64::max)
    }
}

impl Stepper for Implicit {
    fn prepare(&mut self, motion: &Motion, held: &[bool]) -> Result<(), SolveFault> {
        let assembly = Assembly::new(motion.energy, held);
        let cholesky = assembly.analyse()?;
        self.system = Some((assembly, cholesky));
        self.factorised = None;
        self.longest = None;
        Ok(())
    }

    fn longest(&mut self, motion: &Motion, at: &BodyState) -> Result<Option<f64>, SolveFault> {
        if self.longest.is_none() {
            let held = motion.held(at.time);
            let modes = frequency::slowest(motion, &held, &at.displacement, 1)?;
            let slowest_period = modes.first().map(|mode| 1.0 / mode.frequency);
            let periods = slowest_period.into_iter().chain(motion.shortest_period());
            let shortest = periods.reduce(f64::min);
            self.longest = shortest.map(|period| period / STEPS_IN_PERIOD);
        }
        Ok(self.longest)
    }

    fn step(
        &mut self,
        motion: &Motion,
        before: &BodyState,
        step: f64,
        held: &[bool],
    ) -> Result<BodyState, SolveFault> {
        let flying = before.moved(motion, step);
        match self.iterate(motion, before, flying, step) {
            // Supports or nodes that move far turn cells inside out where the tangent's response does not.
            Err(SolveFault::Inverted { .. } | SolveFault::Explodes { .. }) => {
                let predicted = self.predict(motion, before, step, held)?;
                self.iterate(motion, before, predicted, step)
            }
            other => other,
        }
    }

    fn conserves(&self) -> bool {
        self.constants.gamma == 0.5
    }

    fn factorisations(&self) -> usize {
        self.factorisations
    }
}
