//! Matrices of displacements on a regular grid of points, as Ncorr stores them.
//!
//! Ncorr writes no table of points: its results are the matrices `plot_u_ref_formatted` and `plot_v_ref_formatted`
//! of `data_dic_save.displacements` in MATLAB, one row of the image after the other, in the unit that was chosen
//! there. Saved by `writematrix(u, 'frame_1_u.csv')` and the same for v, two files are one frame. The distance between
//! the points is (`dispinfo.spacing` + 1) · `dispinfo.pixtounits`. Points outside of the region of interest are zero
//! in both; rows count downwards, so that y and v are turned up.
//!
//! # References
//! J. Blaber, B. Adair, A. Antoniou, Experimental Mechanics 55 (2015) 1105, doi:10.1007/s11340-015-0009-1

use std::path::{Path, PathBuf};

use super::rows::{FileRows, ReadSettings, Row};
use super::understood::Understood;
use crate::document::Table;
use crate::error::Error;

/// The files of each frame: two whose names end in `u` and `v` and are otherwise the same, or one alone.
pub fn pairs(files: &[PathBuf]) -> Vec<Vec<&Path>> {
    let stem = |file: &Path| {
        let name = file.file_stem()?.to_string_lossy().into_owned();
        Some((file.parent()?.to_owned(), name))
    };
    let matrix_of_v = |file: &PathBuf| {
        let (folder, name) = stem(file)?;
        series(&name)?;
        let other = Some((folder, format!("{}v", name.strip_suffix('u')?)));
        files.iter().find(|file| stem(file) == other)
    };
    let others: Vec<Option<&PathBuf>> = files.iter().map(matrix_of_v).collect();
    let first = files.iter().zip(&others);
    first
        .filter(|(file, _)| !others.contains(&Some(*file)))
        .map(|(file, other)| {
            [file]
                .into_iter()
                .chain(*other)
                .map(PathBuf::as_path)
                .collect()
        })
        .collect()
}

/// The name of a frame without the component at its end: `frame_1` of `frame_1_u`.
pub fn series(stem: &str) -> Option<&str> {
    stem.strip_suffix('u')?.strip_suffix(['_', '-', '.'])
}

/// Reads the two matrices of a frame.
pub fn read(u: &Path, v: &Path, reading: &ReadSettings) -> Result<FileRows, Error> {
    let Some(step) = reading.grid else {
        return Err(Error::input(
            format!(
                "{} is a matrix, which does not state the distance between its points",
                u.display()
            ),
            "give --grid \"0.5 mm\": Ncorr's (spacing + 1) times its pixel length",
        ));
    };
    let Some(unit) = reading.unit else {
        return Err(Error::input(
            format!("{} does not state its unit", u.display()),
            "give --unit mm, or the length of a pixel where Ncorr's units are pixels",
        ));
    };
    let [u, v] = [matrix(u, reading)?, matrix(v, reading)?];
    let size = |matrix: &Table| [matrix.rows.len(), matrix.columns.len()];
    if size(&u) != size(&v) {
        let [[a, b], [c, d]] = [size(&u), size(&v)];
        return Err(Error::input(
            format!(
                "{} has {a} × {b} entries, {} has {c} × {d}",
                u.source.name, v.source.name
            ),
            "save u and v of the same frame",
        ));
    }
    let mut rows = Vec::new();
    for (i, (us, vs)) in u.rows.iter().zip(&v.rows).enumerate() {
        for (j, (u, v)) in us.0.iter().zip(&vs.0).enumerate() {
            // Outside of the region of interest there is no specimen.
            if *u != 0.0 || *v != 0.0 {
                rows.push(Row {
                    position: [step * j as f64, -step * i as f64],
                    displacement: [unit * u, -unit * v],
                    ..Row::default()
                });
            }
        }
    }
    Ok(FileRows {
        rows,
        understood: Understood {
            turned_up: true,
            ..Understood::of("Ncorr")
        },
        ..FileRows::default()
    })
}

fn matrix(path: &Path, reading: &ReadSettings) -> Result<Table, Error> {
    let table = Table::read_as(path, reading.encoding, Table::HINT)?;
    table.check_numbers_or_holes(0..table.columns.len(), "give a matrix of numbers, or NaN")?;
    if table.columns.iter().any(|column| !column.name.is_empty()) {
        let hint = "give markers as one table, or matrices of numbers alone";
        return Err(table.refuse_columns("a matrix must not have column names", hint));
    }
    Ok(table)
}
