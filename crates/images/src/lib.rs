//! Displacements from camera images: reading, noise, and tracking of a pattern with standard deviations.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod images;

use gelbench_base::error;
use gelbench_mechanics::markers;
