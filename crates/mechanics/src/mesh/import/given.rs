//! Meshes that another program hands over in memory.

use std::collections::BTreeMap;

use super::raw::Raw;
use super::{MeshReading, sound, unreadable};
use crate::error::Diagnostic;
use crate::mesh::cell_shape::CellShape;
use crate::mesh::cells::Mesh;

/// Nodes, cells and groups as another program has them.
#[derive(Clone, Debug, Default)]
pub struct MeshData {
    /// The positions of the nodes, in the unit that the [reading](MeshReading) names; z is the same everywhere.
    pub positions: Vec<[f64; 3]>,
    /// The cells: the numbers of their nodes among `positions`, in VTK's order.
    pub cells: Vec<(CellShape, Vec<usize>)>,
    /// Parts of the boundary by name: both ends of each line.
    pub lines: BTreeMap<String, Vec<[usize; 2]>>,
    /// Nodes by name; the edges of the boundary between them belong to the group.
    pub nodes: BTreeMap<String, Vec<usize>>,
}

/// Its name in messages.
const NAME: &str = "the mesh";

impl MeshData {
    /// Makes a mesh of it as [`import`](super::import()) does of a file. Nodes that belong to no cell are left out; the others keep their order.
    ///
    /// # Errors
    /// Every kind of fault of the mesh, see [`Mesh::faults`]; cells with a wrong number of nodes, groups without nodes.
    pub fn read(&self, reading: MeshReading) -> Result<(Mesh, Vec<Diagnostic>), Vec<Diagnostic>> {
        let mut cells = self.cells.iter();
        if let Some(cell) = cells.position(|(shape, nodes)| nodes.len() != shape.nodes()) {
            let reason = format!("has the cell {cell} with a wrong number of nodes");
            return Err(unreadable(NAME, reason.into()));
        }
        sound(self.raw(), NAME, reading)
    }

    fn raw(&self) -> Raw {
        let positions = self.positions.iter().enumerate();
        let cells = self.cells.iter();
        let lines = |ends: &Vec<[usize; 2]>| {
            let ends = ends.iter();
            ends.map(|ends| ends.map(|end| end as u64)).collect()
        };
        Raw {
            positions: positions
                .map(|(node, position)| (node as u64, *position))
                .collect(),
            cells: cells
                .map(|(shape, nodes)| (*shape, numbers(nodes)))
                .collect(),
            lines: by_name(&self.lines, lines),
            sets: by_name(&self.nodes, |nodes| numbers(nodes)),
            ..Raw::default()
        }
    }
}

fn numbers(nodes: &[usize]) -> Vec<u64> {
    nodes.iter().map(|node| *node as u64).collect()
}

fn by_name<T, U>(groups: &BTreeMap<String, T>, of: impl Fn(&T) -> U) -> BTreeMap<String, U> {
    let groups = groups.iter();
    groups
        .map(|(name, group)| (name.clone(), of(group)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> MeshData {
        let positions = [[9.0, 9.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        MeshData {
            positions: positions.map(|[x, y]| [x, y, 2.0]).to_vec(),
            cells: vec![(CellShape::Quad4, vec![1, 2, 3, 4])],
            ..MeshData::default()
        }
    }

    #[test]
    fn a_mesh_in_memory_has_its_own_groups_and_those_of_its_box() {
        let mut data = square();
        data.nodes.insert("base".into(), vec![0, 1, 2]);
        data.lines.insert("side".into(), vec![[3, 2]]);
        let (mesh, warnings) = data.read(MeshReading::in_unit(10.0)).unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(mesh.nodes[2], [10.0, 10.0]);
        assert_eq!(mesh.groups()["base"].edges, mesh.groups()["bottom"].edges);
        assert_eq!(mesh.groups()["side"].edges, mesh.groups()["right"].edges);
    }

    #[test]
    fn groups_without_nodes_and_cells_of_a_wrong_size_are_told() {
        let mut data = square();
        data.nodes.insert("nothing".into(), vec![0]);
        let faults = data.read(MeshReading::in_unit(1.0)).unwrap_err();
        assert!(faults[0].message.contains("`nothing`"), "{faults:?}");
        data.cells[0].1.pop();
        let faults = data.read(MeshReading::in_unit(1.0)).unwrap_err();
        assert!(faults[0].message.contains("the cell 0"), "{faults:?}");
    }
}
