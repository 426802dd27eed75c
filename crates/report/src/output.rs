//! Files that a run writes: VTK files, pictures and reports. Nothing else in gelbench writes files.

#[cfg(feature = "pictures")]
mod explorer;
pub mod export;
#[cfg(feature = "pictures")]
mod files;
#[cfg(feature = "pictures")]
mod folder;
#[cfg(feature = "pictures")]
mod html;
mod markdown;
#[cfg(feature = "pictures")]
mod picture;
pub mod vtk;

#[cfg(feature = "pictures")]
pub use files::{TakesFiles, save, write, write_document, write_frame, write_grids, write_picture};
#[cfg(feature = "pictures")]
pub use folder::{
    ANOTHER_FOLDER, BrokenOff, Remains, ResultFolder, Unfinished, identity, refuse_inputs, relative,
};
pub use markdown::markdown;
#[cfg(feature = "pictures")]
pub use picture::{Drawn, PictureFault, VIRIDIS, picture, png};

/// The JSON Schema that `report.json` follows, whatever the kind of the study:
///
/// ```json
#[doc = include_str!("output/report.schema.json")]
/// ```
pub const REPORT_SCHEMA: &str = include_str!("output/report.schema.json");
