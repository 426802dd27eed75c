//! Fields estimated from noisy markers with unknown grips, compared with the truth: how far errors fall, and how often the
//! stated intervals hold the truth.
//!
//! The data come from converged finite elements on another mesh, never from the estimate's own equations.

use std::path::Path;
use std::sync::Arc;

use super::case::{Block, Computation, Figure, Outcome, Progress, line, section, table};
use super::plate::{Plate, read_noise};
use web_time::Instant;

use crate::document::{Bound, Section};
use crate::error::Error;
use crate::estimation::{RegressedLaw, Robust, Specimen, estimate};
use crate::mesh::{CellShape, Mesh};
use crate::results::{Axis, LineChart, Stroke};
use crate::studies::card::read_card;
use crate::units::Dimension;
use inference::{free_edges, modulus};
use subject::{Data, Disturbance, MIDDLE, PLATE, Subject, first_parameter, unknown_grips};
use trials::Trials;

pub mod coverage;
mod coverage_trial;
mod inference;
mod subject;
pub mod together;
mod trial;
mod trials;
mod truth;

/// Seeds of the estimates of edges and of the modulus, and the force's relative standard deviation.
struct Inference {
    edge_seeds: u64,
    modulus_seeds: u64,
    force_deviation: f64,
    law: Option<RegressedLaw>,
}

struct Settings {
    data: Data,
    noise: Vec<f64>,
    seeds: u64,
    outliers: f64,
    inference: Inference,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let card = read_card(&root.section("plate"), folder);
    let law = card.as_ref().and_then(first_parameter);
    let plate = Plate::read(root, folder);
    let settings = section(root, "data", |section| {
        let ratio = |key| section.quantity(key, Dimension::Ratio, Bound::Positive);
        let seeds = |key| section.count(key, 1, 10_000) as u64;
        Settings {
            data: Data::read(plate, root, section),
            noise: read_noise(section),
            seeds: seeds("seeds"),
            outliers: ratio("outliers"),
            inference: Inference {
                edge_seeds: seeds("edge_seeds"),
                modulus_seeds: seeds("modulus_seeds"),
                force_deviation: ratio("force_deviation"),
                law,
            },
        }
    });
    Box::new(move |progress| compute(&settings, progress))
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let (mut rows, mut plates) = (Vec::new(), Vec::new());
    for subject in [
        Subject::plate(&settings.data)?,
        Subject::strip(&settings.data)?,
    ] {
        for noise in &settings.noise {
            progress.tell(&format!("{}, noise of {noise} mm", subject.name));
            let trials = Trials::new(
                &subject,
                Disturbance::noise(*noise),
                Robust::No,
                settings.seeds,
            )?;
            rows.push(trials.row());
            outcome.checks.extend(trials.checks());
            outcome.claims.extend(trials.claim());
            if subject.name == PLATE {
                plates.push(trials);
            }
        }
        let gross = Disturbance {
            noise: MIDDLE,
            outliers: settings.outliers,
        };
        for robust in [Robust::Huber, Robust::Tukey] {
            progress.tell(&format!("{}, gross errors, {robust:?}", subject.name));
            let trials = Trials::new(&subject, gross, robust, settings.seeds)?;
            outcome.checks.extend(trials.outlier_checks(robust));
        }
        infer(&settings.inference, &subject, progress, &mut outcome)?;
    }
    progress.tell("100,000 nodes");
    outcome.times.push(large(&settings.data)?);
    outcome.blocks = vec![Block::paragraph(EXPLANATION), table(trials::HEAD, rows)];
    outcome.figures.push(picture(&plates));
    Ok(outcome)
}

const EXPLANATION: &str = "Marker displacements with Gaussian noise, interpolated from converged biquadratic finite elements \
    on another mesh; the grips are unknown, the long edges are free. Each cell shows the median over all seeds and, in \
    brackets, the worst seed. Displacements are compared at the markers, stresses at the centres of all cells more than a \
    fifth of the width from a corner, both as root mean squares; the raw stress comes from finite differences between \
    neighbouring markers. Coverage is the share of true values, over all nodes or stresses and all seeds, that lie within \
    their 95 % intervals.";

/// What the data tell in addition to the field: which edges are free, and the modulus.
fn infer(
    inference: &Inference,
    subject: &Subject,
    progress: Progress,
    outcome: &mut Outcome,
) -> Result<(), Error> {
    progress.tell(&format!("{}, unnamed edges", subject.name));
    outcome
        .checks
        .push(free_edges(subject, inference.edge_seeds)?);
    if let Some(law) = &inference.law {
        progress.tell(&format!("{}, modulus", subject.name));
        let (deviation, seeds) = (inference.force_deviation, inference.modulus_seeds);
        outcome
            .checks
            .extend(modulus(subject, law, deviation, seeds)?);
    }
    Ok(())
}

/// The time of one estimate on a hundred thousand nodes.
fn large(data: &Data) -> Result<(String, f64), Error> {
    let problem = &data.plate.problem;
    let subject = Subject::plate(data)?;
    let specimen = Specimen {
        mesh: &Mesh::plate(problem.size, [549, 183], CellShape::Quad4),
        laws: Arc::clone(&problem.law).into(),
        thickness: problem.thickness,
    };
    let data = subject.data(Disturbance::noise(MIDDLE), 0);
    let start = Instant::now();
    estimate(&specimen, &data.markers, &unknown_grips())?;
    let what = format!("estimate on {} nodes", specimen.mesh.nodes.len());
    Ok((what, start.elapsed().as_secs_f64()))
}

fn picture(plates: &[Trials]) -> Figure {
    let of = |value: fn(&Trials) -> f64| plates.iter().map(value).collect::<Vec<_>>();
    let line = |label, error, colour| {
        let (noise, error) = (of(|trials| trials.noise), of(error));
        line(label, &noise, &error, colour, Stroke::Marked)
    };
    let (x, y) = (
        "noise of each component [mm]",
        Axis::logarithmic("error of the displacement, median [mm]"),
    );
    let before = |trials: &Trials| trials.spread(|trial| trial.before).median;
    let after = |trials: &Trials| trials.spread(|trial| trial.after).median;
    let lines = vec![
        line("markers", before, [213, 94, 0]),
        line("estimated field", after, [0, 158, 115]),
    ];
    let chart = LineChart::new("Noisy markers with unknown grips", x, y, lines);
    Figure::new(
        "measured_fields.png",
        "Noisy markers before and after.",
        chart,
    )
}
