//! Test data from files.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::choice::COLUMNS;
use super::cycles::{PRECONDITIONED, SPECIMEN_NAME};
use super::layout::Layout;
use super::test_data::TestData;
use crate::document::{Head, Statements, Table};
use crate::error::{Diagnostic, Error};

/// The statements about test data that a file or the command line must make.
pub const KEYS: [&str; 18] = [
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
];

impl TestData {
    /// Reads a file; `reading` supplements the file's own statements, by [`KEYS`].
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason; nothing is ever guessed.
    pub fn read(path: &Path, reading: &Statements) -> Result<Self, Error> {
        Self::of_table(&Table::read(path, Table::HINT)?, reading)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(name: &str, text: &str, reading: &Statements) -> Result<Self, Error> {
        Self::of_table(&Table::parse(name, text)?, reading)
    }

    fn of_table(table: &Table, reading: &Statements) -> Result<Self, Error> {
        let head = Head::new(table, &KEYS, reading)?;
        let layout = Layout::new(&head).map_err(Error::Input)?;
        let hint = "every row must contain finite numbers; units belong in the line of names";
        table.check_numbers_or_holes(layout.columns(), hint)?;
        let rows = MeasuredRows::of(table, &layout);
        if rows.kept.is_empty() {
            table.check_numbers(layout.columns(), hint)?;
        }
        let fewer = (rows.kept.len() < table.rows.len()).then(|| table.with_rows(&rows.kept));
        let head = match &fewer {
            Some(fewer) => Head::new(fewer, &KEYS, reading)?,
            None => head,
        };
        let mut data = layout.read(&head).map_err(|fault| input(*fault))?;
        data.warnings.extend(rows.warnings(table));
        Ok(data)
    }
}

/// The rows of a table that are measurements, each once.
struct MeasuredRows {
    kept: Vec<usize>,
    /// Rows without a number in a column that is read.
    holes: usize,
    /// Rows that repeat an earlier one of the table, where all rows do.
    copies: usize,
    /// Rows that repeat an earlier one of the table, where other rows do not.
    repeated: usize,
}

impl MeasuredRows {
    /// Repeated rows are copies where all rows are repeated equally often; otherwise some may be equal measurements.
    fn of(table: &Table, layout: &Layout) -> Self {
        let columns: Vec<usize> = layout.all_columns().collect();
        let key = |row: usize| -> Vec<u64> {
            let values = &table.rows[row].0;
            let read = columns
                .iter()
                .map(|column| (values[*column] + 0.0).to_bits());
            read.collect()
        };
        let has_numbers = |row: &usize| {
            let values = &table.rows[*row].0;
            layout.columns().all(|column| values[column].is_finite())
        };
        let all: Vec<usize> = (0..table.rows.len()).filter(has_numbers).collect();
        let mut counts: HashMap<Vec<u64>, usize> = HashMap::new();
        for row in &all {
            *counts.entry(key(*row)).or_default() += 1;
        }
        let [least, most] = [counts.values().min(), counts.values().max()];
        let more = all.len() - counts.len();
        let are_copies = most > Some(&1) && least == most;
        let mut seen = HashSet::new();
        let is_kept = |row: &usize| !are_copies || seen.insert(key(*row));
        let holes = table.rows.len() - all.len();
        Self {
            kept: all.into_iter().filter(is_kept).collect(),
            holes,
            copies: if are_copies { more } else { 0 },
            repeated: if are_copies { 0 } else { more },
        }
    }

    /// The warnings about the other rows.
    fn warnings(&self, table: &Table) -> Vec<Diagnostic> {
        /// A share of equal rows that is not due to chance.
        const MANY: f64 = 0.2;
        let repeated = if self.repeated as f64 > MANY * self.kept.len() as f64 {
            self.repeated
        } else {
            0
        };
        let told = [
            (
                self.holes,
                "rows without a number for strain or stress",
                "they are left out",
            ),
            (
                self.copies,
                "rows that repeat earlier ones, as all rows of the table do",
                "each measurement counts once: copies add no information",
            ),
            (
                repeated,
                "rows that repeat earlier ones",
                "each counts as a measurement of its own: if they are copies, intervals are too narrow",
            ),
        ];
        let told = told.into_iter().filter(|(count, ..)| *count > 0);
        told.map(|(count, what, hint)| {
            let message = format!("{}: {what}: {count}", table.source.name);
            Diagnostic::warning("", message).hint(hint)
        })
        .collect()
    }
}

fn input(fault: Diagnostic) -> Error {
    Error::Input(vec![fault])
}

#[cfg(test)]
mod layouts_tests;
#[cfg(test)]
mod missing_tests;
#[cfg(test)]
mod rows_tests;
#[cfg(test)]
mod tests;
