//! Local refinement of triangles by halving edges, the longest first.
//!
//! Every marked triangle is cut into four through the middles of its edges: the middle of the longest edge is joined
//! to the opposite corner and to the other two middles. A triangle one of whose edges is halved has its longest edge
//! halved too; all cells therefore meet edge to edge, and the smallest angle stays at least half of the first mesh's.
//!
//! # References
//! M. C. Rivara, Int. J. Numer. Methods Eng. 20, 745 (1984), doi:10.1002/nme.1620200412

use std::collections::HashSet;

use super::cell_shape::CellShape;
use super::cells::Mesh;
use super::refine::{Point, Subdivision, key};

/// An edge by its ends, the smaller first.
type Edge = [usize; 2];

impl Mesh {
    /// A mesh with its quadrilaterals halved along their shorter diagonals, which are lines of their maps.
    #[must_use]
    pub fn triangulated(&self) -> Self {
        let mut halved = Subdivision::new(self);
        for cell in 0..self.cell_count() {
            let shape = self.shape(cell);
            let [a, b, c, d] = match halved.corners(cell)[..] {
                [a, b, c, d] => [a, b, c, d],
                _ => {
                    halved.keep(cell);
                    continue;
                }
            };
            let half = match shape.degree() {
                1 => CellShape::Triangle3,
                _ => CellShape::Triangle6,
            };
            let first = self.squared_length([a.node, c.node]);
            let (pieces, diagonal) = if first <= self.squared_length([b.node, d.node]) {
                ([[a, b, c], [a, c, d]], [a, c])
            } else {
                ([[a, b, d], [b, c, d]], [b, d])
            };
            if let Some(centre) = self.cell(cell).get(8) {
                halved.put_between(diagonal.map(|point| point.node), *centre);
            }
            for piece in &pieces {
                halved.add(cell, half, piece);
            }
        }
        halved.finish(|_, edge| vec![edge.to_vec()])
    }

    /// A mesh of triangles in which the marked ones are cut into four, and their neighbours so that cells meet edge to
    /// edge. Groups are kept.
    ///
    /// # Panics
    /// When a cell is not a triangle.
    #[must_use]
    pub fn refined_where(&self, marked: &[bool]) -> Self {
        let halved = self.edges_to_halve(marked);
        let mut finer = Subdivision::new(self);
        for cell in 0..self.cell_count() {
            let [a, b, ..] = self.longest_first(cell);
            if halved.contains(&key(a, b)) {
                let mut points = finer.corners(cell);
                let first = points.iter().position(|point| point.node == a);
                points.rotate_left(first.unwrap_or(0));
                let points = [points[0], points[1], points[2]];
                cut(&mut finer, cell, self.shape(cell), points, &halved);
            } else {
                finer.keep(cell);
            }
        }
        finer.finish(|finer, edge| {
            if halved.contains(&key(edge[0], edge[1])) {
                finer.halves(edge)
            } else {
                vec![edge.to_vec()]
            }
        })
    }

    fn squared_length(&self, [a, b]: Edge) -> f64 {
        let (a, b) = (self.nodes[a], self.nodes[b]);
        (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
    }

    /// The corners of a triangle, turned so that its longest edge is the first.
    fn longest_first(&self, cell: usize) -> [usize; 3] {
        let [a, b, c]: [usize; 3] = self.corners(cell).try_into().expect("triangles");
        let length = |corners: &[usize; 3]| self.squared_length(key(corners[0], corners[1]));
        let turns = [[a, b, c], [b, c, a], [c, a, b]].into_iter();
        let longest = turns.max_by(|one, other| length(one).total_cmp(&length(other)));
        longest.expect("three edges")
    }

    /// All edges of the marked cells, and the longest one of every cell that has one of them.
    fn edges_to_halve(&self, marked: &[bool]) -> HashSet<Edge> {
        let edges = |[a, b, c]: [usize; 3]| [key(a, b), key(b, c), key(c, a)];
        let cells: Vec<[Edge; 3]> = (0..self.cell_count())
            .map(|cell| edges(self.longest_first(cell)))
            .collect();
        let pairs = cells.iter().zip(marked);
        let all = pairs.filter(|(_, marked)| **marked);
        let mut halved: HashSet<Edge> = all.flat_map(|(edges, _)| *edges).collect();
        loop {
            let before = halved.len();
            for edges in &cells {
                if edges.iter().any(|edge| halved.contains(edge)) {
                    halved.insert(edges[0]);
                }
            }
            if halved.len() == before {
                return halved;
            }
        }
    }
}

/// Cuts a triangle through the middle of its first edge, and its halves where their other edge is halved too.
fn cut(
    finer: &mut Subdivision,
    cell: usize,
    shape: CellShape,
    [a, b, c]: [Point; 3],
    halved: &HashSet<Edge>,
) {
    let middle = finer.middle(cell, a, b);
    for [from, to] in [[b, c], [c, a]] {
        if halved.contains(&key(from.node, to.node)) {
            let other = finer.middle(cell, from, to);
            finer.add(cell, shape, &[middle, from, other]);
            finer.add(cell, shape, &[middle, other, to]);
        } else {
            finer.add(cell, shape, &[middle, from, to]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::Shape;

    fn smallest_angle(mesh: &Mesh) -> f64 {
        let angle = |cell: usize, corner: usize| {
            let at = |i: usize| mesh.nodes[mesh.cell(cell)[(corner + i) % 3]];
            let direction = |i: usize| [0, 1].map(|axis| at(i)[axis] - at(0)[axis]);
            let ([ax, ay], [bx, by]) = (direction(1), direction(2));
            (ax * by - ay * bx).atan2(ax * bx + ay * by)
        };
        let cells = 0..mesh.cell_count();
        let angles = cells.flat_map(|cell| (0..3).map(move |corner| angle(cell, corner)));
        angles.fold(f64::INFINITY, f64::min)
    }

    fn area(mesh: &Mesh) -> f64 {
        let cells = 0..mesh.cell_count();
        cells
            .map(|cell| 0.5 * mesh.gradients(cell, [0.3; 2]).1)
            .sum()
    }

    #[test]
    fn cells_meet_edge_to_edge_and_groups_are_kept_however_often_one_corner_is_refined() {
        let shape = Shape::StripWithHole {
            size: [30.0, 10.0],
            radius: 2.5,
        };
        let first = shape.mesh(6, CellShape::Quad4).triangulated();
        let mut mesh = first.clone();
        let mut reach = 3.0;
        for _ in 0..12 {
            reach *= 0.6;
            let near = |cell: usize| {
                let [x, y] = mesh.centre(cell);
                x.hypot(y + 5.0) < reach
            };
            let marked: Vec<bool> = (0..mesh.cell_count()).map(near).collect();
            mesh = mesh.refined_where(&marked);
        }
        assert!(mesh.cell_count() > 2 * first.cell_count());
        // An edge that is not whole on both sides would be boundary.
        let length = |mesh: &Mesh, edges: &[Vec<usize>]| -> f64 {
            let lengths = edges
                .iter()
                .map(|edge| mesh.squared_length([edge[0], edge[1]]));
            lengths.map(f64::sqrt).sum()
        };
        let [before, after] = [&first, &mesh].map(|mesh| length(mesh, mesh.boundary()));
        assert!((before - after).abs() < 1e-10, "{before} {after}");
        for (name, group) in first.groups() {
            let after = length(&mesh, &mesh.groups()[name].edges);
            assert!(
                (length(&first, &group.edges) - after).abs() < 1e-10,
                "{name}"
            );
            let edges = &mesh.groups()[name].edges;
            assert!(
                edges.iter().all(|edge| mesh.boundary().contains(edge)),
                "{name}"
            );
        }
        let [before, after] = [&first, &mesh].map(area);
        assert!((before - after).abs() < 1e-10, "{before} {after}");
        let [before, after] = [&first, &mesh].map(smallest_angle);
        assert!(after > 0.499 * before, "{before} {after}");
    }

    #[test]
    fn marked_cells_become_four_and_nothing_happens_without_marks() {
        let mesh = Shape::Strip { size: [4.0, 2.0] }.mesh(2, CellShape::Triangle3);
        let same = mesh.refined_where(&vec![false; mesh.cell_count()]);
        assert_eq!((&same.nodes, same.groups()), (&mesh.nodes, mesh.groups()));
        assert!((0..mesh.cell_count()).all(|cell| same.cell(cell) == mesh.cell(cell)));
        let all = mesh.refined_where(&vec![true; mesh.cell_count()]);
        assert_eq!(all.cell_count(), 4 * mesh.cell_count());
    }
}
