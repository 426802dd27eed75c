//! The normal equations of a weighted regression with many rows.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// AᵀWA and AᵀWr of a diagonal W, block by block on all threads: no second matrix of all rows is made.
pub fn normal_equations(
    design: &DMatrix<f64>,
    residual: &DVector<f64>,
    weight: impl Fn(usize) -> f64 + Sync,
) -> (DMatrix<f64>, DVector<f64>) {
    const BLOCK: usize = 16_384;
    let (rows, columns) = design.shape();
    let starts: Vec<usize> = (0..rows).step_by(BLOCK).collect();
    let of_block = |first: &usize| {
        let count = BLOCK.min(rows - first);
        let block = design.rows(*first, count);
        let mut weighted = block.transpose();
        for (mut column, row) in weighted.column_iter_mut().zip(*first..) {
            column *= weight(row);
        }
        (&weighted * block, weighted * residual.rows(*first, count))
    };
    let blocks: Vec<_> = starts.par_iter().map(of_block).collect();
    let zero = (DMatrix::zeros(columns, columns), DVector::zeros(columns));
    blocks
        .into_iter()
        .fold(zero, |sum, block| (sum.0 + block.0, sum.1 + block.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_sum_up_to_the_product_of_all_rows() {
        let rows = 40_000;
        let design = DMatrix::from_fn(rows, 3, |row, column| (row * (column + 1)) as f64 % 7.0);
        let residual = DVector::from_fn(rows, |row, _| row as f64 % 5.0);
        let weight = |row: usize| 1.0 + row as f64 % 3.0;
        let weighted = DMatrix::from_fn(rows, 3, |row, column| weight(row) * design[(row, column)]);
        let (normal, right) = normal_equations(&design, &residual, weight);
        // Sums of integers are exact.
        assert_eq!(normal, weighted.transpose() * &design);
        assert_eq!(right, weighted.transpose() * residual);
    }
}
