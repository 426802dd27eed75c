#![doc = include_str!("../README.md")]
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod validation;

use gelbench_base::{budget, document, error, statistics, units};
use gelbench_calibration::{calibration, identification};
use gelbench_corrector::corrector;
use gelbench_estimation::estimation;
use gelbench_mechanics::{
    dynamics, finite_element, markers, mass_spring, material, mesh, problem, solve,
};
use gelbench_report::{compare, results};
use gelbench_studies::studies;
