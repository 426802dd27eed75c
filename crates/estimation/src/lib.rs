//! The equilibrium field nearest to measured markers, with a verdict and intervals.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod estimation;

use gelbench_base::{document, error, statistics, units};
use gelbench_mechanics::{finite_element, markers, material, mesh, problem, solve};
