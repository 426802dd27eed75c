//! Points of the plane: boxes, areas, distances.

use crate::units::{SIZES, on_the_end};

/// Lower left and upper right corner of the box around points.
pub fn bounding_box(points: impl IntoIterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.into_iter().fold(start, |[low, high], [x, y]| {
        [
            [low[0].min(x), low[1].min(y)],
            [high[0].max(x), high[1].max(y)],
        ]
    })
}

/// Points whose size is not that of a specimen: length and width of the box around them in mm, and the largest coordinate.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "span {:.1e} × {:.1e} mm and reach to {reach:.1e} mm from the origin, but specimens must measure 1 nm to 1 km and lie within 1 km of the origin: check the unit",
    .span[0],
    .span[1]
)]
pub struct OutOfSize {
    /// Length and width of the box around the points in mm.
    pub span: [f64; 2],
    /// The largest coordinate in mm.
    pub reach: f64,
}

/// Checks that points have the size of a specimen.
///
/// # Errors
/// [`OutOfSize`] where they do not have it.
pub fn check_size(points: impl IntoIterator<Item = [f64; 2]>) -> Result<(), OutOfSize> {
    let [low, high] = bounding_box(points);
    let span = [high[0] - low[0], high[1] - low[1]];
    let reach = [low, high]
        .as_flattened()
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let [least, most] = SIZES;
    // NaN is out of size too.
    let sized =
        on_the_end(span[0].max(span[1]), SIZES) >= least && on_the_end(reach, SIZES) <= most;
    sized.then_some(()).ok_or(OutOfSize { span, reach })
}

/// The area inside a closed line of straight edges, positive where it runs counter-clockwise.
pub fn polygon_area(line: &[[f64; 2]]) -> f64 {
    let next = line.iter().cycle().skip(1);
    let twice = line
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - b[0] * a[1]);
    twice.sum::<f64>() / 2.0
}

/// The distance of two points.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// The determinant of a 2 × 2 matrix, by rows.
pub fn determinant(map: &[[f64; 2]; 2]) -> f64 {
    map[0][0] * map[1][1] - map[0][1] * map[1][0]
}
