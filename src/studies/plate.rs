//! Plates between two grips: springs, corrected springs and finite elements at every stretch.

use crate::error::Error;
use crate::output::{ResultFolder, write_document, write_grids, write_pictures};

mod figures;
mod json;
mod problem;
mod read;
mod report;
pub mod results;
mod vtk;
mod warnings;

pub use problem::{OutputSettings, Study};
pub use read::DEFAULT;
use results::Results;
pub use results::run;
pub use warnings::warnings;

/// Writes everything a study asks for into its folder.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(study: &Study, results: &Results, folder: &mut ResultFolder) -> Result<(), Error> {
    if study.output.vtk {
        for series in vtk::grids(study, results) {
            write_grids(folder, &series)?;
        }
    }
    if study.output.report {
        let json = json::json(study, results);
        folder.add("report.json", format!("{json:#}\n").as_bytes())?;
    }
    let figures = if study.output.plots {
        figures::figures(study, results)
    } else {
        Vec::new()
    };
    if study.output.report {
        let blocks = report::report(study, results, &figures);
        return write_document(folder, "report", &blocks, &figures);
    }
    write_pictures(folder, &figures).map(|_| ())
}
