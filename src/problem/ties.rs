//! A potential some of whose unknowns are tied to others.

use std::collections::BTreeMap;

use crate::solve::{Inadmissible, Local, Potential, SkewCoupling};

/// Π(u) with uᵢ = uₖ for every tie (i, k): elements depend on the k alone, and no equation is left for an i.
///
/// ```text
/// u = T v,   r_v = Tᵀ r,   K_v = Tᵀ K T,   T of zeros and ones
/// ```
pub struct Tied<'a> {
    potential: Box<dyn Potential + 'a>,
    elements: BTreeMap<usize, TiedElement>,
    ties: BTreeMap<usize, usize>,
}

/// An element with tied unknowns.
struct TiedElement {
    /// The unknowns, each once.
    unknowns: Vec<usize>,
    /// The place among these of each unknown of the untied element.
    places: Vec<usize>,
}

impl<'a> Tied<'a> {
    /// Ties unknowns (keys) to others.
    pub fn new(potential: Box<dyn Potential + 'a>, ties: &BTreeMap<usize, usize>) -> Self {
        let mut elements = BTreeMap::new();
        for element in 0..potential.elements() {
            let own = potential.element_unknowns(element);
            if !own.iter().any(|unknown| ties.contains_key(unknown)) {
                continue;
            }
            let (mut unknowns, mut places) = (Vec::new(), Vec::new());
            for unknown in own {
                let unknown = *ties.get(unknown).unwrap_or(unknown);
                let known = unknowns.iter().position(|known| *known == unknown);
                places.push(known.unwrap_or(unknowns.len()));
                if known.is_none() {
                    unknowns.push(unknown);
                }
            }
            elements.insert(element, TiedElement { unknowns, places });
        }
        Self {
            potential,
            elements,
            ties: ties.clone(),
        }
    }
}

impl TiedElement {
    fn expand(&self, u: &[f64]) -> Vec<f64> {
        self.places.iter().map(|place| u[*place]).collect()
    }
}

impl Potential for Tied<'_> {
    fn unknowns(&self) -> usize {
        self.potential.unknowns()
    }

    fn elements(&self) -> usize {
        self.potential.elements()
    }

    fn element_unknowns(&self, element: usize) -> &[usize] {
        match self.elements.get(&element) {
            Some(tied) => &tied.unknowns,
            None => self.potential.element_unknowns(element),
        }
    }

    fn place(&self, unknown: usize) -> Option<[f64; 2]> {
        self.potential.place(unknown)
    }

    fn skew_couplings(&self) -> Vec<SkewCoupling> {
        let master = |unknown: usize| *self.ties.get(&unknown).unwrap_or(&unknown);
        let own = self.potential.skew_couplings().into_iter();
        own.map(|coupling| SkewCoupling {
            row: master(coupling.row),
            column: master(coupling.column),
            ..coupling
        })
        .collect()
    }

    fn evaluate_element(
        &self,
        element: usize,
        u: &[f64],
        local: Local<'_>,
    ) -> Result<f64, Inadmissible> {
        let Some(tied) = self.elements.get(&element) else {
            return self.potential.evaluate_element(element, u, local);
        };
        let (size, own) = (tied.unknowns.len(), tied.places.len());
        let mut residual = vec![0.0; own];
        let mut matrix = vec![0.0; local.stiffness.as_ref().map_or(0, |_| own * own)];
        let inner = Local {
            residual: &mut residual,
            stiffness: local.stiffness.is_some().then_some(&mut matrix[..]),
        };
        let energy = self
            .potential
            .evaluate_element(element, &tied.expand(u), inner)?;
        for (place, r) in tied.places.iter().zip(residual) {
            local.residual[*place] += r;
        }
        if let Some(stiffness) = local.stiffness {
            for (row, to_row) in tied.places.iter().enumerate() {
                for (column, to_column) in tied.places.iter().enumerate() {
                    // Elements may fill the lower triangle alone.
                    let value = matrix[row.max(column) * own + row.min(column)];
                    stiffness[to_row * size + to_column] += value;
                }
            }
        }
        Ok(energy)
    }

    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        match self.elements.get(&element) {
            Some(tied) => self.potential.instability(element, &tied.expand(u)),
            None => self.potential.instability(element, u),
        }
    }
}
