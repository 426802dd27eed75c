//! Corners of closed lines, by their turn over a part of the line instead of in a point: steps of one cell are no corners, and rounded
//! corners are.

use crate::mesh::geometry::{self, distance, polygon_area};

/// Turn of a line, in rad, from which on a point is a corner: 40°.
pub const CORNER: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Share of the line's length before and behind a point over which its turn is measured, but no more than half its width.
const REACH: f64 = 0.02;

/// Whether a closed line has a corner at each of its points.
pub fn corners(line: &[[f64; 2]]) -> Vec<bool> {
    let count = line.len();
    let point = |number: usize| line[number % count];
    let length: f64 = (0..count).map(|i| distance(point(i), point(i + 1))).sum();
    let reach = (REACH * length).min(polygon_area(line).abs() / length);
    let turns: Vec<f64> = (0..count).map(|index| turn(line, index, reach)).collect();
    let is_sharpest = |index: usize| {
        let near = |other: &usize| *other != index && distance(line[*other], line[index]) < reach;
        let mut others = (0..count).filter(near);
        // The first of several equal ones.
        others.all(|other| (turns[other], index) < (turns[index], other))
    };
    (0..count)
        .map(|index| turns[index] > CORNER && is_sharpest(index))
        .collect()
}

/// By how much a line turns between the nearest points at the reach or farther away on both sides of one of its points.
fn turn(line: &[[f64; 2]], index: usize, reach: f64) -> f64 {
    let count = line.len();
    let at = line[index];
    let away = |step: usize| {
        let far = (1..count).map(|steps| line[(index + steps * step) % count]);
        let mut far = far.skip_while(|point| distance(*point, at) < reach);
        far.next().unwrap_or(line[(index + step) % count])
    };
    let (from, to) = (away(count - 1), away(1));
    let (a, b) = (
        [at[0] - from[0], at[1] - from[1]],
        [to[0] - at[0], to[1] - at[1]],
    );
    geometry::turn(a, b).abs()
}
