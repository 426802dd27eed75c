//! The motion of a specimen's edges, and the bodies that hold them.

mod bodies;
mod edge_displacements;
mod edge_motion;

pub use bodies::{Body, bodies};
pub use edge_motion::EdgeMotion;
