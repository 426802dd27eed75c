//! Results as data, their comparison, and their encodings: reports, pictures, VTK, and the input of other codes.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod compare;
pub mod output;
pub mod results;

use gelbench_base::{document, error, statistics, units};
use gelbench_calibration::{calibration, identification};
use gelbench_mechanics::{dynamics, finite_element, markers, mass_spring, material, mesh, problem};
