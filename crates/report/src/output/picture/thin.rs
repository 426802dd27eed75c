//! Curves and clouds of more points than a picture can show.

use crate::mesh::geometry::bounding_box;

/// A point by its positions on both axes.
type Point = (f64, f64);

/// Up to so many points are drawn as they are.
const MANY: usize = 5_000;

/// Columns and rows of a chart within which points are distinguished: about one for each point of the design.
const COLUMNS: f64 = 500.0;
const ROWS: f64 = 300.0;

/// The most points of a connected line, whatever its course.
const MOST: usize = 40_000;

/// Where points lie on a raster of columns and rows.
struct Raster {
    low: [f64; 2],
    step: [f64; 2],
}

impl Raster {
    fn of(points: &[Point]) -> Self {
        let [low, high] = bounding_box(points.iter().map(|(x, y)| [*x, *y]));
        Self {
            low,
            step: [(high[0] - low[0]) / COLUMNS, (high[1] - low[1]) / ROWS],
        }
    }

    fn column(&self, x: f64) -> usize {
        Self::position(x - self.low[0], self.step[0])
    }

    fn row(&self, y: f64) -> usize {
        Self::position(y - self.low[1], self.step[1])
    }

    /// All points that are at one place on an axis are in its first division.
    fn position(from_start: f64, step: f64) -> usize {
        if step > 0.0 {
            (from_start / step) as usize
        } else {
            0
        }
    }
}

/// One point for each division of the chart that has any.
pub fn scattered(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= MANY {
        return points;
    }
    let raster = Raster::of(&points);
    let (columns, rows) = (COLUMNS as usize + 1, ROWS as usize + 1);
    let mut taken = vec![false; columns * rows];
    let first = |(x, y): &Point| {
        let position = raster.row(*y) * columns + raster.column(*x);
        !std::mem::replace(&mut taken[position], true)
    };
    points.into_iter().filter(first).collect()
}

/// Of every stretch of a line within one column the first, the lowest, the highest and the last point.
pub fn connected(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= MANY {
        return points;
    }
    let raster = Raster::of(&points);
    let stretches = points.chunk_by(|a, b| raster.column(a.0) == raster.column(b.0));
    let thinned: Vec<Point> = stretches.flat_map(ends_and_extremes).collect();
    let every = thinned.len().div_ceil(MOST);
    thinned.into_iter().step_by(every).collect()
}

fn ends_and_extremes(stretch: &[Point]) -> Vec<Point> {
    let indices = 0..stretch.len();
    let by_height = |a: &usize, b: &usize| stretch[*a].1.total_cmp(&stretch[*b].1);
    let lowest = indices.clone().min_by(by_height).unwrap_or(0);
    let highest = indices.max_by(by_height).unwrap_or(0);
    let mut kept = vec![0, lowest, highest, stretch.len() - 1];
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|index| stretch[index]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_ends_and_peaks() {
        let mut points: Vec<Point> = (0..1_000_000)
            .map(|i| (f64::from(i), (f64::from(i) * 1e-3).sin()))
            .collect();
        points[123_456].1 = 9.0;
        let thinned = connected(points.clone());
        assert!(thinned.len() <= 4 * 501, "{}", thinned.len());
        assert!(thinned.contains(&points[123_456]));
        assert_eq!(thinned[0], points[0]);
        assert_eq!(thinned.last(), points.last());
        // Back and forth over all columns: still bounded.
        let wild = (0..1_000_000).map(|i| (f64::from(i % 1000 * 7919 % 1000), f64::from(i)));
        assert!(connected(wild.collect()).len() <= MOST);
    }

    #[test]
    fn a_cloud_keeps_a_point_wherever_it_has_one() {
        let points: Vec<Point> = (0..1_000_000)
            .map(|i| (f64::from(i % 1000), f64::from(i / 1000)))
            .collect();
        let thinned = scattered(points);
        assert!(thinned.len() > 100_000 && thinned.len() <= 501 * 301);
        // A cloud at one place is one point, and a small one stays as it is.
        assert_eq!(scattered(vec![(1.0, 2.0); 6_000]).len(), 1);
        assert_eq!(scattered(vec![(1.0, 2.0); 50]).len(), 50);
    }
}
