//! Newton's method for the minimum of a potential, with a line search that keeps every element admissible.

use super::potential::{Assembly, Inadmissible, Potential, SkewCoupling};
use super::sparse::{Cholesky, NotPositiveDefinite, largest, norm};
use crate::error::SolveFault;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Largest residual of a free unknown relative to the largest reaction. Default: 1e-10.
    pub tolerance: f64,
    /// Iterations allowed. Default: 40.
    pub max_iterations: usize,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            max_iterations: 40,
        }
    }
}

/// How a solution was reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Convergence {
    /// Relative residual before each iteration and after the last.
    pub residuals: Vec<f64>,
    /// The potential at the solution.
    pub energy: f64,
    /// Iterations in which the full step was cut.
    pub cut_steps: usize,
    /// Iterations in which the tangent was not positive definite and was shifted.
    pub shifted_steps: usize,
}

impl Convergence {
    /// Number of iterations.
    pub fn iterations(&self) -> usize {
        self.residuals.len().saturating_sub(1)
    }
}

/// A minimisation prepared for one potential and one set of held unknowns.
pub struct Newton {
    assembly: Assembly,
    cholesky: Cholesky,
    /// The part of the tangent factorised last that is not symmetric, over the free unknowns.
    skew: Vec<SkewCoupling>,
    indefinite: Option<Vec<f64>>,
}

/// Forces are negligible below this share of the stiffest unknown's stiffness times the largest displacement:
/// a body that moves without strain has rounding alone.
const NEGLIGIBLE: f64 = 1e-4;

/// Relative residual below which the tangent no longer changes its kind.
const SMALL: f64 = 1e-3;

/// Relative residual below which a tangent that is not positive definite is that of an unstable equilibrium. From
/// there rounding would choose between the branches beside it.
const SADDLE: f64 = 1e-5;

/// Relative residual at which a stagnating iteration counts as converged by rounding.
const ROUNDING_FLOOR: f64 = 1e-11;

impl Newton {
    /// Analyses the pattern of `potential` with the unknowns marked in `fixed` held.
    ///
    /// # Errors
    /// [`SolveFault::Singular`] when the pattern cannot be analysed.
    pub fn new(potential: &dyn Potential, fixed: &[bool]) -> Result<Self, SolveFault> {
        let assembly = Assembly::new(potential, fixed);
        let cholesky = assembly.analyse(potential);
        let cholesky = cholesky.map_err(|_| SolveFault::Singular)?;
        Ok(Self {
            assembly,
            cholesky,
            skew: Vec::new(),
            indefinite: None,
        })
    }

    /// The free unknowns, ascending.
    pub fn free(&self) -> &[usize] {
        self.assembly.free()
    }

    /// Where the last [`Self::solve`] first met a tangent that is not positive definite.
    pub fn indefinite(&self) -> Option<&[f64]> {
        self.indefinite.as_deref()
    }

    /// Moves the free entries of `u` to a minimum of the potential near by. On return `residual` holds
    /// ∂Π/∂u at all unknowns: nothing at free ones, the reactions at held ones.
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
        describe: &dyn Fn(usize) -> String,
    ) -> Result<Convergence, SolveFault> {
        let inverted = |fault: Inadmissible| inverted(&fault, describe);
        let mut log = Convergence::default();
        let mut stiffness = Vec::new();
        self.indefinite = None;
        loop {
            let energy = self
                .assembly
                .linearise(potential, u, residual, &mut stiffness)
                .map_err(inverted)?;
            let stiffest = self.stiffest(&stiffness);
            let relative = self.relative_residual(residual, NEGLIGIBLE * stiffest * largest(u));
            if !relative.is_finite() {
                return Err(SolveFault::NotFinite("the residual".into()));
            }
            log.energy = energy;
            let stagnant = log
                .residuals
                .last()
                .is_some_and(|last| relative > 0.5 * last);
            log.residuals.push(relative);
            let converged =
                relative <= settings.tolerance || (stagnant && relative < ROUNDING_FLOOR);
            let shifted = self.factorise(&mut stiffness)?;
            if shifted && self.indefinite.is_none() {
                self.indefinite = Some(u.to_vec());
            }
            if shifted && (converged || relative <= SADDLE) {
                return Err(SolveFault::NotPositiveDefinite);
            }
            if converged {
                return Ok(log);
            }
            if log.iterations() >= settings.max_iterations {
                return Err(SolveFault::Stalled {
                    iterations: log.iterations(),
                    residual: relative,
                    tolerance: settings.tolerance,
                });
            }
            log.shifted_steps += usize::from(shifted);
            self.take_skew(potential, 1.0);
            let step = self.step(residual)?;
            let (length, energy) = self
                .search(potential, u, residual, energy, &step)
                .map_err(inverted)?;
            log.cut_steps += usize::from(length < 1.0);
            // A last small step needs no tangent of its own: the one before it was positive definite.
            let least = NEGLIGIBLE * stiffest * largest(u);
            let after = self.relative_residual(residual, least);
            if !shifted && relative <= SMALL && after <= settings.tolerance {
                log.residuals.push(after);
                log.energy = energy;
                return Ok(log);
            }
        }
    }

    /// The change of the free unknowns by the tangent at `u` when the held ones move by `motion` and the
    /// potential is the one given; nothing at held unknowns. A guess: the tangent is shifted where it is not positive definite.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent cannot be factorised.
    pub fn predict(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
        describe: &dyn Fn(usize) -> String,
    ) -> Result<Vec<f64>, SolveFault> {
        let (mut residual, _) = self.factorise_at(potential, u, describe)?;
        self.take_skew(potential, 1.0);
        add_product((potential, 1.0), u, motion, &mut residual, describe)?;
        self.change(&residual)
    }

    /// The field that is at rest at free unknowns under the transposed tangent at `u` while held ones move by `motion`: the
    /// influence of forces on free unknowns on the work of the reactions in that motion; `motion` itself at held unknowns.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent there is not positive definite.
    pub fn influence(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
        describe: &dyn Fn(usize) -> String,
    ) -> Result<Vec<f64>, SolveFault> {
        self.tangent(potential, u, describe)?;
        self.take_skew(potential, -1.0);
        let mut forces = vec![0.0; u.len()];
        add_product((potential, -1.0), u, motion, &mut forces, describe)?;
        let change = self.change(&forces)?;
        Ok(motion.iter().zip(change).map(|(m, c)| m + c).collect())
    }

    /// The change of the free unknowns by the transposed tangent at `u` under small forces on them; nothing at held
    /// unknowns. The tangent of a potential is its own transpose.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent there is not positive definite.
    pub fn respond(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        forces: &[f64],
        describe: &dyn Fn(usize) -> String,
    ) -> Result<Vec<f64>, SolveFault> {
        self.tangent(potential, u, describe)?;
        self.take_skew(potential, -1.0);
        let opposed: Vec<f64> = forces.iter().map(|force| -force).collect();
        self.change(&opposed)
    }

    /// Factorises the tangent at `u` for [`Self::changes`]; the residual there, at held unknowns too.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent there is not positive definite: what followed from a shifted
    /// one would be the derivative of another body.
    pub fn tangent(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        describe: &dyn Fn(usize) -> String,
    ) -> Result<Vec<f64>, SolveFault> {
        let (residual, shifted) = self.factorise_at(potential, u, describe)?;
        self.take_skew(potential, 1.0);
        match shifted {
            true => Err(SolveFault::NotPositiveDefinite),
            false => Ok(residual),
        }
    }

    /// Factorises the tangent at `u`; the residual there, and whether the tangent had to be shifted.
    fn factorise_at(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        describe: &dyn Fn(usize) -> String,
    ) -> Result<(Vec<f64>, bool), SolveFault> {
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        self.assembly
            .linearise(potential, u, &mut residual, &mut stiffness)
            .map_err(|fault| inverted(&fault, describe))?;
        let shifted = self.factorise(&mut stiffness)?;
        Ok((residual, shifted))
    }

    /// Takes the skew part of a potential's tangent between free unknowns with a sign: −1 for the transposed tangent.
    fn take_skew(&mut self, potential: &dyn Potential, sign: f64) {
        let free = |unknown| self.assembly.free_index(unknown);
        let all = potential.skew_couplings().into_iter();
        let couplings = all.filter_map(|coupling| {
            Some(SkewCoupling {
                row: free(coupling.row)?,
                column: free(coupling.column)?,
                stiffness: sign * coupling.stiffness,
            })
        });
        self.skew = couplings.collect();
    }

    /// −K⁻¹ r at the free unknowns, by the tangent factorised last, of many residuals one after the other; nothing at held
    /// unknowns. The first one proves the factor right.
    ///
    /// # Errors
    /// A [`SolveFault`] when the tangent is singular to working precision.
    pub fn changes(&mut self, residuals: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, SolveFault> {
        const TOGETHER: usize = 8;
        let Some((first, others)) = residuals.split_first() else {
            return Ok(Vec::new());
        };
        if !self.skew.is_empty() {
            return residuals
                .iter()
                .map(|residual| self.change(residual))
                .collect();
        }
        let mut changes = vec![self.change(first)?];
        let free = self.assembly.free();
        for group in others.chunks(TOGETHER) {
            let right = group.iter().flat_map(|r| free.iter().map(|i| -r[*i]));
            let mut columns: Vec<f64> = right.collect();
            self.cholesky.substitute_columns(&mut columns, group.len());
            for (residual, column) in group.iter().zip(columns.chunks(free.len().max(1))) {
                changes.push(spread(free, column, residual.len()));
            }
        }
        Ok(changes)
    }

    /// −K⁻¹ r at the free unknowns.
    fn change(&mut self, residual: &[f64]) -> Result<Vec<f64>, SolveFault> {
        let step = self.step(residual)?;
        Ok(spread(self.assembly.free(), &step, residual.len()))
    }

    /// The direction φ of least stiffness at `u`, ‖φ‖ = 1, by inverse iteration, and φᵀ K φ; φ is nothing at held
    /// unknowns. Nothing where there is no tangent.
    pub fn softest_mode(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
    ) -> Option<(f64, Vec<f64>)> {
        const ITERATIONS: usize = 20;
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        let linearised = self
            .assembly
            .linearise(potential, u, &mut residual, &mut stiffness);
        linearised.ok()?;
        let tangent = stiffness.clone();
        self.factorise(&mut stiffness).ok()?;
        // A start without any symmetry has a part of every mode.
        let count = self.assembly.free().len();
        let mut mode: Vec<f64> = (0..count).map(|i| (1.0 + i as f64).sqrt().sin()).collect();
        for _ in 0..ITERATIONS {
            mode = self.cholesky.solve(&mode).ok()?;
            let scale = norm(&mode);
            mode.iter_mut().for_each(|entry| *entry /= scale);
        }
        let forces = self.assembly.pattern().multiply(&tangent, &mode);
        let stiffness = mode.iter().zip(&forces).map(|(a, b)| a * b).sum();
        Some((stiffness, spread(self.assembly.free(), &mode, u.len())))
    }

    /// The largest entry of the diagonal of a stiffness.
    fn stiffest(&self, stiffness: &[f64]) -> f64 {
        let diagonal = self.cholesky.pattern().diagonal().iter();
        diagonal.fold(0.0, |most: f64, place| most.max(stiffness[*place].abs()))
    }

    /// Largest residual of a free unknown relative to the largest of all, reactions included, or to `least`
    /// where there are next to none.
    fn relative_residual(&self, residual: &[f64], least: f64) -> f64 {
        let free = self
            .assembly
            .free()
            .iter()
            .fold(0.0, |worst: f64, i| worst.max(residual[*i].abs()));
        if residual.iter().any(|r| !r.is_finite()) {
            return f64::NAN;
        }
        if free == 0.0 {
            0.0
        } else {
            free / largest(residual).max(least)
        }
    }

    /// Factorises the stiffness, shifted along its diagonal where it is not positive definite; says
    /// whether it had to be shifted.
    fn factorise(&mut self, stiffness: &mut [f64]) -> Result<bool, SolveFault> {
        let diagonal = self.cholesky.pattern().diagonal().to_vec();
        let scale = diagonal
            .iter()
            .map(|place| stiffness[*place].abs())
            .sum::<f64>()
            / diagonal.len().max(1) as f64;
        let mut shift = 0.0;
        while let Err(NotPositiveDefinite) = self.cholesky.factorise(stiffness) {
            let next = if shift == 0.0 {
                1e-4 * scale
            } else {
                4.0 * shift
            };
            if scale.is_nan() || next >= 1e3 * scale {
                return Err(SolveFault::Singular);
            }
            diagonal
                .iter()
                .for_each(|place| stiffness[*place] += next - shift);
            shift = next;
        }
        Ok(shift > 0.0)
    }

    /// −K⁻¹ r by the symmetric factor; a skew part, small beside it, is added by iteration: K_s dᵢ₊₁ = −r − S dᵢ.
    fn step(&mut self, residual: &[f64]) -> Result<Vec<f64>, SolveFault> {
        const ITERATIONS: usize = 60;
        let negative: Vec<f64> = self.assembly.free().iter().map(|i| -residual[*i]).collect();
        let mut solve = |right: &[f64]| {
            let solved = self.cholesky.solve(right);
            solved.map_err(|_| SolveFault::Singular)
        };
        let mut step = solve(&negative)?;
        let mut last = f64::INFINITY;
        for _ in 0..if self.skew.is_empty() { 0 } else { ITERATIONS } {
            let mut right = negative.clone();
            for SkewCoupling {
                row,
                column,
                stiffness,
            } in &self.skew
            {
                right[*row] -= stiffness * step[*column];
                right[*column] += stiffness * step[*row];
            }
            let next = solve(&right)?;
            let moved: Vec<f64> = next.iter().zip(&step).map(|(a, b)| a - b).collect();
            let change = largest(&moved);
            if change.is_nan() || change >= last {
                break;
            }
            (step, last) = (next, change);
            if change <= 1e-14 * largest(&step) {
                break;
            }
        }
        Ok(step)
    }

    /// Goes along `step` as far as the energy falls (Armijo) and all elements stay admissible.
    ///
    /// Where the energy no longer resolves the step, a falling residual is taken instead. Returns the length and the
    /// energy there; `residual` is that of the new place.
    fn search(
        &self,
        potential: &dyn Potential,
        u: &mut [f64],
        residual: &mut [f64],
        energy: f64,
        step: &[f64],
    ) -> Result<(f64, f64), Inadmissible> {
        const SHORTEST: f64 = 1e-6;
        let free = self.assembly.free();
        let start: Vec<f64> = free.iter().map(|i| u[*i]).collect();
        let slope: f64 = free
            .iter()
            .zip(step)
            .map(|(i, step)| residual[*i] * step)
            .sum();
        let before = free
            .iter()
            .fold(0.0, |worst: f64, i| worst.max(residual[*i].abs()));
        let mut length = 1.0;
        loop {
            for ((i, start), step) in free.iter().zip(&start).zip(step) {
                u[*i] = start + length * step;
            }
            let outcome = Assembly::residual(potential, u, residual);
            if let Ok(moved) = outcome {
                let after = free
                    .iter()
                    .fold(0.0, |worst: f64, i| worst.max(residual[*i].abs()));
                let falls = moved <= energy + 1e-4 * length * slope;
                if moved.is_finite() && (falls || after < before || length < SHORTEST) {
                    return Ok((length, moved));
                }
            } else if length < SHORTEST {
                return outcome.map(|energy| (length, energy));
            }
            length *= 0.5;
        }
    }
}

fn inverted(fault: &Inadmissible, describe: &dyn Fn(usize) -> String) -> SolveFault {
    SolveFault::Inverted {
        element: describe(fault.element),
    }
}

/// Adds the forces K m of a small motion m of some unknowns, at all unknowns; Kᵀ m where the sign of the skew part is −1.
fn add_product(
    (potential, sign): (&dyn Potential, f64),
    u: &[f64],
    motion: &[f64],
    forces: &mut [f64],
    describe: &dyn Fn(usize) -> String,
) -> Result<(), SolveFault> {
    Assembly::add_product(potential, u, motion, forces)
        .map_err(|fault| inverted(&fault, describe))?;
    for SkewCoupling {
        row,
        column,
        stiffness,
    } in potential.skew_couplings()
    {
        forces[row] += sign * stiffness * motion[column];
        forces[column] -= sign * stiffness * motion[row];
    }
    Ok(())
}

/// Entries of the free unknowns among all, the others nothing.
fn spread(free: &[usize], entries: &[f64], count: usize) -> Vec<f64> {
    let mut all = vec![0.0; count];
    for (unknown, entry) in free.iter().zip(entries) {
        all[*unknown] = *entry;
    }
    all
}
