//! VTK's unstructured grids.

use super::raw::{ImportFault, Raw};
use crate::mesh::cell_shape::CellShape;

/// Cell arrays in which meshio and Gmsh keep the numbers of physical groups.
const GROUPS: [&str; 3] = ["gmsh:physical", "physical", "CellEntityIds"];

/// VTK's numbers of the kinds of cells that are no faces.
const VERTICES: [u8; 2] = [1, 2];
const LINES: [u8; 3] = [3, 21, 68];

pub const CUT_OFF: &str = "has a list of cells that is cut off";

/// An unstructured grid as it stands in a file.
pub struct UnstructuredGrid {
    /// Three coordinates of point after point.
    pub points: Vec<f64>,
    /// VTK's number of each cell's kind, and its points.
    pub cells: Vec<(u8, Vec<u64>)>,
    /// Arrays of numbers at the points, by name.
    pub point_arrays: Arrays,
    /// Arrays of numbers at the cells, by name.
    pub cell_arrays: Arrays,
}

/// Arrays of numbers by name: all components of point after point, or of cell after cell.
pub type Arrays = Vec<(String, Vec<f64>)>;

impl UnstructuredGrid {
    /// The faces, and the named lines and parts.
    pub fn raw(&self) -> Result<Raw, ImportFault> {
        let mut raw = Raw::default();
        for (name, position) in (0..).zip(self.points.chunks_exact(3)) {
            raw.positions
                .insert(name, [position[0], position[1], position[2]]);
        }
        let mut named = self.cell_arrays.iter();
        let groups = named.find(|(name, _)| GROUPS.contains(&&**name));
        for (index, (kind, nodes)) in self.cells.iter().enumerate() {
            if VERTICES.contains(kind) {
                continue;
            }
            let tag = groups.and_then(|(_, tags)| tags.get(index));
            let group = tag.map(|tag| format!("physical-{tag}"));
            if LINES.contains(kind) {
                if let (Some(group), [a, b, ..]) = (group, &nodes[..]) {
                    raw.lines.entry(group).or_default().push([*a, *b]);
                }
                continue;
            }
            // Gmsh's number of cells in no group.
            if let Some(group) = group.filter(|_| tag != Some(&0.0)) {
                raw.areas.entry(group).or_default().push(raw.cells.len());
            }
            raw.cells.push((shape(*kind, nodes.len())?, nodes.clone()));
        }
        Ok(raw)
    }
}

/// The kind of a face by VTK's number.
fn shape(kind: u8, nodes: usize) -> Result<CellShape, ImportFault> {
    let shape = match (CellShape::of_vtk_number(kind), kind, nodes) {
        (Some(shape), ..) => shape,
        // Lagrange's triangles and quadrilaterals.
        (_, 69, 3) => CellShape::Triangle3,
        (_, 69, 6) => CellShape::Triangle6,
        (_, 70, 4) => CellShape::Quad4,
        (_, 70, 9) => CellShape::Quad9,
        _ => {
            return Err(format!(
                "has cells of VTK's kind {kind} with {nodes} nodes; triangles of three and six nodes and \
                 quadrilaterals of four, eight and nine can be read"
            ).into());
        }
    };
    if nodes != shape.nodes() {
        let belong = shape.nodes();
        return Err(format!("has a cell of {nodes} nodes where {belong} belong").into());
    }
    Ok(shape)
}
