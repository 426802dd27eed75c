//! What was read of a table: columns, units and rows.

use std::ops::Range;

use super::choice::unit;
use super::columns::area;
use super::roles::{DISPLACEMENT, FORCE, Kind, Role, of_kind};
use crate::document::{Column, Head};
use crate::units::Dimension;

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
    /// What some roles say, and the rows that are fitted.
    pub fn of(head: &Head, roles: &[Role], rows: &Range<usize>) -> Self {
        let mut found = Self::default();
        for kind in [Kind::Strain, Kind::Stress, Kind::Time, Kind::Other] {
            for (index, role) in of_kind(roles, kind) {
                let column = &head.table.columns[index];
                let name = match column.written.is_empty() {
                    true => format!("column {}", index + 1),
                    false => format!("`{}`", column.written),
                };
                match kind {
                    Kind::Other => found.unread.push(name),
                    _ => found
                        .columns
                        .push(ColumnReading::of(head, (column, name), role)),
                }
            }
        }
        let line = |row: usize| {
            let (_, place) = &head.table.rows[row.min(head.table.rows.len() - 1)];
            head.table.source.line(place.start)
        };
        found.lines = [line(rows.start), line(rows.end.saturating_sub(1))];
        found
    }

    /// The same in a sentence.
    pub fn sentence(&self) -> String {
        let columns = self.columns.iter().map(|own| {
            let ColumnReading {
                quantity,
                column,
                unit,
                divided_by,
            } = own;
            match divided_by.is_empty() {
                true => format!("{quantity} from {column} [{unit}]"),
                false => format!("{quantity} from {column} [{unit}] over {divided_by}"),
            }
        });
        let columns: Vec<_> = columns.collect();
        let [first, last] = self.lines;
        let unread = match self.unread.is_empty() {
            true => String::new(),
            false => format!("; not read: {}", self.unread.join(", ")),
        };
        format!("{}; lines {first} to {last}{unread}", columns.join(", "))
    }
}

impl ColumnReading {
    fn of(head: &Head, (column, name): (&Column, String), role: &Role) -> Self {
        let key = format!("{} measure", role.kind.name());
        let said = || head.setting(&key, None).ok().flatten();
        let measure = role.measure.map(str::to_owned).or_else(said);
        let measure = measure.unwrap_or_default();
        let length = || head.quantity("length", Dimension::Length).ok().flatten();
        let divided_by = match &*measure {
            DISPLACEMENT => length().map(|length| format!("{length} mm")),
            FORCE => area(head).ok().map(|area| format!("{area} mm²")),
            _ => None,
        };
        let quantity = match (&*measure, role.kind) {
            (_, Kind::Time) => "time".to_owned(),
            (DISPLACEMENT | FORCE | "stretch", _) => measure,
            ("cauchy", kind) => format!("Cauchy {}", kind.name()),
            (measure, kind) => format!("{measure} {}", kind.name()),
        };
        let axis = match role.numbered {
            Some(axis) => format!(" along axis {}", axis + 1),
            None => String::new(),
        };
        Self {
            quantity: format!("{quantity}{axis}"),
            column: name,
            unit: unit(head, column, role.kind).unwrap_or_else(|| "-".to_owned()),
            divided_by: divided_by.unwrap_or_default(),
        }
    }
}
