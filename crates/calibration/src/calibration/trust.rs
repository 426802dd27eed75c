//! The quality of a fit: intervals, residuals, warnings.

mod judged;
mod quality;
mod uneven_noise;
mod verdict;
mod warnings;

pub use judged::Judged;
pub use quality::{Quality, StableRange};
pub use uneven_noise::noise_warnings;
pub use verdict::{Answer, Verdict};
pub use warnings::{taken_zeros, warnings};
