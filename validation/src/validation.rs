//! Cases that reproduce the claims of the publication and check gelbench against other codes and against mathematics.
//!
//! A case is a study file with a kind of its own (`gelbench::kinds`): `gelbench run` computes one, `gelbench validate` all.

mod case;
pub mod correction_matrix;
pub mod cost;
pub mod finite_elements;
pub mod fit_coverage;
pub mod flagship;
pub mod interval_coverage;
pub mod motion_correction;
pub mod nonlinear_spring;
mod oscillator;
pub mod other_codes;
mod plate;
pub mod plate_ablation;
pub mod real_measurements;
pub mod report;
pub mod smoothing;
pub mod spring_identification;
pub mod vibrating_plate;
pub mod vibrating_spring;

/// The case with fields measured by other people.
pub const REAL_MEASUREMENTS: &str = "real-measurements";
