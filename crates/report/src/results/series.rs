//! Quantities over time as a table.

use crate::document::write_records;

/// A quantity at all instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name, such as `grip force, corrected`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// One number per instant.
    pub values: Vec<f64>,
}

impl Series {
    /// A named quantity.
    pub fn new(name: &str, unit: &str, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
        }
    }

    fn head(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }
}

/// Instants in s with their quantities as a CSV table, units in its heads. `gelbench identify` reads one with the
/// columns `extension` and `force`.
pub fn csv(times: &[f64], series: &[Series]) -> String {
    let first = "time [s]".to_owned();
    let head = std::iter::once(first).chain(series.iter().map(Series::head));
    let line = |(instant, time): (usize, &f64)| {
        let values = series.iter().map(|one| written(one.values[instant]));
        std::iter::once(time.to_string()).chain(values).collect()
    };
    let lines = times.iter().enumerate().map(line);
    write_records(std::iter::once(head.collect()).chain(lines))
}

/// A number with all its digits; small ones with an exponent.
fn written(value: f64) -> String {
    match value {
        small if small != 0.0 && small.abs() < 1e-5 => format!("{small:e}"),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Table;

    #[test]
    fn a_table_of_probes_is_read_back() {
        let series = [
            Series::new("extension", "mm", vec![0.0, 0.5]),
            Series::new("force, corrected", "N", vec![-1e-7, 2.5]),
        ];
        let text = csv(&[0.0, 0.1], &series);
        let table = Table::parse("probes.csv", &text).unwrap();
        assert_eq!(table.columns[2].name, "force,_corrected");
        assert_eq!(table.columns[1].unit.as_deref(), Some("mm"));
        assert_eq!(table.rows[0].0, [0.0, 0.0, -1e-7]);
        assert_eq!(table.rows[1].0, [0.1, 0.5, 2.5]);
    }
}
