//! `gelbench correct`: measured displacement fields made to satisfy the physics.
//!
//! ```text
//! one specimen                         ─▶ every frame by itself ─▶ folder
//! several, or parameters of all frames ─▶ parameters ─▶ every frame with these ─▶ folder/specimens/NAME, folder
//! ```

use std::path::Path;

use super::progress::Progress;
use super::terminal::{Outcome, print_report, warn};
use gelbench_base::error::Error;
use gelbench_mechanics::material::Card;
use gelbench_studies::studies::markers::{MarkerStudy, worst_answer};
use gelbench_studies::studies::name;
use gelbench_studies::studies::sections::read_text;

mod frames;
mod joint;
mod options;
mod request;
pub mod values;

pub use frames::exit_code;
use frames::{Job, correct};
pub use options::Options;
use request::request;

/// Corrects, prints, and writes.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    let job = Job {
        name: String::new(),
        text: options
            .study
            .as_deref()
            .map_or(Ok(String::new()), read_text)?,
        inputs: options.inputs(),
        folder: options.output.clone(),
        arguments: format!("{options:?}"),
        pictures: options.pictures.chosen(),
    };
    if options.is_joint() {
        joint::run(options, job)
    } else {
        each_frame(options, job)
    }
}

/// Corrects every frame of one specimen independently.
fn each_frame(options: Options, job: Job) -> Outcome {
    let study = options.study.as_ref().unwrap_or(&options.fields[0]);
    let job = Job {
        name: name(study),
        ..job
    };
    let mut field = prepared(options)?;
    warn(&field.warnings);
    let (estimates, results) = correct(&mut field, job)?;
    print_report(|| results.json())?;
    Ok(exit_code(worst_answer(&estimates), results.passed()))
}

fn prepared(options: Options) -> Result<MarkerStudy, Error> {
    let refined = options.refine;
    let request = request(options)?;
    let progress = Progress::of(0);
    let watch = |action: &str| progress.report(action);
    if !refined {
        return MarkerStudy::prepare(request, &watch);
    }
    let card = Card::load(&request.material, Path::new("."))?;
    MarkerStudy::prepare_refined(card, request, &watch)
}
