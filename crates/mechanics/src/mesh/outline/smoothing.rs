//! Lines through the outermost points of a grid that are the curves and corners behind them.
//!
//! Points of a grid follow a curved edge in steps. Where a parabola of the arc's length, fitted around every point of the line, stays
//! as near to the points as a straightened line may, the line is curved; else there is a corner, or a straight edge whose steps are long.
//! Curved parts are moved out to their outermost points: the specimen reaches at least as far. Where all points lie on one smooth curve,
//! as markers along an edge do, the line goes through them.
//!
//! # References
//! W. S. Cleveland, J. Am. Stat. Assoc. 74, 829 (1979), doi:10.1080/01621459.1979.10481038

use nalgebra::{Matrix3, Vector3};

use super::polygon::{
    Polygon, distance, needed, needed_behind_the_first, shifted, straightened, turn_between,
};
use super::side_lines::{SideLine, corner};
use crate::mesh::geometry::distance as length;

/// Parabolas are fitted to so many spacings on either side, but to no more than this share of a closed line.
const PARABOLA_REACH: f64 = 4.0;
const SHARE: f64 = 0.125;
/// Least reach of a parabola in spacings and in points, and the factor by which it goes beyond the last of these points.
const LEAST: f64 = 2.5;
const FEWEST: usize = 4;
const WIDER: f64 = 1.3;

/// Straight edges of so many spacings at least that meet by a turn of more than this, 40°, meet at a corner.
const SIDE: f64 = 3.0;
const CORNER: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// A longer and a shorter straight edge meet at a corner by a turn of more than this, 75°: ends of strips with two or three rows of markers.
const STRIP: f64 = 5.0;
const END: f64 = 1.0;
const SQUARE: f64 = 75.0 * std::f64::consts::PI / 180.0;

/// Edges of any length meet at a corner by that turn if their points are as near as this, in spacings, to their chords, and one has three points or
/// more: sides of small grids. Steps along a curve or an oblique edge are farther off.
const EXACT: f64 = 0.1;

/// Curves have points so many spacings apart, as far as they are needed.
const STEP: f64 = 0.4;

/// Longer edges, in spacings, that bulge by less than this are straight.
const LONG: f64 = 10.0;
const BULGE: f64 = 0.2;

/// What is smooth has points as near as this, in spacings, to straight edges between them.
const FINE: f64 = 0.05;

/// Points as near as this, in spacings, to their parabolas lie on one curve: steps of a grid are ten times farther off.
const ON_CURVE: f64 = 0.05;

/// The line through such points has points as near as this, in spacings, to straight edges between them.
const FINEST: f64 = 0.003;

/// A part of a closed line: its points, the first and the last one among them.
type Part = Vec<[f64; 2]>;

/// The line behind a closed line of points; no point is farther than `near` from it but where it is curved.
pub fn smoothed(line: &[[f64; 2]], near: f64, spacing: f64) -> Vec<[f64; 2]> {
    let kept = needed(line, near);
    let plain = || kept.iter().map(|point| line[*point]).collect();
    if kept.len() < 3 {
        return plain();
    }
    let curve = closed(line, spacing);
    let edges = parts(line, &kept);
    let is_straight: Vec<bool> = edges
        .iter()
        .map(|edge| chord(edge) > LONG * spacing && bulge(edge) < BULGE * spacing)
        .collect();
    let count = kept.len();
    let is_corner = |i: usize| {
        let (before, next) = (&edges[(i + count - 1) % count], &edges[i]);
        meet_at_a_corner(before, next, spacing)
            || length(line[kept[i]], curve.position(curve.at[kept[i]])) > near
    };
    let ends =
        |i: &usize| is_corner(*i) || is_straight[*i] || is_straight[(*i + count - 1) % count];
    let breaks: Vec<usize> = (0..count).filter(ends).collect();
    let Some(first) = breaks.first() else {
        return outermost(&curve, near, spacing);
    };
    let following = breaks.iter().skip(1).chain([first]);
    let parts: Vec<Smoothed> = breaks
        .iter()
        .zip(following)
        .map(|(from, to)| {
            let piece = part(line, kept[*from], kept[*to]);
            let is_one_edge = (from + 1) % count == *to;
            if is_one_edge && (is_straight[*from] || bulge(&piece) < BULGE * spacing) {
                (vec![piece[0]], SideLine::of(&piece, spacing))
            } else {
                (open_curve(&piece, near, spacing), None)
            }
        })
        .collect();
    let outline = joined(parts, near);
    if outline.len() < 3 { plain() } else { outline }
}

/// The points of a part but for its last one, and its line where it is straight and points lie about it.
type Smoothed = (Vec<[f64; 2]>, Option<SideLine>);

/// Parts one behind the other, each from the corner with the one before it.
fn joined(mut parts: Vec<Smoothed>, near: f64) -> Vec<[f64; 2]> {
    let count = parts.len();
    for index in 0..count {
        let before = parts[(index + count - 1) % count].1;
        let (points, side_line) = &mut parts[index];
        points[0] = corner(points[0], [before, *side_line], near);
    }
    parts.into_iter().flat_map(|(points, _)| points).collect()
}

/// Whether two edges are straight and meet by an angle.
fn meet_at_a_corner(before: &Part, next: &Part, spacing: f64) -> bool {
    let is_side = |edge: &Part, least: f64| {
        let long = chord(edge) >= least * spacing * (1.0 - 1e-9) && edge.len() > least as usize;
        long && bulge(edge) < BULGE * spacing
    };
    let both = |one, other| {
        let sides = [[before, next], [next, before]];
        sides
            .into_iter()
            .any(|[a, b]| is_side(a, one) && is_side(b, other))
    };
    let [a, b] = [before, next].map(|edge| [edge[0], edge[edge.len() - 1]]);
    let turn = turn_between(a, b).abs();
    let is_exact = |edge: &Part| {
        let chord = [edge[0], edge[edge.len() - 1]];
        let mut points = edge.iter();
        points.all(|point| distance(chord, *point) < EXACT * spacing)
    };
    let are_exact = before.len().max(next.len()) > 2 && is_exact(before) && is_exact(next);
    turn > CORNER && both(SIDE, SIDE) || turn > SQUARE && (both(STRIP, END) || are_exact)
}

/// The points of a closed line from each of some to the next one.
pub fn parts(line: &[[f64; 2]], kept: &[usize]) -> Vec<Part> {
    let following = kept.iter().cycle().skip(1);
    let pairs = kept.iter().zip(following);
    pairs.map(|(from, to)| part(line, *from, *to)).collect()
}

/// The points of a closed line from one to another one.
fn part(line: &[[f64; 2]], from: usize, to: usize) -> Part {
    let count = line.len();
    let steps = (to + count - from - 1) % count + 1;
    (0..=steps)
        .map(|step| line[(from + step) % count])
        .collect()
}

pub fn chord(part: &[[f64; 2]]) -> f64 {
    length(part[0], part[part.len() - 1])
}

/// How far a part bulges between its ends, by the parabola over its chord that is nearest to its points.
pub fn bulge(part: &[[f64; 2]]) -> f64 {
    let (from, to) = (part[0], part[part.len() - 1]);
    let size = length(from, to);
    if part.len() < 4 || size == 0.0 {
        return 0.0;
    }
    let [tx, ty] = [(to[0] - from[0]) / size, (to[1] - from[1]) / size];
    let at = part.iter().map(|[x, y]| {
        let [dx, dy] = [x - from[0], y - from[1]];
        (
            2.0 * (dx * tx + dy * ty) / size - 1.0,
            dy * tx - dx * ty,
            1.0,
        )
    });
    parabola(at).map_or(0.0, |coefficients| coefficients[2].abs())
}

/// The parabola nearest to points (t, y) with weights.
fn parabola(points: impl Iterator<Item = (f64, f64, f64)>) -> Option<Vector3<f64>> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (t, y, weight) in points {
        let row = Vector3::new(1.0, t, t * t);
        normal += weight * row * row.transpose();
        right += weight * y * row;
    }
    normal.cholesky().map(|factor| factor.solve(&right))
}

/// The points of a line with their arc lengths, and how far parabolas reach along it.
struct Followed<'a> {
    line: &'a [[f64; 2]],
    at: Vec<f64>,
    /// The arc length of the whole line.
    total: f64,
    is_closed: bool,
    reach: f64,
}

impl Followed<'_> {
    /// The value of the parabola around an arc length.
    fn position(&self, arc: f64) -> [f64; 2] {
        let Self { line, at, .. } = self;
        let from_here = |at: &f64| {
            let t = at - arc;
            let turns = if self.is_closed {
                (t / self.total).round()
            } else {
                0.0
            };
            t - self.total * turns
        };
        let apart: Vec<f64> = at.iter().map(from_here).collect();
        let mut sorted: Vec<f64> = apart.iter().map(|t| t.abs()).collect();
        sorted.sort_by(f64::total_cmp);
        let reach = self.reach.max(WIDER * sorted[sorted.len().min(FEWEST) - 1]);
        let near = apart.iter().enumerate().filter_map(|(other, t)| {
            let share = (t / reach).abs();
            let weight = (1.0 - share.powi(3)).max(0.0).powi(3);
            (weight > 0.0).then_some((t / reach, other, weight))
        });
        let near: Vec<(f64, usize, f64)> = near.collect();
        let of_axis = |axis: usize| {
            let points = near.iter();
            let points = points.map(|(t, other, weight)| (*t, line[*other][axis], *weight));
            parabola(points).map(|coefficients| coefficients[0])
        };
        match [0, 1].map(of_axis) {
            [Some(x), Some(y)] => [x, y],
            _ => self.on_the_line(arc),
        }
    }

    /// The positions on the smooth curve through all points, from the first one on; `None` where they lie on none.
    fn through(&self, spacing: f64) -> Option<Vec<[f64; 2]>> {
        let off = self.at.iter().zip(self.line).map(|(at, point)| {
            let position = self.position(*at);
            let is_near = length(position, *point) <= ON_CURVE * spacing;
            is_near.then(|| [0, 1].map(|axis| point[axis] - position[axis]))
        });
        // The first point that is off ends it: most lines are steps of grids.
        let off: Vec<[f64; 2]> = off.collect::<Option<_>>()?;
        let count = self.line.len();
        let edges = if self.is_closed { count } else { count - 1 };
        let along = (0..edges).flat_map(|i| {
            let next = (i + 1) % count;
            let size = length(self.line[i], self.line[next]);
            let parts = (size / (STEP * spacing)).ceil().max(1.0) as usize;
            let off = &off;
            (0..parts).map(move |part| {
                let share = part as f64 / parts as f64;
                let position = self.position(self.at[i] + share * size);
                [0, 1].map(|axis| {
                    position[axis] + off[i][axis] + share * (off[next][axis] - off[i][axis])
                })
            })
        });
        let last = self.line.last().filter(|_| !self.is_closed);
        Some(along.chain(last.copied()).collect())
    }

    /// The position at an arc length on the line itself.
    fn on_the_line(&self, arc: f64) -> [f64; 2] {
        let last = self.at.partition_point(|at| *at <= arc).max(1) - 1;
        let next = (last + 1) % self.line.len();
        let [a, b] = [self.line[last], self.line[next]];
        let size = length(a, b);
        let share = if size > 0.0 {
            ((arc - self.at[last]) / size).min(1.0)
        } else {
            0.0
        };
        [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
    }

    /// Arc lengths from the first point on, a step apart.
    fn steps(&self, step: f64) -> Vec<f64> {
        let end = if self.is_closed {
            self.total
        } else {
            self.at[self.at.len() - 1]
        };
        let count = (end / step).ceil().max(1.0) as usize;
        let last = count - usize::from(self.is_closed);
        (0..=last).map(|i| end * i as f64 / count as f64).collect()
    }
}

/// The lengths along a line up to each of its points, and behind the last one.
fn arc_lengths(line: &[[f64; 2]]) -> (Vec<f64>, f64) {
    let mut sum = 0.0;
    let at = Polygon(line).edges().map(|[a, b]| {
        let start = sum;
        sum += length(a, b);
        start
    });
    let at: Vec<f64> = at.collect();
    (at, sum)
}

/// A closed line with parabolas around all its points.
fn closed(line: &[[f64; 2]], spacing: f64) -> Followed<'_> {
    let (at, total) = arc_lengths(line);
    Followed {
        line,
        at,
        total,
        is_closed: true,
        reach: (PARABOLA_REACH * spacing)
            .min(SHARE * total)
            .max(LEAST * spacing),
    }
}

/// A closed curve moved out to the outermost of the line's points.
fn outermost(followed: &Followed, near: f64, spacing: f64) -> Vec<[f64; 2]> {
    if let Some(curve) = followed.through(spacing) {
        return straightened(&curve, FINEST * spacing);
    }
    let line = followed.line;
    let steps = followed.steps(STEP * spacing).into_iter();
    let curve: Vec<[f64; 2]> = steps.map(|at| followed.position(at)).collect();
    let curve = straightened(&curve, FINE * spacing);
    let out = line.iter().map(|point| outside(&curve, *point));
    let out = out.fold(0.0, f64::max).min(near);
    shifted(&curve, out)
}

/// How far a point lies to the right of a closed line, which has the specimen to its left.
fn outside(line: &[[f64; 2]], point: [f64; 2]) -> f64 {
    let edges = Polygon(line).edges();
    let nearest = edges.min_by(|a, b| distance(*a, point).total_cmp(&distance(*b, point)));
    nearest.map_or(0.0, |[a, b]| {
        let side = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
        -side.signum() * distance([a, b], point)
    })
}

/// The curve behind a part between two corners or straight edges, without its last point: its ends stay, and what lies between
/// is moved out to the outermost points.
fn open_curve(part: &[[f64; 2]], near: f64, spacing: f64) -> Vec<[f64; 2]> {
    let (at, total) = arc_lengths(part);
    let followed = Followed {
        line: part,
        at,
        total,
        is_closed: false,
        reach: PARABOLA_REACH * spacing,
    };
    if let Some(curve) = followed.through(spacing) {
        return without_the_last(&curve, FINEST * spacing);
    }
    let at = followed.steps(STEP * spacing);
    let total = at[at.len() - 1];
    let mut curve: Vec<[f64; 2]> = at.iter().map(|at| followed.position(*at)).collect();
    let last = curve.len() - 1;
    let normal = |i: usize| {
        let (a, b) = (curve[i.saturating_sub(1)], curve[(i + 1).min(last)]);
        let size = length(a, b).max(f64::MIN_POSITIVE);
        [(b[1] - a[1]) / size, (a[0] - b[0]) / size]
    };
    let normals: Vec<[f64; 2]> = (0..=last).map(normal).collect();
    let out = part.iter().map(|point| {
        let far = |i: &usize| length(curve[*i], *point);
        let nearest = (0..=last).min_by(|a, b| far(a).total_cmp(&far(b)));
        let i = nearest.unwrap_or_default();
        let [dx, dy] = [0, 1].map(|axis| point[axis] - curve[i][axis]);
        dx * normals[i][0] + dy * normals[i][1]
    });
    let out = out.fold(0.0, f64::max).min(near);
    for (i, [nx, ny]) in normals.into_iter().enumerate() {
        // The ends stay where they are.
        let ease = (at[i].min(total - at[i]) / (PARABOLA_REACH * spacing)).min(1.0);
        let blend = |axis: usize, n: f64| {
            let moved = curve[i][axis] + out * n;
            let on_line = followed.on_the_line(at[i])[axis];
            on_line + ease * (moved - on_line)
        };
        curve[i] = [blend(0, nx), blend(1, ny)];
    }
    without_the_last(&curve, FINE * spacing)
}

/// The points of a curve that are needed, but for its last one.
fn without_the_last(curve: &[[f64; 2]], near: f64) -> Vec<[f64; 2]> {
    let needed = needed_behind_the_first(curve, near);
    let inner = &needed[..needed.len() - 1];
    let first = std::iter::once(&0);
    first.chain(inner).map(|point| curve[*point]).collect()
}

#[cfg(test)]
mod tests;
