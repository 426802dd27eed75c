//! What a run writes: VTK files, pictures and reports. Nothing else in gelbench writes files.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::results::Results;
use crate::study::Study;

mod figures;
mod html;
mod json;
mod markdown;
pub mod picture;
mod report;
mod vtk;

/// Writes everything a study asks for into its folder and returns the files in the order of writing.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(study: &Study, results: &Results, folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut written = Vec::new();
    if study.output.vtk {
        for (name, bytes) in vtk::files(study, results) {
            written.push(save(&folder.join("vtk").join(name), &bytes)?);
        }
    }
    let figures = if study.output.plots {
        figures::figures(study, results)
    } else {
        Vec::new()
    };
    for figure in &figures {
        written.push(save(&folder.join(&figure.name), &figure.png)?);
    }
    if study.output.report {
        let blocks = report::report(study, results, &figures);
        let json = json::json(study, results);
        let page = html::html(&study.title, &blocks, &figures);
        let reports = [
            ("report.json", format!("{json:#}\n")),
            ("report.html", page),
            ("report.md", markdown::markdown(&blocks, &figures)),
        ];
        for (name, text) in reports {
            written.push(save(&folder.join(name), text.as_bytes())?);
        }
    }
    Ok(written)
}

/// Makes sure that files can be written into `folder`, before any work is done for them.
///
/// # Errors
/// [`Error::Write`] when the folder cannot be made or does not take files.
pub fn prepare(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|cause| Error::write(folder, cause))?;
    tempfile::tempfile_in(folder).map_err(|cause| Error::write(folder, cause))?;
    Ok(())
}

/// Writes a file under a temporary name and then gives it its own, so that no half file ever has it.
///
/// # Errors
/// [`Error::Write`] with the path.
pub fn save(path: &Path, bytes: &[u8]) -> Result<PathBuf, Error> {
    let fault = |cause: std::io::Error| Error::write(path, cause);
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(fault)?;
    let mut file = temporary_file(folder).map_err(fault)?;
    file.write_all(bytes).map_err(fault)?;
    file.persist(path).map_err(|cause| fault(cause.error))?;
    Ok(path.to_owned())
}

/// A new file that its owner may write and everybody the user allows may read, as any file he makes.
fn temporary_file(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".gelbench-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
