//! The guide, page by page.
//!
//! # With the command
//!
//! | page | for |
//! |---|---|
//! | [From the laboratory](laboratory) | "I have a tensile test", "a biaxial test", "displacements from image correlation": from the raw file to the figure |
//! | [Keys](keys) | every key of studies and cards with unit, range and default |
//! | [Plates](plates) | a clamped plate in all three models: the study file, the report, the figures |
//! | [Specimens](specimens) | any shape, any mesh, supports and loads, adaptive refinement, paths that end early |
//! | [Motions](motions) | a plate that is released, driven or relaxing: dashpots, viscosity, energy |
//! | [Measured fields](measured_fields) | markers from image correlation: the nearest field in equilibrium, with intervals |
//! | [Images](images) | camera images: displacements with standard deviations, and stress from two photographs |
//! | [Materials](materials) | cards, fits to your own tests, export of test data |
//! | [Springs and dashpots](springs_and_dashpots) | spring and dashpot functions from a recording of force and extension |
//! | [Many runs](many_runs) | a study with varied parameters: grids, distributions, the uncertainty of a fit; clusters |
//! | [Other codes](other_codes) | the same problem in Abaqus, CalculiX or FEBio, and the import of their results |
//! | [Validation](validation) | the claims of the publication, and what gelbench is checked against |
//! | [Performance](performance) | why the corrected plate is fast, and how to measure it |
//!
//! # With the library
//!
//! The tests of gelbench run the programs on these pages.
//!
//! | page | for |
//! |---|---|
//! | [A first plate](first_plate) | springs, corrected springs and finite elements of one plate |
//! | [A law of your own](own_law) | a material law that gelbench does not have |
//! | [A shape of your own](own_shape) | a shape from dimensions, from an outline or from a file, with supports and loads |
//! | [Markers of your own](own_markers) | an equilibrium field from markers that are already in memory |
//! | [A condition of your own](own_condition) | a condition of your own in the corrector |
//! | [A study in a program](own_study) | reading a study file and writing its results |
//!
//! # From Python
//!
//! | page | for |
//! |---|---|
//! | [Python](python) | the package `gelbench`: plates, meshes, fits, measured fields, and the corrector on the equations of any program |

#[doc = include_str!("guide/first_plate.md")]
pub mod first_plate {}
#[doc = include_str!("guide/own_law.md")]
pub mod own_law {}
#[doc = include_str!("guide/own_shape.md")]
pub mod own_shape {}
#[doc = include_str!("guide/own_markers.md")]
pub mod own_markers {}
#[doc = include_str!("guide/own_condition.md")]
pub mod own_condition {}
#[doc = include_str!("guide/own_study.md")]
pub mod own_study {}

#[doc = include_str!("guide/laboratory.md")]
pub mod laboratory {}
#[doc = include_str!("guide/keys.md")]
pub mod keys {}
#[doc = include_str!("guide/plates.md")]
#[doc = "```toml"]
#[doc = include_str!("../examples/pva_plate.toml")]
#[doc = "```"]
pub mod plates {}
#[doc = include_str!("guide/specimens.md")]
#[doc = "```toml"]
#[doc = include_str!("../examples/strip_with_hole.toml")]
#[doc = "```"]
pub mod specimens {}
#[doc = include_str!("guide/motions.md")]
#[doc = "```toml"]
#[doc = include_str!("../examples/released_plate.toml")]
#[doc = "```"]
pub mod motions {}
#[doc = include_str!("guide/measured_fields.md")]
#[doc = "```toml"]
#[doc = include_str!("../examples/measured_plate.toml")]
#[doc = "```"]
pub mod measured_fields {}
#[doc = include_str!("guide/images.md")]
pub mod images {}
#[doc = include_str!("guide/materials.md")]
pub mod materials {}
#[doc = include_str!("guide/springs_and_dashpots.md")]
pub mod springs_and_dashpots {}
#[doc = include_str!("guide/many_runs.md")]
pub mod many_runs {}
#[doc = include_str!("guide/other_codes.md")]
pub mod other_codes {}
#[doc = include_str!("guide/validation.md")]
pub mod validation {}
#[doc = include_str!("guide/performance.md")]
pub mod performance {}
#[doc = include_str!("guide/python.md")]
pub mod python {}
