//! Cases that reproduce the claims of the publication and check gelbench against other codes and against mathematics.
//!
//! A case is a study file with a kind of its own (see [`crate::kinds`]): `gelbench run` computes one, `gelbench validate` all.

mod case;
pub(crate) mod correction_matrix;
pub(crate) mod cost;
pub(crate) mod finite_elements;
pub(crate) mod fit_coverage;
pub(crate) mod flagship;
pub(crate) mod interval_coverage;
pub(crate) mod motion_correction;
pub(crate) mod nonlinear_spring;
mod oscillator;
pub(crate) mod other_codes;
mod plate;
pub(crate) mod plate_ablation;
pub(crate) mod real_measurements;
pub mod report;
pub(crate) mod smoothing;
pub(crate) mod spring_identification;
pub(crate) mod vibrating_plate;
pub(crate) mod vibrating_spring;

/// The case with fields measured by other people.
pub const REAL_MEASUREMENTS: &str = "real-measurements";
