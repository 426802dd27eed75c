//! Parts of a report.

use serde::{Deserialize, Serialize};

use super::Drawing;
use crate::document::stored::{StaticText, static_text};
use crate::document::write_records;

/// A part of a report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Block {
    /// A heading of the given level, 1 to 3.
    Heading(u8, String),
    /// Running text.
    Paragraph(String),
    /// A table: heads with units, and rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// The picture of this index, with its caption.
    Figure(usize, String),
    /// Text in a language, such as `toml`, shown as it is.
    Code(
        #[serde(deserialize_with = "static_text")] StaticText,
        String,
    ),
}

impl Block {
    /// A heading of the second level.
    pub fn heading(text: impl Into<String>) -> Self {
        Self::Heading(2, text.into())
    }

    /// Running text.
    pub fn paragraph(text: impl Into<String>) -> Self {
        Self::Paragraph(text.into())
    }

    /// A table with these heads.
    pub fn table(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        let head = head.iter().map(|cell| (*cell).to_owned()).collect();
        Self::Table(head, rows.into_iter().collect())
    }

    /// The block as text for a terminal; empty for a picture.
    pub fn plain(&self) -> String {
        match self {
            Self::Paragraph(text) => broken(text, LINE).join("\n") + "\n",
            Self::Heading(_, text) | Self::Code(_, text) => format!("{text}\n"),
            Self::Figure(..) => String::new(),
            Self::Table(head, rows) => plain_table(head, rows),
        }
    }
}

/// A table that is built column by column, each head together with the cells below it.
pub struct Table<T> {
    rows: Vec<T>,
    head: Vec<String>,
    cells: Vec<Vec<String>>,
}

impl<T> Table<T> {
    /// A table with a row for each item, and no column yet.
    pub fn of(rows: impl IntoIterator<Item = T>) -> Self {
        let rows: Vec<T> = rows.into_iter().collect();
        Self {
            cells: vec![Vec::new(); rows.len()],
            head: Vec::new(),
            rows,
        }
    }

    /// Adds a column.
    #[must_use]
    pub fn column(mut self, head: impl Into<String>, cell: impl Fn(&T) -> String) -> Self {
        self.head.push(head.into());
        for (cells, row) in self.cells.iter_mut().zip(&self.rows) {
            cells.push(cell(row));
        }
        self
    }

    /// Adds a column where it is wanted.
    #[must_use]
    pub fn column_if(
        self,
        wanted: bool,
        head: impl Into<String>,
        cell: impl Fn(&T) -> String,
    ) -> Self {
        if wanted {
            self.column(head, cell)
        } else {
            self
        }
    }

    /// Whether it has no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table as a part of a report.
    pub fn block(self) -> Block {
        Block::Table(self.head, self.cells)
    }

    /// The table for other programs, with commas between its fields.
    pub fn csv(self) -> String {
        write_records(std::iter::once(self.head).chain(self.cells))
    }
}

/// Characters in a line of a paragraph at most.
const LINE: usize = 96;

/// Characters in a line of a head at most, unless its column is wider.
const HEAD: usize = 14;

/// A table in columns that are two spaces apart, figures and their heads on the right.
fn plain_table(head: &[String], rows: &[Vec<String>]) -> String {
    let head = head_rows(head, rows);
    let all = || head.iter().chain(rows);
    let is_figure = |cell: &String| cell == "–" || cell.parse::<f64>().is_ok();
    let columns = 0..head.first().map_or(0, Vec::len);
    let widths: Vec<(usize, bool)> = columns
        .map(|column| {
            let is_of_figures = rows.iter().all(|row| is_figure(&row[column]));
            (column_width(all(), column), is_of_figures)
        })
        .collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths);
        let cells = cells.map(|(cell, (width, is_of_figures))| {
            if *is_of_figures {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        format!("{}\n", line.trim_end())
    };
    all().map(line).collect()
}

/// The most characters of a column of some rows.
fn column_width<'a>(rows: impl Iterator<Item = &'a Vec<String>>, column: usize) -> usize {
    let widths = rows.map(|row| row[column].chars().count());
    widths.max().unwrap_or(0)
}

/// The heads of a table broken into rows that end together above its first row.
fn head_rows(head: &[String], rows: &[Vec<String>]) -> Vec<Vec<String>> {
    let broken_head = |(column, head): (usize, &String)| {
        broken(head, HEAD.max(column_width(rows.iter(), column)))
    };
    let heads: Vec<Vec<String>> = head.iter().enumerate().map(broken_head).collect();
    let count = heads.iter().map(Vec::len).max().unwrap_or(0);
    let part = |parts: &Vec<String>, row: usize| {
        let index = (row + parts.len()).checked_sub(count);
        index.map_or(String::new(), |index| parts[index].clone())
    };
    let row = |row: usize| heads.iter().map(|parts| part(parts, row)).collect();
    (0..count).map(row).collect()
}

/// A text in lines of at most `width` characters, broken between words.
fn broken(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                *line += " ";
                *line += word;
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The content of a file beside a report.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A table or another text.
    Text(String),
    /// A picture.
    Picture(Drawing),
}

/// A picture and its caption.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Figure {
    /// File name.
    pub name: String,
    /// Its content in one sentence.
    pub caption: String,
    /// The picture.
    pub drawing: Drawing,
}

impl Figure {
    /// A picture with its file name and caption.
    pub fn new(
        name: impl Into<String>,
        caption: impl Into<String>,
        drawing: impl Into<Drawing>,
    ) -> Self {
        Self {
            name: name.into(),
            caption: caption.into(),
            drawing: drawing.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_for_a_terminal_has_broken_heads_and_figures_on_the_right() {
        let rows = [["5", "left", "–"], ["10", "right", "12.5"]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        let table = Block::table(&["at", "group", "displacement along x [mm]"], rows);
        let lines: Vec<String> = table.plain().lines().map(str::to_owned).collect();
        assert_eq!(lines[0], "           displacement");
        assert_eq!(lines[1], "at  group  along x [mm]");
        assert_eq!(lines[2], " 5  left              –");
        assert_eq!(lines[3], "10  right          12.5");
    }
}
