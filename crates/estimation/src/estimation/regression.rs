//! Least squares with penalties on roughness, the weights of markers with large residuals, and the rows of the markers.

mod marker_rows;
mod penalised;
mod robust;

pub use marker_rows::MarkerRows;
pub use penalised::{
    Fit, Form, NormalEquations, Regression, Roughness, Undetermined, VarianceComponents, squares,
    weighted_square,
};
pub use robust::Robust;
