//! The mesh's own error in an estimated field ([`super::uncertainty`] computes it on cells half as large).

use nalgebra::DVector;

/// The mesh's own error is at most about so many times the difference that cells half as large make.
pub const MESH_ERROR_FACTOR: f64 = 2.0;

/// The mesh's own error.
#[derive(Clone, Debug)]
pub struct MeshError {
    /// e of node after node in mm.
    pub displacement: Vec<f64>,
    /// δp.
    pub parameters: DVector<f64>,
    /// H e, two numbers per marker.
    pub markers: Vec<f64>,
    /// G₁₁, G₁₂, G₂₁, G₂₂ of cell after cell.
    pub gradients: Vec<[f64; 4]>,
    /// The error of the force of each body in N, in the order of the bodies.
    pub forces: Vec<[f64; 2]>,
}
