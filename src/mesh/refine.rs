//! Finer meshes and meshes of higher degree with the same outline.

use std::collections::HashMap;

use super::{CellShape, Mesh};

impl Mesh {
    /// The mesh of the corners alone.
    #[must_use]
    pub fn linear(&self) -> Self {
        let cells = (0..self.cell_count()).map(|cell| {
            let shape = self.shape(cell);
            (shape.linear(), self.cell(cell)[..shape.corners()].to_vec())
        });
        let mut names = vec![usize::MAX; self.nodes.len()];
        let mut nodes = Vec::new();
        let cells: Vec<_> = cells
            .map(|(shape, corners)| {
                let corners = corners.into_iter().map(|node| {
                    if names[node] == usize::MAX {
                        names[node] = nodes.len();
                        nodes.push(self.nodes[node]);
                    }
                    names[node]
                });
                (shape, corners.collect())
            })
            .collect();
        let mut mesh = Self::new(nodes, cells);
        for (name, group) in self.groups() {
            let edges = group.edges.iter();
            let edges: Vec<_> = edges
                .map(|edge| vec![names[edge[0]], names[edge[1]]])
                .collect();
            let kept = group.nodes.iter().map(|node| names[*node]);
            let nodes = kept.filter(|node| *node != usize::MAX).collect();
            mesh.put_group(name, nodes, edges);
        }
        mesh
    }

    /// Every cell of a mesh of linear cells cut into four through the middles of its edges.
    #[must_use]
    pub fn refined(&self) -> Self {
        let mut middles = Middles::new(self.nodes.clone());
        let mut cells = Vec::with_capacity(4 * self.cell_count());
        for cell in 0..self.cell_count() {
            let (shape, corners) = (self.shape(cell), self.cell(cell));
            let count = shape.corners();
            let middle: Vec<usize> = (0..count)
                .map(|i| middles.of(corners[i], corners[(i + 1) % count]))
                .collect();
            if shape.is_triangle() {
                for i in 0..3 {
                    cells.push((shape, vec![corners[i], middle[i], middle[(i + 2) % 3]]));
                }
                cells.push((shape, middle));
            } else {
                let centre = middles.centre(corners);
                for i in 0..4 {
                    cells.push((
                        shape,
                        vec![corners[i], middle[i], centre, middle[(i + 3) % 4]],
                    ));
                }
            }
        }
        middles.finish(self, cells, |middles, [from, to]| {
            let middle = middles.of(from, to);
            vec![vec![from, middle], vec![middle, to]]
        })
    }

    /// A mesh of linear cells with nodes in the middle of its straight edges: six-node triangles and nine-node
    /// quadrilaterals.
    #[must_use]
    pub fn quadratic(&self) -> Self {
        let mut middles = Middles::new(self.nodes.clone());
        let cells = (0..self.cell_count()).map(|cell| {
            let corners = self.cell(cell);
            let count = corners.len();
            let mut nodes = corners.to_vec();
            nodes.extend((0..count).map(|i| middles.of(corners[i], corners[(i + 1) % count])));
            if count == 3 {
                return (CellShape::Triangle6, nodes);
            }
            nodes.push(middles.centre(corners));
            (CellShape::Quad9, nodes)
        });
        let cells: Vec<_> = cells.collect();
        middles.finish(self, cells, |middles, [from, to]| {
            vec![vec![from, to, middles.of(from, to)]]
        })
    }
}

/// Nodes in the middle of edges, each made once.
pub(super) struct Middles {
    nodes: Vec<[f64; 2]>,
    made: HashMap<[usize; 2], usize>,
}

impl Middles {
    pub(super) fn new(nodes: Vec<[f64; 2]>) -> Self {
        Self {
            nodes,
            made: HashMap::new(),
        }
    }

    /// The node in the middle of an edge.
    pub(super) fn of(&mut self, a: usize, b: usize) -> usize {
        let nodes = &mut self.nodes;
        *self.made.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            nodes.push([0, 1].map(|axis| 0.5 * (nodes[a][axis] + nodes[b][axis])));
            nodes.len() - 1
        })
    }

    /// The node in the middle of an edge, if it was made.
    pub(super) fn made(&self, a: usize, b: usize) -> Option<usize> {
        self.made.get(&[a.min(b), a.max(b)]).copied()
    }

    /// The mesh of some cells with the groups of the one that they were made from; `edges` makes an edge into those
    /// of the new mesh.
    pub(super) fn finish(
        mut self,
        from: &Mesh,
        cells: Vec<(CellShape, Vec<usize>)>,
        edges: impl Fn(&mut Self, [usize; 2]) -> Vec<Vec<usize>>,
    ) -> Mesh {
        let mut groups = Vec::new();
        for (name, group) in from.groups() {
            let (mut nodes, mut own) = (group.nodes.clone(), Vec::new());
            for edge in &group.edges {
                own.extend(edges(&mut self, [edge[0], edge[1]]));
            }
            nodes.extend(own.iter().flatten());
            groups.push((name, nodes, own));
        }
        let mut mesh = Mesh::new(self.nodes, cells);
        for (name, nodes, edges) in groups {
            mesh.put_group(name, nodes, edges);
        }
        mesh
    }

    fn centre(&mut self, corners: &[usize]) -> usize {
        let mean = |axis: usize| {
            corners
                .iter()
                .map(|node| self.nodes[*node][axis])
                .sum::<f64>()
                / corners.len() as f64
        };
        let centre = [mean(0), mean(1)];
        self.nodes.push(centre);
        self.nodes.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

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
}
