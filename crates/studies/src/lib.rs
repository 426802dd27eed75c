//! What a study file asks for: read, solved, compared and reported.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod studies;

use gelbench_base::{budget, document, error, statistics, units};
use gelbench_corrector::corrector;
use gelbench_estimation::estimation;
use gelbench_images::images;
use gelbench_mechanics::{
    dynamics, finite_element, markers, mass_spring, material, mesh, problem, solve,
};
use gelbench_report::{compare, results};
