//! Soft-tissue and hydrogel workbench: mass-spring plates corrected to the accuracy of hyperelastic
//! finite elements.
#![warn(missing_docs)]

pub mod calibration;
pub mod command;
pub mod compare;
pub mod corrector;
pub mod document;
pub mod dynamics;
pub mod error;
pub mod finite_element;
pub mod identification;
pub mod markers;
pub mod mass_spring;
pub mod material;
pub mod mesh;
pub mod multigrid;
pub mod output;
pub mod problem;
pub mod results;
pub mod solve;
pub mod studies;
pub mod units;
pub mod validation;
