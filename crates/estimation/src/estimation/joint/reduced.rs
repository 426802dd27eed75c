//! The normal equations of a frame without its edges.

use std::ops::Range;

use nalgebra::DMatrix;

use super::estimate::Step;
use crate::error::{Error, SolveFault};
use crate::estimation::equations::solve;
use crate::estimation::regression::NormalEquations;
use crate::statistics::inverse;

/// The normal equations of the law's parameters, the edges following.
pub struct Reduced {
    /// Sₖ.
    pub information: DMatrix<f64>,
    /// tₖ.
    pub score: Step,
    /// Qₖ.
    pub misfit: f64,
    /// (F − f)²/(σ² + s²): s is the deviation of the field's force due to noise.
    pub force_misfit: f64,
    /// [−M_θp M_pp⁻¹, 1], with the columns in the order of all parameters.
    pub projection: DMatrix<f64>,
}

impl Reduced {
    /// # Errors
    /// [`Error::Solve`] where the data do not determine how the edges moved.
    pub fn new(equations: &NormalEquations, law: Range<usize>) -> Result<Self, Error> {
        /// The least pivot of the edges' part of a matrix scaled to a unit diagonal.
        const LEAST_PIVOT: f64 = 1e-8;
        let NormalEquations { matrix, target, .. } = equations;
        let edges: Vec<usize> = (0..matrix.nrows())
            .filter(|row| !law.contains(row))
            .collect();
        let law: Vec<usize> = law.collect();
        let part = matrix.select_rows(&edges).select_columns(&edges);
        let covariance = if edges.is_empty() {
            part
        } else {
            inverse(&part, LEAST_PIVOT).ok_or_else(|| solve(SolveFault::Singular))?
        };
        let follow = matrix.select_rows(&law).select_columns(&edges) * &covariance;
        let mut projection = DMatrix::zeros(law.len(), matrix.nrows());
        for (row, column) in law.iter().enumerate() {
            projection[(row, *column)] = 1.0;
        }
        for (column, followed) in edges.iter().zip(follow.column_iter()) {
            projection.set_column(*column, &-followed);
        }
        let of_edges = target.select_rows(&edges);
        let force_misfit = equations.force_misfit - of_edges.dot(&(covariance * &of_edges));
        Ok(Self {
            information: &projection * matrix.select_columns(&law),
            score: &projection * target,
            misfit: equations.misfit + force_misfit,
            force_misfit,
            projection,
        })
    }

    /// T V Tᵀ with the projection T.
    pub fn project(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        &self.projection * matrix * self.projection.transpose()
    }
}
