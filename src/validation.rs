//! Cases that redo the claims of the publication and hold gelbench to other codes and to mathematics.
//!
//! A case is a study file with a `kind` of its own: `gelbench run` computes one, `gelbench validate` all.

use std::path::Path;
use std::time::Instant;

use crate::document::{Document, Faults, Section};
use crate::error::{Diagnostic, Error, suggestion};
use crate::mesh::Mesh;
use crate::output::picture::lines::{Line, LineChart, Stroke};
use crate::output::{Figure, mesh_picture};

mod correction_matrix;
mod cost;
mod finite_elements;
mod flagship;
mod measured_fields;
mod motion;
mod motion_correction;
mod nonlinear_spring;
mod oscillator;
mod other_codes;
pub mod outcome;
mod plate;
mod plate_ablation;
pub mod report;
mod smoothing;
pub mod specimen;
mod spring_identification;
mod vibrating_plate;
mod vibrating_spring;

pub use outcome::{Check, Claim, Computed, Outcome, Wanted};

/// Reports what is being done.
pub type Progress<'a> = &'a dyn Fn(&str);

/// A study of a case that has been read, ready to be computed.
pub struct Ready {
    title: String,
    kind: &'static str,
    text: String,
    defaults: Vec<String>,
    prepared: Prepared,
    /// What deserves attention but does not stop the work.
    pub warnings: Vec<Diagnostic>,
}

/// The computation of a case.
type Prepared = Box<dyn FnOnce(Progress) -> Result<Outcome, Error>>;

/// A kind of study that checks something.
pub struct Case {
    /// The `kind` of its studies.
    pub kind: &'static str,
    /// The study that comes along; its keys are the defaults.
    pub study: &'static str,
    /// Where that study stands.
    pub file: &'static str,
    /// Whether `--quick` leaves it out.
    pub slow: bool,
    prepare: fn(&Section, &Path) -> Prepared,
}

/// All cases, in the order of the report.
pub const CASES: &[Case] = &[
    Case {
        kind: "nonlinear-spring",
        study: include_str!("../examples/nonlinear_spring.toml"),
        file: "examples/nonlinear_spring.toml",
        slow: false,
        prepare: nonlinear_spring::prepare,
    },
    Case {
        kind: "plate-ablation",
        study: include_str!("../examples/plate_ablation.toml"),
        file: "examples/plate_ablation.toml",
        slow: false,
        prepare: plate_ablation::prepare,
    },
    Case {
        kind: "flagship",
        study: include_str!("../validation/cases/flagship.toml"),
        file: "validation/cases/flagship.toml",
        slow: true,
        prepare: flagship::prepare,
    },
    Case {
        kind: "vibrating-spring",
        study: include_str!("../examples/vibrating_spring.toml"),
        file: "examples/vibrating_spring.toml",
        slow: false,
        prepare: vibrating_spring::prepare,
    },
    Case {
        kind: "spring-identification",
        study: include_str!("../examples/spring_identification.toml"),
        file: "examples/spring_identification.toml",
        slow: true,
        prepare: spring_identification::prepare,
    },
    Case {
        kind: "smoothing",
        study: include_str!("../examples/smoothing.toml"),
        file: "examples/smoothing.toml",
        slow: true,
        prepare: smoothing::prepare,
    },
    Case {
        kind: "measured-fields",
        study: include_str!("../validation/cases/measured_fields.toml"),
        file: "validation/cases/measured_fields.toml",
        slow: true,
        prepare: measured_fields::prepare,
    },
    Case {
        kind: specimen::KIND,
        study: include_str!("../examples/strip_with_hole.toml"),
        file: "examples/strip_with_hole.toml",
        slow: true,
        prepare: specimen::prepare,
    },
    Case {
        kind: "motion",
        study: include_str!("../examples/released_plate.toml"),
        file: "examples/released_plate.toml",
        slow: true,
        prepare: motion::prepare,
    },
    Case {
        kind: "cost",
        study: include_str!("../examples/cost.toml"),
        file: "examples/cost.toml",
        slow: true,
        prepare: cost::prepare,
    },
    Case {
        kind: "correction-matrix",
        study: include_str!("../validation/correction_matrix.toml"),
        file: "validation/correction_matrix.toml",
        slow: false,
        prepare: correction_matrix::prepare,
    },
    Case {
        kind: "other-codes",
        study: include_str!("../validation/other_codes.toml"),
        file: "validation/other_codes.toml",
        slow: true,
        prepare: other_codes::prepare,
    },
    Case {
        kind: "patch-tests",
        study: include_str!("../validation/cases/patch_tests.toml"),
        file: "validation/cases/patch_tests.toml",
        slow: false,
        prepare: finite_elements::patch::prepare,
    },
    Case {
        kind: "manufactured-solution",
        study: include_str!("../validation/cases/manufactured_solution.toml"),
        file: "validation/cases/manufactured_solution.toml",
        slow: false,
        prepare: finite_elements::manufactured::prepare,
    },
    Case {
        kind: "hole",
        study: include_str!("../validation/cases/hole.toml"),
        file: "validation/cases/hole.toml",
        slow: false,
        prepare: finite_elements::hole::prepare,
    },
    Case {
        kind: "ring",
        study: include_str!("../validation/cases/ring.toml"),
        file: "validation/cases/ring.toml",
        slow: false,
        prepare: finite_elements::ring::prepare,
    },
    Case {
        kind: "curved-meshes",
        study: include_str!("../validation/cases/curved_meshes.toml"),
        file: "validation/cases/curved_meshes.toml",
        slow: true,
        prepare: finite_elements::curved_meshes::prepare,
    },
    Case {
        kind: "cantilever",
        study: include_str!("../validation/cases/cantilever.toml"),
        file: "validation/cases/cantilever.toml",
        slow: false,
        prepare: finite_elements::cantilever::prepare,
    },
    Case {
        kind: "cook",
        study: include_str!("../validation/cases/cook.toml"),
        file: "validation/cases/cook.toml",
        slow: true,
        prepare: finite_elements::cook::prepare,
    },
    Case {
        kind: "motion-correction",
        study: include_str!("../validation/cases/motion_correction.toml"),
        file: "validation/cases/motion_correction.toml",
        slow: true,
        prepare: motion_correction::prepare,
    },
    Case {
        kind: "vibrating-plate",
        study: include_str!("../validation/cases/vibrating_plate.toml"),
        file: "validation/cases/vibrating_plate.toml",
        slow: false,
        prepare: vibrating_plate::prepare,
    },
    Case {
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
pub fn choose(names: &[String], quick: bool) -> Result<Vec<&'static Case>, Error> {
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
pub fn case_of(file: &str, text: &str) -> Result<Option<&'static Case>, Error> {
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

impl Case {
    /// Computes the study that comes along; a model without a solution is a check that failed.
    ///
    /// # Errors
    /// [`Error::Input`] or [`Error::Write`].
    pub fn compute_or_fail(&self, progress: Progress) -> Result<Computed, Error> {
        let ready = self.read(Path::new(self.file), self.study)?;
        match ready.compute(progress) {
            Err(fault @ Error::Solve { .. }) => {
                let check = Check::fault(fault.to_string(), "no fault");
                Ok(Computed {
                    title: self.kind.to_owned(),
                    kind: self.kind,
                    text: self.study.to_owned(),
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

    /// Reads a study of this case.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault.
    pub fn read(&self, file: &Path, text: &str) -> Result<Ready, Error> {
        let read = self.read_with(file, text, self.prepare)?;
        Ok(Ready {
            title: read.title,
            kind: self.kind,
            text: text.to_owned(),
            defaults: read.defaults,
            prepared: read.made,
            warnings: read.warnings,
        })
    }

    /// What `read` makes of a study of this case.
    fn read_with<T>(
        &self,
        file: &Path,
        text: &str,
        read: impl FnOnce(&Section, &Path) -> T,
    ) -> Result<Read<T>, Error> {
        let folder = file.parent().unwrap_or(Path::new("."));
        let file = file.display().to_string();
        let faults = Faults::default();
        let (title, made) = {
            let defaults = Document::parse(self.file, self.study, &faults);
            let document = Document::parse(&file, text, &faults);
            let root = document.root(Some(&defaults), &faults);
            root.text("kind");
            let title = root.heading("title");
            let made = read(&root, folder);
            root.unknown_keys();
            (title, made)
        };
        let defaults = faults.defaults();
        let warnings = faults.finish()?;
        Ok(Read {
            title,
            made,
            defaults,
            warnings,
        })
    }
}

/// What was read of a study.
struct Read<T> {
    title: String,
    made: T,
    /// The keys that it does not hold, with the defaults that they took.
    defaults: Vec<String>,
    warnings: Vec<Diagnostic>,
}

impl Ready {
    /// Computes the study.
    ///
    /// # Errors
    /// [`Error::Solve`] when a model has no solution.
    pub fn compute(self, progress: Progress) -> Result<Computed, Error> {
        let start = Instant::now();
        let outcome = (self.prepared)(progress)?;
        Ok(Computed {
            title: self.title,
            kind: self.kind,
            text: self.text,
            defaults: self.defaults,
            outcome,
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}

/// A number as a table shows it: five significant digits, or powers of ten where it is far from one.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor();
    if (-3.0..5.0).contains(&exponent) {
        let digits = (4.0 - exponent).max(0.0) as usize;
        return format!("{value:.digits$}");
    }
    format!("{value:.2e}")
}

/// A limit as a person would write it.
pub fn limit(value: f64) -> String {
    match value.abs() {
        small if small > 0.0 && small < 1e-3 => format!("{value:e}"),
        _ => value.to_string(),
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
