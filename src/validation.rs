//! Cases that redo the claims of the publication and hold gelbench to other codes and to mathematics.
//!
//! A case is a study file with a `kind` of its own: `gelbench run` computes one, `gelbench validate` all.

use std::path::Path;

use crate::budget::Budget;
use crate::document::{Document, Faults, Key};
use crate::error::{Diagnostic, Error, suggestion};
use crate::results::{Check, Outcome, Results};
use crate::studies::plate as plate_study;
use crate::studies::sections::read_text;
use crate::studies::{Kind, Prepare, PreparedStudy, Progress, motion, other_files, specimen};

mod case;
mod correction_matrix;
mod cost;
mod finite_elements;
mod fit_coverage;
mod flagship;
mod interval_coverage;
mod motion_correction;
mod nonlinear_spring;
mod oscillator;
mod other_codes;
mod plate;
mod plate_ablation;
mod real_measurements;
pub mod report;
mod smoothing;
mod spring_identification;
mod vibrating_plate;
mod vibrating_spring;

/// The case of fields that other people measured.
pub const REAL_MEASUREMENTS: &str = "real-measurements";

/// A table of cases: kind, the study that comes along, `quick` or `slow`, and what reads it.
macro_rules! cases {
    (@slow quick) => { false };
    (@slow slow) => { true };
    ($($kind:expr, $file:literal, $speed:ident, $prepare:path;)*) => {
        /// All cases, in the order of the report.
        pub const CASES: &[Kind] = &[$(Kind {
            kind: $kind,
            study: include_str!(concat!("../", $file)),
            file: $file,
            slow: cases!(@slow $speed),
        }),*];

        /// What reads them: apart from them, so that a program that computes none has no solver in it.
        const READERS: &[(&str, Prepare)] = &[$(($kind, $prepare)),*];
    };
}

cases! {
    "nonlinear-spring", "examples/nonlinear_spring.toml", quick, nonlinear_spring::prepare;
    "plate-ablation", "examples/plate_ablation.toml", quick, plate_ablation::prepare;
    "flagship", "validation/cases/flagship.toml", slow, flagship::prepare;
    "vibrating-spring", "examples/vibrating_spring.toml", quick, vibrating_spring::prepare;
    "spring-identification", "examples/spring_identification.toml", slow, spring_identification::prepare;
    "smoothing", "examples/smoothing.toml", slow, smoothing::prepare;
    "measured-fields", "validation/cases/measured_fields.toml", slow, interval_coverage::prepare;
    "interval-coverage", "validation/cases/interval_coverage.toml", slow, interval_coverage::coverage::prepare;
    "joint-parameters", "validation/cases/joint_parameters.toml", slow, interval_coverage::together::prepare;
    REAL_MEASUREMENTS, "validation/cases/real_measurements.toml", slow, real_measurements::prepare;
    "test-curves", "validation/cases/test_curves.toml", slow, fit_coverage::prepare;
    specimen::KIND, "examples/strip_with_hole.toml", slow, specimen::prepare;
    motion::KIND, "examples/released_plate.toml", slow, motion::prepare;
    "cost", "examples/cost.toml", slow, cost::prepare;
    "correction-matrix", "validation/correction_matrix.toml", quick, correction_matrix::prepare;
    "other-codes", "validation/other_codes.toml", slow, other_codes::prepare;
    "patch-tests", "validation/cases/patch_tests.toml", quick, finite_elements::patch::prepare;
    "manufactured-solution", "validation/cases/manufactured_solution.toml", quick, finite_elements::manufactured::prepare;
    "hole", "validation/cases/hole.toml", quick, finite_elements::hole::prepare;
    "ring", "validation/cases/ring.toml", quick, finite_elements::ring::prepare;
    "curved-meshes", "validation/cases/curved_meshes.toml", slow, finite_elements::curved_meshes::prepare;
    "cantilever", "validation/cases/cantilever.toml", quick, finite_elements::cantilever::prepare;
    "cook", "validation/cases/cook.toml", slow, finite_elements::cook::prepare;
    "motion-correction", "validation/cases/motion_correction.toml", slow, motion_correction::prepare;
    "vibrating-plate", "validation/cases/vibrating_plate.toml", quick, vibrating_plate::prepare;
    "own-error", "validation/cases/own_error.toml", slow, finite_elements::own_error::prepare;
}

/// The cases of some kinds, or all; without the slow ones where `quick` is wanted and none is named.
///
/// # Errors
/// [`Error::Input`] with every unknown name.
pub fn choose(names: &[String], quick: bool) -> Result<Vec<&'static Kind>, Error> {
    if names.is_empty() {
        return Ok(CASES.iter().filter(|case| !(quick && case.slow)).collect());
    }
    let known = || CASES.iter().map(|case| case.kind);
    let unknown = names
        .iter()
        .filter(|name| !known().any(|kind| kind == name.as_str()));
    let faults: Vec<Diagnostic> = unknown
        .map(|name| {
            let fault = Diagnostic::error("", format!("there is no case `{name}`"));
            fault.hint(suggestion(name, &known().collect::<Vec<_>>(), "cases:"))
        })
        .collect();
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    let chosen = CASES
        .iter()
        .filter(|case| names.iter().any(|name| name == case.kind));
    Ok(chosen.collect())
}

/// What reads the studies of a case.
fn reader(case: &Kind) -> Prepare {
    let found = READERS.iter().find(|(kind, _)| *kind == case.kind);
    found.expect("a case of the table").1
}

/// Reads a study of a case, which may ask for so much.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn read_as(
    case: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<PreparedStudy, Error> {
    case.read(reader(case), file, text, budget)
}

/// The keys that are asked for when a text is read as a study of a case.
pub fn keys(case: &Kind, text: &str) -> Vec<Key> {
    case.keys(reader(case), text)
}

/// The case that a study's text is of; nothing for a plate study.
///
/// # Errors
/// [`Error::Input`] when the kind is unknown.
pub fn case_of(file: &str, text: &str) -> Result<Option<&'static Kind>, Error> {
    let faults = Faults::default();
    let found = {
        let document = Document::parse(file, text, &faults);
        let root = document.root(None, &faults);
        if !root.has("kind") {
            return match other_files::recognised(&root, file) {
                Some((what, hint)) => Err(Error::input(format!("{file} {what}"), hint)),
                None => Ok(None),
            };
        }
        let cases = CASES.iter().map(|case| (case.kind, Some(case)));
        let kinds: Vec<_> = std::iter::once(("plate", None)).chain(cases).collect();
        root.choice("kind", &kinds)
    };
    match found {
        // Other faults are told when the whole study is read.
        Some(case) => Ok(case),
        None => faults.finish().map(|_| None),
    }
}

/// Reads a study of any kind, which may ask for so much.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn read(path: &Path, budget: Budget) -> Result<PreparedStudy, Error> {
    let text = read_text(path)?;
    read_given(path, text, budget)
}

/// Reads a study of any kind from its text; the files that it names are relative to `path`.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn read_given(path: &Path, text: String, budget: Budget) -> Result<PreparedStudy, Error> {
    match case_of(&path.display().to_string(), &text)? {
        Some(case) => read_as(case, path, &text, budget),
        None => plate_study::prepare(path, text, budget),
    }
}

/// Computes the study that comes along; a model without a solution is a check that failed.
///
/// # Errors
/// [`Error::Input`] or [`Error::Write`].
pub fn compute_or_fail(case: &Kind, progress: Progress) -> Result<Results, Error> {
    let ready = read_as(case, Path::new(case.file), case.study, Budget::USUAL)?;
    match ready.compute(progress) {
        Err(fault @ Error::Solve { .. }) => {
            let check = Check::fault(fault.to_string(), "no fault");
            Ok(Results {
                name: case.kind.to_owned(),
                title: case.kind.to_owned(),
                kind: case.kind,
                text: case.study.to_owned(),
                defaults: Vec::new(),
                read_warnings: Vec::new(),
                outcome: Outcome {
                    checks: vec![check],
                    ..Outcome::default()
                },
                seconds: 0.0,
            })
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Wanted, limit, number};

    #[test]
    fn checks_pass_and_fail_as_they_should() {
        let check = |wanted, computed| Check::new("x", "mm", wanted, "a book", computed);
        assert!(check(Wanted::Equal(2.0, 1.0), 2.01).passed());
        assert!(!check(Wanted::Equal(2.0, 1.0), 2.03).passed());
        assert!(
            check(Wanted::AtMost(1.0), 1.0).passed() && !check(Wanted::AtMost(1.0), 1.1).passed()
        );
        assert!(check(Wanted::AtLeast(1.0), 1.0).passed());
        for wanted in [
            Wanted::Equal(2.0, 1.0),
            Wanted::AtMost(1.0),
            Wanted::AtLeast(1.0),
        ] {
            assert!(!check(wanted, f64::NAN).passed());
        }
    }

    #[test]
    fn numbers_are_written_with_five_digits() {
        assert_eq!(number(0.012_345_67), "0.012346");
        assert_eq!(number(-123.456_78), "-123.46");
        assert_eq!(number(1.234_56e-7), "1.23e-7");
        assert_eq!((limit(80.0), limit(1e-9)), ("80".into(), "1e-9".into()));
    }

    #[test]
    fn every_case_reads_its_own_study_and_tells_faults() {
        for case in CASES {
            let own = read_as(case, Path::new(case.file), case.study, Budget::USUAL);
            assert!(own.is_ok());
            let found = case_of(case.file, case.study).unwrap().unwrap();
            assert_eq!(found.kind, case.kind);
            let text = "kind = \"x\"
misspelt = 1
";
            let told = read_as(case, Path::new("x.toml"), text, Budget::USUAL)
                .map(|_| ())
                .unwrap_err();
            assert!(told.to_string().contains("misspelt: unknown key"), "{told}");
        }
        assert!(case_of("x.toml", "kind = \"plate\"").unwrap().is_none());
        let fault = case_of("x.toml", "kind = \"smoothin\"")
            .map(|_| ())
            .unwrap_err();
        assert!(
            fault.to_string().contains("did you mean \"smoothing\""),
            "{fault}"
        );
        let fault = choose(&["smoothin".into()], false).map(|_| ()).unwrap_err();
        assert!(
            fault.to_string().contains("did you mean `smoothing`"),
            "{fault}"
        );
    }
}
