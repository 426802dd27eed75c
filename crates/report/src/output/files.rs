//! What a run writes into its folder: grids, tables, pictures and reports.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

use rayon::prelude::*;

use super::explorer::Explorer;
use super::folder::{ResultFolder, free_name, kept, refuse_file, refuse_inputs};
use super::html::html;
use super::markdown::markdown_of_files;
use super::picture::{Drawn, PictureFault, picture};
use super::vtk;
use crate::document::name_of;
use crate::error::{Diagnostic, Error};
use crate::results::{
    Block, Content, Drawing, Figure, GridSeries, NamedGrid, PictureFormat, PictureStyle, Results,
};

/// Takes the files of a run: a folder of results, or a list in memory.
pub trait TakesFiles {
    /// Takes a file; `name` is relative to the folder, with `/` between its parts.
    ///
    /// # Errors
    /// [`Error::Write`] when it would replace an input, or when it cannot be written.
    fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error>;

    /// A warning for each file that is somebody else's and in the way of one that was taken since the last time.
    fn in_the_way(&mut self) -> Vec<Diagnostic> {
        Vec::new()
    }
}

impl TakesFiles for ResultFolder {
    fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        ResultFolder::add(self, name, bytes)
    }

    fn in_the_way(&mut self) -> Vec<Diagnostic> {
        ResultFolder::in_the_way(self)
    }
}

impl TakesFiles for Vec<(String, Vec<u8>)> {
    fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        self.push((name.to_owned(), bytes.to_vec()));
        Ok(())
    }
}

/// Writes everything that a study has found into a folder: grids, tables and, where it is wanted, the report for machines;
/// then pictures and the report for people. Returns a warning for each picture that cannot be drawn, and for each file that was in the way.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(
    results: &Results,
    with_report: bool,
    folder: &mut dyn TakesFiles,
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
            let style = PictureStyle::default();
            warnings.extend(write_picture(folder, name, drawing, &style)?);
        }
    }
    let pictures = write_pictures(folder, &outcome.figures, &outcome.style)?;
    let missing = faults(&pictures);
    if with_report {
        let explorer = Explorer::of(results);
        add_document(
            folder,
            "report",
            &results.report(),
            &pictures,
            explorer.as_ref(),
        )?;
    }
    warnings.extend(missing);
    warnings.extend(folder.in_the_way());
    Ok(warnings)
}

/// Draws a picture and writes it in the formats of a style, whatever the ending of its name; a warning where it cannot be drawn.
///
/// # Errors
/// [`Error::Write`] when it cannot be written.
pub fn write_picture(
    folder: &mut dyn TakesFiles,
    name: &str,
    drawing: &Drawing,
    style: &PictureStyle,
) -> Result<Option<Diagnostic>, Error> {
    let picture = ReportPicture::draw(name, drawing, style);
    for (name, bytes) in &picture.files {
        folder.add(name, bytes)?;
    }
    Ok(picture.png.err())
}

fn missing(name: &str, fault: &PictureFault) -> Diagnostic {
    Diagnostic::warning("", format!("the picture {name} cannot be drawn: {fault}"))
        .hint("the numbers are complete; the files in vtk/ show the same in ParaView")
}

/// A picture of a report: its PNG, and the files of its formats by their names.
struct ReportPicture {
    png: Drawn,
    files: Vec<(String, Vec<u8>)>,
}

impl ReportPicture {
    fn draw(name: &str, drawing: &Drawing, style: &PictureStyle) -> Self {
        let stem = name.strip_suffix(".png").unwrap_or(name);
        let drawn = |format| {
            let drawn = picture(drawing, format, style);
            drawn.map_err(|fault| missing(name, &fault))
        };
        let png = drawn(PictureFormat::Png);
        let (mut files, mut fault) = (Vec::new(), None);
        for format in &style.formats {
            let bytes = match format {
                PictureFormat::Png => png.clone(),
                PictureFormat::Svg | PictureFormat::Pdf => drawn(*format),
            };
            match bytes {
                Ok(bytes) => files.push((
                    format!("{stem}.{}", name_of(&PictureFormat::NAMES, *format)),
                    bytes,
                )),
                Err(error) => fault = Some(error),
            }
        }
        Self {
            png: fault.map_or(png, Err),
            files,
        }
    }
}

fn write_pictures(
    folder: &mut dyn TakesFiles,
    figures: &[Figure],
    style: &PictureStyle,
) -> Result<Vec<ReportPicture>, Error> {
    let drawn: Vec<ReportPicture> = figures
        .par_iter()
        .map(|figure| ReportPicture::draw(&figure.name, &figure.drawing, style))
        .collect();
    for (name, bytes) in drawn.iter().flat_map(|picture| &picture.files) {
        folder.add(name, bytes)?;
    }
    Ok(drawn)
}

fn faults(drawn: &[ReportPicture]) -> Vec<Diagnostic> {
    let faults = drawn
        .iter()
        .filter_map(|picture| picture.png.as_ref().err());
    faults.cloned().collect()
}

/// Writes the grids of a corrected frame into the folder `vtk`, and its tables beside it.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_frame(
    folder: &mut dyn TakesFiles,
    grids: &[NamedGrid],
    tables: &[(String, String)],
) -> Result<(), Error> {
    for NamedGrid { name, grid, .. } in grids {
        folder.add(&format!("vtk/{name}.vtu"), &vtk::grid(grid))?;
    }
    let mut tables = tables.iter();
    tables.try_for_each(|(name, table)| folder.add(name, table.as_bytes()))
}

/// Writes the grids of a series into the folder `vtk`.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_grids(folder: &mut dyn TakesFiles, series: &GridSeries) -> Result<(), Error> {
    let mut files = vtk::files(series);
    files.try_for_each(|(name, bytes)| folder.add(&format!("vtk/{name}"), &bytes))
}

/// Writes a document as `NAME.md`, with its pictures beside it, and as one self-contained `NAME.html`. Returns a warning for
/// each picture that cannot be drawn, which the documents contain instead of it, and for each former file that was kept.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_document(
    folder: &mut dyn TakesFiles,
    name: &str,
    blocks: &[Block],
    figures: &[Figure],
) -> Result<Vec<Diagnostic>, Error> {
    let pictures = write_pictures(folder, figures, &PictureStyle::default())?;
    add_document(folder, name, blocks, &pictures, None)?;
    let mut warnings = faults(&pictures);
    warnings.extend(folder.in_the_way());
    Ok(warnings)
}

fn add_document(
    folder: &mut dyn TakesFiles,
    name: &str,
    blocks: &[Block],
    pictures: &[ReportPicture],
    explorer: Option<&Explorer>,
) -> Result<(), Error> {
    let title = blocks.iter().find_map(|block| match block {
        Block::Heading(1, title) => Some(title.as_str()),
        _ => None,
    });
    let drawn: Vec<&Drawn> = pictures.iter().map(|picture| &picture.png).collect();
    let page = html(title.unwrap_or(name), blocks, &drawn, explorer);
    let file = |index: usize| match &pictures[index] {
        ReportPicture {
            png: Err(fault), ..
        } => Err(fault.to_string()),
        ReportPicture { files, .. } => {
            Ok(files.first().map_or(String::new(), |file| file.0.clone()))
        }
    };
    let text = markdown_of_files(blocks, &file);
    folder.add(&format!("{name}.html"), page.as_bytes())?;
    folder.add(&format!("{name}.md"), text.as_bytes())
}

/// Begin of the names of files that do not have their own yet.
const TEMPORARY: &str = ".gelbench-new-";

/// Writes a file under a temporary name and then gives it its own, so that no incomplete file ever has it. A file of that name that
/// gelbench has not written is kept under another one, which the warning names.
///
/// # Errors
/// [`Error::Write`] with the path, also where it is a file that the program has read.
pub fn save(path: &Path, bytes: &[u8]) -> Result<Option<Diagnostic>, Error> {
    refuse_inputs(path, &[])?;
    let fault = |cause: std::io::Error| Error::write(path, cause);
    // A name alone has an empty parent.
    let folder = path
        .parent()
        .filter(|parent| *parent != Path::new(""))
        .unwrap_or(Path::new("."));
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
    let moved = is_unrelated(path, bytes).then(|| (kept(path), free_name(path)));
    if let Some((_, other)) = &moved {
        std::fs::rename(path, other).map_err(fault)?;
    }
    file.persist(path).map_err(|cause| fault(cause.error))?;
    Ok(moved.map(|(warning, _)| warning))
}

/// Whether a file is there that gelbench has not written: a text that does not name it, or no picture where one is to be.
fn is_unrelated(path: &Path, new: &[u8]) -> bool {
    const BEGIN: usize = 2048;
    const PICTURES: [&[u8]; 3] = [b"\x89PNG", b"<svg", b"%PDF"];
    let Ok(there) = std::fs::read(path) else {
        return false;
    };
    if let Some(begin) = PICTURES.iter().find(|begin| new.starts_with(begin)) {
        return !there.starts_with(begin);
    }
    let begin = String::from_utf8_lossy(&there[..there.len().min(BEGIN)]);
    !there.is_empty() && there != new && !begin.contains("gelbench")
}

/// Removes temporary files of processes that were killed: those that no process has locked after a minute.
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
        let (abandoned, file) = old(".gelbench-new-a");
        drop(file);
        let (used, held) = old(".gelbench-new-b");
        held.try_lock().unwrap();
        let young = folder.path().join(".gelbench-new-c");
        std::fs::write(&young, "").unwrap();
        assert!(save(&folder.path().join("a.md"), b"1").unwrap().is_none());
        assert!(!abandoned.exists() && used.exists() && young.exists());
    }

    #[test]
    fn a_file_of_somebody_else_is_kept_and_one_of_gelbench_is_replaced() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("notes.inp");
        std::fs::write(&path, "mine").unwrap();
        let warning = save(&path, b"** written by gelbench").unwrap().unwrap();
        assert!(warning.message.ends_with("notes.inp.kept"), "{warning:?}");
        assert_eq!(
            std::fs::read(path.with_extension("inp.kept")).unwrap(),
            b"mine"
        );
        assert!(
            save(&path, b"** written by gelbench again")
                .unwrap()
                .is_none()
        );
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
