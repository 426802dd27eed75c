//! `gelbench correct`: a measured displacement field made to satisfy the physics.

use std::path::Path;

use super::identity;
use super::progress::Progress;
use super::terminal::{Outcome, print_report, warn};
use crate::material::Card;
use crate::studies::markers::{MarkerStudy, worst_answer};
use crate::studies::name;
use crate::studies::sections::read_text;

mod frames;
mod options;
mod pictures;
mod request;
pub mod together;
mod values;

pub use frames::exit_code;
use frames::{Told, correct};
pub use options::Options;
use request::request;

/// Corrects, prints, and writes.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    let folder = options.output.clone();
    let inputs = options.inputs();
    let study = options.study.as_deref();
    let text = study.map_or(Ok(String::new()), read_text)?;
    let name = name(study.unwrap_or(&options.fields[0]));
    let said = format!("{options:?}");
    let pictures = options.pictures.chosen();
    let refine = options.refine;
    let request = request(options)?;
    let mut field = if refine {
        let progress = Progress::of(0);
        let card = Card::load(&request.material, Path::new("."))?;
        MarkerStudy::prepare_refined(card, request, &|what| progress.tell(what))?
    } else {
        MarkerStudy::prepare(request)?
    };
    warn(&field.warnings);
    let told = Told {
        name,
        text,
        identity: identity::of(&said),
        pictures,
    };
    let (estimates, results) = correct(&mut field, told, &inputs, &folder)?;
    print_report(|| results.json())?;
    Ok(exit_code(worst_answer(&estimates), results.passed()))
}
