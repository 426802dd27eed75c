//! Example 2: a vibrating spring from disturbed data, with known and with unknown constants.
//!
//! Eq. 25–32, with ü + k u = 0 (the publication's sign in Eq. 25 gives no oscillation; its Eq. 28–32
//! discretise the oscillation).

use std::path::Path;

use rayon::prelude::*;

use super::case::{
    Check, Claim, Computation, Figure, Outcome, Progress, Spread, check, failed, line, mean,
    normal_numbers, number, percent, removed_percent, row, section, share, table,
};
use super::oscillator::{Differences, Motion, Regression};
use super::plate::CORRECTOR;
use crate::corrector::Corrector;
use crate::document::{Bound, Section};
use crate::error::SolveFault;
use crate::results::{LineChart, Stroke};
use crate::solve::vector::{difference, dot};
use crate::statistics::Estimate;
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
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let (motion, damping) = section(root, "motion", read_motion);
    let order = section(root, "differences", |section| {
        let order = section.count("order", 2, 4);
        if order == 3 {
            section.fault("order", "must be 2 or 4", "4 is Numerov's");
        }
        order
    });
    let settings = section(root, "data", |section| Settings {
        motion,
        damping,
        disturbance: section.quantity("disturbance", Dimension::Ratio, Bound::Positive),
        seed: section.count("seed", 0, usize::MAX) as u64,
        seeds: section.count("seeds", 3, 100_000) as u64,
        order,
    });
    Box::new(move |progress| {
        compute(&settings, progress).map_err(failed("corrector", "the vibrating spring"))
    })
}

/// The undamped motion, and the damping of the damped one.
fn read_motion(section: &Section) -> (Motion, f64) {
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
            "gives no oscillation: c² must be below 4 k",
            "make it smaller",
        );
    }
    (motion, damping)
}

impl Settings {
    /// The motion disturbed by white noise.
    fn disturbed(&self, motion: &Motion, seed: u64) -> Vec<f64> {
        let noise = self.noise(motion);
        let exact = motion.displacement().into_iter();
        let draws = exact.zip(normal_numbers(seed));
        draws.map(|(u, draw)| u + noise * draw).collect()
    }

    /// Standard deviation of the noise in mm.
    fn noise(&self, motion: &Motion) -> f64 {
        let exact = motion.displacement();
        self.disturbance * mean(exact.iter().map(|u| u * u)).sqrt()
    }

    /// The difference equations of the undamped motion.
    fn differences(&self) -> Differences {
        Differences::new(self.motion.points, self.motion.step(), self.order)
    }

    /// The corrector that knows the stiffness.
    fn corrector(&self) -> Corrector<'static> {
        let stiffness = self.motion.stiffness;
        self.differences().known(&[stiffness], CORRECTOR)
    }
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, SolveFault> {
    let mut outcome = Outcome::default();
    drawn_motion(settings, &mut outcome)?;
    progress.tell("known stiffness");
    outcome.checks.extend(known_stiffness(settings)?);
    progress.tell("unknown stiffness");
    let (undamped, order) = (settings.motion, settings.order);
    let free = unknown_constants(settings, &undamped, order, &["k"], &mut outcome)?;
    progress.tell("unknown stiffness and damping");
    let damped = Motion {
        damping: settings.damping,
        ..undamped
    };
    unknown_constants(settings, &damped, 2, &["k, damped", "c"], &mut outcome)?;
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
    let exact = settings.motion.displacement();
    let data = settings.disturbed(&settings.motion, settings.seed);
    let correction = settings.corrector().correct(&data, &data)?;
    let before = percent(&data, &exact);
    let after = percent(correction.field(), &exact);
    let removed = removed_percent(before, after);
    outcome.checks.extend([
        check("disturbance of the plotted motion", "%", before)
            .at_least(20.0, "publication: more than 20 %"),
        check("deviation after the correction", "%", after)
            .at_most(10.0, "publication: within 10 %"),
        check("correction", "%", removed).at_least(80.0, "publication: above 80 %"),
    ]);
    let [before, after, removed] = [before, after, removed].map(number);
    outcome.claims.push(Claim {
        claim: "Example 2: the corrected motion is within 10 %, corrections above 80 %",
        reproduced: format!(
            "disturbed by {before} %, corrected to {after} %: a correction of {removed} %"
        ),
    });
    let times = settings.motion.times();
    let inner_times = &times[1..times.len() - 1];
    outcome.figures = vec![
        motion_figure(&times, &exact, &data, correction.field()),
        multiplier_figure(inner_times, &correction.multipliers[0].values),
    ];
    Ok(())
}

/// The corrections of all seeds.
fn known_stiffness(settings: &Settings) -> Result<[Check; 2], SolveFault> {
    let exact = settings.motion.displacement();
    let corrector = settings.corrector();
    let correction = |seed: u64| -> Result<f64, SolveFault> {
        let data = settings.disturbed(&settings.motion, seed);
        let corrected = corrector.correct(&data, &data)?;
        let [after, before] = [corrected.field(), &data].map(|u| percent(u, &exact));
        Ok(removed_percent(before, after))
    };
    let seeds = settings.seeds;
    let corrections: Result<Vec<f64>, _> = (0..seeds).map(correction).collect();
    let corrections = Spread::of(corrections?);
    let what = |which: &str| format!("correction, {which} of {seeds} seeds");
    Ok([
        check(what("median"), "%", corrections.median).at_least(80.0, "publication: above 80 %"),
        check(what("worst"), "%", corrections.least)
            .at_least(70.0, "projection onto two dimensions"),
    ])
}

/// k from the disturbed data as they are: least squares of D u + k M u = 0.
fn uncorrected_stiffness(settings: &Settings) -> f64 {
    let data = settings.disturbed(&settings.motion, settings.seed);
    let differences = settings.differences();
    let [without, with] = [0.0, 1.0].map(|k| differences.residual(&data, k));
    let mass = difference(&with, &without);
    -dot(&mass, &without) / dot(&mass, &mass)
}

/// What the estimates of one constant over all seeds come to.
struct Regressed {
    name: String,
    truth: f64,
    mean: f64,
    /// Standard deviation.
    spread: f64,
    /// The Cramér–Rao bound of the standard deviation.
    bound: f64,
    /// Share of the seeds whose 95 % interval holds the true value, in %.
    coverage: f64,
}

impl Regressed {
    fn new(name: &str, estimates: &[&Estimate], truth: f64, bound: f64) -> Self {
        let mean = mean(estimates.iter().map(|estimate| estimate.value));
        let squares = estimates
            .iter()
            .map(|estimate| (estimate.value - mean).powi(2));
        let variance = squares.sum::<f64>() / (estimates.len() as f64 - 1.0);
        let covered = estimates.iter().map(|estimate| estimate.holds(truth));
        Self {
            name: name.to_owned(),
            truth,
            mean,
            spread: variance.sqrt(),
            bound,
            coverage: share(covered),
        }
    }

    fn checks(&self) -> [Check; 3] {
        let Self { name, bound, .. } = self;
        let bias = (self.mean - self.truth).abs();
        [
            check(
                format!("{name}: spread over the Cramér-Rao bound"),
                "–",
                self.spread / bound,
            )
            .at_most(1.1, "Fisher information"),
            check(
                format!("{name}: bias over the Cramér-Rao bound"),
                "–",
                bias / bound,
            )
            .at_most(0.2, "Fisher information"),
            check(
                format!("{name}: true value within the 95 % interval"),
                "%",
                self.coverage,
            )
            .at_least(90.0, "95 %, less sampling error"),
        ]
    }
}

/// Regresses constants over all seeds and returns the mean of the first.
fn unknown_constants(
    settings: &Settings,
    motion: &Motion,
    order: usize,
    names: &[&str],
    outcome: &mut Outcome,
) -> Result<f64, SolveFault> {
    let fits = fits(settings, motion, order, names.len())?;
    let bounds = motion.bounds(settings.noise(motion));
    let bounds = bounds.ok_or(SolveFault::Singular)?;
    let truth = [motion.stiffness, motion.damping];
    let constants = names.iter().enumerate().map(|(index, name)| {
        let estimates: Vec<&Estimate> = fits.iter().map(|fit| &fit[index]).collect();
        Regressed::new(name, &estimates, truth[index], bounds[index])
    });
    let constants: Vec<Regressed> = constants.collect();
    outcome
        .checks
        .extend(constants.iter().flat_map(Regressed::checks));
    let rows = constants.iter();
    let rows = rows.map(|actual| {
        row(
            &actual.name,
            [actual.truth, actual.mean, actual.spread, actual.bound],
        )
    });
    let head = "constant | true value | mean | spread | Cramér-Rao bound";
    outcome.blocks.push(table(head, rows));
    Ok(constants[0].mean)
}

/// The estimated constants of all seeds.
fn fits(
    settings: &Settings,
    motion: &Motion,
    order: usize,
    constants: usize,
) -> Result<Vec<Vec<Estimate>>, SolveFault> {
    let step = motion.step();
    let differences = Differences::new(motion.points, step, order);
    let regression = Regression::new(differences, step, constants, CORRECTOR);
    let seeds: Vec<u64> = (0..settings.seeds).collect();
    let fits = seeds.par_chunks(25).map(|seeds| {
        let mut factors = regression.factors()?;
        let fit = |seed: &u64| regression.fit(&settings.disturbed(motion, *seed), &mut factors);
        seeds.iter().map(fit).collect::<Result<Vec<_>, _>>()
    });
    Ok(fits.collect::<Result<Vec<_>, SolveFault>>()?.concat())
}

fn motion_figure(times: &[f64], exact: &[f64], data: &[f64], corrected: &[f64]) -> Figure {
    let lines = vec![
        line("disturbed", times, data, [170, 170, 170], Stroke::Points),
        line("exact", times, exact, [30, 30, 30], Stroke::Solid),
        line("corrected", times, corrected, [0, 114, 178], Stroke::Dashed),
    ];
    let (x, y) = ("time [s]", "displacement [mm]");
    Figure::new(
        "vibrating_spring.png",
        "Figure 3 of the publication: exact, disturbed and corrected motion.",
        LineChart::new("Motion of the vibrating spring", x, y, lines),
    )
}

fn multiplier_figure(times: &[f64], psi: &[f64]) -> Figure {
    let (x, y) = ("time [s]", "multiplier ζ [mm]");
    let lines = vec![line("ζ", times, psi, [204, 121, 167], Stroke::Solid)];
    Figure::new(
        "vibrating_spring_multipliers.png",
        "Figure 3 of the publication: the Lagrange multipliers.",
        LineChart::new(
            "Lagrange multipliers of the equation of motion",
            x,
            y,
            lines,
        ),
    )
}
