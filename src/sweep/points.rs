//! Points that another program has chosen.

use std::path::Path;

use super::variable::{MOST_RUNS, Setting, key_and_unit};
use gelbench_base::document::read_records;
use gelbench_base::error::{Diagnostic, Error};

/// Points in place of drawn ones: a table with a column for each key, and a line for each point.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    keys: Vec<String>,
    rows: Vec<Vec<Setting>>,
}

impl Points {
    /// The format of such a table.
    pub const HINT: &str = "column heads are keys, with the unit in brackets: plate.width [mm],material.c10 [MPa]; each line below is a point";

    /// Points from columns, by keys with their units such as `material.c10 [MPa]`.
    ///
    /// # Errors
    /// Without points, with columns of different lengths, or with more than a million points.
    pub fn of_columns(columns: &[(String, Vec<String>)]) -> Result<Self, Diagnostic> {
        let count = columns.first().map_or(0, |(_, values)| values.len());
        if count == 0 {
            return Err(Diagnostic::error("", "there are no points").hint(Points::HINT));
        }
        if let Some((head, values)) = columns.iter().find(|(_, values)| values.len() != count) {
            let message = format!("`{head}` has {} values, others have {count}", values.len());
            return Err(Diagnostic::error("", message).hint(Points::HINT));
        }
        if count > MOST_RUNS {
            return Err(
                Diagnostic::error("", "there are more than a million points")
                    .hint("take fewer, or several sweeps"),
            );
        }
        let columns: Vec<(&str, Vec<Setting>)> = columns
            .iter()
            .map(|(head, values)| column(head, values))
            .collect::<Result<_, _>>()?;
        let row = |index: usize| {
            columns
                .iter()
                .map(|(_, values)| values[index].clone())
                .collect()
        };
        Ok(Self {
            rows: (0..count).map(row).collect(),
            keys: columns.iter().map(|(key, _)| (*key).to_owned()).collect(),
        })
    }

    /// Points from a CSV table.
    ///
    /// # Errors
    /// [`Error::Input`] where it is not one, and the errors of [`Points::of_columns`].
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let named = |fault: Diagnostic| Error::from(fault.prefixed(path.display()));
        let records = read_records(bytes)
            .filter(|records| !records.is_empty())
            .ok_or_else(|| {
                let fault =
                    Diagnostic::error("", "is not a comma-separated table with one line of heads");
                named(fault.hint(Points::HINT))
            })?;
        let (head, lines) = (&records[0], &records[1..]);
        let column = |position: usize| {
            let values = lines.iter().map(|line| line[position].trim().to_owned());
            (head[position].trim().to_owned(), values.collect())
        };
        let columns: Vec<_> = (0..head.len()).map(column).collect();
        Self::of_columns(&columns).map_err(named)
    }

    /// The keys.
    pub fn keys(&self) -> impl Iterator<Item = String> {
        self.keys.iter().cloned()
    }

    /// The values at each point, in the order of the keys.
    pub fn rows(&self) -> &[Vec<Setting>] {
        &self.rows
    }
}

/// A column's key, and its values with their unit.
fn column<'a>(head: &'a str, values: &[String]) -> Result<(&'a str, Vec<Setting>), Diagnostic> {
    let (key, unit) = key_and_unit(head);
    if key.is_empty() || key.split('.').any(str::is_empty) {
        return Err(Diagnostic::error("", format!("`{head}` is not a key")).hint(Points::HINT));
    }
    let setting = |text: &String| match (unit, text.parse::<f64>()) {
        (_, Ok(value)) if !value.is_finite() => None,
        ("", _) if text.is_empty() => None,
        ("", _) => Some(Setting::of(text)),
        (unit, Ok(value)) => Some(Setting::Number(value, unit.to_owned())),
        _ => None,
    };
    let read = values.iter().map(|text| {
        setting(text).ok_or_else(|| {
            let message = format!("`{key}`: `{text}` is not a number");
            Diagnostic::error("", message).hint(Points::HINT)
        })
    });
    let read = read.collect::<Result<Vec<Setting>, _>>()?;
    if read.iter().any(|one| one.unit() != read[0].unit()) {
        let message = format!("`{key}`: the values have several units");
        return Err(Diagnostic::error("", message).hint(Points::HINT));
    }
    Ok((key, read))
}
