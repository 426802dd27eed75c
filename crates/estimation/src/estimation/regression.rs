//! Least squares with penalties on roughness, the weights of markers with large residuals, and the rows of the markers.

mod penalised;
mod robust;

pub use penalised::{
    Fit, Form, MarkerRows, NormalEquations, Regression, Roughness, Undetermined,
    VarianceComponents, squares, weighted_square,
};
pub use robust::Robust;
