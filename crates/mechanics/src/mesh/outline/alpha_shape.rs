//! The lines around scattered points: the boundary of the small Delaunay triangles.

use std::collections::{BTreeMap, HashMap};

use super::fault::OutlineFault;
use crate::mesh::cell_shape::CellShape;
use crate::mesh::cells::{Mesh, Neighbours};
use crate::mesh::geometry::{distance, polygon_area};
use crate::mesh::parts::Parts;
use crate::mesh::triangulate::delaunay;
use crate::statistics::median;

/// Circles of triangles up to so many spacings are inside.
const RADIUS: f64 = 1.9;

/// A part with a smaller share of the area is a stray group of points.
const STRAY: f64 = 0.02;

/// The points of a closed line.
type Line = Vec<[f64; 2]>;

/// The closed lines around different points, those around holes clockwise, and the points' spacing. Circles are larger than
/// usual by the factor `wider`.
pub fn lines(points: &[[f64; 2]], wider: f64) -> Result<(Vec<Line>, f64), OutlineFault> {
    let triangles = delaunay(points);
    if triangles.is_empty() {
        return Err(OutlineFault::OneLine);
    }
    let spacing = median_edge(points, &triangles);
    let small = |triangle: &[usize; 3]| radius(points, triangle) < wider * RADIUS * spacing;
    let mut inside: Vec<bool> = triangles.iter().map(small).collect();
    let cells = triangles
        .iter()
        .map(|corners| (CellShape::Triangle3, corners.to_vec()));
    let adjacent = Mesh::new(points.to_vec(), cells).neighbours();
    mend_touching(&triangles, &adjacent, &mut inside);
    largest_part(points, &triangles, &adjacent, &mut inside)?;
    let boundary = boundary_edges(&triangles, &adjacent, &inside);
    let lines = boundary_lines(boundary).into_iter();
    let positions = lines.map(|line| line.iter().map(|point| points[*point]).collect());
    Ok((positions.collect(), spacing))
}

fn median_edge(points: &[[f64; 2]], triangles: &[[usize; 3]]) -> f64 {
    let edges = triangles
        .iter()
        .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    // An edge between two triangles is counted once.
    let edges = edges.filter(|[a, b]| a < b);
    median(edges.map(|[a, b]| distance(points[*a], points[*b])))
}

/// The radius of the circle through the corners of a triangle.
fn radius(points: &[[f64; 2]], triangle: &[usize; 3]) -> f64 {
    let [a, b, c] = triangle.map(|point| points[point]);
    let twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| distance(a, b));
    sides.iter().product::<f64>() / (2.0 * twice.abs())
}

/// The edges of triangles inside without one at their other side, by their first point, inside to the left.
fn boundary_edges(
    triangles: &[[usize; 3]],
    adjacent: &Neighbours,
    inside: &[bool],
) -> Vec<[usize; 2]> {
    let kept = (0..triangles.len()).filter(|triangle| inside[*triangle]);
    let edges = kept.flat_map(|triangle| [0, 1, 2].map(|side| (triangle, side)));
    let open = edges.filter(|(triangle, side)| {
        !adjacent
            .across(*triangle, *side)
            .is_some_and(|other| inside[other])
    });
    open.map(|(triangle, side)| [side, (side + 1) % 3].map(|corner| triangles[triangle][corner]))
        .collect()
}

/// Where two lines of the boundary touch in a point, all triangles around it become inside.
fn mend_touching(triangles: &[[usize; 3]], adjacent: &Neighbours, inside: &mut [bool]) {
    loop {
        let mut leaving: HashMap<usize, usize> = HashMap::new();
        for [from, _] in boundary_edges(triangles, adjacent, inside) {
            *leaving.entry(from).or_default() += 1;
        }
        let mut changed = false;
        for (triangle, inside) in triangles.iter().zip(&mut *inside) {
            let touching = triangle
                .iter()
                .any(|point| leaving.get(point).is_some_and(|n| *n > 1));
            if touching && !*inside {
                (*inside, changed) = (true, true);
            }
        }
        if !changed {
            return;
        }
    }
}

/// Leaves the largest connected part inside; others must be small.
fn largest_part(
    points: &[[f64; 2]],
    triangles: &[[usize; 3]],
    adjacent: &Neighbours,
    inside: &mut [bool],
) -> Result<(), OutlineFault> {
    let mut parts = Parts::new(triangles.len());
    for triangle in (0..triangles.len()).filter(|triangle| inside[*triangle]) {
        for next in (0..3).filter_map(|side| adjacent.across(triangle, side)) {
            if inside[next] {
                parts.join(triangle, next);
            }
        }
    }
    let part: Vec<usize> = (0..triangles.len())
        .map(|index| parts.first(index))
        .collect();
    let mut areas: BTreeMap<usize, f64> = BTreeMap::new();
    for triangle in (0..triangles.len()).filter(|triangle| inside[*triangle]) {
        let corners = triangles[triangle].map(|point| points[point]);
        *areas.entry(part[triangle]).or_default() += polygon_area(&corners);
    }
    let largest = areas.iter().max_by(|a, b| a.1.total_cmp(b.1));
    let Some((&largest, _)) = largest else {
        return Err(OutlineFault::TooFarApart);
    };
    let total: f64 = areas.values().sum();
    let mut others = areas.iter().filter(|(first, _)| **first != largest);
    if let Some((&first, _)) = others.find(|(_, area)| **area > STRAY * total) {
        return Err(OutlineFault::SeparatedPoints(points[triangles[first][0]]));
    }
    for (inside, part) in inside.iter_mut().zip(&part) {
        *inside &= *part == largest;
    }
    Ok(())
}

/// The closed lines of the boundary, in the order of their first points.
fn boundary_lines(edges: Vec<[usize; 2]>) -> Vec<Vec<usize>> {
    let mut next: BTreeMap<usize, usize> = edges.into_iter().map(|[a, b]| (a, b)).collect();
    let mut lines = Vec::new();
    while let Some((start, mut point)) = next.pop_first() {
        let mut line = vec![start];
        while point != start {
            line.push(point);
            let Some(following) = next.remove(&point) else {
                break;
            };
            point = following;
        }
        lines.push(line);
    }
    lines
}
