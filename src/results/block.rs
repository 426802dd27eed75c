//! Parts of a report.

use serde::{Deserialize, Serialize};

use super::Drawing;
use crate::document::stored::{StaticText, static_text};

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
