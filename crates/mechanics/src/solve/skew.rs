//! The part of a tangent that is not symmetric: it couples a few unknowns, such as those where a pressure ends.
//!
//! ```text
//! K + S = K' + U D Uᵀ,   K' = K + σ U Uᵀ,   D = C − σ 1
//! (K + S)⁻¹ b = x − K'⁻¹ U y,   x = K'⁻¹ b,   (1 + D G) y = D Uᵀ x,   G = Uᵀ K'⁻¹ U
//! det (K + S) = det K' · det (1 + D G)
//! ```
//!
//! U contains the unit vectors of the coupled unknowns, and of some around them, and S = U C Uᵀ. The body is braced
//! by σ where K itself is not positive definite, which does not mean that a body whose loads have no potential is
//! unstable. Stability is lost, without oscillation, where det (K + S) vanishes.
//!
//! # References
//! V. V. Bolotin, Nonconservative Problems of the Theory of Elastic Stability, Pergamon (1963)

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::potential::SkewCoupling;

/// S, and the bracing of K.
#[derive(Clone, Default)]
pub struct SkewPart {
    /// The unknowns of U.
    coupled: Vec<usize>,
    /// C.
    couplings: DMatrix<f64>,
    /// σ.
    pub brace: f64,
    /// K'⁻¹ U with the present factor; empty where it is not known.
    pub columns: Vec<Vec<f64>>,
}

impl SkewPart {
    /// The skew part from couplings between free unknowns, given by their positions.
    pub fn new(all: &[SkewCoupling]) -> Self {
        let ends = all
            .iter()
            .flat_map(|coupling| [coupling.row, coupling.column]);
        let coupled: Vec<usize> = ends.collect::<BTreeSet<_>>().into_iter().collect();
        let mut couplings = DMatrix::zeros(coupled.len(), coupled.len());
        for coupling in all {
            let position = |unknown| coupled.binary_search(&unknown).expect("coupled");
            let (row, column) = (position(coupling.row), position(coupling.column));
            couplings[(row, column)] += coupling.stiffness;
            couplings[(column, row)] -= coupling.stiffness;
        }
        Self {
            coupled,
            couplings,
            ..Self::default()
        }
    }

    /// Changes it to that of the transposed tangent.
    pub fn transpose(&mut self) {
        self.couplings.transpose_mut();
    }

    /// Adds unknowns to U.
    pub fn widen(&mut self, around: &[usize]) {
        let more: Vec<usize> = around
            .iter()
            .copied()
            .filter(|unknown| !self.coupled.contains(unknown))
            .collect();
        let count = self.coupled.len() + more.len();
        self.coupled.extend(more);
        self.couplings.resize_mut(count, count, 0.0);
    }

    /// Whether the tangent is symmetric.
    pub fn is_none(&self) -> bool {
        self.coupled.is_empty()
    }

    /// The unknowns of U.
    pub fn coupled(&self) -> &[usize] {
        &self.coupled
    }

    /// D.
    fn remainder(&self) -> DMatrix<f64> {
        let mut remainder = self.couplings.clone();
        (0..self.coupled.len()).for_each(|i| remainder[(i, i)] -= self.brace);
        remainder
    }

    /// 1 + D G.
    fn system(&self) -> DMatrix<f64> {
        let count = self.coupled.len();
        let flexibility = DMatrix::from_fn(count, count, |i, k| self.columns[k][self.coupled[i]]);
        DMatrix::identity(count, count) + self.remainder() * flexibility
    }

    /// Whether det (K + S) is positive, as it is at rest and until stability is lost; the columns must be known.
    pub fn keeps_stability(&self) -> bool {
        self.system().determinant() > 0.0
    }

    /// (K + S)⁻¹ b from K'⁻¹ b; the columns must be known; `None` where there is no inverse.
    pub fn complete(&self, mut x: Vec<f64>) -> Option<Vec<f64>> {
        let there = self.coupled.iter().map(|unknown| x[*unknown]);
        let there = DVector::from_iterator(self.coupled.len(), there);
        let parts = self.system().lu().solve(&(self.remainder() * there))?;
        for (part, column) in parts.iter().zip(&self.columns) {
            for (x, column) in x.iter_mut().zip(column) {
                *x -= part * column;
            }
        }
        Some(x)
    }
}
