//! Velocity Verlet, which is the method of central differences.
//!
//! ```text
//! u̇½ = u̇₀ + ½ h ü₀,   u₁ = u₀ + h u̇½,   M ü₁ = f₁ − ∂Π/∂u(u₁) − f_v(u₁, u̇₁),   u̇₁ = u̇½ + ½ h ü₁
//! ```
//!
//! With viscous forces the last two equations are solved together for u̇₁, so that dashpots do not shorten the
//! longest stable step 2/ω of the fastest undamped vibration ω.
//!
//! # References
//! T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and Structures, Wiley (2000), § 6.2

use super::frequency;
use super::motion::Motion;
use super::state::{BodyState, Stepper};
use super::viscosity::Viscosity;
use crate::error::SolveFault;
use crate::solve::Assembly;
use crate::solve::krylov::solve_by_diagonal;
use crate::solve::vector::{gather, largest};

/// Share of the longest stable step that is taken: at one half the energy of the fastest vibrations is accurate to a third.
const SHARE: f64 = 0.5;

/// Number of steps after which the longest stable step is computed again.
const STEPS_BETWEEN_ESTIMATES: usize = 64;

/// The method of central differences.
#[derive(Default)]
pub(super) struct Central {
    assembly: Option<Assembly>,
    /// The longest safe step in s, and how many steps ago it was found.
    longest: Option<(f64, usize)>,
}

impl Stepper for Central {
    fn prepare(&mut self, motion: &Motion, held: &[bool]) -> Result<(), SolveFault> {
        let without = |i: &usize| !held[*i] && motion.mass[*i] <= 0.0;
        if let Some(unknown) = (0..held.len()).find(without) {
            return Err(SolveFault::NotFinite(format!(
                "the acceleration of unknown {unknown}, which has no mass,"
            )));
        }
        self.assembly = Some(Assembly::new(motion.energy, held));
        self.longest = None;
        Ok(())
    }

    fn longest(&mut self, motion: &Motion, at: &BodyState) -> Result<Option<f64>, SolveFault> {
        if let Some((longest, age)) = self.longest
            && age < STEPS_BETWEEN_ESTIMATES
        {
            return Ok(Some(longest));
        }
        let assembly = self.assembly.as_ref().expect("prepared");
        let stiffness = motion.tangent(assembly, at, 0.0, 0.0)?;
        let mass = gather(assembly.free(), &motion.mass);
        let omega = frequency::fastest(assembly.pattern(), &stiffness, &mass);
        if !omega.is_finite() {
            return Err(SolveFault::NotFinite("the fastest frequency".into()));
        }
        let longest = SHARE * 2.0 / omega;
        self.longest = Some((longest, 0));
        Ok(Some(longest))
    }

    fn step(
        &mut self,
        motion: &Motion,
        before: &BodyState,
        step: f64,
        held: &[bool],
    ) -> Result<BodyState, SolveFault> {
        if let Some((_, age)) = &mut self.longest {
            *age += 1;
        }
        let mut after = before.moved(motion, step);
        for i in (0..held.len()).filter(|i| !held[*i]) {
            after.velocity[i] += 0.5 * step * before.acceleration[i];
            after.displacement[i] += step * after.velocity[i];
        }
        motion.evaluate(&mut after, step)?;
        let damped = motion.viscosity.is_some_and(Viscosity::depends_on_rates);
        if damped {
            self.end_damped(motion, &mut after, step)?;
        }
        motion.accelerate(&mut after, held)?;
        if !damped {
            for i in (0..held.len()).filter(|i| !held[*i]) {
                after.velocity[i] += 0.5 * step * after.acceleration[i];
            }
        }
        Ok(after)
    }

    fn conserves(&self) -> bool {
        true
    }

    fn factorisations(&self) -> usize {
        0
    }
}

impl Central {
    /// The end of a step with viscous forces: M (u̇₁ − u̇½) = ½ h (f − ∂Π/∂u − f_v(u₁, u̇₁)) for u̇₁, by Newton's method with conjugate
    /// gradients, whose preconditioner is the diagonal; on entry the velocity is that of half the step.
    fn end_damped(
        &self,
        motion: &Motion,
        after: &mut BodyState,
        step: f64,
    ) -> Result<(), SolveFault> {
        const ITERATIONS: usize = 30;
        const TOLERANCE: f64 = 1e-12;
        let assembly = self.assembly.as_ref().expect("prepared");
        let (free, pattern, half) = (assembly.free(), assembly.pattern(), 0.5 * step);
        let start = after.velocity.clone();
        let mut scale = 0.0_f64;
        for iteration in 0..ITERATIONS {
            let forces = &after.forces;
            let defect = |i: usize| {
                let force = forces.external[i] - forces.elastic[i] - forces.viscous[i];
                motion.mass[i] * (after.velocity[i] - start[i]) - half * force
            };
            let defect: Vec<f64> = free.iter().map(|i| -defect(*i)).collect();
            let most = largest(&defect);
            let impulse = |i: &usize| {
                let forces =
                    [&forces.external, &forces.elastic, &forces.viscous].map(|all| all[*i].abs());
                (motion.mass[*i] * start[*i]).abs() + half * forces.iter().sum::<f64>()
            };
            scale = free.iter().map(impulse).fold(scale, f64::max);
            if most <= TOLERANCE * scale {
                return Ok(());
            }
            if !most.is_finite() || iteration + 1 == ITERATIONS {
                break;
            }
            let damping = motion.damping(assembly, after, step)?;
            let mut values: Vec<f64> = damping.iter().map(|c| half * c).collect();
            for (i, position) in free.iter().zip(pattern.diagonal()) {
                values[*position] += motion.mass[*i];
            }
            let change = solve_by_diagonal(pattern, &values, &defect);
            for (i, change) in free.iter().zip(change) {
                after.velocity[*i] += change;
            }
            motion.evaluate_viscous(after, step)?;
        }
        Err(SolveFault::Explodes {
            time: after.time,
            step,
        })
    }
}
