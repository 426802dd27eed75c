//! Newton's method as far as a coarse answer needs it: by multigrid, with one tangent for several steps.

use super::assembly::Assembly;
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

/// Steps and tangents at most.
const MOST: usize = 24;
const LINEARISATIONS: usize = 8;

/// The share of the first imbalance beyond which steps lead away.
const FARTHER: f64 = 2.0;

/// The share of the imbalance before a step that may be left after it with the tangent of an earlier place.
const SERVES: f64 = 0.25;

/// What a system's residual has to fall by at least and at most: less is not worth a new imbalance, more is lost to what is not linear.
const FALLS: [f64; 2] = [0.1, 0.05];

/// What the imbalances tell.
struct Pace {
    /// The share of the first one that may be left.
    share: f64,
    /// Not a number at first.
    first: f64,
    /// The one before the last step, where the tangent is that of the step.
    last: Option<f64>,
}

impl Pace {
    fn is_near(&self, weight: f64) -> bool {
        weight <= self.share * self.first || weight == 0.0
    }

    /// Whether the tangent serves for another step.
    fn serves(&self, weight: f64) -> bool {
        self.last.is_none_or(|last| weight <= SERVES * last)
    }

    /// What a system's residual has to fall by: from 1 on it is not solved.
    fn reduction(&self, weight: f64) -> f64 {
        if self.is_near(weight) || !self.serves(weight) {
            return 1.0;
        }
        let wanted = 0.5 * self.share * self.first / weight;
        wanted.max(0.5 * self.share).clamp(FALLS[1], FALLS[0])
    }
}

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
        let mut stiffness = Vec::new();
        let mut linearisations = 0;
        let mut pace = Pace {
            share,
            first: f64::NAN,
            last: None,
        };
        for _ in 0..MOST {
            if pace.last.is_none() {
                let assembly = &self.tangent.assembly;
                let linearised = assembly.linearise(potential, u, residual, &mut stiffness);
                linearised.ok()?;
                self.tangent.take(&stiffness)?;
                linearisations += 1;
            }
            let mut right = gather(self.free(), residual);
            scale(&mut right, -1.0);
            let iterative = self.tangent.iterative.as_mut()?;
            let solved = iterative.solve_as_far_as(&right, |weight| pace.reduction(weight));
            let Solved { x, weight } = solved.ok()?;
            if pace.is_near(weight) {
                let iterations = iterative.iterations - begun;
                return iterative.is_definite().then_some(Approach {
                    linearisations,
                    iterations,
                    left: weight / pace.first.max(f64::MIN_POSITIVE),
                    energy: Assembly::residual(potential, u, residual).ok()?,
                });
            }
            if pace.first.is_nan() {
                pace.first = weight;
            }
            if pace.serves(weight) {
                self.step(potential, u, residual, &x)?;
                pace.last = Some(weight);
            } else if linearisations == LINEARISATIONS || weight > FARTHER * pace.first {
                return None;
            } else {
                pace.last = None;
            }
        }
        None
    }

    /// Takes a step, half of it and so on where cells turn over; `None` where even a short one does.
    fn step(
        &self,
        potential: &dyn Potential,
        u: &mut [f64],
        residual: &mut [f64],
        step: &[f64],
    ) -> Option<()> {
        const HALVES: usize = 6;
        let start = gather(self.free(), u);
        let mut length = 1.0;
        for _ in 0..HALVES {
            for ((i, start), step) in self.free().iter().zip(&start).zip(step) {
                u[*i] = start + length * step;
            }
            residual.fill(0.0);
            if potential.add_forces(u, residual).is_ok() {
                return Some(());
            }
            length *= 0.5;
        }
        None
    }
}
