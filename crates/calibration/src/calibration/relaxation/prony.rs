//! The search for the terms of a Prony series on top of a law.
//!
//! ```text
//! σ(t) = c (σ∞(t) + Σ βₖ σₖ(t))
//! ```
//!
//! is linear in c and c βₖ for relaxation times on a grid: every few of them are tried by linear least squares, those without
//! negative shares and with the smallest sums are improved with the law's parameters by Levenberg–Marquardt, in gᵢ and ln τᵢ.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::history::{History, State};
use crate::calibration::data::TestData;
use crate::calibration::least_squares::descend;
use crate::calibration::regression::{Misfit, Response, Row, holds, improved, ordered};
use crate::calibration::settings::MEASURE;
use crate::material::HyperelasticLaw;
use crate::material::parameters::Parameter;
use crate::material::registry::Law;
use crate::material::viscosity::{Relaxation, ViscousMaterial};
use crate::statistics::extremes;

/// Relaxation times on the grid: their number in a decade, and the limits of their number.
const IN_A_DECADE: f64 = 4.0;
const GRID: [usize; 2] = [6, 16];
/// Starts that are improved.
const STARTS: usize = 3;
/// The limit of the sum of all shares.
pub const MOST_SHARED: f64 = 0.999;

/// A law with a Prony series over some histories. Values are those of the law, then share and ln time in s of each term.
#[derive(Clone)]
pub struct Viscous<'a> {
    /// The law.
    pub law: &'static Law,
    /// How many values the law has.
    pub of_law: usize,
    /// The tests.
    pub tests: &'a [TestData],
    /// What is fitted of them.
    pub histories: Vec<History>,
}

impl Viscous<'_> {
    /// The Prony series of some values.
    pub fn material(&self, values: &[f64]) -> ViscousMaterial {
        let (terms, _) = values[self.of_law..].as_chunks::<2>();
        let terms = terms.iter().map(|[share, time]| Relaxation {
            share: *share,
            time: time.exp(),
        });
        ViscousMaterial {
            relaxation: terms.collect(),
            ..ViscousMaterial::default()
        }
    }

    /// The stresses of some values at all states of each history, in MPa.
    fn of_histories(&self, histories: &[History], values: &[f64]) -> Vec<Vec<f64>> {
        let (law, material) = (self.law(values), self.material(values));
        let stresses = histories.iter().map(|history| {
            let data = &self.tests[history.test];
            let long = history.long_time_stress(data, &*law);
            history.stresses(data, &long, &material)
        });
        stresses.collect()
    }
}

impl Response for Viscous<'_> {
    fn data(&self) -> &[TestData] {
        self.tests
    }

    fn rows(&self) -> Vec<Row> {
        let states = self
            .histories
            .iter()
            .flat_map(|history| history.states.iter().map(move |state| (history, state)));
        let row = |(number, (history, state)): (usize, (&History, &State))| {
            Row::of(history.test, &state.observation, number as f64, state.count)
        };
        states.enumerate().map(row).collect()
    }

    fn law(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw> {
        let measure = self.tests[0].stress_measure;
        let of_law = &values[..self.of_law];
        self.law.with_values(of_law, measure, MEASURE).0.into()
    }

    fn stresses(&self, values: &[f64]) -> Vec<f64> {
        let (terms, _) = values[self.of_law..].as_chunks::<2>();
        if terms.iter().map(|[share, _]| share).sum::<f64>() > MOST_SHARED {
            return self.rows().iter().map(|_| f64::NAN).collect();
        }
        self.of_histories(&self.histories, values).concat()
    }

    fn predicted(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let tests = self.tests.iter();
        let mut predicted: Vec<Vec<f64>> = tests
            .map(|test| vec![f64::NAN; test.observations.len()])
            .collect();
        // The tests had times and rows when they were gathered.
        let histories = History::all(self.tests, false).unwrap_or_default();
        let stresses = self.of_histories(&histories, values);
        for (history, stresses) in histories.iter().zip(stresses) {
            let axis = history.states[0].observation.axis;
            let observations = self.tests[history.test].observations.iter();
            let rows = observations.zip(&mut predicted[history.test]);
            let along = rows.filter(|(one, _)| one.axis == axis);
            for ((_, predicted), stress) in along.zip(stresses) {
                *predicted = stress;
            }
        }
        predicted
    }

    fn is_logarithmic(&self, value: usize) -> bool {
        value > self.of_law && (value - self.of_law) % 2 == 1
    }
}

impl Misfit<Viscous<'_>> {
    /// The best values with as many terms as there are bounds, from some values of the law.
    pub fn minimum(
        &self,
        laws: &[Vec<f64>],
        parameters: &[Parameter],
        bounds: &[[f64; 2]],
    ) -> Option<Vec<f64>> {
        let each = laws.iter();
        let starts = each.flat_map(|law| self.starts(law, parameters, bounds));
        let (_, best) = improved(self, starts.collect(), bounds)
            .into_iter()
            .next()?;
        let mut values = descend(self, &best, bounds).unwrap_or(best);
        let of_law = self.response.of_law;
        // Terms stand in the order of their times, where bounds allow it.
        let mut sorted = values.clone();
        let (terms, _) = sorted[of_law..].as_chunks_mut::<2>();
        terms.sort_by(|a, b| a[1].total_cmp(&b[1]));
        if holds(bounds, &sorted) {
            values = sorted;
        }
        Some(ordered(&parameters[..of_law], bounds, values))
    }

    /// Starts from values of the law, the best first.
    fn starts(&self, law: &[f64], parameters: &[Parameter], bounds: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let of_law = self.response.of_law;
        let terms = (bounds.len() - of_law) / 2;
        if terms == 0 {
            return vec![law.to_vec()];
        }
        let times = bounds[of_law..].iter().skip(1).step_by(2).flatten();
        let [low, high] = extremes(times.copied());
        let decades = (high - low) / std::f64::consts::LN_10;
        let count = ((IN_A_DECADE * decades) as usize)
            .clamp(GRID[0], GRID[1])
            .max(terms);
        let time = |k: usize| low + (high - low) * (k as f64 + 0.5) / count as f64;
        let grid: Vec<f64> = (0..count).map(time).collect();
        let (matrix, right) = self.normal_equations(law, &grid);
        let mut tried: Vec<(f64, Vec<usize>, DVector<f64>)> = Vec::new();
        for chosen in subsets(count, terms) {
            let rows: Vec<usize> = [0]
                .into_iter()
                .chain(chosen.iter().map(|k| k + 1))
                .collect();
            let part = matrix.select_rows(&rows).select_columns(&rows);
            let target = right.select_rows(&rows);
            let Some(solution) = part.cholesky().map(|factor| factor.solve(&target)) else {
                continue;
            };
            if solution.iter().all(|value| *value > 0.0) {
                tried.push((-solution.dot(&target), chosen, solution));
            }
        }
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let start = |(_, chosen, solution): (f64, Vec<usize>, DVector<f64>)| {
            let mut values = law.to_vec();
            for (value, _) in values
                .iter_mut()
                .zip(parameters)
                .filter(|(_, one)| one.is_stress())
            {
                *value *= solution[0];
            }
            let all = solution.sum();
            for (index, k) in chosen.iter().enumerate() {
                values.push(solution[index + 1] / all);
                values.push(grid[*k]);
            }
            for (value, [low, high]) in values.iter_mut().zip(bounds) {
                *value = value.clamp(*low, *high);
            }
            values
        };
        tried.into_iter().take(STARTS).map(start).collect()
    }

    /// AᵀA and Aᵀσ of the weighted columns σ∞ and σₖ, one for each time on the grid.
    fn normal_equations(&self, law: &[f64], grid: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let elastic = self.weighed(self.response.stresses(law));
        let mut columns = vec![elastic.clone()];
        for time in grid {
            // β = 1.
            let values: Vec<f64> = law.iter().copied().chain([0.5, *time]).collect();
            columns.push(self.weighed(self.response.stresses(&values)) - &elastic);
        }
        let columns = DMatrix::from_columns(&columns);
        let target = self.weighed(self.rows.iter().map(|row| row.stress).collect());
        (columns.tr_mul(&columns), columns.tr_mul(&target))
    }
}

/// All ascending choices of `size` of the first `count` numbers.
fn subsets(count: usize, size: usize) -> Vec<Vec<usize>> {
    let mut subsets = vec![Vec::new()];
    for _ in 0..size {
        let longer = |shorter: &Vec<usize>| {
            let first = shorter.last().map_or(0, |last| last + 1);
            let shorter = shorter.clone();
            (first..count)
                .map(move |next| shorter.iter().copied().chain([next]).collect::<Vec<_>>())
        };
        subsets = subsets.iter().flat_map(longer).collect();
    }
    subsets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subsets_are_all_there() {
        assert_eq!(subsets(5, 2).len(), 10);
        assert_eq!(subsets(3, 3), [[0, 1, 2]]);
        assert_eq!(subsets(3, 0), [Vec::<usize>::new()]);
    }
}
