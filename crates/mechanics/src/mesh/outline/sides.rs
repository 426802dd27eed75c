//! Which of its sides the edges of a specimen's outline belong to.
//!
//! Sides are found on the outline's convex hull: they go from corner to corner and are named by where they face. A notch or a
//! waist, no deeper than it is wide, belongs to the side that it lies in, however the specimen is turned, and so does a dent of a rough edge.
//! Deeper ones, such as a cut or the inside of a U, belong to none: they are no part of what is gripped or pulled beside them. Where the hull bridges the angle
//! between two sides, as that of an L, its edges are named by where they face themselves. Among scattered markers corners are rounded: where
//! four sides are not seen from corner to corner, they go between the positions where the hull turns over some length.

use super::corners::{CORNER, corners};
use super::polygon::{distance, turn_between};
use crate::mesh::geometry::{self, convex_hull, distance as length};

/// Sides reach along the specimen by this share of its extent at least; a corner that is cut off is no side.
const LEAST: f64 = 0.2;

/// Share of a hull's edge within which points of the line lie on it.
const NEAR: f64 = 0.02;

/// Dents no deeper than this share of the specimen's extent are roughness of an edge, such as that of a mask.
const ROUGH: f64 = 0.01;

type Edge = [[f64; 2]; 2];

/// An edge of the hull with the points of the line from its first to its last one.
struct Span {
    edge: Edge,
    points: Vec<[f64; 2]>,
}

/// The edges of an outer line, the specimen to its left, each with the side that it belongs to, if any.
pub fn sides(line: &[[f64; 2]]) -> Vec<(Option<&'static str>, Edge)> {
    let spans = spans(line);
    let edges: Vec<Edge> = spans.iter().map(|span| span.edge).collect();
    let corners_of_hull: Vec<[f64; 2]> = edges.iter().map(|[from, _]| *from).collect();
    let ways = [
        chains(&sharp_turns(&edges), true),
        chains(&corners(&corners_of_hull), true),
        (0..edges.len()).map(|edge| vec![edge]).collect(),
    ];
    let has_all = |chains: &&Vec<Vec<usize>>| has_four_sides(&edges, chains);
    let extents = geometry::sides(line.iter().copied());
    let rough = ROUGH * extents[0].max(extents[1]);
    let mut named = Vec::new();
    for chain in ways.iter().find(has_all).unwrap_or(&ways[0]) {
        let side = facing(&edges, chain);
        for (position, number) in chain.iter().enumerate() {
            let amid = position > 0 && position + 1 < chain.len();
            named.extend(spans[*number].named((side, amid), rough));
        }
    }
    named
}

impl Span {
    /// Its edges with their sides, on a side of the hull, amid others of the same side or not; dents are rough edges up to a depth.
    fn named(
        &self,
        (side, amid): (&'static str, bool),
        rough: f64,
    ) -> Vec<(Option<&'static str>, Edge)> {
        let near = NEAR * length(self.edge[0], self.edge[1]);
        let off = |position: usize| distance(self.edge, self.points[position]);
        let last = self.points.len() - 1;
        let on: Vec<usize> = (0..=last)
            .filter(|position| *position == 0 || *position == last || off(*position) <= near)
            .collect();
        let lies_on_the_hull = on.windows(2).any(|pair| pair[1] == pair[0] + 1);
        let pieces = self.points.windows(2).map(|pair| [pair[0], pair[1]]);
        let pieces: Vec<Edge> = pieces.collect();
        if !lies_on_the_hull && !amid {
            let chains = chains(&sharp_turns(&pieces), false);
            let each = chains.iter().flat_map(|chain| {
                let facing_side = facing(&pieces, chain);
                let edges = chain.iter().map(|number| pieces[*number]);
                edges.map(move |edge| (Some(facing_side), edge))
            });
            return each.collect();
        }
        let pockets = on.windows(2).flat_map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            let depth = (from..=to).map(off).fold(0.0, f64::max);
            let is_shallow = depth <= length(self.points[from], self.points[to]).max(rough);
            let name = is_shallow.then_some(side);
            pieces[from..to].iter().map(move |edge| (name, *edge))
        });
        pockets.collect()
    }
}

/// The edges of a line's convex hull in order, with what the line does between their ends.
fn spans(line: &[[f64; 2]]) -> Vec<Span> {
    let mut corners = convex_hull(line);
    corners.sort_unstable();
    let count = line.len();
    let next = corners.iter().cycle().skip(1);
    let between = corners.iter().zip(next).map(|(from, to)| {
        let steps = (to + count - from - 1) % count + 1;
        let points = (0..=steps).map(|step| line[(from + step) % count]);
        Span {
            edge: [line[*from], line[*to]],
            points: points.collect(),
        }
    });
    between.collect()
}

/// Whether edges begin at a corner.
fn sharp_turns(edges: &[Edge]) -> Vec<bool> {
    let count = edges.len();
    let turn = |i: usize| turn_between(edges[(i + count - 1) % count], edges[i]).abs();
    (0..count).map(|i| turn(i) > CORNER).collect()
}

/// Numbers of edges that follow each other from corner to corner; of a closed line the first one may begin before a corner. A
/// round line faces all sides: each of its edges is for itself.
fn chains(begins_at_corner: &[bool], closed: bool) -> Vec<Vec<usize>> {
    let count = begins_at_corner.len();
    let corner = begins_at_corner.iter().position(|begins| *begins);
    let first = corner.filter(|_| closed).unwrap_or_default();
    let mut chains: Vec<Vec<usize>> = Vec::new();
    for i in (0..count).map(|i| (first + i) % count) {
        match chains.last_mut() {
            Some(chain) if !begins_at_corner[i] => chain.push(i),
            _ => chains.push(vec![i]),
        }
    }
    if closed && chains.len() < 2 {
        (0..count).map(|i| vec![i]).collect()
    } else {
        chains
    }
}

/// Whether chains of a hull's edges are its left, right, lower and upper side.
fn has_four_sides(edges: &[Edge], chains: &[Vec<usize>]) -> bool {
    let extent =
        |axis: usize, edges: &mut dyn Iterator<Item = Edge>| geometry::sides(edges.flatten())[axis];
    let reaches = |side: &str, axis: usize| {
        let facing_edges = chains.iter().filter(|chain| facing(edges, chain) == side);
        let mut facing_edges = facing_edges.flatten().map(|edge| edges[*edge]);
        extent(axis, &mut facing_edges) > LEAST * extent(axis, &mut edges.iter().copied())
    };
    let sides = [("left", 1), ("right", 1), ("bottom", 0), ("top", 0)];
    sides.into_iter().all(|(side, axis)| reaches(side, axis))
}

/// Where edges that follow each other face together.
fn facing(edges: &[Edge], chain: &[usize]) -> &'static str {
    let (from, to) = (edges[chain[0]][0], edges[chain[chain.len() - 1]][1]);
    let normal = [to[1] - from[1], from[0] - to[0]];
    match (
        normal[0].abs() > normal[1].abs(),
        normal[0] > 0.0,
        normal[1] > 0.0,
    ) {
        (true, false, _) => "left",
        (true, true, _) => "right",
        (false, _, false) => "bottom",
        (false, _, true) => "top",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::outline::polygon::Polygon;

    /// How long the edges of a side are together.
    fn total(line: &[[f64; 2]], side: Option<&str>) -> f64 {
        let of_side = sides(line).into_iter().filter(|(name, _)| *name == side);
        of_side.map(|(_, [a, b])| length(a, b)).sum()
    }

    fn perimeter(line: &[[f64; 2]]) -> f64 {
        Polygon(line).edges().map(|[a, b]| length(a, b)).sum()
    }

    fn turned(line: &[[f64; 2]], degrees: f64) -> Vec<[f64; 2]> {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let turn = |[x, y]: &[f64; 2]| [cosine * x - sine * y + 1e3, sine * x + cosine * y];
        line.iter().map(turn).collect()
    }

    const NAMES: [&str; 4] = ["bottom", "right", "top", "left"];

    #[test]
    fn notches_and_waists_belong_to_the_side_that_they_lie_in_however_the_specimen_is_turned() {
        let smooth = (0..=20).map(|i| {
            let x = f64::from(i) / 20.0;
            [
                40.0 - 20.0 * x,
                20.0 - 3.0 * (std::f64::consts::PI * x).sin(),
            ]
        });
        let mut line = vec![
            [0.0, 0.0],
            [25.0, 0.0],
            [25.0, 4.0],
            [35.0, 4.0],
            [35.0, 0.0],
        ];
        line.extend([[60.0, 0.0], [60.0, 20.0]]);
        line.extend(smooth);
        line.push([0.0, 20.0]);
        let lengths: Vec<f64> = NAMES.iter().map(|side| total(&line, Some(side))).collect();
        assert!((lengths[0] - 68.0).abs() < 1e-9, "{lengths:?}");
        assert!((lengths[1] - 20.0).abs() < 1e-9, "{lengths:?}");
        assert!(lengths[2] > 60.0);
        for degrees in [-35.0, -10.0, 0.0, 7.0, 35.0, 80.0, 130.0, 180.0, 260.0] {
            let quarter = (degrees / 90.0_f64).round().rem_euclid(4.0) as usize;
            for begin in [0, 3, 9] {
                let mut line = turned(&line, degrees);
                line.rotate_left(begin);
                let now: Vec<f64> = (0..4)
                    .map(|side| total(&line, Some(NAMES[(side + quarter) % 4])))
                    .collect();
                for (one, other) in lengths.iter().zip(&now) {
                    assert!((one - other).abs() < 1e-9, "{degrees}°: {now:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_deeper_than_wide_belongs_to_no_side() {
        let cut = [
            [0.0, 0.0],
            [29.0, 0.0],
            [30.0, 8.0],
            [31.0, 0.0],
            [60.0, 0.0],
            [60.0, 20.0],
            [0.0, 20.0],
        ];
        assert!((total(&cut, Some("bottom")) - 58.0).abs() < 1e-9);
        assert!((total(&cut, Some("left")) - 20.0).abs() < 1e-9);
        assert!((total(&cut, None) - 2.0 * f64::hypot(1.0, 8.0)).abs() < 1e-9);
        let u = [
            [0.0, 0.0],
            [30.0, 0.0],
            [30.0, 40.0],
            [20.0, 40.0],
            [20.0, 10.0],
            [10.0, 10.0],
            [10.0, 40.0],
            [0.0, 40.0],
        ];
        assert!((total(&u, Some("top")) - 20.0).abs() < 1e-9);
        assert!((total(&u, None) - 70.0).abs() < 1e-9);
    }

    /// As the edge of a mask, whose pixels leave slits half a thousandth of it wide.
    #[test]
    fn slits_of_a_rough_edge_belong_to_its_side() {
        let right = (0..10).flat_map(|slit| {
            let y = 2.0 * f64::from(slit);
            [
                [60.0, y],
                [60.0, y + 1.0],
                [59.5, y + 1.01],
                [60.0, y + 1.02],
            ]
        });
        let line: Vec<[f64; 2]> = [[0.0, 0.0]]
            .into_iter()
            .chain(right)
            .chain([[60.0, 20.0], [0.0, 20.0]])
            .collect();
        assert!(total(&line, None) < 1e-9);
        assert!((total(&line, Some("right")) - 29.8).abs() < 0.1);
    }

    #[test]
    fn an_inner_angle_is_named_by_where_its_edges_face() {
        let l = [
            [0.0, 0.0],
            [40.0, 0.0],
            [40.0, 10.0],
            [10.0, 10.0],
            [10.0, 30.0],
            [0.0, 30.0],
        ];
        let lengths = NAMES.map(|side| total(&l, Some(side)));
        assert_eq!(lengths, [40.0, 30.0, 40.0, 30.0]);
    }

    #[test]
    fn every_edge_is_named_once() {
        let ragged: Vec<[f64; 2]> = (0..90)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 90.0;
                let radius = 20.0 + f64::from(i * 7 % 5);
                [radius * angle.cos(), 2.0 * radius * angle.sin()]
            })
            .collect();
        for line in [&ragged[..], &ragged[..3], &ragged[10..60]] {
            let all: f64 = sides(line).iter().map(|(_, [a, b])| length(*a, *b)).sum();
            assert!((all / perimeter(line) - 1.0).abs() < 1e-12);
            assert_eq!(sides(line).len(), line.len());
        }
    }
}
