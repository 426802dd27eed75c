//! The envelope of a specimen's outermost markers: dents that a grid turned against its edge, or scattered markers, make are bridged,
//! and corners without a marker are those of the sides beside them.
//!
//! The edge lies outside all markers, and rarely farther than a spacing. A line from marker to marker with the others to its left, none
//! deeper than that, is as near to it as any, and has no steps.

use super::polygon::{needed, turn_between};
use super::side_lines::SideLine;
use super::smoothing::{bulge, chord, parts};
use crate::mesh::geometry::distance as length;

/// Markers deeper than this below their chord, in spacings, are in a dent; rows that are a little uneven are not.
const DENT: f64 = 0.3;

/// Markers so little outside of a chord, in spacings, lie on it.
const ON_CHORD: f64 = 0.02;

/// A dent is short below this length in spacings, and one of a step where one of its ends has this share of its depth.
const SHORT: f64 = 4.0;
const STEEP: f64 = 0.7;

/// Sides are longer than so many times what their points may be off them: those of circles, which turn by less than corners do, are shorter.
const SIDE: f64 = 9.0;

/// Points as near as this to the ends of a side, in spacings, may belong to a corner.
const END: f64 = 0.75;

/// Straight sides bulge by less than this share of what their points may be off them.
const STRAIGHT: f64 = 0.9;

/// Sides that turn by less than this, 10°, are one: where one row of markers ends at an edge and the next one begins.
const FLAT: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// Corners turn by more than this, 50°.
const CORNER: f64 = 50.0 * std::f64::consts::PI / 180.0;

/// A closed line, the specimen to its left, with its points in dents no deeper than `deep` moved onto the chords that bridge them.
pub fn without_dents(line: &[[f64; 2]], deep: f64, spacing: f64) -> Vec<[f64; 2]> {
    let count = line.len();
    let along_x = |a: &usize, b: &usize| line[*a][0].total_cmp(&line[*b][0]);
    let first = (0..count).min_by(along_x).unwrap_or_default();
    let closed: Vec<[f64; 2]> = (0..=count).map(|i| line[(first + i) % count]).collect();
    let mut bridged = Vec::new();
    let mut from = 0;
    while from < count {
        // The whole closed line has no chord.
        let most = count - usize::from(from == 0);
        let ends = (from + 2..=most).rev();
        let mut chords = ends.map(|to| Chord::new(&closed[from..=to]));
        let longest = chords.find(|chord| chord.is_envelope(deep, spacing));
        let chord = longest.unwrap_or_else(|| Chord::new(&closed[from..=from + 1]));
        chord.bridge(spacing, &mut bridged);
        from += chord.points.len() - 1;
    }
    bridged
}

/// The straight line from the first to the last of some points that follow each other.
struct Chord<'a> {
    points: &'a [[f64; 2]],
    along: [f64; 2],
}

impl<'a> Chord<'a> {
    fn new(points: &'a [[f64; 2]]) -> Self {
        let (from, to) = (points[0], points[points.len() - 1]);
        let size = length(from, to).max(f64::MIN_POSITIVE);
        let along = [0, 1].map(|axis| (to[axis] - from[axis]) / size);
        Self { points, along }
    }

    /// How far a point lies along the chord from its start, and how deep to its left.
    fn coordinates(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([x0, y0], [tx, ty]) = (self.points[0], self.along);
        let (dx, dy) = (x - x0, y - y0);
        [dx * tx + dy * ty, dy * tx - dx * ty]
    }

    /// Whether no point lies to the right of the chord, and all dents are those of steps or of a few markers, and no deeper than `deep`.
    fn is_envelope(&self, deep: f64, spacing: f64) -> bool {
        let mut dent: Vec<[f64; 2]> = Vec::new();
        for point in self.points {
            let [at, depth] = self.coordinates(*point);
            if depth < -ON_CHORD * spacing || depth > deep {
                return false;
            }
            if depth > DENT * spacing {
                dent.push([at, depth]);
            } else if !dent.is_empty() {
                if !is_step(&dent, spacing) {
                    return false;
                }
                dent.clear();
            }
        }
        true
    }

    /// Adds the points but for the last one, those in dents at their positions along the chord.
    fn bridge(&self, spacing: f64, line: &mut Vec<[f64; 2]>) {
        let mut before = f64::NEG_INFINITY;
        for point in &self.points[..self.points.len() - 1] {
            let [at, depth] = self.coordinates(*point);
            if depth < DENT * spacing {
                line.push(*point);
            } else if at > before {
                line.push([0, 1].map(|axis| self.points[0][axis] + at * self.along[axis]));
            }
            before = before.max(at);
        }
    }
}

/// Whether a dent, by its points along and below its chord, is short, or deepest at one of its ends as steps are; one that is deepest amid
/// is a round or a waisted edge.
fn is_step(dent: &[[f64; 2]], spacing: f64) -> bool {
    let (first, last) = (dent[0], dent[dent.len() - 1]);
    let deepest = dent.iter().map(|[_, depth]| *depth).fold(0.0, f64::max);
    last[0] - first[0] < SHORT * spacing || first[1].max(last[1]) > STEEP * deepest
}

/// The corners of a closed line that is a polygon: of straight sides that turn by more than 50° where they meet, with no point between them
/// deeper than `deep`. `None` for any other line; sides have no point farther than `near` from the straight line between their ends.
pub fn polygonal(line: &[[f64; 2]], [near, deep]: [f64; 2], spacing: f64) -> Option<Vec<[f64; 2]>> {
    let corners = without_flat_ones(line, needed(line, near), SIDE * near);
    let edges = parts(line, &corners);
    let count = edges.len();
    let is_side = |edge: &usize| chord(&edges[*edge]) > SIDE * near;
    let sides: Vec<usize> = (0..count).filter(is_side).collect();
    let is_straight = |edge: &usize| bulge(&edges[*edge]) < STRAIGHT * near;
    if sides.len() < 3 || !sides.iter().all(is_straight) {
        return None;
    }
    let following = sides.iter().cycle().skip(1);
    let corners = sides.iter().zip(following).map(|(one, other)| {
        let lines =
            [&edges[*one], &edges[*other]].map(|side| SideLine::nearest_to(side, END * spacing));
        let corner = lines[0].corner_with(lines[1], CORNER)?;
        let is_beside = |point: [f64; 2]| lines.iter().any(|line| line.distance(point) < deep);
        let between = (other + count - one - 1) % count;
        let mut cut = (1..=between).flat_map(|step| edges[(one + step) % count].windows(2));
        let is_cut =
            cut.all(|pair| is_beside([0, 1].map(|axis| (pair[0][axis] + pair[1][axis]) / 2.0)));
        is_cut.then_some(corner)
    });
    corners.collect()
}

/// The corners of a line without those between two edges longer than `long` that hardly turn there.
fn without_flat_ones(line: &[[f64; 2]], mut corners: Vec<usize>, long: f64) -> Vec<usize> {
    let is_flat = |corners: &[usize], i: usize| {
        let count = corners.len();
        let [a, b, c] = [i + count - 1, i, i + 1].map(|i| line[corners[i % count]]);
        length(a, b).min(length(b, c)) > long && turn_between([a, b], [b, c]).abs() < FLAT
    };
    while let Some(flat) = (0..corners.len()).find(|i| is_flat(&corners, *i)) {
        corners.remove(flat);
    }
    corners
}
