//! Files of any kind as one series of frames.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::frames::MarkerSeries;
use super::rows::{FileRows, ReadSettings, Row};
use super::understood::Understood;
use super::{matrices, plausible, positions, table};
use crate::document::is_table_path;
use crate::error::{Diagnostic, Error};
use crate::mesh::{Mesh, import_series};

/// What files hold.
#[derive(Debug)]
pub struct MarkerFiles {
    /// The markers.
    pub series: MarkerSeries,
    /// The mesh that the field came on.
    pub mesh: Option<Mesh>,
    /// How the files were understood.
    pub understood: Understood,
    /// What deserves attention.
    pub warnings: Vec<Diagnostic>,
}

/// Reads one or several files. Several tables or fields are frames: the number at the end of a file's name is its
/// frame's, otherwise its index in the list. Two matrices whose names end in `u` and `v` are one frame.
///
/// # Errors
/// [`Error::Input`] with the file, what is wrong and what to do.
pub fn read(files: &[PathBuf], settings: &ReadSettings) -> Result<MarkerFiles, Error> {
    let groups = matrices::pairs(files);
    let several = groups.len() > 1;
    let mut combined: Option<FileRows> = None;
    for (group, number) in groups.iter().zip(frame_numbers(&groups)) {
        let mut file_rows = match group[..] {
            [frame] if settings.rest.is_some() => positions::read(frame, settings)?,
            [u, v] => matrices::read(u, v, settings)?,
            _ if is_table_path(group[0]) => table::read(group[0], settings)?,
            _ => on_mesh(group[0], settings)?,
        };
        if several {
            check_one_frame(&file_rows, group[0])?;
            for row in &mut file_rows.rows {
                row.frame = Some(number);
            }
        }
        match &mut combined {
            None => combined = Some(file_rows),
            Some(combined) => append(combined, file_rows, group[0])?,
        }
    }
    let Some(mut combined) = combined else {
        return Err(Error::input("no field is given", "name a file"));
    };
    let mut warnings = std::mem::take(&mut combined.warnings);
    let (mesh, understood) = (combined.mesh.clone(), combined.understood.clone());
    let series = combined.gather(&mut warnings);
    plausible::check(&series, &mut warnings)?;
    Ok(MarkerFiles {
        series,
        mesh,
        understood,
        warnings,
    })
}

/// Reads a field on a mesh: the nodes are the markers, and all its steps are frames.
fn on_mesh(path: &Path, reading: &ReadSettings) -> Result<FileRows, Error> {
    let unit = reading.unit.unwrap_or(1.0);
    let series = import_series(path, unit, reading.array.as_deref()).map_err(|reason| {
        let hint = "give a field as .csv (x, y, ux, uy), .vtu, .vtk (up to version 4), .pvd, Gmsh's .msh with \
                    $NodeData, or CalculiX' .frd (ASCII)";
        Error::input(format!("{} {reason}", path.display()), hint)
    })?;
    let several = series.steps.len() > 1;
    let steps = series.steps.iter().zip(1..);
    let rows = steps.flat_map(|(step, number)| {
        let nodes = series.mesh.nodes.iter().zip(0..);
        let pairs = nodes.zip(step.displacement.chunks_exact(2));
        pairs.map(move |((position, node), u)| Row {
            frame: several.then_some(number),
            time: step.time,
            name: Some(node),
            position: *position,
            displacement: [u[0], u[1]],
            ..Row::default()
        })
    });
    Ok(FileRows {
        rows: rows.collect(),
        mesh: Some(series.mesh),
        understood: Understood::of("field on a mesh"),
        ..FileRows::default()
    })
}

/// Refuses a file of several frames beside others, because each of several files is one frame.
fn check_one_frame(read: &FileRows, file: &Path) -> Result<(), Error> {
    let frames: BTreeSet<Option<usize>> = read.rows.iter().map(|row| row.frame).collect();
    if frames.len() < 2 {
        return Ok(());
    }
    let message = format!(
        "{} has {} frames, but each of several files is one frame",
        file.display(),
        frames.len()
    );
    let hint = "give all frames in one file, or one frame in each";
    Err(Error::input(message, hint))
}

/// Adds the frames of one more file, which must be of the same kind.
fn append(combined: &mut FileRows, added: FileRows, file: &Path) -> Result<(), Error> {
    let meshes = [&combined.mesh, &added.mesh].map(|mesh| mesh.as_ref().map(|mesh| &mesh.nodes));
    let fault = if combined.understood.layout != added.understood.layout {
        "has another layout than the files before it"
    } else if meshes[0] != meshes[1] {
        "has another mesh than the files before it"
    } else {
        combined.rows.extend(added.rows);
        combined.warnings.extend(added.warnings);
        return Ok(());
    };
    let hint = "give the frames of one measurement in one layout and on one mesh";
    Err(Error::input(format!("{} {fault}", file.display()), hint))
}

/// The number at the end of a name.
pub fn number_at_end(name: &str) -> Option<usize> {
    let before = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    name[before.len()..].parse().ok()
}

/// The numbers at the ends of the files' names where all have different ones, otherwise 1, 2, 3 …
fn frame_numbers(groups: &[Vec<&Path>]) -> Vec<usize> {
    let number = |group: &Vec<&Path>| {
        let stem = group[0].file_stem()?.to_string_lossy().into_owned();
        let stem = match group.len() {
            2 => matrices::series(&stem)?.to_owned(),
            _ => stem,
        };
        number_at_end(&stem)
    };
    let numbers: Option<Vec<usize>> = groups.iter().map(number).collect();
    let different =
        |numbers: &Vec<usize>| numbers.iter().collect::<BTreeSet<_>>().len() == numbers.len();
    let counted = || (1..=groups.len()).collect();
    numbers.filter(different).unwrap_or_else(counted)
}
