//! A sheet with the states at its nodes, on either side where materials meet.

use std::borrow::Cow;

use super::state::{LocalState, nodal_states, states_within_parts};
use crate::mesh::Mesh;
use crate::problem::SheetLaws;

/// A sheet on a mesh with the states at its nodes; between cells of different laws, where stresses jump, the mesh is cut.
pub struct NodalSheet<'a> {
    /// The mesh.
    pub mesh: Cow<'a, Mesh>,
    /// ux, uy of node after node in mm.
    pub displacement: Cow<'a, [f64]>,
    /// The states of node after node.
    pub states: Vec<LocalState>,
}

impl<'a> NodalSheet<'a> {
    /// The sheet of some displacement fields and viscous stresses as [`LocalState::of`] takes them.
    pub fn new(
        laws: SheetLaws,
        mesh: &'a Mesh,
        fields: &[&'a [f64]],
        viscous: &[[f64; 4]],
    ) -> Self {
        let laws = laws.in_cells(mesh);
        let Some(cut) = laws.cut(mesh) else {
            return Self {
                states: nodal_states(&laws, mesh, fields, viscous),
                mesh: Cow::Borrowed(mesh),
                displacement: Cow::Borrowed(fields.last().copied().unwrap_or_default()),
            };
        };
        let mut cut_fields: Vec<Vec<f64>> = fields.iter().map(|field| cut.field(field)).collect();
        let fields: Vec<&[f64]> = cut_fields.iter().map(Vec::as_slice).collect();
        Self {
            states: states_within_parts(&laws, &cut.mesh, &fields),
            mesh: Cow::Owned(cut.mesh),
            displacement: Cow::Owned(cut_fields.pop().unwrap_or_default()),
        }
    }
}
