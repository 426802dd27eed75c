//! The correction matrix of a small linear system, as defined in the publication.

use nalgebra::DMatrix;

use super::factor::weighted_qr;
use crate::solve::{FactorFault, SparseRows};

/// ψ, S and Y of linear conditions B u = b with i unknowns, dense.
///
/// ```text
/// S = (B W⁻¹ Bᵀ)⁻¹,   Y = I − W⁻¹ Bᵀ S B,   u = Y ū + W⁻¹ Bᵀ S b,   ψ = S (B ū − b)
/// ```
///
/// Y² = Y, B Y = 0, and for W = I also Y = Yᵀ. The rank of Y is i less the number of rows: when B is square Y is
/// zero, and the data have no influence.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrectionMatrix {
    weights: Vec<f64>,
    /// Orthonormal columns that span the rows of B W^(−½): n × m.
    q: DMatrix<f64>,
    /// W^(−½) Bᵀ = Q R: m × m.
    r: DMatrix<f64>,
}

impl CorrectionMatrix {
    /// The correction matrix of the conditions `rows` with the diagonal of W.
    ///
    /// # Errors
    /// [`FactorFault`] when rows depend on each other.
    pub fn new(rows: &SparseRows, weights: Vec<f64>) -> Result<Self, FactorFault> {
        let (q, r) = weighted_qr(rows, &weights)?;
        Ok(Self { weights, q, r })
    }

    /// Y, i × i.
    pub fn y(&self) -> DMatrix<f64> {
        let size = self.weights.len();
        let projector = &self.q * self.q.transpose();
        DMatrix::from_fn(size, size, |i, j| {
            let identity = if i == j { 1.0 } else { 0.0 };
            identity - projector[(i, j)] * (self.weights[j] / self.weights[i]).sqrt()
        })
    }

    /// S, one row and column for each row of B.
    pub fn s(&self) -> DMatrix<f64> {
        let rows = self.r.nrows();
        let inverse = self
            .r
            .solve_upper_triangular(&DMatrix::identity(rows, rows))
            .expect("independent rows");
        &inverse * inverse.transpose()
    }
}
