//! Laws from tests, and springs and dashpots from recordings.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

#[cfg(test)]
mod assertions;
pub mod calibration;
pub mod identification;

use gelbench_base::{document, error, statistics, units};
use gelbench_estimation::estimation;
use gelbench_mechanics::{material, mesh, problem, solve};
