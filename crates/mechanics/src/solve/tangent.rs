//! The tangent of a potential, factorised: small changes of an equilibrium, and its softest mode.

use rayon::prelude::*;

use super::assembly::Assembly;
use super::iterative::{Iterative, LinearSolver};
use super::potential::{Inadmissible, Potential};
use super::skew::SkewPart;
use super::sparse::{Cholesky, FactorFault};
use super::vector::{dot, gather, norm, scale, spread};
use crate::error::SolveFault;

/// The tangent of a potential over its free unknowns, factorised at one state after the other, or solved by multigrid.
pub struct Tangent {
    pub(super) assembly: Assembly,
    /// Analysed when it is first needed.
    cholesky: Option<Cholesky>,
    /// The tangent for multigrid, where it is used and the tangent taken last has not been factorised.
    pub(super) iterative: Option<Iterative>,
    /// Whether the factor is that of the tangent taken last.
    pub(super) factorised: bool,
    /// The part of the tangent factorised last that is not symmetric, over the free unknowns.
    pub(super) skew: SkewPart,
}

/// Names an element of a potential for messages.
pub type Describe<'a> = &'a dyn Fn(usize) -> String;

/// The mode of a tangent that has the least stiffness.
pub struct SoftestMode {
    /// Its stiffness, that of a displacement of length one.
    pub stiffness: f64,
    /// The largest entry on the tangent's diagonal.
    pub stiffest: f64,
    /// The displacement of all unknowns, of length one.
    pub displacement: Vec<f64>,
}

impl Tangent {
    /// Analyses the pattern of `potential` with the unknowns marked in `fixed` held.
    ///
    /// # Errors
    /// [`SolveFault::Singular`] when the pattern cannot be analysed.
    pub fn new(
        potential: &dyn Potential,
        fixed: &[bool],
        solver: LinearSolver,
    ) -> Result<Self, SolveFault> {
        let assembly = Assembly::new(potential, fixed);
        let multigrid = solver.is_multigrid(assembly.free().len());
        let iterative = multigrid.then(|| Iterative::new(&assembly, potential));
        let mut tangent = Self {
            iterative: iterative.flatten(),
            cholesky: None,
            factorised: false,
            assembly,
            skew: SkewPart::default(),
        };
        if tangent.iterative.is_none() {
            tangent.analysed()?;
        }
        Ok(tangent)
    }

    /// The factor's memory, analysed when it is first needed.
    pub(super) fn analysed(&mut self) -> Result<&mut Cholesky, FactorFault> {
        if self.cholesky.is_none() {
            self.cholesky = Some(self.assembly.analyse()?);
        }
        Ok(self.cholesky.as_mut().expect("analysed above"))
    }

    /// The largest entry on the diagonal of the symmetric tangent whose factor is at hand; `None` where there is none.
    pub(super) fn factorised_stiffest(&self) -> Option<f64> {
        let factor = self.cholesky.as_ref().filter(|_| self.iterative.is_none());
        let values = factor?.values();
        (!values.is_empty() && self.skew.is_none()).then(|| self.assembly.stiffest(values))
    }

    /// The free unknowns, ascending.
    pub fn free(&self) -> &[usize] {
        self.assembly.free()
    }

    /// Factorises the tangent at `u` for [`Self::changes`]; returns the residual there, including held unknowns.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent there is not positive definite: a shifted one would
    /// give the derivative of another body.
    pub fn at(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        describe: Describe,
    ) -> Result<Vec<f64>, SolveFault> {
        let (residual, mut shifted) = self.factorise_at(potential, u, describe)?;
        if !self.factorised && !self.iterative.as_mut().is_some_and(Iterative::is_definite) {
            shifted = self.replace_by_factor()?;
        }
        if shifted {
            Err(SolveFault::NotPositiveDefinite)
        } else {
            Ok(residual)
        }
    }

    /// −K⁻¹ r at the free unknowns, by the tangent factorised last, for many residuals one after the other; zero at
    /// held unknowns. The first one verifies the factor.
    ///
    /// # Errors
    /// A [`SolveFault`] when the tangent is singular to working precision.
    pub fn changes(&mut self, residuals: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, SolveFault> {
        const COLUMNS_AT_ONCE: usize = 16;
        const WORTH_FACTOR: usize = 8;
        let Some((first, others)) = residuals.split_first() else {
            return Ok(Vec::new());
        };
        if !self.skew.is_none() {
            return residuals
                .iter()
                .map(|residual| self.change(residual))
                .collect();
        }
        if residuals.len() > WORTH_FACTOR {
            self.replace_by_factor()?;
        }
        let mut changes = vec![self.change(first)?];
        if !self.factorised {
            for residual in others {
                changes.push(self.change(residual)?);
            }
            return Ok(changes);
        }
        let free = self.assembly.free();
        let cholesky = self.cholesky.as_ref().expect("factorised");
        let groups = others.par_chunks(COLUMNS_AT_ONCE).flat_map_iter(|group| {
            let right = group.iter().flat_map(|r| free.iter().map(|i| -r[*i]));
            let mut columns: Vec<f64> = right.collect();
            cholesky.substitute_columns(&mut columns, group.len());
            // Without free unknowns every column is empty.
            let begins = (0..).step_by(free.len().max(1));
            let pairs = group.iter().zip(begins);
            let spreads = pairs.map(|(residual, begin)| {
                let column = columns.get(begin..begin + free.len());
                spread(free, column.unwrap_or_default(), residual.len())
            });
            spreads.collect::<Vec<_>>()
        });
        changes.par_extend(groups);
        Ok(changes)
    }

    /// The change of the free unknowns by the tangent at `u` when the held ones move by `motion` and the
    /// potential is the one given; zero at held unknowns. A guess: the tangent is shifted where it is not positive
    /// definite.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent cannot be factorised.
    pub fn predict(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
        describe: Describe,
    ) -> Result<Vec<f64>, SolveFault> {
        let (mut residual, _) = self.factorise_at(potential, u, describe)?;
        add_product(potential, 1.0, u, motion, &mut residual).map_err(|f| f.named(describe))?;
        self.change(&residual)
    }

    /// The field that is at rest at free unknowns under the transposed tangent at `u` while held ones move by `motion`:
    /// the influence of forces on free unknowns on the work of the reactions in that motion; `motion` itself at held
    /// unknowns.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent there is not positive definite.
    pub fn influence(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
        describe: Describe,
    ) -> Result<Vec<f64>, SolveFault> {
        self.at(potential, u, describe)?;
        self.skew.transpose();
        let mut forces = vec![0.0; u.len()];
        add_product(potential, -1.0, u, motion, &mut forces).map_err(|f| f.named(describe))?;
        let change = self.change(&forces)?;
        Ok(motion.iter().zip(change).map(|(m, c)| m + c).collect())
    }

    /// The change of the free unknowns by the transposed tangent at `u` under small forces on them; zero at held
    /// unknowns. The tangent of a potential is its own transpose.
    ///
    /// # Errors
    /// A [`SolveFault`] when `u` is not admissible or the tangent there is not positive definite.
    pub fn respond(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        forces: &[f64],
        describe: Describe,
    ) -> Result<Vec<f64>, SolveFault> {
        self.at(potential, u, describe)?;
        self.skew.transpose();
        let opposed: Vec<f64> = forces.iter().map(|force| -force).collect();
        self.change(&opposed)
    }

    /// The direction φ of least stiffness at `u`, ‖φ‖ = 1, by inverse iteration, and φᵀ K φ; φ is zero at held
    /// unknowns. `None` where there is no tangent.
    pub fn softest_mode(&mut self, potential: &dyn Potential, u: &[f64]) -> Option<SoftestMode> {
        /// A shift with which a tangent that is singular but for rounding can be solved.
        const SHIFT: f64 = 1e-9;
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        let linearised = self
            .assembly
            .linearise(potential, u, &mut residual, &mut stiffness);
        linearised.ok()?;
        let tangent = stiffness.clone();
        let skew = std::mem::take(&mut self.skew);
        let factorised = self.factorise(&mut stiffness);
        // The known columns are those of another factor.
        self.skew = skew;
        self.skew.columns.clear();
        factorised.ok()?;
        let mut mode = self.inverse_iteration();
        if mode.is_none() {
            let shift = SHIFT * self.assembly.stiffest(&stiffness);
            for position in self.assembly.pattern().diagonal() {
                stiffness[*position] += shift;
            }
            self.analysed().ok()?.factorise(&stiffness).ok()?;
            mode = self.inverse_iteration();
        }
        let mode = mode?;
        let forces = self.assembly.pattern().multiply(&tangent, &mode);
        Some(SoftestMode {
            stiffness: dot(&mode, &forces),
            stiffest: self.assembly.stiffest(&tangent),
            displacement: spread(self.free(), &mode, u.len()),
        })
    }

    /// The mode of least stiffness of the factor at hand, of length one; `None` where that is singular to working precision.
    fn inverse_iteration(&mut self) -> Option<Vec<f64>> {
        const ITERATIONS: usize = 20;
        // A start without any symmetry has a part of every mode.
        let count = self.free().len();
        let mut mode: Vec<f64> = (0..count).map(|i| (1.0 + i as f64).sqrt().sin()).collect();
        for _ in 0..ITERATIONS {
            mode = self.analysed().ok()?.solve(&mode).ok()?;
            let size = norm(&mode);
            mode.iter_mut().for_each(|entry| *entry /= size);
        }
        Some(mode)
    }

    /// Factorises the tangent at `u`; returns the residual there, and whether the tangent had to be shifted.
    fn factorise_at(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        describe: Describe,
    ) -> Result<(Vec<f64>, bool), SolveFault> {
        let mut residual = vec![0.0; u.len()];
        self.take_skew(potential);
        if let Some(iterative) = &mut self.iterative {
            let linearised = iterative.linearise(potential, u, &mut residual);
            linearised.map_err(|fault| fault.named(describe))?;
            self.factorised = false;
            return Ok((residual, false));
        }
        let mut stiffness = Vec::new();
        let assembly = &self.assembly;
        let linearised = assembly.linearise(potential, u, &mut residual, &mut stiffness);
        linearised.map_err(|fault| fault.named(describe))?;
        let shifted = self.factorise(&mut stiffness)?;
        Ok((residual, shifted))
    }

    /// Factorises the tangent taken last, unless it is factorised; returns whether it had to be shifted.
    fn replace_by_factor(&mut self) -> Result<bool, SolveFault> {
        match &self.iterative {
            Some(iterative) if !self.factorised => {
                let mut entries = iterative.entries(&self.assembly);
                self.factorise(&mut entries)
            }
            _ => Ok(false),
        }
    }

    /// Factorises the stiffness, shifted along its diagonal where it is not positive definite; returns whether it had to be shifted.
    pub(super) fn factorise(&mut self, stiffness: &mut [f64]) -> Result<bool, SolveFault> {
        let mean = self.assembly.pattern().mean_diagonal(stiffness);
        let mut shift = 0.0;
        let mut outcome = self.factorise_braced(stiffness);
        while let Err(fault) = outcome {
            if fault == FactorFault::OutOfMemory {
                return Err(fault.into());
            }
            let next = if shift == 0.0 {
                1e-4 * mean
            } else {
                4.0 * shift
            };
            if mean.is_nan() || next >= 1e3 * mean {
                return Err(SolveFault::Singular);
            }
            for position in self.assembly.pattern().diagonal() {
                stiffness[*position] += next - shift;
            }
            shift = next;
            outcome = self.analysed()?.factorise(stiffness);
        }
        Ok(shift > 0.0)
    }

    /// −K⁻¹ r at the free unknowns.
    fn change(&mut self, residual: &[f64]) -> Result<Vec<f64>, SolveFault> {
        let step = self.step(residual)?;
        Ok(spread(self.free(), &step, residual.len()))
    }

    /// K⁻¹ b by multigrid or the factor, without the skew part.
    pub(super) fn solve(&mut self, right: &[f64]) -> Result<Vec<f64>, SolveFault> {
        const REDUCTION: f64 = 1e-12;
        if !self.factorised
            && let Some(iterative) = &mut self.iterative
        {
            if let Ok(x) = iterative.solve(right, REDUCTION) {
                return Ok(x);
            }
            self.replace_by_factor()?;
        }
        self.analysed()?.solve(right).map_err(SolveFault::from)
    }

    /// −(K + S)⁻¹ r with the symmetric factor of K.
    pub(super) fn step(&mut self, residual: &[f64]) -> Result<Vec<f64>, SolveFault> {
        let mut negative = gather(self.assembly.free(), residual);
        scale(&mut negative, -1.0);
        let step = self.solve(&negative)?;
        if self.skew.is_none() {
            return Ok(step);
        }
        self.find_columns()?;
        self.skew.complete(step).ok_or(SolveFault::Singular)
    }
}

/// Adds the forces K m of a small motion m of some unknowns, at all unknowns; Kᵀ m where the sign of the skew part is −1.
fn add_product(
    potential: &dyn Potential,
    sign: f64,
    u: &[f64],
    motion: &[f64],
    forces: &mut [f64],
) -> Result<(), Inadmissible> {
    Assembly::add_product(potential, u, motion, forces)?;
    for coupling in potential.skew_couplings() {
        forces[coupling.row] += sign * coupling.stiffness * motion[coupling.column];
        forces[coupling.column] -= sign * coupling.stiffness * motion[coupling.row];
    }
    Ok(())
}
