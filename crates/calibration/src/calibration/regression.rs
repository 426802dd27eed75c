//! The parameters with the smallest sum of squares: models of tests, residuals, weights and starts.

mod elastic;
mod linear;
mod misfit;
mod search;
mod zero;

pub use elastic::Elastic;
pub use misfit::{Estimated, Misfit, Response, Row, Rows};
pub use search::{Rival, Search, holds, improved, ordered};
pub use zero::{MovedZero, Zero};
