//! Velocity Verlet, which is the method of central differences.
//!
//! ```text
//! u̇½ = u̇₀ + ½ h ü₀,   u₁ = u₀ + h u̇½,   M ü₁ = f₁ − ∂Π/∂u(u₁) − f_v(u₁, u̇₁),   u̇₁ = u̇½ + ½ h ü₁
//! ```
//!
//! With viscous forces the last two are solved together for u̇₁, so that dashpots do not shorten the longest stable
//! step 2/ω of the fastest undamped vibration ω.
//!
//! # References
//! T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and Structures, Wiley (2000), § 6.2

use super::frequency;
use super::march::Stepper;
use super::motion::{Motion, Moving};
use super::tangents::Tangents;
use super::viscosity::{Viscosity, Whole, inverted};
use crate::error::SolveFault;
use crate::solve::{Assembly, SymmetricPattern};

/// Share of the longest stable step that is taken: at one half the energy of the fastest vibrations is right to a third.
const SHARE: f64 = 0.5;

/// Steps after which the longest stable one is found anew.
const AGE: usize = 64;

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

    fn longest(&mut self, motion: &Motion, moving: &Moving) -> Result<Option<f64>, SolveFault> {
        if let Some((longest, age)) = self.longest
            && age < AGE
        {
            return Ok(Some(longest));
        }
        let assembly = self.assembly.as_ref().expect("prepared");
        let tangents = Tangents::new(motion, moving, 0.0);
        let omega = tangents.fastest(assembly)?;
        let longest = SHARE * 2.0 / omega;
        self.longest = Some((longest, 0));
        Ok(Some(longest))
    }

    fn step(
        &mut self,
        motion: &Motion,
        before: &Moving,
        step: f64,
        held: &[bool],
    ) -> Result<Moving, SolveFault> {
        if let Some((_, age)) = &mut self.longest {
            *age += 1;
        }
        let mut after = before.moved(motion, step);
        for i in (0..held.len()).filter(|i| !held[*i]) {
            after.velocity[i] += 0.5 * step * before.acceleration[i];
            after.displacement[i] += step * after.velocity[i];
        }
        motion.evaluate(&mut after, step)?;
        if let Some(viscosity) = motion.viscosity.filter(|own| own.depends_on_rates()) {
            let assembly = self.assembly.as_ref().expect("prepared");
            let end = Damped {
                motion,
                viscosity,
                assembly,
                step,
            };
            end.solve(&mut after)?;
        }
        motion.accelerate(&mut after, held)?;
        if motion.viscosity.is_none_or(|own| !own.depends_on_rates()) {
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

/// The end of a step with viscous forces: M (u̇₁ − u̇½) = ½ h (f − ∂Π/∂u − f_v(u₁, u̇₁)) for u̇₁.
struct Damped<'a> {
    motion: &'a Motion<'a>,
    viscosity: &'a dyn Viscosity,
    assembly: &'a Assembly,
    step: f64,
}

impl Damped<'_> {
    /// Newton's method with conjugate gradients; on entry the velocity is that of half the step.
    fn solve(&self, after: &mut Moving) -> Result<(), SolveFault> {
        const ITERATIONS: usize = 30;
        const TOLERANCE: f64 = 1e-12;
        let (motion, half) = (self.motion, 0.5 * self.step);
        let free = self.assembly.free();
        let start = after.velocity.clone();
        let describe = &*motion.describe;
        let mut scale = 0.0_f64;
        for iteration in 0..ITERATIONS {
            let forces = &after.forces;
            let defect = |i: usize| {
                let force = forces.external[i] - forces.elastic[i] - forces.viscous[i];
                motion.mass[i] * (after.velocity[i] - start[i]) - half * force
            };
            let defect: Vec<f64> = free.iter().map(|i| -defect(*i)).collect();
            let most = defect.iter().fold(0.0_f64, |most, r| most.max(r.abs()));
            let impulse =
                |i: &usize| (motion.mass[*i] * start[*i]).abs() + half * forces.elastic[*i].abs();
            scale = free.iter().map(impulse).fold(scale, f64::max);
            if most <= TOLERANCE * scale {
                return Ok(());
            }
            if !most.is_finite() || iteration + 1 == ITERATIONS {
                break;
            }
            let tangents = Tangents::new(motion, after, self.step);
            let damping = tangents.damping(self.assembly)?;
            let change = self.change(&damping, &defect);
            for (i, change) in free.iter().zip(change) {
                after.velocity[*i] += change;
            }
            let at = Whole {
                displacement: &after.displacement,
                velocity: &after.velocity,
                elapsed: self.step,
            };
            after.forces.viscous =
                super::viscosity::forces(motion.energy, self.viscosity, &after.memory, at)
                    .map_err(inverted(describe))?;
        }
        Err(SolveFault::Explodes {
            time: after.time,
            step: self.step,
        })
    }

    /// (M + ½ h C)⁻¹ b by conjugate gradients with the diagonal as their preconditioner.
    fn change(&self, damping: &[f64], b: &[f64]) -> Vec<f64> {
        let pattern: &SymmetricPattern = self.assembly.pattern();
        let half = 0.5 * self.step;
        let mut values: Vec<f64> = damping.iter().map(|c| half * c).collect();
        for (i, place) in self.assembly.free().iter().zip(pattern.diagonal()) {
            values[*place] += self.motion.mass[*i];
        }
        frequency::conjugate_gradients(pattern, &values, b)
    }
}
