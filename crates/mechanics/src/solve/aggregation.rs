//! Multigrid by smoothed aggregation: a symmetric approximate inverse of the stiffness of any mesh.
//!
//! Nodes that are strongly coupled are grouped; each group moves as a rigid body, smoothed by one step of damped Jacobi, and is
//! one node of the next coarser level, with three unknowns. A cycle costs about as much as two products with the stiffness, and
//! the iterations around it hardly depend on the number of nodes. Only the positions of its nodes are required of the
//! mesh: quadrilaterals and triangles, linear and quadratic, graded, locally refined, with holes and any supports.
//!
//! | step | how |
//! |---|---|
//! | motions without strain | two translations and the rotation of the nodes' positions |
//! | smoother | block Gauss–Seidel, forward before and backward after the coarser levels: symmetric |
//! | coarser operators | PᵀAP |
//! | coarsest level | sparse Cholesky factor |
//!
//! All sums run in an order that does not depend on the number of threads.
//!
//! Times and memory beside those of a sparse factor are in `guide::performance`.
//!
//! # References
//! P. Vaněk, J. Mandel, M. Brezina, Computing 56, 179 (1996), doi:10.1007/BF02238511

mod aggregates;
pub mod blocks;
pub mod level;
mod prolongation;
#[cfg(test)]
mod tests;

use super::sparse::{Cholesky, FactorFault};
use blocks::Blocks;
use level::{Coarser, Level};
pub use prolongation::Motions;

/// Most nodes of a level that is factorised.
const COARSEST: usize = 200;

/// Largest share of a level's nodes that the next coarser one may have; where groups stay small, that level is the last.
const LARGEST_COARSENING: f64 = 0.7;

/// Levels from fine to coarse.
pub struct Hierarchy {
    fine: Level<2, 3>,
    coarse: Vec<Level<3, 3>>,
    coarsest: Cholesky,
    /// Right-hand side and solution of the coarsest level.
    last: Vec<[f32; 3]>,
}

impl Hierarchy {
    /// The levels of a positive definite matrix with two unknowns a node.
    ///
    /// # Errors
    /// [`FactorFault`] when a level shows that it is not positive definite, or is too large.
    pub fn new(matrix: &Blocks<2, 2>, motions: &[Motions<2>]) -> Result<Self, FactorFault> {
        const INDEFINITE: FactorFault = FactorFault::NotPositiveDefinite;
        let (fine, mut below) = Level::aggregated(matrix, motions).ok_or(INDEFINITE)?;
        let mut coarse: Vec<Level<3, 3>> = Vec::new();
        let mut nodes = fine.nodes();
        loop {
            let rows = below.matrix.rows();
            if rows <= COARSEST || rows as f64 > LARGEST_COARSENING * nodes as f64 {
                break;
            }
            nodes = rows;
            let (level, next) =
                Level::aggregated(&below.matrix, &below.motions).ok_or(INDEFINITE)?;
            coarse.push(level);
            below = next;
        }
        Ok(Self {
            coarsest: factor(&below)?,
            last: vec![[0.0; 3]; below.matrix.rows()],
            coarse,
            fine,
        })
    }

    /// Nodes of all levels, fine to coarse.
    #[cfg(test)]
    pub fn nodes(&self) -> Vec<usize> {
        let coarse = self.coarse.iter().map(Level::nodes);
        let between = std::iter::once(self.fine.nodes()).chain(coarse);
        between.chain([self.last.len()]).collect()
    }

    /// z = M r by one V-cycle.
    pub fn apply(&mut self, r: &[[f64; 2]], z: &mut [[f64; 2]]) {
        let most = single_precision(r, &mut self.fine.b);
        if most == 0.0 || !most.is_finite() {
            z.fill([most; 2]);
            return;
        }
        let Self {
            fine,
            coarse,
            coarsest,
            last,
        } = self;
        fine.descend(
            coarse
                .first_mut()
                .map_or(&mut last[..], |level| &mut level.b),
        );
        for index in 0..coarse.len() {
            let (upper, lower) = coarse.split_at_mut(index + 1);
            upper[index].descend(
                lower
                    .first_mut()
                    .map_or(&mut last[..], |level| &mut level.b),
            );
        }
        let mut flat: Vec<f64> = last.iter().flatten().map(|b| f64::from(*b)).collect();
        coarsest.substitute(&mut flat);
        for (last, correction) in last.iter_mut().zip(flat.chunks_exact(3)) {
            *last = [
                correction[0] as f32,
                correction[1] as f32,
                correction[2] as f32,
            ];
        }
        for index in (0..coarse.len()).rev() {
            let (upper, lower) = coarse.split_at_mut(index + 1);
            upper[index].ascend(lower.first().map_or(&last[..], |level| &level.x));
        }
        fine.ascend(coarse.first().map_or(&last[..], |level| &level.x));
        for (z, x) in z.iter_mut().zip(&fine.x) {
            *z = x.map(|x| most * f64::from(x));
        }
    }
}

/// Rounds a vector to single precision, whose range of exponents is small, after division by its largest entry, which is returned; nothing is
/// written where that entry is zero or not finite.
pub fn single_precision<const N: usize>(r: &[[f64; N]], rounded: &mut [[f32; N]]) -> f64 {
    let sizes = r.iter().flatten().map(|r| r.abs());
    let most = sizes.fold(0.0, f64::max);
    if most > 0.0 && most.is_finite() {
        for (b, r) in rounded.iter_mut().zip(r) {
            *b = r.map(|r| (r / most) as f32);
        }
    }
    most
}

/// The factor of the coarsest level.
fn factor(below: &Coarser) -> Result<Cholesky, FactorFault> {
    let matrix = &below.matrix;
    let column = |column: usize| -> Vec<(usize, f64)> {
        let blocks = matrix.row(column / 3);
        let entries = blocks.flat_map(|(other, block)| {
            let entries = block[column % 3].into_iter().enumerate();
            entries.map(move |(i, entry)| (3 * other + i, entry))
        });
        entries.filter(|(row, _)| *row >= column).collect()
    };
    let columns: Vec<_> = (0..3 * matrix.rows()).map(column).collect();
    Cholesky::of_columns(&columns)
}
