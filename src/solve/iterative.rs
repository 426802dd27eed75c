//! A tangent without a factor: conjugate gradients with one cycle of multigrid each.

use super::aggregation::{Hierarchy, Motions};
use super::assembly::Assembly;
use super::nodal::{NodalMatrix, Nodes, conjugate_gradients, product};
use super::potential::Potential;
use super::sparse::FactorFault;

/// How systems with the tangent are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearSolver {
    /// By multigrid where it is faster, which is from [`WORTH_MULTIGRID`] unknowns on, otherwise by a factor. The default.
    #[default]
    Automatic,
    /// By a sparse Cholesky factor.
    Direct,
    /// By conjugate gradients with multigrid, where the places of the nodes are known and the tangent is symmetric; by a factor
    /// where the iteration does not lead to the end.
    Multigrid,
}

/// Unknowns from which on multigrid is faster than a factor.
pub const WORTH_MULTIGRID: usize = 100_000;

/// Iterations that a system may take.
const MOST: usize = 80;

/// Iterations, over those of a cycle made for this very tangent, from which on a new cycle is made.
const STALE: f64 = 1.6;

/// The tangent of a potential by nodes, with a cycle that was made for it or for one before it.
pub struct Iterative {
    nodes: Nodes,
    motions: Vec<Motions<2>>,
    matrix: NodalMatrix,
    /// The values taken last.
    values: Vec<f64>,
    cycle: Option<Hierarchy>,
    /// Whether the cycle was made for the values taken last.
    fresh: bool,
    /// Iterations a digit with a cycle of its own.
    pace: f64,
    /// Iterations of all systems so far.
    pub iterations: usize,
}

impl LinearSolver {
    /// The names that studies use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("automatic", Self::Automatic),
        ("direct", Self::Direct),
        ("multigrid", Self::Multigrid),
    ];

    /// Whether it is multigrid for so many unknowns.
    pub fn is_multigrid(self, unknowns: usize) -> bool {
        match self {
            Self::Automatic => unknowns >= WORTH_MULTIGRID,
            Self::Direct => false,
            Self::Multigrid => unknowns > 0,
        }
    }
}

impl Iterative {
    /// Prepares the tangent of a potential; `None` where the places of its nodes are not known, or where it has a part that is not
    /// symmetric.
    pub fn new(assembly: &Assembly, potential: &dyn Potential) -> Option<Self> {
        let nodes = Nodes::new(assembly.free(), assembly.places()?);
        let free = |unknown| assembly.free_index(unknown).is_some();
        let couplings = potential.skew_couplings();
        let mut skew = couplings
            .iter()
            .map(|own| free(own.row) && free(own.column));
        (!skew.any(|couples| couples)).then(|| Self {
            motions: nodes.motions(),
            matrix: NodalMatrix::new(&nodes, assembly.pattern()),
            nodes,
            values: Vec::new(),
            cycle: None,
            fresh: false,
            pace: f64::INFINITY,
            iterations: 0,
        })
    }

    /// Takes the tangent at another state.
    pub fn take(&mut self, assembly: &Assembly, values: &[f64]) {
        self.matrix.take(&self.nodes, assembly.pattern(), values);
        self.values.clear();
        self.values.extend_from_slice(values);
        self.fresh = false;
    }

    /// The values taken last.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// x of K x = b, until the residual has fallen by `reduction` in the norm of the preconditioner.
    ///
    /// # Errors
    /// [`FactorFault`] where K is not positive definite, or the iteration does not get there.
    pub fn solve(&mut self, b: &[f64], reduction: f64) -> Result<Vec<f64>, FactorFault> {
        let b = self.nodes.spread(b);
        loop {
            self.prepare()?;
            let cycle = self.cycle.as_mut().expect("made above");
            let found = conjugate_gradients(&self.matrix.blocks, cycle, &b, reduction, MOST);
            self.iterations += found.as_ref().map_or(MOST, |found| found.iterations);
            if let Ok(found) = &found
                && found.reduction <= reduction
            {
                let digits = -found.reduction.max(1e-16).log10();
                let pace = (found.iterations as f64 - 1.0) / digits.max(1.0);
                if self.fresh {
                    self.pace = pace;
                } else if pace > STALE * self.pace {
                    self.cycle = None;
                }
                return Ok(self.nodes.gather(&found.x));
            }
            self.cycle = None;
            if self.fresh {
                return Err(found.err().unwrap_or(FactorFault::NotPositiveDefinite));
            }
        }
    }

    /// √(r · M r), which is about √(r · K⁻¹ r): the imbalance r as the energy that it stands for; nothing where there is no cycle.
    pub fn weight(&mut self, r: &[f64]) -> Option<f64> {
        self.prepare().ok()?;
        let r = self.nodes.spread(r);
        let mut z = vec![[0.0; 2]; r.len()];
        self.cycle.as_mut()?.apply(&r, &mut z);
        let product = product(&r, &z);
        (product >= 0.0).then(|| product.sqrt())
    }

    /// Makes a cycle where there is none.
    fn prepare(&mut self) -> Result<(), FactorFault> {
        if self.cycle.is_none() {
            self.cycle = Some(Hierarchy::new(&self.matrix.blocks, &self.motions)?);
            self.fresh = true;
        }
        Ok(())
    }

    /// Whether the tangent is positive definite, as far as a dozen iterations from a start that has a part of every mode show: with a
    /// good preconditioner a negative stiffness stands alone, and is found first.
    pub fn is_definite(&mut self) -> bool {
        const ITERATIONS: usize = 12;
        let (Ok(()), Some(cycle)) = (self.prepare(), &mut self.cycle) else {
            return false;
        };
        let start = self.nodes.uneven();
        conjugate_gradients(&self.matrix.blocks, cycle, &start, 0.0, ITERATIONS).is_ok()
    }
}
