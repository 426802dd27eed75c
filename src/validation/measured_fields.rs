//! Fields from noisy markers with unknown grips, beside the truth.
//!
//! The data come from converged finite elements on another mesh, never from the estimate's own equations.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::case::{Check, Claim, Outcome, Prepared, Progress, Wanted, marked_line, number};
use super::plate::Plate;
use crate::corrector::estimation::{
    EdgeCondition, Knowledge, MeasuredForce, RegressedLaw, Robust, Specimen, Unnamed, estimate,
};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::mesh::{CellShape, Grid, Mesh, Shape};
use crate::output::picture::lines::{Axis, LineChart};
use crate::results::Block;
use crate::studies::plate::study;
use crate::units::Dimension;
use trial::Trial;
use truth::Truth;

mod trial;
mod truth;

struct Settings {
    plate: Plate,
    radius: f64,
    markers: [usize; 2],
    noise: Vec<f64>,
    seeds: u64,
    outliers: f64,
    force_deviation: f64,
    modulus_seeds: u64,
    edge_seeds: u64,
    law: Option<RegressedLaw>,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let card = study::read_card(&root.section("plate"), folder);
    let plate = Plate::read(root, folder);
    let hole = root.section("hole");
    let section = root.section("data");
    let settings = Settings {
        plate,
        radius: hole.quantity("radius", Dimension::Length, Bound::Positive),
        markers: section.count_pair("markers", 3, 400).unwrap_or([3, 3]),
        noise: section.quantities("noise", Dimension::Length, Bound::Positive),
        seeds: section.count("seeds", 1, 10_000) as u64,
        outliers: section.quantity("outliers", Dimension::Ratio, Bound::Positive),
        force_deviation: section.quantity("force_deviation", Dimension::Ratio, Bound::Positive),
        modulus_seeds: section.count("modulus_seeds", 1, 10_000) as u64,
        edge_seeds: section.count("edge_seeds", 1, 10_000) as u64,
        law: card.and_then(|card| {
            let first = card.parameters.first().map(|parameter| parameter.key);
            RegressedLaw::of_card(&card, &first.into_iter().collect::<Vec<_>>()).ok()
        }),
    };
    if settings.noise.is_empty() {
        section.fault("noise", "needs at least one value", "such as [\"0.5 mm\"]");
    }
    hole.unknown_keys();
    section.unknown_keys();
    Box::new(move |progress| compute(&settings, progress))
}

/// A specimen with its truth and the mesh of the estimate.
struct Subject {
    name: &'static str,
    truth: Truth,
    mesh: Mesh,
    places: Vec<[f64; 2]>,
}

/// The noise at which stress, gross errors and modulus are looked at, in mm.
const MIDDLE: f64 = 0.5;

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let (mut rows, mut points) = (Vec::new(), Vec::new());
    for subject in [plate(settings)?, strip(settings)?] {
        for noise in &settings.noise {
            progress(&format!("{}, noise of {noise} mm", subject.name));
            let trials = subject.trials(settings, *noise, 0.0, Robust::No)?;
            rows.push(row(&subject, *noise, &trials));
            check_trials(&mut outcome, &subject, *noise, &trials);
            if subject.name == PLATE {
                let median = |value: fn(&Trial) -> f64| spread(&trials, value)[1];
                points.push([
                    *noise,
                    median(|trial| trial.before),
                    median(|trial| trial.after),
                ]);
            }
        }
        for robust in [Robust::Huber, Robust::Tukey] {
            progress(&format!("{}, gross errors, {robust:?}", subject.name));
            let trials = subject.trials(settings, MIDDLE, settings.outliers, robust)?;
            check_outliers(&mut outcome, &subject, robust, &trials);
        }
        progress(&format!("{}, unnamed edges", subject.name));
        check_edges(&mut outcome, settings, &subject)?;
        if let Some(law) = &settings.law {
            progress(&format!("{}, modulus", subject.name));
            check_modulus(&mut outcome, settings, &subject, law)?;
        }
    }
    progress("100,000 nodes");
    outcome.times.push(large(settings)?);
    outcome.blocks = vec![
        Block::Paragraph(EXPLANATION.into()),
        Block::table(&HEAD, rows),
    ];
    outcome.figures.push(super::case::figure(
        "measured_fields.png",
        "Noisy markers before and after.",
        &chart(&points),
    ));
    Ok(outcome)
}

const PLATE: &str = "plate";

const EXPLANATION: &str = "Displacements of markers with normal noise, read from converged biquadratic finite elements on \
    another mesh; of the grips nothing is known, the long edges are free. Each cell shows the median of all seeds and, in \
    brackets, the worst one. Displacements are compared at the markers, stresses in the middle of all cells farther than a \
    fifth of the width from a corner, both as root mean squares; the raw stress comes from differences of neighbouring \
    markers. Coverage is the share of all nodes and stresses, and of all seeds, that lie within their 95 % intervals.";

const HEAD: [&str; 8] = [
    "specimen, noise",
    "noise found [mm]",
    "before [mm]",
    "after [mm]",
    "stress, raw [%]",
    "stress [%]",
    "displacements covered [%]",
    "stresses covered [%]",
];

fn plate(settings: &Settings) -> Result<Subject, Error> {
    let problem = &settings.plate.problem;
    let grid = |cells: [usize; 2]| Grid {
        size: problem.size,
        cells,
        grading: 2.0,
    };
    let fine = settings.plate.cells.map(|cells| 2 * cells + 3);
    Subject::new(
        settings,
        PLATE,
        Mesh::of_grid(grid(fine), CellShape::Quad9),
        Mesh::of_grid(grid(settings.plate.cells), CellShape::Quad9),
    )
}

fn strip(settings: &Settings) -> Result<Subject, Error> {
    let shape = Shape::StripWithHole {
        size: settings.plate.problem.size,
        radius: settings.radius,
    };
    shape
        .check()
        .map_err(|message| Error::input(message, "look at the section `hole`"))?;
    let across = settings.plate.cells[1];
    Subject::new(
        settings,
        "strip with a hole",
        shape.mesh(2 * across + 3, CellShape::Quad9),
        shape.mesh(across, CellShape::Quad9),
    )
}

impl Subject {
    fn new(settings: &Settings, name: &'static str, fine: Mesh, mesh: Mesh) -> Result<Self, Error> {
        let problem = &settings.plate.problem;
        let stretch = settings.plate.stretch();
        let truth = Truth::new(fine, &problem.law, problem.thickness, stretch)?;
        Ok(Self {
            name,
            places: truth.places(settings.markers),
            truth,
            mesh,
        })
    }

    fn specimen(&self, settings: &Settings) -> Specimen<'_> {
        Specimen {
            mesh: &self.mesh,
            law: Arc::clone(&self.truth.law),
            thickness: settings.plate.problem.thickness,
        }
    }

    /// The estimates of all seeds beside the truth.
    fn trials(
        &self,
        settings: &Settings,
        noise: f64,
        outliers: f64,
        robust: Robust,
    ) -> Result<Vec<Trial>, Error> {
        let specimen = self.specimen(settings);
        let knowledge = Knowledge {
            robust,
            ..unknown_grips()
        };
        let trial = |seed: u64| {
            let data = self.truth.markers(&self.places, noise, outliers, seed);
            let found = estimate(&specimen, &data.markers, &knowledge)?;
            Ok(Trial::new(&self.truth, &self.mesh, &data, &found))
        };
        (0..settings.seeds).into_par_iter().map(trial).collect()
    }
}

/// Nothing is known of the grips, the long edges are free.
fn unknown_grips() -> Knowledge {
    let edge = |(name, condition): (&str, EdgeCondition)| (name.to_owned(), condition);
    let grips = ["left", "right"].map(|name| (name, EdgeCondition::Unknown));
    let free = ["bottom", "top"].map(|name| (name, EdgeCondition::Free));
    Knowledge {
        edges: grips.into_iter().chain(free).map(edge).collect(),
        ..Knowledge::default()
    }
}

/// Least, median and largest value of all trials.
fn spread(trials: &[Trial], value: fn(&Trial) -> f64) -> [f64; 3] {
    let mut values: Vec<f64> = trials.iter().map(value).collect();
    values.sort_by(f64::total_cmp);
    [
        values[0],
        values[values.len() / 2],
        values[values.len() - 1],
    ]
}

fn mean(trials: &[Trial], value: fn(&Trial) -> f64) -> f64 {
    trials.iter().map(value).sum::<f64>() / trials.len() as f64
}

fn row(subject: &Subject, noise: f64, trials: &[Trial]) -> Vec<String> {
    let worst = |value: fn(&Trial) -> f64| {
        let [_, median, most] = spread(trials, value);
        format!("{} ({})", number(median), number(most))
    };
    vec![
        format!("{}, {noise} mm", subject.name),
        worst(|trial| trial.noise),
        worst(|trial| trial.before),
        worst(|trial| trial.after),
        worst(|trial| trial.differences),
        worst(|trial| trial.stress),
        number(mean(trials, |trial| trial.displacement_cover)),
        number(mean(trials, |trial| trial.stress_cover)),
    ]
}

const SOURCE: &str = "aim";

fn check_trials(outcome: &mut Outcome, subject: &Subject, noise: f64, trials: &[Trial]) {
    let mut check = |quantity: &str, wanted: Wanted, value: f64| {
        let quantity = format!("{}, noise of {noise} mm: {quantity}", subject.name);
        outcome
            .checks
            .push(Check::new(quantity, "%", wanted, SOURCE, value));
    };
    let fall = spread(trials, Trial::fall);
    check(
        "fall of the displacement's error, worst seed",
        Wanted::AtLeast(80.0),
        fall[0],
    );
    let covers = [
        (
            "displacements in their 95 % intervals",
            mean(trials, |trial| trial.displacement_cover),
        ),
        (
            "stresses in their 95 % intervals",
            mean(trials, |trial| trial.stress_cover),
        ),
    ];
    for (quantity, cover) in covers {
        check(quantity, Wanted::AtLeast(90.0), cover);
        check(quantity, Wanted::AtMost(99.0), cover);
    }
    if noise == MIDDLE {
        let [least, _, _] = spread(trials, |trial| trial.differences);
        let [_, _, most] = spread(trials, |trial| trial.stress);
        check("error of the stress, worst seed", Wanted::AtMost(5.0), most);
        check(
            "error of the stress from differences, best seed",
            Wanted::AtLeast(50.0),
            least,
        );
        outcome.claims.push(Claim {
            claim: "The technique smooths results of other methods",
            reproduced: format!(
                "markers with a noise of {noise} mm on a {} with unknown grips: the displacement's error falls by {} %, that of \
                 the stress from {} to {} % (medians)",
                subject.name,
                number(fall[1]),
                number(spread(trials, |trial| trial.differences)[1]),
                number(spread(trials, |trial| trial.stress)[1]),
            ),
        });
    }
}

fn check_outliers(outcome: &mut Outcome, subject: &Subject, robust: Robust, trials: &[Trial]) {
    let share = |count: fn(&Trial) -> [usize; 2]| {
        let sum = |which: usize| {
            trials
                .iter()
                .map(|trial| count(trial)[which])
                .sum::<usize>()
        };
        100.0 * sum(0) as f64 / sum(1) as f64
    };
    let (hits, alarms) = (share(|trial| trial.hits), share(|trial| trial.alarms));
    let [least, _, _] = spread(trials, Trial::fall);
    for (quantity, wanted, value) in [
        ("gross errors found", Wanted::AtLeast(95.0), hits),
        (
            "sound markers taken for gross errors",
            Wanted::AtMost(1.0),
            alarms,
        ),
        (
            "fall of the displacement's error with gross errors, worst seed",
            Wanted::AtLeast(80.0),
            least,
        ),
    ] {
        let quantity = format!("{}, {robust:?}: {quantity}", subject.name);
        outcome
            .checks
            .push(Check::new(quantity, "%", wanted, SOURCE, value));
    }
}

/// Nothing is said of any edge: the data tell which ones are free.
fn check_edges(outcome: &mut Outcome, settings: &Settings, subject: &Subject) -> Result<(), Error> {
    let specimen = subject.specimen(settings);
    let knowledge = Knowledge {
        unnamed: Unnamed::Tested,
        ..Knowledge::default()
    };
    let length = settings.plate.problem.size[0];
    let right = |seed: u64| -> Result<bool, Error> {
        let data = subject.truth.markers(&subject.places, MIDDLE, 0.0, seed);
        let found = estimate(&specimen, &data.markers, &knowledge)?;
        let free = found.edges.iter().filter(|edge| edge.probability.is_some());
        Ok(free.clone().count() == 4
            && free.into_iter().all(|edge| {
                let is_long = edge.length > 0.9 * length;
                is_long == (edge.condition == EdgeCondition::Free)
            }))
    };
    let told: Result<Vec<bool>, Error> = (0..settings.edge_seeds)
        .into_par_iter()
        .map(right)
        .collect();
    let told = told?;
    let share = 100.0 * told.iter().filter(|right| **right).count() as f64 / told.len() as f64;
    let quantity = format!(
        "{}: seeds whose data tell the free edges from the grips",
        subject.name
    );
    outcome.checks.push(Check::new(
        quantity,
        "%",
        Wanted::AtLeast(90.0),
        SOURCE,
        share,
    ));
    Ok(())
}

/// The first parameter of the law, from the field and the force.
fn check_modulus(
    outcome: &mut Outcome,
    settings: &Settings,
    subject: &Subject,
    law: &RegressedLaw,
) -> Result<(), Error> {
    let specimen = subject.specimen(settings);
    let truth = law.start()[0];
    let deviation = settings.force_deviation * subject.truth.force;
    let inside = |seed: u64| -> Result<[f64; 2], Error> {
        let data = subject.truth.markers(&subject.places, MIDDLE, 0.0, seed);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(1);
        let draw: f64 = StandardNormal.sample(&mut random);
        let knowledge = Knowledge {
            forces: vec![MeasuredForce {
                edge: "right".into(),
                axis: 0,
                force: subject.truth.force + deviation * draw,
                standard_deviation: deviation,
            }],
            law: Some(law.scaled(1.3)),
            ..unknown_grips()
        };
        let found = estimate(&specimen, &data.markers, &knowledge)?;
        let (_, _, modulus) = found.parameters[0];
        let [low, high] = modulus.interval;
        let covered = f64::from(u8::from(low <= truth && truth <= high));
        Ok([covered, 100.0 * (modulus.value / truth - 1.0).abs()])
    };
    let found: Result<Vec<[f64; 2]>, Error> = (0..settings.modulus_seeds)
        .into_par_iter()
        .map(inside)
        .collect();
    let found = found?;
    let mean = |which: usize| found.iter().map(|one| one[which]).sum::<f64>() / found.len() as f64;
    let key = law.parameters()[0].key;
    let quantity = format!("{}: seeds with {key} in its 95 % interval", subject.name);
    let check = Check::new(
        quantity,
        "%",
        Wanted::AtLeast(90.0),
        SOURCE,
        100.0 * mean(0),
    );
    outcome.checks.push(check);
    let quantity = format!("{}: mean error of {key}", subject.name);
    let wanted = Wanted::AtMost(2.0);
    outcome
        .checks
        .push(Check::new(quantity, "%", wanted, SOURCE, mean(1)));
    Ok(())
}

/// The time of one estimate on a hundred thousand nodes.
fn large(settings: &Settings) -> Result<(String, f64), Error> {
    let problem = &settings.plate.problem;
    let subject = plate(settings)?;
    let specimen = Specimen {
        mesh: &Mesh::plate(problem.size, [549, 183], CellShape::Quad4),
        law: Arc::clone(&problem.law),
        thickness: problem.thickness,
    };
    let data = subject.truth.markers(&subject.places, MIDDLE, 0.0, 0);
    let start = Instant::now();
    estimate(&specimen, &data.markers, &unknown_grips())?;
    let what = format!("estimate on {} nodes", specimen.mesh.nodes.len());
    Ok((what, start.elapsed().as_secs_f64()))
}

fn chart(points: &[[f64; 3]]) -> LineChart {
    let line = |label, which, colour| marked_line(points, which, label, colour);
    LineChart {
        title: "Noisy markers with unknown grips".into(),
        x: Axis::linear("noise of each component [mm]"),
        y: Axis::logarithmic("error of the displacement, median [mm]"),
        lines: vec![
            line("markers", 1, [213, 94, 0]),
            line("estimated field", 2, [0, 158, 115]),
        ],
        band: None,
    }
}
