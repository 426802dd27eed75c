//! The resolution with which the numbers of a column were written, and whether it indicates their rounding.
//!
//! ```text
//! s = 10⁻ᵈ     the last digit that the column has,   ρ² = mean of s²/12
//! ```
//!
//! Trailing zeros count where the file has them. A strain that was commanded to the machine is exact, however few digits it is written
//! with: such a column is not rounded, see [`WrittenColumn::is_commanded`].

use crate::document::{Table, Written};

/// A column of a table with the distance of the numbers that could have been written.
pub struct WrittenColumn {
    values: Vec<f64>,
    steps: Vec<f64>,
}

impl WrittenColumn {
    /// Some rows of a column; its digits are those of all rows.
    pub fn of(table: &Table, column: usize, rows: &[usize]) -> Self {
        let steps = steps(&table.written(column));
        Self {
            values: rows.iter().map(|row| table.rows[*row].0[column]).collect(),
            steps: rows.iter().map(|row| steps[*row]).collect(),
        }
    }

    /// The largest distance of the numbers that could have been written.
    pub fn largest_step(&self) -> f64 {
        self.steps.iter().copied().fold(0.0, f64::max)
    }

    /// The root mean square of the possible rounding, after the values are `read` in another measure and unit.
    pub fn rounding(&self, read: &dyn Fn(f64) -> f64) -> f64 {
        let square = |(value, step): (&f64, &f64)| {
            let half = 0.5 * step;
            (read(value + half) - read(value - half)).powi(2) / 12.0
        };
        let squares = self.values.iter().zip(&self.steps).map(square);
        (squares.sum::<f64>() / self.values.len().max(1) as f64).sqrt()
    }

    /// Whether the strains were commanded rather than measured and rounded: their distances are equal, or all are multiples of more than
    /// the last digit, or equal strains recur with `measured` values that both rise and fall. Where these only rise or only fall at equal
    /// strains, the strain changed by less than its last digit.
    pub fn is_commanded(&self, measured: &Self) -> bool {
        /// Numbers of more digits count as exact.
        const MOST: f64 = 1e15;
        let positive = self.steps.iter().copied().filter(|step| *step > 0.0);
        let finest = positive.fold(f64::INFINITY, f64::min);
        let position = |value: &f64| (value / finest).round();
        let positions: Vec<f64> = self.values.iter().map(position).collect();
        if positions.iter().any(|position| position.abs() > MOST) {
            return false;
        }
        let mut rows: Vec<usize> = (0..positions.len()).collect();
        rows.sort_by(|a, b| positions[*a].total_cmp(&positions[*b]));
        let again: Vec<&[usize]> = rows
            .chunk_by(|a, b| positions[*a] == positions[*b])
            .collect();
        let [rises, falls] = measured.rises_and_falls(&again);
        match (rises, falls) {
            (true, true) => true,
            (false, false) => is_regular(again.iter().map(|rows| positions[rows[0]] as i64)),
            _ => false,
        }
    }

    /// Whether values of equal strains rise, and whether they fall, by more than their last digit.
    fn rises_and_falls(&self, again: &[&[usize]]) -> [bool; 2] {
        let pairs = || again.iter().flat_map(|rows| rows.windows(2));
        let change = |pair: &[usize]| {
            let [a, b] = [pair[0], pair[1]];
            let change = self.values[b] - self.values[a];
            if change.abs() > 1.5 * self.steps[a].max(self.steps[b]) {
                change
            } else {
                0.0
            }
        };
        [
            pairs().any(|pair| change(pair) > 0.0),
            pairs().any(|pair| change(pair) < 0.0),
        ]
    }
}

/// Whether ascending numbers follow one another at equal distances, or at multiples of more than one.
fn is_regular(positions: impl Iterator<Item = i64>) -> bool {
    let positions: Vec<i64> = positions.collect();
    let gaps: Vec<i64> = positions.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let divisor = gaps.iter().fold(0, |known, gap| divisor(known, *gap));
    gaps.windows(2).all(|pair| pair[0] == pair[1]) || divisor > 1
}

/// The greatest common divisor.
fn divisor(a: i64, b: i64) -> i64 {
    match b {
        0 => a,
        _ => divisor(b, a % b),
    }
}

/// The distance of the numbers that could stand in each row: those with fewer digits than the others ended in zeros, so that all
/// have as many decimals, or as many significant digits, as the one with the most.
fn steps(column: &[Option<Written>]) -> Vec<f64> {
    let numbers = || column.iter().flatten();
    let most_digits = numbers().map(|one| one.digits).max().unwrap_or(0);
    let most_decimals = numbers().map(|one| one.decimals).max().unwrap_or(0);
    let step = |one: &Option<Written>| {
        let written = one.filter(|one| one.digits > 0);
        let last = written.map_or(-most_decimals, |one| {
            (-most_decimals).max(one.exponent() + 1 - most_digits)
        });
        10f64.powi(last)
    };
    column.iter().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(rows: &[(&str, &str)], column: usize) -> WrittenColumn {
        let rows: Vec<String> = rows.iter().map(|(x, y)| format!("{x};{y}\n")).collect();
        let table = Table::parse("a.csv", &format!("a;b\n{}", rows.concat())).unwrap();
        WrittenColumn::of(&table, column, &(0..rows.len()).collect::<Vec<_>>())
    }

    fn commanded(rows: &[(&str, &str)]) -> bool {
        column(rows, 0).is_commanded(&column(rows, 1))
    }

    /// A rectangle of width w has the standard deviation w/√12.
    #[test]
    fn the_last_decimal_or_digit_tells_what_was_rounded() {
        let width = |values: &[&str]| {
            let rows: Vec<(&str, &str)> = values.iter().map(|one| (*one, "1")).collect();
            column(&rows, 0).rounding(&|value| value) * 12f64.sqrt()
        };
        assert!((width(&["0", "1.2", "12.53", "130.11"]) / 0.01 - 1.0).abs() < 1e-9);
        // Three digits each: 0.001, 0.01 and 0.1.
        let mean = ((1e-6 + 1e-4 + 1e-2) / 3.0_f64).sqrt();
        assert!((width(&["0.123", "1.23", "12.3"]) / mean - 1.0).abs() < 1e-9);
        assert!(width(&["0.3333333333333333", "0.2857142857142857"]) < 1e-15);
        assert!((width(&["1.100000", "1.200000"]) / 1e-6 - 1.0).abs() < 1e-6);
        let unit = column(&[("0.5", "1"), ("0.7", "1")], 0).rounding(&|value| 25.4 * value);
        assert!((unit * 12f64.sqrt() / 2.54 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn strains_that_were_commanded_are_exact() {
        // At equal distances, at multiples of five last digits, and the same ones again with stresses that scatter.
        assert!(commanded(&[
            ("1", "3"),
            ("2", "7"),
            ("3", "9"),
            ("4", "10")
        ]));
        assert!(commanded(&[
            ("5", "3"),
            ("10", "7"),
            ("20", "9"),
            ("50", "10")
        ]));
        let again = [
            ("1.1", "3"),
            ("1.1", "5"),
            ("1.2", "9"),
            ("1.2", "7"),
            ("1.4", "10"),
            ("1.5", "14"),
        ];
        assert!(commanded(&again));
        // Every 1/60 with two decimals, and a strain that rises while its digits stand still.
        assert!(!commanded(&[
            ("1.02", "3"),
            ("1.03", "5"),
            ("1.05", "7"),
            ("1.07", "9")
        ]));
        assert!(!commanded(&[
            ("1.0", "0.3"),
            ("1.0", "0.7"),
            ("1.1", "1.2"),
            ("1.1", "1.6")
        ]));
    }
}
