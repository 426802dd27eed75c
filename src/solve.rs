//! Sums of element energies, their minimum by Newton's method, and the sparse linear algebra below.
//!
//! Nothing here knows any mechanics: an unknown is a number in a vector, an element is a term of a sum.

pub mod dissection;
mod ending;
pub mod newton;
pub mod path;
pub mod potential;
pub mod rows;
pub mod sparse;

pub use newton::{Convergence, Newton, NewtonSettings};
pub use path::{Loading, PathEnd, State, compliance, follow, influence};
pub use potential::{Assembly, Inadmissible, Local, Potential, SkewCoupling};
pub use rows::SparseRows;
pub use sparse::{Cholesky, NotPositiveDefinite, SparseLu, SymmetricPattern};
