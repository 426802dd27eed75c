//! The corrective technique: any field is brought to the nearest one that satisfies equilibrium and what is known at the boundary.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod corrector;
pub mod multigrid;

#[cfg(test)]
use gelbench_base::budget;
use gelbench_base::{error, statistics};
#[cfg(test)]
use gelbench_mechanics::finite_element;
use gelbench_mechanics::{dynamics, mass_spring, material, mesh, problem, solve};
