//! The report of a study as plain data, to be shown and to be exported.

use serde::{Deserialize, Serialize};

use gelbench::output::vtk;
use gelbench::results::{Block, Content, Drawing, Outcome, Results};

/// The results of a study.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Report {
    /// Its title.
    pub title: String,
    /// Whether all that was required is met, without a doubt.
    pub passed: bool,
    /// The report that the command writes, below its title.
    pub blocks: Vec<Block>,
    /// The pictures of its blocks.
    pub figures: Vec<Drawing>,
    /// Files to be saved: name and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// Computing time in s.
    pub seconds: f64,
}

impl From<Results> for Report {
    fn from(results: Results) -> Self {
        let figures = results.outcome.figures.iter();
        Self {
            passed: results.passed(),
            blocks: results.report().into_iter().skip(1).collect(),
            figures: figures.map(|figure| figure.drawing.clone()).collect(),
            files: files(&results.outcome),
            title: results.title,
            seconds: results.seconds,
        }
    }
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
