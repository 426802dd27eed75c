//! Parts of a report.

/// A part of a report.
#[derive(Clone, Debug)]
pub enum Block {
    /// A heading of the given level, 1 to 3.
    Heading(u8, String),
    /// Running text.
    Paragraph(String),
    /// A table: heads with units, and rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// The picture of this index, with its caption.
    Figure(usize, String),
    /// Text shown as it is.
    Code(String),
}

impl Block {
    /// A table with these heads.
    pub fn table(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        let head = head.iter().map(|cell| (*cell).to_owned()).collect();
        Self::Table(head, rows.into_iter().collect())
    }
}

/// A picture and its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name.
    pub name: String,
    /// What it shows, in one sentence.
    pub caption: String,
    /// The picture.
    pub png: Vec<u8>,
}

impl Figure {
    /// A picture with its file name and caption.
    pub fn new(name: &str, caption: &str, png: Vec<u8>) -> Self {
        Self {
            name: name.to_owned(),
            caption: caption.to_owned(),
            png,
        }
    }
}
