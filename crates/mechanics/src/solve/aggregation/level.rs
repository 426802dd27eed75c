//! One level with its smoother: block Gauss–Seidel, once forward before and once backward after the coarser levels, whose nodes may have
//! another number of unknowns.
//!
//! In single precision: this is the inside of a preconditioner, whose rounding the iteration around it removes.

use nalgebra::SMatrix;

use super::aggregates::{Aggregates, STRONG};
use super::blocks::{Blocks, add_product, rounded};
use super::prolongation::{Motions, smoothed, tentative};

/// A level above the coarsest one, with N unknowns a node, and M on the next coarser one.
pub struct Level<const N: usize, const M: usize> {
    operator: Operator<N>,
    /// What carries fields to the level from the next coarser one, P.
    prolongation: Blocks<N, M, f32>,
    /// The right-hand side, to be written.
    pub b: Vec<[f32; N]>,
    /// The approximate solution.
    pub x: Vec<[f32; N]>,
    residual: Vec<[f32; N]>,
}

/// The operator A of a level: its blocks below the diagonal, L, and the inverses of those on it, D⁻¹. A = L + D + Lᵀ.
pub struct Operator<const N: usize> {
    below: Blocks<N, N, f32>,
    inverses: Vec<[[f32; N]; N]>,
}

impl<const N: usize, const M: usize> Blocks<N, M, f32> {
    /// x ← x + P y.
    fn prolong(&self, y: &[[f32; M]], x: &mut [[f32; N]]) {
        for (row, x) in x.iter_mut().enumerate() {
            for (column, block) in self.row(row) {
                add_product(x, block, &y[column]);
            }
        }
    }

    /// y = Pᵀ x.
    fn restrict(&self, x: &[[f32; N]], y: &mut [[f32; M]]) {
        y.fill([0.0; M]);
        for (row, x) in x.iter().enumerate() {
            for (column, block) in self.row(row) {
                let sum = &mut y[column];
                for i in 0..N {
                    for k in 0..M {
                        sum[k] += block[i][k] * x[i];
                    }
                }
            }
        }
    }
}

/// The operator of the next coarser level, and the motions without strain there.
pub struct Coarser {
    /// PᵀAP.
    pub matrix: Blocks<3, 3>,
    /// The motions.
    pub motions: Vec<Motions<3>>,
}

impl<const N: usize> Operator<N> {
    /// The operator of a matrix, with the inverse of each block on its diagonal in double precision; `None` where one has none.
    fn new(matrix: &Blocks<N, N>) -> Option<(Self, Vec<[[f64; N]; N]>)> {
        let rows = matrix.rows();
        let mut below = Blocks::default();
        let mut inverses = Vec::with_capacity(rows);
        below.starts.push(0);
        for row in 0..rows {
            for (column, block) in matrix.row(row).take_while(|(column, _)| *column <= row) {
                if column < row {
                    below.columns.push(column as u32);
                    below.values.push(rounded(block));
                } else {
                    inverses.push(inverse(block)?);
                }
            }
            below.starts.push(below.columns.len());
        }
        if inverses.len() < rows {
            return None;
        }
        below.columns.shrink_to_fit();
        below.values.shrink_to_fit();
        let operator = Self {
            below,
            inverses: inverses.iter().map(rounded).collect(),
        };
        Some((operator, inverses))
    }

    /// x of one row of a sweep, (b − L x) D⁻¹, of what L x of the columns before is not in `sum` yet; what this x is for the rows before,
    /// −Lᵀ x, is added to their sums.
    #[inline(always)]
    fn relax(&self, row: usize, mut sum: [f32; N], x: &mut [[f32; N]], before: &mut [[f32; N]]) {
        let positions = self.below.starts[row]..self.below.starts[row + 1];
        let columns = &self.below.columns[positions.clone()];
        let blocks = &self.below.values[positions];
        for (column, block) in columns.iter().zip(blocks) {
            let x = &x[*column as usize];
            for i in 0..N {
                for k in 0..N {
                    sum[i] -= block[i][k] * x[k];
                }
            }
        }
        let solution = times(&self.inverses[row], &sum);
        for (column, block) in columns.iter().zip(blocks) {
            let before = &mut before[*column as usize];
            for i in 0..N {
                for k in 0..N {
                    before[k] -= block[i][k] * solution[i];
                }
            }
        }
        x[row] = solution;
    }
}

impl<const N: usize> Level<N, 3> {
    /// A level with the operator `matrix` and what comes below it; `None` where a block on the diagonal has no inverse.
    pub fn aggregated(matrix: &Blocks<N, N>, motions: &[Motions<N>]) -> Option<(Self, Coarser)> {
        let (operator, inverses) = Operator::new(matrix)?;
        let aggregates = Aggregates::of(matrix, STRONG[usize::from(N > 2)]);
        let (rigid, coarse_motions) = tentative(&aggregates, motions);
        let prolongation = smoothed(matrix, &inverses, &aggregates, &rigid);
        let restriction = prolongation.transposed(aggregates.count);
        let image = matrix.product(&prolongation, aggregates.count);
        let mut coarse = restriction.product(&image, aggregates.count);
        fill_gaps(&mut coarse);
        let coarser = Coarser {
            matrix: coarse,
            motions: coarse_motions,
        };
        Some((Self::new(operator, prolongation.rounded()), coarser))
    }
}

impl<const N: usize, const M: usize> Level<N, M> {
    /// A level of an operator.
    fn new(operator: Operator<N>, prolongation: Blocks<N, M, f32>) -> Self {
        let zeros = vec![[0.0; N]; operator.inverses.len()];
        Self {
            operator,
            prolongation,
            b: zeros.clone(),
            x: zeros.clone(),
            residual: zeros,
        }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.x.len()
    }

    /// Smooths from zero, forward, and writes the right-hand side of the next coarser level.
    pub fn descend(&mut self, coarser: &mut [[f32; M]]) {
        // What is left are the terms that the forward sweep did not know.
        self.residual.fill([0.0; N]);
        for row in 0..self.nodes() {
            let (x, before) = (&mut self.x, &mut self.residual);
            self.operator.relax(row, self.b[row], x, before);
        }
        self.prolongation.restrict(&self.residual, coarser);
    }

    /// Adds the correction of the next coarser level and smooths backward.
    pub fn ascend(&mut self, coarser: &[[f32; M]]) {
        self.prolongation.prolong(coarser, &mut self.x);
        self.residual.copy_from_slice(&self.b);
        for row in (0..self.nodes()).rev() {
            let (x, before) = (&mut self.x, &mut self.residual);
            self.operator.relax(row, before[row], x, before);
        }
    }
}

/// Puts one on the diagonal where a motion of an aggregate has no unknown of its own.
fn fill_gaps(matrix: &mut Blocks<3, 3>) {
    for row in 0..matrix.rows() {
        for position in matrix.starts[row]..matrix.starts[row + 1] {
            if matrix.columns[position] as usize == row {
                let block = &mut matrix.values[position];
                for (i, row) in block
                    .iter_mut()
                    .enumerate()
                    .filter(|(i, row)| row[*i] == 0.0)
                {
                    row[i] = 1.0;
                }
            }
        }
    }
}

/// The inverse of a positive definite block.
fn inverse<const N: usize>(block: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let matrix = SMatrix::<f64, N, N>::from_fn(|row, column| block[row][column]);
    let inverse = matrix.cholesky()?.inverse();
    Some(std::array::from_fn(|row| {
        std::array::from_fn(|column| inverse[(row, column)])
    }))
}

#[inline(always)]
fn times<const N: usize>(block: &[[f32; N]; N], x: &[f32; N]) -> [f32; N] {
    let mut product = [0.0; N];
    add_product(&mut product, block, x);
    product
}
