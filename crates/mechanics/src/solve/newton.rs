//! Newton's method for the minimum of a potential, with a line search that keeps every element admissible.

use super::assembly::Assembly;
use super::convergence::{Convergence, NewtonSettings};
use super::iterative::LinearSolver;
use super::potential::{Inadmissible, Potential};
use super::tangent::{Describe, Tangent};
use super::vector::{dot, gather, largest, scale};
use crate::error::SolveFault;

/// A minimisation prepared for one potential and one set of held unknowns.
pub struct Newton {
    /// The tangent factorised last.
    pub tangent: Tangent,
    /// Whether a tangent that is not positive definite is shifted until it is, or ends the iteration at once. Default: shifted.
    pub shifts: bool,
    indefinite: Option<Vec<f64>>,
}

/// Forces are negligible below this share of the stiffest unknown's stiffness times the largest displacement: a body
/// that moves without strain has only rounding.
const NEGLIGIBLE: f64 = 1e-4;

/// The share of the relative residual before a step that may remain after it if its tangent is to be used again.
const REUSABLE: f64 = 0.05;

/// The share that may remain after a step with the tangent of another state nearby: three such steps cost less than a factor.
const REUSABLE_NEARBY: f64 = 0.3;

/// Relative residual below which the tangent no longer changes its definiteness.
const DEFINITE_BELOW: f64 = 1e-3;

/// Relative residual below which a tangent that is not positive definite is that of an unstable equilibrium. Beyond
/// that, rounding would choose between the branches beside it.
const SADDLE: f64 = 1e-5;

/// Relative residual at which a stagnating iteration counts as converged by rounding.
const ROUNDING_FLOOR: f64 = 1e-11;

/// A potential, the unknowns of the iteration to its minimum, and ∂Π/∂u there.
struct Descent<'a> {
    potential: &'a dyn Potential,
    u: &'a mut [f64],
    residual: &'a mut [f64],
    settings: NewtonSettings,
    log: Convergence,
}

impl<'a> Descent<'a> {
    fn new(
        potential: &'a dyn Potential,
        u: &'a mut [f64],
        residual: &'a mut [f64],
        settings: NewtonSettings,
    ) -> Self {
        let log = Convergence::default();
        Self {
            potential,
            u,
            residual,
            settings,
            log,
        }
    }
}

/// The state of the iteration.
struct Iterate {
    energy: f64,
    /// Relative residual.
    relative: f64,
    /// Force below which a residual is negligible at a displacement of 1 mm.
    negligible: f64,
    /// Whether the tangent had to be shifted.
    shifted: bool,
}

impl Newton {
    /// Analyses the pattern of `potential` with the unknowns marked in `fixed` held.
    ///
    /// # Errors
    /// [`SolveFault::Singular`] when the pattern cannot be analysed.
    pub fn new(potential: &dyn Potential, fixed: &[bool]) -> Result<Self, SolveFault> {
        Self::with_solver(potential, fixed, LinearSolver::Automatic)
    }

    /// [`Self::new`] with a linear solver.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_solver(
        potential: &dyn Potential,
        fixed: &[bool],
        solver: LinearSolver,
    ) -> Result<Self, SolveFault> {
        Ok(Self {
            tangent: Tangent::new(potential, fixed, solver)?,
            shifts: true,
            indefinite: None,
        })
    }

    /// The free unknowns, ascending.
    pub fn free(&self) -> &[usize] {
        self.tangent.free()
    }

    /// Where the last [`Self::solve`] first met a tangent that is not positive definite.
    pub fn indefinite(&self) -> Option<&[f64]> {
        self.indefinite.as_deref()
    }

    /// Moves the free entries of `u` to a nearby minimum of the potential. On return `residual` is ∂Π/∂u at all
    /// unknowns: zero at free ones, the reactions at held ones.
    ///
    /// `describe` names an element for messages.
    ///
    /// # Errors
    /// A [`SolveFault`] when a step cannot be made admissible, the tangent is not positive definite at
    /// the solution, or the iteration stalls.
    pub fn solve(
        &mut self,
        potential: &dyn Potential,
        u: &mut [f64],
        residual: &mut [f64],
        settings: NewtonSettings,
        describe: Describe,
    ) -> Result<Convergence, SolveFault> {
        self.indefinite = None;
        let mut descent = Descent::new(potential, u, residual, settings);
        if self.tangent.iterative.is_some() {
            let start = descent.u.to_vec();
            if self.solve_inexactly(&mut descent).is_some() {
                return Ok(descent.log);
            }
            descent.u.copy_from_slice(&start);
            descent.log = Convergence::default();
            self.solve_directly(&mut descent, describe)?;
            // A factor solves from the same start what multigrid did not: multigrid does not suit these cells.
            self.tangent.iterative = None;
        } else {
            self.solve_directly(&mut descent, describe)?;
        }
        Ok(descent.log)
    }

    /// As [`Self::solve`] from a state near that of the tangent factorised last: its factor is used as long as it shortens the residual
    /// quickly, and is that of the tangent at the end if it suffices.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_near(
        &mut self,
        potential: &dyn Potential,
        u: &mut [f64],
        residual: &mut [f64],
        settings: NewtonSettings,
        describe: Describe,
    ) -> Result<Convergence, SolveFault> {
        let Some(stiffest) = self.tangent.factorised_stiffest() else {
            return self.solve(potential, u, residual, settings, describe);
        };
        let energy = Assembly::residual(potential, u, residual);
        let near = Iterate {
            energy: energy.map_err(|fault| fault.named(describe))?,
            relative: f64::INFINITY,
            negligible: NEGLIGIBLE * stiffest,
            shifted: false,
        };
        let mut descent = Descent::new(potential, u, residual, settings);
        if self.hold_tangent(&mut descent, near, REUSABLE_NEARBY) {
            return Ok(descent.log);
        }
        self.solve(potential, u, residual, settings, describe)
    }

    /// Newton's method with a factor for every tangent.
    fn solve_directly(&mut self, to: &mut Descent, describe: Describe) -> Result<(), SolveFault> {
        let settings = to.settings;
        let mut stiffness = Vec::new();
        loop {
            let assembly = &self.tangent.assembly;
            let linearised = assembly.linearise(to.potential, to.u, to.residual, &mut stiffness);
            let energy = linearised.map_err(|fault| fault.named(describe))?;
            let mut now = self.measure(to, energy, assembly.stiffest(&stiffness))?;
            self.tangent.take_skew(to.potential);
            if self.shifts {
                now.shifted = self.tangent.factorise(&mut stiffness)?;
            } else {
                let factorised = self.tangent.factorise_braced(&mut stiffness);
                factorised.map_err(|fault| fault.or(SolveFault::NotPositiveDefinite))?;
            }
            if now.shifted && self.indefinite.is_none() {
                self.indefinite = Some(to.u.to_vec());
            }
            let before = to.log.residuals.iter().rev().nth(1);
            let stagnant = before.is_some_and(|before| now.relative > 0.5 * before);
            let converged =
                now.relative <= settings.tolerance || (stagnant && now.relative < ROUNDING_FLOOR);
            if now.shifted && (converged || now.relative <= SADDLE) {
                return Err(SolveFault::NotPositiveDefinite);
            }
            if converged {
                return Ok(());
            }
            if to.log.iterations() >= settings.max_iterations {
                return Err(SolveFault::Stalled {
                    iterations: to.log.iterations(),
                    residual: now.relative,
                    tolerance: settings.tolerance,
                });
            }
            to.log.shifted_steps += usize::from(now.shifted);
            let step = self.tangent.step(to.residual)?;
            let searched = self.search(to, now.energy, &step);
            let (length, energy) = searched.map_err(|fault| fault.named(describe))?;
            to.log.cut_steps += usize::from(length < 1.0);
            if now.shifted || now.relative > DEFINITE_BELOW {
                continue;
            }
            if self.hold_tangent(to, Iterate { energy, ..now }, REUSABLE) {
                return Ok(());
            }
        }
    }

    /// Takes steps with the tangent taken last, which was positive definite nearby, while each reduces the residual
    /// enough: such steps cost a fraction of a factor. Returns whether the residual has come below the tolerance.
    fn hold_tangent(&mut self, to: &mut Descent, near: Iterate, serves: f64) -> bool {
        let (mut before, mut energy) = (near.relative, near.energy);
        loop {
            let after = self.relative_residual(to.residual, near.negligible * largest(to.u));
            if after <= to.settings.tolerance {
                to.log.residuals.push(after);
                to.log.energy = energy;
                return true;
            }
            let more = to.log.iterations() + 1 < to.settings.max_iterations;
            let is_used = after <= serves * before && more;
            let step = is_used.then(|| self.tangent.step(to.residual).ok());
            let Some(step) = step.flatten() else {
                return false;
            };
            let (start, forces) = (to.u.to_vec(), to.residual.to_vec());
            match self.search(to, energy, &step) {
                Ok((1.0, lower)) => energy = lower,
                _ => {
                    to.u.copy_from_slice(&start);
                    to.residual.copy_from_slice(&forces);
                    return false;
                }
            }
            to.log.residuals.push(after);
            before = after;
        }
    }

    /// Newton's method with steps by multigrid, each solved as exactly as its stage requires. `None` where anything
    /// fails: Newton's method with factors then finds the solution, or the fault.
    fn solve_inexactly(&mut self, to: &mut Descent) -> Option<()> {
        let settings = to.settings;
        loop {
            let iterative = self.tangent.iterative.as_mut()?;
            let energy = iterative.linearise(to.potential, to.u, to.residual).ok()?;
            let stiffest = iterative.stiffest();
            let now = self.measure(to, energy, stiffest).ok()?;
            let iterative = self.tangent.iterative.as_mut()?;
            if now.relative <= settings.tolerance {
                return iterative.is_definite().then_some(());
            }
            if to.log.iterations() >= settings.max_iterations {
                return None;
            }
            let mut right = gather(self.tangent.assembly.free(), to.residual);
            scale(&mut right, -1.0);
            let step = iterative.solve(&right, forcing(&to.log, settings.tolerance));
            let (length, energy) = self.search(to, now.energy, &step.ok()?).ok()?;
            to.log.cut_steps += usize::from(length < 1.0);
            let after = self.relative_residual(to.residual, now.negligible * largest(to.u));
            if now.relative <= DEFINITE_BELOW && after <= settings.tolerance {
                to.log.residuals.push(after);
                to.log.energy = energy;
                let iterative = self.tangent.iterative.as_mut()?;
                return iterative.is_definite().then_some(());
            }
        }
    }

    /// Records a linearised state.
    fn measure(&self, to: &mut Descent, energy: f64, stiffest: f64) -> Result<Iterate, SolveFault> {
        let negligible = NEGLIGIBLE * stiffest;
        let relative = self.relative_residual(to.residual, negligible * largest(to.u));
        if !relative.is_finite() {
            return Err(SolveFault::NotFinite("the residual".into()));
        }
        to.log.energy = energy;
        to.log.residuals.push(relative);
        Ok(Iterate {
            energy,
            relative,
            negligible,
            shifted: false,
        })
    }

    /// Largest residual of a free unknown.
    fn imbalance(&self, residual: &[f64]) -> f64 {
        let free = self.free().iter();
        free.fold(0.0, |worst: f64, i| worst.max(residual[*i].abs()))
    }

    /// Largest residual of a free unknown relative to the largest of all, reactions included, or to `least` where forces are negligible.
    fn relative_residual(&self, residual: &[f64], least: f64) -> f64 {
        if residual.iter().any(|r| !r.is_finite()) {
            return f64::NAN;
        }
        match self.imbalance(residual) {
            0.0 => 0.0,
            free => free / largest(residual).max(least),
        }
    }

    /// Line search along `step`: the energy must fall (Armijo) and all elements must stay admissible.
    ///
    /// Where the energy no longer resolves the step, a falling residual is taken instead. Returns the length and the
    /// energy there; `residual` is that of the new state.
    fn search(
        &self,
        to: &mut Descent,
        energy: f64,
        step: &[f64],
    ) -> Result<(f64, f64), Inadmissible> {
        const SHORTEST: f64 = 1e-6;
        let (u, residual) = (&mut *to.u, &mut *to.residual);
        let free = self.free();
        let start = gather(free, u);
        let slope = dot(&gather(free, residual), step);
        let before = self.imbalance(residual);
        let mut length = 1.0;
        loop {
            for ((i, start), step) in free.iter().zip(&start).zip(step) {
                u[*i] = start + length * step;
            }
            let outcome = Assembly::residual(to.potential, u, residual);
            if let Ok(moved) = outcome {
                let falls =
                    moved <= energy + 1e-4 * length * slope || self.imbalance(residual) < before;
                if moved.is_finite() && (falls || length < SHORTEST) {
                    return Ok((length, moved));
                }
            } else if length < SHORTEST {
                return outcome.map(|energy| (length, energy));
            }
            length *= 0.5;
        }
    }
}

/// Reduction of the residual of a step's system: about to the residual that the step's own error leaves, judged by
/// the steps before, and no farther than the tolerance requires.
///
/// # References
/// S. C. Eisenstat, H. F. Walker, SIAM J. Sci. Comput. 17, 16 (1996), doi:10.1137/0917003
fn forcing(log: &Convergence, tolerance: f64) -> f64 {
    const FIRST: f64 = 1e-2;
    let now = log.residuals[log.residuals.len() - 1];
    let before = log.residuals.iter().rev().nth(1);
    let quadratic = before.map_or(FIRST, |before| 0.5 * (now / before).powi(2));
    let least = (0.2 * tolerance / now).max(1e-11);
    quadratic.clamp(1e-6, FIRST).max(least).min(0.1)
}
