//! The results of a study as plain data, to be shown and to be given out.

use serde::{Deserialize, Serialize};

use gelbench::output::vtk;
use gelbench::results::{Block, Content, Drawing, Outcome, Results};
use gelbench_report::results::requirements;

/// A part of a report.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum Part {
    /// A heading of the given level, 1 to 3.
    Heading(u8, String),
    /// Running text.
    Paragraph(String),
    /// Heads and rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A picture with its caption.
    Picture(Drawing, String),
    /// Text that is shown as it is.
    Code(String),
}

/// The results of a study.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Report {
    /// Its title.
    pub title: String,
    /// Whether all that was required is met, without a doubt.
    pub passed: bool,
    /// Doubts, warnings and models that ended early, each in a sentence.
    pub told: Vec<String>,
    /// Explanations, tables and pictures.
    pub parts: Vec<Part>,
    /// Files that go out: name and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// Computing time in s.
    pub seconds: f64,
}

impl From<Results> for Report {
    fn from(results: Results) -> Self {
        let passed = results.passed();
        let mut messages = results.read_warnings;
        messages.extend(sentences(&results.outcome));
        let files = files(&results.outcome);
        Self {
            title: results.title,
            passed,
            told: messages,
            parts: parts(results.outcome),
            files,
            seconds: results.seconds,
        }
    }
}

fn sentences(outcome: &Outcome) -> Vec<String> {
    let ends = outcome.ends.iter().map(|end| match end.advice {
        Some(advice) => format!("{}; {advice}", end.message),
        None => end.message.clone(),
    });
    let remarks = outcome.doubts().chain(outcome.warnings());
    ends.chain(remarks).collect()
}

/// Tables and fields: those that the command writes, but for pictures.
fn files(outcome: &Outcome) -> Vec<(String, Vec<u8>)> {
    let tables = outcome
        .files
        .iter()
        .filter_map(|(name, content)| match content {
            Content::Text(text) => Some((name.clone(), text.clone().into_bytes())),
            Content::Picture(_) => None,
        });
    let fields = outcome.grids.iter().flat_map(vtk::files);
    tables.chain(fields).collect()
}

/// The blocks with their pictures; those that no block places come last.
fn parts(outcome: Outcome) -> Vec<Part> {
    let mut figures: Vec<_> = outcome.figures.into_iter().map(Some).collect();
    let mut parts: Vec<Part> = Vec::new();
    let required = (!outcome.checks.is_empty()).then(|| requirements(&outcome.checks));
    for block in required.into_iter().chain(outcome.blocks) {
        parts.extend(match block {
            Block::Heading(level, text) => Some(Part::Heading(level, text)),
            Block::Paragraph(text) => Some(Part::Paragraph(text)),
            Block::Table(head, rows) => Some(Part::Table(head, rows)),
            Block::Code(_, text) => Some(Part::Code(text)),
            Block::Figure(index, caption) => {
                let figure = figures.get_mut(index).and_then(Option::take);
                figure.map(|figure| Part::Picture(figure.drawing, caption))
            }
        });
    }
    let unplaced = figures.into_iter().flatten();
    parts.extend(unplaced.map(|figure| Part::Picture(figure.drawing, figure.caption)));
    parts
}
