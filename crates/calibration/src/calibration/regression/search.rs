//! The search for the parameters with the smallest sum of squares: starts that are drawn, completed by linear least squares,
//! and improved.

use rayon::prelude::*;

use super::elastic::Elastic;
use super::misfit::Misfit;
use crate::calibration::least_squares::{Precision, Residuals, descend, minimise, sum_of_squares};
use crate::material::parameters::Parameter;
use crate::units::Dimension;

/// Points above this number are thinned while starts are compared; the last improvement uses all of them.
const THINNED: usize = 400;
/// The number of distinct minima that are improved until convergence.
const REFINED: usize = 3;
/// Draws for each parameter that is no stress.
const DRAWS: usize = 80;

/// Parameters with their sum of squares.
type Candidate = (f64, Vec<f64>);

/// The rough minima that are reached from some starts, the best first.
pub fn improved(
    model: &(impl Residuals + Sync),
    starts: Vec<Vec<f64>>,
    bounds: &[[f64; 2]],
) -> Vec<Candidate> {
    let minimum = |start: Vec<f64>| {
        let result = minimise(model, &start, bounds, Precision::Rough)?;
        Some((sum_of_squares(model, &result), result))
    };
    sorted(starts.into_par_iter().filter_map(minimum).collect())
}

/// What is searched.
pub struct Search<'a> {
    pub misfit: &'a Misfit<Elastic<'a>>,
    pub parameters: &'a [Parameter],
    /// Lower and upper limit of each parameter.
    pub bounds: &'a [[f64; 2]],
}

/// The best parameters, and those of the next best minimum elsewhere.
pub struct Minimum {
    pub values: Vec<f64>,
    pub rival: Option<Rival>,
}

/// Another minimum than the best one.
#[derive(Clone, Debug)]
pub struct Rival {
    pub values: Vec<f64>,
    /// Its sum of squares over that of the best one, less 1.
    pub worse: f64,
}

/// A minimum is no rival where its sum of squares is more than this multiple of the best one, however few the data are.
const FAR: f64 = 5.0;

impl Search<'_> {
    /// The parameters with the smallest sum of squares from `starts` starts; `None` where none describe the data at all.
    pub fn minimum(&self, starts: usize) -> Option<Minimum> {
        let thinned = self.misfit.thinned(THINNED);
        let starts = self.spread(self.starts(&thinned), starts);
        let minima = improved(&thinned, starts, self.bounds);
        let refined: Vec<Vec<f64>> = self
            .apart(&minima)
            .into_par_iter()
            .filter_map(|rough| self.refine(rough))
            .collect();
        let sum = |values: &Vec<f64>| sum_of_squares(self.misfit, values);
        let values = refined.into_iter();
        let values = ordered(
            self.parameters,
            self.bounds,
            values.min_by(|a, b| sum(a).total_cmp(&sum(b)))?,
        );
        // Another minimum counts only where it is still a different one after the same improvement.
        let least = sum_of_squares(&thinned, &values);
        let of_law = self.of_law(values.clone());
        let elsewhere = |result: &Vec<f64>| self.differs(result, &of_law);
        let best_other = minima
            .iter()
            .find(|(sum, result)| *sum <= FAR * least && elsewhere(&self.of_law(result.clone())))
            .and_then(|(_, result)| descend(&thinned, result, self.bounds))
            .map(|result| self.of_law(result))
            .filter(elsewhere);
        let rival = best_other.map(|other| Rival {
            worse: (sum(&other) / sum(&values) - 1.0).max(0.0),
            values: other,
        });
        Some(Minimum { values, rival })
    }

    /// The best starts, and of a law with an angle the best of the others in as many equal parts of its range: valleys of a sum of
    /// squares lie at different angles.
    fn spread(&self, starts: Vec<Candidate>, count: usize) -> Vec<Vec<f64>> {
        let pairs = self.parameters.iter().zip(self.bounds);
        let angle = pairs
            .enumerate()
            .find(|(_, (one, [low, high]))| one.dimension == Dimension::Angle && low < high);
        let (best, others) = starts.split_at(count.min(starts.len()));
        let of_parts = angle.into_iter().flat_map(|(index, (_, [low, high]))| {
            let part =
                move |start: &[f64]| ((start[index] - low) / (high - low) * count as f64) as usize;
            (0..count).filter_map(move |wanted| others.iter().find(|(_, one)| part(one) == wanted))
        });
        let chosen = best.iter().chain(of_parts);
        chosen.map(|(_, start)| start.clone()).collect()
    }

    /// Values as the law takes them: within limits that depend on others, and in order.
    fn of_law(&self, values: Vec<f64>) -> Vec<f64> {
        let (_, entries) = self.misfit.response.build(&values);
        let values = entries.parameters.iter().map(|one| one.value).collect();
        ordered(self.parameters, self.bounds, values)
    }

    /// The best of some distinct minima, without those whose sum of squares is so large that they cannot become the best.
    fn apart(&self, minima: &[Candidate]) -> Vec<Vec<f64>> {
        const ABOVE: f64 = 1.2;
        let mut chosen: Vec<Vec<f64>> = Vec::new();
        for (sum, result) in minima {
            let result = self.of_law(result.clone());
            if *sum <= ABOVE * minima[0].0
                && chosen.iter().all(|other| self.differs(&result, other))
            {
                chosen.push(result);
            }
        }
        chosen.truncate(REFINED);
        chosen
    }

    /// Starts within the bounds, the best first.
    fn starts(&self, misfit: &Misfit<Elastic>) -> Vec<Candidate> {
        let stresses = self.stresses();
        let fitted = self.bounds.iter().filter(|[low, high]| low < high).count();
        let free = fitted - stresses.len();
        let scale = misfit.response.stiffness;
        let mut starts = Vec::new();
        for number in 0..(DRAWS * free).max(1) {
            let mut values = self.draw(scale, number);
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
            if sum.is_finite() && holds(self.bounds, &values) {
                starts.push((sum, values));
            }
        }
        sorted(starts)
    }

    /// A point of Sobol's sequence within the usual ranges.
    fn draw(&self, scale: f64, number: usize) -> Vec<f64> {
        let draw = |(dimension, (parameter, [low, high])): (usize, (&Parameter, &[f64; 2]))| {
            let share = f64::from(sobol_burley::sample(number as u32, dimension as u32, 1));
            let [from, to] = match parameter.usual {
                [from, to] if from.max(*low) < to.min(*high) => [from.max(*low), to.min(*high)],
                usual => usual,
            };
            let drawn = if parameter.is_stress() {
                scale * 0.01_f64.powf(share)
            } else if from > 0.0 {
                from * (to / from).powf(share)
            } else {
                from + (to - from) * share
            };
            drawn.clamp(*low, *high)
        };
        let pairs = self.parameters.iter().zip(self.bounds);
        pairs.enumerate().map(draw).collect()
    }

    /// Improves parameters until they are a minimum; those that are stresses begin at their best values given the others.
    fn refine(&self, values: Vec<f64>) -> Option<Vec<f64>> {
        let mut linear = values.clone();
        let completed = self.misfit.complete(&mut linear, &self.stresses());
        let sum = |values: &[f64]| sum_of_squares(self.misfit, values);
        let is_better =
            completed.is_some() && holds(self.bounds, &linear) && sum(&linear) < sum(&values);
        let start = if is_better { linear } else { values };
        descend(self.misfit, &start, self.bounds).or(Some(start))
    }

    /// The fitted parameters that are stresses.
    fn stresses(&self) -> Vec<usize> {
        let all = 0..self.parameters.len();
        let is_fitted = |index: &usize| self.bounds[*index][0] < self.bounds[*index][1];
        all.filter(|index| self.parameters[*index].is_stress() && is_fitted(index))
            .collect()
    }

    /// Whether a parameter of another minimum differs by a tenth of its size, or of its least significant size.
    pub fn differs(&self, other: &[f64], values: &[f64]) -> bool {
        const FAR: f64 = 0.1;
        let stiffness = self.misfit.response.stiffness;
        let pairs = other.iter().zip(values).zip(self.parameters);
        let mut apart = pairs.map(|((other, value), parameter)| {
            let size = value.abs().max(parameter.least_size(stiffness));
            (other - value).abs() > FAR * size
        });
        apart.any(|apart| apart)
    }
}

/// Values with the terms of a sum of powers in the order of their exponents, where bounds allow it, so that equal fits have equal parameters.
/// Values after those of the law stay.
pub fn ordered(parameters: &[Parameter], bounds: &[[f64; 2]], values: Vec<f64>) -> Vec<f64> {
    let keys = parameters.iter().map(|parameter| parameter.key);
    let count = keys.filter(|key| key.starts_with("alpha_")).count();
    if count < 2 {
        return values;
    }
    let (of_law, others) = values.split_at(parameters.len());
    let mut terms: Vec<&[f64]> = of_law.chunks(of_law.len() / count).collect();
    terms.sort_by(|a, b| b[1].total_cmp(&a[1]));
    let ordered = [&terms.concat(), others].concat();
    if holds(bounds, &ordered) {
        ordered
    } else {
        values
    }
}

/// Whether values lie within their bounds.
pub fn holds(bounds: &[[f64; 2]], values: &[f64]) -> bool {
    let mut pairs = values.iter().zip(bounds);
    pairs.all(|(value, [low, high])| (low..=high).contains(&value))
}

fn sorted(mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    candidates
}
