//! The correlation of a regression's noise, by restricted likelihood.
//!
//! ```text
//! z = A δ + ε,   Cov(ε) = τ² R,   δ held by S with slope g₀
//! −2 ln L = n ln τ² + 2 ln det R₁ + ln det M + (zᵀR⁻¹z)/τ² − gᵀM⁻¹g,   M = AᵀR⁻¹A/τ² + S,   g = AᵀR⁻¹z/τ² + g₀
//! ```
//!
//! R₁ is the correlation of one component at n/2 positions. The determinant of M accounts for the part of the noise that the fit has removed.
//!
//! # References
//! D. A. Harville, J. Am. Stat. Assoc. 72, 320 (1977), doi:10.1080/01621459.1977.10480998

use std::cmp::Ordering;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::correlation::{Correlation, Decay, Sites, Whitening};
use super::{chi_squared_limit, inverse_of, normal_equations};

/// A regression with two rows, one of each component, for each position; their variance is one where they are white.
pub struct CorrelatedRegression<'a> {
    /// The positions of the rows.
    pub sites: &'a Sites,
    /// A.
    pub design: &'a DMatrix<f64>,
    /// z.
    pub residual: &'a DVector<f64>,
    /// S.
    pub held: &'a DMatrix<f64>,
    /// g₀.
    pub slope: &'a DVector<f64>,
}

/// Noise that a regression may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorrelatedNoise {
    /// Its correlation.
    pub correlation: Correlation,
    /// τ².
    pub variance: f64,
    /// 2 ln of its likelihood over that of white noise.
    pub evidence: f64,
}

/// A regression whose rows were whitened.
pub struct WhiteRegression {
    normal: DMatrix<f64>,
    right: DVector<f64>,
    square: f64,
    rows: f64,
    log_determinant: f64,
}

/// The likelihood of a regression at its best variance.
#[derive(Clone, Copy)]
struct Score {
    /// −2 ln L.
    deviance: f64,
    variance: f64,
}

impl WhiteRegression {
    /// The regression of rows that are white, or are whitened.
    pub fn new(
        design: &DMatrix<f64>,
        residual: &DVector<f64>,
        whitening: Option<&Whitening>,
    ) -> Self {
        let Some(whitening) = whitening else {
            return Self::of_rows(design, residual, 0.0);
        };
        let mut white = DVector::zeros(residual.len());
        whitening.apply(residual.as_slice(), white.as_mut_slice());
        Self::of_rows(
            &whitening.columns(design),
            &white,
            whitening.log_determinant(),
        )
    }

    fn of_rows(design: &DMatrix<f64>, residual: &DVector<f64>, log_determinant: f64) -> Self {
        let (normal, right) = normal_equations(design, residual, |_| 1.0);
        Self {
            normal,
            right,
            square: residual.norm_squared(),
            rows: residual.len() as f64,
            log_determinant,
        }
    }

    /// zᵀR⁻¹z of the residuals at the best δ, and the effective number of fitted parameters; `None` where δ is not determined.
    pub fn residual_square(
        &self,
        held: &DMatrix<f64>,
        slope: &DVector<f64>,
        variance: f64,
    ) -> Option<(f64, f64)> {
        let (_, solution, effective) = self.solve(held, slope, variance)?;
        let square = self.square - 2.0 * solution.dot(&self.right)
            + solution.dot(&(&self.normal * &solution));
        Some((square.max(f64::MIN_POSITIVE), effective))
    }

    /// The best δ; `None` where it is not determined.
    pub fn best(
        &self,
        held: &DMatrix<f64>,
        slope: &DVector<f64>,
        variance: f64,
    ) -> Option<DVector<f64>> {
        let (_, solution, _) = self.solve(held, slope, variance)?;
        Some(solution)
    }

    /// ln det M − gᵀM⁻¹g, δ, and tr(M⁻¹AᵀR⁻¹A)/τ².
    fn solve(
        &self,
        held: &DMatrix<f64>,
        slope: &DVector<f64>,
        variance: f64,
    ) -> Option<(f64, DVector<f64>, f64)> {
        const LEAST: f64 = 1e-12;
        let mut matrix = &self.normal / variance + held;
        // Directions that are not determined stay unchanged.
        let ridge = LEAST * matrix.trace() / matrix.nrows().max(1) as f64;
        (0..matrix.nrows()).for_each(|i| matrix[(i, i)] += ridge);
        let target = &self.right / variance + slope;
        let factor = matrix.cholesky()?;
        let solution = factor.solve(&target);
        let log: f64 = factor
            .l_dirty()
            .diagonal()
            .iter()
            .map(|pivot| 2.0 * pivot.ln())
            .sum();
        let effective = inverse_of(&factor).dot(&self.normal) / variance;
        Some((log - target.dot(&solution), solution, effective))
    }

    fn score(&self, held: &DMatrix<f64>, slope: &DVector<f64>) -> Option<Score> {
        const ITERATIONS: usize = 4;
        let mut variance = 1.0;
        for _ in 0..ITERATIONS {
            let (square, effective) = self.residual_square(held, slope, variance)?;
            variance = (square / (self.rows - effective).max(1.0)).max(f64::MIN_POSITIVE);
        }
        let (rest, ..) = self.solve(held, slope, variance)?;
        let deviance =
            self.rows * variance.ln() + 2.0 * self.log_determinant + rest + self.square / variance;
        Some(Score { deviance, variance })
    }
}

/// Shares of the noise that are tried.
const SHARES: [f64; 4] = [0.25, 0.6, 0.9, 0.995];

impl CorrelatedRegression<'_> {
    /// The correlations with a length between half of `spacing` and `longest` that a 95 % region of length and share holds, the
    /// likeliest first; nothing where they are not determined.
    pub fn plausible(&self, spacing: f64, longest: f64) -> Vec<CorrelatedNoise> {
        let regression = WhiteRegression::new(self.design, self.residual, None);
        let white = regression.score(self.held, self.slope);
        let (Some(white), Some(tried)) = (white, self.search(spacing, longest)) else {
            return Vec::new();
        };
        let least = tried[0].1.deviance;
        let near = tried
            .into_iter()
            .filter(|(_, score)| score.deviance - least < chi_squared_limit(2.0, 0.05));
        near.map(|(correlation, score)| CorrelatedNoise {
            correlation,
            variance: score.variance,
            evidence: white.deviance - score.deviance,
        })
        .collect()
    }

    /// All correlations that are tried, the likeliest first.
    fn search(&self, spacing: f64, longest: f64) -> Option<Vec<(Correlation, Score)>> {
        const STEP: f64 = 1.8;
        let geometric = std::iter::successors(Some(0.6 * spacing), |length| Some(STEP * length));
        let lengths: Vec<f64> = geometric.take_while(|length| *length <= longest).collect();
        // Computed here once, before all threads need it.
        self.sites.order();
        let mut tried = self.grid(Decay::Exponential, &lengths);
        let length = tried.iter().min_by(likelier)?.0.length;
        let spaced = [length / STEP, length, STEP * length];
        let around = spaced.map(|length| length.min(longest));
        tried.extend(self.grid(Decay::Smooth, &around));
        let best = *tried.iter().min_by(likelier)?;
        tried.extend(self.refined(best, STEP.sqrt(), longest));
        tried.sort_by(|a, b| likelier(&a, &b));
        Some(tried)
    }

    /// The scores of these lengths with all shares.
    fn grid(&self, decay: Decay, lengths: &[f64]) -> Vec<(Correlation, Score)> {
        let of = |length: &f64| {
            SHARES.map(|share| Correlation {
                decay,
                share,
                length: *length,
            })
        };
        let all: Vec<Correlation> = lengths.iter().flat_map(of).collect();
        all.into_par_iter()
            .filter_map(|one| self.tried(one))
            .collect()
    }

    fn tried(&self, correlation: Correlation) -> Option<(Correlation, Score)> {
        let whitening = Whitening::new(self.sites, &correlation);
        let white = WhiteRegression::new(self.design, self.residual, Some(&whitening));
        let score = white.score(self.held, self.slope)?;
        score.deviance.is_finite().then_some((correlation, score))
    }

    /// The scores of smaller steps in length and share about the best.
    fn refined(
        &self,
        mut best: (Correlation, Score),
        mut step: f64,
        longest: f64,
    ) -> Vec<(Correlation, Score)> {
        const ROUNDS: usize = 2;
        let mut tried = Vec::new();
        for _ in 0..ROUNDS {
            let at = best.0;
            let longer = |factor: f64| Correlation {
                length: (at.length * factor).min(longest),
                ..at
            };
            // Steps of the odds s/(1 − s).
            let more = |factor: f64| {
                let odds = factor.powi(3) * at.share / (1.0 - at.share);
                Correlation {
                    share: odds / (1.0 + odds),
                    ..at
                }
            };
            let around = [
                longer(step),
                longer(1.0 / step),
                more(step),
                more(1.0 / step),
            ];
            for near in around {
                let Some(actual) = self.tried(near) else {
                    continue;
                };
                if actual.1.deviance < best.1.deviance {
                    best = actual;
                }
                tried.push(actual);
            }
            step = step.sqrt();
        }
        tried
    }
}

fn likelier(a: &&(Correlation, Score), b: &&(Correlation, Score)) -> Ordering {
    a.1.deviance.total_cmp(&b.1.deviance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::normal_numbers;

    /// Noise of a correlation on a grid of 20 × 12 positions, with a fitted plane subtracted from each component.
    fn noise(correlation: Option<Correlation>, seed: u64) -> (Sites, DMatrix<f64>, DVector<f64>) {
        let positions = (0..20).flat_map(|i| (0..12).map(move |j| [f64::from(i), f64::from(j)]));
        let positions: Vec<[f64; 2]> = positions.collect();
        let count = positions.len();
        let root = DMatrix::from_fn(count, count, |i, j| {
            let [a, b] = [positions[i], positions[j]];
            let far = (a[0] - b[0]).hypot(a[1] - b[1]);
            match (i == j, correlation) {
                (true, _) => 1.0,
                (false, Some(one)) => one.at(far),
                (false, None) => 0.0,
            }
        });
        let root = root.cholesky().unwrap().unpack();
        let mut normal = normal_numbers(seed);
        let mut draw = || DVector::from_fn(count, |_, _| normal());
        let components = [&root * draw(), &root * draw()];
        let values = DVector::from_fn(2 * count, |row, _| components[row % 2][row / 2]);
        let design = DMatrix::from_fn(2 * count, 6, |row, column| {
            let [x, y] = positions[row / 2];
            if column / 3 == row % 2 {
                [1.0, x / 20.0, y / 12.0][column % 3]
            } else {
                0.0
            }
        });
        let fitted = (design.tr_mul(&design))
            .cholesky()
            .unwrap()
            .solve(&design.tr_mul(&values));
        let residual = &values - &design * fitted;
        (Sites::new(positions), design, residual)
    }

    fn likeliest(correlation: Option<Correlation>, seed: u64) -> CorrelatedNoise {
        let (sites, design, residual) = noise(correlation, seed);
        let regression = CorrelatedRegression {
            sites: &sites,
            design: &design,
            residual: &residual,
            held: &DMatrix::zeros(6, 6),
            slope: &DVector::zeros(6),
        };
        regression.plausible(1.0, 12.0)[0]
    }

    #[test]
    fn length_and_size_of_correlated_noise_are_found() {
        for length in [1.0, 3.0] {
            let truth = Correlation {
                decay: Decay::Exponential,
                share: 0.999,
                length,
            };
            let actual: Vec<_> = (0..6).map(|seed| likeliest(Some(truth), seed)).collect();
            let mean = |value: fn(&CorrelatedNoise) -> f64| {
                (actual.iter().map(|one| value(one).ln()).sum::<f64>() / 6.0).exp()
            };
            let (range, size) = (mean(|one| one.correlation.length), mean(|one| one.variance));
            assert!((range / length).ln().abs() < 0.4, "{length} {range}");
            assert!(size > 0.6 && size < 1.6, "{length} {size}");
            assert!(actual.iter().all(|one| one.evidence > 30.0), "{actual:?}");
        }
    }

    #[test]
    fn white_noise_is_white() {
        for seed in 0..12 {
            let actual = likeliest(None, seed);
            assert!(actual.evidence < 12.0, "{actual:?}");
            assert!((actual.variance - 1.0).abs() < 0.25, "{actual:?}");
        }
    }
}
