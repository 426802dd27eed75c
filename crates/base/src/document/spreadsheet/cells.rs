//! The cells of a sheet as lines of fields.

use super::super::converted::{Unconvertible, afford};
use super::workbook::Workbook;
use super::xml::{Met, attribute, damaged, walk};
use quick_xml::events::BytesStart;

/// Rows and columns of the largest sheet that there can be.
const LARGEST: [usize; 2] = [1 << 20, 1 << 14];

/// A cell that is not empty.
struct Cell {
    row: usize,
    column: usize,
    text: String,
}

/// The text of a sheet: a line a row, with tabs between the columns from the first to the last that is not empty.
///
/// # Errors
/// [`Unconvertible`] where the sheet is damaged or too large.
pub fn text(xml: &str, workbook: &Workbook) -> Result<String, Unconvertible> {
    let mut reader = CellReader::new(workbook);
    walk(xml, |met| reader.on(met))?;
    let mut cells = reader.cells;
    cells.sort_by_key(|cell| (cell.row, cell.column));
    lines(&cells)
}

/// Lines above the first row that reaches the last column, such as titles, end at their last field; empty fields of rows
/// below are missing numbers.
fn lines(cells: &[Cell]) -> Result<String, Unconvertible> {
    let columns = || cells.iter().map(|cell| cell.column);
    let (Some(first), Some(last)) = (columns().min(), columns().max()) else {
        return Ok(String::new());
    };
    let filled = |cell: &&Cell| cell.column == last;
    let first_full = cells.iter().find(filled).map_or(0, |cell| cell.row);
    let rows: Vec<&[Cell]> = cells.chunk_by(|a, b| a.row == b.row).collect();
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

/// Reads cell after cell.
struct CellReader<'a> {
    workbook: &'a Workbook,
    cells: Vec<Cell>,
    /// Bytes of the cells' texts, which may be longer than the sheet: many cells may name one text.
    letters: usize,
    /// Where the next cell is that does not say it.
    row: usize,
    column: usize,
    /// Kind and format of the current cell.
    kind: String,
    format: usize,
    text: String,
    is_value: bool,
}

impl<'a> CellReader<'a> {
    fn new(workbook: &'a Workbook) -> Self {
        Self {
            workbook,
            cells: Vec::new(),
            letters: 0,
            row: 0,
            column: 0,
            kind: String::new(),
            format: 0,
            text: String::new(),
            is_value: false,
        }
    }

    fn on(&mut self, met: Met) -> Result<(), Unconvertible> {
        match met {
            Met::Start(tag) => match tag.local_name().as_ref() {
                "row" => self.begin_row(tag),
                "c" => self.begin_cell(tag),
                "v" | "t" => self.is_value = true,
                _ => {}
            },
            Met::Text(text) if self.is_value => self.text.push_str(text),
            Met::End("v" | "t") => self.is_value = false,
            Met::End("c") => return self.end_cell(),
            Met::End("row") => self.row += 1,
            _ => {}
        }
        Ok(())
    }

    fn begin_row(&mut self, tag: &BytesStart) {
        let number = attribute(tag, "r").and_then(|row| row.parse::<usize>().ok());
        self.row = number
            .and_then(|row| row.checked_sub(1))
            .unwrap_or(self.row);
        self.column = 0;
    }

    fn begin_cell(&mut self, tag: &BytesStart) {
        if let Some([row, column]) = attribute(tag, "r").and_then(|name| position(&name)) {
            (self.row, self.column) = (row, column);
        }
        self.kind = attribute(tag, "t").unwrap_or_default();
        let format = attribute(tag, "s").and_then(|format| format.parse().ok());
        self.format = format.unwrap_or(0);
        self.text.clear();
    }

    fn end_cell(&mut self) -> Result<(), Unconvertible> {
        let [row, column] = [self.row, self.column];
        self.column += 1;
        if row >= LARGEST[0] || column >= LARGEST[1] {
            return Err(damaged("a cell lies outside of any sheet"));
        }
        let text = std::mem::take(&mut self.text);
        let text = match &*self.kind {
            "s" => {
                let text = text
                    .trim()
                    .parse()
                    .ok()
                    .and_then(|number: usize| self.workbook.texts.get(number));
                text.ok_or_else(|| damaged("a cell names a text that is not there"))?
                    .clone()
            }
            // A line that begins with # is a remark; so would be that of an error such as #DIV/0!.
            "e" => "NaN".to_owned(),
            "" | "n" if self.workbook.dates.contains(&self.format) && !text.is_empty() => {
                format!("{text} days (a date or a time of day)")
            }
            _ => text,
        };
        let text = text.replace(['\t', '\n', '\r'], " ").replace('"', "'");
        self.letters += text.len();
        afford(self.letters as f64, self.cells.len() as f64)?;
        if !text.trim().is_empty() {
            self.cells.push(Cell { row, column, text });
        }
        Ok(())
    }
}

/// Row and column, from 0 on, of a name such as `AB12`.
fn position(name: &str) -> Option<[usize; 2]> {
    let digits = name.trim_start_matches(|letter: char| letter.is_ascii_uppercase());
    let letters = name[..name.len() - digits.len()].bytes();
    let column = letters.fold(0_usize, |column, letter| {
        column
            .saturating_mul(26)
            .saturating_add(usize::from(letter - b'A') + 1)
    });
    let row: usize = digits.parse().ok()?;
    Some([row.checked_sub(1)?, column.checked_sub(1)?])
}

#[cfg(test)]
mod tests;
