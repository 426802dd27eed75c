//! Systems with two unknowns per node of a rectangular grid, solved by multigrid.
//!
//! Each node is coupled with its eight neighbours. The nodes with the same X make up a *line*; the first and the last
//! line are fixed, all others are free. Numbers have single precision: multigrid serves as a preconditioner, and the
//! iteration around it removes the rounding.
//!
//! | step | how |
//! |---|---|
//! | smoother | block Gauss–Seidel in four colours, once down and once, in the reverse order, up: symmetric |
//! | where cells are long | lines along their short sides in zebra order: lines along X replace the point smoother, lines along Y are added to it |
//! | restriction | the transpose of the prolongation |
//! | prolongation | linear between the coarser grid's nodes, whatever their number |
//! | coarser operators | discretised on the coarser grid itself, not by products of matrices |
//! | coarsest grid | sparse Cholesky factor |
//!
//! All sums run in an order that does not depend on the number of threads.

mod assembled_line;
mod coarsest;
mod cycle;
mod line;
pub mod stencil;
mod strip;
#[cfg(test)]
mod tests;
pub mod transfer;
mod tridiagonal;
mod vector;

pub use assembled_line::CellStiffness;
pub use cycle::Multigrid;
pub use stencil::Stencil;
pub use strip::is_even;
pub use transfer::Interpolation;
pub use vector::{Lines, Vector};

/// Grids with fewer nodes are done by one thread: handing out work takes longer than the work.
pub const NODES_WORTH_A_THREAD: usize = 4_096;
