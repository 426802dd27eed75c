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

/// Asserts that a number differs from an expected one by less than a share of it.
#[cfg(test)]
#[track_caller]
fn assert_near(computed: f64, expected: f64, share: f64, context: &dyn std::fmt::Debug) {
    assert!(
        (computed / expected - 1.0).abs() < share,
        "{context:?}: {computed} instead of {expected}"
    );
}
