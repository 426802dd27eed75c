//! Uncertainties of an estimated field besides noise: its mesh, the scale of the picture, the law's parameters, edges that were
//! not seen, smoothness.

mod considered;
mod granted;
mod moved_edges;
mod picture_scale;
mod refined_mesh;
mod smoothing_bias;
mod unknown_edges;

pub use granted::Granted;
pub use moved_edges::MovedEdge;
pub use picture_scale::ScaleChange;
pub use refined_mesh::{MOST_REFINED_CELLS, MeshDifference};
