//! Tables of which only some lines are read: what stands in the others is no fault.

use std::ops::Range;
use std::path::Path;

use super::super::columns::Column;
use super::super::lines::{blanks_to_tabs, delimiter, plain_text};
use super::{Table, TextPart};
use crate::error::Error;

impl Table {
    /// Reads the rows of a file that begin in a part of its text; the others keep their places, without numbers and without faults.
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason.
    pub fn read_part(path: &Path, hint: &str, part: TextPart) -> Result<Self, Error> {
        Self::read_within(path, None, hint, part)
    }

    /// Reads the rows of a text that begin in a part of it.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault and its place.
    pub fn parse_part(name: &str, text: &str, part: TextPart) -> Result<Self, Error> {
        let text = blanks_to_tabs(plain_text(text));
        match delimiter(&text) {
            Some(delimiter) => Self::separated(name, text, delimiter, part),
            None => Err(Self::empty(name, text, b',').without_columns()),
        }
    }

    /// Adds a row outside of the part, which has so many fields.
    pub(super) fn add_unread_row(&mut self, fields: usize, position: Range<usize>) {
        if self.columns.is_empty() {
            self.columns = vec![Column::default(); fields];
        }
        let columns = self.columns.len();
        self.faults.resize(columns, None);
        self.nonsense.resize(columns, None);
        self.rows.push((vec![f64::NAN; columns], position));
    }
}
