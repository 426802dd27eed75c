//! Sparse matrices of any shape, stored by rows.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::pattern::SymmetricPattern;

/// A sparse matrix by rows, of any shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SparseRows {
    columns: usize,
    rows: Vec<Vec<(usize, f64)>>,
}

impl SparseRows {
    /// A matrix without rows that multiplies vectors of length `columns`.
    pub fn new(columns: usize) -> Self {
        Self {
            columns,
            rows: Vec::new(),
        }
    }

    /// Appends a row of (column, value); entries of the same column are added up.
    pub fn push(&mut self, row: impl IntoIterator<Item = (usize, f64)>) {
        let mut merged = BTreeMap::new();
        for (column, value) in row {
            *merged.entry(column).or_insert(0.0) += value;
        }
        self.rows.push(merged.into_iter().collect());
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The entries of one row: (column, value), columns ascending.
    pub fn row(&self, row: usize) -> &[(usize, f64)] {
        &self.rows[row]
    }

    /// D B with the diagonal D given by `scales`, one number a row.
    pub fn scaled(&self, scales: &[f64]) -> Self {
        let rows = self.rows.iter().zip(scales);
        let scale = |(row, scale): (&Vec<(usize, f64)>, &f64)| {
            row.iter()
                .map(|(column, value)| (*column, value * scale))
                .collect()
        };
        Self {
            columns: self.columns,
            rows: rows.map(scale).collect(),
        }
    }

    /// Appends all rows of another matrix with the same number of columns.
    pub fn append(&mut self, other: Self) {
        self.rows.extend(other.rows);
    }

    /// The dense matrix.
    pub fn to_dense(&self) -> DMatrix<f64> {
        let mut dense = DMatrix::zeros(self.rows.len(), self.columns);
        for (index, row) in self.rows.iter().enumerate() {
            for (column, value) in row {
                dense[(index, *column)] = *value;
            }
        }
        dense
    }

    /// B x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let product =
            |row: &Vec<(usize, f64)>| row.iter().map(|(column, value)| value * x[*column]).sum();
        self.rows.iter().map(product).collect()
    }

    /// Bᵀ y.
    pub fn multiply_transposed(&self, y: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.columns];
        for (row, y) in self.rows.iter().zip(y) {
            for (column, value) in row {
                product[*column] += value * y;
            }
        }
        product
    }

    /// B W⁻¹ Bᵀ as a symmetric sparse matrix, with the diagonal W given by `weights`.
    pub fn normal_matrix(&self, weights: &[f64]) -> (SymmetricPattern, Vec<f64>) {
        let mut by_column = vec![Vec::new(); self.columns];
        for (index, row) in self.rows.iter().enumerate() {
            for (column, value) in row {
                by_column[*column].push((index, *value));
            }
        }
        let products: Vec<BTreeMap<usize, f64>> = self
            .rows
            .iter()
            .enumerate()
            .map(|(index, row)| {
                let mut sums = BTreeMap::from([(index, 0.0)]);
                for (column, value) in row {
                    for (other, other_value) in &by_column[*column] {
                        if *other >= index {
                            *sums.entry(*other).or_insert(0.0) +=
                                value * other_value / weights[*column];
                        }
                    }
                }
                sums
            })
            .collect();
        let pattern =
            SymmetricPattern::new(products.iter().map(|sums| sums.keys().copied().collect()));
        (
            pattern,
            products
                .into_iter()
                .flat_map(BTreeMap::into_values)
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_matrix_is_b_w_inverse_b_transposed() {
        let mut b = SparseRows::new(4);
        b.push([(0, 1.0), (2, -2.0)]);
        b.push([(2, 3.0), (1, 1.0), (2, 1.0)]);
        b.push([(3, 5.0)]);
        let (pattern, values) = b.normal_matrix(&[1.0, 2.0, 4.0, 1.0]);
        let entry = |row, column| {
            pattern
                .position(row, column)
                .map(|position| values[position])
        };
        assert_eq!(entry(0, 0), Some(2.0));
        assert_eq!(entry(0, 1), Some(-2.0));
        assert_eq!(entry(1, 1), Some(4.5));
        assert_eq!(entry(2, 2), Some(25.0));
        assert_eq!(entry(0, 2), None);
    }
}
