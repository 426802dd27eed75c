//! Quantities over time as a table.

use std::fmt::Write;

/// A quantity at all instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name, such as `grip force, corrected`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// One number an instant.
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
    let quoted = |head: String| match head.contains([',', '"']) {
        true => format!("\"{}\"", head.replace('"', "\"\"")),
        false => head,
    };
    let mut text = String::from("time [s]");
    for one in series {
        text += ",";
        text += &quoted(one.head());
    }
    text.push('\n');
    for (instant, time) in times.iter().enumerate() {
        text += &time.to_string();
        for one in series {
            let _ = match one.values[instant] {
                small if small != 0.0 && small.abs() < 1e-5 => write!(text, ",{small:e}"),
                value => write!(text, ",{value}"),
            };
        }
        text.push('\n');
    }
    text
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
