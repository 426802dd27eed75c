//! Sheets of hyperelastic material: materials, meshes, boundary-value problems, springs, finite elements and motion.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod dynamics;
pub mod finite_element;
pub mod markers;
pub mod mass_spring;
pub mod material;
pub mod mesh;
pub mod problem;
pub mod solve;

#[cfg(test)]
use gelbench_base::budget;
use gelbench_base::{document, error, statistics, units};
