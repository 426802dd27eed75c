//! Conjugate gradients and Lanczos' method for symmetric sparse matrices.

use nalgebra::{DMatrix, SymmetricEigen};

use super::pattern::SymmetricPattern;
use super::vector::{add_scaled, dot, norm};

/// A vector without any symmetry, different for each seed: a start that has a part of every mode.
pub fn irregular(size: usize, seed: usize) -> Vec<f64> {
    let entry = |i: usize| ((i + 1) as f64 * (2.0 + seed as f64).sqrt()).sin();
    (0..size)
        .map(|i| entry(i) + 0.3 * (i as f64).sqrt().sin())
        .collect()
}

/// The largest magnitude of an eigenvalue of a symmetric operator by Lanczos' method: the largest Ritz value plus its error
/// bound, which is not below that of the eigenvalue; NaN where the operator is not finite, and zero where it has no rows.
///
/// # References
/// B. N. Parlett, The Symmetric Eigenvalue Problem, SIAM (1998), § 13.2, doi:10.1137/1.9781611971163
pub fn largest_eigenvalue(size: usize, apply: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
    const STEPS: usize = 24;
    let mut now = irregular(size, 0);
    let length = norm(&now);
    now.iter_mut().for_each(|x| *x /= length);
    let mut last = vec![0.0; size];
    let (mut diagonal, mut off_diagonal, mut beta) = (Vec::new(), Vec::new(), 0.0);
    for _ in 0..STEPS.min(size) {
        let mut next = apply(&now);
        add_scaled(&mut next, -beta, &last);
        let alpha = dot(&next, &now);
        add_scaled(&mut next, -alpha, &now);
        diagonal.push(alpha);
        beta = norm(&next);
        off_diagonal.push(beta);
        if beta <= 1e-12 * alpha.abs() {
            break;
        }
        next.iter_mut().for_each(|x| *x /= beta);
        last = std::mem::replace(&mut now, next);
    }
    let count = diagonal.len();
    if count == 0 {
        return 0.0;
    }
    let tridiagonal = DMatrix::from_fn(count, count, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => off_diagonal[i.min(j)],
        _ => 0.0,
    });
    if tridiagonal.iter().any(|entry| !entry.is_finite()) {
        return f64::NAN;
    }
    let eigen = SymmetricEigen::new(tridiagonal);
    let bounds = (0..count).map(|i| {
        eigen.eigenvalues[i].abs()
            + off_diagonal[count - 1] * eigen.eigenvectors[(count - 1, i)].abs()
    });
    bounds.fold(0.0, f64::max)
}

/// x of A x = b by conjugate gradients for a positive definite matrix, to 14 digits or as near as rounding allows; its diagonal is the
/// preconditioner.
pub fn solve_by_diagonal(pattern: &SymmetricPattern, values: &[f64], b: &[f64]) -> Vec<f64> {
    let precondition = |r: &[f64]| -> Vec<f64> {
        let diagonal = pattern.diagonal().iter().map(|position| values[*position]);
        r.iter().zip(diagonal).map(|(r, d)| r / d).collect()
    };
    let (mut x, mut r) = (vec![0.0; b.len()], b.to_vec());
    let mut z = precondition(&r);
    let mut direction = z.clone();
    let mut square = dot(&r, &z);
    let enough = 1e-28 * square;
    for _ in 0..2 * b.len() + 20 {
        if square <= enough || square.is_nan() {
            break;
        }
        let image = pattern.multiply(values, &direction);
        let length = square / dot(&direction, &image);
        add_scaled(&mut x, length, &direction);
        add_scaled(&mut r, -length, &image);
        z = precondition(&r);
        let next = dot(&r, &z);
        for (direction, z) in direction.iter_mut().zip(&z) {
            *direction = z + next / square * *direction;
        }
        square = next;
    }
    x
}
