//! An array of numbers, and its text as a table.

/// An array of numbers with its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Its name; empty where the file has one array alone.
    pub name: String,
    /// The names of the numbers of an entry; none of plain numbers.
    pub fields: Vec<String>,
    /// The numbers of entries along each index.
    pub shape: Vec<usize>,
    /// The numbers: the fields of an entry are adjacent, and the last index changes fastest.
    pub numbers: Vec<f64>,
}

impl Array {
    /// Rows and columns, where this is a table: a vector is none.
    pub fn size(&self) -> Option<[usize; 2]> {
        match (self.shape[..].as_ref(), self.fields.len()) {
            ([rows, columns], 0) if *rows > 1 && *columns > 1 => Some([*rows, *columns]),
            ([rows], 2..) => Some([*rows, self.fields.len()]),
            _ => None,
        }
    }

    /// Whether it may be one of several columns of a table: more than one plain number.
    pub fn is_column(&self) -> bool {
        self.fields.is_empty() && self.numbers.len() > 1
    }

    /// Its numbers in lines of so many, below its names.
    pub fn table(&self, [_, columns]: [usize; 2]) -> String {
        let mut text = self.fields.join("\t");
        text.push('\n');
        for row in self.numbers.chunks(columns) {
            push_row(&mut text, row.iter().copied());
        }
        text
    }

    /// Its name and its shape in words.
    pub fn describe(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(usize::to_string).collect();
        format!("{} ({})", self.name, sizes.join(" × "))
    }
}

/// Adds a line of numbers.
pub fn push_row(text: &mut String, row: impl Iterator<Item = f64>) {
    for (column, number) in row.enumerate() {
        text.push_str(if column > 0 { "\t" } else { "" });
        text.push_str(&number.to_string());
    }
    text.push('\n');
}
