//! The search for the terms of a Prony series on top of a law.
//!
//! ```text
//! σ(t) = c (σ∞(t) + Σ βₖ σₖ(t))
//! ```
//!
//! is linear in c and c βₖ for relaxation times on a grid: every few of them are tried by linear least squares, those without
//! negative shares and with the smallest sums are improved with the law's parameters by Levenberg–Marquardt, in gᵢ and ln τᵢ.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::history::History;
use crate::calibration::data::TestData;
use crate::calibration::least_squares::{
    Measured, Precision, Residuals, descend, minimise, sum_of_squares,
};
use crate::calibration::regression::{Reweighed, Rows, ordered};
use crate::calibration::settings::{MEASURE, Weighting};
use crate::material::HyperelasticLaw;
use crate::material::parameters::Parameter;
use crate::material::registry::Law;
use crate::material::viscosity::{Relaxation, ViscousMaterial};

/// Relaxation times on the grid: so many in a decade, but within these numbers.
const IN_A_DECADE: f64 = 4.0;
const GRID: [usize; 2] = [6, 16];
/// Starts that are improved.
const STARTS: usize = 3;
/// All shares together stay below this.
pub const MOST_SHARED: f64 = 0.999;

/// The residuals of a law with a Prony series over some histories. Parameters are those of the law, then share and ln time in s of
/// each term.
pub struct ViscousMisfit<'a> {
    law: &'static Law,
    /// How many parameters the law has.
    pub of_law: usize,
    tests: &'a [TestData],
    /// The histories.
    pub histories: Vec<History>,
    weighting: Weighting,
    weights: Vec<Vec<f64>>,
}

/// Values with their sum of squares.
pub type Found = (f64, Vec<f64>);

impl<'a> ViscousMisfit<'a> {
    /// The residuals of a law with so many parameters, weighted by the measured stresses.
    pub fn new(
        law: &'static Law,
        of_law: usize,
        tests: &'a [TestData],
        histories: Vec<History>,
        weighting: Weighting,
    ) -> Self {
        let weights = histories.iter().map(|history| {
            let states = history.states.iter();
            let stresses = states.map(|state| state.observation.stress);
            weights(weighting, &tests[history.test], history, stresses)
        });
        Self {
            law,
            of_law,
            tests,
            weighting,
            weights: weights.collect(),
            histories,
        }
    }

    /// The law's entry in the registry.
    pub fn entry(&self) -> &'static Law {
        self.law
    }

    /// The law of long times.
    pub fn law(&self, values: &[f64]) -> Box<dyn HyperelasticLaw> {
        let measure = self.tests[0].stress_measure;
        self.law
            .with_values(&values[..self.of_law], measure, MEASURE)
            .0
    }

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
    pub fn stresses(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let (law, material) = (self.law(values), self.material(values));
        let stresses = self.histories.iter().map(|history| {
            let data = &self.tests[history.test];
            let long = history.long_time_stress(data, &*law);
            history.stresses(data, &long, &material)
        });
        stresses.collect()
    }

    /// The rows of each history in the order of time.
    pub fn curves(&self) -> Vec<Rows> {
        let mut first = 0;
        let rows = |history: &History| {
            let count = history.states.len();
            first += count;
            (first - count..first)
                .map(|row| (row, row as f64))
                .collect()
        };
        self.histories.iter().map(rows).collect()
    }

    /// The best values with so many terms within bounds, from some values of the law.
    pub fn minimum(
        &self,
        laws: &[Vec<f64>],
        parameters: &[Parameter],
        bounds: &[[f64; 2]],
    ) -> Option<Found> {
        let terms = (bounds.len() - self.of_law) / 2;
        let starts: Vec<Vec<f64>> = laws
            .iter()
            .flat_map(|law| self.starts(law, parameters, bounds, terms))
            .collect();
        let improved = |start: &Vec<f64>| {
            let found = minimise(self, start, bounds, Precision::Rough)?;
            Some((sum_of_squares(self, &found), found))
        };
        let rough: Vec<Found> = starts.par_iter().filter_map(improved).collect();
        let best = rough.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let found = descend(self, &best.1, bounds).unwrap_or(best.1);
        let found = ordered(&parameters[..self.of_law], bounds, self.ordered(found));
        Some((sum_of_squares(self, &found), found))
    }

    /// The terms in the order of their times.
    fn ordered(&self, mut values: Vec<f64>) -> Vec<f64> {
        let (terms, _) = values[self.of_law..].as_chunks_mut::<2>();
        terms.sort_by(|a, b| a[1].total_cmp(&b[1]));
        values
    }

    /// Starts from values of the law, the best first.
    fn starts(
        &self,
        law: &[f64],
        parameters: &[Parameter],
        bounds: &[[f64; 2]],
        terms: usize,
    ) -> Vec<Vec<f64>> {
        if terms == 0 {
            return vec![law.to_vec()];
        }
        let [low, high] = bounds[self.of_law + 1];
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
            let Some(found) = part.cholesky().map(|factor| factor.solve(&target)) else {
                continue;
            };
            if found.iter().all(|value| *value > 0.0) {
                tried.push((-found.dot(&target), chosen, found));
            }
        }
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let start = |(_, chosen, found): (f64, Vec<usize>, DVector<f64>)| {
            let mut values = law.to_vec();
            for (value, _) in values
                .iter_mut()
                .zip(parameters)
                .filter(|(_, one)| one.is_stress())
            {
                *value *= found[0];
            }
            let all = found.sum();
            for (index, k) in chosen.iter().enumerate() {
                values.push(found[index + 1] / all);
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
        let elastic = self.weighted(&self.stresses(law));
        let mut columns = vec![elastic.clone()];
        for time in grid {
            // β = 1.
            let values: Vec<f64> = law.iter().copied().chain([0.5, *time]).collect();
            columns.push(self.weighted(&self.stresses(&values)) - &elastic);
        }
        let columns = DMatrix::from_columns(&columns);
        let measured: Vec<Vec<f64>> = self
            .histories
            .iter()
            .map(|history| {
                let states = history.states.iter();
                states.map(|state| state.observation.stress).collect()
            })
            .collect();
        let target = self.weighted(&measured);
        (columns.tr_mul(&columns), columns.tr_mul(&target))
    }

    fn weighted(&self, stresses: &[Vec<f64>]) -> DVector<f64> {
        let pairs = stresses.iter().zip(&self.weights);
        let values = pairs.flat_map(|(own, weights)| own.iter().zip(weights));
        let values: Vec<f64> = values.map(|(stress, weight)| stress * weight).collect();
        DVector::from_vec(values)
    }
}

impl Residuals for ViscousMisfit<'_> {
    fn count(&self) -> usize {
        self.weights.iter().map(Vec::len).sum()
    }

    fn evaluate(&self, parameters: &[f64], residuals: &mut [f64]) -> bool {
        let (terms, _) = parameters[self.of_law..].as_chunks::<2>();
        if terms.iter().map(|[share, _]| share).sum::<f64>() > MOST_SHARED {
            return false;
        }
        let mut residuals = residuals.iter_mut();
        let found = self.stresses(parameters);
        for ((history, own), weights) in self.histories.iter().zip(&found).zip(&self.weights) {
            for ((state, stress), weight) in history.states.iter().zip(own).zip(weights) {
                let residual = weight * (state.observation.stress - stress);
                match residuals.next() {
                    Some(place) if residual.is_finite() => *place = residual,
                    _ => return false,
                }
            }
        }
        true
    }
}

impl Reweighed for ViscousMisfit<'_> {
    fn reweighed(&self, values: &[f64]) -> Self {
        let stresses = self.stresses(values);
        let weights = self.histories.iter().zip(stresses).map(|(history, own)| {
            let data = &self.tests[history.test];
            weights(self.weighting, data, history, own.into_iter())
        });
        Self {
            weights: weights.collect(),
            histories: self.histories.clone(),
            ..*self
        }
    }

    fn is_relative(&self) -> bool {
        self.weighting == Weighting::Relative
    }

    fn measured(&self) -> Vec<Measured> {
        let histories = self.histories.iter().zip(&self.weights);
        let rows = histories.flat_map(|(history, weights)| history.states.iter().zip(weights));
        rows.map(|(state, weight)| Measured {
            stress: state.observation.stress,
            weight: weight / state.count.sqrt(),
            count: state.count,
        })
        .collect()
    }
}

/// The weights of the states of a history by some stresses there; the means of many rows weigh as all of them.
fn weights(
    weighting: Weighting,
    data: &TestData,
    history: &History,
    stresses: impl Iterator<Item = f64>,
) -> Vec<f64> {
    let pairs = history.states.iter().zip(stresses);
    pairs
        .map(|(state, stress)| weighting.weight_of(data, stress) * state.count.sqrt())
        .collect()
}

/// All ascending choices of `size` of the first `count` numbers.
fn subsets(count: usize, size: usize) -> Vec<Vec<usize>> {
    let mut found = vec![Vec::new()];
    for _ in 0..size {
        let longer = |own: &Vec<usize>| {
            let first = own.last().map_or(0, |last| last + 1);
            let own = own.clone();
            (first..count).map(move |next| own.iter().copied().chain([next]).collect::<Vec<_>>())
        };
        found = found.iter().flat_map(longer).collect();
    }
    found
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
