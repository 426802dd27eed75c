//! The precision with which the numbers of a table are written.

use super::Table;
use super::columns::unquoted;
use super::lines::line_at;

/// The digits of a number as written in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Number of digits from the first one that is not zero to the last one, including zeros at the end; 0 for zero.
    pub digits: i32,
    /// Number of digits behind the point or the comma, less the power of ten.
    pub decimals: i32,
}

impl Written {
    /// The digits of a field; `None` where it is not a number.
    pub fn of(field: &str) -> Option<Self> {
        /// Beyond this power numbers are zero, or infinite.
        const POWER: i32 = 400;
        let (mantissa, power) = field.split_once(['e', 'E']).unwrap_or((field, "0"));
        let power: i32 = power.parse().ok()?;
        let (_, behind) = mantissa.split_once(['.', ',']).unwrap_or((mantissa, ""));
        let digits = || mantissa.chars().filter(char::is_ascii_digit);
        digits().next()?;
        let count = |count: usize| i32::try_from(count).unwrap_or(i32::MAX / 4);
        Some(Self {
            digits: count(digits().skip_while(|digit| *digit == '0').count()),
            decimals: count(behind.len()) - power.clamp(-POWER, POWER),
        })
    }

    /// n of the first digit that is not zero, whose place is 10ⁿ.
    pub fn exponent(self) -> i32 {
        self.digits - 1 - self.decimals
    }
}

impl Table {
    /// The precision of a column in each row, as written in the file; `None` where a field is not a number.
    pub fn written(&self, column: usize) -> Vec<Option<Written>> {
        let text = &self.source.text;
        let start = |row: &usize| self.rows[*row].1.start;
        // Rows may be in another order than that of the file.
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.sort_by_key(start);
        let mut order = order.iter().peekable();
        let mut result = vec![None; self.rows.len()];
        for record in self.records(text).records().map_while(Result::ok) {
            let from = record.position().map_or(0, |at| at.byte() as usize);
            let begins = line_at(text, from).start;
            if let Some(row) = order.next_if(|row| start(row) == begins) {
                let field = record.get(column).map(unquoted);
                result[*row] = field.and_then(Written::of);
            }
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_of_the_file() {
        let of = |field| Written::of(field).map(|result| (result.digits, result.decimals));
        for (field, digits, decimals) in [
            ("1.100000", 7, 6),
            ("-0,0250", 3, 4),
            ("+12.50e-3", 4, 5),
            ("1e2", 1, -2),
            ("150", 3, 0),
            ("0.000", 0, 3),
        ] {
            assert_eq!(of(field), Some((digits, decimals)), "{field}");
        }
        assert_eq!(of("nan"), None);
        assert_eq!(of(""), None);
        assert_eq!(Written::of("12.50e-3").unwrap().exponent(), -2);
    }

    #[test]
    fn columns_are_found_behind_heads_units_and_remarks() {
        let text = "# test: uniaxial\n\"a\";\"b\"\n(-);(MPa)\n\n1,10;\"0,5\"\n# pause\n1,2;\n";
        let table = Table::parse("a.csv", text).unwrap();
        let decimals = |column| -> Vec<Option<i32>> {
            let result = table.written(column).into_iter();
            result.map(|one| one.map(|one| one.decimals)).collect()
        };
        assert_eq!(decimals(0), [Some(2), Some(1)]);
        assert_eq!(decimals(1), [Some(1), None]);
    }
}
