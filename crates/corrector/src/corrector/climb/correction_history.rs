//! The decrease of an iteration's corrections, and the error that the last one leaves.
//!
//! The iteration ends with the correction z = M⁻¹ r, where M⁻¹ is one V-cycle: an error e, K e = r, becomes
//! (1 − M⁻¹ K) e. In the direction of the smallest eigenvalue θ of M⁻¹ K, which a cycle reaches least, |z| = θ |e|, so that
//!
//! ```text
//! |e − z| = (1/θ − 1) |z|
//! ```
//!
//! Conjugate gradients reveal θ as they go, through Lanczos' matrix of their step lengths α and shares β:
//!
//! ```text
//! T = tridiagonal:   Tⱼⱼ = 1/αⱼ + βⱼ₋₁/αⱼ₋₁,   Tⱼ,ⱼ₊₁ = √βⱼ/αⱼ
//! ```
//!
//! and corrections that each fall by a factor ρ leave ρ/(1 − ρ) of the last one: the larger one counts, with a margin
//! for what few iterations do not show. Because one sheet under one stretch has much the same θ on all grids, the
//! smallest one of the coarser grids, which take more iterations, counts too.
//!
//! # References
//! Y. Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., SIAM (2003), § 6.7.3, doi:10.1137/1.9780898718003

use nalgebra::DMatrix;

/// Smallest error after a correction, as a share of it: half or a little more was measured where corrections fall fast.
const SMALLEST_REMAINDER: f64 = 0.6;
/// Margin for few iterations, in which the corrections fall faster than the error: the largest ratio on the plates measured.
const MARGIN: f64 = 1.5;
/// The slowest fall of corrections and the smallest eigenvalue that are accepted.
const SLOWEST: f64 = 0.95;
const SMALLEST: f64 = 1.0 - SLOWEST;

/// Corrections of an iteration, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrectionHistory {
    /// Root mean squares over the nodes in mm.
    pub corrections: Vec<f64>,
    /// θ, as far as known.
    pub weakest: f64,
    diagonal: Vec<f64>,
    off_diagonal: Vec<f64>,
    /// βⱼ/αⱼ of the last iteration.
    carried: f64,
}

impl CorrectionHistory {
    /// Begins with a first correction; `weakest` is θ of coarser grids, 1 where there are none.
    pub fn new(first: f64, weakest: f64) -> Self {
        Self {
            corrections: vec![first],
            weakest,
            diagonal: Vec::new(),
            off_diagonal: Vec::new(),
            carried: 0.0,
        }
    }

    /// Adds the correction after a step of length α along a direction with a share β of the one before it; `share` is that of the next direction.
    pub fn push(&mut self, correction: f64, length: f64, share: f64) {
        self.corrections.push(correction);
        if !(length > 0.0 && share >= 0.0) {
            return;
        }
        self.diagonal.push(1.0 / length + self.carried);
        self.off_diagonal.push(share.sqrt() / length);
        self.carried = share / length;
        let smallest = smallest_eigenvalue(&self.diagonal, &self.off_diagonal);
        self.weakest = self.weakest.min(smallest.max(SMALLEST));
    }

    /// The first correction.
    pub fn first(&self) -> f64 {
        self.corrections[0]
    }

    /// The error that the last correction leaves once it has been applied.
    pub fn remaining_error(&self) -> f64 {
        let last = self.corrections[self.corrections.len() - 1];
        let rate = self.rate().max(1.0 - self.weakest);
        last * (MARGIN * rate / (1.0 - rate)).max(SMALLEST_REMAINDER)
    }

    /// The factor by which the corrections fall: on average or in the last step, whichever is slower.
    fn rate(&self) -> f64 {
        let [.., before, last] = self.corrections[..] else {
            return 0.0;
        };
        let steps = (self.corrections.len() - 1) as f64;
        let mean_ratio = (last / self.first()).powf(1.0 / steps);
        mean_ratio.max(last / before).min(SLOWEST)
    }

    /// θ for an iteration that continues this one: from Lanczos' matrix, or from the fall of the corrections.
    pub fn slowest(&self) -> f64 {
        self.weakest.min(1.0 - self.rate())
    }

    /// This iteration and its continuation as one.
    pub fn followed_by(mut self, mut more: Self) -> Self {
        self.corrections.append(&mut more.corrections);
        Self {
            corrections: self.corrections,
            weakest: self.weakest.min(more.weakest),
            ..more
        }
    }
}

/// The smallest eigenvalue of a symmetric tridiagonal matrix.
fn smallest_eigenvalue(diagonal: &[f64], off_diagonal: &[f64]) -> f64 {
    let entry = |row: usize, column: usize| match row.abs_diff(column) {
        0 => diagonal[row],
        1 => off_diagonal[row.min(column)],
        _ => 0.0,
    };
    let size = diagonal.len();
    DMatrix::from_fn(size, size, entry)
        .symmetric_eigenvalues()
        .min()
}
