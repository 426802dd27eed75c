//! A tangent without a factor: conjugate gradients with one multigrid cycle per iteration.

use super::aggregation::Hierarchy;
use super::assembly::Assembly;
use super::nodal::{NodalMatrix, Nodes, Solution, conjugate_gradients};
use super::potential::{Evaluated, Potential};
use super::sparse::FactorFault;

/// How systems with the tangent are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearSolver {
    /// By multigrid from [`WORTH_MULTIGRID`] unknowns on, otherwise by a factor. The default.
    #[default]
    Automatic,
    /// By a sparse Cholesky factor.
    Direct,
    /// By conjugate gradients with multigrid, where the positions of the nodes are known and the tangent is symmetric;
    /// by a factor where the iteration does not converge.
    Multigrid,
}

/// Number of unknowns from which multigrid is taken: it saves a third of a factor's time and memory there on a strip with a hole, and half
/// of both at four times as many unknowns, see `guide::performance`; on plates of equal quadratic cells it takes longer.
pub const WORTH_MULTIGRID: usize = 500_000;

/// Most iterations of a system.
const MOST_ITERATIONS: usize = 80;

/// Iterations, relative to those of a cycle made for the same tangent, from which on a new cycle is made.
const STALE: f64 = 1.6;

/// The tangent of a potential by nodes, with a cycle that was made for it or for one before it.
pub struct Iterative {
    nodes: Nodes,
    matrix: NodalMatrix,
    cycle: Option<Box<Hierarchy>>,
    /// Whether the cycle was made for the values taken last, or for others, or is to be made.
    built: Built,
    /// Iterations per digit with a cycle made for the tangent itself.
    iterations_per_digit: f64,
}

/// The values for which a cycle was made.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Built {
    ForThese,
    ForOthers,
    Not,
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
    /// Prepares the tangent of a potential; `None` where the positions of its nodes are not known, or where it has a part that is not
    /// symmetric.
    pub fn new(assembly: &Assembly, potential: &dyn Potential) -> Option<Self> {
        let nodes = Nodes::new(assembly.free(), assembly.positions()?);
        let free = |unknown| assembly.free_index(unknown).is_some();
        let couplings = potential.skew_couplings();
        let mut skew = couplings
            .iter()
            .map(|coupling| free(coupling.row) && free(coupling.column));
        (!skew.any(|couples| couples)).then(|| Self {
            matrix: NodalMatrix::new(&nodes, assembly.free(), potential),
            nodes,
            cycle: None,
            built: Built::Not,
            iterations_per_digit: f64::INFINITY,
        })
    }

    /// Takes the tangent of a potential at another state; returns the energy there, and ∂Π/∂u at all unknowns. There
    /// is no tangent at a state that is not admissible.
    pub fn linearise(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        residual: &mut [f64],
    ) -> Evaluated {
        let energy = self.matrix.linearise(potential, u, residual);
        // Aggregation is costly, and also serves for tangents near its own.
        if self.built == Built::ForThese {
            self.built = Built::ForOthers;
        }
        energy
    }

    /// The entries of the tangent taken last.
    pub fn entries(&self, assembly: &Assembly) -> Vec<f64> {
        self.matrix.entries(&self.nodes, assembly.pattern())
    }

    /// The largest entry on its diagonal.
    pub fn stiffest(&self) -> f64 {
        self.matrix.stiffest()
    }

    /// x of K x = b, until the residual has fallen by `reduction` in the norm of the preconditioner.
    pub fn solve(&mut self, b: &[f64], reduction: f64) -> Result<Vec<f64>, FactorFault> {
        let b = self.nodes.spread(b);
        loop {
            let solution = self.iterate(&b, reduction, MOST_ITERATIONS);
            if let Ok(solution) = &solution
                && solution.reduction <= reduction
            {
                self.discard_if_stale(solution.iterations, solution.reduction);
                return Ok(self.nodes.gather(&solution.x));
            }
            if self.built == Built::ForThese {
                return Err(solution.err().unwrap_or(FactorFault::NotPositiveDefinite));
            }
            self.built = Built::Not;
        }
    }

    /// Conjugate gradients with the cycle, which is made if it has not been.
    fn iterate(
        &mut self,
        b: &[[f64; 2]],
        reduction: f64,
        most: usize,
    ) -> Result<Solution, FactorFault> {
        if self.built == Built::Not {
            self.cycle = None;
        }
        let cycle = match &mut self.cycle {
            Some(cycle) => cycle,
            None => {
                // Also where there is none: another attempt would end alike.
                self.built = Built::ForThese;
                let hierarchy = Hierarchy::new(&self.matrix.full(), &self.nodes.motions())?;
                self.cycle.insert(Box::new(hierarchy))
            }
        };
        conjugate_gradients(&self.matrix, |r, z| cycle.apply(r, z), b, reduction, most)
    }

    /// Discards a cycle that was made for other values and takes many more iterations than one made for its own.
    fn discard_if_stale(&mut self, iterations: usize, reduction: f64) {
        if reduction == 1.0 {
            return;
        }
        let digits = -reduction.max(1e-16).log10();
        let per_digit = (iterations as f64 - 1.0) / digits.max(1.0);
        if self.built == Built::ForThese {
            self.iterations_per_digit = per_digit;
        } else if per_digit > STALE * self.iterations_per_digit {
            self.built = Built::Not;
        }
    }

    /// Whether the tangent is positive definite, judged by some iterations from a start that has a part of every
    /// mode: with a good preconditioner a negative stiffness is isolated, and is found first.
    pub fn is_definite(&mut self) -> bool {
        const ITERATIONS: usize = 12;
        let start = self.nodes.uneven();
        self.iterate(&start, 0.0, ITERATIONS).is_ok()
    }
}
