//! Identification of spring and dashpot functions, Eq. 2–5 and the end of § 2.1 of the publication.
//!
//! A trial is counted as good when K(·) *and* D(·) lie within the 95 % band at *all* fixed extensions. The shares of
//! single places within their own 95 % intervals stand next to it.

use std::path::Path;

use rayon::prelude::*;

use super::case::{
    Block, Check, Claim, Computation, Figure, Outcome, Progress, check, limit, mean, number, row,
    section, share, table,
};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::identification::{Function, Identification, IdentificationSettings, Sample, identify};
use crate::results::identification_picture;
use crate::statistics::{extremes, median};
use crate::units::Dimension;

#[derive(Clone, Copy)]
struct Settings {
    sample: Sample,
    trials: usize,
    positions: usize,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let positions = section(root, "comparison", |comparison| {
        comparison.count("places", 3, 1000)
    });
    let settings = section(root, "recording", |recording| Settings {
        sample: Sample {
            duration: recording.quantity("duration", Dimension::Time, Bound::Positive),
            instants: recording.count("instants", 100, 100_000),
            noise: recording.quantity("noise", Dimension::Ratio, Bound::Positive),
            seed: recording.count("first_seed", 0, usize::MAX) as u64,
        },
        trials: recording.count("trials", 3, 10_000),
        positions,
    });
    Box::new(move |progress| compute(settings, progress))
}

/// One function at one place: how far it is from the truth, and what it claims.
#[derive(Clone, Copy)]
struct Place {
    error: f64,
    standard_error: f64,
    truth: f64,
    within_interval: bool,
    within_band: bool,
}

/// Both functions at all places.
type Trial = [Vec<Place>; 2];

const TRUTH: [fn(f64) -> f64; 2] = [Sample::stiffness, Sample::damping];

fn compute(settings: Settings, progress: Progress) -> Result<Outcome, Error> {
    progress.tell("trials");
    let positions = positions(&settings);
    let seeds: Vec<u64> = (0..settings.trials as u64).collect();
    let one = |seed: &u64| -> Result<Trial, Error> {
        let sample = Sample {
            seed: settings.sample.seed + seed,
            ..settings.sample
        };
        let actual = identify(
            &sample.recording(),
            IdentificationSettings::default(),
            &|_| (),
        )?;
        Ok(compare(&actual, &positions))
    };
    let trials: Vec<Trial> = seeds.par_iter().map(one).collect::<Result<_, _>>()?;
    let recording = settings.sample.recording();
    let drawn = identify(&recording, IdentificationSettings::default(), &|_| ())?;
    let within = |trial: &&Trial| trial.iter().flatten().all(|position| position.within_band);
    let good = trials.iter().filter(within).count();
    Ok(Outcome {
        checks: checks(&trials, good),
        claims: vec![claim(&settings, good)],
        blocks: vec![explanation(&settings), error_table(&trials, &positions)],
        figures: vec![Figure::new(
            "spring_identification.png",
            format!(
                "K(·) and D(·) identified from the recording of seed {}: K = 0.15 + 0.05 e^(x/8 mm) N/mm, \
                 D = 0.004 + 0.0015 tanh(x/5 mm) N·s/mm.",
                settings.sample.seed
            ),
            identification_picture(&drawn, &recording),
        )],
        ..Outcome::default()
    })
}

/// Fixed extensions from the smallest to the largest of the exact motion.
fn positions(settings: &Settings) -> Vec<f64> {
    let exact = settings.sample.exact().extension;
    let [low, high] = extremes(exact);
    let position = |i: usize| low + (high - low) * i as f64 / (settings.positions - 1) as f64;
    (0..settings.positions).map(position).collect()
}

fn compare(actual: &Identification, positions: &[f64]) -> Trial {
    let at = |function: &Function, truth: fn(f64) -> f64, x: f64| {
        let (estimate, truth) = (function.at(x), truth(x));
        let [low, high] = function.band(x);
        Place {
            error: estimate.value - truth,
            standard_error: estimate.standard_error,
            truth,
            within_interval: estimate.holds(truth),
            within_band: (low..=high).contains(&truth),
        }
    };
    [0, 1].map(|index| {
        let (_, _, function) = actual.functions()[index];
        positions
            .iter()
            .map(|x| at(function, TRUTH[index], *x))
            .collect()
    })
}

/// Share of the trials and places where something holds, in %.
fn share_of_places(trials: &[Trial], index: usize, holds: impl Fn(&Place) -> bool) -> f64 {
    let all = trials.iter().flat_map(|trial| &trial[index]);
    share(all.map(holds))
}

/// Median of |error| over trials and places, in % of the truth.
fn median_error(trials: &[Trial], index: usize) -> f64 {
    let all = trials.iter().flat_map(|trial| &trial[index]);
    median(all.map(|position| 100.0 * (position.error / position.truth).abs()))
}

fn checks(trials: &[Trial], good: usize) -> Vec<Check> {
    let count = trials.len();
    let what = format!("trials of {count} with K(·) and D(·) within the 95 % band at all places");
    let chance = "95 %, less sampling error";
    let good = check(what, "%", 100.0 * good as f64 / count as f64);
    let mut checks = vec![good.at_least(90.0, chance)];
    for (index, name) in ["K(·)", "D(·)"].into_iter().enumerate() {
        let within = share_of_places(trials, index, |position| position.within_interval);
        let error = median_error(trials, index);
        checks.extend([
            check(
                format!("{name}: places within their own 95 % interval"),
                "%",
                within,
            )
            .at_least(90.0, chance),
            check(
                format!("{name}: error, median over trials and places"),
                "%",
                error,
            )
            .at_most(5.0, "noise at one instant"),
        ]);
    }
    checks
}

fn claim(settings: &Settings, good: usize) -> Claim {
    Claim {
        claim: "§ 2.1: given input and output data, the non-linear functions K(·) and D(·) can be approximated",
        reproduced: format!(
            "splines from force and motion with {} % noise each: both functions within their 95 % band everywhere in \
             {good} of {} trials",
            limit(100.0 * settings.sample.noise),
            settings.trials
        ),
    }
}

fn explanation(settings: &Settings) -> Block {
    Block::Paragraph(format!(
        "Force and extension have white noise of {} % of their root mean square; the seeds are {} to {}. A band applies to \
         both functions at all places simultaneously, an interval to one place. At the ends of the range the motion \
         reverses: its velocity vanishes there, the recording does not determine D(·), and individual trials deviate \
         strongly, which the means in the table show. The median error is therefore checked. Standard errors are means over the \
         recordings that have them, which are those that are explained.",
        limit(100.0 * settings.sample.noise),
        settings.sample.seed,
        settings.sample.seed + settings.trials as u64 - 1
    ))
}

fn error_table(trials: &[Trial], positions: &[f64]) -> Block {
    const ROWS: usize = 10;
    let mean = |index: usize, position: usize, of: fn(&Place) -> f64| {
        let values = trials.iter().map(|trial| of(&trial[index][position]));
        mean(values.filter(|value| value.is_finite()))
    };
    let cells = |index: usize, position: usize| {
        [
            TRUTH[index](positions[position]),
            mean(index, position, |one| one.error),
            mean(index, position, |one| one.standard_error),
        ]
    };
    let rows = (0..positions.len()).step_by((positions.len() / ROWS).max(1));
    let rows = rows.map(|position| {
        let numbers = [0, 1].map(|index| cells(index, position));
        row(number(positions[position]), numbers.concat())
    });
    let head = "x [mm] | K [N/mm] | mean error of K | mean standard error of K | \
                D [N·s/mm] | mean error of D | mean standard error of D";
    table(head, rows)
}
