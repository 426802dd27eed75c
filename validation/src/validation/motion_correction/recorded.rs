//! A recorded motion with noise and an unknown start.

use rayon::prelude::*;

use super::bodies::{Body, Fields, Models, PlateInTime, Steps, check_even, fault, percent};
use crate::corrector::{CorrectorSettings, Solver};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::units::Dimension;
use crate::validation::case::{
    Outcome, Progress, Spread, check, limit, mean, normal_numbers, removed_percent, row, table,
};

/// What is recorded.
pub struct Recording {
    cells: [usize; 2],
    noise: f64,
    /// In a period.
    steps: usize,
    instants: usize,
    seeds: u64,
}

/// The data decide to this part; a smaller further move is left undone.
const SMOOTHING: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-8,
    movement: 1e-4,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// The deviation of one seed's motion from the truth in %.
struct Deviation {
    before: f64,
    after: f64,
}

impl Recording {
    pub fn read(section: &Section) -> Self {
        let cells = section.count_pair("cells", 2, 400).unwrap_or([2, 2]);
        check_even(section, cells);
        Self {
            cells,
            noise: section.quantity("noise", Dimension::Ratio, Bound::Positive),
            steps: section.count("steps", 20, 10_000),
            instants: section.count("instants", 5, 1000),
            seeds: section.count("seeds", 2, 1000) as u64,
        }
    }

    /// Noise before and after, over the seeds; the finite elements' motion is the truth, the springs' the first guess.
    pub fn compare(
        &self,
        plate: &PlateInTime,
        progress: Progress,
        outcome: &mut Outcome,
    ) -> Result<(), Error> {
        let models = Models::new(plate, self.cells);
        let viscosities = models.viscosities();
        let bodies = models.bodies(&viscosities)?;
        let steps = Steps {
            step: bodies.reference.period()? / self.steps as f64,
            count: self.instants - 1,
            every: 1,
            finer: 8,
        };
        let (exact, guess) = (bodies.exact(steps)?, bodies.springs.integrate(steps)?);
        let equation = bodies.equation(steps.step)?;
        progress.tell("seeds");
        let one = |seed: u64| -> Result<Deviation, Error> {
            let data = self.disturbed(&exact, &bodies.scheme, seed);
            let actual = equation.smooth(&data, &guess, self.instants, SMOOTHING);
            Ok(Deviation {
                before: percent(&data, &exact),
                after: percent(&actual.map_err(fault)?, &exact),
            })
        };
        let seeds = (1..=self.seeds).into_par_iter();
        let deviations: Vec<Deviation> = seeds.map(one).collect::<Result<_, _>>()?;
        self.report(&deviations, percent(&guess, &exact), outcome);
        Ok(())
    }

    fn report(&self, deviations: &[Deviation], guess: f64, outcome: &mut Outcome) {
        let removed = deviations
            .iter()
            .map(|one| removed_percent(one.before, one.after));
        let (instants, seeds) = (self.instants, self.seeds);
        let what = format!(
            "recorded motion of {instants} instants: noise removed, worst of {seeds} seeds"
        );
        let worst = check(what, "%", Spread::of(removed).least);
        let source = "a fraction √(2/n) of white noise would remain";
        outcome.checks.push(worst.at_least(50.0, source));
        let noise = format!("with {} % noise", limit(100.0 * self.noise));
        let rows = [
            row("springs, the first guess", [guess]),
            row(noise, [mean(deviations.iter().map(|one| one.before))]),
            row(
                "corrected, start unknown",
                [mean(deviations.iter().map(|one| one.after))],
            ),
        ];
        let head = "recorded motion | deviation from the finite elements, mean [%]";
        outcome.blocks.push(table(head, rows));
    }

    /// White noise on every unknown that is not held, over the root mean square of all.
    fn disturbed(&self, exact: &Fields, body: &Body, seed: u64) -> Fields {
        let size = self.noise * mean(exact.iter().flatten().map(|u| u * u)).sqrt();
        let held = body.motion.held(0.0);
        let mut draws = normal_numbers(seed);
        let mut disturbed = exact.clone();
        for field in &mut disturbed {
            for ((u, held), draw) in field.iter_mut().zip(&held).zip(&mut draws) {
                *u += if *held { 0.0 } else { size * draw };
            }
        }
        disturbed
    }
}
