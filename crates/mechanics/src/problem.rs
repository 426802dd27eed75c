//! The boundary value problem of a sheet, independent of the method of solution: supports, loads, and quantities that follow from equilibrium.

mod balance;
mod boundary;
mod boundary_conditions;
mod constraints;
mod contradictions;
pub mod corner_forces;
mod deformed;
mod groups;
mod influence;
mod laws;
mod loads;
mod model;
mod plate;
mod pressure;
mod reactions;
mod rigid;
mod rigid_motion;
pub mod sampling_point;
pub mod sheet_energy;
mod sheet_forces;
mod singular;
mod solution;
mod ties;
mod unstrained;

pub use balance::{Balance, Resultant};
pub use boundary::BoundaryProblem;
pub use boundary_conditions::{Drive, LONGEST_TURN, Load, Support};
pub use deformed::{DeformedSheet, PointFault, Stress};
pub use groups::mean_displacement;
pub use laws::{CellLaws, LawAndRegions, Region, SheetLaws};
pub use model::{Model, Work};
pub use plate::{ClampedPlate, Measures};
pub use reactions::{GroupState, Reactions};
pub use rigid_motion::RigidMotion;
pub use singular::singular_points;
pub use solution::Solution;

#[cfg(test)]
mod tests;
