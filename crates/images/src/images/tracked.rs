//! A point in one image after another, and tracked points as markers in mm.

use nalgebra::Matrix2;

use super::grid::Grid;
use super::subset::Match;
use super::warp::Warp;
use crate::markers::{Frame, Marker, MarkerSeries};

/// A point of the first image in a later one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// Its position in the first image in pixels.
    pub position: [f64; 2],
    /// Its displacement in pixels.
    pub displacement: [f64; 2],
    /// ∂u/∂X.
    pub gradient: Matrix2<f64>,
    /// The covariance of the displacement in pixels².
    pub covariance: Matrix2<f64>,
    /// The part of the pattern's variance that is found again.
    pub similarity: f64,
}

impl Tracked {
    /// The displacement about the point.
    pub fn warp(&self) -> Warp {
        Warp::affine(self.displacement, self.gradient)
    }
}

/// A point of the first image that is matched in a later one, directly or over the images between them.
impl Match {
    /// The point's position in the later image.
    pub fn position(&self, point: [usize; 2]) -> [f64; 2] {
        let [u, v] = self.warp.displacement();
        [point[0] as f64 + u, point[1] as f64 + v]
    }

    /// The step from the point's match in an earlier image to this one, as if it had been matched itself.
    pub fn since(&self, then: &Self) -> Option<Self> {
        let inverse = then.warp.deformation_gradient().try_inverse()?;
        let ([a, b], [c, d]) = (self.warp.displacement(), then.warp.displacement());
        let gradient = self.warp.deformation_gradient() * inverse - Matrix2::identity();
        Some(Self {
            warp: Warp::affine([a - c, b - d], gradient),
            covariance: Matrix2::zeros(),
            ..*self
        })
    }

    /// This match followed by a step to the next image, which was matched about the pixel `centre` near the point's position. The
    /// covariances of both add up.
    pub fn followed_by(&self, step: &Self, point: [usize; 2], centre: [usize; 2]) -> Self {
        let [x, y] = self.position(point);
        let [u, v] = step.warp.at(x - centre[0] as f64, y - centre[1] as f64, 6);
        let f = step.warp.deformation_gradient() * self.warp.deformation_gradient();
        Self {
            warp: Warp::affine(
                [x + u - point[0] as f64, y + v - point[1] as f64],
                f - Matrix2::identity(),
            ),
            covariance: self.covariance + step.covariance,
            ..*step
        }
    }

    /// The match as results give it: position, displacement, gradient, covariance and similarity of the point.
    pub fn tracked(&self, point: [usize; 2]) -> Tracked {
        Tracked {
            position: point.map(|x| x as f64),
            displacement: self.warp.displacement(),
            gradient: self.warp.gradient(),
            covariance: self.covariance,
            similarity: self.similarity,
        }
    }
}

/// The frames of tracked points as markers: in mm by the length of a pixel, x to the right, y up, with the origin at the centre of the lower left
/// pixel of images of `height` rows. Each frame has its number. A marker's standard deviation is √(½ tr Cov(u)).
pub fn series(frames: &[(usize, Vec<Option<Tracked>>)], height: usize, pixel: f64) -> MarkerSeries {
    let up = (height - 1) as f64;
    let marker = |(number, tracked): (usize, &Option<Tracked>)| {
        let tracked = tracked.as_ref()?;
        let ([x, y], [u, v]) = (tracked.position, tracked.displacement);
        Some(Marker {
            number,
            position: [x * pixel, (up - y) * pixel],
            displacement: [u * pixel, -v * pixel],
            standard_deviation: Some((0.5 * tracked.covariance.trace()).sqrt() * pixel),
        })
    };
    MarkerSeries {
        frames: frames
            .iter()
            .map(|(number, all)| Frame {
                number: *number,
                time: None,
                markers: all.iter().enumerate().filter_map(marker).collect(),
            })
            .collect(),
        ..MarkerSeries::default()
    }
}

/// Adds the error of affine subsets where the strain varies: the displacement of a fit is the mean over the subset, which differs from that of
/// its middle by the curvature,
///
/// ```text
/// b = −(w²/6) ∇²u                w: half of the subset's width; second derivatives from the gradients of neighbouring points
/// ```
///
/// b bᵀ, times the part of |b|² that is not noise, is added to the covariance of each point that has a neighbour along both axes.
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
