//! Cases that redo the claims of the publication and hold gelbench to other codes and to mathematics.
//!
//! A case is a study file with a `kind` of its own: `gelbench run` computes one, `gelbench validate` all.

use std::path::Path;

use crate::document::{Document, Faults};
use crate::error::{Diagnostic, Error, suggestion};
use crate::mesh::Mesh;
use crate::output::mesh_picture;
use crate::output::picture::lines::{Line, LineChart, Stroke};
use crate::results::{Check, Claim, Computed, Figure, Outcome, Wanted, limit, number};
use crate::studies::{Kind, Prepared, Progress, motion, specimen};

mod correction_matrix;
mod cost;
mod finite_elements;
mod flagship;
mod measured_fields;
mod motion_correction;
mod nonlinear_spring;
mod oscillator;
mod other_codes;
mod plate;
mod plate_ablation;
pub mod report;
mod smoothing;
mod spring_identification;
mod vibrating_plate;
mod vibrating_spring;

/// All cases, in the order of the report.
pub const CASES: &[Kind] = &[
    Kind {
        kind: "nonlinear-spring",
        study: include_str!("../examples/nonlinear_spring.toml"),
        file: "examples/nonlinear_spring.toml",
        slow: false,
        prepare: nonlinear_spring::prepare,
    },
    Kind {
        kind: "plate-ablation",
        study: include_str!("../examples/plate_ablation.toml"),
        file: "examples/plate_ablation.toml",
        slow: false,
        prepare: plate_ablation::prepare,
    },
    Kind {
        kind: "flagship",
        study: include_str!("../validation/cases/flagship.toml"),
        file: "validation/cases/flagship.toml",
        slow: true,
        prepare: flagship::prepare,
    },
    Kind {
        kind: "vibrating-spring",
        study: include_str!("../examples/vibrating_spring.toml"),
        file: "examples/vibrating_spring.toml",
        slow: false,
        prepare: vibrating_spring::prepare,
    },
    Kind {
        kind: "spring-identification",
        study: include_str!("../examples/spring_identification.toml"),
        file: "examples/spring_identification.toml",
        slow: true,
        prepare: spring_identification::prepare,
    },
    Kind {
        kind: "smoothing",
        study: include_str!("../examples/smoothing.toml"),
        file: "examples/smoothing.toml",
        slow: true,
        prepare: smoothing::prepare,
    },
    Kind {
        kind: "measured-fields",
        study: include_str!("../validation/cases/measured_fields.toml"),
        file: "validation/cases/measured_fields.toml",
        slow: true,
        prepare: measured_fields::prepare,
    },
    Kind {
        kind: specimen::KIND,
        study: include_str!("../examples/strip_with_hole.toml"),
        file: "examples/strip_with_hole.toml",
        slow: true,
        prepare: specimen::prepare,
    },
    Kind {
        kind: "motion",
        study: include_str!("../examples/released_plate.toml"),
        file: "examples/released_plate.toml",
        slow: true,
        prepare: motion::prepare,
    },
    Kind {
        kind: "cost",
        study: include_str!("../examples/cost.toml"),
        file: "examples/cost.toml",
        slow: true,
        prepare: cost::prepare,
    },
    Kind {
        kind: "correction-matrix",
        study: include_str!("../validation/correction_matrix.toml"),
        file: "validation/correction_matrix.toml",
        slow: false,
        prepare: correction_matrix::prepare,
    },
    Kind {
        kind: "other-codes",
        study: include_str!("../validation/other_codes.toml"),
        file: "validation/other_codes.toml",
        slow: true,
        prepare: other_codes::prepare,
    },
    Kind {
        kind: "patch-tests",
        study: include_str!("../validation/cases/patch_tests.toml"),
        file: "validation/cases/patch_tests.toml",
        slow: false,
        prepare: finite_elements::patch::prepare,
    },
    Kind {
        kind: "manufactured-solution",
        study: include_str!("../validation/cases/manufactured_solution.toml"),
        file: "validation/cases/manufactured_solution.toml",
        slow: false,
        prepare: finite_elements::manufactured::prepare,
    },
    Kind {
        kind: "hole",
        study: include_str!("../validation/cases/hole.toml"),
        file: "validation/cases/hole.toml",
        slow: false,
        prepare: finite_elements::hole::prepare,
    },
    Kind {
        kind: "ring",
        study: include_str!("../validation/cases/ring.toml"),
        file: "validation/cases/ring.toml",
        slow: false,
        prepare: finite_elements::ring::prepare,
    },
    Kind {
        kind: "curved-meshes",
        study: include_str!("../validation/cases/curved_meshes.toml"),
        file: "validation/cases/curved_meshes.toml",
        slow: true,
        prepare: finite_elements::curved_meshes::prepare,
    },
    Kind {
        kind: "cantilever",
        study: include_str!("../validation/cases/cantilever.toml"),
        file: "validation/cases/cantilever.toml",
        slow: false,
        prepare: finite_elements::cantilever::prepare,
    },
    Kind {
        kind: "cook",
        study: include_str!("../validation/cases/cook.toml"),
        file: "validation/cases/cook.toml",
        slow: true,
        prepare: finite_elements::cook::prepare,
    },
    Kind {
        kind: "motion-correction",
        study: include_str!("../validation/cases/motion_correction.toml"),
        file: "validation/cases/motion_correction.toml",
        slow: true,
        prepare: motion_correction::prepare,
    },
    Kind {
        kind: "vibrating-plate",
        study: include_str!("../validation/cases/vibrating_plate.toml"),
        file: "validation/cases/vibrating_plate.toml",
        slow: false,
        prepare: vibrating_plate::prepare,
    },
    Kind {
        kind: "own-error",
        study: include_str!("../validation/cases/own_error.toml"),
        file: "validation/cases/own_error.toml",
        slow: true,
        prepare: finite_elements::own_error::prepare,
    },
];

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
            return Ok(None);
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

/// Computes the study that comes along; a model without a solution is a check that failed.
///
/// # Errors
/// [`Error::Input`] or [`Error::Write`].
pub fn compute_or_fail(case: &Kind, progress: Progress) -> Result<Computed, Error> {
    let ready = case.read(Path::new(case.file), case.study)?;
    match ready.compute(progress) {
        Err(fault @ Error::Solve { .. }) => {
            let check = Check::fault(fault.to_string(), "no fault");
            Ok(Computed {
                title: case.kind.to_owned(),
                kind: case.kind,
                text: case.study.to_owned(),
                defaults: Vec::new(),
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

/// Distance of two series over the size of the second, in relative L2, in %.
fn percent(values: &[f64], reference: &[f64]) -> f64 {
    let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let error = norm(&mut values.iter().zip(reference).map(|(u, v)| u - v));
    100.0 * error / norm(&mut reference.iter().copied())
}

/// A chart as a figure of a case.
fn figure(name: &str, caption: &str, chart: &LineChart) -> Figure {
    Figure::new(name, caption, chart.png())
}

/// The `which`th number of all points over their first one, as a marked line.
fn marked_line<const N: usize>(
    points: &[[f64; N]],
    which: usize,
    label: &str,
    colour: [u8; 3],
) -> Line {
    Line {
        label: label.to_owned(),
        points: points
            .iter()
            .map(|point| [point[0], point[which]])
            .collect(),
        colour,
        stroke: Stroke::Marked,
    }
}

/// A mesh as a figure of a case.
fn mesh_figure(name: &str, caption: &str, title: &str, mesh: &Mesh) -> Figure {
    Figure::new(name, caption, mesh_picture(title, mesh))
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert!(case.read(Path::new(case.file), case.study).is_ok());
            let found = case_of(case.file, case.study).unwrap().unwrap();
            assert_eq!(found.kind, case.kind);
            let text = "kind = \"x\"
misspelt = 1
";
            let told = case
                .read(Path::new("x.toml"), text)
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
