//! Results for machines: `report.json`, the same keys for every kind of study.

use serde_json::{Map, Value, json};

use super::{Check, Finding, Results, Step, verdict};

/// The entries of an object.
pub fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(entries) => entries,
        _ => Map::new(),
    }
}

impl Results {
    /// The results in the format of `report.schema.json`. Numbers and models that do not exist are `null`.
    pub fn json(&self) -> Value {
        let outcome = &self.outcome;
        let step = |step: &Step| {
            let mut all = step.models.clone();
            all.insert("at".into(), json!(step.at));
            Value::Object(all)
        };
        let times = self.times();
        let times: Map<_, _> = times.map(|(what, s)| (what.to_owned(), json!(s))).collect();
        json!({
            "gelbench": env!("CARGO_PKG_VERSION"),
            "name": self.name,
            "kind": self.kind,
            "title": self.title,
            "study": { "text": self.text, "defaults": self.defaults },
            "problem": outcome.problem,
            "material": outcome.material.as_ref().map(|material| &material.json),
            "along": (!outcome.along.is_empty()).then_some(outcome.along),
            "steps": outcome.steps.iter().map(step).collect::<Vec<_>>(),
            "requirements": outcome.checks.iter().map(Check::json).collect::<Vec<_>>(),
            "passed": self.passed(),
            "verdict": verdict(&outcome.checks),
            "warnings": self.warnings().collect::<Vec<_>>(),
            "doubts": outcome.doubts().collect::<Vec<_>>(),
            "findings": outcome.findings.iter().map(Finding::json).collect::<Vec<_>>(),
            "ends": outcome.ends.iter().map(|end| &end.message).collect::<Vec<_>>(),
            "balance": { "worst": outcome.balance, "models": outcome.balances },
            "times_s": times,
        })
    }
}
