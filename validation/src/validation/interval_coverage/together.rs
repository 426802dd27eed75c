//! Parameters from all frames of a test together: how often their 95 % intervals hold the truth, how well the forces of frames that
//! are left out are predicted, and whether the right law is found among others.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;

use super::subject::{CorrelatedDraws, Data, Subject, unknown_grips};
use super::trials::TARGET;
use super::truth::Truth;
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::estimation::{
    JointEstimate, JointFrame, JointSettings, Knowledge, MeasuredForce, RegressedLaw, Specimen,
    estimate_jointly,
};
use crate::markers::Marker;
use crate::material::Card;
use crate::mesh::CellShape;
use crate::mesh::Shape;
use crate::results::Block;
use crate::studies::card::read_card;
use crate::units::Dimension;
use crate::validation::case::{
    Check, Computation, Outcome, Progress, check, mean, normal_numbers_of_stream, number, section,
    share, table,
};
use crate::validation::plate::{Plate, read_noise};

/// The law that is wrong.
const WRONG_LAW: &str = "neo-hooke";

struct Settings {
    data: Data,
    frames: usize,
    noise: f64,
    seeds: u64,
    force_deviation: f64,
    law: Option<RegressedLaw>,
    wrong_law: Option<RegressedLaw>,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let all = |card: &Card| RegressedLaw::of_card(card, &["all"]).ok();
    let law = read_card(&root.section("plate"), folder);
    let plate = Plate::read(root, folder);
    let settings = section(root, "data", |section| Settings {
        data: Data::read(plate, root, section),
        frames: section.count("frames", 2, 100),
        noise: read_noise(section).first().copied().unwrap_or_default(),
        seeds: section.count("seeds", 1, 10_000) as u64,
        force_deviation: section.quantity("force_deviation", Dimension::Ratio, Bound::Positive),
        law: law.as_ref().and_then(all),
        wrong_law: Card::load(WRONG_LAW, folder).ok().as_ref().and_then(all),
    });
    Box::new(move |progress| compute(&settings, progress))
}

/// Noise of the frames.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    /// Over so many spacings of the markers.
    length: Option<f64>,
    /// Whether the picture at rest has as much of it as each frame.
    at_rest: bool,
}

const KINDS: [Kind; 3] = [
    Kind {
        name: "white noise",
        length: None,
        at_rest: false,
    },
    Kind {
        name: "white noise, also in the reference picture",
        length: None,
        at_rest: true,
    },
    Kind {
        name: "noise correlated over 1 spacing",
        length: Some(1.0),
        at_rest: false,
    },
];

/// The frames of a test without noise.
struct Test {
    subject: Subject,
    markers: Vec<Vec<Marker>>,
    forces: Vec<f64>,
}

/// What came of one seed.
struct Trial {
    held: Vec<bool>,
    /// Root mean square error of the forces left out, by the right law and the wrong one, in percent.
    predicted: [f64; 2],
    is_right_first: bool,
    common: f64,
}

impl Test {
    fn new(settings: &Settings) -> Result<Self, Error> {
        let data = &settings.data;
        let subject = Subject::strip(data)?.with_markers_inside(data.markers);
        let problem = &data.plate.problem;
        let shape = Shape::StripWithHole {
            size: problem.size,
            radius: data.radius,
        };
        let fine = 5 * data.plate.cells[1] + 3;
        let frames = 1..=settings.frames;
        let truths: Result<Vec<Truth>, Error> = frames
            .into_par_iter()
            .map(|frame| {
                let stretch = data.plate.stretch() * frame as f64 / settings.frames as f64;
                Truth::new(shape.mesh(fine, CellShape::Quad9), problem, stretch)
            })
            .collect();
        let truths = truths?;
        let exact = |truth: &Truth| truth.markers(subject.positions(), 0.0, 0.0, 0).markers;
        Ok(Self {
            markers: truths.iter().map(exact).collect(),
            forces: truths.iter().map(|truth| truth.force).collect(),
            subject,
        })
    }

    fn trial(&self, settings: &Settings, kind: Kind, seed: u64) -> Result<Trial, Error> {
        let draws = CorrelatedDraws::new(self.subject.positions(), kind.length);
        let mut markers = self.markers.clone();
        for (index, markers) in markers.iter_mut().enumerate() {
            draws.disturb(markers, settings.noise, 1000 * seed + index as u64);
            if kind.at_rest {
                draws.disturb(markers, settings.noise, 1000 * seed + 999);
            }
        }
        let off = normal_numbers_of_stream(seed, 7).take(self.forces.len());
        let knowledge = self.forces.iter().zip(off).map(|(force, off)| {
            let deviation = settings.force_deviation * force;
            Knowledge {
                forces: vec![MeasuredForce {
                    edge: "right".into(),
                    axis: 0,
                    force: force + deviation * off,
                    standard_deviation: deviation,
                    common_deviation: 0.0,
                }],
                ..unknown_grips()
            }
        });
        let frames = markers.iter().zip(knowledge);
        let frames = frames.map(|(markers, knowledge)| JointFrame {
            specimen: Specimen {
                mesh: &self.subject.mesh,
                laws: Arc::clone(&self.subject.truth.law).into(),
                thickness: settings.data.plate.problem.thickness,
            },
            markers,
            knowledge,
        });
        judged(&frames.collect::<Vec<_>>(), settings)
    }
}

fn judged(frames: &[JointFrame], settings: &Settings) -> Result<Trial, Error> {
    let none = || Error::input("the card's law cannot be fitted", "name another card");
    let laws = settings.law.as_ref().zip(settings.wrong_law.as_ref());
    let (right, wrong) = laws.ok_or_else(none)?;
    let truth = right.start();
    let find = |law: &RegressedLaw, profiles: bool| {
        let joint = JointSettings {
            profiles,
            ..JointSettings::default()
        };
        estimate_jointly(frames, law, &joint, &|_| ())
    };
    let actual = find(&right.scaled(1.2), true)?;
    let other = find(wrong, false)?;
    let error = |actual: &JointEstimate| 100.0 * actual.prediction_error().unwrap_or(f64::INFINITY);
    let parameters = actual.parameters.iter().zip(&truth);
    let criterion = |one: &JointEstimate| one.information_criterion(&[&actual, &other]);
    Ok(Trial {
        held: parameters
            .map(|(actual, truth)| actual.holds(*truth))
            .collect(),
        predicted: [error(&actual), error(&other)],
        is_right_first: error(&actual) < error(&other) && criterion(&actual) < criterion(&other),
        common: actual.common,
    })
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let test = Test::new(settings)?;
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for kind in KINDS {
        progress.tell(kind.name);
        let trials: Result<Vec<Trial>, Error> = (0..settings.seeds)
            .into_par_iter()
            .map(|seed| test.trial(settings, kind, seed))
            .collect();
        let trials = trials?;
        rows.push(row(kind, &trials));
        outcome.checks.extend(checks(kind, &trials));
    }
    outcome.blocks = vec![Block::paragraph(EXPLANATION), table(HEAD, rows)];
    Ok(outcome)
}

const HEAD: &str = "data | parameters in their intervals [%] | error of the predicted force of a left-out frame [%] | the \
                    same for a neo-Hookean law [%] | right law ranked first [%] | correlation from frame to frame";

const EXPLANATION: &str = "Five frames of a strip with a hole, from converged finite elements with a Yeoh law, each with a \
    force measured to 1 %; the grips are unknown. All three parameters are estimated from all frames together, with initial \
    values 20 % too large. The force of each frame is predicted from its markers and the law fitted to the other frames. The \
    right law has to rank first both by these predictions and by AICc.";

fn covered(trials: &[Trial]) -> f64 {
    share(trials.iter().flat_map(|trial| trial.held.iter().copied()))
}

fn first(trials: &[Trial]) -> f64 {
    share(trials.iter().map(|trial| trial.is_right_first))
}

fn row(kind: Kind, trials: &[Trial]) -> Vec<String> {
    let predicted = |law: usize| mean(trials.iter().map(|trial| trial.predicted[law]));
    vec![
        kind.name.to_owned(),
        number(covered(trials)),
        number(predicted(0)),
        number(predicted(1)),
        number(first(trials)),
        number(mean(trials.iter().map(|trial| trial.common))),
    ]
}

fn checks(kind: Kind, trials: &[Trial]) -> [Check; 2] {
    let of = |what: &str| format!("{}: {what}", kind.name);
    let held = check(
        of("parameters in their 95 % intervals"),
        "%",
        covered(trials),
    );
    [
        held.at_least(90.0, TARGET),
        check(of("the right law ranks first"), "%", first(trials)).at_least(95.0, TARGET),
    ]
}
