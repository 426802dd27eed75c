//! Whether a fit's residuals along curves are white noise: Durbin and Watson's test.
//!
//! ```text
//! d = Σ (rᵢ₊₁ − rᵢ)²/Σ rᵢ²     neighbours of one curve          2: white, 0: all equal, 4: alternating
//! d/4 ~ Beta with   E[d] = tr(M A)/ν,   Var[d] = 2 (tr(M A M A) − E[d]² ν)/(ν (ν + 2)),   M = 1 − J (JᵀJ)⁻¹Jᵀ
//! ```
//!
//! # References
//! J. Durbin, G. S. Watson, Biometrika 37, 409 (1950) and 38, 159 (1951), doi:10.1093/biomet/38.1-2.159

use nalgebra::{DMatrix, DVector};

use super::beta_cumulated;
use super::curve::Curve;

/// Durbin and Watson's statistic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DurbinWatson {
    /// d in 0…4.
    pub statistic: f64,
    /// The probability of so small a d for white normal noise.
    pub probability: f64,
}

impl DurbinWatson {
    /// The statistic of the residuals of a least-squares fit; `None` where there are no neighbours or no degrees of freedom.
    pub fn new(design: &DMatrix<f64>, residual: &DVector<f64>, curves: &[Curve]) -> Option<Self> {
        let freedom = design.nrows().checked_sub(design.ncols())?;
        let pairs = || curves.iter().flat_map(|curve| curve.rows.windows(2));
        let [squares, products] = sums(curves);
        if freedom < 2 || squares == 0.0 {
            return None;
        }
        let columns = design.clone().qr().q();
        let differences: f64 = pairs()
            .map(|p| (residual[p[1]] - residual[p[0]]).powi(2))
            .sum();
        let statistic = differences / residual.norm_squared().max(f64::MIN_POSITIVE);
        let applied = second_differences(curves, &columns);
        let inner = columns.tr_mul(&applied);
        let freedom = freedom as f64;
        let first = squares - inner.trace();
        let second = products - 2.0 * applied.norm_squared() + inner.norm_squared();
        let mean = first / freedom;
        let variance = 2.0 * (second - mean * first) / (freedom * (freedom + 2.0));
        let sum = mean * (4.0 - mean) / variance - 1.0;
        let shapes = [mean, 4.0 - mean].map(|part| 0.25 * sum * part);
        Some(Self {
            statistic,
            probability: beta_cumulated(shapes, 0.25 * statistic),
        })
    }
}

/// tr A and tr A².
fn sums(curves: &[Curve]) -> [f64; 2] {
    let counts = curves.iter().map(|curve| curve.rows.len() as f64);
    let long = counts.filter(|count| *count >= 2.0);
    long.fold([0.0; 2], |[first, second], count| {
        [first + 2.0 * (count - 1.0), second + 6.0 * count - 8.0]
    })
}

/// A Q: aᵀ A a is the sum of the squares of differences of neighbours.
fn second_differences(curves: &[Curve], columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut applied = DMatrix::zeros(columns.nrows(), columns.ncols());
    for pair in curves.iter().flat_map(|curve| curve.rows.windows(2)) {
        for column in 0..columns.ncols() {
            let difference = columns[(pair[1], column)] - columns[(pair[0], column)];
            applied[(pair[1], column)] += difference;
            applied[(pair[0], column)] -= difference;
        }
    }
    applied
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::normal_numbers;

    /// Straight lines through two curves: what is left of white noise has probabilities that are spread evenly.
    #[test]
    fn white_noise_has_every_probability_alike() {
        let curves = [(0..12).collect(), (12..30).collect()].map(Curve::even);
        let design = DMatrix::from_fn(30, 2, |i, j| (0.1 * i as f64).powi(j as i32));
        let solver = design.clone().svd(true, true);
        let mut normal = normal_numbers(2);
        let mut tails = [0; 3];
        const DRAWS: i32 = 2000;
        for _ in 0..DRAWS {
            let noise = DVector::from_fn(30, |_, _| normal());
            let residual = &noise - &design * solver.solve(&noise, 1e-12).unwrap();
            let result = DurbinWatson::new(&design, &residual, &curves).unwrap();
            for (count, level) in tails.iter_mut().zip([0.05, 0.5, 0.95]) {
                *count += i32::from(result.probability < level);
            }
        }
        for (count, level) in tails.into_iter().zip([0.05, 0.5, 0.95]) {
            let share = f64::from(count) / f64::from(DRAWS);
            assert!((share - level).abs() < 0.02, "{level}: {share}");
        }
    }

    /// Durbin and Watson's lower bounds for 15 points and a line: d below 0.95 is met in less than 2.5 % of cases.
    #[test]
    fn residuals_that_change_slowly_are_not_white() {
        let design = DMatrix::from_fn(15, 2, |i, j| (i as f64).powi(j as i32));
        let wave = DVector::from_fn(15, |i, _| (0.5 * i as f64).sin());
        let solver = design.clone().svd(true, true);
        let residual = &wave - &design * solver.solve(&wave, 1e-12).unwrap();
        let curve = [Curve::even((0..15).collect())];
        let result = DurbinWatson::new(&design, &residual, &curve).unwrap();
        assert!(
            result.statistic < 0.5 && result.probability < 1e-4,
            "{result:?}"
        );
        let zigzag = DVector::from_fn(15, |i, _| [1.0, -1.0][i % 2]);
        let result = DurbinWatson::new(&design, &zigzag, &curve).unwrap();
        assert!(
            result.statistic > 3.5 && result.probability > 0.999,
            "{result:?}"
        );
    }
}
