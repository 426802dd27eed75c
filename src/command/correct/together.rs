//! `gelbench correct --together`: parameters of laws from all frames of all specimens, and every specimen corrected with them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::frames::{Told, correct, exit_code, finish};
use super::options::Options;
use super::request::request;
use crate::command::identity;
use crate::command::interrupt;
use crate::command::progress::Progress;
use crate::command::terminal::{Outcome, print_report, warn};
use crate::error::{Diagnostic, Error};
use crate::estimation::JointSettings;
use crate::material::Card;
use crate::material::softened_law::check_memory;
use crate::output::{self, ResultFolder};
use crate::studies::markers::joint::{
    CorrectedSpecimen, JointStudy, NamedSpecimen, given_the_law, results, undetermined,
};
use crate::studies::markers::{Conditions, MarkerStudy, Request, worst_answer};
use crate::studies::name;

/// Finds the parameters, corrects, prints, and writes.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    let folder = options.output.clone();
    let said = format!("{options:?}");
    let pictures = options.pictures.chosen();
    let (study, inputs) = read(options)?;
    study.check()?;
    let identity = identity::of(&said);
    for (_, specimen) in &study.specimens {
        warn(&specimen.warnings);
    }
    let given: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    let mut results_folder = ResultFolder::open(&folder, "correct", &given)?;
    interrupt::guard(&results_folder);
    let start = Instant::now();
    let progress = Progress::of(0);
    let found = study.estimate(&|what| progress.tell(what))?;
    drop(progress);
    let mut corrected = Vec::new();
    for (name, specimen) in &study.specimens {
        let mut own = specimen.with_card(&found.card);
        let told = Told {
            name: name.clone(),
            text: String::new(),
            identity: format!("{identity}_{name}"),
            pictures: pictures.clone(),
        };
        let (estimates, results) = correct(
            &mut own,
            told,
            &inputs,
            &folder.join("specimens").join(name),
        )?;
        corrected.push(CorrectedSpecimen {
            name: name.clone(),
            study: own,
            estimates,
            doubts: results.outcome.doubts.len(),
        });
    }
    warn(&[given_the_law()]);
    let undetermined = undetermined(&found.estimate);
    warn(
        undetermined
            .map(|told| Diagnostic::warning("", told))
            .as_slice(),
    );
    interrupt::guard(&results_folder);
    let seconds = start.elapsed().as_secs_f64();
    let results = results(&study, &found, &corrected, seconds);
    warn(&output::write(&results, true, &mut results_folder)?);
    finish(results_folder, &results)?;
    print_report(|| results.json())?;
    let all = corrected
        .into_iter()
        .flat_map(|specimen| specimen.estimates);
    let answer = worst_answer(&all.collect::<Vec<_>>());
    Ok(exit_code(answer, results.passed()))
}

/// The study and the files that it follows from.
fn read(options: Options) -> Result<(JointStudy, Vec<PathBuf>), Error> {
    let mut all_inputs = options.inputs();
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
    let own_name = options.fields.first().map(|first| name(first));
    let like = request(options)?;
    let fit = if like.conditions.fit.is_empty() {
        vec!["all".to_owned()]
    } else {
        like.conditions.fit.clone()
    };
    let mut specimens = Vec::new();
    if let Some(own_name) = own_name {
        specimens.push((own_name, prepared(like.clone())?));
    }
    for file in &files {
        let (specimen, more) = of_file(file, &like)?;
        specimens.push(specimen);
        all_inputs.push(file.clone());
        all_inputs.extend(more);
    }
    let study = JointStudy {
        specimens,
        cards: cards?,
        fit,
        settings,
    };
    Ok((study, all_inputs))
}

/// The specimen of a file, and what else it names.
fn of_file(file: &Path, like: &Request) -> Result<(NamedSpecimen, Vec<PathBuf>), Error> {
    let mut conditions = Conditions::of_file(file)?;
    let Some(specimen) = conditions.specimen.take() else {
        return Err(Error::input(
            format!("{} has no [specimen]", file.display()),
            "add the section with fields and thickness, as `gelbench new --kind markers` shows it",
        ));
    };
    let folder = file.parent().unwrap_or(Path::new("."));
    let inputs = specimen.inputs(folder).collect();
    let own = specimen.request(folder, conditions, like);
    let name = specimen.name.clone().unwrap_or_else(|| name(file));
    Ok(((name, prepared(own)?), inputs))
}

/// A specimen whose parameters are found by nobody but all together.
fn prepared(mut request: Request) -> Result<MarkerStudy, Error> {
    request.conditions.fit.clear();
    MarkerStudy::prepare(request)
}
