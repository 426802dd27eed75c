//! One folder of results, and the exit code of a correction.

use std::path::PathBuf;

use crate::command::terminal::NOT_EXPLAINED;
use gelbench_estimation::estimation::Answer;
use gelbench_studies::studies::pictures::Pictures;

/// One folder of results: what they follow from, and how they are written.
#[derive(Clone)]
pub struct Job {
    pub name: String,
    /// The text of the study, empty where there is none.
    pub text: String,
    pub inputs: Vec<PathBuf>,
    pub folder: PathBuf,
    /// The command line, by which an interrupted run is recognised together with the files that were read.
    pub arguments: String,
    pub pictures: Pictures,
}

/// The exit code of a verdict, and of whether all requirements are met.
pub fn exit_code(answer: Answer, passed: bool) -> u8 {
    match answer {
        Answer::NotExplained => NOT_EXPLAINED,
        Answer::Undecided => 1,
        _ => u8::from(!passed),
    }
}
