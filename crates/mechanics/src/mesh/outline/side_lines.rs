//! Straight lines nearest to rows of outermost markers that lie about a straight edge.
//!
//! Markers a little off their grid make corners of an outline that go through two of them a rough guess at the edge: the line nearest
//! to all of a row is √n times nearer.

use nalgebra::{SymmetricEigen, Vector2};

use super::polygon::distance;
use crate::mesh::geometry::distance as length;

/// Points of a row lie within this of its line, in spacings, by root mean square: steps of a grid along an oblique edge, which would take
/// the line into the specimen, are 0.29 off.
const EVEN: f64 = 0.15;

/// Fewer points have no line of their own.
const FEWEST: usize = 4;

/// Lines that meet by a smaller sine have no sure point in common.
const SHARP: f64 = 0.3;

/// A straight line: a point on it and its direction.
#[derive(Clone, Copy)]
pub struct SideLine {
    centre: Vector2<f64>,
    along: Vector2<f64>,
}

impl SideLine {
    /// The line of a row of points; `None` where they are few, lie on the chord already, or do not follow one straight line.
    pub fn of(row: &[[f64; 2]], spacing: f64) -> Option<Self> {
        let chord = [*row.first()?, *row.last()?];
        let is_exact = row
            .iter()
            .all(|point| distance(chord, *point) < 1e-6 * spacing);
        if row.len() < FEWEST || is_exact {
            return None;
        }
        let (line, across) = Self::through(row);
        (across < EVEN * spacing).then_some(line)
    }

    /// The line nearest to points; those within `ends` of the first and the last one, which may belong to a corner, do not
    /// count where others are three or more.
    pub fn nearest_to(row: &[[f64; 2]], ends: f64) -> Self {
        let [first, last] = [row[0], row[row.len() - 1]];
        let is_amid = |point: &&[f64; 2]| length(**point, first).min(length(**point, last)) > ends;
        let amid: Vec<[f64; 2]> = row.iter().filter(is_amid).copied().collect();
        Self::through(if amid.len() > 2 { &amid } else { row }).0
    }

    /// The line nearest to points, in their direction, and the root mean square of their distances.
    fn through(row: &[[f64; 2]]) -> (Self, f64) {
        let points = || row.iter().map(|point| Vector2::from(*point));
        let centre = points().sum::<Vector2<f64>>() / row.len() as f64;
        let scatter = points().map(|point| (point - centre) * (point - centre).transpose());
        let scatter = SymmetricEigen::new(scatter.sum());
        let along: Vector2<f64> = scatter
            .eigenvectors
            .column(scatter.eigenvalues.imax())
            .into();
        let [first, last] = [row[0], row[row.len() - 1]].map(Vector2::from);
        let line = Self {
            centre,
            along: along * along.dot(&(last - first)).signum(),
        };
        let across = (scatter.eigenvalues.min().max(0.0) / row.len() as f64).sqrt();
        (line, across)
    }

    /// Where another side that follows this one meets it by a turn of more than `least`, in rad.
    pub fn corner_with(self, other: Self, least: f64) -> Option<[f64; 2]> {
        let (sine, cosine) = (self.along.perp(&other.along), self.along.dot(&other.along));
        let turns = sine.atan2(cosine).abs() > least;
        self.crossing(other).filter(|_| turns).map(Into::into)
    }

    /// How far a point lies from the line.
    pub fn distance(self, point: [f64; 2]) -> f64 {
        let point = Vector2::from(point);
        (self.nearest(point) - point).norm()
    }

    fn nearest(self, point: Vector2<f64>) -> Vector2<f64> {
        self.centre + self.along * self.along.dot(&(point - self.centre))
    }

    fn crossing(self, other: Self) -> Option<Vector2<f64>> {
        let sine = self.along.perp(&other.along);
        let far = (other.centre - self.centre).perp(&other.along) / sine;
        (sine.abs() > SHARP).then(|| self.centre + self.along * far)
    }
}

/// The corner between two sides, of which a line is known or not, that is at or near a point of the outline.
pub fn corner(point: [f64; 2], sides: [Option<SideLine>; 2], near: f64) -> [f64; 2] {
    let start = Vector2::from(point);
    let moved = match sides {
        [None, None] => return point,
        [Some(one), None] | [None, Some(one)] => one.nearest(start),
        [Some(one), Some(other)] => one
            .crossing(other)
            .unwrap_or_else(|| (one.nearest(start) + other.nearest(start)) / 2.0),
    };
    if (moved - start).norm() < near {
        moved.into()
    } else {
        point
    }
}
