//! Newton's method as far as a coarse answer needs it: by multigrid, with one tangent for several steps.

use super::iterative::{LinearSolver, Solved};
use super::nested::{Carry, Ladder};
use super::newton::Newton;
use super::potential::Potential;
use super::tangent::Tangent;
use super::vector::{gather, scale};
use crate::error::SolveFault;

/// How near an approach has come, and what it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Tangents.
    pub linearisations: usize,
    /// Iterations, each with one cycle of multigrid.
    pub iterations: usize,
    /// The share of the first imbalance that is left.
    pub left: f64,
    /// The potential.
    pub energy: f64,
}

/// Steps at most.
const MOST: usize = 24;

/// The share of the imbalance before a step that may be left after it with the tangent of an earlier place.
const SERVES: f64 = 0.25;

/// What a system's residual has to fall by at least and at most: less is not worth a new imbalance, more is lost to what is not linear.
const FALLS: [f64; 2] = [0.1, 0.05];

impl Newton {
    /// Newton's method with systems solved by multigrid on those of coarser meshes.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn above(
        potential: &dyn Potential,
        fixed: &[bool],
        ladder: Ladder,
        carry: Carry,
    ) -> Result<Self, SolveFault> {
        let mut newton = Self::with_solver(potential, fixed, LinearSolver::Multigrid)?;
        let Tangent {
            assembly,
            iterative,
            ..
        } = &mut newton.tangent;
        if let Some(iterative) = iterative {
            iterative.put_on(ladder, assembly, carry);
        }
        Ok(newton)
    }

    /// The systems of which this one is the finest; `None` where they were not solved by multigrid on coarser ones.
    pub fn into_ladder(self) -> Option<Ladder> {
        let Tangent {
            assembly,
            iterative,
            ..
        } = self.tangent;
        iterative?.into_ladder(&assembly)
    }

    /// Moves the free entries of `u` towards a minimum of the potential by multigrid, until the imbalance stands for a share of the
    /// first one, both measured as the iteration weighs them. The tangent is taken anew only where it no longer serves. `None` where
    /// there is no multigrid, or anything is not as it should be.
    pub fn approach(
        &mut self,
        potential: &dyn Potential,
        u: &mut [f64],
        residual: &mut [f64],
        share: f64,
    ) -> Option<Approach> {
        let begun = self.tangent.iterative.as_ref()?.iterations;
        let (mut stiffness, mut energy) = (Vec::new(), f64::NAN);
        let (mut linearisations, mut first) = (0, f64::NAN);
        // The imbalance before the last step, where the tangent is that of the step.
        let mut last = None;
        for _ in 0..MOST {
            if last.is_none() {
                let assembly = &self.tangent.assembly;
                let linearised = assembly.linearise(potential, u, residual, &mut stiffness);
                energy = linearised.ok()?;
                self.tangent.take(&stiffness)?;
                linearisations += 1;
            }
            let mut right = gather(self.free(), residual);
            scale(&mut right, -1.0);
            let [goal, most] = [
                share * first,
                last.map_or(f64::INFINITY, |last| SERVES * last),
            ];
            let reduction = |weight: f64| match weight <= goal || weight > most {
                true => 1.0,
                // Not a number at first.
                false => (0.5 * goal / weight)
                    .max(0.5 * share)
                    .clamp(FALLS[1], FALLS[0]),
            };
            let iterative = self.tangent.iterative.as_mut()?;
            let Solved { x, weight } = iterative.solve_as_far_as(&right, reduction).ok()?;
            if weight <= goal || weight == 0.0 {
                return iterative.is_definite().then(|| Approach {
                    linearisations,
                    iterations: iterative.iterations - begun,
                    left: weight / first.max(f64::MIN_POSITIVE),
                    energy,
                });
            }
            if weight > most {
                last = None;
                continue;
            }
            if first.is_nan() {
                first = weight;
            }
            let searched = self.search(potential, u, residual, energy, &x);
            (energy, last) = (searched.ok()?.1, Some(weight));
        }
        None
    }
}
