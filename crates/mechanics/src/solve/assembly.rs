//! The assembly of a potential: its residual, and its stiffness over the free unknowns.

use std::sync::{Arc, OnceLock};

use super::connectivity::Connectivity;
use super::dissection::dissection;
use super::pattern::SymmetricPattern;
use super::potential::{ElementTerms, Evaluated, Inadmissible, Potential};
use super::scatter::{NOWHERE, Scatter};
use super::sparse::{Cholesky, FactorFault};
use super::vector::{dot, moved, norm};

/// The sum of element contributions into a sparse matrix over the free unknowns.
#[derive(Debug)]
pub struct Assembly {
    /// Position of each unknown among the free ones.
    free_index: Vec<u32>,
    /// The free unknowns, ascending.
    free: Vec<usize>,
    /// The free unknowns of each element.
    elements: Connectivity,
    /// Computed when it is first needed.
    sparse: OnceLock<(SymmetricPattern, Scatter)>,
    /// The positions of the nodes, as far as they are known.
    nodes: Arc<[[f64; 2]]>,
}

/// Unknowns from which on nested dissection pays: its analysis takes half the time of one by least degree, and from
/// half a million unknowns on the factorisation takes one to three times less.
const WORTH_DISSECTION: usize = 30_000;

impl Assembly {
    /// Prepares the assembly of `potential` with the unknowns marked in `fixed` held.
    pub fn new(potential: &dyn Potential, fixed: &[bool]) -> Self {
        let free: Vec<usize> = (0..fixed.len()).filter(|i| !fixed[*i]).collect();
        let mut free_index = vec![NOWHERE; fixed.len()];
        for (index, unknown) in free.iter().enumerate() {
            free_index[*unknown] = index as u32;
        }
        let connectivity = potential.connectivity();
        let mut elements = Connectivity::new(free.len());
        elements.reserve_as(connectivity);
        for element in 0..connectivity.elements() {
            let unknowns = connectivity.of(element).iter();
            elements.push(unknowns.map(|unknown| free_index[*unknown as usize] as usize));
        }
        Self {
            nodes: Arc::clone(connectivity.nodes()),
            free_index,
            free,
            elements,
            sparse: OnceLock::new(),
        }
    }

    /// The free unknowns, ascending.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Position of an unknown among the free ones; `None` where it is held.
    pub fn free_index(&self, unknown: usize) -> Option<usize> {
        let position = self.free_index[unknown];
        (position != NOWHERE).then_some(position as usize)
    }

    /// The position of each free unknown, if all are known.
    pub fn positions(&self) -> Option<impl Iterator<Item = [f64; 2]> + Clone> {
        let last = self.free.last().map_or(0, |unknown| unknown / 2);
        let positions = self.free.iter().map(|unknown| self.nodes[unknown / 2]);
        (last < self.nodes.len()).then_some(positions)
    }

    /// Pattern of the stiffness over the free unknowns.
    pub fn pattern(&self) -> &SymmetricPattern {
        &self.sparse().0
    }

    fn sparse(&self) -> &(SymmetricPattern, Scatter) {
        self.sparse.get_or_init(|| Scatter::new(&self.elements))
    }

    /// The largest entry on the diagonal of a stiffness.
    pub fn stiffest(&self, stiffness: &[f64]) -> f64 {
        let diagonal = self.pattern().diagonal().iter();
        diagonal.fold(0.0, |most: f64, entry| most.max(stiffness[*entry].abs()))
    }

    /// Analyses the pattern of the stiffness, in an order by positions where the system is large and the positions are known.
    ///
    /// # Errors
    /// [`FactorFault`] when the pattern cannot be analysed because memory runs out.
    pub fn analyse(&self) -> Result<Cholesky, FactorFault> {
        match self.positions() {
            Some(positions) if self.free.len() >= WORTH_DISSECTION => {
                let positions: Vec<[f64; 2]> = positions.collect();
                let order = dissection(self.pattern(), &positions);
                Cholesky::analyse_in_order(self.pattern().clone(), &order)
            }
            _ => Cholesky::analyse(self.pattern().clone()),
        }
    }

    /// Energy and full residual, including fixed unknowns, at which it is the reaction.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted element.
    pub fn residual(potential: &dyn Potential, u: &[f64], residual: &mut [f64]) -> Evaluated {
        residual.fill(0.0);
        potential.evaluate(u, residual, None)
    }

    /// Adds the forces K m of a small motion m of some unknowns, at all unknowns.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted element.
    pub fn add_product(
        potential: &dyn Potential,
        u: &[f64],
        motion: &[f64],
        forces: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let mut terms = ElementTerms::default();
        for element in 0..potential.elements() {
            let unknowns = potential.element_unknowns(element);
            if (unknowns.iter()).all(|unknown| motion[*unknown as usize] == 0.0) {
                continue;
            }
            let size = unknowns.len();
            terms.evaluate(potential, element, u, true)?;
            for row in 0..size {
                for column in 0..size {
                    let stiffness = terms.stiffness[row.max(column) * size + row.min(column)];
                    let [row, column] = [row, column].map(|index| unknowns[index] as usize);
                    forces[row] += stiffness * motion[column];
                }
            }
        }
        Ok(())
    }

    /// Energy, full residual and the stiffness of the free unknowns.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted element.
    pub fn linearise(
        &self,
        potential: &dyn Potential,
        u: &[f64],
        residual: &mut [f64],
        stiffness: &mut Vec<f64>,
    ) -> Evaluated {
        residual.fill(0.0);
        stiffness.clear();
        let (pattern, scatter) = self.sparse();
        stiffness.resize(pattern.entries(), 0.0);
        let mut take = |element: usize, lower: &[f64]| {
            let size = potential.element_unknowns(element).len();
            let mut entries = scatter.of(element).iter();
            for row in 0..size {
                let values = &lower[row * size..=row * size + row];
                for (value, entry) in values.iter().zip(&mut entries) {
                    if *entry != NOWHERE {
                        stiffness[*entry as usize] += value;
                    }
                }
            }
        };
        potential.evaluate(u, residual, Some(&mut take))
    }
}

/// Checks ∂Π/∂u and ∂²Π/∂u² against central differences along a direction; returns the smallest
/// relative errors over the step sizes (each error is V-shaped in the step).
pub fn derivative_errors(potential: &dyn Potential, u: &[f64], direction: &[f64]) -> [f64; 2] {
    let size = potential.unknowns();
    let assembly = Assembly::new(potential, &vec![false; size]);
    let (mut residual, mut stiffness) = (vec![0.0; size], Vec::new());
    let at = |step: f64| {
        let mut residual = vec![0.0; size];
        let energy = Assembly::residual(potential, &moved(u, step, direction), &mut residual)
            .expect("admissible");
        (energy, residual)
    };
    assembly
        .linearise(potential, u, &mut residual, &mut stiffness)
        .expect("admissible");
    let slope = dot(&residual, direction);
    let product = assembly.pattern().multiply(&stiffness, direction);
    let mut best = [f64::INFINITY; 2];
    for step in (1..8).map(|power| 10f64.powi(-power)) {
        let ((up_energy, up), (down_energy, down)) = (at(step), at(-step));
        let energy_error = ((up_energy - down_energy) / (2.0 * step) - slope).abs() / slope.abs();
        let difference: Vec<f64> = up
            .iter()
            .zip(&down)
            .zip(&product)
            .map(|((u, d), p)| (u - d) / (2.0 * step) - p)
            .collect();
        let residual_error = norm(&difference) / norm(&product);
        best = [best[0].min(energy_error), best[1].min(residual_error)];
    }
    best
}
