//! The search for the parameters with the smallest sum of squares: starts that are drawn, completed by linear least squares,
//! and improved.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::misfit::Misfit;
use crate::calibration::least_squares::{Precision, minimise, sum_of_squares};
use crate::material::parameters::Parameter;

/// Points above this number are thinned while starts are compared; the last improvement uses all of them.
const THINNED: usize = 400;
/// How many of the improved starts are improved to the end.
const REFINED: usize = 2;
/// Draws for each parameter that is no stress.
const DRAWS: usize = 80;

/// Parameters with their sum of squares.
type Candidate = (f64, Vec<f64>);

/// What is searched.
pub struct Search<'a> {
    pub misfit: &'a Misfit<'a>,
    pub parameters: &'a [Parameter],
    /// Lower and upper limit of each parameter.
    pub bounds: &'a [[f64; 2]],
}

/// The best parameters, and those of the next best minimum elsewhere.
pub struct Minimum {
    pub values: Vec<f64>,
    pub rival: Option<Rival>,
}

/// A minimum beside the best one.
#[derive(Clone, Debug)]
pub struct Rival {
    pub values: Vec<f64>,
    /// Its sum of squares over that of the best one, less 1.
    pub worse: f64,
}

/// A minimum whose sum of squares is so many times that of the best one is no rival, however few the data are.
const FAR: f64 = 5.0;

impl Search<'_> {
    /// The parameters of the smallest sum of squares from so many starts; `None` where none describe the data at all.
    pub fn minimum(&self, starts: usize) -> Option<Minimum> {
        let thinned = self.misfit.thinned(THINNED);
        let mut best_starts = self.starts(&thinned);
        best_starts.truncate(starts);
        let rough = |(_, start): Candidate| {
            let found = minimise(&thinned, &start, self.bounds, Precision::Rough)?;
            Some((sum_of_squares(&thinned, &found), found))
        };
        let minima = best_starts.into_par_iter().filter_map(rough).collect();
        let minima = sorted(minima);
        // A minimum that is far above the best one cannot become it.
        let refined =
            minima
                .iter()
                .take(REFINED)
                .map(|(sum, rough)| match *sum > 1.2 * minima[0].0 {
                    true => rough.clone(),
                    false => self.refine(rough.clone()),
                });
        let sum = |values: &Vec<f64>| sum_of_squares(self.misfit, values);
        let values = self.ordered(refined.min_by(|a, b| sum(a).total_cmp(&sum(b)))?);
        // Another minimum counts as one when it is still elsewhere after the same care.
        let least = sum_of_squares(&thinned, &values);
        let elsewhere = |found: &Vec<f64>| differs(found, &values);
        let rival = minima
            .iter()
            .find(|(sum, found)| *sum <= FAR * least && elsewhere(&self.ordered(found.clone())))
            .and_then(|(_, found)| minimise(&thinned, found, self.bounds, Precision::Full))
            .map(|found| self.ordered(found))
            .filter(elsewhere);
        let rival = rival.map(|own| {
            let [best, rival] = [sum(&values), sum(&own)];
            Rival {
                worse: if rival > best {
                    rival / best - 1.0
                } else {
                    0.0
                },
                values: own,
            }
        });
        Some(Minimum { values, rival })
    }

    /// Starts within the bounds, the best first.
    fn starts(&self, misfit: &Misfit) -> Vec<Candidate> {
        let stresses = self.stresses();
        let free = self.parameters.len() - stresses.len();
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let scale = misfit.stiffness();
        let mut starts = Vec::new();
        for _ in 0..(DRAWS * free).max(1) {
            let mut values = self.draw(scale, &mut random);
            let drawn = values.clone();
            if misfit.complete(&mut values, &stresses).is_none() {
                values = drawn;
            }
            for (value, [low, high]) in values.iter_mut().zip(self.bounds) {
                // A start on a bound could never leave it: stay a little inside.
                let width = (high - low).min(scale.max(value.abs()));
                *value = value.max(low + 1e-3 * width).min(high - 1e-3 * width);
            }
            let sum = sum_of_squares(misfit, &values);
            if sum.is_finite() && self.holds(&values) {
                starts.push((sum, values));
            }
        }
        sorted(starts)
    }

    fn draw(&self, scale: f64, random: &mut ChaCha8Rng) -> Vec<f64> {
        let draw = |(parameter, [low, high]): (&Parameter, &[f64; 2])| {
            let share: f64 = random.random();
            let [from, to] = parameter.usual;
            let drawn = match from > 0.0 {
                _ if parameter.is_stress() => scale * 0.01_f64.powf(share),
                true => from * (to / from).powf(share),
                false => from + (to - from) * share,
            };
            drawn.clamp(*low, *high)
        };
        self.parameters.iter().zip(self.bounds).map(draw).collect()
    }

    /// Improves parameters until neither the linear ones alone nor all together can be improved: narrow valleys
    /// need several turns.
    fn refine(&self, mut values: Vec<f64>) -> Vec<f64> {
        let stresses = self.stresses();
        let sum = |values: &[f64]| sum_of_squares(self.misfit, values);
        for _ in 0..5 {
            let before = sum(&values);
            let mut linear = values.clone();
            let completed = self.misfit.complete(&mut linear, &stresses).is_some();
            if completed && self.holds(&linear) && sum(&linear) < before {
                values = linear;
            }
            if let Some(better) = minimise(self.misfit, &values, self.bounds, Precision::Full) {
                values = better;
            }
            if sum(&values) > (1.0 - 1e-9) * before {
                break;
            }
        }
        values
    }

    /// The parameters that are stresses.
    fn stresses(&self) -> Vec<usize> {
        let all = 0..self.parameters.len();
        all.filter(|index| self.parameters[*index].is_stress())
            .collect()
    }

    /// Whether values lie within the bounds.
    fn holds(&self, values: &[f64]) -> bool {
        let mut pairs = values.iter().zip(self.bounds);
        pairs.all(|(value, [low, high])| (low..=high).contains(&value))
    }

    /// Terms of Ogden's law in the order of their exponents: the same fit always has the same face.
    fn ordered(&self, values: Vec<f64>) -> Vec<f64> {
        let is_term = |pair: &[Parameter]| {
            pair[0].key.starts_with("mu_") && pair[1].key.starts_with("alpha_")
        };
        let (terms, rest) = self.parameters.as_chunks::<2>();
        if !rest.is_empty() || !terms.iter().all(|pair| is_term(pair)) {
            return values;
        }
        let mut terms = values.as_chunks::<2>().0.to_vec();
        terms.sort_by(|a, b| b[1].total_cmp(&a[1]));
        terms.concat()
    }
}

fn sorted(mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    candidates
}

/// Whether a parameter of another minimum is a tenth away.
pub fn differs(other: &[f64], values: &[f64]) -> bool {
    let mut pairs = other.iter().zip(values);
    pairs.any(|(other, value)| (other - value).abs() / value.abs().max(1e-300) > 0.1)
}
