//! A tangent without a factor: conjugate gradients with one multigrid cycle per iteration.

use super::aggregation::Hierarchy;
use super::assembly::Assembly;
use super::nested::{Carry, Ladder, Nested};
use super::nodal::{NodalMatrix, Nodes, Wanted, conjugate_gradients};
use super::potential::{Inadmissible, Potential};
use super::sparse::FactorFault;

/// How systems with the tangent are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearSolver {
    /// By multigrid from [`WORTH_MULTIGRID`] unknowns on, otherwise by a factor. The default.
    #[default]
    Automatic,
    /// By a sparse Cholesky factor.
    Direct,
    /// By conjugate gradients with multigrid, where the places of the nodes are known and the tangent is symmetric;
    /// by a factor where the iteration does not converge.
    Multigrid,
}

/// Number of unknowns from which multigrid is taken: about where it is as fast as a factor with linear elements; with
/// quadratic ones it takes up to half as long again there, and less memory.
pub const WORTH_MULTIGRID: usize = 500_000;

/// Most iterations of a system.
const MOST: usize = 80;

/// Iterations, relative to those of a cycle made for the same tangent, from which on a new cycle is made.
const STALE: f64 = 1.6;

/// The tangent of a potential by nodes, with a cycle that was made for it or for one before it.
pub struct Iterative {
    nodes: Nodes,
    matrix: NodalMatrix,
    cycle: Cycle,
    /// Whether the cycle was made for the values taken last, or for others, or is to be made.
    made: Made,
    /// Iterations per digit with a cycle made for the tangent itself.
    pace: f64,
    /// Iterations of all systems so far.
    pub iterations: usize,
}

/// An approximate inverse of the matrix.
enum Cycle {
    /// Made from the matrix alone.
    Aggregation(Option<Box<Hierarchy>>),
    /// Over systems that were solved before.
    Nested(Box<Nested>),
}

/// The values for which a cycle was made.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Made {
    ForThese,
    ForOthers,
    Not,
}

/// The result of solving a system.
pub struct Solved {
    /// The free unknowns.
    pub x: Vec<f64>,
    /// √(b · M b), which is about √(b · K⁻¹ b): the imbalance b in terms of the energy that it represents.
    pub weight: f64,
}

impl Cycle {
    /// z = M r.
    fn apply(&mut self, r: &[[f64; 2]], z: &mut [[f64; 2]]) {
        match self {
            Self::Aggregation(cycle) => cycle.as_mut().expect("made").apply(r, z),
            Self::Nested(cycle) => cycle.apply(r, z),
        }
    }
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
            matrix: NodalMatrix::new(&nodes, assembly.free(), potential),
            nodes,
            cycle: Cycle::Aggregation(None),
            made: Made::Not,
            pace: f64::INFINITY,
            iterations: 0,
        })
    }

    /// Puts it on systems that were solved before; `carry` transfers their fields to this one.
    pub fn put_on(&mut self, ladder: Ladder, assembly: &Assembly, carry: Carry) {
        let cycle = ladder.above(assembly.free(), &self.nodes, carry);
        self.cycle = Cycle::Nested(Box::new(cycle));
        self.made = Made::Not;
    }

    /// The systems with this one as the finest; `None` where it was not put on others.
    pub fn into_ladder(self, assembly: &Assembly) -> Option<Ladder> {
        match self.cycle {
            Cycle::Nested(cycle) => Some(Ladder::new(*cycle, self.nodes, assembly)),
            Cycle::Aggregation(_) => None,
        }
    }

    /// Whether the cycle goes over systems that were solved before.
    pub fn is_nested(&self) -> bool {
        matches!(self.cycle, Cycle::Nested(_))
    }

    /// Takes the tangent of a potential at another state; returns the energy there, and ∂Π/∂u at all unknowns. There
    /// is no tangent at a state that is not admissible.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted element.
    pub fn linearise(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        residual: &mut [f64],
    ) -> Result<f64, Inadmissible> {
        let energy = self.matrix.linearise(potential, u, residual);
        // Aggregation is costly, and also serves for tangents near its own.
        self.made = match (&self.cycle, self.made) {
            (Cycle::Aggregation(_), Made::ForThese | Made::ForOthers) => Made::ForOthers,
            _ => Made::Not,
        };
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
    ///
    /// # Errors
    /// [`FactorFault`] where K is not positive definite, or the iteration does not get there.
    pub fn solve(&mut self, b: &[f64], reduction: f64) -> Result<Vec<f64>, FactorFault> {
        Ok(self.solve_as_far_as(b, |_| Wanted::Reduction(reduction))?.x)
    }

    /// The same, as exactly as is wanted at the weight of b.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn solve_as_far_as(
        &mut self,
        b: &[f64],
        wanted: impl Fn(f64) -> Wanted,
    ) -> Result<Solved, FactorFault> {
        let b = self.nodes.spread(b);
        loop {
            self.prepare()?;
            let cycle = |r: &[[f64; 2]], z: &mut [[f64; 2]]| self.cycle.apply(r, z);
            let found = conjugate_gradients(&self.matrix, cycle, &b, &wanted, MOST);
            self.iterations += found.as_ref().map_or(MOST, |found| found.iterations);
            if let Ok(found) = &found {
                let reached = match wanted(found.first) {
                    Wanted::Size => true,
                    Wanted::Reduction(reduction) => found.reduction <= reduction,
                };
                if reached {
                    self.judge(found.iterations, found.reduction);
                    return Ok(Solved {
                        x: self.nodes.gather(&found.x),
                        weight: found.first,
                    });
                }
            }
            match (&self.cycle, self.made) {
                // The smoother does not work on these cells.
                (Cycle::Nested(_), _) => self.cycle = Cycle::Aggregation(None),
                (_, Made::ForThese) => {
                    return Err(found.err().unwrap_or(FactorFault::NotPositiveDefinite));
                }
                _ => {}
            }
            self.made = Made::Not;
        }
    }

    /// Discards a cycle that was made for other values and takes many more iterations than one made for its own.
    fn judge(&mut self, iterations: usize, reduction: f64) {
        if reduction == 1.0 {
            return;
        }
        let digits = -reduction.max(1e-16).log10();
        let pace = (iterations as f64 - 1.0) / digits.max(1.0);
        if self.made == Made::ForThese {
            self.pace = pace;
        } else if pace > STALE * self.pace {
            self.made = Made::Not;
        }
    }

    /// Makes the cycle if it has not been made.
    ///
    /// # Errors
    /// [`FactorFault`] where the tangent taken last has none.
    pub fn prepare(&mut self) -> Result<(), FactorFault> {
        if self.made == Made::Not {
            match &mut self.cycle {
                Cycle::Aggregation(cycle) => {
                    *cycle = Some(Box::new(Hierarchy::new(
                        &self.matrix.whole(),
                        &self.nodes.motions(),
                    )?));
                }
                Cycle::Nested(cycle) => cycle.take(&self.matrix.blocks)?,
            }
            self.made = Made::ForThese;
        }
        Ok(())
    }

    /// Whether the tangent is positive definite, judged by some iterations from a start that has a part of every
    /// mode: with a good preconditioner a negative stiffness is isolated, and is found first.
    pub fn is_definite(&mut self) -> bool {
        let iterations = match self.cycle {
            Cycle::Aggregation(_) => 12,
            Cycle::Nested(_) => 5,
        };
        if self.prepare().is_err() {
            return false;
        }
        let start = self.nodes.uneven();
        let cycle = |r: &[[f64; 2]], z: &mut [[f64; 2]]| self.cycle.apply(r, z);
        conjugate_gradients(
            &self.matrix,
            cycle,
            &start,
            |_| Wanted::Reduction(0.0),
            iterations,
        )
        .is_ok()
    }
}
