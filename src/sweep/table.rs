//! Runs as a table with a line for each, written and read.

use std::path::Path;

use super::figures::Row;
use super::variable::Setting;
use crate::error::Error;

/// The columns before those of the figures, but for the keys, and those behind them.
const FIRST: &str = "run";
const LAST: [&str; 2] = ["passed", "fault"];

/// The names of all figures, in the order in which runs have them.
pub fn names(rows: &[Row]) -> Vec<&str> {
    let mut known = std::collections::HashSet::new();
    let all = rows.iter().flat_map(|row| &row.figures);
    all.map(|(name, _)| name.as_str())
        .filter(|name| known.insert(*name))
        .collect()
}

/// A key with the unit of its values.
pub fn headed(key: &str, rows: &[Row], index: usize) -> String {
    let unit = rows.first().map_or("", |row| row.settings[index].unit());
    match unit {
        "" => key.to_owned(),
        unit => format!("{key} [{unit}]"),
    }
}

/// The table: number of the run, the keys with units, all figures, whether requirements are met, and what was amiss.
pub fn write(keys: &[String], rows: &[Row]) -> Vec<u8> {
    let names = names(rows);
    let keys = keys.iter().enumerate();
    let keys = keys.map(|(index, key)| headed(key, rows, index));
    let head = std::iter::once(FIRST.to_owned())
        .chain(keys)
        .chain(names.iter().map(|name| (*name).to_owned()))
        .chain(LAST.map(str::to_owned));
    let mut table = csv::Writer::from_writer(Vec::new());
    let sound = "memory takes all that is written";
    table.write_record(head).expect(sound);
    for row in rows {
        let figures: std::collections::HashMap<&str, f64> = row
            .figures
            .iter()
            .map(|(name, value)| (name.as_str(), *value))
            .collect();
        let found = names
            .iter()
            .map(|name| figures.get(name).map_or(String::new(), f64::to_string));
        let line = std::iter::once(row.number.to_string())
            .chain(row.settings.iter().map(Setting::words))
            .chain(found)
            .chain([row.passed.to_string(), row.fault.clone()]);
        table.write_record(line).expect(sound);
    }
    table.into_inner().expect(sound)
}

/// The rows of a table that [`write`] has written, with as many keys.
///
/// # Errors
/// [`Error::Input`] where it is no such table.
pub fn read(path: &Path, keys: usize, bytes: &[u8]) -> Result<Vec<Row>, Error> {
    let wrong = || {
        Error::input(
            format!("{} is no table of a sweep of these keys", path.display()),
            "compute this shard again",
        )
    };
    let mut table = csv::Reader::from_reader(bytes);
    let head = table.headers().map_err(|_| wrong())?.clone();
    let figures = 1 + keys..head.len().checked_sub(LAST.len()).ok_or_else(wrong)?;
    if figures.start > figures.end {
        return Err(wrong());
    }
    let units: Vec<&str> = head.iter().skip(1).take(keys).map(unit_of).collect();
    let mut rows = Vec::new();
    for line in table.records() {
        let line = line.map_err(|_| wrong())?;
        let settings = line.iter().skip(1).take(keys).zip(&units);
        let own = figures.clone().filter(|place| !line[*place].is_empty());
        let own = own.map(|place| Some((head[place].to_owned(), line[place].parse().ok()?)));
        rows.push(Row {
            number: line[0].parse().map_err(|_| wrong())?,
            settings: settings.map(|(text, unit)| setting(text, unit)).collect(),
            figures: own.collect::<Option<_>>().ok_or_else(wrong)?,
            passed: line[figures.end].parse().map_err(|_| wrong())?,
            fault: line[figures.end + 1].to_owned(),
        });
    }
    Ok(rows)
}

fn unit_of(head: &str) -> &str {
    let inner = head.rsplit_once(" [").map(|(_, unit)| unit);
    inner.and_then(|unit| unit.strip_suffix(']')).unwrap_or("")
}

fn setting(text: &str, unit: &str) -> Setting {
    match (unit, text.parse::<f64>()) {
        ("", _) => Setting::of(text),
        (unit, Ok(value)) => Setting::Number(value, unit.to_owned()),
        _ => Setting::Text(text.to_owned()),
    }
}
