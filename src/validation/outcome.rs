//! What a case finds: checks, claims, explanations, pictures.

use serde_json::{Value, json};

use crate::output::{Block, Figure};

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
        }
    }

    /// Deviation from the wanted value in %, where there is one.
    pub fn error_percent(&self) -> Option<f64> {
        match self.wanted {
            Wanted::Equal(expected, _) => Some(100.0 * (self.computed / expected - 1.0).abs()),
            _ => None,
        }
    }

    /// Whether the value is what it has to be; one that is not a number is not.
    pub fn passed(&self) -> bool {
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
    /// VTK files: name and content.
    pub vtk: Vec<(String, Vec<u8>)>,
    /// Tables and other files beside the report: name and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// Times that were measured: what, and seconds.
    pub times: Vec<(String, f64)>,
}

/// A case that was computed.
#[derive(Clone, Debug)]
pub struct Computed {
    /// The study's title.
    pub title: String,
    /// The case's kind.
    pub kind: &'static str,
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
                "passed": check.passed(),
            })
        };
        let times = self
            .outcome
            .times
            .iter()
            .map(|(what, seconds)| (what.clone(), json!(seconds)));
        json!({
            "case": self.kind,
            "title": self.title,
            "checks": self.outcome.checks.iter().map(check).collect::<Vec<_>>(),
            "passed": self.passed(),
            "times_s": times.collect::<serde_json::Map<_, _>>(),
        })
    }
}
