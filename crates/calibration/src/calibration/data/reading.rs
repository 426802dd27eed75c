//! Test data from files.

use std::ops::Range;
use std::path::Path;

use super::choice::COLUMNS;
use super::cycles::{PRECONDITIONED, SPECIMEN_NAME};
use super::gross_rows::{gross_rows, torn_rows};
use super::layout::Layout;
use super::row_choice::{ROWS, STRAIN_RANGE, chosen_rows, chosen_text};
use super::strain_column::FLIP;
use super::test_data::TestData;
use crate::document::{Head, Statements, Table};
use crate::error::{Diagnostic, Error};

/// The statements about test data that a file or the command line must make.
pub const KEYS: [&str; 32] = [
    "test",
    "stress measure",
    "strain measure",
    "stress unit",
    "strain unit",
    "direction",
    "strain ratio",
    "area",
    "length",
    "width",
    "thickness",
    "time unit",
    "cycle",
    "zero",
    "ramp",
    PRECONDITIONED,
    COLUMNS,
    SPECIMEN_NAME,
    ROWS,
    STRAIN_RANGE,
    FLIP,
    "mounting",
    "tines",
    "tine spacing",
    "tine inset",
    "tine diameter",
    "tine bars",
    "arm width",
    "fillet",
    "markers",
    "rest state",
    "force zero",
];
impl TestData {
    /// Reads a file; `reading` has further statements by [`KEYS`], which supplement those of the file.
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason; nothing is ever guessed.
    pub fn read(path: &Path, reading: &Statements) -> Result<Self, Error> {
        let part = |table: &Table| chosen_part(table, reading);
        Self::of_table(&Table::read_part(path, Table::HINT, &part)?, reading)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(name: &str, text: &str, reading: &Statements) -> Result<Self, Error> {
        let part = |table: &Table| chosen_part(table, reading);
        Self::of_table(&Table::parse_part(name, text, &part)?, reading)
    }

    fn of_table(table: &Table, reading: &Statements) -> Result<Self, Error> {
        let head = Head::new(table, &KEYS, reading)?;
        let layout = Layout::new(&head).map_err(Error::Input)?;
        let hint = "every row must contain finite numbers; units belong in the line of names";
        table.check_numbers_or_holes(layout.columns(), hint)?;
        let is_measured = |row: &usize| {
            let values = &table.rows[*row].0;
            layout.columns().all(|column| values[column].is_finite())
        };
        let all: Vec<usize> = (0..table.rows.len()).collect();
        let stated = chosen_rows(&head, &all).map_err(|fault| input(*fault))?;
        let (mut chosen, holes) = kept(&stated, is_measured);
        if chosen.is_empty() {
            let only = table.with_rows(&stated);
            only.check_numbers(layout.columns(), hint)?;
        }
        let is_backwards = layout.runs_backwards(table, &chosen);
        if is_backwards {
            chosen.reverse();
        }
        let rows_are_stated = head.text(ROWS).map_err(|fault| input(*fault))?.is_some();
        let (mut gross, mut torn) = (Vec::new(), Vec::new());
        if !rows_are_stated {
            gross = layout.unlike(table, &chosen, gross_rows);
            let others = kept(&chosen, |row| !gross.contains(row)).0;
            torn = layout.unlike(table, &others, torn_rows);
        }
        let is_good = |row: &usize| !gross.contains(row) && !torn.contains(row);
        let (chosen, _) = kept(&chosen, is_good);
        let fewer = (chosen != all).then(|| table.with_rows(&chosen));
        let head = match &fewer {
            Some(fewer) => Head::new(fewer, &KEYS, reading)?,
            None => head,
        };
        let mut data = layout.read(&head).map_err(|fault| input(*fault))?;
        data.remarks.extend(is_backwards.then(|| {
            "the times decrease: the rows are read from the last to the first".to_owned()
        }));
        data.warnings.extend((holes > 0).then(|| {
            let message = format!(
                "{}: rows without a number for strain or stress: {holes}",
                table.source.name
            );
            Diagnostic::warning("", message).hint("they are left out")
        }));
        let gross = left_out(
            table,
            &gross,
            "rows that leave the curve of their neighbours",
        );
        let behind = "rows behind a rupture, where the specimen carries nothing";
        let torn = left_out(table, &torn, behind);
        data.warnings.extend(gross.into_iter().chain(torn));
        Ok(data)
    }
}

/// The part of a table's text with the rows that are stated; all of it where the statements are at fault, which is told later.
fn chosen_part(table: &Table, reading: &Statements) -> Range<usize> {
    let head = Head::new(table, &KEYS, reading);
    head.map_or(0..usize::MAX, |head| chosen_text(&head))
}

/// The warning about rows that are left out, where there are any.
fn left_out(table: &Table, rows: &[usize], what: &str) -> Option<Diagnostic> {
    let message = format!("{what}: {}", rows.len());
    let hint = "they are left out; `--rows 1..` keeps all rows";
    let position = table.rows[*rows.first()?].1.clone();
    Some(
        Diagnostic::warning("", message)
            .hint(hint)
            .at(&table.source, position),
    )
}

/// Those of some rows that fulfil a condition, and how many do not.
fn kept(rows: &[usize], condition: impl Fn(&usize) -> bool) -> (Vec<usize>, usize) {
    let kept: Vec<usize> = rows.iter().copied().filter(condition).collect();
    let others = rows.len() - kept.len();
    (kept, others)
}

fn input(fault: Diagnostic) -> Error {
    Error::Input(vec![fault])
}

#[cfg(test)]
mod dialects_tests;
#[cfg(test)]
mod layouts_tests;
#[cfg(test)]
mod missing_tests;
#[cfg(test)]
mod rows_tests;
#[cfg(test)]
mod tests;
