//! What a run writes into its folder: grids, tables, pictures and reports.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rayon::prelude::*;

use super::folder::{ResultFolder, refuse_file, refuse_inputs};
use super::html::html;
use super::markdown::markdown;
use super::picture::{Drawn, png};
use super::vtk;
use crate::error::{Diagnostic, Error};
use crate::results::{Block, Content, Drawing, Figure, GridSeries, Results};

/// Writes everything that a study has found into a folder: grids, tables and, where it is wanted, the report for machines;
/// then pictures and the report for people. Returns a warning for each picture that cannot be drawn.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(
    results: &Results,
    with_report: bool,
    folder: &mut ResultFolder,
) -> Result<Vec<Diagnostic>, Error> {
    let outcome = &results.outcome;
    let mut grids = outcome.grids.iter();
    grids.try_for_each(|series| write_grids(folder, series))?;
    let timed = |series: &GridSeries| series.grids.iter().any(|grid| grid.time.is_some());
    if outcome.grids.iter().any(timed) {
        folder.add("vtk/view.py", vtk::VIEW.as_bytes())?;
    }
    for (name, content) in &outcome.files {
        if let Content::Text(text) = content {
            folder.add(name, text.as_bytes())?;
        }
    }
    if with_report {
        let json = format!("{:#}\n", results.json());
        folder.add("report.json", json.as_bytes())?;
    }
    let mut warnings = Vec::new();
    for (name, content) in &outcome.files {
        if let Content::Picture(drawing) = content {
            warnings.extend(write_picture(folder, name, drawing)?.err());
        }
    }
    warnings.extend(match with_report {
        true => write_document(folder, "report", &results.report(), &outcome.figures)?,
        false => faults(write_pictures(folder, &outcome.figures)?),
    });
    Ok(warnings)
}

/// Draws a picture and writes it, if it can be drawn.
///
/// # Errors
/// [`Error::Write`] when it cannot be written.
pub fn write_picture(
    folder: &mut ResultFolder,
    name: &str,
    drawing: &Drawing,
) -> Result<Drawn, Error> {
    add_picture(folder, name, draw(name, drawing))
}

fn draw(name: &str, drawing: &Drawing) -> Drawn {
    png(drawing).map_err(|fault| {
        Diagnostic::warning("", format!("the picture {name} cannot be drawn: {fault}"))
            .hint("the numbers are complete; the files in vtk/ show the same in ParaView")
    })
}

fn add_picture(folder: &mut ResultFolder, name: &str, drawn: Drawn) -> Result<Drawn, Error> {
    if let Ok(picture) = &drawn {
        folder.add(name, picture)?;
    }
    Ok(drawn)
}

fn write_pictures(folder: &mut ResultFolder, figures: &[Figure]) -> Result<Vec<Drawn>, Error> {
    let drawn = figures.par_iter();
    let drawn = drawn.map(|figure| draw(&figure.name, &figure.drawing));
    let drawn: Vec<Drawn> = drawn.collect();
    let named = figures.iter().zip(drawn);
    named
        .map(|(figure, drawn)| add_picture(folder, &figure.name, drawn))
        .collect()
}

fn faults(drawn: Vec<Drawn>) -> Vec<Diagnostic> {
    drawn.into_iter().filter_map(Result::err).collect()
}

/// Writes the grids of a series into the folder `vtk`.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_grids(folder: &mut ResultFolder, series: &GridSeries) -> Result<(), Error> {
    let mut files = vtk::files(series);
    files.try_for_each(|(name, bytes)| folder.add(&format!("vtk/{name}"), &bytes))
}

/// Writes a document as `NAME.md`, with its pictures beside it, and as one self-contained `NAME.html`. Returns a warning for
/// each picture that cannot be drawn; it stands in its place too.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_document(
    folder: &mut ResultFolder,
    name: &str,
    blocks: &[Block],
    figures: &[Figure],
) -> Result<Vec<Diagnostic>, Error> {
    let title = blocks.iter().find_map(|block| match block {
        Block::Heading(1, title) => Some(title.as_str()),
        _ => None,
    });
    let pictures = write_pictures(folder, figures)?;
    let page = html(title.unwrap_or(name), blocks, &pictures);
    let missing = |index: usize| pictures[index].as_ref().err().map(ToString::to_string);
    let text = markdown(blocks, figures, &missing);
    folder.add(&format!("{name}.html"), page.as_bytes())?;
    folder.add(&format!("{name}.md"), text.as_bytes())?;
    Ok(faults(pictures))
}

/// Begin of the names of files that do not have their own yet.
const TEMPORARY: &str = ".gelbench-new-";

/// Writes a file under a temporary name and then gives it its own, so that no half file ever has it.
///
/// # Errors
/// [`Error::Write`] with the path, also where it is a file that the program has read.
pub fn save(path: &Path, bytes: &[u8]) -> Result<PathBuf, Error> {
    refuse_inputs(path, &[])?;
    let fault = |cause: std::io::Error| Error::write(path, cause);
    // A name alone has an empty parent.
    let folder = path.parent().filter(|parent| *parent != Path::new(""));
    let folder = folder.unwrap_or(Path::new("."));
    refuse_file(folder)?;
    if path.is_dir() {
        let cause = "it is a folder; name the file in it that is to be written";
        return Err(Error::write(path, cause));
    }
    std::fs::create_dir_all(folder).map_err(fault)?;
    sweep(folder);
    let mut file = temporary_file(folder).map_err(fault)?;
    // What is locked is not swept.
    let _ = file.as_file().try_lock();
    file.write_all(bytes).map_err(fault)?;
    file.as_file().sync_all().map_err(fault)?;
    file.persist(path).map_err(|cause| fault(cause.error))?;
    Ok(path.to_owned())
}

/// Removes temporary files of processes that were killed: those that nobody holds any more after a minute.
fn sweep(folder: &Path) {
    const MINUTE: Duration = Duration::from_secs(60);
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let temporary = |name: &str| name.starts_with(TEMPORARY);
    for entry in entries.filter(|entry| temporary(&entry.file_name().to_string_lossy())) {
        let changed = entry.metadata().and_then(|about| about.modified());
        let age = changed.ok().and_then(|changed| changed.elapsed().ok());
        let held = File::open(entry.path()).is_ok_and(|file| file.try_lock().is_err());
        if age.is_some_and(|age| age > MINUTE) && !held {
            // What cannot be removed does no harm.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// A new file that its owner may write and everybody the user allows may read, as any file he makes.
fn temporary_file(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_temporary_file_that_a_kill_has_left_is_swept_and_one_in_use_is_not() {
        let folder = tempfile::TempDir::new().unwrap();
        let old = |name: &str| {
            let path = folder.path().join(name);
            let file = File::create(&path).unwrap();
            let hour = std::time::SystemTime::now() - Duration::from_secs(3600);
            file.set_modified(hour).unwrap();
            (path, file)
        };
        let (left, file) = old(".gelbench-new-a");
        drop(file);
        let (used, held) = old(".gelbench-new-b");
        held.try_lock().unwrap();
        let young = folder.path().join(".gelbench-new-c");
        std::fs::write(&young, "").unwrap();
        save(&folder.path().join("a.md"), b"1").unwrap();
        assert!(!left.exists() && used.exists() && young.exists());
    }
}
