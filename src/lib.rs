//! Soft-tissue and hydrogel workbench: mass-spring plates corrected to the accuracy of hyperelastic
//! finite elements.
#![warn(missing_docs)]

pub mod boundary;
pub mod calibration;
pub mod command;
pub mod compare;
pub mod corrector;
pub mod document;
pub mod dynamics;
pub mod error;
pub mod finite_element;
pub mod identification;
pub mod mass_spring;
pub mod material;
pub mod measured_field;
pub mod measurement;
pub mod mesh;
pub mod multigrid;
pub mod output;
pub mod problem;
pub mod results;
pub mod run;
pub mod sheet_energy;
pub mod solve;
pub mod study;
pub mod units;
pub mod validation;
