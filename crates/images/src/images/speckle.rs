//! The size of the pattern, and of the subsets that it asks for.

use rayon::prelude::*;

use super::filter::{gaussian, symmetric};
use super::gradient::Reference;
use super::grid::Grid;
use super::subset::Subset;
use super::warp::Order;

/// Half the width of a subset that is five speckles wide, by the width at half height of the pattern's autocorrelation, and wide enough for
/// standard deviations of the displacement below a twentieth of a pixel at a quarter of the points, but at most an eighth of the image.
pub fn half_width(reference: &Reference, grid: &Grid, order: Order) -> usize {
    const SPECKLES: f64 = 5.0;
    const DEVIATION: f64 = 0.05;
    const LEAST: usize = 5;
    let size = reference.image.size();
    let most = (size[0].min(size[1]) / 8).max(LEAST);
    let start = (0.5 * SPECKLES * speckle(reference)).round() as usize;
    let deviation = |half| typical(grid, &|point| Subset::new(reference, point, half, order));
    let mut half = start.clamp(LEAST, most);
    while half < most && deviation(half) > DEVIATION {
        half = (half + 1 + half / 8).min(most);
    }
    half
}

/// The size and the positions of patches that share no pixel.
#[derive(Clone, Debug)]
pub struct PatchLayout {
    /// Width of a patch in pixels.
    pub width: usize,
    /// Width of a speckle in pixels.
    pub speckle: f64,
    /// The points of the grid at which there is a patch.
    pub points: Vec<usize>,
}

impl PatchLayout {
    /// Patches that are wide enough for the noise, on a grid of a spacing.
    pub fn new(reference: &Reference, grid: &Grid, spacing: usize) -> Self {
        let speckle = speckle(reference);
        let width = spacing * patch_steps(reference, grid, spacing, speckle);
        let first = [0, 1].map(|axis| grid.points.iter().map(|point| point[axis]).min());
        let is_on_lattice = |point: &[usize; 2]| {
            (0..2).all(|axis| (point[axis] - first[axis].unwrap_or(0)).is_multiple_of(width))
        };
        let numbers = 0..grid.points.len();
        Self {
            width,
            speckle,
            points: numbers
                .filter(|number| is_on_lattice(&grid.points[*number]))
                .collect(),
        }
    }
}

/// The width of patches that share no pixel in steps of the grid: three speckles, and wide enough that the noise moves a quarter of them by
/// less than an eighth of a speckle, for which the images are linear; at most an eighth of the image.
fn patch_steps(reference: &Reference, grid: &Grid, spacing: usize, speckle: f64) -> usize {
    const SPECKLES: f64 = 3.0;
    const LINEAR: f64 = 0.125;
    let size = reference.image.size();
    let most = (size[0].min(size[1]) / 8 / spacing).max(1);
    let mut steps = ((SPECKLES * speckle / spacing as f64).round() as usize).clamp(1, most);
    let deviation = |steps| {
        typical(grid, &|point| {
            Subset::patch(reference, point, steps * spacing)
        })
    };
    while steps < most && deviation(steps) > LINEAR * speckle {
        steps += 1;
    }
    steps
}

/// The standard deviation in pixels below which those of a quarter of the points are.
fn typical(grid: &Grid, subset: &(dyn Fn([usize; 2]) -> Option<Subset> + Sync)) -> f64 {
    const SAMPLE: usize = 200;
    let every = (grid.points.len() / SAMPLE).max(1);
    let sample: Vec<[usize; 2]> = grid.points.iter().step_by(every).copied().collect();
    let deviation = |point: &[usize; 2]| {
        subset(*point).map_or(f64::INFINITY, |subset| subset.expected_deviation())
    };
    let mut deviations: Vec<f64> = sample.par_iter().map(deviation).collect();
    deviations.sort_by(f64::total_cmp);
    deviations
        .get(deviations.len() / 4)
        .copied()
        .unwrap_or(f64::INFINITY)
}

/// The width at half height of the autocorrelation of the pattern, the mean of both directions, in pixels; light and dark areas that
/// are much larger than a speckle do not count.
fn speckle(reference: &Reference) -> f64 {
    const MOST: usize = 40;
    /// Standard deviation in pixels of what counts as an area.
    const AREA: f64 = 16.0;
    let [width, height] = reference.image.size();
    let lags = MOST.min(width.min(height) / 2);
    let areas = symmetric(&reference.image, &gaussian(AREA));
    let pairs = reference.image.values().iter().zip(areas.values());
    let values: Vec<f32> = pairs.map(|(value, area)| value - area).collect();
    let mean = areas
        .values()
        .iter()
        .map(|area| f64::from(*area))
        .sum::<f64>()
        / values.len() as f64;
    let width_along = |step: usize| {
        let mut covariances: Vec<f64> = (0..lags)
            .map(|lag| covariance(&values, &reference.usable, lag * step))
            .collect();
        covariances[0] -= reference.noise.variance(mean);
        width_at_half_height(&covariances)
    };
    0.5 * (width_along(1) + width_along(width))
}

/// The covariance of the usable values with those that stand `shift` behind them.
fn covariance(values: &[f32], usable: &[bool], shift: usize) -> f64 {
    let (mut sum, mut count, mut sums) = (0.0, 0.0, [0.0; 2]);
    for at in 0..values.len().saturating_sub(shift) {
        if usable[at] && usable[at + shift] {
            let pair = [values[at], values[at + shift]].map(f64::from);
            (sum, count) = (sum + pair[0] * pair[1], count + 1.0);
            sums = [sums[0] + pair[0], sums[1] + pair[1]];
        }
    }
    sum / count - sums[0] * sums[1] / (count * count)
}

/// The width at half height of a function that is even, from its values at 0, 1, 2 …
fn width_at_half_height(values: &[f64]) -> f64 {
    let level = 0.5 * values[0];
    let below = values
        .iter()
        .position(|value| *value < level)
        .unwrap_or(values.len() - 1)
        .max(1);
    let (high, low) = (values[below - 1], values[below]);
    let part = if high > low {
        ((high - level) / (high - low)).clamp(0.0, 1.0)
    } else {
        1.0
    };
    2.0 * ((below - 1) as f64 + part)
}
