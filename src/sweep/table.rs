//! The records of runs, and their table with a line for each, written and read.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::plan::Run;
use super::variable::{Setting, headed, key_and_unit};
use gelbench_base::document::{read_records, write_records};
use gelbench_base::error::Error;
use gelbench_report::results::Results;

/// The separator between the warnings of a run.
const BETWEEN: &str = " | ";

/// A run with its results.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Row {
    /// The run's number.
    pub number: usize,
    /// The values that were set.
    pub settings: Vec<Setting>,
    /// Every number of every model at every step, by names such as `corrected.force_N@0.5`: model, quantity with its unit, and the
    /// stretch, load factor, time in s or frame, the second time at one with `#2` behind it. Components along x and y end with `.x` and `.y`.
    pub figures: Vec<(String, f64)>,
    /// Whether all requirements of the study are met.
    pub passed: bool,
    /// Why there is no solution, or where a model ended early; empty otherwise.
    pub fault: String,
    /// Warnings of the study and of its results, each in a sentence.
    pub warnings: Vec<String>,
}

impl Row {
    /// The record of a study's findings.
    pub fn of(run: &Run, results: &Results) -> Self {
        let outcome = &results.outcome;
        let mut figures = Vec::new();
        let mut times: HashMap<String, usize> = HashMap::new();
        for step in &outcome.steps {
            let mut at = step.at.to_string();
            let times = times.entry(at.clone()).or_default();
            *times += 1;
            if *times > 1 {
                at += &format!("#{times}");
            }
            for (model, quantities) in &step.models {
                let mut flat = Vec::new();
                flatten(model, quantities, &mut flat);
                figures.extend(
                    flat.into_iter()
                        .map(|(name, value)| (format!("{name}@{at}"), value)),
                );
            }
        }
        let warnings = results.warnings().chain(outcome.doubts());
        let ends = outcome.ends.iter().map(|end| end.message.as_str());
        Self {
            number: run.number,
            settings: run.settings.clone(),
            figures,
            passed: results.passed(),
            fault: ends.collect::<Vec<_>>().join("; "),
            warnings: warnings.collect(),
        }
    }

    /// The record of a study without a solution.
    pub fn failed(run: &Run, fault: String, warnings: Vec<String>) -> Self {
        Self {
            number: run.number,
            settings: run.settings.clone(),
            figures: Vec::new(),
            passed: false,
            fault,
            warnings,
        }
    }

    /// Its warnings as one text.
    pub fn joined_warnings(&self) -> String {
        self.warnings.join(BETWEEN)
    }

    /// A figure by its name.
    pub fn figure(&self, name: &str) -> Option<f64> {
        let mut figures = self.figures.iter();
        figures
            .find(|(key, _)| key == name)
            .map(|(_, value)| *value)
    }
}

/// All numbers below a name, with two components where it ends with a unit; other lists are left out.
fn flatten(name: &str, value: &Value, into: &mut Vec<(String, f64)>) {
    match value {
        Value::Number(number) => into.extend(number.as_f64().map(|value| (name.to_owned(), value))),
        Value::Object(fields) => {
            for (key, inner) in fields {
                flatten(&format!("{name}.{key}"), inner, into);
            }
        }
        Value::Array(parts)
            if parts.len() == 2 && (name.ends_with("_N") || name.ends_with("_mm")) =>
        {
            for (axis, part) in ["x", "y"].into_iter().zip(parts) {
                flatten(&format!("{name}.{axis}"), part, into);
            }
        }
        _ => {}
    }
}

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
