//! What can only be decided about the columns once all rows are read.

use std::ops::Range;

use super::super::columns::Column;
use super::super::decimals::NotANumber;
use super::super::lines::{are_quantities, names_in_remark, remark_above};
use super::Table;

impl Table {
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
