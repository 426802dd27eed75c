//! The input of an estimate: the specimen and its outline, the markers on it, prior knowledge, and the start.

mod knowledge;
mod observations;
mod outline;
mod regressed_law;
mod start;
mod task;

pub use knowledge::{
    EdgeCondition, FORCE_CLASS, Knowledge, MeasuredForce, Physics, Specimen, Unnamed,
};
pub use observations::Observations;
pub use outline::{Segment, name_parts};
pub use regressed_law::{Neighbours, RegressedLaw, UncertainLaw};
pub use start::{DEGREE, Polynomial};
pub use task::{Edge, Task, observe, singular_corners};

#[cfg(test)]
pub use outline::segments;
