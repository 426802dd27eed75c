//! The derivatives of the markers' displacements over their noise, and the covariance of their products with correlated noise.

use nalgebra::{DMatrix, DVector};

use super::penalised::VarianceComponents;
use crate::statistics::{CorrelatedNoise, Sites, Whitening, normal_equations};

/// The derivatives of the markers, two rows each, with their weights.
pub struct MarkerRows<'a> {
    pub design: &'a DMatrix<f64>,
    pub weights: &'a [f64],
    pub variances: &'a VarianceComponents,
}

impl MarkerRows<'_> {
    /// ÃᵀÃ, Ã = √(W/v) A.
    pub fn information(&self) -> DMatrix<f64> {
        let none = DVector::zeros(self.design.nrows());
        normal_equations(self.design, &none, |row| self.weight(row)).0
    }

    fn weight(&self, row: usize) -> f64 {
        self.variances.weight(self.weights, row) / self.variances.variance
    }

    /// τ² ÃᵀRÃ.
    pub fn spread(&self, noise: &CorrelatedNoise, sites: &Sites) -> DMatrix<f64> {
        let whitening = Whitening::new(sites, &noise.correlation);
        let scaled = self.scaled();
        let columns = scaled.column_iter();
        let entries =
            columns.flat_map(|column| whitening.apply_inverse_transposed(column.as_slice()));
        let root = DMatrix::from_iterator(scaled.nrows(), scaled.ncols(), entries);
        root.tr_mul(&root) * noise.variance
    }

    /// Ã.
    fn scaled(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.design.nrows(), self.design.ncols(), |row, column| {
            self.weight(row).sqrt() * self.design[(row, column)]
        })
    }
}
