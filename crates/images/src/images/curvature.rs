//! The error of affine subsets where the strain varies.
//!
//! ```text
//! b = −(w²/6) ∇²u                w: half of the subset's width; second derivatives from the gradients of neighbouring points
//! ```
//!
//! The displacement of an affine fit is the mean over the subset, which differs from that of its middle by the curvature.

use nalgebra::Matrix2;

use super::grid::Grid;
use super::tracked::Tracked;

/// Adds b bᵀ, times the part of |b|² that is not noise, to the covariance of each point that has a neighbour along both axes.
pub fn add_curvature(grid: &Grid, spacing: usize, half: usize, tracked: &mut [Option<Tracked>]) {
    let square = (half * half) as f64 / 6.0;
    let biases: Vec<Option<[f64; 2]>> = (0..tracked.len())
        .map(|point| Some(laplacian(grid, spacing, point, tracked)?.map(|sum| square * sum)))
        .collect();
    for (one, bias) in tracked.iter_mut().zip(biases) {
        if let (Some(one), Some([x, y])) = (one, bias) {
            // A bias below the noise is mostly that of the gradients.
            let noise = one.covariance.trace();
            let share = (x * x + y * y) / (x * x + y * y + noise).max(f64::MIN_POSITIVE);
            one.covariance += share * Matrix2::new(x * x, x * y, x * y, y * y);
        }
    }
}

/// ∇²ux, ∇²uy at a point in 1/pixels.
fn laplacian(
    grid: &Grid,
    spacing: usize,
    point: usize,
    tracked: &[Option<Tracked>],
) -> Option<[f64; 2]> {
    let [x, y] = grid.points[point];
    let gradient_at = |dx: isize, dy: isize| {
        let position = [x as isize + dx, y as isize + dy];
        let mut others = grid.neighbours[point].iter();
        let other = others.find(|other| grid.points[**other].map(|at| at as isize) == position)?;
        tracked[*other].map(|one| one.gradient)
    };
    let gradient = tracked[point]?.gradient;
    // Where a neighbour is not followed, the difference is to the point itself.
    let slope = |dx: isize, dy: isize| {
        let (before, after) = (gradient_at(-dx, -dy), gradient_at(dx, dy));
        let steps = before.iter().chain(&after).count();
        let change = after.unwrap_or(gradient) - before.unwrap_or(gradient);
        (steps > 0).then(|| change / (steps * spacing) as f64)
    };
    let step = spacing as isize;
    let (along, across) = (slope(step, 0)?, slope(0, step)?);
    Some([0, 1].map(|axis| along[(axis, 0)] + across[(axis, 1)]))
}
