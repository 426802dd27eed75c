//! Sparse matrices of small dense blocks, kept row by row.

use rayon::prelude::*;

use crate::solve::grouped::grouped;

/// Rows from which on a product is shared among threads; each row is summed by one of them.
const WORTH_A_THREAD: usize = 8_192;

/// A sparse matrix of R × C blocks; the columns of each row ascend.
#[derive(Clone, Debug, Default)]
pub struct Blocks<const R: usize, const C: usize, T = f64> {
    /// Where each row begins.
    pub starts: Vec<usize>,
    /// The column of each block.
    pub columns: Vec<u32>,
    /// The blocks.
    pub values: Vec<[[T; C]; R]>,
}

impl<const R: usize, const C: usize, T> Blocks<R, C, T> {
    /// Number of rows of blocks.
    pub fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// The blocks of a row with their columns.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, &[[T; C]; R])> {
        let positions = self.starts[row]..self.starts[row + 1];
        let columns = &self.columns[positions.clone()];
        let numbers = columns.iter().map(|column| *column as usize);
        numbers.zip(&self.values[positions])
    }
}

impl<const R: usize, const C: usize> Blocks<R, C> {
    /// The matrix in single precision.
    pub fn rounded(&self) -> Blocks<R, C, f32> {
        Blocks {
            starts: self.starts.clone(),
            columns: self.columns.clone(),
            values: self.values.iter().map(rounded).collect(),
        }
    }

    /// y = A x.
    pub fn multiply(&self, x: &[[f64; C]], y: &mut [[f64; R]]) {
        let product = |(row, y): (usize, &mut [f64; R])| {
            let mut sum = [0.0; R];
            for (column, block) in self.row(row) {
                add_product(&mut sum, block, &x[column]);
            }
            *y = sum;
        };
        if y.len() >= WORTH_A_THREAD && rayon::current_num_threads() > 1 {
            let rows = y.par_iter_mut().enumerate();
            rows.with_min_len(WORTH_A_THREAD / 4).for_each(product);
        } else {
            y.iter_mut().enumerate().for_each(product);
        }
    }

    /// Aᵀ, which has so many rows.
    pub fn transposed(&self, rows: usize) -> Blocks<C, R> {
        let blocks = (0..self.rows()).flat_map(|row| {
            let positions = self.starts[row]..self.starts[row + 1];
            positions.map(move |position| (self.columns[position] as usize, (row as u32, position)))
        });
        let (starts, entries) = grouped(rows, blocks);
        let transposed = |position: usize| -> [[f64; R]; C] {
            let block = &self.values[position];
            std::array::from_fn(|k| std::array::from_fn(|i| block[i][k]))
        };
        Blocks {
            starts,
            columns: entries.iter().map(|(row, _)| *row).collect(),
            values: entries.iter().map(|(_, at)| transposed(*at)).collect(),
        }
    }

    /// A B, where B has so many columns.
    pub fn product<const D: usize>(&self, right: &Blocks<C, D>, columns: usize) -> Blocks<R, D> {
        const NONE: u32 = u32::MAX;
        let mut positions = vec![NONE; columns];
        let mut product = Blocks {
            starts: vec![0],
            ..Blocks::default()
        };
        let mut sums: Vec<(u32, [[f64; D]; R])> = Vec::new();
        for row in 0..self.rows() {
            sums.clear();
            for (middle, left) in self.row(row) {
                for (column, block) in right.row(middle) {
                    if positions[column] == NONE {
                        positions[column] = sums.len() as u32;
                        sums.push((column as u32, [[0.0; D]; R]));
                    }
                    add_matrix_product(&mut sums[positions[column] as usize].1, left, block);
                }
            }
            sums.sort_unstable_by_key(|(column, _)| *column);
            for (column, sum) in &sums {
                positions[*column as usize] = NONE;
                product.columns.push(*column);
                product.values.push(*sum);
            }
            product.starts.push(product.columns.len());
        }
        product
    }
}

/// A block in single precision.
pub fn rounded<const R: usize, const C: usize>(block: &[[f64; C]; R]) -> [[f32; C]; R] {
    block.map(|row| row.map(|value| value as f32))
}

/// y ← y + A x of one block.
#[inline(always)]
pub fn add_product<const R: usize, const C: usize, T>(y: &mut [T; R], a: &[[T; C]; R], x: &[T; C])
where
    T: Copy + std::ops::Mul<Output = T> + std::ops::AddAssign,
{
    for i in 0..R {
        for k in 0..C {
            y[i] += a[i][k] * x[k];
        }
    }
}

/// S ← S + A B of single blocks.
#[inline(always)]
pub fn add_matrix_product<const R: usize, const C: usize, const D: usize>(
    sum: &mut [[f64; D]; R],
    a: &[[f64; C]; R],
    b: &[[f64; D]; C],
) {
    for i in 0..R {
        for j in 0..C {
            for k in 0..D {
                sum[i][k] += a[i][j] * b[j][k];
            }
        }
    }
}
