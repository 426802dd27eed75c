//! The derivatives of the markers over their noise, and their products with the noise that was found.

use nalgebra::DMatrix;

use super::penalised::VarianceComponents;
use crate::statistics::{CorrelatedNoise, Sites, Whitening};

/// The derivatives of the markers, two rows each, with their weights.
pub struct MarkerRows<'a> {
    pub design: &'a DMatrix<f64>,
    pub weights: &'a [f64],
    pub variances: &'a VarianceComponents,
}

impl MarkerRows<'_> {
    /// ÃᵀÃ, Ã = √(W/v) A.
    pub fn information(&self) -> DMatrix<f64> {
        let scaled = self.scaled();
        scaled.tr_mul(&scaled)
    }

    /// τ² ÃᵀRÃ.
    pub fn spread(&self, noise: &CorrelatedNoise, sites: &Sites) -> DMatrix<f64> {
        let whitening = Whitening::new(sites, &noise.correlation);
        let scaled = self.scaled();
        let columns = scaled.column_iter();
        let root = columns.flat_map(|column| whitening.apply_inverse_transposed(column.as_slice()));
        let root = DMatrix::from_iterator(scaled.nrows(), scaled.ncols(), root);
        root.tr_mul(&root) * noise.variance
    }

    /// Ã.
    fn scaled(&self) -> DMatrix<f64> {
        let scale = |row: usize| {
            let weight = self.variances.weight(self.weights, row);
            (weight / self.variances.variance).sqrt()
        };
        DMatrix::from_fn(self.design.nrows(), self.design.ncols(), |row, column| {
            scale(row) * self.design[(row, column)]
        })
    }
}
