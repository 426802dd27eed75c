//! What was read of a table: columns, units and rows.

/// The columns and rows of a file that the data of a test are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableReading {
    /// The columns that were read.
    pub columns: Vec<ColumnReading>,
    /// The names of the others.
    pub unread: Vec<String>,
    /// The first and the last line of the rows that are fitted.
    pub lines: [usize; 2],
}

/// A column that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnReading {
    /// What it was read as, such as `nominal stress` or `force along axis 2`.
    pub quantity: String,
    /// Its name in the file, or its number.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// The dimension of the specimen that it was divided by; empty where it was taken as it is.
    pub divided_by: String,
}

impl TableReading {
    /// What was read, in a sentence.
    pub fn sentence(&self) -> String {
        let columns = self.columns.iter().map(|reading| {
            let ColumnReading {
                quantity,
                column,
                unit,
                divided_by,
            } = reading;
            if divided_by.is_empty() {
                format!("{quantity} from {column} [{unit}]")
            } else {
                format!("{quantity} from {column} [{unit}] over {divided_by}")
            }
        });
        let columns: Vec<_> = columns.collect();
        let [first, last] = self.lines;
        let unread = if self.unread.is_empty() {
            String::new()
        } else {
            format!("; not read: {}", self.unread.join(", "))
        };
        format!("{}; lines {first} to {last}{unread}", columns.join(", "))
    }
}
