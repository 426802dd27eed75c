//! One level with its smoother: block Gauss–Seidel, once forward before and once backward after the coarser levels, whose nodes may have
//! another number of unknowns.
//!
//! In single precision: this is the inside of a preconditioner, whose rounding the iteration around it removes.

use nalgebra::SMatrix;

use super::aggregates::{Aggregates, STRONG};
use super::blocks::{Blocks, add_product};
use super::prolongation::{Motions, smoothed, tentative};

/// A level above the coarsest one, with N unknowns a node, and M on the next coarser one.
pub struct Level<const N: usize, const M: usize> {
    operator: Operator<N>,
    transfer: Transfer<N, M>,
    /// The right-hand side, to be written.
    pub b: Vec<[f32; N]>,
    /// The approximate solution.
    pub x: Vec<[f32; N]>,
    residual: Vec<[f32; N]>,
}

/// The operator of a level, with the inverses of its blocks on the diagonal.
pub struct Operator<const N: usize> {
    matrix: Blocks<N, N, f32>,
    /// Where the block on the diagonal of each row is.
    diagonal: Vec<usize>,
    inverses: Vec<[[f32; N]; N]>,
}

/// To a level from the next coarser one, and back.
pub struct Transfer<const N: usize, const M: usize> {
    prolongation: Blocks<N, M, f32>,
    restriction: Blocks<M, N, f32>,
}

/// The operator of the next coarser level, and the motions without strain there.
pub struct Coarser {
    /// PᵀAP.
    pub matrix: Blocks<3, 3>,
    /// The motions.
    pub motions: Vec<Motions<3>>,
}

impl<const N: usize> Operator<N> {
    /// One that is to be taken later.
    pub fn none(nodes: usize) -> Self {
        Self {
            matrix: Blocks::default(),
            diagonal: vec![0; nodes],
            inverses: Vec::new(),
        }
    }

    /// The operator of a matrix, and the inverses in double precision; `None` where a block on the diagonal has none.
    pub fn of(matrix: &Blocks<N, N>) -> Option<(Self, Vec<[[f64; N]; N]>)> {
        let find = |row: usize| {
            let places = matrix.starts[row]..matrix.starts[row + 1];
            let own = matrix.columns[places.clone()].binary_search(&(row as u32));
            own.ok().map(|place| places.start + place)
        };
        let diagonal = (0..matrix.rows()).map(find).collect::<Option<Vec<_>>>()?;
        let inverses = diagonal.iter().map(|place| inverse(&matrix.values[*place]));
        let inverses = inverses.collect::<Option<Vec<_>>>()?;
        let operator = Self {
            matrix: matrix.rounded(),
            diagonal,
            inverses: inverses.iter().map(rounded).collect(),
        };
        Some((operator, inverses))
    }
}

impl<const N: usize, const M: usize> Transfer<N, M> {
    /// The transfer of a prolongation P from so many coarse nodes; the restriction is Pᵀ.
    pub fn new(prolongation: &Blocks<N, M>, coarse: usize) -> Self {
        Self {
            prolongation: prolongation.rounded(),
            restriction: prolongation.transposed(coarse).rounded(),
        }
    }
}

impl<const N: usize> Level<N, 3> {
    /// A level with the operator `matrix` and what comes below it; `None` where a block on the diagonal has no inverse.
    pub fn aggregated(matrix: &Blocks<N, N>, motions: &[Motions<N>]) -> Option<(Self, Coarser)> {
        let (operator, inverses) = Operator::of(matrix)?;
        let aggregates = Aggregates::of(matrix, STRONG[usize::from(N > 2)]);
        let (rigid, coarse_motions) = tentative(&aggregates, motions);
        let prolongation = smoothed(matrix, &inverses, &aggregates, &rigid);
        let restriction = prolongation.transposed(aggregates.count);
        let image = matrix.product(&prolongation, aggregates.count);
        let mut coarse = restriction.product(&image, aggregates.count);
        fill_gaps(&mut coarse);
        let transfer = Transfer {
            prolongation: prolongation.rounded(),
            restriction: restriction.rounded(),
        };
        let coarser = Coarser {
            matrix: coarse,
            motions: coarse_motions,
        };
        Some((Self::new(operator, transfer), coarser))
    }
}

impl<const N: usize, const M: usize> Level<N, M> {
    /// A level of an operator.
    pub fn new(operator: Operator<N>, transfer: Transfer<N, M>) -> Self {
        let zeros = vec![[0.0; N]; operator.diagonal.len()];
        Self {
            operator,
            transfer,
            b: zeros.clone(),
            x: zeros.clone(),
            residual: zeros,
        }
    }

    /// Takes another operator of the same nodes.
    pub fn take(&mut self, operator: Operator<N>) {
        self.operator = operator;
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.operator.diagonal.len()
    }

    /// Smooths from zero, forward, and writes the right-hand side of the next coarser level.
    pub fn descend(&mut self, coarser: &mut [[f32; M]]) {
        let Operator {
            matrix,
            diagonal,
            inverses,
        } = &self.operator;
        for row in 0..diagonal.len() {
            let mut sum = self.b[row];
            let before = matrix.starts[row]..diagonal[row];
            subtract(&mut sum, matrix, before, &self.x);
            self.x[row] = times(&inverses[row], &sum);
        }
        // What is left are the terms that the forward sweep did not know.
        for (row, own) in diagonal.iter().enumerate() {
            let mut sum = [0.0; N];
            let after = own + 1..matrix.starts[row + 1];
            subtract(&mut sum, matrix, after, &self.x);
            self.residual[row] = sum;
        }
        for (row, sum) in coarser.iter_mut().enumerate() {
            *sum = [0.0; M];
            for (column, block) in self.transfer.restriction.row(row) {
                add_product(sum, block, &self.residual[column]);
            }
        }
    }

    /// Adds the correction of the next coarser level and smooths backward.
    pub fn ascend(&mut self, coarser: &[[f32; M]]) {
        for (row, x) in self.x.iter_mut().enumerate() {
            for (column, block) in self.transfer.prolongation.row(row) {
                add_product(x, block, &coarser[column]);
            }
        }
        let Operator {
            matrix,
            diagonal,
            inverses,
        } = &self.operator;
        for (row, own) in diagonal.iter().enumerate().rev() {
            let mut sum = self.b[row];
            subtract(&mut sum, matrix, matrix.starts[row]..*own, &self.x);
            let after = own + 1..matrix.starts[row + 1];
            subtract(&mut sum, matrix, after, &self.x);
            self.x[row] = times(&inverses[row], &sum);
        }
    }
}

/// Puts one on the diagonal where a motion of an aggregate has no unknown of its own.
fn fill_gaps(matrix: &mut Blocks<3, 3>) {
    for row in 0..matrix.rows() {
        for place in matrix.starts[row]..matrix.starts[row + 1] {
            if matrix.columns[place] as usize == row {
                let block = &mut matrix.values[place];
                (0..3)
                    .filter(|i| block[*i][*i] == 0.0)
                    .collect::<Vec<_>>()
                    .into_iter()
                    .for_each(|i| block[i][i] = 1.0);
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

/// sum ← sum − Σ Aᵢₖ xₖ over some places of the matrix.
#[inline(always)]
fn subtract<const N: usize>(
    sum: &mut [f32; N],
    matrix: &Blocks<N, N, f32>,
    places: std::ops::Range<usize>,
    x: &[[f32; N]],
) {
    let columns = &matrix.columns[places.clone()];
    for (column, block) in columns.iter().zip(&matrix.values[places]) {
        let x = &x[*column as usize];
        for i in 0..N {
            for k in 0..N {
                sum[i] -= block[i][k] * x[k];
            }
        }
    }
}

fn rounded<const N: usize>(block: &[[f64; N]; N]) -> [[f32; N]; N] {
    block.map(|row| row.map(|value| value as f32))
}

#[inline(always)]
fn times<const N: usize>(block: &[[f32; N]; N], x: &[f32; N]) -> [f32; N] {
    let mut product = [0.0; N];
    add_product(&mut product, block, x);
    product
}
