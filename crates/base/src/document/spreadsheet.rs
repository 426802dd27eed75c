//! Sheets of a workbook (Office Open XML, `.xlsx`) as texts of tables: the values that its cells had when it was saved.
//!
//! Each row of a sheet is a line, so that messages name the rows that the user sees. Errors of formulas are missing
//! numbers; dates and times of day are no numbers.

use std::io::Cursor;

use calamine::{Cell, DataRef, Reader, SheetType, Xlsx, XlsxError};

use super::archive::Archive;
use super::converted::{TableText, Unconvertible, afford};
use crate::error::suggestion;

/// What to do with a damaged workbook.
const AGAIN: &str = "save it again, or save the sheet as .csv";

/// Rows and columns of the largest sheet that there can be.
const LARGEST: [usize; 2] = [1 << 20, 1 << 14];

/// The sheets of a workbook that was checked in their order, or the one with a name.
///
/// # Errors
/// [`Unconvertible`] where there is no sheet of this name, or a part is damaged or too large.
pub(super) fn tables(bytes: &[u8], part: Option<&str>) -> Result<Vec<TableText>, Unconvertible> {
    let mut workbook = Xlsx::new(Cursor::new(bytes)).map_err(damaged)?;
    let sheets = workbook.sheets_metadata().iter();
    let sheets = sheets.filter(|sheet| sheet.typ == SheetType::WorkSheet);
    let mut names: Vec<String> = sheets.map(|sheet| sheet.name.clone()).collect();
    if let Some(part) = part {
        if !names.iter().any(|name| name == part) {
            let known: Vec<&str> = names.iter().map(String::as_str).collect();
            return Err(Unconvertible::new(
                format!("has no sheet `{part}`"),
                suggestion(part, &known, "its sheets:"),
            ));
        }
        names = vec![part.to_owned()];
    }
    let texts = names.into_iter().map(|name| {
        Ok(TableText {
            text: text(&mut workbook, &name)?,
            name: Some(name),
        })
    });
    texts.collect()
}

/// Unpacks all parts once: each is as large as the archive states and has room, and so have the texts whose number a part states, for
/// which room is made before they are read.
///
/// # Errors
/// [`Unconvertible`] where one is damaged or too large.
pub(super) fn check(archive: &mut Archive) -> Result<(), Unconvertible> {
    for name in archive.names() {
        let part = archive.read(&name)?;
        let text = String::from_utf8_lossy(&part);
        for (_, after) in text
            .match_indices("uniqueCount")
            .map(|(at, key)| text.split_at(at + key.len()))
        {
            let value = after.trim_start_matches(|letter: char| !letter.is_ascii_digit());
            let digits = value.bytes().take_while(u8::is_ascii_digit);
            let count = digits.fold(0.0, |count, digit| 10.0 * count + f64::from(digit - b'0'));
            if count > part.len() as f64 {
                let message = format!("is a damaged workbook: {name} cannot hold {count} texts");
                return Err(Unconvertible::new(message, AGAIN));
            }
        }
    }
    Ok(())
}

/// The fault of a workbook that is damaged.
fn damaged(cause: XlsxError) -> Unconvertible {
    Unconvertible::new(format!("is a damaged workbook: {cause}"), AGAIN)
}

/// A cell that is not empty.
struct Filled {
    row: usize,
    column: usize,
    text: String,
}

/// The text of a sheet: a line a row, with tabs between the columns from the first to the last that is not empty.
fn text(workbook: &mut Xlsx<Cursor<&[u8]>>, sheet: &str) -> Result<String, Unconvertible> {
    let mut reader = workbook.worksheet_cells_reader(sheet).map_err(damaged)?;
    let mut cells = Vec::new();
    // Cells' texts may be longer than the sheet: many cells may name one text.
    let mut letters = 0;
    while let Some(cell) = reader.next_cell().map_err(damaged)? {
        let text = field(&cell);
        letters += text.len();
        afford(letters as f64, cells.len() as f64)?;
        if !text.trim().is_empty() {
            let (row, column) = cell.get_position();
            let (row, column) = (row as usize, column as usize);
            if row >= LARGEST[0] {
                return Err(damaged(XlsxError::RowNumberOverflow));
            }
            if column >= LARGEST[1] {
                return Err(damaged(XlsxError::ColumnNumberOverflow));
            }
            cells.push(Filled { row, column, text });
        }
    }
    cells.sort_by_key(|cell| (cell.row, cell.column));
    lines(&cells)
}

/// A cell as a field of a table.
fn field(cell: &Cell<DataRef>) -> String {
    let text = match cell.get_value() {
        DataRef::Empty => String::new(),
        DataRef::Int(number) => number.to_string(),
        DataRef::Float(number) => number.to_string(),
        DataRef::Bool(flag) => u8::from(*flag).to_string(),
        DataRef::DateTime(days) => format!("{} days (a date or a time of day)", days.as_f64()),
        // A line that begins with # is a remark; so would be that of an error such as #DIV/0!.
        DataRef::Error(_) => "NaN".to_owned(),
        DataRef::SharedString(text) => (*text).to_owned(),
        DataRef::String(text) | DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => {
            text.clone()
        }
    };
    text.replace(['\t', '\n', '\r'], " ").replace('"', "'")
}

/// Lines above the first row that reaches the last column, such as titles, end at their last field; empty fields of rows
/// below are missing numbers.
fn lines(cells: &[Filled]) -> Result<String, Unconvertible> {
    let columns = || cells.iter().map(|cell| cell.column);
    let (Some(first), Some(last)) = (columns().min(), columns().max()) else {
        return Ok(String::new());
    };
    let filled = |cell: &&Filled| cell.column == last;
    let first_full = cells.iter().find(filled).map_or(0, |cell| cell.row);
    let rows: Vec<&[Filled]> = cells.chunk_by(|a, b| a.row == b.row).collect();
    let letters: usize = cells.iter().map(|cell| cell.text.len()).sum();
    afford(letters as f64, (rows.len() * (last - first + 1)) as f64)?;
    let mut text = String::new();
    let mut line = 0;
    for row in rows {
        text.extend(std::iter::repeat_n('\n', row[0].row - line));
        line = row[0].row;
        let mut column = first;
        for cell in row {
            text.extend(std::iter::repeat_n(
                '\t',
                cell.column.saturating_sub(column),
            ));
            column = cell.column;
            text.push_str(&cell.text);
        }
        if line >= first_full {
            text.extend(std::iter::repeat_n('\t', last - column));
        }
    }
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests;
