//! Runs as a table with a line for each, written and read.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::figures::{BETWEEN, Row};
use super::variable::{Setting, headed, key_and_unit};
use gelbench_base::document::{read_records, write_records};
use gelbench_base::error::Error;

/// The heads before those of the keys and figures, and those after them.
const FIRST: &str = "run";
const LAST: [&str; 3] = ["passed", "fault", "warnings"];

/// The names of all figures, in the order in which runs have them.
pub fn names(rows: &[Row]) -> Vec<&str> {
    let mut known = HashSet::new();
    let all = rows.iter().flat_map(|row| &row.figures);
    all.map(|(name, _)| name.as_str())
        .filter(|name| known.insert(*name))
        .collect()
}

/// All keys with the units of their values.
pub fn heads(keys: &[String], rows: &[Row]) -> Vec<String> {
    let unit = |index: usize| rows.first().map_or("", |row| row.settings[index].unit());
    let keys = keys.iter().enumerate();
    keys.map(|(index, key)| headed(key, unit(index))).collect()
}

/// The table: number of the run, the keys with units, all figures, whether requirements are met, its fault, and its
/// warnings.
pub fn write(keys: &[String], rows: &[Row]) -> Vec<u8> {
    let names = names(rows);
    let head = std::iter::once(FIRST.to_owned())
        .chain(heads(keys, rows))
        .chain(names.iter().map(|name| (*name).to_owned()))
        .chain(LAST.map(str::to_owned));
    let line = |row: &Row| {
        let figures: HashMap<&str, f64> = row
            .figures
            .iter()
            .map(|(name, value)| (name.as_str(), *value))
            .collect();
        let cells = names
            .iter()
            .map(|name| figures.get(name).map_or(String::new(), f64::to_string));
        let first = std::iter::once(row.number.to_string());
        let settings = row.settings.iter().map(Setting::plain_text);
        let last = [
            row.passed.to_string(),
            row.fault.clone(),
            row.joined_warnings(),
        ];
        first.chain(settings).chain(cells).chain(last).collect()
    };
    let lines = rows.iter().map(line);
    write_records(std::iter::once(head.collect()).chain(lines)).into_bytes()
}

/// The rows of a table that [`write()`] has written, of these keys.
///
/// # Errors
/// [`Error::Input`] where it is no such table.
pub fn read(path: &Path, keys: &[String], bytes: &[u8]) -> Result<Vec<Row>, Error> {
    let wrong = || {
        Error::input(
            format!("{} is not a table of a sweep of these keys", path.display()),
            "compute this shard again",
        )
    };
    rows_of(&read_records(bytes).ok_or_else(wrong)?, keys).ok_or_else(wrong)
}

fn rows_of(records: &[Vec<String>], keys: &[String]) -> Option<Vec<Row>> {
    let (head, lines) = records.split_first()?;
    let figures = 1 + keys.len()..head.len().checked_sub(LAST.len())?;
    let varied = head.get(1..figures.start)?.iter();
    let (names, units): (Vec<&str>, Vec<&str>) = varied.map(|head| key_and_unit(head)).unzip();
    if names != keys {
        return None;
    }
    let row = |line: &Vec<String>| {
        let settings = line[1..].iter().zip(&units);
        let filled = figures
            .clone()
            .filter(|position| !line[*position].is_empty());
        let filled =
            filled.map(|position| Some((head[position].clone(), line[position].parse().ok()?)));
        Some(Row {
            number: line[0].parse().ok()?,
            settings: settings.map(|(text, unit)| setting(text, unit)).collect(),
            figures: filled.collect::<Option<_>>()?,
            passed: line[figures.end].parse().ok()?,
            fault: line[figures.end + 1].clone(),
            warnings: warnings(&line[figures.end + 2]),
        })
    };
    lines.iter().map(row).collect()
}

fn warnings(text: &str) -> Vec<String> {
    let parts = text.split(BETWEEN).filter(|one| !one.is_empty());
    parts.map(str::to_owned).collect()
}

fn setting(text: &str, unit: &str) -> Setting {
    match (unit, text.parse::<f64>()) {
        ("", _) => Setting::of(text),
        (unit, Ok(value)) => Setting::Number(value, unit.to_owned()),
        _ => Setting::Text(text.to_owned()),
    }
}
