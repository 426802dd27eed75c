//! Tables that are a part of a file: one of its sheets, or some of its lines, where what stands in the others is no fault; and what can only be
//! decided about the columns once all rows are read.

use std::ops::Range;
use std::path::Path;

use super::super::columns::Column;
use super::super::converted::TableText;
use super::super::decimals::NotANumber;
use super::super::lines::{
    are_quantities, blanks_to_tabs, delimiter, names_in_remark, plain_text, remark_above,
};
use super::{Table, TextPart};
use crate::error::Error;

/// Rows from which on a text is surely a table, and not a few values that belong to one.
const FEWEST_ROWS: usize = 3;

impl Table {
    /// The one of several texts that is a table.
    pub(super) fn only(file: &Path, texts: &[TableText], part: TextPart) -> Result<Self, Error> {
        let read = |text: &TableText| {
            let file = file.display();
            let name = match &text.name {
                Some(name) => format!("{file}#{name}"),
                None => file.to_string(),
            };
            let table = Self::separated(&name, text.text.clone(), b'\t', part)?;
            Ok(Self {
                part: text.name.clone(),
                is_text: false,
                ..table
            })
        };
        let (mut tables, mut refused) = (Vec::new(), None);
        for text in texts {
            match read(text) {
                Ok(table) => tables.push(table),
                Err(fault) => refused = refused.or(Some(fault)),
            }
        }
        if tables.iter().any(|table| table.rows.len() >= FEWEST_ROWS) {
            tables.retain(|table| table.rows.len() >= FEWEST_ROWS);
        }
        if tables.len() > 1 {
            let names = tables.iter().filter_map(|table| table.part.as_deref());
            let names: Vec<&str> = names.collect();
            let file = file.display();
            let message = format!("{file} has several tables: `{}`", names.join("`, `"));
            let hint = format!("name one: {file}#{}", names[0]);
            return Err(Error::input(message, hint));
        }
        let empty = || Error::input(format!("{} has no table", file.display()), Self::HINT);
        let table = tables.pop();
        table.ok_or_else(|| refused.unwrap_or_else(empty))
    }

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

    /// Removes a last column that is none, and takes names from a remark that is a line of names.
    pub(super) fn settle(&mut self) {
        self.drop_trailing_column();
        self.name_by_remark_if(are_quantities);
    }

    /// Takes names from the remark right above the rows, as some programs write them, if no other line names the columns.
    pub fn name_by_remark(&mut self) {
        self.name_by_remark_if(|_| true);
    }

    /// Takes names from that remark if they are `accepted`.
    fn name_by_remark_if(&mut self, accepted: fn(&[&str]) -> bool) {
        let unnamed = self.columns.iter().all(|column| column.name.is_empty());
        let first_row = self.rows.first().map_or(0, |(_, position)| position.start);
        let Some(position) = remark_above(&self.source.text, first_row).filter(|_| unnamed) else {
            return;
        };
        let remark = self.source.text[position.clone()]
            .trim_start_matches('#')
            .trim();
        let names = names_in_remark(remark, self.columns.len());
        if let Some(names) = names.filter(|names| accepted(names)) {
            // Columns without a name have a unit only of themselves: times of a clock are in s, whatever their name states.
            for (column, name) in self.columns.iter_mut().zip(names) {
                let mut named = Column::new(name);
                named.unit = column.unit.take().or(named.unit.take());
                *column = named;
            }
            self.columns_place = position;
        }
    }

    /// Removes the column behind separators at the ends of lines: it has neither a name nor a number.
    fn drop_trailing_column(&mut self) {
        let Some(last) = self.columns.len().checked_sub(1).filter(|last| *last > 0) else {
            return;
        };
        let is_hole = |row: &(Vec<f64>, Range<usize>)| row.0[last].is_nan();
        let is_empty = matches!(self.faults[last], Some((_, NotANumber::Empty)));
        let is_plain = self.columns[last] == Column::default() && self.nonsense[last].is_none();
        if is_empty && is_plain && self.rows.iter().all(is_hole) {
            self.columns.truncate(last);
            self.faults.truncate(last);
            self.nonsense.truncate(last);
            self.rows.iter_mut().for_each(|(row, _)| row.truncate(last));
        }
    }
}
