//! Sums of element energies, their minimisation by Newton's method, and the sparse linear algebra that it needs.
//!
//! No mechanics enters here: an unknown is a number in a vector, an element is a term of a sum.

mod aggregation;
pub mod assembly;
mod bracing;
mod composed;
mod connectivity;
mod convergence;
pub mod dissection;
mod ending;
mod grouped;
mod iterative;
mod journal;
pub mod krylov;
mod loading;
pub mod newton;
mod nodal;
pub mod path;
mod pattern;
pub mod potential;
pub mod rows;
mod scatter;
mod skew;
pub mod sparse;
pub mod tangent;
pub mod vector;

pub use assembly::Assembly;
pub use composed::{After, DeadForces, Sum};
pub use connectivity::Connectivity;
pub use convergence::{Convergence, NewtonSettings};
pub use iterative::{LinearSolver, WORTH_MULTIGRID};
pub use journal::{Attendance, Journal, Milestone};
pub use loading::{Loading, Stage, State};
pub use newton::Newton;
pub use path::{PathEnd, compliance, equilibrium, follow};
pub use pattern::SymmetricPattern;
pub use potential::{
    Evaluated, Inadmissible, Local, Potential, Remembering, SkewCoupling, Take,
    evaluate_by_elements,
};
pub use rows::SparseRows;
pub use sparse::{Cholesky, FactorFault, SparseLu};
pub use tangent::Tangent;
