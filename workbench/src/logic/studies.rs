//! Studies of any kind, run in the background from files in memory, and their reports as plain data, to be shown and to be exported.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use gelbench::budget::Budget;
use gelbench::document::with_files;
use gelbench::kinds;
use gelbench::output::vtk;
use gelbench::results::{Block, Content, Drawing, Outcome, Results};
use gelbench::studies::Progress;

use super::background::Worker;
use super::engine::Fault;

/// A file by its name.
pub type NamedFile = (String, Vec<u8>);

/// A study and the files that it may name.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct StudyQuestion {
    /// The name of the study among the files.
    pub study: String,
    /// All files.
    pub files: Vec<NamedFile>,
}

/// Runs studies.
#[derive(Default)]
pub struct Runner;

impl Worker for Runner {
    type Question = StudyQuestion;
    type Answer = Result<Report, Fault>;
    const NAME: &'static str = "runner";

    fn answer(&mut self, question: &StudyQuestion) -> Result<Report, Fault> {
        with_files(paths(&question.files), || {
            let study = kinds::read(Path::new(&question.study), Budget::USUAL)?;
            study.compute(Progress::silent()).map(Report::from)
        })
        .map_err(Fault::from)
    }
}

/// Files by the paths that the library finds them by.
pub fn paths(files: &[NamedFile]) -> impl Iterator<Item = (PathBuf, Vec<u8>)> + '_ {
    files
        .iter()
        .map(|(name, content)| (PathBuf::from(name), content.clone()))
}

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
    pub files: Vec<NamedFile>,
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
fn files(outcome: &Outcome) -> Vec<NamedFile> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn run(study: &str, text: &str, others: &[NamedFile]) -> Result<Report, Fault> {
        let study_file = (study.to_owned(), text.as_bytes().to_vec());
        let files = others.iter().cloned().chain([study_file]).collect();
        let study = study.to_owned();
        Runner.answer(&StudyQuestion { study, files })
    }

    #[test]
    fn a_study_from_memory_has_tables_pictures_and_fields() {
        let text = include_str!("../../../examples/nonlinear_spring.toml");
        let report = run("spring.toml", text, &[]).unwrap();
        let has = |kind: fn(&Block) -> bool| report.blocks.iter().any(kind);
        assert!(has(|block| matches!(block, Block::Table(..))));
        assert!(has(|block| matches!(block, Block::Figure(..))));
        assert!(!report.figures.is_empty());
        let text = "kind = \"plate\"\n[plate]\ncells = [12, 4]\n[load]\nstretches = [\"20 %\"]\n[tolerances]\ndisplacement = \"5 %\"\ndeparture = \"50 %\"\nforce = \"5 %\"\n";
        let report = run("plate.toml", text, &[]).unwrap();
        assert!(
            report.files.iter().any(|(name, _)| name.ends_with(".vtu")),
            "{:?}",
            report.blocks
        );
    }

    #[test]
    fn a_card_that_a_study_names_is_found_among_the_files_and_nowhere_else() {
        let card = gelbench::material::registry::CARDS[1].1.as_bytes().to_vec();
        let text = "kind = \"plate\"\n[plate]\ncells = [12, 4]\n[material]\ncard = \"own.toml\"\n[load]\nstretches = [\"10 %\"]\n";
        assert!(run("plate.toml", text, &[("own.toml".into(), card)]).is_ok());
        assert!(
            run("plate.toml", text, &[])
                .unwrap_err()
                .message
                .contains("own.toml")
        );
    }
}
