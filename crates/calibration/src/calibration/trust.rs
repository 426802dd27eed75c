//! The quality of a fit: intervals, residuals, warnings.

mod assessment;
mod judged;
mod quality;
mod uneven_noise;
mod verdict;
mod warnings;

pub use assessment::Assessment;
pub use judged::{AT_BOUND, Judged, Values, at_bound};
pub use quality::{Deviations, Quality, StableRange, rounded};
pub use uneven_noise::noise_warnings;
pub use verdict::{Answer, Verdict};
pub use warnings::{taken_zeros, warnings};
