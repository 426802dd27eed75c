//! Finer meshes and meshes of another degree with the same outline.
//!
//! Every node of a finer mesh lies where the map of a cell of the first mesh has it: on the curved sides of six-,
//! eight- and nine-node cells, not on their chords.

use std::collections::HashMap;

use super::cell_shape::CellShape;
use super::cells::{Group, Mesh};

impl Mesh {
    /// The mesh with nodes at the corners alone.
    #[must_use]
    pub fn linear(&self) -> Self {
        let mut names = vec![usize::MAX; self.nodes.len()];
        let mut nodes = Vec::new();
        let cells: Vec<_> = (0..self.cell_count())
            .map(|cell| {
                let corners = self.corners(cell).iter().map(|node| {
                    if names[*node] == usize::MAX {
                        names[*node] = nodes.len();
                        nodes.push(self.nodes[*node]);
                    }
                    names[*node]
                });
                (self.shape(cell).linear(), corners.collect())
            })
            .collect();
        let mut mesh = Self::new(nodes, cells);
        for (name, group) in self.groups() {
            let straight = |sides: &[Vec<usize>]| -> Vec<Vec<usize>> {
                let ends = sides.iter().map(|side| [side[0], side[1]]);
                ends.map(|ends| ends.map(|node| names[node]).to_vec())
                    .collect()
            };
            let kept = group.nodes.iter().map(|node| names[*node]);
            let group = Group {
                nodes: kept.filter(|node| *node != usize::MAX).collect(),
                edges: straight(&group.edges),
                lines: straight(&group.lines),
                cells: group.cells.clone(),
            };
            mesh.put_group(name, group);
        }
        mesh
    }

    /// Every cell cut into four of its kind through the middles of its edges.
    #[must_use]
    pub fn refined(&self) -> Self {
        self.quartered().finish(Subdivision::halves)
    }

    /// The cells of [`Self::refined`], before they are a mesh.
    pub(super) fn quartered(&self) -> Subdivision<'_> {
        let mut finer = Subdivision::new(self);
        for cell in 0..self.cell_count() {
            let shape = self.shape(cell);
            let corners = finer.corners(cell);
            let count = corners.len();
            let middle: Vec<Point> = (0..count)
                .map(|i| finer.middle(cell, corners[i], corners[(i + 1) % count]))
                .collect();
            if shape.is_triangle() {
                for i in 0..3 {
                    finer.add(cell, shape, &[corners[i], middle[i], middle[(i + 2) % 3]]);
                }
                finer.add(cell, shape, &middle);
            } else {
                let centre = finer.centre(cell, &corners);
                for i in 0..4 {
                    let piece = [corners[i], middle[i], centre, middle[(i + 3) % 4]];
                    finer.add(cell, shape, &piece);
                }
            }
        }
        finer
    }

    /// The mesh with linear cells made into six-node triangles and nine-node quadrilaterals, their new nodes in the
    /// middle of straight edges; quadratic cells stay as they are.
    #[must_use]
    pub fn quadratic(&self) -> Self {
        let mut higher = Subdivision::new(self);
        for cell in 0..self.cell_count() {
            match self.shape(cell) {
                CellShape::Triangle3 => {
                    higher.add(cell, CellShape::Triangle6, &higher.corners(cell));
                }
                CellShape::Quad4 => higher.add(cell, CellShape::Quad9, &higher.corners(cell)),
                _ => higher.keep(cell),
            }
        }
        higher.finish(|higher, edge| vec![higher.with_middle(edge[0], edge[1])])
    }
}

/// A point of a cell that is a node: its number, and its natural coordinates in the cell.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub node: usize,
    local: [f64; 2],
}

/// The cells into which those of a mesh are cut, with the new nodes, each created once.
pub(super) struct Subdivision<'a> {
    mesh: &'a Mesh,
    pub nodes: Vec<[f64; 2]>,
    cells: Vec<(CellShape, Vec<usize>)>,
    /// The cell of which each one is a piece.
    parents: Vec<usize>,
    /// The nodes half way between two others along a line of a cell.
    middles: HashMap<[usize; 2], usize>,
}

impl<'a> Subdivision<'a> {
    /// No cells yet; cuts go through the mesh's own nodes in the middle of edges.
    pub fn new(mesh: &'a Mesh) -> Self {
        let mut middles = HashMap::new();
        for cell in 0..mesh.cell_count() {
            let nodes = mesh.cell(cell);
            for edge in mesh.shape(cell).edges() {
                if let [a, b, middle] = edge[..] {
                    middles.insert(key(nodes[a], nodes[b]), nodes[middle]);
                }
            }
        }
        Self {
            mesh,
            nodes: mesh.nodes.clone(),
            cells: Vec::new(),
            parents: Vec::new(),
            middles,
        }
    }

    /// The corners of a cell.
    pub fn corners(&self, cell: usize) -> Vec<Point> {
        let nodes = self.mesh.corners(cell).iter();
        nodes
            .zip(self.mesh.shape(cell).natural_nodes())
            .map(|(node, local)| Point {
                node: *node,
                local: *local,
            })
            .collect()
    }

    /// The point of a cell half way between two of its points.
    pub fn middle(&mut self, cell: usize, a: Point, b: Point) -> Point {
        let local = [0, 1].map(|axis| 0.5 * (a.local[axis] + b.local[axis]));
        let (nodes, mesh) = (&mut self.nodes, self.mesh);
        let node = *self.middles.entry(key(a.node, b.node)).or_insert_with(|| {
            nodes.push(mesh.position(cell, local));
            nodes.len() - 1
        });
        Point { node, local }
    }

    /// The point of a cell in the middle of four of its points.
    pub fn centre(&mut self, cell: usize, corners: &[Point]) -> Point {
        let mean = |axis: usize| corners.iter().map(|point| point.local[axis]).sum::<f64>() / 4.0;
        let local = [mean(0), mean(1)];
        let middle_node = self.mesh.cell(cell).get(8);
        let node = match middle_node.filter(|_| local == [0.0; 2]) {
            Some(node) => *node,
            None => {
                self.nodes.push(self.mesh.position(cell, local));
                self.nodes.len() - 1
            }
        };
        Point { node, local }
    }

    /// The node half way between two nodes, if there is one.
    pub fn between(&self, a: usize, b: usize) -> Option<usize> {
        self.middles.get(&key(a, b)).copied()
    }

    /// Records which node is half way between two nodes.
    pub fn put_between(&mut self, [a, b]: [usize; 2], middle: usize) {
        self.middles.insert(key(a, b), middle);
    }

    /// Adds a piece of a cell by its corners, with the other nodes of its kind.
    pub fn add(&mut self, cell: usize, shape: CellShape, corners: &[Point]) {
        let mut nodes: Vec<usize> = corners.iter().map(|point| point.node).collect();
        let count = corners.len();
        if shape.degree() == 2 {
            for i in 0..count {
                let middle = self.middle(cell, corners[i], corners[(i + 1) % count]);
                nodes.push(middle.node);
            }
        }
        if shape == CellShape::Quad9 {
            nodes.push(self.centre(cell, corners).node);
        }
        self.cells.push((shape, nodes));
        self.parents.push(cell);
    }

    /// Adds a cell as it is.
    pub fn keep(&mut self, cell: usize) {
        let nodes = self.mesh.cell(cell).to_vec();
        self.cells.push((self.mesh.shape(cell), nodes));
        self.parents.push(cell);
    }

    /// An edge with its middle.
    fn with_middle(&self, a: usize, b: usize) -> Vec<usize> {
        [a, b].into_iter().chain(self.between(a, b)).collect()
    }

    /// Both halves of an edge that was cut.
    pub fn halves(&self, edge: &[usize]) -> Vec<Vec<usize>> {
        let (a, b) = (edge[0], edge[1]);
        let middle = self
            .between(a, b)
            .expect("the middle of an edge that was cut");
        match edge.len() {
            2 => vec![vec![a, middle], vec![middle, b]],
            _ => vec![self.with_middle(a, middle), self.with_middle(middle, b)],
        }
    }

    /// The mesh, with the groups of the one that was cut; `edges` makes an edge into those of the new mesh.
    pub fn finish(self, edges: impl Fn(&Self, &[usize]) -> Vec<Vec<usize>>) -> Mesh {
        let divided = |sides: &[Vec<usize>]| -> Vec<Vec<usize>> {
            sides.iter().flat_map(|side| edges(&self, side)).collect()
        };
        let pieces = |cells: &[usize]| -> Vec<usize> {
            let is_within = |piece: &usize| cells.binary_search(&self.parents[*piece]).is_ok();
            if cells.is_empty() {
                Vec::new()
            } else {
                (0..self.parents.len()).filter(is_within).collect()
            }
        };
        let groups = self.mesh.groups().iter().map(|(name, group)| {
            let group = Group {
                nodes: group.nodes.clone(),
                edges: divided(&group.edges),
                lines: divided(&group.lines),
                cells: pieces(&group.cells),
            };
            (name, group)
        });
        let groups: Vec<_> = groups.collect();
        let mut mesh = Mesh::new(self.nodes, self.cells);
        for (name, group) in groups {
            mesh.put_group(name, group);
        }
        mesh
    }
}

/// An edge by its ends, the smaller first.
pub fn key(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::Shape;

    #[test]
    fn finer_and_quadratic_meshes_have_the_same_outline() {
        let shape = Shape::StripWithHole {
            size: [30.0, 10.0],
            radius: 2.5,
        };
        for kind in [CellShape::Triangle3, CellShape::Quad4] {
            let mesh = shape.mesh(4, kind);
            let (fine, high) = (mesh.refined(), mesh.refined().quadratic());
            assert_eq!(fine.cell_count(), 4 * mesh.cell_count());
            for other in [&fine, &high] {
                for (name, group) in mesh.groups() {
                    assert_eq!(
                        other.groups()[name].edges.len(),
                        2 * group.edges.len(),
                        "{name}"
                    );
                }
                let boundary = other.boundary().len();
                assert_eq!(boundary, 2 * mesh.boundary().len());
            }
            let back = high.linear();
            assert_eq!(
                (back.nodes.len(), back.cell_count()),
                (fine.nodes.len(), fine.cell_count())
            );
            for cell in 0..high.cell_count() {
                assert!(high.gradients(cell, high.shape(cell).centre()).1 > 0.0);
            }
        }
    }

    /// Half a ring, whose curved cells are cut along the lines of their own maps.
    #[test]
    fn curved_cells_keep_their_area_and_their_sides() {
        let shape = Shape::RingSector {
            radii: [10.0, 20.0],
            angle: 3.0,
        };
        for kind in [CellShape::Triangle6, CellShape::Quad8, CellShape::Quad9] {
            let mesh = shape.mesh(2, kind);
            let area = mesh.area();
            let fine = mesh.refined();
            let triangles = mesh.triangulated();
            let marked: Vec<bool> = (0..triangles.cell_count())
                .map(|cell| cell % 3 == 0)
                .collect();
            for other in [
                &fine,
                &fine.refined(),
                &triangles,
                &triangles.refined_where(&marked),
            ] {
                let error = (other.area() / area - 1.0).abs();
                assert!(error < 1e-12, "{kind:?}: {error}");
                assert_eq!(
                    other.element_names().contains("T2"),
                    other.shape(0).is_triangle()
                );
                assert_eq!(other.degree(), 2);
                assert!(other.faults(crate::mesh::Exemptions::default()).is_empty());
            }
            // Where the map of an edge has it, a quarter along: ⅜, ¾ and −⅛ of its nodes' positions.
            let edge = &mesh.groups()["inside"].edges[0];
            let [a, b, m] = [edge[0], edge[1], edge[2]].map(|node| mesh.nodes[node]);
            let quarter = [0, 1].map(|axis| 0.375 * a[axis] + 0.75 * m[axis] - 0.125 * b[axis]);
            let near = |node: &usize| {
                let position = fine.nodes[*node];
                (position[0] - quarter[0]).hypot(position[1] - quarter[1]) < 1e-12
            };
            assert!(fine.groups()["inside"].nodes.iter().any(near), "{kind:?}");
            let inside = &fine.groups()["inside"].edges;
            assert!(inside.iter().all(|edge| fine.boundary().contains(edge)));
        }
    }

    #[test]
    fn linear_cells_beside_quadratic_ones_share_their_middles() {
        let nodes = vec![
            [0.0, 0.0],
            [2.0, 0.0],
            [0.0, 2.0],
            [1.0, 0.0],
            [1.1, 1.1],
            [0.0, 1.0],
            [2.0, 2.0],
        ];
        let cells = [
            (CellShape::Triangle6, (0..6).collect()),
            (CellShape::Triangle3, vec![1, 6, 2]),
        ];
        let mesh = Mesh::new(nodes, cells).quadratic();
        assert_eq!(mesh.cell(1)[..3], [1, 6, 2]);
        assert_eq!((mesh.cell(1)[5], mesh.nodes.len()), (4, 9));
    }
}
