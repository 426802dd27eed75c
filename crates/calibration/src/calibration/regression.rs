//! The parameters with the smallest sum of squares: residuals, weights, starts, and zeros that are found with the law.

mod misfit;
pub mod refined_zero;
mod reweighed;
mod search;

pub use misfit::{Misfit, Rows, Zero};
pub use refined_zero::MovedZero;
pub use reweighed::{Reweighed, settled};
pub use search::{Rival, Search, check_minimum, ordered};
