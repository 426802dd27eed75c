//! Displacements that were measured, or computed elsewhere, at scattered points of a flat specimen.
//!
//! ```text
//! .csv, .txt, .dat   ─table─┐
//! Ncorr           ─matrices─┼─rows─▶ MarkerSeries { frames of markers } (and the mesh that they came on)
//! .vtu .msh .frd … ─────────┘
//! ```
//!
//! All lengths are in mm. A marker that was not found in a frame is absent from it.

pub mod columns;
mod frames;
mod layouts;
mod matrices;
mod mistake;
mod outside;
mod plausible;
mod positions;
mod read;
mod role;
mod rows;
mod subset;
mod table;
mod understood;

pub use frames::{Frame, Marker, MarkerSeries};
pub use mistake::Mistake;
pub use plausible::{MarkersOnMesh, check_thickness, place_on, unit_ratio};
pub use read::{MarkerFiles, number_at_end, read};
pub use role::{ChosenColumns, Role};
pub use rows::ReadSettings;
pub use subset::Subset;
pub use table::read_lines;
pub use understood::{ColumnTaken, Understood};
