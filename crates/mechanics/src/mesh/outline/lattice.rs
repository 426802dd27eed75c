//! Points of a triangular lattice inside closed lines.

use std::collections::HashMap;

use super::polygon::Polygon;
use crate::mesh::geometry::{bounding_box, distance};

/// Lattice points are no nearer than so many sizes to a point of the lines.
const NEAR: f64 = 0.7;

/// The points of a lattice with edges of the length `size` between the first line and the others, away from the
/// points `on_lines` that the lines are divided by.
pub fn inside(lines: &[Polygon], on_lines: &[[f64; 2]], size: f64) -> Vec<[f64; 2]> {
    let square = |[x, y]: [f64; 2]| [(x / size).floor() as i64, (y / size).floor() as i64];
    let mut squares: HashMap<[i64; 2], Vec<[f64; 2]>> = HashMap::new();
    for point in on_lines {
        squares.entry(square(*point)).or_default().push(*point);
    }
    let near = |point: [f64; 2]| {
        let [i, j] = square(point);
        let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
        let mut points = around.filter_map(|key| squares.get(&key)).flatten();
        points.any(|p| distance(point, *p) < NEAR * size)
    };
    let [[left, low], [_, high]] = bounding_box(on_lines.iter().copied());
    // Whole rows between the lowest and the highest point.
    let rows = ((high - low) / (0.75f64.sqrt() * size)).round().max(1.0);
    let step = (high - low) / rows;
    let mut points = Vec::new();
    for row in 1..rows as i64 {
        let y = low + row as f64 * step;
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
        let mut crossings: Vec<f64> = lines.iter().flat_map(|line| line.crossings(y)).collect();
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let position = |i: i64| left + (i as f64 + shift) * size;
            let first = ((pair[0] - left) / size - shift).ceil() as i64;
            let last = ((pair[1] - left) / size - shift).floor() as i64;
            points.extend(
                (first..=last)
                    .map(|i| [position(i), y])
                    .filter(|point| !near(*point)),
            );
        }
    }
    points
}
