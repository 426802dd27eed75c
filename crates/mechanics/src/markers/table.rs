//! Scattered markers from tables: columns with names, and what other programs export, see [`super::layouts`].
//!
//! Optional columns: `standard_deviation` (of each component; DICe's `SIGMA`), `frame`, `time`, `id`. A displacement
//! that is empty or NaN was not found. DICe and VIC mark points that they did not find by `sigma` = −1 (`MATCH` ≠ 0 in early
//! versions of DICe, which writes lines that begin with `***` first).

use std::path::Path;

use super::columns::{
    self, ASSIGN, FRAME, Length, Names, TIME, Units, find, length, plain, required,
};
use super::layouts::{Layout, NAMED, recognise};
use super::role::Role;
use super::rows::{FileRows, ReadSettings, Row};
use super::subset::Subset;
use super::understood::{ColumnTaken, Understood};
use crate::document::{FoundColumns, Table, is_pixel};
use crate::error::{Diagnostic, Error};

/// What a file of markers is.
const HINT: &str = "markers are a table with the columns x [mm], y [mm], ux [mm], uy [mm]";

/// Reads the markers of one table.
pub fn read(path: &Path, reading: &ReadSettings) -> Result<FileRows, Error> {
    let mut table = Table::read_as(path, reading.encoding, HINT)?;
    table.name_by_remark();
    let chosen = reading.columns.on(&table)?;
    let reader = Reader::new(&table, &chosen, reading)?;
    let rows = (0..table.rows.len()).map(|row| reader.row(row));
    Ok(FileRows {
        rows: rows.collect::<Result<_, _>>()?,
        mesh: None,
        understood: Understood {
            subset: Subset::of(&table, path, reader.layout),
            ..reader.understood()
        },
        warnings: reader.warnings,
    })
}

/// Reads closed lines: positions in the columns `x`, `y`; several lines have their numbers or names in a column `line`. `unit` is
/// the length of the file's unit in mm, where the file does not state it.
///
/// # Errors
/// [`Error::Input`] with file, line and reason.
pub fn read_lines(path: &Path, unit: Option<f64>) -> Result<Vec<Vec<[f64; 2]>>, Error> {
    let table = Table::read(path, Table::HINT)?;
    let ([x, y], label) = columns::of_positions(&table, unit, &["line"], &[])?;
    let hint = "give an outline as numbers x, y, and a number or a name of its line in each row where there are several";
    table.check_numbers([x.0, y.0], hint)?;
    let mut lines: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for (index, (row, place)) in table.rows.iter().enumerate() {
        let label = match label {
            None => String::new(),
            Some(column) if row[column].is_finite() => row[column].to_string(),
            Some(column) => match table.field(index, column) {
                Some(name) if !name.trim().is_empty() => name.trim().to_owned(),
                _ => {
                    return Err(table.refuse(
                        place.clone(),
                        "column `line`: no line is named",
                        hint,
                    ));
                }
            },
        };
        let position = [row[x.0] * x.1, row[y.0] * y.1];
        match lines.iter_mut().find(|(known, _)| *known == label) {
            Some((_, line)) => line.push(position),
            None => lines.push((label, vec![position])),
        }
    }
    Ok(lines.into_iter().map(|(_, line)| line).collect())
}

/// Columns of a point's own number.
pub(super) const NAME: Names = &["id", "subset_id", "marker", "point", "node", "node_id"];

/// A table and the columns that are read.
struct Reader<'a> {
    table: &'a Table,
    layout: &'static str,
    downwards: bool,
    deformed: bool,
    positions: [Length; 2],
    displacements: [Length; 2],
    deviation: Option<Length>,
    frame: Option<usize>,
    /// With its unit in s.
    time: Option<(usize, f64)>,
    name: Option<usize>,
    mismatch: Option<usize>,
    lost: Option<usize>,
    converged: Option<usize>,
    /// Whether positions are in pixels.
    in_pixels: bool,
    /// The length in mm of the unit where heads state none, as given by the user.
    given: Option<f64>,
    warnings: Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    fn new(
        table: &'a Table,
        chosen: &FoundColumns<Role>,
        reading: &ReadSettings,
    ) -> Result<Self, Error> {
        let named = chosen.any(&Role::LENGTHS);
        let layout = if named { &NAMED } else { recognise(table) };
        let head = |role: Role, names: Names| match chosen.of(role) {
            Some(index) => Some((index, columns::unit_of(table, index))),
            None => find(table, names),
        };
        let ([x, y], [ux, uy]) = (layout.positions, layout.displacements);
        let roles = [(Role::X, x), (Role::Y, y), (Role::Ux, ux), (Role::Uy, uy)];
        let heads = roles.map(|(role, names)| head(role, names));
        let names = || heads.iter().map(|head| head.as_ref()?.1.as_deref());
        let common_unit = columns::common_unit(names());
        let common = common_unit.as_deref();
        let units = Units {
            given: reading.unit,
            corrected: common,
            pixels: layout.pixels || named && names().flatten().any(is_pixel),
        };
        let of = |index: usize| {
            let head = match &heads[index] {
                Some(head) => head.clone(),
                None => required(table, roles[index].1, ASSIGN)?,
            };
            length(table, head, units)
        };
        let deviation = head(Role::StandardDeviation, layout.deviation);
        let plain_column = |role, names| chosen.of(role).or_else(|| plain(table, names));
        let reader = Self {
            table,
            layout: layout.name,
            downwards: reading.downwards.unwrap_or(layout.downwards),
            deformed: reading.deformed.unwrap_or(layout.deformed),
            positions: [of(0)?, of(1)?],
            displacements: [of(2)?, of(3)?],
            deviation: deviation
                .map(|head| length(table, head, units))
                .transpose()?,
            frame: plain_column(Role::Frame, FRAME),
            time: plain_column(Role::Time, TIME)
                .map(|column| Ok::<_, Error>((column, columns::seconds(table, column)?)))
                .transpose()?,
            name: plain_column(Role::Id, NAME),
            mismatch: plain(table, &["match"]),
            lost: plain(table, layout.lost),
            converged: plain(table, layout.converged),
            in_pixels: heads[0]
                .as_ref()
                .is_some_and(|(_, unit)| unit.as_deref().map_or(units.pixels, is_pixel)),
            given: reading.unit,
            warnings: columns::correction(table, common, reading.unit)
                .into_iter()
                .chain(columns::mixed_units(names()))
                .collect(),
        };
        let hint = "write a number in every field of this column, or leave it empty where nothing was found";
        table.check_numbers_or_holes(reader.read(), hint)?;
        reader.check_columns(layout, named, &reading.ignored_columns)
    }

    /// Refuses columns that are not read, and points that leave their plane; where the user names the columns, a warning lists the others.
    fn check_columns(
        mut self,
        layout: &Layout,
        named: bool,
        ignored: &[String],
    ) -> Result<Self, Error> {
        let table = self.table;
        let used = self.read().chain(self.name).chain(self.mismatch);
        let used = used.chain(columns::out_of_plane(table, layout.out_of_plane, ignored));
        let harmless = layout.harmless.chunks(1);
        let harmless = harmless.filter_map(|name| find(table, name).map(|(index, _)| index));
        let used: Vec<usize> = used.chain(harmless).collect();
        if named {
            let others = columns::others(table, &used, ignored).into_iter();
            let others: Vec<_> = others.map(|column| &*column.written).collect();
            if !others.is_empty() {
                let message = format!("ignored columns: {}", others.join(", "));
                let hint = "--columns lists those that are read";
                self.warnings
                    .push(Diagnostic::warning("", message).hint(hint));
            }
        } else {
            let vectors = [layout.positions, layout.displacements];
            let lengths = vectors.as_flattened().iter().chain([&layout.deviation]);
            let others = [FRAME, TIME, NAME].into_iter().chain(layout.out_of_plane);
            let names = lengths.copied().chain(others).map(columns::first_name);
            let known: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
            columns::check_all(table, &used, &known, ignored)?;
        }
        let vectors = [self.positions, self.displacements];
        columns::check_flat(table, vectors, layout.out_of_plane, ignored, |row| {
            !self.is_lost(row)
        })?;
        Ok(self)
    }

    /// The columns whose fields are numbers.
    fn read(&self) -> impl Iterator<Item = usize> {
        let vectors = self.positions.into_iter().chain(self.displacements);
        let lengths = vectors.chain(self.deviation).map(|(column, _)| column);
        let time = self.time.map(|(column, _)| column);
        let others = [self.frame, time, self.lost, self.converged];
        lengths.chain(others.into_iter().flatten())
    }

    /// Whether the point of a row was not found.
    fn is_lost(&self, values: &[f64]) -> bool {
        self.lost.is_some_and(|column| values[column] < 0.0)
            || self.converged.is_some_and(|column| values[column] == 0.0)
            || self.mismatch.is_some_and(|column| values[column] != 0.0)
    }

    fn row(&self, row: usize) -> Result<Row, Error> {
        let (values, line) = &self.table.rows[row];
        let refuse = |message: &str, hint: &str| self.table.refuse(line.clone(), message, hint);
        let up = if self.downwards { -1.0 } else { 1.0 };
        let pair = |[x, y]: [Length; 2]| [values[x.0] * x.1, up * values[y.0] * y.1];
        let (mut position, mut displacement) = (pair(self.positions), pair(self.displacements));
        if self.deformed && displacement.iter().all(|u| u.is_finite()) {
            position = [position[0] - displacement[0], position[1] - displacement[1]];
        }
        let is_lost = self.is_lost(values);
        let deviation = self.deviation.map(|(column, unit)| values[column] * unit);
        if deviation.is_some_and(|deviation| deviation < 0.0) && !is_lost {
            let hint = "leave it empty where it is not known";
            return Err(refuse("a standard deviation is negative", hint));
        }
        if is_lost {
            displacement = [f64::NAN; 2];
        }
        if position.iter().any(|x| !x.is_finite()) {
            let hint = "give x and y, or leave out the line";
            return Err(refuse("a marker has no position", hint));
        }
        if self.deformed && displacement.iter().any(|u| !u.is_finite()) {
            // Its position at rest is unknown.
            position = [f64::NAN; 2];
        }
        let integer = |column: Option<usize>| {
            let value = values[column?];
            (value >= 0.0 && value.fract() == 0.0).then_some(value)
        };
        if self.frame.is_some() && integer(self.frame).is_none() {
            let hint = "number the frames 1, 2, 3 …";
            return Err(refuse("a frame number is not a whole number", hint));
        }
        let time = self.time.map(|(column, unit)| values[column] * unit);
        Ok(Row {
            frame: integer(self.frame).map(|frame| frame as usize),
            time: time.filter(|time| time.is_finite()),
            name: integer(self.name).map(|name| name as u64),
            position,
            displacement,
            standard_deviation: deviation.filter(|deviation| *deviation > 0.0),
        })
    }

    /// What was taken from which column, and how.
    fn understood(&self) -> Understood {
        let ([x, y], [ux, uy]) = (self.positions, self.displacements);
        let lengths = [("x", x), ("y", y), ("ux", ux), ("uy", uy)];
        let deviation = self.deviation.map(|length| ("standard deviation", length));
        let lengths = lengths.into_iter().chain(deviation);
        let of_length =
            lengths.map(|(holds, (column, unit))| self.taken(holds, column, Some(unit)));
        let others = [
            ("frame", self.frame),
            ("time", self.time.map(|(column, _)| column)),
            ("id", self.name),
        ];
        let others = others
            .into_iter()
            .filter_map(|(holds, column)| Some((holds, column?)));
        let others = others.map(|(holds, column)| self.taken(holds, column, None));
        Understood {
            layout: self.layout,
            encoding: self.table.encoding.map(|encoding| encoding.name()),
            part: self.table.part.clone(),
            columns: of_length.chain(others).collect(),
            turned_up: self.downwards,
            taken_to_rest: self.deformed,
            subset: None,
            pixel: self.in_pixels.then_some(self.positions[0].1),
        }
    }

    fn taken(&self, holds: &'static str, column: usize, unit: Option<f64>) -> ColumnTaken {
        ColumnTaken {
            holds,
            head: self.table.columns[column].head(),
            unit,
            unit_source: match unit {
                None => "",
                Some(_) if unit == self.given => "--unit",
                Some(_) => "the file",
            },
        }
    }
}

#[cfg(test)]
mod tests;
