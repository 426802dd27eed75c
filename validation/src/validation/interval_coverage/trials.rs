//! Estimates of many seeds, and what is demanded of them.

use rayon::prelude::*;

use super::subject::{Disturbance, MIDDLE, Subject, unknown_grips};
use super::trial::{Flagged, Trial};
use crate::error::Error;
use crate::estimation::{Knowledge, Robust};
use crate::validation::case::{Check, Claim, Spread, check, mean, number};

/// Where the limits come from.
pub const TARGET: &str = "aim";

/// The heads of the table of trials.
pub const HEAD: &str = "specimen, noise | estimated noise [mm] | displacement error before [mm] | after [mm] | stress \
                        error, raw [%] | after [%] | displacements covered [%] | stresses covered [%]";

/// The estimates of all seeds compared with the truth.
pub struct Trials {
    subject: &'static str,
    /// In mm.
    pub noise: f64,
    all: Vec<Trial>,
}

impl Trials {
    /// Estimates and compares the seeds from 0 on.
    pub fn new(
        subject: &Subject,
        disturbance: Disturbance,
        robust: Robust,
        seeds: u64,
    ) -> Result<Self, Error> {
        let knowledge = Knowledge {
            robust,
            ..unknown_grips()
        };
        let trial = |seed: u64| {
            let data = subject.data(disturbance, seed);
            let actual = subject.estimate(&data, &knowledge)?;
            Ok(Trial::new(&subject.truth, &subject.mesh, &data, &actual))
        };
        let all: Result<Vec<Trial>, Error> = (0..seeds).into_par_iter().map(trial).collect();
        Ok(Self {
            subject: subject.name,
            noise: disturbance.noise,
            all: all?,
        })
    }

    /// Least, median and largest value of all trials.
    pub fn spread(&self, value: fn(&Trial) -> f64) -> Spread {
        Spread::of(self.all.iter().map(value))
    }

    fn mean(&self, value: fn(&Trial) -> f64) -> f64 {
        mean(self.all.iter().map(value))
    }

    /// A row of the table.
    pub fn row(&self) -> Vec<String> {
        let worst = |value: fn(&Trial) -> f64| {
            let spread = self.spread(value);
            format!("{} ({})", number(spread.median), number(spread.most))
        };
        vec![
            format!("{}, {} mm", self.subject, self.noise),
            worst(|trial| trial.noise),
            worst(|trial| trial.before),
            worst(|trial| trial.after),
            worst(|trial| trial.differences),
            worst(|trial| trial.stress),
            number(self.mean(|trial| trial.displacement_cover)),
            number(self.mean(|trial| trial.stress_cover)),
        ]
    }

    /// Errors have to fall, and intervals to hold the truth as often as they say.
    pub fn checks(&self) -> Vec<Check> {
        let check = |what: &str, value: f64| {
            let (subject, noise) = (self.subject, self.noise);
            check(
                format!("{subject}, noise of {noise} mm: {what}"),
                "%",
                value,
            )
        };
        let reduction = self.spread(Trial::reduction).least;
        let mut checks = vec![
            check("reduction of the displacement error, worst seed", reduction)
                .at_least(80.0, TARGET),
        ];
        for (what, cover) in [
            ("displacements", self.mean(|trial| trial.displacement_cover)),
            ("stresses", self.mean(|trial| trial.stress_cover)),
        ] {
            let check = || check(&format!("{what} in their 95 % intervals"), cover);
            checks.extend([
                check().at_least(90.0, TARGET),
                check().at_most(99.0, TARGET),
            ]);
        }
        if self.noise == MIDDLE {
            let stress = self.spread(|trial| trial.stress).most;
            let raw = self.spread(|trial| trial.differences).least;
            checks.extend([
                check("stress error, worst seed", stress).at_most(5.0, TARGET),
                check("stress error from finite differences, best seed", raw)
                    .at_least(50.0, TARGET),
            ]);
        }
        checks
    }

    /// The publication's claim, at one of the noises.
    pub fn claim(&self) -> Option<Claim> {
        let median = |value| number(self.spread(value).median);
        (self.noise == MIDDLE).then(|| Claim {
            claim: "The technique smooths results of other methods",
            reproduced: format!(
                "markers with a noise of {} mm on a {} with unknown grips: the displacement error falls by {} %, the stress \
                 error from {} to {} % (medians)",
                self.noise,
                self.subject,
                median(Trial::reduction),
                median(|trial| trial.differences),
                median(|trial| trial.stress),
            ),
        })
    }

    /// Gross errors have to be found, and to leave no trace in the field.
    pub fn outlier_checks(&self, robust: Robust) -> [Check; 3] {
        let check = |what: &str, value: f64| {
            check(format!("{}, {robust:?}: {what}", self.subject), "%", value)
        };
        let share = |of: fn(&Trial) -> Flagged| {
            let all = || self.all.iter().map(of);
            let (flagged, count) = (all().map(|of| of.flagged), all().map(|of| of.count));
            100.0 * flagged.sum::<usize>() as f64 / count.sum::<usize>() as f64
        };
        let reduction = self.spread(Trial::reduction).least;
        [
            check("gross errors detected", share(|trial| trial.wrong)).at_least(95.0, TARGET),
            check(
                "sound markers mistaken for gross errors",
                share(|trial| trial.sound),
            )
            .at_most(1.0, TARGET),
            check(
                "reduction of the displacement error with gross errors, worst seed",
                reduction,
            )
            .at_least(80.0, TARGET),
        ]
    }
}
