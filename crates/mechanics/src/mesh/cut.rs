//! A mesh cut along the lines between parts of its cells, for fields whose gradients jump there.

use std::collections::BTreeMap;

use super::cells::Mesh;

/// A mesh whose parts share no node. Its cells have the numbers and positions of those of the mesh that was cut; it has no groups.
#[derive(Clone, Debug)]
pub struct CutMesh {
    /// The mesh.
    pub mesh: Mesh,
    /// The node of the mesh that was cut at which each node lies.
    pub originals: Vec<usize>,
}

impl Mesh {
    /// The mesh cut between cells of different parts, given by a number for each cell.
    pub fn cut_between(&self, parts: &[u8]) -> CutMesh {
        let mut numbers = BTreeMap::new();
        for (cell, part) in parts.iter().enumerate() {
            let nodes = self.cell(cell).iter();
            numbers.extend(nodes.map(|node| ((*node, *part), 0)));
        }
        let mut originals = Vec::with_capacity(numbers.len());
        for ((node, _), number) in &mut numbers {
            *number = originals.len();
            originals.push(*node);
        }
        let cells = parts.iter().enumerate().map(|(cell, part)| {
            let nodes = self.cell(cell).iter().map(|node| numbers[&(*node, *part)]);
            (self.shape(cell), nodes.collect())
        });
        let nodes = originals.iter().map(|node| self.nodes[*node]);
        CutMesh {
            mesh: Self::new(nodes.collect(), cells),
            originals,
        }
    }
}

impl CutMesh {
    /// A field, ux, uy of node after node of the mesh that was cut, at the nodes of this one.
    pub fn field(&self, displacement: &[f64]) -> Vec<f64> {
        let nodes = self.originals.iter();
        let components =
            nodes.flat_map(|node| [displacement[2 * node], displacement[2 * node + 1]]);
        components.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellShape;

    #[test]
    fn parts_share_no_node_and_keep_cells_and_fields() {
        let mesh = Mesh::plate([4.0, 2.0], [4, 2], CellShape::Quad9);
        let parts: Vec<u8> = (0..mesh.cell_count())
            .map(|cell| u8::from(mesh.centre(cell)[0] > 2.0))
            .collect();
        let cut = mesh.cut_between(&parts);
        // Five nodes lie on the line x = 2 mm.
        assert_eq!(cut.mesh.nodes.len(), mesh.nodes.len() + 5);
        let field: Vec<f64> = (0..2 * mesh.nodes.len()).map(|i| i as f64).collect();
        let moved = cut.field(&field);
        for cell in 0..mesh.cell_count() {
            for (node, original) in cut.mesh.cell(cell).iter().zip(mesh.cell(cell)) {
                assert_eq!(cut.mesh.nodes[*node], mesh.nodes[*original]);
                assert_eq!(moved[2 * node + 1], field[2 * original + 1]);
            }
        }
        let edges = mesh.boundary().len() + 4;
        assert_eq!(cut.mesh.boundary().len(), edges);
    }
}
