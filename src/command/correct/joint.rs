//! `gelbench correct --together`: parameters of laws from all frames of all specimens, and every specimen corrected with them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::frames::{Job, correct, exit_code, finish};
use super::options::Options;
use super::request::request;
use crate::command::interrupt;
use crate::command::progress::Progress;
use crate::command::terminal::{Outcome, print_report, warn, warn_texts};
use gelbench_base::error::Error;
use gelbench_estimation::estimation::{FieldEstimate, JointSettings};
use gelbench_mechanics::material::Card;
use gelbench_mechanics::material::softened_law::check_memory;
use gelbench_report::output::ResultFolder;
use gelbench_studies::studies::markers::joint::{
    CorrectedSpecimen, JointStudy, NamedSpecimen, given_the_law, results, undetermined,
};
use gelbench_studies::studies::markers::{
    Conditions, MarkerStudy, Request, in_plane, worst_answer,
};
use gelbench_studies::studies::name;

/// Estimates the parameters, corrects, prints, and writes.
pub fn run(options: Options, mut job: Job) -> Outcome {
    let study = read(options, &mut job.inputs)?;
    study.check()?;
    for (_, specimen) in &study.specimens {
        warn(&specimen.warnings);
    }
    let inputs: Vec<&Path> = job.inputs.iter().map(PathBuf::as_path).collect();
    let folder = interrupt::guarded(|| ResultFolder::open(&job.folder, "correct", &inputs))?;
    let start = Instant::now();
    let progress = Progress::of(0);
    let estimate = study.estimate(&|action| progress.report(action))?;
    drop(progress);
    let mut corrected = Vec::new();
    for (name, specimen) in &study.specimens {
        corrected.push(corrected_specimen(
            name,
            specimen.with_card(&estimate.card),
            &job,
        )?);
    }
    warn(&[given_the_law()]);
    warn_texts(undetermined(&estimate.estimate));
    let folder = interrupt::guarded(|| Ok(folder))?;
    let results = results(&study, &estimate, &corrected, start.elapsed().as_secs_f64());
    finish(folder, &results)?;
    print_report(|| results.json())?;
    let estimates = corrected
        .into_iter()
        .flat_map(|specimen| specimen.estimates);
    let estimates: Vec<FieldEstimate> = estimates.collect();
    Ok(exit_code(worst_answer(&estimates), results.passed()))
}

/// Corrects a specimen with the card of the estimated parameters.
fn corrected_specimen(
    name: &str,
    mut study: MarkerStudy,
    job: &Job,
) -> Result<CorrectedSpecimen, Error> {
    let job = Job {
        name: name.to_owned(),
        text: String::new(),
        folder: job.folder.join("specimens").join(name),
        arguments: format!("{}_{name}", job.arguments),
        ..job.clone()
    };
    let (estimates, results) = correct(&mut study, job)?;
    Ok(CorrectedSpecimen {
        name: name.to_owned(),
        study,
        estimates,
        doubts: results.outcome.doubts().count(),
    })
}

/// The study; the files that specimens name are added to the `inputs`.
fn read(options: Options, inputs: &mut Vec<PathBuf>) -> Result<JointStudy, Error> {
    let materials = [&options.material].into_iter().chain(&options.laws);
    let load = |card: &String| {
        let card = Card::load(card, Path::new("."))?;
        check_memory(&*card.law, "a correction of measured fields")?;
        Ok(card)
    };
    let cards: Result<Vec<Card>, Error> = materials.map(load).collect();
    let files = options.specimen.clone();
    let settings = JointSettings {
        groups: options.leave_out,
        ..JointSettings::default()
    };
    let field_name = options.fields.first().map(|first| name(first));
    let like = request(options)?;
    let fit = if like.conditions.fit.is_empty() {
        vec!["all".to_owned()]
    } else {
        like.conditions.fit.clone()
    };
    let mut specimens = Vec::new();
    if let Some(name) = field_name {
        specimens.push((name, prepared(like.clone())?));
    }
    for file in files {
        specimens.push(of_file(&file, &like, inputs)?);
    }
    let cards = in_common_plane(cards?, &specimens)?;
    Ok(JointStudy {
        specimens,
        cards,
        fit,
        settings,
    })
}

/// The cards in the plane state of all specimens.
///
/// # Errors
/// [`Error::Input`] where specimens differ in it, or a card has no stress in it.
fn in_common_plane(cards: Vec<Card>, specimens: &[NamedSpecimen]) -> Result<Vec<Card>, Error> {
    let mut planes = specimens
        .iter()
        .map(|(_, study)| study.card.law.plane_state());
    let first = planes.next();
    if planes.any(|plane| Some(plane) != first) {
        let hint = "pool specimens in plane stress, or specimens in plane strain; --sheet states it for all";
        return Err(Error::input(
            "some specimens are in plane stress and others in plane strain",
            hint,
        ));
    }
    cards
        .into_iter()
        .map(|card| in_plane(card, first))
        .collect()
}

/// The specimen of a file; both are added to the `inputs`.
fn of_file(file: &Path, like: &Request, inputs: &mut Vec<PathBuf>) -> Result<NamedSpecimen, Error> {
    let mut conditions = Conditions::of_file(file)?;
    conditions.sheet = like.conditions.sheet.or(conditions.sheet);
    let Some(specimen) = conditions.specimen.take() else {
        return Err(Error::input(
            format!("{} has no [specimen]", file.display()),
            "add the section with fields and thickness, as `gelbench new --kind markers` shows it",
        ));
    };
    let folder = file.parent().unwrap_or(Path::new("."));
    inputs.push(file.to_owned());
    inputs.extend(specimen.inputs(folder));
    let request = specimen.request(folder, conditions, like);
    let name = specimen.name.unwrap_or_else(|| name(file));
    Ok((name, prepared(request)?))
}

/// A specimen whose parameters are those of all specimens.
fn prepared(mut request: Request) -> Result<MarkerStudy, Error> {
    request.conditions.fit.clear();
    let progress = Progress::of(0);
    MarkerStudy::prepare(request, &|action| progress.report(action))
}
