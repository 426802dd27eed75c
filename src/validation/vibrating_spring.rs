//! Example 2: a vibrating spring from disturbed data, with known and with unknown constants.
//!
//! Eq. 25–32, with ü + k u = 0 (the publication's sign in Eq. 25 gives no oscillation; its Eq. 28–32
//! discretise the oscillation).

use std::path::Path;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::oscillator::{Differences, Motion, Regression};
use super::plate::CORRECTOR;
use super::{Check, Claim, Outcome, Prepared, Progress, Wanted, number, percent};
use crate::corrector::{CorrectorSettings, Solver};
use crate::document::{Bound, Section};
use crate::error::{Error, SolveFault};
use crate::output::picture::lines::{Axis, Line, LineChart, Stroke};
use crate::results::{Block, Figure};
use crate::statistics::median;
use crate::units::Dimension;

#[derive(Clone, Debug)]
struct Settings {
    motion: Motion,
    damping: f64,
    disturbance: f64,
    seed: u64,
    seeds: u64,
    order: usize,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("motion");
    let motion = Motion {
        stiffness: section.number("stiffness", Bound::Positive),
        damping: 0.0,
        amplitude: section.quantity("amplitude", Dimension::Length, Bound::Positive),
        duration: section.quantity("duration", Dimension::Time, Bound::Positive),
        points: section.count("points", 8, 100_000),
    };
    let damping = section.number("damping", Bound::Positive);
    if damping * damping >= 4.0 * motion.stiffness {
        section.fault(
            "damping",
            "leaves no oscillation: c² must be below 4 k",
            "make it smaller",
        );
    }
    section.unknown_keys();
    let section = root.section("data");
    let disturbance = section.quantity("disturbance", Dimension::Ratio, Bound::Positive);
    let seed = section.count("seed", 0, usize::MAX) as u64;
    let seeds = section.count("seeds", 3, 100_000) as u64;
    section.unknown_keys();
    let section = root.section("differences");
    let order = section.count("order", 2, 4);
    if order == 3 {
        section.fault("order", "must be 2 or 4", "4 is Numerov's");
    }
    section.unknown_keys();
    let settings = Settings {
        motion,
        damping,
        disturbance,
        seed,
        seeds,
        order,
    };
    Box::new(move |progress| compute(&settings, progress).map_err(fault))
}

fn fault(fault: SolveFault) -> Error {
    Error::Solve {
        model: "corrector".into(),
        step: "the vibrating spring".into(),
        fault,
    }
}

impl Settings {
    fn damped(&self) -> Motion {
        Motion {
            damping: self.damping,
            ..self.motion
        }
    }

    /// The motion disturbed by white noise.
    fn disturbed(&self, motion: &Motion, seed: u64) -> Vec<f64> {
        let noise = self.noise(motion);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let exact = motion.displacement().into_iter();
        let draw = |random: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(random) };
        exact.map(|u| u + noise * draw(&mut random)).collect()
    }

    /// Standard deviation of the noise in mm.
    fn noise(&self, motion: &Motion) -> f64 {
        let exact = motion.displacement();
        let square = exact.iter().map(|u| u * u).sum::<f64>() / exact.len() as f64;
        self.disturbance * square.sqrt()
    }
}

const SETTINGS: CorrectorSettings = CorrectorSettings {
    solver: Solver::Automatic,
    ..CORRECTOR
};

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, SolveFault> {
    let mut outcome = Outcome::default();
    drawn_motion(settings, &mut outcome)?;
    progress("known stiffness");
    known_stiffness(settings, &mut outcome)?;
    progress("unknown stiffness");
    let free = unknown_constants(
        settings,
        &settings.motion,
        settings.order,
        &["k"],
        &mut outcome,
    )?;
    progress("unknown stiffness and damping");
    unknown_constants(
        settings,
        &settings.damped(),
        2,
        &["k, damped", "c"],
        &mut outcome,
    )?;
    outcome.claims.push(Claim {
        claim: "Example 2: the constant can be regressed with the motion; 1.2 instead of 1 from uncorrected results",
        reproduced: format!(
            "{} from the disturbed data of seed {}, by least squares of the difference equations; with the motion, \
             mean over {} seeds: {}; the true value is {}",
            number(uncorrected_stiffness(settings)),
            settings.seed,
            settings.seeds,
            number(free),
            settings.motion.stiffness
        ),
    });
    Ok(outcome)
}

fn drawn_motion(settings: &Settings, outcome: &mut Outcome) -> Result<(), SolveFault> {
    let motion = &settings.motion;
    let (exact, data) = (
        motion.displacement(),
        settings.disturbed(motion, settings.seed),
    );
    let differences = Differences::new(motion.points, motion.step(), settings.order);
    let corrector = differences.known(&[motion.stiffness], SETTINGS);
    let correction = corrector.correct(&data, &data)?;
    let before = percent(&data, &exact);
    let after = percent(correction.field(), &exact);
    let correction_percent = 100.0 * (1.0 - after / before);
    outcome.checks.extend([
        Check::new(
            "disturbance of the drawn motion",
            "%",
            Wanted::AtLeast(20.0),
            "publication: more than 20 %",
            before,
        ),
        Check::new(
            "deviation after the correction",
            "%",
            Wanted::AtMost(10.0),
            "publication: within 10 %",
            after,
        ),
        Check::new(
            "correction",
            "%",
            Wanted::AtLeast(80.0),
            "publication: above 80 %",
            correction_percent,
        ),
    ]);
    outcome.claims.push(Claim {
        claim: "Example 2: the corrected motion is within 10 %, corrections above 80 %",
        reproduced: format!(
            "disturbed by {} %, corrected to {} %: a correction of {} %",
            number(before),
            number(after),
            number(correction_percent)
        ),
    });
    let times = motion.times();
    let multipliers = &correction.multipliers[0].values;
    outcome.figures = figures(&times, &exact, &data, correction.field(), multipliers);
    Ok(())
}

fn known_stiffness(settings: &Settings, outcome: &mut Outcome) -> Result<(), SolveFault> {
    let motion = &settings.motion;
    let exact = motion.displacement();
    let differences = Differences::new(motion.points, motion.step(), settings.order);
    let corrector = differences.known(&[motion.stiffness], SETTINGS);
    let correction = |seed: u64| -> Result<f64, SolveFault> {
        let data = settings.disturbed(motion, seed);
        let field = corrector.correct(&data, &data)?;
        let [after, before] = [field.field(), &data].map(|u| percent(u, &exact));
        Ok(100.0 * (1.0 - after / before))
    };
    let corrections = (0..settings.seeds)
        .map(correction)
        .collect::<Result<Vec<f64>, _>>()?;
    let worst = corrections.iter().copied().fold(f64::INFINITY, f64::min);
    outcome.checks.extend([
        Check::new(
            format!("correction, median of {} seeds", settings.seeds),
            "%",
            Wanted::AtLeast(80.0),
            "publication: above 80 %",
            median(corrections),
        ),
        Check::new(
            format!("correction, worst of {} seeds", settings.seeds),
            "%",
            Wanted::AtLeast(70.0),
            "projection onto two dimensions",
            worst,
        ),
    ]);
    Ok(())
}

/// k from the disturbed data as they are: least squares of D u + k M u = 0.
fn uncorrected_stiffness(settings: &Settings) -> f64 {
    let motion = &settings.motion;
    let data = settings.disturbed(motion, settings.seed);
    let differences = Differences::new(motion.points, motion.step(), settings.order);
    let [without, with] = [0.0, 1.0].map(|k| differences.residual(&data, k));
    let mass: Vec<f64> = with
        .iter()
        .zip(&without)
        .map(|(with, without)| with - without)
        .collect();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    -product(&mass, &without) / product(&mass, &mass)
}

/// Regresses constants over all seeds and returns the mean of the first.
fn unknown_constants(
    settings: &Settings,
    motion: &Motion,
    order: usize,
    names: &[&str],
    outcome: &mut Outcome,
) -> Result<f64, SolveFault> {
    let step = motion.step();
    let regression = Regression::new(
        Differences::new(motion.points, step, order),
        step,
        names.len(),
        SETTINGS,
    );
    let seeds: Vec<u64> = (0..settings.seeds).collect();
    let fits = seeds.par_chunks(25).map(|seeds| {
        let mut factors = regression.factors()?;
        let fit = |seed: &u64| regression.fit(&settings.disturbed(motion, *seed), &mut factors);
        seeds.iter().map(fit).collect::<Result<Vec<_>, _>>()
    });
    let fits: Vec<_> = fits.collect::<Result<Vec<_>, SolveFault>>()?.concat();
    let bounds = motion
        .bounds(settings.noise(motion))
        .ok_or(SolveFault::Singular)?;
    let truth = [motion.stiffness, motion.damping];
    let count = fits.len() as f64;
    let mut rows = Vec::new();
    let mut first = f64::NAN;
    for (index, name) in names.iter().enumerate() {
        let (truth, bound) = (truth[index], bounds[index]);
        let mean = fits.iter().map(|fit| fit[index].value).sum::<f64>() / count;
        let square: f64 = fits
            .iter()
            .map(|fit| (fit[index].value - mean).powi(2))
            .sum();
        let spread = (square / (count - 1.0)).sqrt();
        let inside = |fit: &&Vec<crate::statistics::Estimate>| {
            let [low, high] = fit[index].interval;
            (low..=high).contains(&truth)
        };
        let coverage = 100.0 * fits.iter().filter(inside).count() as f64 / count;
        outcome.checks.extend([
            Check::new(
                format!("{name}: spread over the Cramér-Rao bound"),
                "–",
                Wanted::AtMost(1.1),
                "Fisher information",
                spread / bound,
            ),
            Check::new(
                format!("{name}: bias over the Cramér-Rao bound"),
                "–",
                Wanted::AtMost(0.2),
                "Fisher information",
                (mean - truth).abs() / bound,
            ),
            Check::new(
                format!("{name}: true value within the 95 % interval"),
                "%",
                Wanted::AtLeast(90.0),
                "95 %, less what chance allows",
                coverage,
            ),
        ]);
        rows.push(vec![
            (*name).to_owned(),
            number(truth),
            number(mean),
            number(spread),
            number(bound),
        ]);
        if index == 0 {
            first = mean;
        }
    }
    let head = [
        "constant",
        "true value",
        "mean",
        "spread",
        "Cramér-Rao bound",
    ];
    outcome.blocks.push(Block::table(&head, rows));
    Ok(first)
}

fn figures(
    times: &[f64],
    exact: &[f64],
    data: &[f64],
    corrected: &[f64],
    psi: &[f64],
) -> Vec<Figure> {
    let line = |label: &str, times: &[f64], values: &[f64], colour, stroke| Line {
        label: label.to_owned(),
        points: times.iter().zip(values).map(|(t, u)| [*t, *u]).collect(),
        colour,
        stroke,
    };
    let motion = LineChart {
        title: "Motion of the vibrating spring".into(),
        x: Axis::linear("time [s]"),
        y: Axis::linear("displacement [mm]"),
        lines: vec![
            line("disturbed", times, data, [170, 170, 170], Stroke::Points),
            line("exact", times, exact, [30, 30, 30], Stroke::Solid),
            line("corrected", times, corrected, [0, 114, 178], Stroke::Dashed),
        ],
        band: None,
    };
    let multipliers = LineChart {
        title: "Lagrange multipliers of the equation of motion".into(),
        x: Axis::linear("time [s]"),
        y: Axis::linear("multiplier ζ [mm]"),
        lines: vec![line(
            "ζ",
            &times[1..times.len() - 1],
            psi,
            [204, 121, 167],
            Stroke::Solid,
        )],
        band: None,
    };
    vec![
        super::figure(
            "vibrating_spring.png",
            "Figure 3 of the publication: exact, disturbed and corrected motion.",
            &motion,
        ),
        super::figure(
            "vibrating_spring_multipliers.png",
            "Figure 3 of the publication: the Lagrange multipliers.",
            &multipliers,
        ),
    ]
}
