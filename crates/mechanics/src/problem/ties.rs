//! A potential in which some unknowns are tied to others.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::constraints::Tie;
use crate::solve::{Connectivity, Evaluated, Local, Potential, SkewCoupling, Take};

/// Π(u) with uᵢ = s uₖ for every tie (i, k) of the share s: elements depend on the k alone, and there is no equation for an i.
///
/// ```text
/// u = T v,   r_v = Tᵀ r,   K_v = Tᵀ K T,   T of zeros, ones and shares
/// ```
pub struct TiedPotential<'a> {
    potential: Box<dyn Potential + 'a>,
    connectivity: Connectivity,
    /// For each element with tied unknowns: the position of each unknown of the untied element among its own, and its share.
    positions: BTreeMap<usize, Vec<(usize, f64)>>,
    ties: &'a BTreeMap<usize, Tie>,
}

impl<'a> TiedPotential<'a> {
    /// Ties unknowns (keys) to others.
    pub fn new(potential: Box<dyn Potential + 'a>, ties: &'a BTreeMap<usize, Tie>) -> Self {
        let mut connectivity = Connectivity::new(potential.unknowns());
        connectivity.reserve_as(potential.connectivity());
        let mut tied = BTreeMap::new();
        for element in 0..potential.elements() {
            let element_unknowns = potential.element_unknowns(element);
            let element_unknowns = element_unknowns.iter().map(|unknown| *unknown as usize);
            if !element_unknowns
                .clone()
                .any(|unknown| ties.contains_key(&unknown))
            {
                connectivity.push(element_unknowns);
                continue;
            }
            let (mut unknowns, mut positions) = (Vec::new(), Vec::new());
            for unknown in element_unknowns {
                let (unknown, share) = followed(ties, unknown);
                let known = unknowns.iter().position(|known| *known == unknown);
                positions.push((known.unwrap_or(unknowns.len()), share));
                if known.is_none() {
                    unknowns.push(unknown);
                }
            }
            connectivity.push(unknowns);
            tied.insert(element, positions);
        }
        let nodes = Arc::clone(potential.connectivity().nodes());
        Self {
            connectivity: connectivity.with_positions(nodes),
            potential,
            positions: tied,
            ties,
        }
    }
}

/// The unknown that one follows, and its share; itself where it is not tied.
fn followed(ties: &BTreeMap<usize, Tie>, unknown: usize) -> (usize, f64) {
    let tie = ties.get(&unknown);
    tie.map_or((unknown, 1.0), |tie| (tie.master, tie.share))
}

/// The values of an element's untied unknowns.
fn spread(positions: &[(usize, f64)], u: &[f64]) -> Vec<f64> {
    positions
        .iter()
        .map(|(position, share)| share * u[*position])
        .collect()
}

impl TiedPotential<'_> {
    /// Evaluates the untied potential at u = T v, whose forces become those of v: f ← f + Tᵀ r.
    fn untied(
        &self,
        v: &[f64],
        forces: &mut [f64],
        evaluate: impl FnOnce(&[f64], &mut [f64]) -> Evaluated,
    ) -> Evaluated {
        let (mut u, mut untied) = (v.to_vec(), vec![0.0; v.len()]);
        for (unknown, tie) in self.ties {
            u[*unknown] = tie.share * v[tie.master];
        }
        let energy = evaluate(&u, &mut untied)?;
        for (unknown, tie) in self.ties {
            untied[tie.master] += tie.share * std::mem::take(&mut untied[*unknown]);
        }
        for (force, contribution) in forces.iter_mut().zip(untied) {
            *force += contribution;
        }
        Ok(energy)
    }
}

/// Adds Tᵀ K T of an element, whose unknowns have these positions among its remaining ones; elements may fill the lower triangle alone.
fn fold(positions: &[(usize, f64)], stiffness: &[f64], folded: &mut [f64]) {
    let (count, size) = (positions.len(), folded.len().isqrt());
    for (row, (to_row, of_row)) in positions.iter().enumerate() {
        for (column, (to_column, of_column)) in positions.iter().enumerate() {
            let value = stiffness[row.max(column) * count + row.min(column)];
            folded[to_row * size + to_column] += of_row * of_column * value;
        }
    }
}

impl Potential for TiedPotential<'_> {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn skew_couplings(&self) -> Vec<SkewCoupling> {
        let couplings = self.potential.skew_couplings().into_iter();
        couplings
            .map(|coupling| {
                let (row, of_row) = followed(self.ties, coupling.row);
                let (column, of_column) = followed(self.ties, coupling.column);
                SkewCoupling {
                    row,
                    column,
                    stiffness: of_row * of_column * coupling.stiffness,
                }
            })
            .collect()
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        let Some(positions) = self.positions.get(&element) else {
            return self.potential.evaluate_element(element, u, local);
        };
        let count = positions.len();
        let mut residual = vec![0.0; count];
        let mut matrix = vec![0.0; local.stiffness.as_ref().map_or(0, |_| count * count)];
        let inner = Local {
            residual: &mut residual,
            stiffness: local.stiffness.is_some().then_some(&mut matrix[..]),
        };
        let energy = self
            .potential
            .evaluate_element(element, &spread(positions, u), inner)?;
        for ((position, share), r) in positions.iter().zip(residual) {
            local.residual[*position] += share * r;
        }
        if let Some(stiffness) = local.stiffness {
            fold(positions, &matrix, stiffness);
        }
        Ok(energy)
    }

    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Evaluated {
        let Some(take) = take else {
            return self.untied(u, forces, |u, untied| {
                self.potential.evaluate(u, untied, None)
            });
        };
        let mut folded = Vec::new();
        let mut take = |element: usize, stiffness: &[f64]| {
            let Some(positions) = self.positions.get(&element) else {
                return take(element, stiffness);
            };
            let size = self.element_unknowns(element).len();
            folded.clear();
            folded.resize(size * size, 0.0);
            fold(positions, stiffness, &mut folded);
            take(element, &folded);
        };
        self.untied(u, forces, |u, untied| {
            self.potential.evaluate(u, untied, Some(&mut take))
        })
    }

    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        match self.positions.get(&element) {
            Some(positions) => self.potential.instability(element, &spread(positions, u)),
            None => self.potential.instability(element, u),
        }
    }
}
