//! The kinds of studies, and reading a study of any kind.
//!
//! Every kind has a built-in study: its values are the defaults, and `gelbench validate` computes it. A plate study,
//! which needs no `kind`, is read here too but is not in the table.

use std::path::Path;

use gelbench_base::budget::Budget;
use gelbench_base::document::{Document, Faults, Key};
use gelbench_base::error::{Diagnostic, Error, suggestion};
use gelbench_report::results::{Check, Outcome, Results};
use gelbench_studies::studies::plate as plate_study;
use gelbench_studies::studies::sections::read_text;
use gelbench_studies::studies::specimen::{self, Specimen};
use gelbench_studies::studies::{
    Kind, Loaded, Prepare, PreparedStudy, Progress, motion, name, other_files,
};
use gelbench_validation::validation::{
    REAL_MEASUREMENTS, correction_matrix, cost, finite_elements, fit_coverage, flagship,
    interval_coverage, motion_correction, nonlinear_spring, other_codes, plate_ablation,
    real_measurements, smoothing, spring_identification, vibrating_plate, vibrating_spring,
};

/// A table of kinds: name, built-in study, `quick` or `slow`, reader, and the built-in study of a shape.
macro_rules! kinds {
    (@slow quick) => { false };
    (@slow slow) => { true };
    (@shape) => { None };
    (@shape $file:literal) => { Some(($file, include_str!(concat!("../", $file)))) };
    ($($kind:expr, $file:literal, $speed:ident, $prepare:path $(, $shape:literal)?;)*) => {
        /// All kinds, in the order of the report.
        pub const KINDS: &[Kind] = &[$(Kind {
            name: $kind,
            study: include_str!(concat!("../", $file)),
            file: $file,
            slow: kinds!(@slow $speed),
            of_shape: kinds!(@shape $($shape)?),
        }),*];

        /// Their readers, kept apart so that a program that computes no study contains no solver.
        const READERS: &[(&str, Prepare)] = &[$(($kind, $prepare)),*];
    };
}

kinds! {
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
    motion::KIND, "examples/released_plate.toml", slow, motion::prepare, "examples/vibrating_strip.toml";
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

/// The kind of a name.
pub fn named(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// The cases with the given names; without names, all cases, or with `quick` all but the slow ones.
///
/// # Errors
/// [`Error::Input`] with every unknown name.
pub fn choose(names: &[String], quick: bool) -> Result<Vec<&'static Kind>, Error> {
    if names.is_empty() {
        return Ok(KINDS.iter().filter(|kind| !(quick && kind.slow)).collect());
    }
    let known = || KINDS.iter().map(|kind| kind.name);
    let unknown = names
        .iter()
        .filter(|name| !known().any(|kind| kind == name.as_str()));
    let faults: Vec<Diagnostic> = unknown
        .map(|name| {
            let fault = Diagnostic::error("", format!("there is no case `{name}`"));
            fault.hint(suggestion(name, &known().collect::<Vec<_>>(), "cases:"))
        })
        .collect();
    Error::refuse(faults)?;
    let chosen = KINDS
        .iter()
        .filter(|kind| names.iter().any(|name| name == kind.name));
    Ok(chosen.collect())
}

/// The reader for studies of a kind.
fn reader(kind: &Kind) -> Prepare {
    let entry = READERS.iter().find(|(name, _)| *name == kind.name);
    entry.expect("a kind of the table").1
}

/// Reads a study of a kind within a budget.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn read_as(
    kind: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<PreparedStudy, Error> {
    if kind.name == specimen::KIND {
        let loaded = specimen::load(kind, file, text, budget)?;
        return Ok(specimen::ready(kind, name(file), text, loaded));
    }
    if kind.name == motion::KIND {
        let loaded = motion::load(kind, file, text, budget)?;
        return Ok(motion::ready(kind, name(file), text, loaded));
    }
    kind.read(reader(kind), file, text, budget)
}

/// The keys that are looked up when a text is read as a study of a kind.
pub fn keys(kind: &Kind, text: &str) -> Vec<Key> {
    kind.keys(text, reader(kind))
}

/// Names of files for `gelbench new` and `gelbench keys` that no `kind` of a study has.
const NO_KINDS: [(&str, &str); 3] = [
    (
        "moving-specimen",
        "write kind = \"motion\": with [specimen] it is that of a specimen, with [plate] that of a plate",
    ),
    (
        "markers",
        "leave `kind` out: what is known of markers is read by `gelbench correct FIELD --study FILE`",
    ),
    (
        "card",
        "leave `kind` out: a card has none, and a study names it with `card` under [material]",
    ),
];

/// The kind stated in a study's text; `None` for a plate study.
///
/// # Errors
/// [`Error::Input`] when the kind is unknown.
pub fn kind_of(file: &str, text: &str) -> Result<Option<&'static Kind>, Error> {
    let faults = Faults::default();
    let choice = {
        let document = Document::parse(file, text, &faults);
        let root = document.root(None, &faults);
        if text
            .lines()
            .all(|line| line.trim().is_empty() || line.trim_start().starts_with('#'))
        {
            let hint = "`gelbench new` writes a study of each kind, with every key in it";
            return Err(Error::input(format!("{file} states nothing"), hint));
        }
        if !root.has("kind") {
            return match other_files::recognised(&root, file) {
                Some((what, hint)) => Err(Error::input(format!("{file} {what}"), hint)),
                None => Ok(None),
            };
        }
        let others = KINDS.iter().map(|kind| (kind.name, Some(kind)));
        let kinds: Vec<_> = std::iter::once(("plate", None)).chain(others).collect();
        let stated = root.optional_text("kind");
        match NO_KINDS.iter().find(|(name, _)| *name == stated) {
            Some((_, hint)) => {
                let message = format!("\"{stated}\" is no kind of study");
                root.fault("kind", &message, hint);
                None
            }
            None if faults.none() => root.choice("kind", &kinds),
            // It is no text, which is reported already.
            None => None,
        }
    };
    match choice {
        // Other faults are reported when the study is read completely.
        Some(kind) => Ok(kind),
        None => faults.finish().map(|_| None),
    }
}

/// Reads a study of any kind within a budget.
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
    match kind_of(&path.display().to_string(), &text)? {
        Some(kind) => read_as(kind, path, &text, budget),
        None => plate_study::prepare(path, &text, budget),
    }
}

/// Reads the study of a plate or a specimen, the boundary value problem of one sheet.
///
/// # Errors
/// [`Error::Input`] with every fault, or where the study is of another kind.
pub fn read_sheet(path: &Path, text: &str, budget: Budget) -> Result<Loaded<Specimen>, Error> {
    match kind_of(&path.display().to_string(), text)? {
        None => plate_study::load(path, text, budget),
        Some(kind) if kind.name == specimen::KIND => specimen::load(kind, path, text, budget),
        Some(kind) => Err(Error::input(
            format!(
                "a study of the kind `{}` is not a boundary value problem of one sheet",
                kind.name
            ),
            "take a plate study or one of the kind `specimen`",
        )),
    }
}

/// Computes the built-in study of a kind; a model without a solution becomes a failed check.
///
/// # Errors
/// [`Error::Input`] or [`Error::Write`].
pub fn compute_or_fail(kind: &Kind, progress: Progress) -> Result<Results, Error> {
    let ready = read_as(kind, Path::new(kind.file), kind.study, Budget::USUAL)?;
    match ready.compute(progress) {
        Err(fault @ Error::Solve { .. }) => {
            let check = Check::fault(fault.to_string(), "no fault");
            Ok(Results {
                name: kind.name.to_owned(),
                title: kind.name.to_owned(),
                kind: kind.name,
                text: kind.study.to_owned(),
                outcome: Outcome {
                    checks: vec![check],
                    ..Outcome::default()
                },
                ..Results::default()
            })
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_reads_its_own_study_and_tells_faults() {
        for kind in KINDS {
            let study = read_as(kind, Path::new(kind.file), kind.study, Budget::USUAL);
            assert!(study.is_ok());
            let recognised = kind_of(kind.file, kind.study).unwrap().unwrap();
            assert_eq!(recognised.name, kind.name);
            let text = "kind = \"x\"
misspelt = 1
";
            let faults = read_as(kind, Path::new("x.toml"), text, Budget::USUAL)
                .map(|_| ())
                .unwrap_err();
            assert!(
                faults.to_string().contains("misspelt: unknown key"),
                "{faults}"
            );
        }
        assert!(kind_of("x.toml", "kind = \"plate\"").unwrap().is_none());
        let fault = kind_of("x.toml", "kind = \"smoothin\"")
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
