//! Tangents of bodies whose loads have no potential, factorised where their symmetric part is not positive definite.

use super::potential::{Potential, SkewCoupling};
use super::skew::SkewPart;
use super::sparse::FactorFault;
use super::tangent::Tangent;
use crate::error::SolveFault;

/// Stiffness with which a tangent is braced where loads have no potential, relative to the mean of its diagonal.
const BRACE: f64 = 100.0;

/// Width of the braced region around the coupled unknowns, in cells.
const RINGS: usize = 4;

impl Tangent {
    /// Takes the skew part of a potential's tangent between free unknowns.
    pub(super) fn take_skew(&mut self, potential: &dyn Potential) {
        let free = |unknown| self.assembly.free_index(unknown);
        let all = potential.skew_couplings().into_iter();
        let couplings = all.filter_map(|coupling| {
            Some(SkewCoupling {
                row: free(coupling.row)?,
                column: free(coupling.column)?,
                ..coupling
            })
        });
        let couplings: Vec<_> = couplings.collect();
        self.skew = SkewPart::new(&couplings);
    }

    /// Factorises the stiffness as it is, or braced where it has a skew part with which the body is stable.
    pub(super) fn factorise_braced(&mut self, stiffness: &mut [f64]) -> Result<(), FactorFault> {
        self.factorised = true;
        self.skew.brace = 0.0;
        self.skew.columns.clear();
        let outcome = self.analysed()?.factorise(stiffness);
        if outcome != Err(FactorFault::NotPositiveDefinite) || self.skew.is_none() {
            return outcome;
        }
        let unbraced = self.skew.clone();
        let brace = BRACE * self.assembly.pattern().mean_diagonal(stiffness);
        for _ in 0..RINGS {
            self.brace(stiffness, brace);
            let is_braced = self.analysed()?.factorise(stiffness).is_ok();
            if is_braced {
                self.skew.brace = brace;
                if self.find_columns().is_ok() && self.skew.keeps_stability() {
                    return Ok(());
                }
            }
            self.brace(stiffness, -brace);
            if is_braced {
                break;
            }
            let around = self.assembly.pattern().around(self.skew.coupled());
            self.skew.widen(&around);
        }
        self.skew = unbraced;
        outcome
    }

    /// Adds to the diagonal of the unknowns that the skew part couples.
    fn brace(&self, stiffness: &mut [f64], brace: f64) {
        let diagonal = self.assembly.pattern().diagonal();
        for unknown in self.skew.coupled() {
            stiffness[diagonal[*unknown]] += brace;
        }
    }

    /// Computes K'⁻¹ U, once for a factor.
    pub(super) fn find_columns(&mut self) -> Result<(), SolveFault> {
        if !self.skew.columns.is_empty() {
            return Ok(());
        }
        let size = self.free().len();
        let coupled = self.skew.coupled().to_vec();
        let columns = coupled.into_iter().map(|unknown| {
            let mut unit = vec![0.0; size];
            unit[unknown] = 1.0;
            self.solve(&unit)
        });
        self.skew.columns = columns.collect::<Result<_, _>>()?;
        Ok(())
    }
}
