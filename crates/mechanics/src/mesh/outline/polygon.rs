//! Closed lines of straight edges.

use crate::mesh::geometry::{distance as length, polygon_area};

/// A closed line of straight edges.
#[derive(Clone, Copy)]
pub struct Polygon<'a>(pub &'a [[f64; 2]]);

impl<'a> Polygon<'a> {
    /// The edges, the last one back to the first point.
    pub fn edges(self) -> impl Iterator<Item = [[f64; 2]; 2]> + use<'a> {
        let next = self.0.iter().cycle().skip(1);
        self.0.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// Positions along x where the line crosses a height, ascending.
    pub fn crossings(self, y: f64) -> Vec<f64> {
        let across = self.edges().filter(|[a, b]| (a[1] > y) != (b[1] > y));
        let at = across.map(|[a, b]| a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
        let mut at: Vec<f64> = at.collect();
        at.sort_by(f64::total_cmp);
        at
    }

    /// Whether a point lies inside.
    pub fn contains(self, [x, y]: [f64; 2]) -> bool {
        let left = self.crossings(y).into_iter().filter(|at| *at < x);
        left.count() % 2 == 1
    }
}

/// Whether all points lie on one straight line.
pub fn is_straight(line: &[[f64; 2]]) -> bool {
    let mut corners = line
        .windows(2)
        .map(|pair| polygon_area(&[line[0], pair[0], pair[1]]));
    corners.all(|area| area == 0.0)
}

/// The distance of a point from an edge.
pub fn distance([a, b]: [[f64; 2]; 2], point: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = (point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1];
    let share = if square > 0.0 {
        (share / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    length([a[0] + share * along[0], a[1] + share * along[1]], point)
}

/// A closed line with fewer points, none of its points further than `near` from it.
pub fn straightened(line: &[[f64; 2]], near: f64) -> Vec<[f64; 2]> {
    let kept = needed(line, near).into_iter();
    kept.map(|point| line[point]).collect()
}

/// The points that a closed line needs so that none is further than `near` from it (Douglas and Peucker), by their numbers in its order.
pub fn needed(line: &[[f64; 2]], near: f64) -> Vec<usize> {
    let centre = [0, 1].map(|axis| line.iter().map(|p| p[axis]).sum::<f64>() / line.len() as f64);
    let farthest = |from: [f64; 2]| {
        let points = 0..line.len();
        points.max_by(|a, b| length(from, line[*a]).total_cmp(&length(from, line[*b])))
    };
    let first = farthest(centre).unwrap_or_default();
    let second = farthest(line[first]).unwrap_or_default();
    let count = line.len();
    let turned: Vec<[f64; 2]> = (0..=count).map(|i| line[(first + i) % count]).collect();
    let half = (second + count - first) % count;
    let first_half = needed_behind_the_first(&turned[..=half], near).into_iter();
    let second_half = needed_behind_the_first(&turned[half..], near).into_iter();
    let mut kept = vec![0];
    kept.extend(first_half.chain(second_half.map(|point| half + point)));
    kept.pop();
    kept.iter().map(|point| (first + point) % count).collect()
}

/// The points that an open line needs after its first one, by their numbers.
pub fn needed_behind_the_first(line: &[[f64; 2]], near: f64) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut open = vec![(0, line.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let far = |point: usize| distance([line[from], line[to]], line[point]);
        let most = (from + 1..to).max_by(|a, b| far(*a).total_cmp(&far(*b)));
        match most.filter(|most| far(*most) > near) {
            Some(most) => open.extend([(most, to), (from, most)]),
            None => kept.push(to),
        }
    }
    kept
}

/// By how much a line turns from one edge to the next, in rad from −π to π.
pub fn turn_between(before: [[f64; 2]; 2], next: [[f64; 2]; 2]) -> f64 {
    let direction = |[a, b]: [[f64; 2]; 2]| (b[1] - a[1]).atan2(b[0] - a[0]);
    let change = direction(next) - direction(before);
    change.sin().atan2(change.cos())
}

/// A line with every edge moved by a distance to its right; at sharp corners no point moves by more than three distances.
pub fn shifted(line: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    const SHARPEST: f64 = 2.0 / 9.0;
    let normals: Vec<[f64; 2]> = Polygon(line)
        .edges()
        .map(|[a, b]| {
            let size = length(a, b).max(f64::MIN_POSITIVE);
            [(b[1] - a[1]) / size, (a[0] - b[0]) / size]
        })
        .collect();
    let count = line.len();
    let moved = |i: usize| {
        let [m, n] = [normals[(i + count - 1) % count], normals[i]];
        let share = distance / (1.0 + m[0] * n[0] + m[1] * n[1]).max(SHARPEST);
        [0, 1].map(|axis| line[i][axis] + share * (m[axis] + n[axis]))
    };
    (0..count).map(moved).collect()
}

/// The points of a line with more between them, so that no edge is longer than `size`.
pub fn divided(line: &[[f64; 2]], size: f64) -> Vec<[f64; 2]> {
    let edges = Polygon(line).edges();
    let pieces = edges.flat_map(|[a, b]| {
        let count = (length(a, b) / size - 1e-6).ceil().max(1.0) as usize;
        (0..count).map(move |i| {
            let share = i as f64 / count as f64;
            [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
        })
    });
    pieces.collect()
}

/// A position where edges of lines cross or touch that do not follow each other.
pub fn crossing(lines: &[Polygon]) -> Option<[f64; 2]> {
    let mut edges: Vec<(usize, [[f64; 2]; 2])> = lines
        .iter()
        .enumerate()
        .flat_map(|(line, polygon)| polygon.edges().map(move |edge| (line, edge)))
        .collect();
    let left = |(_, [a, b]): &(usize, [[f64; 2]; 2])| a[0].min(b[0]);
    edges.sort_by(|one, other| left(one).total_cmp(&left(other)));
    for (i, (line, [a, b])) in edges.iter().enumerate() {
        let right = a[0].max(b[0]);
        let following = edges[i + 1..].iter();
        for (other, [c, d]) in following.take_while(|edge| left(edge) <= right) {
            // Neighbours have a point in common; they cross where one runs back on the other.
            if line == other && b == c {
                if a != d && distance([*a, *b], *d) == 0.0 {
                    return Some(*d);
                }
                continue;
            }
            if line == other && d == a {
                continue;
            }
            let side = |[a, b]: [[f64; 2]; 2], p: [f64; 2]| {
                (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
            };
            let [s, t] = [side([*a, *b], *c), side([*a, *b], *d)];
            let [u, v] = [side([*c, *d], *a), side([*c, *d], *b)];
            let apart = |p: f64, q: f64| p * q > 0.0;
            let aligned = s == 0.0 && t == 0.0;
            let touching = |[p, q]: [[f64; 2]; 2], point| distance([p, q], point) == 0.0;
            let overlap =
                touching([*a, *b], *c) || touching([*a, *b], *d) || touching([*c, *d], *a);
            if !apart(s, t) && !apart(u, v) && (!aligned || overlap) {
                let share = if s == t { 0.0 } else { s / (s - t) };
                return Some([0, 1].map(|axis| c[axis] + share * (d[axis] - c[axis])));
            }
        }
    }
    None
}
