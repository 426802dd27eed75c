//! Arithmetic of plain vectors; all sums from the first entry to the last.

use crate::statistics::larger;

/// a · b.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Euclidean norm.
pub fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The largest magnitude; NaN where an entry is NaN.
pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| larger(most, x.abs()))
}

/// a − b.
pub fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// x + step · direction.
pub fn moved(x: &[f64], step: f64, direction: &[f64]) -> Vec<f64> {
    x.iter().zip(direction).map(|(x, d)| x + step * d).collect()
}

/// sum ← sum + factor · x.
#[inline]
pub fn add_scaled(sum: &mut [f64], factor: f64, x: &[f64]) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum += factor * x;
    }
}

/// x ← factor · x.
pub fn scale(x: &mut [f64], factor: f64) {
    x.iter_mut().for_each(|x| *x *= factor);
}

/// Chosen entries of a vector.
pub fn gather(positions: &[usize], x: &[f64]) -> Vec<f64> {
    positions.iter().map(|position| x[*position]).collect()
}

/// A vector of so many entries: the given ones at their positions, zero elsewhere.
pub fn spread(positions: &[usize], entries: &[f64], count: usize) -> Vec<f64> {
    let mut all = vec![0.0; count];
    for (position, entry) in positions.iter().zip(entries) {
        all[*position] = *entry;
    }
    all
}
