//! The record of a run.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::plan::Run;
use super::variable::Setting;
use gelbench_report::results::Results;

/// The separator between the warnings of a run.
pub(super) const BETWEEN: &str = " | ";

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
