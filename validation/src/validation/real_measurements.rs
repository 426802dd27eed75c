//! Fields measured by other groups: is what is wrong with them told?

use std::path::Path;

use super::case::{Block, Check, Computation, Outcome, Progress, check, number, section, table};
use crate::budget::Budget;
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::estimation::{Answer, EdgeCondition, FieldEstimate};
use crate::markers::ReadSettings;
use crate::mesh::{CellShape, MeshReading};
use crate::statistics::larger;
use crate::studies::markers::{Conditions, MarkerStudy, MeshSource, Request};
use crate::units::Dimension;

/// Forces are in balance up to rounding.
const BALANCE: f64 = 1e-9;

const ANSWERS: [(&str, Answer); 4] = [
    ("explained", Answer::Explained),
    ("correlated", Answer::Correlated),
    ("undecided", Answer::Undecided),
    ("not-explained", Answer::NotExplained),
];

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let material = section(root, "material", |material| material.text("card"));
    let fields = root.tables("field").into_iter().map(|field| {
        let read = MeasuredField::read(&field, folder, &material);
        field.unknown_keys();
        read
    });
    let fields: Vec<MeasuredField> = fields.collect();
    Box::new(move |progress| Ok(compute(fields, progress)))
}

/// A field with what its user would say of it.
struct MeasuredField {
    name: String,
    request: Request,
    /// What the verdict must be.
    expected: Answer,
    /// Why it must be that.
    why: String,
}

impl MeasuredField {
    fn read(field: &Section, folder: &Path, material: &str) -> Self {
        let position = |name: &String| folder.join(name);
        let mesh = field.optional_text("mesh");
        let conditions = [
            ("free", EdgeCondition::Free),
            ("rigid", EdgeCondition::Rigid),
            ("rest", EdgeCondition::Known([Some(0.0); 2])),
        ];
        let mut edges = Vec::new();
        for (key, condition) in conditions {
            if field.has(key) {
                let names = field.texts(key).into_iter();
                edges.extend(names.map(|name| (name, condition)));
            }
        }
        let pixel = || field.quantity("pixel", Dimension::Length, Bound::Positive);
        Self {
            name: field.text("name"),
            request: Request {
                files: field.texts("files").iter().map(position).collect(),
                reading: ReadSettings {
                    unit: field.has("pixel").then(pixel),
                    ..ReadSettings::default()
                },
                images: Default::default(),
                material: material.to_owned(),
                thickness: field.quantity("thickness", Dimension::Length, Bound::Positive),
                mesh: match mesh.as_str() {
                    "" => MeshSource::Data,
                    name => MeshSource::File(folder.join(name), MeshReading::in_unit(1.0)),
                },
                cell_size: None,
                shape: CellShape::Triangle6,
                holes: true,
                conditions: Conditions {
                    edges,
                    ..Conditions::default()
                },
                forces: None,
                budget: Budget::USUAL,
            },
            expected: field.choice("verdict", &ANSWERS).unwrap_or_default(),
            why: field.text("why"),
        }
    }

    /// The numbers of the frames and their estimates.
    fn estimate(&self) -> Result<Estimated, Error> {
        let mut study = MarkerStudy::prepare(self.request.clone(), &|_| ())?;
        let estimates = study.estimate(&|_| ())?;
        let frames = study.series.frames.iter();
        let frames = frames.map(|frame| (frame.number, frame.markers.len()));
        Ok(Estimated {
            frames: frames.collect(),
            estimates,
        })
    }
}

/// What was found of a field.
struct Estimated {
    /// Number and markers of each frame.
    frames: Vec<(usize, usize)>,
    estimates: Vec<FieldEstimate>,
}

impl Estimated {
    fn rows(&self, name: &str) -> Vec<Vec<String>> {
        let frames = self.frames.iter().zip(&self.estimates);
        let row = |((frame, markers), actual): (&(usize, usize), &FieldEstimate)| {
            let verdict = &actual.verdict;
            let reasons: Vec<String> = verdict.reasons.iter().map(|one| one.words()).collect();
            let trial = verdict.trials.first().filter(|_| !reasons.is_empty());
            let length = verdict.correlation.map(|one| number(one.length));
            vec![
                name.to_owned(),
                frame.to_string(),
                markers.to_string(),
                number(actual.noise),
                length.unwrap_or_default(),
                verdict.answer.words().to_owned(),
                reasons.join("; "),
                trial
                    .map(|trial| trial.alternative.words())
                    .unwrap_or_default(),
            ]
        };
        frames.map(row).collect()
    }

    fn checks(&self, name: &str, expected: Answer) -> [Check; 2] {
        let count = self.estimates.len() as f64;
        let message = self.estimates.iter();
        let message = message
            .filter(|actual| meets(actual.verdict.answer, expected))
            .count() as f64;
        let imbalance = self.estimates.iter().map(|actual| actual.imbalance);
        let imbalance = imbalance.fold(0.0, larger);
        [
            check(
                format!("{name}: frames that are {}", required(expected)),
                "%",
                100.0 * message / count,
            )
            .at_least(100.0, "all frames share the same faults"),
            check(
                format!("{name}: sum of all forces over the largest"),
                "",
                imbalance,
            )
            .at_most(BALANCE, "equilibrium"),
        ]
    }
}

/// Whether an answer is the expected one; where the data may be unable to judge, a refutation is as good.
fn meets(answer: Answer, expected: Answer) -> bool {
    answer == expected || (expected == Answer::Undecided && answer == Answer::NotExplained)
}

fn required(expected: Answer) -> &'static str {
    match expected {
        Answer::Undecided => "not explained or cannot be judged",
        answer => answer.words(),
    }
}

const HEAD: &str = "field | frame | markers | noise [mm] | correlation length [mm] | verdict | why | best alternative";

const EXPLANATION: &str = "Each field is corrected with an incompressible law, an assumed thickness and conditions that are \
    only partly true, as an uninformed user would do. The verdict must be that the data are not explained, \
    or that they cannot judge; no intervals are given where they are not explained. Each alternative that might explain the \
    misfit is evaluated in one linearised step.";

fn compute(fields: Vec<MeasuredField>, progress: Progress) -> Outcome {
    let mut outcome = Outcome::default();
    let (mut rows, mut reasons) = (Vec::new(), Vec::new());
    for field in &fields {
        progress.tell(&field.name);
        match field.estimate() {
            Ok(actual) => {
                rows.extend(actual.rows(&field.name));
                outcome
                    .checks
                    .extend(actual.checks(&field.name, field.expected));
            }
            // Failures are shown among the others.
            Err(fault) => outcome.checks.push(Check::fault(
                format!("{}: {fault}", field.name),
                "a field and its verdict",
            )),
        }
        reasons.push(Block::paragraph(format!("{}: {}", field.name, field.why)));
    }
    outcome.blocks = vec![Block::paragraph(EXPLANATION), table(HEAD, rows)];
    outcome.blocks.extend(reasons);
    outcome
}
