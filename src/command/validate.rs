//! `gelbench validate`: the claims of the publication and the comparisons with other codes, case by case.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::conclusion::conclude;
use super::interrupt;
use super::progress::{Progress, report_files};
use super::terminal::{Outcome, print_report, warn};
use crate::kinds;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_report::output::{self, ResultFolder};
use gelbench_report::results::{Results, check_lines};
use gelbench_studies::studies::{self, Kind};
use gelbench_validation::validation;

/// Computes the cases, and writes one report of them.
pub fn run(names: &[String], quick: bool, folder: Option<PathBuf>) -> Outcome {
    let chosen = kinds::choose(names, quick)?;
    // The report of some cases never replaces that of all.
    let part = match &*chosen {
        [case] => case.name,
        all if all.len() == kinds::KINDS.len() => "",
        _ => "several",
    };
    let usual = || Path::new("output/validation").join(part);
    let folder = &folder.unwrap_or_else(usual);
    let statement = format!("validate {names:?} {quick}");
    let identity = interrupt::identity(&statement);
    let mut results =
        interrupt::guarded(|| ResultFolder::resume(folder, "validate", &[], &identity))?;
    warn(validation_time(&chosen).as_slice());
    let progress = Progress::of(chosen.len() as u64);
    let mut cases = Vec::new();
    for case in chosen {
        cases.push(computed(case, &mut results, &progress)?);
        progress.advance();
    }
    let (blocks, figures) = validation::report::report("Validation of gelbench", &cases);
    let mut warnings = output::write_document(&mut results, "REPORT", &blocks, &figures)?;
    let times = validation::report::times(&cases);
    warnings.extend(output::write_document(&mut results, "TIMES", &times, &[])?);
    drop(progress);
    warn(&warnings);
    report_files(&results.finish()?);
    print_report(|| cases_json(&cases))?;
    let report = folder.join("REPORT.md");
    let checks = cases.iter().flat_map(|case| {
        let checks = case.outcome.checks.iter();
        checks.map(|check| (Some(case.kind), check))
    });
    let lines = check_lines(checks);
    conclude(&cases, &format!("{lines}\nreport: {}\n", report.display()))
}

/// The results of a case: those that the same command has kept before it was interrupted, or new ones, which are kept.
fn computed(
    case: &'static Kind,
    folder: &mut ResultFolder,
    progress: &Progress,
) -> Result<Results, Error> {
    if let Some(kept) = folder.kept(case.name) {
        return Ok(kept);
    }
    let report = |what: &str| progress.report(&format!("{}: {what}", case.name));
    report("begins");
    let results = kinds::compute_or_fail(case, studies::Progress::to(&report))?;
    folder.keep(case.name, &results)?;
    Ok(results)
}

/// What deserves to be known before slow cases are computed.
fn validation_time(cases: &[&Kind]) -> Option<Diagnostic> {
    let slow = cases.iter().filter(|case| case.slow).count();
    (slow > 1).then(|| {
        let message = format!(
            "{slow} of these {} cases take minutes, all of them together about three quarters of an hour on two processors; after an interrupt, the \
             same command continues with the next case",
            cases.len()
        );
        Diagnostic::warning("", message).hint("--quick leaves the slow cases out")
    })
}

/// All cases for machines, each as `report.json` has a study.
fn cases_json(cases: &[Results]) -> Value {
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "passed": cases.iter().all(Results::passed),
        "cases": cases.iter().map(Results::json).collect::<Vec<_>>(),
    })
}
