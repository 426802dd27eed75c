//! Laws fitted to curves of known laws, with noise that correlates along them: how often the 95 % intervals hold the true
//! parameters, and whether what a wrong law leaves is told from noise.

use std::path::Path;

use rayon::prelude::*;

use super::case::{
    Block, Check, Computation, Outcome, Progress, check, mean, normal_numbers_of_stream, number,
    section, share, table,
};
use crate::calibration::{Answer, Fit, FitSettings, TestData, fit};
use crate::document::{Bound, Section, Statements};
use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::material::registry::Law;
use crate::statistics::Estimate;
use crate::units::Dimension;

struct Settings {
    points: Vec<f64>,
    autocorrelation: Vec<f64>,
    noise: f64,
    seeds: u64,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let settings = section(root, "curves", |section| Settings {
        points: section.multiples("points", Bound::Positive, 1e5),
        autocorrelation: section.quantities(
            "autocorrelation",
            Dimension::Ratio,
            Bound::NonNegative,
        ),
        noise: section.quantity("noise", Dimension::Ratio, Bound::Positive),
        seeds: section.count("seeds", 1, 10_000) as u64,
    });
    Box::new(move |progress| compute(&settings, progress))
}

/// A test and its largest nominal strain.
type Pull = (&'static str, f64);

/// A law that makes curves, and the law that is fitted to them.
struct Subject {
    name: &'static str,
    law: &'static str,
    values: &'static [f64],
    pulls: &'static [Pull],
    /// Strains grow with this power of the point's number.
    crowding: i32,
    fitted: &'static str,
}

const YEOH: [f64; 3] = [0.05, 0.02, 0.002];

const RIGHT: [Subject; 4] = [
    Subject {
        name: "neo-Hooke, uniaxial",
        law: "neo-hooke",
        values: &[0.1],
        pulls: &[("uniaxial", 1.0)],
        crowding: 1,
        fitted: "neo-hooke",
    },
    Subject {
        name: "Mooney-Rivlin, three tests",
        law: "mooney-rivlin",
        values: &[0.08, 0.03],
        pulls: &[("uniaxial", 1.0), ("planar", 0.8), ("equibiaxial", 0.5)],
        crowding: 1,
        fitted: "mooney-rivlin",
    },
    Subject {
        name: "Yeoh, uniaxial",
        law: "yeoh",
        values: &YEOH,
        pulls: &[("uniaxial", 1.0)],
        crowding: 1,
        fitted: "yeoh",
    },
    Subject {
        name: "Fung-Demiray, two tests, uneven",
        law: "fung-demiray",
        values: &[0.1, 0.6],
        pulls: &[("uniaxial", 0.6), ("equibiaxial", 0.4)],
        crowding: 2,
        fitted: "fung-demiray",
    },
];

const WRONG: Subject = Subject {
    name: "neo-Hooke for Yeoh, uniaxial",
    law: "yeoh",
    values: &YEOH,
    pulls: &[("uniaxial", 1.0)],
    crowding: 1,
    fitted: "neo-hooke",
};

/// What came of one fit.
struct Trial {
    answer: Answer,
    effective_points: f64,
    /// Of each true parameter, whether its interval holds it.
    held: Vec<bool>,
}

/// What is the same for all seeds.
#[derive(Clone, Copy)]
struct Kind {
    points: f64,
    correlation: f64,
}

impl Subject {
    fn trials(&self, settings: &Settings, kind: Kind) -> Result<Vec<Trial>, Error> {
        let seeds = 0..settings.seeds;
        let one = |seed| {
            self.fit(settings.noise, kind, seed)
                .map(|fit| self.trial(&fit))
        };
        seeds.into_par_iter().map(one).collect()
    }

    fn fit(&self, noise: f64, kind: Kind, seed: u64) -> Result<Fit, Error> {
        let (nominal, strain) = (StressMeasure::Nominal, StrainMeasure::Nominal);
        let named = |name: &str| Law::named(name).expect("laws of gelbench");
        let (law, _) = named(self.law).with_values(self.values, nominal, strain);
        let tests = self.pulls.iter().enumerate().map(|(stream, pull)| {
            let drawn = correlated(kind.correlation, seed, stream as u64);
            self.test(&*law, *pull, kind.points, drawn.map(|z| noise * z))
        });
        let tests: Vec<TestData> = tests.collect::<Result<_, _>>()?;
        fit(named(self.fitted), &tests, &FitSettings::default())
    }

    /// The data of a test as a file holds them.
    fn test(
        &self,
        law: &dyn HyperelasticLaw,
        (name, largest): Pull,
        points: f64,
        noise: impl Iterator<Item = f64>,
    ) -> Result<TestData, Error> {
        let stress = |x: f64| match name {
            "uniaxial" => law.tension([1.0, 0.0], x).nominal_stress,
            "planar" => law.biaxial([x, 0.0])[0],
            _ => law.biaxial([x, x])[0],
        };
        let scale = stress(largest);
        let mut text = format!("# test: {name}\nstretch [-],nominal_stress [MPa]\n");
        for (index, noise) in (1..=points as usize).zip(noise) {
            let x = largest * (index as f64 / points).powi(self.crowding);
            text += &format!("{},{}\n", 1.0 + x, stress(x) + scale * noise);
        }
        TestData::parse(name, &text, &Statements::new())
    }

    fn trial(&self, actual: &Fit) -> Trial {
        let quality = &actual.quality;
        let truths = self.values.iter().zip(&quality.estimates);
        let held = |(truth, estimate): (&f64, &Estimate)| estimate.holds(*truth);
        Trial {
            answer: quality
                .verdict
                .map_or(Answer::White, |verdict| verdict.answer),
            effective_points: quality.effective_points(),
            held: truths.map(held).collect(),
        }
    }
}

/// Noise of variance one whose neighbours correlate by so much.
fn correlated(correlation: f64, seed: u64, stream: u64) -> impl Iterator<Item = f64> {
    let fresh = (1.0 - correlation * correlation).max(0.0).sqrt();
    let numbers = normal_numbers_of_stream(seed, stream);
    numbers.scan(None, move |before: &mut Option<f64>, z| {
        *before = Some(before.map_or(z, |last| correlation * last + fresh * z));
        *before
    })
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for points in &settings.points {
        for correlation in &settings.autocorrelation {
            let (points, correlation) = (*points, *correlation);
            let kind = Kind {
                points,
                correlation,
            };
            progress.tell(&format!("{points} points, autocorrelation {correlation}"));
            let mut right = Vec::new();
            for subject in &RIGHT {
                let trials = subject.trials(settings, kind)?;
                rows.push(row(subject, kind, &trials));
                right.extend(trials);
            }
            let wrong = WRONG.trials(settings, kind)?;
            rows.push(row(&WRONG, kind, &wrong));
            outcome.checks.extend(checks(kind, &right, &wrong));
        }
    }
    outcome.blocks = vec![Block::paragraph(EXPLANATION), table(HEAD, rows)];
    Ok(outcome)
}

const HEAD: &str = "fitted law and curves | points of each curve | autocorrelation of the noise | white noise [%] | \
                    correlated noise [%] | systematic [%] | effective points, mean | parameters in their intervals [%]";

const EXPLANATION: &str = "Synthetic test curves of known laws, fitted as `materials fit` does. The verdicts are in percent \
    of all seeds; the last column is the share of true parameters within their 95 % intervals, over the seeds that have \
    intervals. In the uneven curves the points are concentrated at small strains. The last law of each group is wrong: its \
    misfit has to be distinguished from noise.";

fn share_of(trials: &[Trial], answer: Answer) -> f64 {
    share(trials.iter().map(|trial| trial.answer == answer))
}

fn covered(trials: &[Trial]) -> f64 {
    let known = trials.iter().filter(|trial| trial.answer.has_intervals());
    share(known.flat_map(|trial| trial.held.iter().copied()))
}

fn row(subject: &Subject, kind: Kind, trials: &[Trial]) -> Vec<String> {
    let answers = [Answer::White, Answer::Correlated, Answer::Systematic];
    let head = [
        subject.name.to_owned(),
        kind.points.to_string(),
        kind.correlation.to_string(),
    ];
    let mut row = head.to_vec();
    row.extend(answers.map(|answer| number(share_of(trials, answer))));
    row.push(number(mean(
        trials.iter().map(|trial| trial.effective_points),
    )));
    row.push(if subject.fitted == subject.law {
        number(covered(trials))
    } else {
        "–".to_owned()
    });
    row
}

fn checks(kind: Kind, right: &[Trial], wrong: &[Trial]) -> [Check; 3] {
    const SOURCE: &str = "95 %, less sampling error";
    let Kind {
        points,
        correlation,
    } = kind;
    let of = |what: &str| format!("{points} points, autocorrelation {correlation}: {what}");
    let held = || {
        let name = of("parameters in their 95 % intervals");
        check(name, "%", covered(right))
    };
    let wrong = share_of(wrong, Answer::Systematic);
    [
        held().at_least(90.0, SOURCE),
        held().at_most(99.0, SOURCE),
        check(of("a wrong law is detected"), "%", wrong).at_least(95.0, "aim"),
    ]
}
