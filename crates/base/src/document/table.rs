//! Tables of numbers as laboratories write them: commas, semicolons, tabs or blanks, decimal points or commas, a head of
//! `# key: value` lines or a preamble, names with units in brackets or in a line of their own.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::Faults;
use super::columns::{Above, Column, unquoted};
use super::decimals::{Decimals, NotANumber, is_clock_time, is_hole};
use super::encoding::TextEncoding;
use super::file::MOST_OF_DATA;
use super::formats;
use super::lines::{SURVEYED, line_at};
use super::text::{bytes, text_of_data};
use crate::error::{Diagnostic, Error, Source};

/// A field that is not a number: its row and the fault.
type FieldFault = Option<(usize, NotANumber)>;

/// The part of a text in which rows are read, by the statements of a table whose rows are not read yet.
pub type TextPart<'a> = &'a dyn Fn(&Table) -> Range<usize>;

/// All of a text.
const WHOLE: TextPart<'static> = &|table: &Table| 0..table.source.text.len();

/// A table of a file.
#[derive(Debug)]
pub struct Table {
    /// The file, for messages.
    pub source: Arc<Source>,
    /// The encoding in which it was written, where it was read from a file.
    pub encoding: Option<TextEncoding>,
    /// The name of the sheet or the array that was read, where the file has several tables.
    pub part: Option<String>,
    /// Whether it is a text, above whose rows the user can write statements.
    pub is_text: bool,
    /// The columns.
    pub columns: Vec<Column>,
    /// The place of the line that names the columns.
    pub columns_place: Range<usize>,
    /// The rows, each with its place. A field that is not a number is NaN here, and is reported by [`Self::check_numbers`].
    pub rows: Vec<(Vec<f64>, Range<usize>)>,
    /// The separator of the columns.
    delimiter: u8,
    /// The first field of each column that is not a number.
    faults: Vec<FieldFault>,
    /// The first field of each column that is neither a number nor marks a missing one: empty, or NaN.
    nonsense: Vec<FieldFault>,
}

impl Table {
    /// The description of a table, for users who gave something else.
    pub const HINT: &str = "a table is CSV: a header line of names with units, and rows of numbers";

    /// Reads a file in the encoding that its bytes show; `hint` describes what it should be.
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason.
    pub fn read(path: &Path, hint: &str) -> Result<Self, Error> {
        Self::read_as(path, None, hint)
    }

    /// Reads a file in the `wanted` encoding, if there is one.
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason.
    pub fn read_as(path: &Path, wanted: Option<TextEncoding>, hint: &str) -> Result<Self, Error> {
        Self::read_within(path, wanted, hint, WHOLE)
    }

    fn read_within(
        path: &Path,
        wanted: Option<TextEncoding>,
        hint: &str,
        part: TextPart,
    ) -> Result<Self, Error> {
        let (file, sheet) = formats::file_and_part(path);
        let bytes = bytes(&file, MOST_OF_DATA, hint)?;
        let tables = formats::tables(&bytes, sheet.as_deref()).map_err(|fault| {
            Error::input(format!("{} {}", file.display(), fault.message), fault.hint)
        })?;
        if let Some(tables) = tables {
            return Self::only(&file, &tables, part);
        }
        let (text, encoding) = text_of_data(&file, &bytes, wanted, hint)?;
        let table = Self::parse_part(&path.display().to_string(), &text, part)?;
        Ok(Self {
            encoding: Some(encoding),
            ..table
        })
    }

    /// Reads a text.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault and its place.
    pub fn parse(name: &str, text: &str) -> Result<Self, Error> {
        Self::parse_part(name, text, WHOLE)
    }

    fn empty(name: &str, text: String, delimiter: u8) -> Self {
        Self {
            source: Arc::new(Source {
                name: name.to_owned(),
                text,
            }),
            encoding: None,
            part: None,
            is_text: true,
            delimiter,
            columns: Vec::new(),
            columns_place: 0..0,
            rows: Vec::new(),
            faults: Vec::new(),
            nonsense: Vec::new(),
        }
    }

    fn without_columns(&self) -> Error {
        let hint =
            "a table has at least two columns, separated by commas, semicolons, tabs or blanks";
        self.refuse(0..0, "there are no columns in this file", hint)
    }

    /// Reads a text whose columns have a known separator.
    fn separated(name: &str, text: String, delimiter: u8, part: TextPart) -> Result<Self, Error> {
        let mut table = Self::empty(name, text.clone(), delimiter);
        let faults = Faults::default();
        table.read_records(&text, &part(&table), &faults);
        faults.finish()?;
        if table.columns.len() == 1 {
            Err(table.without_columns())
        } else if table.rows.is_empty() {
            Err(table.refuse(
                0..0,
                "there are no rows of numbers",
                "a table has a header line of names with units, and rows of numbers",
            ))
        } else {
            table.settle();
            Ok(table)
        }
    }

    pub(super) fn records<'a>(&self, text: &'a str) -> csv::Reader<&'a [u8]> {
        csv::ReaderBuilder::new()
            .delimiter(self.delimiter)
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes())
    }

    fn read_records(&mut self, text: &str, part: &Range<usize>, faults: &Faults) {
        let mut surveyed = self.records(text);
        let first = surveyed.records().map_while(Result::ok);
        let first = first.filter(|record| !record.iter().all(str::is_empty));
        let fields = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
        let first: Vec<Vec<String>> = first.map(fields).take(SURVEYED).collect();
        let above = Above::of(&first);
        let mut decimals = Decimals::default();
        let mut line = 0;
        for record in self.records(text).records() {
            let record = match record {
                Ok(record) => record,
                Err(cause) => {
                    return faults.push(self.fault(0..0, cause.to_string(), "correct this line"));
                }
            };
            if record.iter().all(str::is_empty) {
                continue;
            }
            let position = line_at(text, record.position().map_or(0, |at| at.byte() as usize));
            if Some(line) == above.names {
                self.columns = record.iter().map(Column::new).collect();
                self.columns_place = position;
            } else if Some(line) == above.units {
                self.add_units(&record);
            } else if line >= above.first_row && part.contains(&position.start) {
                self.add_row(&record, position, &mut decimals, faults);
            } else if line >= above.first_row {
                self.add_unread_row(record.len(), position);
            }
            line += 1;
        }
        if decimals.are_ambiguous() {
            let hint = "write 1050 or 1.0500 instead of 1,050 or 1.050, whichever is meant";
            let message = "points or commas may mark decimals or group thousands in this file";
            faults.push(self.fault(0..0, message, hint));
        }
    }

    /// The units of a line below the names, for columns that have none.
    fn add_units(&mut self, record: &csv::StringRecord) {
        for (column, field) in self.columns.iter_mut().zip(record) {
            let unit = unquoted(field).trim_matches(['(', ')', '[', ']', ' ']);
            if !unit.is_empty() {
                column.add_unit(unit);
            }
        }
    }

    fn add_row(
        &mut self,
        record: &csv::StringRecord,
        position: Range<usize>,
        decimals: &mut Decimals,
        faults: &Faults,
    ) {
        // A separator behind the last field, as some programs write, does not begin another column.
        let known = self.columns.len();
        let outside = record
            .iter()
            .skip(known)
            .all(|field| field.trim().is_empty());
        let count = if known > 0 && outside {
            record.len().min(known)
        } else {
            record.len()
        };
        if self.columns.is_empty() {
            self.columns = vec![Column::default(); count];
        }
        let columns = self.columns.len();
        if count != columns {
            let message = format!("{count} fields, but the header has {columns} columns");
            let hint = "every row needs as many fields as the header; numbers with decimal commas need semicolons or tabs \
                        between the columns, and lines above the header must begin with #";
            return faults.push(self.fault(position, message, hint));
        }
        self.faults.resize(count, None);
        self.nonsense.resize(count, None);
        let fields = record.iter().take(count).enumerate();
        let row = fields
            .map(|(column, field)| self.read_field(column, unquoted(field), decimals))
            .collect();
        self.rows.push((row, position));
    }

    /// The number in a field of the next row, NaN where it is none; a column of clock times is in s.
    fn read_field(&mut self, column: usize, field: &str, decimals: &mut Decimals) -> f64 {
        match decimals.read(column, field) {
            Ok(value) => {
                if is_clock_time(field) {
                    self.columns[column].unit = Some("s".to_owned());
                }
                value
            }
            Err(reason) => {
                let fault = (self.rows.len(), reason);
                if !is_hole(field) {
                    self.nonsense[column].get_or_insert(fault.clone());
                }
                self.faults[column].get_or_insert(fault);
                f64::NAN
            }
        }
    }

    /// The table with some of its rows, in the order of `kept`, including all whose fields are nonsense.
    pub fn with_rows(&self, kept: &[usize]) -> Self {
        let lacks = |i: usize| kept.iter().position(|row| self.rows[*row].0[i].is_nan());
        let first = |(i, fault): (usize, &FieldFault)| Some((lacks(i)?, fault.clone()?.1));
        let again = |fault: &FieldFault| {
            let (row, reason) = fault.clone()?;
            Some((kept.iter().position(|kept| *kept == row)?, reason))
        };
        Self {
            source: Arc::clone(&self.source),
            columns: self.columns.clone(),
            columns_place: self.columns_place.clone(),
            part: self.part.clone(),
            rows: kept.iter().map(|row| self.rows[*row].clone()).collect(),
            faults: self.faults.iter().enumerate().map(first).collect(),
            nonsense: self.nonsense.iter().map(again).collect(),
            ..*self
        }
    }

    /// The text of a field, as it is written in the file.
    pub fn field(&self, row: usize, column: usize) -> Option<String> {
        let text = &self.source.text[self.rows[row].1.clone()];
        let record = self.records(text).records().next()?.ok()?;
        record.get(column).map(|field| unquoted(field).to_owned())
    }

    /// The first column with this name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// Checks that all fields of some columns are numbers.
    ///
    /// # Errors
    /// The first field of each column that is not one.
    pub fn check_numbers(
        &self,
        columns: impl IntoIterator<Item = usize>,
        hint: &str,
    ) -> Result<(), Error> {
        self.check(&self.faults, columns, hint)
    }

    /// Checks that all fields of some columns are numbers or holes in the data: empty, or NaN.
    ///
    /// # Errors
    /// The first field of each column that is neither.
    pub fn check_numbers_or_holes(
        &self,
        columns: impl IntoIterator<Item = usize>,
        hint: &str,
    ) -> Result<(), Error> {
        self.check(&self.nonsense, columns, hint)
    }

    fn check(
        &self,
        faults: &[FieldFault],
        columns: impl IntoIterator<Item = usize>,
        hint: &str,
    ) -> Result<(), Error> {
        let first = |column: usize| {
            let (row, reason) = faults[column].as_ref()?;
            let name = match &*self.columns[column].name {
                "" => String::new(),
                name => format!("column `{name}`: "),
            };
            Some(self.fault(self.rows[*row].1.clone(), format!("{name}{reason}"), hint))
        };
        Error::refuse(columns.into_iter().filter_map(first).collect())
    }

    /// A fault at a place of the file.
    pub fn fault(
        &self,
        position: Range<usize>,
        message: impl Into<String>,
        hint: &str,
    ) -> Diagnostic {
        Diagnostic::error("", message)
            .hint(hint)
            .at(&self.source, position)
    }

    /// The refusal of the file for one fault.
    pub fn refuse(&self, position: Range<usize>, message: impl Into<String>, hint: &str) -> Error {
        self.fault(position, message, hint).into()
    }

    /// The refusal of the file because of its names of columns.
    pub fn refuse_columns(&self, message: impl Into<String>, hint: &str) -> Error {
        self.refuse(self.columns_place.clone(), message, hint)
    }
}

mod parts;

#[cfg(test)]
mod dialects;
#[cfg(test)]
mod tests;
