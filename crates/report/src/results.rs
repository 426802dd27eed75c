//! Results of a study or a case as data: requirements, quantities, tables, pictures, grids.
//!
//! Every kind of study returns the same [`Results`]. [`Results::report`] and [`Results::json`] present the same
//! content in the same order; `output` draws and encodes it.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::document::stored::{self, StaticText, optional_static_text, static_text};
use crate::error::Error;

mod array;
mod block;
mod card_curves;
mod chart;
mod check;
mod drawing;
mod fields;
mod finding;
mod fit;
mod fit_picture;
mod grid;
mod group;
mod headline;
mod identification;
pub mod locking;
mod material;
pub mod models;
mod picture_style;
mod report;
mod sampled;
mod sheet;
mod sheet_arrays;
mod sheet_figures;
pub mod small_strain;
mod springs;
mod state;
mod stretches;
mod surface;
mod viscous_stress;
pub mod wrinkling;

pub use array::{Array, Components};
pub use block::{Block, Content, Figure, Table};
pub use card_curves::{card_curves, comparison_chart, material_chart};
pub use chart::{Axis, Line, LineChart, PALETTE, Scale, Stroke, from_rest};
pub use check::{Check, Wanted, check_lines, digits, requirements, verdict};
pub use drawing::{Drawing, MeshFigure, NamedLines, mesh_outlines};
pub use fields::{Animation, FieldFigure, Frame, Panel, Values};
pub use finding::{Finding, Found, Weight};
pub use fit::fit_json;
pub use fit_picture::{fit_picture, tests_chart};
pub use grid::{Grid, GridCell, GridSeries, NamedGrid};
pub use group::{NamedGroup, group_json, group_picture, group_table};
pub use headline::{Gauge, Headline, LoadedSheet};
pub use identification::{identification_json, identification_picture};
pub use material::{Material, properties};
pub use picture_style::{Palette, PictureFormat, PictureStyle, PictureWidth};
pub use report::{claims, pictures};
pub use sampled::{Position, positions};
pub use sheet::{Deformed, Sheet};
pub use sheet_figures::{SheetField, ShownFields, sheet_figures};
pub use springs::springs_csv;
pub use state::{LocalState, cell_states, nodal_states};
pub use stretches::{BESIDE_CORNERS, Stretches};
pub use surface::Surface;
pub use viscous_stress::ViscousStress;

/// A claim of the publication, and the result found here.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// The publication's words, shortened.
    #[serde(deserialize_with = "static_text")]
    pub claim: StaticText,
    /// The result found here.
    pub reproduced: String,
}

/// A model that has no solution at some of its load factors.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct End {
    /// The model, where it ended, and why.
    pub message: String,
    /// Advice on what to try.
    #[serde(deserialize_with = "optional_static_text")]
    pub advice: Option<StaticText>,
    /// The exit code of a command that ends with it.
    pub exit_code: u8,
}

impl From<&Error> for End {
    fn from(error: &Error) -> Self {
        Self {
            message: error.to_string(),
            advice: error.advice(),
            exit_code: error.exit_code(),
        }
    }
}

/// Results at one stretch, load factor, instant or frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// The stretch, load factor, time in s or number of the frame.
    pub at: f64,
    /// The quantities of every model, by names with units; `null` where a model has no solution.
    #[serde(with = "stored::json")]
    pub models: Map<String, Value>,
}

/// The results of the models of a study or a case. Fields and files are not stored: the report of all cases does not need them.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Requirements, with the values found.
    pub checks: Vec<Check>,
    /// Claims of the publication.
    pub claims: Vec<Claim>,
    /// The problem that was solved, for machines.
    #[serde(with = "stored::json")]
    pub problem: Map<String, Value>,
    /// The material.
    pub material: Option<Material>,
    /// The parameter along which the steps run: `stretch`, `load factor`, `time` or `frame`.
    #[serde(deserialize_with = "static_text")]
    pub along: StaticText,
    /// The quantities of all models, step by step.
    pub steps: Vec<Step>,
    /// Explanations and tables. Pictures that no block places come after the last block.
    pub blocks: Vec<Block>,
    /// Pictures.
    pub figures: Vec<Figure>,
    /// How the pictures are drawn.
    #[serde(skip)]
    pub style: PictureStyle,
    /// Fields of the models.
    #[serde(skip)]
    pub grids: Vec<GridSeries>,
    /// Fields for readers of the report, written to other files or to none.
    #[serde(skip)]
    pub explored: Vec<GridSeries>,
    /// Tables and other files beside the report: name and content.
    #[serde(skip)]
    pub files: Vec<(String, Content)>,
    /// Measured times: name and seconds.
    pub times: Vec<(String, f64)>,
    /// What a reader must know of the results; a study with a doubt has not passed.
    pub findings: Vec<Finding>,
    /// Models that ended early.
    pub ends: Vec<End>,
    /// The worst balance of forces and moments of all boundary value problems that were solved, relative to the largest
    /// force or moment; `None` where none was solved.
    pub balance: Option<f64>,
    /// The balance of every model, by its name.
    #[serde(with = "stored::json")]
    pub balances: Map<String, Value>,
    /// What the study is computed for, at a glance: [`Headline::blocks`] of a sheet. Reports and terminals begin with it.
    pub headline: Vec<Block>,
    /// Further figures for a terminal: how far the models agree, or everything about measured fields.
    pub summary: String,
}

impl Outcome {
    /// Adds the early end of a model that the study requires to reach its last step: a requirement that is not met.
    pub fn ended(&mut self, error: &Error) {
        let end = End::from(error);
        let advice = end
            .advice
            .map_or_else(String::new, |advice| format!(" ({advice})"));
        self.checks
            .push(Check::end(format!("{}{advice}", end.message)));
        self.ends.push(end);
    }

    /// Warnings about the results, each in a sentence.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let warnings = self.findings.iter().filter(|one| !one.is_doubt());
        warnings.map(ToString::to_string)
    }

    /// Doubts about the results, each in a sentence.
    pub fn doubts(&self) -> impl Iterator<Item = String> {
        let doubts = self.findings.iter().filter(|one| one.is_doubt());
        doubts.map(ToString::to_string)
    }

    /// The warnings as paragraphs of a report.
    pub fn warning_paragraphs(&self) -> impl Iterator<Item = Block> {
        self.warnings()
            .map(|warning| Block::paragraph(format!("Warning: {warning}")))
    }
}

/// The results of a study.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Results {
    /// The study's name, from the name of its file.
    pub name: String,
    /// The study's title.
    pub title: String,
    /// The study's kind.
    #[serde(deserialize_with = "static_text")]
    pub kind: StaticText,
    /// The study's text; empty where there is none.
    pub text: String,
    /// The keys that the study does not state, with the defaults used.
    pub defaults: Vec<String>,
    /// Warnings from reading the study.
    pub read_warnings: Vec<String>,
    /// The findings.
    pub outcome: Outcome,
    /// Computing time in s.
    pub seconds: f64,
}

impl Results {
    /// Warnings from reading the study and from its results.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let of_reading = self.read_warnings.iter().cloned();
        of_reading.chain(self.outcome.warnings())
    }

    /// Wall-clock times in s: that of the whole study, and those of its parts.
    fn times(&self) -> impl Iterator<Item = (&str, f64)> {
        let parts = self.outcome.times.iter();
        let parts = parts.map(|(what, seconds)| (&**what, *seconds));
        std::iter::once(("whole study", self.seconds)).chain(parts)
    }

    /// The headline for a terminal.
    pub fn headline(&self) -> String {
        let blocks: Vec<String> = self.outcome.headline.iter().map(Block::plain).collect();
        blocks.join("\n")
    }

    /// What follows the headline on a terminal: how far the models agree, and the requirements unless the summary judges them.
    pub fn agreement(&self) -> String {
        let outcome = &self.outcome;
        let mut text = outcome.summary.clone();
        let judged = !outcome.checks.is_empty();
        if judged && (text.is_empty() || !outcome.headline.is_empty()) {
            text += &check_lines(outcome.checks.iter().map(|check| (None, check)));
        } else if text.is_empty() {
            text += "nothing was judged: there is no requirement on what was computed\n";
        }
        text
    }

    /// Both, as the command prints them.
    pub fn summary(&self) -> String {
        let parts = [self.headline(), self.agreement()];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        parts.join("\n")
    }

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

    /// Whether all requirements are met, no model ended early, and there is no doubt.
    pub fn passed(&self) -> bool {
        let Outcome { checks, ends, .. } = &self.outcome;
        let has_doubt = self.outcome.findings.iter().any(Finding::is_doubt);
        checks.iter().all(Check::passed) && !has_doubt && ends.is_empty()
    }
}

/// The entries of an object.
pub fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(entries) => entries,
        _ => Map::new(),
    }
}

/// A value as `write` has it; a dash where there is none, or NaN.
pub fn or_dash(value: Option<f64>, write: impl FnOnce(f64) -> String) -> String {
    let value = value.filter(|value| !value.is_nan());
    value.map_or("–".to_owned(), write)
}

/// ux, uy of node after node of a field that is a function of the position at rest.
#[cfg(test)]
fn displacements(mesh: &crate::mesh::Mesh, field: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<f64> {
    mesh.nodes.iter().flat_map(|node| field(*node)).collect()
}

/// A limit as a person would write it.
pub fn limit(value: f64) -> String {
    match value.abs() {
        small if small > 0.0 && small < 1e-3 => format!("{value:e}"),
        _ => value.to_string(),
    }
}
