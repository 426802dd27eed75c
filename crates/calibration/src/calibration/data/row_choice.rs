//! The rows of a table that are fitted, as the user states them.

use std::ops::Range;

use crate::document::{ColumnNames, Faulty, Head, Table, column_meaning, column_named};
use crate::statistics::extremes;
use crate::units::{self, Dimension};

/// The key of the rows: lines of the file, or a column and the value that it must have.
pub const ROWS: &str = "rows";
/// The key of the nominal strains between which rows are fitted.
pub const STRAIN_RANGE: &str = "strain range";

/// Names of the column that says to which protocol a row belongs.
const PROTOCOLS: &ColumnNames<()> = &[((), "setname set_name protocol protocol_name")];

/// What a row must fulfil.
enum Condition {
    /// It begins in the part of the text that has these lines.
    Lines(Range<usize>),
    /// A column has this text.
    Value(usize, String),
}

/// Those of some rows that are stated by [`ROWS`]; all of them where none are.
///
/// # Errors
/// A fault where the statement cannot be read, or leaves no row.
pub fn chosen_rows(head: &Head, rows: &[usize]) -> Faulty<Vec<usize>> {
    let mut chosen = rows.to_vec();
    for condition in conditions(head)? {
        chosen.retain(|row| condition.holds(head, *row));
    }
    if chosen.is_empty() {
        let hint = "look at the values in the file";
        return Err(head.fault_of(ROWS, "the rows leave no row", hint));
    }
    Ok(chosen)
}

/// The rows of each protocol with its name; all rows without a name where no column names protocols.
pub fn protocols(table: &Table) -> Vec<(String, Range<usize>)> {
    let Some(column) = column_meaning(PROTOCOLS, (), table) else {
        return vec![(String::new(), 0..table.rows.len())];
    };
    let mut all: Vec<(String, Range<usize>)> = Vec::new();
    for row in 0..table.rows.len() {
        let name = table.field(row, column).unwrap_or_default();
        match all.last_mut() {
            Some((known, rows)) if *known == name => rows.end = row + 1,
            _ => all.push((name, row..row + 1)),
        }
    }
    all
}

/// The part of a table's text with the lines that are stated by [`ROWS`]; all of it where none are, or where the statement cannot be read.
pub fn chosen_text(head: &Head) -> Range<usize> {
    let mut part = 0..head.table.source.text.len();
    for condition in conditions(head).unwrap_or_default() {
        if let Condition::Lines(lines) = condition {
            part = part.start.max(lines.start)..part.end.min(lines.end);
        }
    }
    part
}

/// Where a line begins, counted from 1; the end of the text where it has fewer.
fn start_of(text: &str, line: usize) -> usize {
    let mut ends = text.match_indices('\n');
    let end_before = line.checked_sub(2).map(|before| ends.nth(before));
    end_before.map_or(0, |end| end.map_or(text.len(), |(at, _)| at + 1))
}

/// Those of some rows whose strains, from the zero on, are in the stated [`STRAIN_RANGE`]; all of them where none is.
///
/// # Errors
/// A fault where the statement cannot be read, or leaves no row.
pub fn rows_in_range(
    head: &Head,
    rows: &[usize],
    strain: impl Fn(usize) -> f64,
) -> Faulty<Vec<usize>> {
    let Some([low, high]) = strain_range(head)? else {
        return Ok(rows.to_vec());
    };
    let is_within = |row: &usize| (low..=high).contains(&strain(*row));
    let chosen: Vec<usize> = rows.iter().copied().filter(is_within).collect();
    if chosen.is_empty() {
        let [least, most] = extremes(rows.iter().map(|row| strain(*row)));
        let hint = format!(
            "the strains go from {least:.4} to {most:.4} there, counted from the zero; those of compression are negative"
        );
        let message = "the strain range leaves none of the rows";
        return Err(head.fault_of(STRAIN_RANGE, message, &hint));
    }
    Ok(chosen)
}

impl Condition {
    fn holds(&self, head: &Head, row: usize) -> bool {
        match self {
            Self::Lines(lines) => lines.contains(&head.table.rows[row].1.start),
            Self::Value(column, value) => head.table.field(row, *column).as_ref() == Some(value),
        }
    }
}

/// The conditions of `--rows 12..340` or `--rows SetName=Test,Cycle=3-Stretch`.
fn conditions(head: &Head) -> Faulty<Vec<Condition>> {
    let Some(text) = head.text(ROWS)? else {
        return Ok(Vec::new());
    };
    let parts = text.split(',').map(|part| {
        if let Some((name, value)) = part.split_once('=') {
            let column = column_named(head.table, name.trim())?;
            return Ok(Condition::Value(column, value.trim().to_owned()));
        }
        let lines = part.split_once("..").and_then(|(first, last)| {
            let line = |text: &str, open: usize| match text.trim() {
                "" => Some(open),
                number => number.parse().ok(),
            };
            let start = |line: usize| start_of(&head.table.source.text, line);
            let after = line(last, usize::MAX)?.saturating_add(1);
            Some(Condition::Lines(start(line(first, 1)?)..start(after)))
        });
        lines.ok_or_else(|| {
            let message = format!("the rows `{part}` cannot be read");
            let hint =
                "lines of the file such as 12..340, or a column and its value such as SetName=Test";
            *head.fault_of(ROWS, message, hint)
        })
    });
    parts.collect::<Result<_, _>>().map_err(Box::new)
}

/// The stated nominal strains.
fn strain_range(head: &Head) -> Faulty<Option<[f64; 2]>> {
    let Some(text) = head.text(STRAIN_RANGE)? else {
        return Ok(None);
    };
    let ratio = |text: &str, open: f64| match text.trim() {
        "" => Some(open),
        number => units::parse(number, Dimension::Ratio).ok(),
    };
    let range = text
        .split_once("..")
        .and_then(|(low, high)| Some([ratio(low, f64::MIN)?, ratio(high, f64::MAX)?]));
    let Some(range) = range.filter(|[low, high]| low < high) else {
        let message = format!("the strain range `{text}` cannot be read");
        let hint = "nominal strains such as 0..0.3, \"0 %..30 %\" or ..0.3";
        return Err(head.fault_of(STRAIN_RANGE, message, hint));
    };
    Ok(Some(range))
}
