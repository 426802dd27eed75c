//! Noise that correlates along curves: its whitening and its covariance, in as many steps as there are values.
//!
//! ```text
//! Corr(εᵢ, εⱼ) = s e^(−|xᵢ − xⱼ|/ℓ)  (i ≠ j, of one curve)        s: share of the noise that correlates
//! ```
//!
//! It is a process of first order observed with white noise, so that the Kalman filter predicts each value from all before it.
//!
//! # References
//! A. C. Harvey, Forecasting, Structural Time Series Models and the Kalman Filter (1989), doi:10.1017/CBO9781107049994

use nalgebra::{DMatrix, DVectorView};

use super::correlation::Correlation;

/// Rows of a regression that follow one another on one curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The rows in their order.
    pub rows: Vec<usize>,
    /// The distance from each row to the next, one less than there are rows; 1 in the mean.
    pub gaps: Vec<f64>,
}

impl Curve {
    /// Rows at equal distances.
    pub fn even(rows: Vec<usize>) -> Self {
        let gaps = vec![1.0; rows.len().saturating_sub(1)];
        Self { rows, gaps }
    }

    /// Rows in the order of their positions.
    pub fn by_position(mut positions: Vec<(usize, f64)>) -> Self {
        positions.sort_by(|a, b| a.1.total_cmp(&b.1));
        let distances = positions.windows(2).map(|pair| pair[1].1 - pair[0].1);
        let gaps: Vec<f64> = distances.collect();
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        let mean = if mean > 0.0 { mean } else { 1.0 };
        Self {
            rows: positions.into_iter().map(|(row, _)| row).collect(),
            gaps: gaps.into_iter().map(|gap| gap / mean).collect(),
        }
    }
}

/// Noise along curves.
#[derive(Clone, Copy)]
pub struct NoiseAlong<'a> {
    /// The curves, whose noises are independent.
    pub curves: &'a [Curve],
    /// The correlation of the noise of each; exponential.
    pub correlation: Correlation,
}

/// A step of the Kalman filter at a row: the decay of the state, the gain, and the variance of the innovation.
struct Step {
    row: usize,
    /// e^(−gap/ℓ) from the row before; 0 at the beginning of a curve.
    decay: f64,
    gain: f64,
    variance: f64,
}

impl NoiseAlong<'_> {
    fn decay(&self, gap: f64) -> f64 {
        (-gap / self.correlation.length).exp()
    }

    fn steps(&self) -> Vec<Step> {
        let share = self.correlation.share;
        let mut steps = Vec::new();
        for curve in self.curves {
            let mut known = share;
            for (index, row) in curve.rows.iter().enumerate() {
                let decay = match index {
                    0 => 0.0,
                    _ => self.decay(curve.gaps[index - 1]),
                };
                known = share + decay * decay * (known - share);
                let variance = known + 1.0 - share;
                let gain = known / variance;
                known *= 1.0 - gain;
                steps.push(Step {
                    row: *row,
                    decay,
                    gain,
                    variance,
                });
            }
        }
        steps
    }

    /// U A with UᵀU = R⁻¹, and ln det R.
    pub fn whitened(&self, columns: &DMatrix<f64>) -> (DMatrix<f64>, f64) {
        let steps = self.steps();
        let mut white = DMatrix::zeros(columns.nrows(), columns.ncols());
        for (values, mut white) in columns.column_iter().zip(white.column_iter_mut()) {
            let mut state = 0.0;
            for step in &steps {
                let predicted = step.decay * state;
                let new = values[step.row] - predicted;
                state = predicted + step.gain * new;
                white[step.row] = new / step.variance.sqrt();
            }
        }
        (white, steps.iter().map(|step| step.variance.ln()).sum())
    }

    /// R A.
    pub fn product(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut product = columns * (1.0 - self.correlation.share);
        for (values, mut product) in columns.column_iter().zip(product.column_iter_mut()) {
            for curve in self.curves {
                let sums = self.weighted_sums(curve, values);
                for (row, sum) in curve.rows.iter().zip(sums) {
                    product[*row] += self.correlation.share * sum;
                }
            }
        }
        product
    }

    /// Σⱼ e^(−|xᵢ − xⱼ|/ℓ) vⱼ at every row of a curve, in one pass forward and one backward.
    fn weighted_sums(&self, curve: &Curve, values: DVectorView<f64>) -> Vec<f64> {
        let mut sums: Vec<f64> = curve.rows.iter().map(|row| values[*row]).collect();
        let mut before = 0.0;
        for index in 1..sums.len() {
            let value = values[curve.rows[index - 1]];
            before = self.decay(curve.gaps[index - 1]) * (before + value);
            sums[index] += before;
        }
        let mut after = 0.0;
        for index in (1..sums.len()).rev() {
            let value = values[curve.rows[index]];
            after = self.decay(curve.gaps[index - 1]) * (after + value);
            sums[index - 1] += after;
        }
        sums
    }

    /// The number of independent values with the same information on a variance: n²/Σ ρᵢⱼ².
    pub fn independent(&self) -> f64 {
        let squared = NoiseAlong {
            curves: self.curves,
            correlation: Correlation {
                share: self.correlation.share.powi(2),
                length: 0.5 * self.correlation.length,
                ..self.correlation
            },
        };
        let count: usize = self.curves.iter().map(|curve| curve.rows.len()).sum();
        let squares: f64 = squared.product(&DMatrix::from_element(count, 1, 1.0)).sum();
        (count * count) as f64 / squares
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Decay;

    const NOISE: Correlation = Correlation {
        decay: Decay::Exponential,
        share: 0.7,
        length: 2.5,
    };

    /// Two curves of uneven spacing whose rows are mixed.
    fn curves() -> Vec<Curve> {
        let first = [(0, 0.0), (3, 0.3), (2, 1.7), (6, 2.0), (1, 4.0)];
        let second = [(5, 0.0), (4, 1.0), (7, 1.0)];
        [first.to_vec(), second.to_vec()]
            .map(Curve::by_position)
            .to_vec()
    }

    fn exact(curves: &[Curve]) -> DMatrix<f64> {
        let mut matrix = DMatrix::identity(8, 8);
        for curve in curves {
            for (i, a) in curve.rows.iter().enumerate() {
                for (j, b) in curve.rows.iter().enumerate().skip(i + 1) {
                    let distance = curve.gaps[i..j].iter().sum();
                    matrix[(*a, *b)] = NOISE.at(distance);
                    matrix[(*b, *a)] = matrix[(*a, *b)];
                }
            }
        }
        matrix
    }

    #[test]
    fn whitening_and_products_are_those_of_the_full_matrix() {
        let curves = curves();
        let exact = exact(&curves);
        let noise = NoiseAlong {
            curves: &curves,
            correlation: NOISE,
        };
        let columns = DMatrix::from_fn(8, 3, |i, j| ((1 + i) as f64 * (0.6 + j as f64)).sin());
        assert!((noise.product(&columns) - &exact * &columns).amax() < 1e-13);
        let (white, log) = noise.whitened(&columns);
        assert!((log - exact.determinant().ln()).abs() < 1e-12);
        let inverse = exact.clone().cholesky().unwrap().solve(&columns);
        assert!((white.tr_mul(&white) - columns.tr_mul(&inverse)).amax() < 1e-12);
        // Correlations are squared for pairs; a value with itself counts as 1.
        let squares = exact.norm_squared();
        assert!((noise.independent() - 64.0 / squares).abs() < 1e-12);
    }
}
