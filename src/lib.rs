//! A workbench for sheets of soft tissue and hydrogel at large strains.
//!
//! gelbench solves one problem in three ways: with a lattice of springs, with hyperelastic finite elements, and with
//! the *corrector*, which takes any displacement field and finds the nearest one that satisfies equilibrium and what is
//! known at the boundary. The given field may come from springs, from another program, or from a camera.
//!
//! # Ten lines
//!
//! A clamped plate of 10 % PVA hydrogel, 150 × 50 × 2 mm, stretched by a half; corrected on 60 × 20 cells:
//!
//! ```
//! use std::path::Path;
//! use gelbench::corrector::{DifferenceScheme, climb::{Climb, ClimbSettings}};
//! use gelbench::{material::Card, problem::ClampedPlate};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let law = Card::load("pva-10", Path::new("."))?.law;
//! let plate = ClampedPlate { size: [150.0, 50.0], thickness: 2.0, law, stretches: vec![0.5] };
//! let scheme = DifferenceScheme::default();
//! let mut climb = Climb::even(&plate, [60, 20], scheme, ClimbSettings::default());
//! let corrected = climb.correct(0.5)?;
//! let sheet = climb.deformed(&corrected);
//! let [ux, uy] = sheet.displacement_at([75.0, 50.0])?;
//! let stress = sheet.stress_at([75.0, 25.0])?.cauchy[0];
//! println!("{:.3} N, edge at ({ux:.3}, {uy:.3}) mm, {stress:.5} MPa", corrected.force);
//! # assert!((corrected.force - 12.87459).abs() < 0.01, "{}", corrected.force);
//! # assert!((ux - 37.5).abs() < 1e-3 && (uy + 4.6405).abs() < 1e-3, "{ux} {uy}");
//! # assert!((stress - 0.1946).abs() < 1e-4, "{stress}");
//! # Ok(())
//! # }
//! ```
//!
//! Lengths are in mm, forces in N, stresses in MPa, times in s and masses in tonnes, everywhere. Points are given by
//! their coordinates at rest.
//!
//! The [guide] continues from here, page by page. The programs in `examples/` do the same in files of their own.
//!
//! # What to use for what
//!
//! Dependencies go one way: each module uses only modules above it in this table.
//!
//! | to … | use |
//! |---|---|
//! | convert quantities with units; understand an error; estimate with intervals | [`units`], [`error`], [`statistics`] |
//! | limit the memory and work that a study may need | [`budget`] |
//! | read TOML and tables with all faults reported at once | [`document`] |
//! | mesh a shape, an outline or a file; evaluate a field at a point | [`mesh`] |
//! | load a material card, write a law of your own, plot its curves | [`material`] |
//! | minimise an energy along a path of load factors | [`solve`], [`multigrid`] |
//! | state how a sheet is supported and loaded; get displacement and stress at a point | [`problem`] |
//! | read measured markers | [`markers`] |
//! | solve a problem with springs, with finite elements, or in time | [`mass_spring`], [`finite_element`], [`dynamics`] |
//! | correct a field with conditions of your own; correct a plate; estimate a field from markers | [`corrector`], [`corrector::climb`], [`estimation`] |
//! | fit a law to test data; find springs and dashpots in a recording | [`calibration`], [`identification`] |
//! | compare two fields, with the reference's own error | [`compare`] |
//! | solve, compare and report what a study asks for | [`studies`], [`results`] |
//! | write reports, pictures, VTK files, or the input of another code | [`output`] |
//! | recompute the cases that validate gelbench | [`validation`] |
//! | read a study file of any kind, and compute it as the command does | [`kinds`] |
//! | run a study many times with some of its keys changed | [`sweep`] |
//! | call the command itself | [`command`] |
#![warn(missing_docs)]
#![forbid(unsafe_code)]

#[cfg(feature = "command")]
pub mod command;
pub mod guide;
pub mod kinds;
pub mod sweep;

#[doc(inline)]
pub use gelbench_base::{budget, document, error, statistics, units};
#[doc(inline)]
pub use gelbench_calibration::{calibration, identification};
#[doc(inline)]
pub use gelbench_corrector::{corrector, multigrid};
#[doc(inline)]
pub use gelbench_estimation::estimation;
#[doc(inline)]
pub use gelbench_mechanics::{
    dynamics, finite_element, markers, mass_spring, material, mesh, problem, solve,
};
#[doc(inline)]
pub use gelbench_report::{compare, output, results};
#[doc(inline)]
pub use gelbench_studies::studies;
#[doc(inline)]
pub use gelbench_validation::validation;

/// The program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
