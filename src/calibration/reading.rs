//! Test data from files.

use std::path::Path;

use super::layout::Layout;
use super::test_data::TestData;
use crate::document::{Head, Statements, Table};
use crate::error::{Diagnostic, Error};

/// What a file or the command line must say about test data.
pub const KEYS: [&str; 15] = [
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
];

impl TestData {
    /// Reads a file; `reading` says what the file does not, by [`KEYS`].
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
        let hint = "every row holds finite numbers; units stand in the line of names";
        table.check_numbers(layout.columns(), hint)?;
        layout.read(&head).map_err(|fault| input(*fault))
    }
}

fn input(fault: Diagnostic) -> Error {
    Error::Input(vec![fault])
}

#[cfg(test)]
mod missing_tests;
#[cfg(test)]
mod tests;
