//! Noise that correlates with distance, and the transformation that makes it white.
//!
//! ```text
//! Corr(εᵢ, εⱼ) = s ρ(|xᵢ − xⱼ|/ℓ)  (i ≠ j),   ρ(1) = 1/e                       s: share of the noise that correlates
//! exponential   ρ = e⁻ᵃ                                    smooth   ρ = (1 + a + a²/3) e⁻ᵃ  (Matérn 5/2)
//! U ε is white:  (U ε)ᵢ = (εᵢ − Σⱼ bᵢⱼ εⱼ)/√fᵢ,   j: the nearest ones of those before i
//! ```
//!
//! bᵢ and fᵢ are the best prediction of εᵢ by a few neighbours that precede it in a random order, and its variance
//! (Vecchia). UᵀU is the sparse precision: R⁻¹ of all markers up to the contribution of farther ones.
//!
//! # References
//! A. V. Vecchia, J. R. Stat. Soc. B 50, 297 (1988), doi:10.1111/j.2517-6161.1988.tb01729.x;
//! J. Guinness, Technometrics 60, 415 (2018), doi:10.1080/00401706.2018.1437476

use std::sync::{Arc, OnceLock};

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::neighbours::nearest_before;

/// Number of neighbours by which each value is predicted.
const NEIGHBOURS: usize = 10;

/// The form of the decrease of a correlation with distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decay {
    /// e⁻ᵃ.
    Exponential,
    /// (1 + a + a²/3) e⁻ᵃ.
    Smooth,
}

/// A correlation that falls with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// The form of the decrease.
    pub decay: Decay,
    /// s in 0…1.
    pub share: f64,
    /// ℓ, in the unit of the positions: the distance at which the correlated part has fallen to 1/e.
    pub length: f64,
}

impl Correlation {
    /// The correlation of two values at a distance greater than zero.
    pub fn at(&self, distance: f64) -> f64 {
        /// (1 + a + a²/3) e⁻ᵃ = 1/e.
        const SMOOTH: f64 = 2.904_629_975;
        let a = distance / self.length;
        self.share
            * match self.decay {
                Decay::Exponential => (-a).exp(),
                Decay::Smooth => {
                    let a = SMOOTH * a;
                    (1.0 + a + a * a / 3.0) * (-a).exp()
                }
            }
    }

    /// The number of independent values with the same information on a variance as values at these positions: n²/Σ ρᵢⱼ².
    pub fn independent(&self, positions: &[[f64; 2]]) -> f64 {
        const MOST: usize = 300;
        let stride = positions.len().div_ceil(MOST).max(1);
        let some: Vec<_> = positions.iter().step_by(stride).collect();
        let of = |position: &[f64; 2]| -> f64 {
            let others = positions.iter().filter(|other| *other != position);
            let squares = others.map(|other| self.at(distance(*position, *other)).powi(2));
            1.0 + squares.sum::<f64>()
        };
        let mean = some.iter().map(|position| of(position)).sum::<f64>() / some.len().max(1) as f64;
        positions.len() as f64 / mean.max(1.0)
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Positions in an order, each with its nearest ones of those that precede it.
type Order = Vec<(usize, Vec<usize>)>;

/// Positions with an order in which each value is predicted from few preceding ones.
#[derive(Clone, Debug)]
pub struct Sites {
    positions: Vec<[f64; 2]>,
    order: Arc<OnceLock<Order>>,
}

impl Sites {
    /// These positions; their order is computed when it is first needed, for noise that correlates.
    pub fn new(positions: Vec<[f64; 2]>) -> Self {
        Self {
            positions,
            order: Arc::default(),
        }
    }

    pub(super) fn order(&self) -> &[(usize, Vec<usize>)] {
        if let Some(order) = self.order.get() {
            return order;
        }
        // Computed before the cell is locked: a thread that waits for others of its pool may enter this function again.
        let order = nearest_before(&self.positions, NEIGHBOURS);
        self.order.get_or_init(|| order)
    }

    /// The positions.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions
    }
}

/// U: a row for each position, in their order.
#[derive(Clone, Debug)]
pub struct Whitening {
    rows: Vec<Row>,
}

#[derive(Clone, Debug)]
struct Row {
    position: usize,
    /// 1/√f.
    scale: f64,
    /// bⱼ of the preceding positions.
    before: Vec<(usize, f64)>,
}

impl Whitening {
    /// The transformation that makes noise of this correlation white; the identity where there is no correlation.
    pub fn new(sites: &Sites, correlation: &Correlation) -> Self {
        let row = |(position, before): &(usize, Vec<usize>)| {
            let at = |a: usize, b: usize| {
                if a == b {
                    1.0
                } else {
                    correlation.at(distance(sites.positions[a], sites.positions[b]))
                }
            };
            let covariances =
                DVector::from_iterator(before.len(), before.iter().map(|b| at(*position, *b)));
            let mutual =
                DMatrix::from_fn(before.len(), before.len(), |i, j| at(before[i], before[j]));
            // Positions that are twice in the data may make the matrix singular.
            let solved = mutual.cholesky().map(|factor| factor.solve(&covariances));
            let weights = solved.unwrap_or_else(|| DVector::zeros(before.len()));
            let variance = (1.0 - covariances.dot(&weights)).max(1e-6);
            Row {
                position: *position,
                scale: variance.sqrt().recip(),
                before: before
                    .iter()
                    .copied()
                    .zip(weights.iter().copied())
                    .collect(),
            }
        };
        Self {
            rows: sites.order().par_iter().map(row).collect(),
        }
    }

    /// ln det R of one component.
    pub fn log_determinant(&self) -> f64 {
        -2.0 * self.rows.iter().map(|row| row.scale.ln()).sum::<f64>()
    }

    /// U a of both components of each position.
    pub fn apply(&self, values: &[f64], white: &mut [f64]) {
        for row in &self.rows {
            for axis in [0, 1] {
                let known: f64 = row
                    .before
                    .iter()
                    .map(|(j, b)| b * values[2 * j + axis])
                    .sum();
                let position = 2 * row.position + axis;
                white[position] = row.scale * (values[position] - known);
            }
        }
    }

    /// U⁻ᵀ a, whose square is aᵀ R a.
    pub fn apply_inverse_transposed(&self, values: &[f64]) -> Vec<f64> {
        let (mut rest, mut result) = (values.to_vec(), vec![0.0; values.len()]);
        for row in self.rows.iter().rev() {
            for axis in [0, 1] {
                let position = 2 * row.position + axis;
                result[position] = rest[position] / row.scale;
                for (j, b) in &row.before {
                    rest[2 * j + axis] += b * rest[position];
                }
            }
        }
        result
    }

    /// U A of all columns.
    pub fn columns(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut white = DMatrix::zeros(matrix.nrows(), matrix.ncols());
        let rows = matrix.nrows().max(1);
        let pairs = matrix.as_slice().chunks_exact(rows);
        for (values, white) in pairs.zip(white.as_mut_slice().chunks_exact_mut(rows)) {
            self.apply(values, white);
        }
        white
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sites() -> Sites {
        let positions = (0..6).flat_map(|i| (0..5).map(move |j| [f64::from(i), f64::from(j)]));
        Sites::new(positions.collect())
    }

    const SHORT: Correlation = Correlation {
        decay: Decay::Exponential,
        share: 0.6,
        length: 1.0,
    };

    #[test]
    fn correlations_fall_to_1_by_e_at_their_length() {
        for decay in [Decay::Exponential, Decay::Smooth] {
            let one = Correlation {
                decay,
                share: 1.0,
                length: 2.5,
            };
            assert!((one.at(2.5) - (-1f64).exp()).abs() < 1e-8 && one.at(1e-12) > 0.999_999);
        }
    }

    #[test]
    fn whitening_is_the_inverse_root_of_the_correlation() {
        let sites = sites();
        let whitening = Whitening::new(&sites, &SHORT);
        let positions = sites.positions();
        let exact = DMatrix::from_fn(positions.len(), positions.len(), |i, j| {
            if i == j {
                1.0
            } else {
                SHORT.at(distance(positions[i], positions[j]))
            }
        });
        let exact_log = exact.clone().determinant().ln();
        assert!((whitening.log_determinant() / exact_log - 1.0).abs() < 0.02);
        let wave = |k: usize| (0.7 * k as f64).sin();
        let both: Vec<f64> = (0..positions.len())
            .flat_map(|k| [wave(k), -2.0 * wave(k)])
            .collect();
        let one = DVector::from_fn(positions.len(), |k, _| wave(k));
        let square = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>();
        let direct = one.dot(&(&exact * &one));
        let actual = square(&whitening.apply_inverse_transposed(&both));
        assert!(
            (actual / (5.0 * direct) - 1.0).abs() < 0.02,
            "{actual} {direct}"
        );
        let inverse = one.dot(&exact.cholesky().unwrap().solve(&one));
        let mut white = vec![0.0; both.len()];
        whitening.apply(&both, &mut white);
        assert!((square(&white) / (5.0 * inverse) - 1.0).abs() < 0.02);
        // U⁻ᵀ undoes Uᵀ exactly: aᵀb = (U⁻ᵀa)ᵀ(U b).
        let mutual: f64 = white
            .iter()
            .zip(whitening.apply_inverse_transposed(&both))
            .map(|(a, b)| a * b)
            .sum();
        assert!((mutual / square(&both) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn long_correlations_leave_few_independent_values() {
        let positions = sites().positions().to_vec();
        assert!(SHORT.independent(&positions) > 15.0);
        let long = Correlation {
            share: 1.0,
            length: 100.0,
            ..SHORT
        };
        assert!(long.independent(&positions) < 1.2);
    }
}
