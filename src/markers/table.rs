//! Scattered markers from tables: columns with names, and what DICe and muDIC write.
//!
//! | layout | known by | place at rest | y axis |
//! |---|---|---|---|
//! | columns | `x`, `y`, `ux`, `uy` (or `u`, `v`) | x, y | as it is |
//! | DICe | `COORDINATE_X`, `DISPLACEMENT_X` | x, y in pixels | downwards, turned up |
//! | DICe, stereo | `MODEL_COORDINATES_X`, `MODEL_DISPLACEMENT_X` | x, y in the calibration's unit | as it is |
//! | muDIC | `x`, `y`, `ux`, `uy`, `true_strain_xx` | (x − ux, y − uy) in pixels | downwards, turned up |
//!
//! Optional columns: `standard_deviation` (of each component; DICe's `SIGMA`), `frame`, `time`, `id`. A displacement
//! that is empty or NaN was not found. DICe marks points that it did not find by `SIGMA` = −1 (`MATCH` ≠ 0 in early
//! versions) and writes lines that begin with `***` first.
//!
//! # References
//! DICe: `DICe_solution_*.txt` among the regression tests of github.com/dicengine/dice, and its maintainers on
//! SIGMA (issues 123 and 133: in pixels, one number for both directions, −1 where the correlation failed).
//! muDIC: `exportCSV` in `muDIC/IO/readWriteUtils.py` of github.com/PolymerGuy/muDIC; its `x`, `y` are the places
//! *in the frame*, so that the displacement is subtracted from them.

use std::path::Path;

use super::columns::{self, Length, Names, Units, length, plain};
use super::rows::{FileRows, ReadSettings, Row};
use crate::document::Table;
use crate::error::{Diagnostic, Error};

/// Where a layout keeps what.
struct Layout {
    name: &'static str,
    places: [Names; 2],
    displacements: [Names; 2],
    deviation: Names,
    /// Whether the y axis points downwards, as in an image.
    downwards: bool,
    /// Whether places are those of the frame, not at rest.
    deformed: bool,
    /// Whether lengths are pixels where the head says nothing.
    pixels: bool,
}

const COLUMNS: Layout = Layout {
    name: "columns",
    places: [&["x"], &["y"]],
    displacements: [&["ux", "u", "u_x"], &["uy", "v", "u_y"]],
    deviation: &["standard_deviation", "sigma"],
    downwards: false,
    deformed: false,
    pixels: false,
};

const DICE: Layout = Layout {
    name: "DICe",
    places: [&["coordinate_x"], &["coordinate_y"]],
    displacements: [&["displacement_x"], &["displacement_y"]],
    deviation: &["sigma"],
    downwards: true,
    deformed: false,
    pixels: true,
};

const DICE_STEREO: Layout = Layout {
    name: "DICe, stereo",
    places: [&["model_coordinates_x"], &["model_coordinates_y"]],
    displacements: [&["model_displacement_x"], &["model_displacement_y"]],
    // SIGMA is in pixels, not in the calibration's unit.
    deviation: &[],
    downwards: false,
    deformed: false,
    pixels: false,
};

const MUDIC: Layout = Layout {
    name: "muDIC",
    deviation: &[],
    downwards: true,
    deformed: true,
    pixels: true,
    ..COLUMNS
};

/// What a file of markers is.
const HINT: &str = "markers are a table in UTF-8 with the columns x [mm], y [mm], ux [mm], uy [mm]";

/// Reads the markers of one table.
///
/// # Errors
/// [`Error::Input`] with file, line and reason.
pub fn read(path: &Path, reading: &ReadSettings) -> Result<FileRows, Error> {
    let table = Table::read(path, HINT)?;
    let layout = layout(&table);
    let (columns, warning) = Columns::find(&table, layout, reading)?;
    let rows = (0..table.rows.len()).map(|row| columns.row(&table, layout, row));
    Ok(FileRows {
        rows: rows.collect::<Result<_, _>>()?,
        mesh: None,
        layout: layout.name,
        warnings: warning.into_iter().collect(),
    })
}

/// Reads closed lines: places in the columns `x`, `y`; several lines have their numbers in a column `line`. `unit` is
/// the length of the file's unit in mm, where it does not say it.
///
/// # Errors
/// [`Error::Input`] with file, line and reason.
pub fn read_lines(path: &Path, unit: Option<f64>) -> Result<Vec<Vec<[f64; 2]>>, Error> {
    let table = Table::read(path, Table::HINT)?;
    let units = Units {
        given: unit,
        ..Units::default()
    };
    let [x, y] = [
        length(&table, &["x"], units)?,
        length(&table, &["y"], units)?,
    ];
    let number = plain(&table, &["line"]);
    let read: Vec<usize> = [x.0, y.0].into_iter().chain(number).collect();
    columns::check_all(&table, &read, &["x", "y", "line"], &[])?;
    table.check_numbers(read, "an outline has numbers x, y alone")?;
    let mut lines: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for (row, _) in &table.rows {
        let (place, number) = (
            [row[x.0] * x.1, row[y.0] * y.1],
            number.map_or(0.0, |n| row[n]),
        );
        match lines.iter_mut().find(|(known, _)| *known == number) {
            Some((_, line)) => line.push(place),
            None => lines.push((number, vec![place])),
        }
    }
    Ok(lines.into_iter().map(|(_, line)| line).collect())
}

fn layout(table: &Table) -> &'static Layout {
    let has = |name: &str| table.columns.iter().any(|column| column.name == name);
    match () {
        () if has("model_displacement_x") => &DICE_STEREO,
        () if has("displacement_x") && has("coordinate_x") => &DICE,
        () if has("true_strain_xx") && has("ux") => &MUDIC,
        () => &COLUMNS,
    }
}

/// The columns that are read.
struct Columns {
    places: [Length; 2],
    displacements: [Length; 2],
    deviation: Option<Length>,
    frame: Option<usize>,
    time: Option<usize>,
    name: Option<usize>,
    mismatch: Option<usize>,
}

/// Columns that are not lengths.
const FRAME: Names = &["frame", "frame_number", "image"];
const TIME: Names = &["time", "t"];
const NAME: Names = &["id", "subset_id", "marker", "point", "node", "node_id"];

impl Columns {
    /// The columns, and a word where a given unit corrects those of the file.
    fn find(
        table: &Table,
        layout: &Layout,
        reading: &ReadSettings,
    ) -> Result<(Self, Option<Diagnostic>), Error> {
        let [places, displacements] = [layout.places, layout.displacements];
        let head = columns::common_unit(table, [places, displacements].as_flattened());
        let units = Units {
            given: reading.unit,
            corrected: head.as_deref(),
            pixels: layout.pixels,
        };
        let length = |names: Names| length(table, names, units);
        let has_deviation = columns::find(table, layout.deviation).is_some();
        let columns = Self {
            places: [length(places[0])?, length(places[1])?],
            displacements: [length(displacements[0])?, length(displacements[1])?],
            deviation: has_deviation
                .then(|| length(layout.deviation))
                .transpose()?,
            frame: plain(table, FRAME),
            time: plain(table, TIME),
            name: plain(table, NAME),
            mismatch: plain(table, &["match"]),
        };
        let hint = "a field of this column is a number, or empty where nothing was found";
        table.check_numbers_or_holes(columns.read(), hint)?;
        columns.overlooks_none(table, layout, &reading.ignored_columns)?;
        let word = columns::correction(table, head.as_deref(), reading.unit);
        Ok((columns, word))
    }

    /// Refuses columns that nobody reads, and points that leave their plane.
    fn overlooks_none(
        &self,
        table: &Table,
        layout: &Layout,
        ignored: &[String],
    ) -> Result<(), Error> {
        let used = self.read().chain(self.name).chain(self.mismatch);
        let used = used.chain(columns::out_of_plane(table, ignored));
        // The same in pixels of one camera.
        let pixels: Vec<Names> = match layout.name == DICE_STEREO.name {
            true => [DICE.places, DICE.displacements].concat(),
            false => Vec::new(),
        };
        let used = used.chain(pixels.into_iter().filter_map(|names| plain(table, names)));
        let lengths = [layout.places, layout.displacements];
        let lengths = lengths.as_flattened().iter().chain([&layout.deviation]);
        let others = [FRAME, TIME, NAME, columns::HEIGHT, columns::LIFT];
        let known = lengths.chain(&others).flat_map(|names| names.first());
        let known: Vec<&str> = known.copied().collect();
        columns::check_all(table, &used.collect::<Vec<_>>(), &known, ignored)?;
        let columns = |pair: [Length; 2]| pair.map(|(column, _)| column);
        columns::check_flat(
            table,
            columns(self.places),
            columns(self.displacements),
            ignored,
        )
    }

    /// The columns whose fields are numbers.
    fn read(&self) -> impl Iterator<Item = usize> {
        let lengths = self.places.into_iter().chain(self.displacements);
        let lengths = lengths.chain(self.deviation).map(|(column, _)| column);
        lengths.chain(self.frame).chain(self.time)
    }

    fn row(&self, table: &Table, layout: &Layout, row: usize) -> Result<Row, Error> {
        let (values, line) = &table.rows[row];
        let refuse = |message: &str, hint: &str| table.refuse(line.clone(), message, hint);
        let up = if layout.downwards { -1.0 } else { 1.0 };
        let pair = |[x, y]: [Length; 2]| [values[x.0] * x.1, up * values[y.0] * y.1];
        let (mut place, mut displacement) = (pair(self.places), pair(self.displacements));
        if layout.deformed && displacement.iter().all(|u| u.is_finite()) {
            place = [place[0] - displacement[0], place[1] - displacement[1]];
        }
        let deviation = self.deviation.map(|(column, unit)| values[column] * unit);
        let negative = deviation.is_some_and(|deviation| deviation < 0.0);
        if negative && layout.name != DICE.name {
            let hint = "leave it empty where it is not known";
            return Err(refuse("a standard deviation is negative", hint));
        }
        if negative || self.mismatch.is_some_and(|column| values[column] != 0.0) {
            displacement = [f64::NAN; 2];
        }
        if place.iter().any(|x| !x.is_finite()) {
            let hint = "give x and y, or leave out the line";
            return Err(refuse("a marker has no place", hint));
        }
        if layout.deformed && displacement.iter().any(|u| !u.is_finite()) {
            // Where it was at rest nobody knows.
            place = [f64::NAN; 2];
        }
        let whole = |column: Option<usize>| {
            let value = values[column?];
            (value >= 0.0 && value.fract() == 0.0).then_some(value)
        };
        if self.frame.is_some() && whole(self.frame).is_none() {
            let hint = "number the frames 1, 2, 3 …";
            return Err(refuse("a frame has no whole number", hint));
        }
        let time = self.time.map(|column| values[column]);
        Ok(Row {
            frame: whole(self.frame).map(|frame| frame as usize),
            time: time.filter(|time| time.is_finite()),
            name: whole(self.name).map(|name| name as u64),
            place,
            displacement,
            standard_deviation: deviation.filter(|deviation| *deviation > 0.0),
        })
    }
}

#[cfg(test)]
mod tests;
