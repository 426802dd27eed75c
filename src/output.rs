//! What a run writes: VTK files, pictures and reports. Nothing else in gelbench writes files.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::results::Results;
use crate::study::Study;

mod figures;
mod fit;
pub mod folder;
pub mod hand_over;
mod html;
mod identification;
mod json;
mod markdown;
mod material;
pub mod measured;
pub mod picture;
mod report;
pub mod series;
pub mod vtk;
mod warnings;
pub mod wrinkling;

pub use figures::{
    Field, Figure, cell_figure, comparison_chart, field_animation, field_figure, material_chart,
    mesh_picture,
};
pub use fit::{fit_json, fit_picture};
pub use identification::{identification_json, identification_picture};
pub use material::material_json;
pub use report::{Block, material_statement};
pub use warnings::warnings;

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
    written.extend(write_pictures(folder, &figures)?);
    if study.output.report {
        let json = json::json(study, results);
        written.push(save(
            &folder.join("report.json"),
            format!("{json:#}\n").as_bytes(),
        )?);
        let blocks = report::report(study, results, &figures);
        written.extend(write_document(folder, "report", &blocks, &figures)?);
    }
    remove_stale(folder, &written)?;
    for name in ONCE {
        let path = folder.join(name);
        if path.exists() && !written.contains(&path) {
            std::fs::remove_file(&path).map_err(|cause| Error::write(&path, cause))?;
        }
    }
    Ok(written)
}

/// Files of a plate's study that are missing where a model has no solution.
const ONCE: [&str; 5] = [
    "estimated_error.png",
    "vtk/mass_spring.pvd",
    "vtk/springs.pvd",
    "vtk/corrected.pvd",
    "vtk/finite_element.pvd",
];

/// Removes what an earlier run of a study with more stretches or load factors has left among the files of this
/// one.
///
/// # Errors
/// [`Error::Write`] with the file that could not be removed.
pub fn remove_stale(folder: &Path, written: &[PathBuf]) -> Result<(), Error> {
    for (part, prefixes, ending) in [
        ("", &["plates_", "error_"][..], "png"),
        ("", &["nodes_", "cells_", "markers_"][..], "csv"),
        (
            "vtk",
            &[
                "mass_spring_",
                "springs_",
                "corrected_",
                "finite_element_",
                "markers_",
            ][..],
            "vtu",
        ),
    ] {
        let Ok(entries) = std::fs::read_dir(folder.join(part)) else {
            continue;
        };
        for path in entries.flatten().map(|entry| entry.path()) {
            let stem = path
                .file_stem()
                .map(|stem| stem.to_string_lossy().into_owned());
            let number = stem
                .iter()
                .find_map(|stem| prefixes.iter().find_map(|prefix| stem.strip_prefix(prefix)));
            let numbered = number.is_some_and(|number| number.parse::<u32>().is_ok());
            let ours = numbered && path.extension().is_some_and(|found| found == ending);
            if ours && !written.contains(&path) {
                std::fs::remove_file(&path).map_err(|cause| Error::write(&path, cause))?;
            }
        }
    }
    Ok(())
}

/// Writes pictures into a folder.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_pictures(folder: &Path, figures: &[Figure]) -> Result<Vec<PathBuf>, Error> {
    let pictures = figures.iter();
    pictures
        .map(|figure| save(&folder.join(&figure.name), &figure.png))
        .collect()
}

/// Writes a document as `NAME.md`, with its pictures beside it, and as one self-contained `NAME.html`.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write_document(
    folder: &Path,
    name: &str,
    blocks: &[Block],
    figures: &[Figure],
) -> Result<[PathBuf; 2], Error> {
    let title = blocks.iter().find_map(|block| match block {
        Block::Heading(1, title) => Some(title.as_str()),
        _ => None,
    });
    let page = html::html(title.unwrap_or(name), blocks, figures);
    let text = markdown::markdown(blocks, figures);
    Ok([
        save(&folder.join(format!("{name}.html")), page.as_bytes())?,
        save(&folder.join(format!("{name}.md")), text.as_bytes())?,
    ])
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

/// Takes a folder that was prepared away again when nothing came to be written into it.
pub fn abandon(folder: &Path) {
    // It is not empty when an earlier run has left its files, and then it stays.
    let _ = std::fs::remove_dir(folder);
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
