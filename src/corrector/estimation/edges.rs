//! How the edges of a specimen move, and the bodies that hold them.

mod bodies;
mod edge_displacements;
mod edge_motion;

pub use bodies::{Body, bodies};
pub use edge_motion::EdgeMotion;
