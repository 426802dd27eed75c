//! What a study or a case finds: checks, explanations, tables, pictures.

use serde_json::{Map, Value, json};

use crate::compare::judgement::Judgement;

mod block;
mod chart;
mod curves;
mod fields;
mod fit;
mod grid;
mod identification;
mod material;
mod series;
pub mod wrinkling;

pub use block::{Block, Content, Drawing, Figure};
pub use chart::{Axis, Line, LineChart, PALETTE, Scale, Stroke};
pub use curves::{comparison_chart, material_chart};
pub use fields::{Animation, Colours, FieldCell, FieldFigure, Frame, Panel, mesh_outlines};
pub use fit::{fit_json, fit_picture};
pub use grid::{Array, Grid, GridCell, GridSeries, NamedGrid, Sheet};
pub use identification::{identification_json, identification_picture};
pub use material::{material_json, material_statement};
pub use series::{Series, csv};

/// What a computed value has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// A value, within a tolerance in percent of it.
    Equal(f64, f64),
    /// At most so much.
    AtMost(f64),
    /// At least so much.
    AtLeast(f64),
}

/// One checked figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// What is checked.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// What it has to be.
    pub wanted: Wanted,
    /// Where that comes from.
    pub source: &'static str,
    /// What gelbench computed.
    pub computed: f64,
    /// The own error of what it was compared with, in the check's unit, where that is known.
    pub own_error: Option<f64>,
    judgement: Option<Judgement>,
}

impl Check {
    /// A check of a computed value.
    pub fn new(
        quantity: impl Into<String>,
        unit: &'static str,
        wanted: Wanted,
        source: &'static str,
        computed: f64,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            wanted,
            source,
            computed,
            own_error: None,
            judgement: None,
        }
    }

    /// A fault that leaves nothing to be checked.
    pub fn fault(quantity: impl Into<String>, source: &'static str) -> Self {
        Self::new(quantity, "–", Wanted::AtMost(0.0), source, f64::NAN)
    }

    /// With what the comparison with something that has an error of its own comes to.
    #[must_use]
    pub fn judged(self, judgement: Judgement, own_error: f64) -> Self {
        Self {
            judgement: Some(judgement),
            own_error: own_error.is_finite().then_some(own_error),
            ..self
        }
    }

    /// Deviation from the wanted value in %, where there is one.
    pub fn error_percent(&self) -> Option<f64> {
        match self.wanted {
            Wanted::Equal(expected, _) => Some(100.0 * (self.computed / expected - 1.0).abs()),
            _ => None,
        }
    }

    /// What the check comes to.
    pub fn judgement(&self) -> Judgement {
        match &self.judgement {
            Some(judgement) => judgement.clone(),
            None if self.is_met() => Judgement::Pass,
            None => Judgement::Fail,
        }
    }

    /// Whether the check passed; one that cannot be judged did not.
    pub fn passed(&self) -> bool {
        self.judgement().passed()
    }

    /// `pass`, `FAIL` or `cannot be judged`, with the reason where there is one.
    pub fn result(&self) -> String {
        let judgement = self.judgement();
        match judgement.remark() {
            Some(remark) => format!("{}: {remark}", judgement.word()),
            None => judgement.word().to_owned(),
        }
    }

    /// Whether the value is what it has to be; one that is not a number is not.
    fn is_met(&self) -> bool {
        match self.wanted {
            Wanted::Equal(_, tolerance) => {
                self.error_percent().is_some_and(|error| error <= tolerance)
            }
            Wanted::AtMost(limit) => self.computed <= limit,
            Wanted::AtLeast(limit) => self.computed >= limit,
        }
    }
}

/// What the publication claims, and what came out here.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// The publication's words, shortened.
    pub claim: &'static str,
    /// What came out here.
    pub reproduced: String,
}

/// The result of a case.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The checks.
    pub checks: Vec<Check>,
    /// Claims of the publication.
    pub claims: Vec<Claim>,
    /// Explanations and tables.
    pub blocks: Vec<Block>,
    /// Pictures.
    pub figures: Vec<Figure>,
    /// Fields of the models.
    pub grids: Vec<GridSeries>,
    /// Tables and other files beside the report: name and content.
    pub files: Vec<(String, Content)>,
    /// Times that were measured: what, and seconds.
    pub times: Vec<(String, f64)>,
    /// What deserves attention in the results, each in a sentence.
    pub warnings: Vec<String>,
    /// The worst balance of forces and moments of all boundary value problems that were solved, relative to the largest
    /// force or moment; `None` where none was solved.
    pub balance: Option<f64>,
    /// More for machines than checks and times: key and value.
    pub json: Map<String, Value>,
}

/// A case that was computed.
#[derive(Clone, Debug)]
pub struct Computed {
    /// The study's title.
    pub title: String,
    /// The case's kind.
    pub kind: &'static str,
    /// The study's text; empty where there is none.
    pub text: String,
    /// The keys that it does not hold, with the defaults that they took.
    pub defaults: Vec<String>,
    /// Its result.
    pub outcome: Outcome,
    /// Computing time in s.
    pub seconds: f64,
}

impl Computed {
    /// Whether all checks passed.
    pub fn passed(&self) -> bool {
        self.outcome.checks.iter().all(Check::passed)
    }

    /// The figures for machines.
    pub fn json(&self) -> Value {
        let check = |check: &Check| {
            let (expected, tolerance) = match check.wanted {
                Wanted::Equal(value, tolerance) => (json!(value), json!(tolerance)),
                Wanted::AtMost(limit) => (json!({ "at_most": limit }), Value::Null),
                Wanted::AtLeast(limit) => (json!({ "at_least": limit }), Value::Null),
            };
            json!({
                "quantity": check.quantity,
                "unit": check.unit,
                "expected": expected,
                "source": check.source,
                "computed": check.computed,
                "error_percent": check.error_percent(),
                "tolerance_percent": tolerance,
                "own_error": check.own_error,
                "result": check.judgement().word(),
                "remark": check.judgement().remark(),
                "passed": check.passed(),
            })
        };
        let times = self
            .outcome
            .times
            .iter()
            .map(|(what, seconds)| (what.clone(), json!(seconds)));
        let mut all = json!({
            "gelbench": env!("CARGO_PKG_VERSION"),
            "case": self.kind,
            "title": self.title,
            "study": { "text": self.text, "defaults": self.defaults },
            "warnings": self.outcome.warnings,
            "checks": self.outcome.checks.iter().map(check).collect::<Vec<_>>(),
            "passed": self.passed(),
            "balance": self.outcome.balance,
            "times_s": times.collect::<Map<_, _>>(),
        });
        for (key, value) in &self.outcome.json {
            all[key] = value.clone();
        }
        all
    }
}

/// A number as a table shows it: five significant digits, or powers of ten where it is far from one.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor();
    if (-3.0..5.0).contains(&exponent) {
        let digits = (4.0 - exponent).max(0.0) as usize;
        return format!("{value:.digits$}");
    }
    format!("{value:.2e}")
}

/// A limit as a person would write it.
pub fn limit(value: f64) -> String {
    match value.abs() {
        small if small > 0.0 && small < 1e-3 => format!("{value:e}"),
        _ => value.to_string(),
    }
}
