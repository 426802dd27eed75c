//! Combinations of parameters, and how well the data determine them.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The relative standard error from which on a combination of parameters counts as not determined: two standard errors are then its own size.
pub const VAGUE: f64 = 0.5;

/// Relative standard error up to which a combination takes part in the first search.
pub const LOOSE: f64 = 3.0;

/// A combination of parameters that the data determine independently of the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The share of every parameter, relative to the larger of its value and its first value: a unit vector whose largest entry is positive.
    pub weights: Vec<f64>,
    /// The standard error of the combination by white noise, relative to the parameters: 1/√eigenvalue.
    pub relative_error: f64,
}

impl Direction {
    /// Whether the data determine it.
    pub fn is_determined(&self) -> bool {
        self.relative_error < VAGUE
    }
}

/// The eigenvectors of the information, with every parameter relative to its scale; the best determined first.
pub fn directions(information: &DMatrix<f64>, scales: &[f64]) -> Vec<Direction> {
    let scaled = DMatrix::from_fn(scales.len(), scales.len(), |i, j| {
        scales[i] * information[(i, j)] * scales[j]
    });
    let SymmetricEigen {
        eigenvalues,
        eigenvectors,
    } = SymmetricEigen::new((&scaled + scaled.transpose()) * 0.5);
    let direction = |(index, eigenvalue): (usize, &f64)| {
        let column = eigenvectors.column(index);
        let sign = column[column.iamax()].signum();
        Direction {
            weights: column.iter().map(|weight| sign * weight).collect(),
            relative_error: eigenvalue.max(0.0).sqrt().recip(),
        }
    };
    let mut all: Vec<Direction> = eigenvalues.iter().enumerate().map(direction).collect();
    all.sort_by(|a, b| a.relative_error.total_cmp(&b.relative_error));
    all
}

/// The inverse of the information over combinations whose relative standard error is below a limit, in the parameters' own units.
pub fn inverse(directions: &[Direction], scales: &[f64], limit: f64) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(scales.len(), scales.len());
    for direction in directions.iter().filter(|one| one.relative_error < limit) {
        let weights = direction.weights.iter().zip(scales);
        let column = DVector::from_iterator(scales.len(), weights.map(|(w, s)| w * s));
        sum += &column * column.transpose() * direction.relative_error.powi(2);
    }
    sum
}
