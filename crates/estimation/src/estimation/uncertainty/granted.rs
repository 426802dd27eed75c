//! Small changes of a field that are no evidence against its equations, because what is known admits them.

use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::estimation::regression::{Fit, VarianceComponents};
use crate::estimation::search::{MESH_ERROR_FACTOR, NearestField};

/// A change that is no alternative to the equations, because it is known to be possible.
pub struct Granted {
    /// The displacements of the markers due to its parameters: two rows per marker.
    pub design: DMatrix<f64>,
    /// The standard deviation of its parameters; `None` where they may have any value.
    pub deviation: Option<f64>,
}

impl NearestField<'_> {
    /// The admitted changes: a picture of another scale, the discretisation error at the markers, and free edges up to the gap away from those of
    /// the mesh.
    ///
    /// # Errors
    /// Where the tangent cannot be used to solve systems.
    pub fn granted(&mut self, mesh_error: Option<&[f64]>) -> Result<Vec<Granted>, Error> {
        let knowledge = self.equations.task.knowledge;
        let stated = knowledge.scale_deviation > 0.0;
        let scale = stated.then(|| Granted {
            design: self.magnification(),
            deviation: None,
        });
        let mut all: Vec<Granted> = scale.into_iter().collect();
        all.extend(mesh_error.map(|error| Granted {
            design: DMatrix::from_column_slice(error.len(), 1, error),
            deviation: Some(MESH_ERROR_FACTOR),
        }));
        let (strips, squares) = self.edge_strips();
        if !strips.is_empty() {
            let independent = squares.cholesky().map(|factor| factor.l());
            let strips: Vec<_> = strips.into_iter().map(|(_, strip)| strip).collect();
            let designs = self.marker_changes(&strips)?;
            all.extend(independent.map(|factor| Granted {
                design: designs * factor,
                deviation: Some(1.0),
            }));
        }
        Ok(all)
    }

    /// The part of the misfit Σ w ω r² of a regression that granted changes E of known deviation d explain in addition to its parameters:
    ///
    /// ```text
    /// bᵀH⁻¹b,   b = EᵀWr,   H = EᵀWE − TᵀCT/v + v/d²,   T = AᵀWE                         C, A: covariance and design
    /// ```
    pub fn granted_misfit(
        &self,
        granted: &[Granted],
        (fit, design): (&Fit, &DMatrix<f64>),
        variances: &VarianceComponents,
    ) -> f64 {
        let known = granted.iter().filter_map(|change| {
            let deviation = change.deviation?;
            Some((change, variances.variance / deviation.powi(2)))
        });
        let columns = known.flat_map(|(change, prior)| {
            let columns = change.design.column_iter();
            columns.map(move |column| (column, prior))
        });
        let (columns, priors): (Vec<_>, Vec<f64>) = columns.unzip();
        if columns.is_empty() {
            return 0.0;
        }
        let changes = DMatrix::from_columns(&columns);
        let mut weighted = changes.clone();
        for (row, mut entries) in weighted.row_iter_mut().enumerate() {
            entries *= variances.weight(&self.observations().weights, row);
        }
        let targets = design.tr_mul(&weighted);
        let fitted = targets.tr_mul(&(&fit.covariance * &targets)) / variances.variance;
        let priors = DMatrix::from_diagonal(&DVector::from_vec(priors));
        let slope = weighted.tr_mul(&fit.residual);
        let curvature = weighted.tr_mul(&changes) - fitted + priors;
        let factor = curvature.cholesky();
        factor.map_or(0.0, |factor| slope.dot(&factor.solve(&slope)))
    }
}
