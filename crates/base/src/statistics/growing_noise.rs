//! Noise of curves that has one size in all rows, or a size that grows in proportion to another quantity.
//!
//! ```text
//! sᵢ² = (1 − t) + t oᵢ²                                    o: the other size, Σ oᵢ²/n = 1
//! dᵢ = (2 rᵢ − rᵢ₋₁ − rᵢ₊₁)/√6,   Var dᵢ = v (4 sᵢ² + sᵢ₋₁² + sᵢ₊₁²)/6,   v of each curve by itself
//! ```
//!
//! The share t is the likeliest one by the differences d of neighbours: a smooth misfit contributes little to them, however large it is.

use nalgebra::DVector;

/// Shares of the other size that are tried.
const SHARES: [f64; 11] = [
    0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 0.9, 0.97, 0.99, 0.997, 0.999,
];

/// 2 ln of a likelihood ratio that one parameter exceeds by chance in one of a thousand cases.
const SIGNIFICANT: f64 = 10.8;

/// Neighbouring differences share values, so that this many of them are worth one independent one: 1 + 2 Σ ρ².
const OVERLAP: f64 = 1.94;

/// The sizes of the noise of rows; `None` where they may all be the same. Curves are given by their rows in order.
pub fn sizes(
    curves: &[Vec<usize>],
    residual: &DVector<f64>,
    other: &DVector<f64>,
) -> Option<DVector<f64>> {
    let scale = other.norm_squared() / other.len() as f64;
    let squares = other.map(|size| size * size / scale);
    let of_share = |share: f64| squares.map(|square| 1.0 - share + share * square);
    let even = likelihood(curves, residual, &of_share(0.0));
    let tried = SHARES.map(|share| (likelihood(curves, residual, &of_share(share)), share));
    let (best, share) = tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_significant = 2.0 * (best - even) / OVERLAP > SIGNIFICANT;
    is_significant.then(|| of_share(share).map(f64::sqrt))
}

/// ln of the likelihood of the differences of neighbours.
fn likelihood(curves: &[Vec<usize>], residual: &DVector<f64>, squares: &DVector<f64>) -> f64 {
    const FEWEST: usize = 3;
    let of_curve = |rows: &Vec<usize>| {
        let terms = rows.windows(3).map(|near| {
            let [before, at, after] = [0, 1, 2].map(|position| near[position]);
            let variance = (4.0 * squares[at] + squares[before] + squares[after]) / 6.0;
            let difference = 2.0 * residual[at] - residual[before] - residual[after];
            (variance.ln(), difference.powi(2) / 6.0 / variance)
        });
        let (logarithms, ratios): (Vec<f64>, Vec<f64>) = terms.unzip();
        let count = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / count;
        if ratios.len() < FEWEST || mean == 0.0 {
            0.0
        } else {
            -0.5 * (logarithms.iter().sum::<f64>() + count * mean.ln())
        }
    };
    curves.iter().map(of_curve).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::normal_numbers;

    /// The sizes that are found of noise on a wave six times as large, with a correlation of neighbours and a relative rise of its size.
    fn sizes_of(correlation: f64, rise: f64, seed: u64) -> Option<DVector<f64>> {
        const ROWS: usize = 80;
        let mut normal = normal_numbers(seed);
        let stress = DVector::from_fn(ROWS, |i, _| (1 + i) as f64);
        let mut last = 0.0;
        let residual = DVector::from_fn(ROWS, |i, _| {
            last = correlation * last + (1.0 - correlation * correlation).sqrt() * normal();
            (1.0 + rise * i as f64 / ROWS as f64) * last + 6.0 * (0.05 * i as f64).sin()
        });
        sizes(&[(0..ROWS).collect()], &residual, &stress)
    }

    #[test]
    fn noise_that_grows_is_found_on_a_wave_and_even_noise_stays_even() {
        let count = |correlation, rise| {
            let seeds = 0..100;
            let seeds = seeds.filter(|seed| sizes_of(correlation, rise, *seed).is_some());
            seeds.count()
        };
        assert!(count(0.0, 0.0) <= 1 && count(0.9, 0.0) <= 1);
        assert!(count(0.0, 9.0) >= 70, "{}", count(0.0, 9.0));
        let estimate = sizes_of(0.0, 9.0, 1).unwrap();
        assert!((estimate.norm_squared() / 80.0 - 1.0).abs() < 1e-12);
        assert!(estimate[79] / estimate[0] > 3.0, "{estimate}");
    }
}
