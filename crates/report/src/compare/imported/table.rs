//! Fields at scattered points, from tables.
//!
//! | column | meaning |
//! |---|---|
//! | `x`, `y` | position at rest |
//! | `ux`, `uy` (`u`, `v`) | displacement |
//! | `stretch`, `load_factor`, `factor` | the load factor of a row; a stretch in % is one too |
//! | `time` | the time of a row, the load factor unless `--time` says otherwise |
//! | `z`, `uz` | of a sheet that stays flat |
//!
//! Units stand in the names (`ux_mm`) or in brackets. Other columns are refused, see [`crate::markers::columns`].

use crate::document::Table;
use crate::error::Error;
use crate::markers::columns::{self, Names, Units, length, plain};
use crate::units::{self, Dimension};

const LENGTHS: [Names; 4] = {
    let ([x, y], [ux, uy]) = (columns::POSITIONS, columns::DISPLACEMENTS);
    [x, y, ux, uy]
};
const RENAME: &str =
    "name the columns x [mm], y [mm], ux [mm] and uy [mm] (or u and v), with your own unit";
const FACTOR: Names = &["stretch", "load_factor", "factor"];
const TIME: Names = &["time"];
const NAMES: Names = &["node", "node_id", "marker", "id", "point"];
const KNOWN: [&str; 11] = [
    "x",
    "y",
    "ux",
    "uy",
    "stretch",
    "load_factor",
    "factor",
    "time",
    "node",
    "z",
    "uz",
];

/// How a file is to be understood.
#[derive(Clone, Debug)]
pub struct ImportSettings {
    /// The length of the file's unit in mm; mm where neither this nor the file says it.
    pub unit: Option<f64>,
    /// The array of a VTK file, where it must be named.
    pub array: Option<String>,
    /// The load factor.
    pub factor: f64,
    /// The time of a step, where it is not the load factor.
    pub time: Option<f64>,
    /// Columns of a table that are passed over.
    pub ignored_columns: Vec<String>,
}

/// A displacement field at scattered points.
#[derive(Clone, Debug)]
pub struct Points {
    /// Points in mm.
    pub positions: Vec<[f64; 2]>,
    /// ux, uy of point after point in mm.
    pub displacement: Vec<f64>,
}

/// A column that chooses rows, the scale of its numbers, and the number that is chosen.
type Choice = (usize, f64, f64);

/// The points of the rows with the load factor.
///
/// # Errors
/// [`Error::Input`] with what is wrong.
pub fn read(table: &Table, settings: &ImportSettings) -> Result<Points, Error> {
    let matches = LENGTHS.map(|names| columns::find(table, names));
    let heads = matches.iter().map(|matched| matched.as_ref()?.1.as_deref());
    let head = columns::common_unit(heads);
    let units = Units {
        given: settings.unit.or(Some(1.0)),
        corrected: head.as_deref().filter(|_| settings.unit.is_some()),
        pixels: false,
    };
    let mut lengths = Vec::new();
    for names in LENGTHS {
        let matched = columns::required(table, names, RENAME)?;
        lengths.push(length(table, matched, units)?);
    }
    let choices = choices(table, settings)?;
    let read = lengths.iter().map(|(column, _)| *column);
    let read: Vec<usize> = read.chain(choices.iter().map(|choice| choice.0)).collect();
    table.check_numbers(read.iter().copied(), "every field of a column is a number")?;
    let ignored = &settings.ignored_columns;
    let flat = columns::out_of_plane(table, columns::OUT_OF_PLANE, ignored);
    let used = read.iter().copied().chain(flat).chain(plain(table, NAMES));
    columns::check_all(table, &used.collect::<Vec<_>>(), &KNOWN, ignored)?;
    let vectors = [[lengths[0], lengths[1]], [lengths[2], lengths[3]]];
    columns::check_flat(table, vectors, columns::OUT_OF_PLANE, ignored, |_| true)?;
    let rows = chosen(table, &choices)?;
    let pair = |row: &&Vec<f64>, first: usize| {
        [0, 1].map(|axis| {
            let (column, unit) = lengths[first + axis];
            row[column] * unit
        })
    };
    let all: Vec<_> = rows
        .iter()
        .map(|row| [pair(row, 0), pair(row, 2)])
        .collect();
    check_unique(&table.source.name, all.clone())?;
    Ok(Points {
        positions: all.iter().map(|[position, _]| *position).collect(),
        displacement: all
            .iter()
            .flat_map(|[_, displacement]| *displacement)
            .collect(),
    })
}

/// Refuses two displacements of one point; equal rows are harmless.
fn check_unique(file: &str, mut all: Vec<[[f64; 2]; 2]>) -> Result<(), Error> {
    all.sort_by(|[a, _], [b, _]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut pairs = all.windows(2);
    let differs = |pair: &&[[[f64; 2]; 2]]| pair[0][0] == pair[1][0] && pair[0][1] != pair[1][1];
    let Some(&[[[x, y], [ux, uy]], [_, [vx, vy]]]) = pairs.find(differs) else {
        return Ok(());
    };
    let message =
        format!("{file} has two displacements at ({x}, {y}) mm: ({ux}, {uy}) and ({vx}, {vy}) mm");
    let hint = "leave the rows of one load factor and of one measurement, or add a column `load_factor` or `time`";
    Err(Error::input(message, hint))
}

/// The columns that choose rows.
fn choices(table: &Table, settings: &ImportSettings) -> Result<Vec<Choice>, Error> {
    let mut choices = Vec::new();
    if let Some((index, scale)) = factor_column(table)? {
        choices.push((index, scale, settings.factor));
    }
    if let Some(index) = plain(table, TIME) {
        let wanted = settings.time.unwrap_or(settings.factor);
        choices.push((index, 1.0, wanted));
    } else if let Some(time) = settings.time {
        let message = format!("--time {time} is given, but there is no column `time`");
        return Err(table.refuse_columns(message, "leave it out, or name the column"));
    }
    Ok(choices)
}

/// The column with the load factor, a number or in %.
fn factor_column(table: &Table) -> Result<Option<(usize, f64)>, Error> {
    let Some(index) = plain(table, FACTOR) else {
        return Ok(None);
    };
    let scale = match table.columns[index].unit.as_deref() {
        None | Some("") => 1.0,
        Some(unit) => units::factor(unit, Dimension::Ratio).map_err(|_| {
            let message = format!("`{unit}` is not a unit of a load factor");
            table.refuse_columns(message, "%, or none")
        })?,
    };
    Ok(Some((index, scale)))
}

/// The rows that are chosen.
fn chosen<'a>(table: &'a Table, choices: &[Choice]) -> Result<Vec<&'a Vec<f64>>, Error> {
    const NEAR: f64 = 1e-6;
    let mut rows: Vec<&Vec<f64>> = table.rows.iter().map(|(row, _)| row).collect();
    for (column, scale, wanted) in choices {
        let there = |row: &&Vec<f64>| scale * row[*column];
        let mut all: Vec<f64> = rows.iter().map(there).collect();
        rows.retain(|row| (there(row) - wanted).abs() <= NEAR * wanted.abs());
        if rows.is_empty() {
            all.sort_by(f64::total_cmp);
            all.dedup();
            let all: Vec<String> = all.iter().take(12).map(f64::to_string).collect();
            let (what, option) = if TIME.contains(&&*table.columns[*column].name) {
                ("time", "--time")
            } else {
                ("load factor", "--factor")
            };
            let message = format!("{} has no rows for the {what} {wanted}", table.source.name);
            let hint = format!("choose one that it has with {option}: {}", all.join(", "));
            return Err(Error::input(message, hint));
        }
    }
    Ok(rows)
}
