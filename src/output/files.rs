//! What a run writes into its folder: grids, tables, pictures and reports.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::folder::{ResultFolder, refuse_file};
use super::html::html;
use super::markdown::markdown;
use super::picture::png;
use super::vtk;
use crate::error::Error;
use crate::results::{Block, Content, Figure, GridSeries, Results};

/// Writes everything that a study has found into a folder: grids, tables and pictures and, where it is wanted, the
/// report for people and for machines.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(results: &Results, with_report: bool, folder: &mut ResultFolder) -> Result<(), Error> {
    let outcome = &results.outcome;
    let mut grids = outcome.grids.iter();
    grids.try_for_each(|series| write_grids(folder, series))?;
    write_files(folder, &outcome.files)?;
    if !with_report {
        return write_pictures(folder, &outcome.figures).map(|_| ());
    }
    let json = format!("{:#}\n", results.json());
    folder.add("report.json", json.as_bytes())?;
    write_document(folder, "report", &results.report(), &outcome.figures)
}

/// Draws pictures and writes them into a folder.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
fn write_pictures(folder: &mut ResultFolder, figures: &[Figure]) -> Result<Vec<Vec<u8>>, Error> {
    let mut written = Vec::new();
    for figure in figures {
        let picture = png(&figure.drawing);
        folder.add(&figure.name, &picture)?;
        written.push(picture);
    }
    Ok(written)
}

/// Writes tables, texts and pictures beside a report.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
fn write_files(folder: &mut ResultFolder, files: &[(String, Content)]) -> Result<(), Error> {
    files.iter().try_for_each(|(name, content)| match content {
        Content::Text(text) => folder.add(name, text.as_bytes()),
        Content::Picture(drawing) => folder.add(name, &png(drawing)),
    })
}

/// Writes the grids of a series into the folder `vtk`.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_grids(folder: &mut ResultFolder, series: &GridSeries) -> Result<(), Error> {
    let mut files = vtk::files(series);
    files.try_for_each(|(name, bytes)| folder.add(&format!("vtk/{name}"), &bytes))
}

/// Writes a document as `NAME.md`, with its pictures beside it, and as one self-contained `NAME.html`.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_document(
    folder: &mut ResultFolder,
    name: &str,
    blocks: &[Block],
    figures: &[Figure],
) -> Result<(), Error> {
    let title = blocks.iter().find_map(|block| match block {
        Block::Heading(1, title) => Some(title.as_str()),
        _ => None,
    });
    let pictures = write_pictures(folder, figures)?;
    let page = html(title.unwrap_or(name), blocks, &pictures);
    let text = markdown(blocks, figures);
    folder.add(&format!("{name}.html"), page.as_bytes())?;
    folder.add(&format!("{name}.md"), text.as_bytes())
}

/// Writes a file under a temporary name and then gives it its own, so that no half file ever has it.
///
/// # Errors
/// [`Error::Write`] with the path.
pub fn save(path: &Path, bytes: &[u8]) -> Result<PathBuf, Error> {
    let fault = |cause: std::io::Error| Error::write(path, cause);
    let folder = path.parent().unwrap_or(Path::new("."));
    refuse_file(folder)?;
    if path.is_dir() {
        let cause = "it is a folder; name the file in it that is to be written";
        return Err(Error::write(path, cause));
    }
    std::fs::create_dir_all(folder).map_err(fault)?;
    let mut file = temporary_file(folder).map_err(fault)?;
    file.write_all(bytes).map_err(fault)?;
    file.as_file().sync_all().map_err(fault)?;
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
