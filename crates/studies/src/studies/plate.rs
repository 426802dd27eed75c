//! Plates between two grips: springs, corrected springs and finite elements at every stretch.

use std::path::Path;

use crate::budget::Budget;
use crate::document::write_records;
use crate::error::Error;
use crate::results::{Content, Material, Outcome};
use crate::statistics::larger;
use crate::studies::{PreparedStudy, Progress};

mod figures;
mod json;
mod problem;
mod read;
mod report;
pub mod results;
mod summary;
mod vtk;
mod warnings;

pub use problem::{OutputSettings, Study};
pub use read::{DEFAULT, keys};
use results::{MODELS, Results, run};

/// The `kind` of these studies.
pub const KIND: &str = "plate";

/// Reads a study of the file `path` within a budget.
///
/// # Errors
/// [`Error::Input`] with every fault of the study and of its card.
pub fn prepare(path: &Path, text: String, budget: Budget) -> Result<PreparedStudy, Error> {
    Ok(ready(Study::of_file(path, text, budget)?))
}

/// A study that was read, with a card of the caller's or its own, ready to be computed.
pub fn ready(study: Study) -> PreparedStudy {
    PreparedStudy {
        name: study.name.clone(),
        title: study.title.clone(),
        kind: KIND,
        text: study.text.clone(),
        defaults: study.defaults.clone(),
        warnings: study.warnings.clone(),
        folder: Some(study.output.folder.clone()),
        report: study.output.report,
        progress_steps: run::progress_steps(&study),
        about: study.describe(),
        computation: Box::new(move |progress: Progress| {
            let results = run::run(&study, progress)?;
            Ok(outcome(&study, &results))
        }),
    }
}

/// The outcome of a plate; with pictures and grids where the study wants them.
fn outcome(study: &Study, results: &Results) -> Outcome {
    let requirements = results.requirements(study);
    let warnings = warnings::warnings(study, results);
    let figures = || {
        if study.output.plots {
            figures::figures(study, results)
        } else {
            Vec::new()
        }
    };
    let (figures, mut grids) = rayon::join(figures, || vtk::grids(study, results));
    let mut explored = Vec::new();
    if !study.output.vtk {
        std::mem::swap(&mut grids, &mut explored);
    }
    let times = results.times.iter();
    let mut outcome = Outcome {
        checks: requirements,
        problem: json::problem(study),
        material: Some(Material::from(&study.card)),
        along: "stretch",
        steps: json::steps(results),
        headline: summary::headline(study, results),
        summary: summary::agreement(results),
        warnings,
        ends: results.ends.iter().map(Into::into).collect(),
        balance: results.worst_balances().reduce(larger),
        balances: json::balances(results),
        times: times
            .map(|(what, seconds)| ((*what).to_owned(), *seconds))
            .collect(),
        figures,
        style: study.pictures.style.clone(),
        grids,
        explored,
        files: vec![("forces.csv".to_owned(), Content::Text(forces(results)))],
        ..Outcome::default()
    };
    outcome.blocks = report::blocks(study, results, &outcome);
    outcome
}

/// Force, width and energy of all models at all stretches as a table for other programs.
fn forces(results: &Results) -> String {
    let head = [
        "stretch",
        "model",
        "grip_displacement_mm",
        "force_N",
        "mid_width_mm",
        "strain_energy_mJ",
    ];
    let mut records = vec![head.map(str::to_owned).to_vec()];
    let length = results.springs.mesh.grid().size[0];
    for (step, compared) in results.comparison.iter().enumerate() {
        for (name, measures) in MODELS.into_iter().zip(results.measures(step)) {
            let Some(own) = measures else { continue };
            let stretch = compared.stretch;
            let values = [stretch * length, own.force, own.mid_width, own.energy];
            let names = [stretch.to_string(), name.to_owned()];
            records.push(
                names
                    .into_iter()
                    .chain(values.map(|value| value.to_string()))
                    .collect(),
            );
        }
    }
    write_records(records)
}
