//! Newton's method for a coarse answer: by multigrid, with one tangent for several steps.

use super::assembly::Assembly;
use super::iterative::{Iterative, LinearSolver, Solved};
use super::nested::{Carry, Ladder};
use super::newton::Newton;
use super::nodal::Wanted;
use super::potential::Potential;
use super::tangent::Tangent;
use super::vector::{gather, scale, spread};
use crate::error::SolveFault;

/// How near an approach has come, and its cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Approach {
    /// The number of tangents.
    pub linearisations: usize,
    /// Iterations, each with one cycle of multigrid.
    pub iterations: usize,
    /// The number of systems that were solved.
    pub steps: usize,
    /// The first imbalance b as √(b · M b), with the cycle M, in √mJ: about the energy that it represents.
    pub first: f64,
    /// The remaining imbalance in the same measure.
    pub last: f64,
}

impl Approach {
    /// The remaining share of the first imbalance.
    pub fn left(&self) -> f64 {
        self.last / self.first.max(f64::MIN_POSITIVE)
    }
}

/// How near an approach has to come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nearness {
    /// To a share of its first imbalance.
    Share(f64),
    /// To an imbalance of so many √mJ.
    Imbalance(f64),
}

/// The tangent with which an approach begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstTangent {
    /// The tangent that was taken last, at another state.
    Known,
    /// The tangent at the first state.
    Own,
}

/// Most steps, and most tangents.
const MOST: usize = 24;
const LINEARISATIONS: usize = 8;

/// The share of the first imbalance above which steps diverge.
const FARTHER: f64 = 2.0;

/// The share of the imbalance before a step that may remain after it with the tangent of an earlier state.
const SERVES: f64 = 0.25;

/// The least and the largest reduction of a system's residual: a smaller one is not worth a new imbalance, a larger one is lost to nonlinearity.
const FALLS: [f64; 2] = [0.1, 0.05];

/// The imbalances so far.
struct Pace {
    nearness: Nearness,
    /// NaN before one is known.
    first: f64,
    /// The imbalance before the last step with the tangent taken last.
    last: Option<f64>,
}

impl Pace {
    fn new(nearness: Nearness) -> Self {
        Self {
            nearness,
            first: f64::NAN,
            last: None,
        }
    }

    /// The imbalance that may remain; `weight` is the present one.
    fn enough(&self, weight: f64) -> f64 {
        match self.nearness {
            Nearness::Share(share) if self.first.is_nan() => share * weight,
            Nearness::Share(share) => share * self.first,
            Nearness::Imbalance(enough) => enough,
        }
    }

    fn is_near(&self, weight: f64) -> bool {
        weight <= self.enough(weight) || weight == 0.0
    }

    /// Whether the tangent is good enough for another step.
    fn serves(&self, weight: f64) -> bool {
        self.last.is_none_or(|last| weight <= SERVES * last)
    }

    /// The accuracy wanted of a system with an imbalance of some weight.
    fn wanted(&self, weight: f64) -> Wanted {
        if self.is_near(weight) || !self.serves(weight) {
            return Wanted::Size;
        }
        let wanted = 0.5 * self.enough(weight) / weight;
        Wanted::Reduction(wanted.clamp(FALLS[1], FALLS[0]))
    }
}

impl Newton {
    /// Newton's method with systems solved by multigrid on top of those of coarser meshes.
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
        newton.put_on(ladder, carry);
        Ok(newton)
    }

    /// The systems with this one as the finest; `None` where they were not solved by multigrid on coarser ones.
    pub fn into_ladder(self) -> Option<Ladder> {
        let Tangent {
            assembly,
            iterative,
            ..
        } = self.tangent;
        iterative?.into_ladder(&assembly)
    }

    /// Puts the system on other, coarser ones, in place of those below it.
    pub fn put_on(&mut self, ladder: Ladder, carry: Carry) {
        let Tangent {
            assembly,
            iterative,
            ..
        } = &mut self.tangent;
        if let Some(iterative) = iterative {
            iterative.put_on(ladder, assembly, carry);
        }
    }

    /// Whether systems are solved by multigrid on coarser ones.
    pub fn is_nested(&self) -> bool {
        let iterative = self.tangent.iterative.as_ref();
        iterative.is_some_and(Iterative::is_nested)
    }

    /// Takes the tangent at `u` for multigrid; `None` without multigrid, or where `u` is not admissible.
    pub fn take_tangent(&mut self, potential: &dyn Potential, u: &[f64]) -> Option<()> {
        let iterative = self.tangent.iterative.as_mut()?;
        let mut residual = vec![0.0; u.len()];
        iterative.linearise(potential, u, &mut residual).ok()?;
        iterative.prepare().ok()
    }

    /// The approximate response of the free unknowns to a small motion of held ones from an equilibrium `u`, by
    /// multigrid on the tangent taken last; zero at held unknowns. `None` without multigrid.
    pub fn carried_along(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
    ) -> Option<Vec<f64>> {
        let mut forces = vec![0.0; u.len()];
        Assembly::add_product(potential, u, motion, &mut forces).ok()?;
        let mut right = gather(self.free(), &forces);
        scale(&mut right, -1.0);
        let iterative = self.tangent.iterative.as_mut()?;
        let step = iterative.solve(&right, FALLS[1]).ok()?;
        Some(spread(self.free(), &step, u.len()))
    }

    /// Moves the free entries of `u` towards a minimum of the potential by multigrid until the imbalance, as the iteration
    /// measures it, is small enough. The tangent is taken anew only where it is no longer good enough; where it was taken on the
    /// way, the equilibrium is checked for stability. `None` without multigrid, or where anything fails.
    pub fn approach(
        &mut self,
        potential: &dyn Potential,
        u: &mut [f64],
        residual: &mut [f64],
        nearness: Nearness,
        tangent: FirstTangent,
    ) -> Option<Approach> {
        let begun = self.tangent.iterative.as_ref()?.iterations;
        let (mut own, mut pace) = (Approach::default(), Pace::new(nearness));
        let mut anew = tangent == FirstTangent::Own;
        if !anew {
            residual.fill(0.0);
            potential.add_forces(u, residual).ok()?;
        }
        for _ in 0..MOST {
            if std::mem::take(&mut anew) {
                let iterative = self.tangent.iterative.as_mut()?;
                iterative.linearise(potential, u, residual).ok()?;
                own.linearisations += 1;
                pace.last = None;
            }
            let mut right = gather(self.free(), residual);
            scale(&mut right, -1.0);
            let iterative = self.tangent.iterative.as_mut()?;
            let solved = iterative.solve_as_far_as(&right, |weight| pace.wanted(weight));
            let Solved { x, weight } = solved.ok()?;
            if pace.first.is_nan() {
                pace.first = weight;
            }
            own.first = pace.first;
            if pace.is_near(weight) {
                own.last = weight;
                let iterative = self.tangent.iterative.as_mut()?;
                own.iterations = iterative.iterations - begun;
                let stable = own.linearisations == 0 || iterative.is_definite();
                return stable.then_some(own);
            }
            if pace.serves(weight) {
                self.step(potential, u, residual, &x)?;
                own.steps += 1;
                pace.last = Some(weight);
            } else if own.linearisations == LINEARISATIONS || weight > FARTHER * pace.first {
                return None;
            } else {
                anew = true;
            }
        }
        None
    }

    /// Takes a step, or half of it and so on where cells turn over; `None` where even a short one fails.
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
