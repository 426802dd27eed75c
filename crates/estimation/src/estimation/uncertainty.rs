//! Uncertainties of an estimated field besides noise: its mesh, the scale of the picture, the law's parameters, edges that were
//! not seen, smoothness.

mod considered;
mod mesh_error;
mod moved_edges;
mod picture_scale;
mod smoothing_bias;
mod unknown_places;

pub use mesh_error::{MESH_ERRORS, MOST_REFINED_CELLS, MeshDifference, MeshError};
pub use moved_edges::MovedEdge;
pub use picture_scale::ScaleChange;
