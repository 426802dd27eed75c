//! The sides of all cells, sorted by their ends: which cells meet at each, and which of them make up the boundary.

use std::collections::HashSet;

use super::finding::Finding;
use crate::error::Diagnostic;
use crate::mesh::cells::Mesh;
use crate::mesh::refine::key;

/// A side of a cell.
#[derive(Clone, Copy)]
pub struct Side {
    /// Begin and end, with the cell to the left.
    pub ends: [usize; 2],
    /// The node in its middle.
    pub middle: Option<usize>,
}

/// All sides of a mesh's cells, except some cells.
pub struct Sides<'a> {
    pub mesh: &'a Mesh,
    /// Sorted by their ends.
    all: Vec<Side>,
    /// The cells that are left out.
    again: &'a HashSet<usize>,
}

impl<'a> Sides<'a> {
    pub fn new(mesh: &'a Mesh, again: &'a HashSet<usize>) -> Self {
        let edges = mesh.edges().into_iter();
        let edges = edges.filter(|edge| !again.contains(&edge.cell));
        let side = |nodes: Vec<usize>| Side {
            ends: [nodes[0], nodes[1]],
            middle: nodes.get(2).copied(),
        };
        let all = edges.map(|edge| side(mesh.edge_nodes(edge))).collect();
        Self { mesh, all, again }
    }

    /// The sides with the same ends.
    fn meeting(&self) -> impl Iterator<Item = &[Side]> {
        let ends = |side: &Side| key(side.ends[0], side.ends[1]);
        self.all
            .chunk_by(move |one, other| ends(one) == ends(other))
    }

    /// The cells that are counted.
    pub fn cells(&self) -> impl Iterator<Item = usize> {
        (0..self.mesh.cell_count()).filter(|cell| !self.again.contains(cell))
    }

    /// The sides of one cell alone.
    pub fn boundary(&self) -> Vec<Side> {
        let alone = self.meeting().filter(|sides| sides.len() == 1);
        alone.map(|sides| sides[0]).collect()
    }

    /// Half way between the ends of a side.
    pub fn position(&self, side: Side) -> [f64; 2] {
        let [a, b] = side.ends.map(|node| self.mesh.nodes[node]);
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    }

    /// Sides where cells overlap or do not match.
    pub fn faults(&self) -> Vec<Diagnostic> {
        let overlapping = self.meeting().filter(|sides| {
            sides.len() > 2 || (sides.len() == 2 && sides[0].ends == sides[1].ends)
        });
        let overlapping = Finding::of(overlapping.map(|sides| self.position(sides[0]))).error(
            [
                "side has cells that overlap: two on the same side of it",
                "sides have cells that overlap: two on the same side of each",
            ],
            "remove one of the cells; surfaces that coincide must be joined before they are meshed (Coherence in Gmsh)",
        );
        let apart = self
            .meeting()
            .filter(|sides| sides.len() == 2 && sides[0].middle != sides[1].middle);
        let apart = Finding::of(apart.map(|sides| self.position(sides[0]))).error(
            [
                "side has another node in its middle for each of its two cells",
                "sides have another node in their middle for each of their two cells",
            ],
            "merge nodes at the same place (merge_nodes, --merge-nodes), or mesh with one order of elements",
        );
        overlapping.into_iter().chain(apart).collect()
    }
}
