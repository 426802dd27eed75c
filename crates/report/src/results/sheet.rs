//! Sheets: the data that determine their stresses, and the states at their nodes.

use std::borrow::Cow;

use super::state::{LocalState, nodal_states, states_within_parts};
use super::viscous_stress::ViscousStress;
use crate::mesh::Mesh;
use crate::problem::SheetLaws;

/// The data that determine the stresses of a sheet.
#[derive(Clone, Copy)]
pub struct Sheet<'a> {
    /// The materials.
    pub laws: SheetLaws<'a>,
    /// Thickness in mm.
    pub thickness: f64,
    /// The earlier displacement fields, which a law with a memory remembers.
    pub past: &'a [&'a [f64]],
    /// The viscous part of the stresses; `None` where the material has none.
    pub viscous: Option<&'a ViscousStress>,
}

impl<'a> Sheet<'a> {
    /// Of an elastic material that remembers nothing yet.
    pub fn elastic(laws: SheetLaws<'a>, thickness: f64) -> Self {
        Self {
            laws,
            thickness,
            past: &[],
            viscous: None,
        }
    }

    /// The same after some displacement fields.
    #[must_use]
    pub fn after(self, past: &'a [&'a [f64]]) -> Self {
        Self { past, ..self }
    }

    /// The earlier fields and the present one.
    pub(super) fn fields(self, displacement: &'a [f64]) -> Vec<&'a [f64]> {
        let past = self.past.iter().copied();
        past.chain([displacement]).collect()
    }
}

/// A model with the data that determine its stresses.
pub struct Deformed<'a> {
    /// Its name.
    pub label: String,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Its displacement fields: the present one last, preceded by those that a law with a memory remembers.
    pub fields: Vec<&'a [f64]>,
    /// The viscous part of the first Piola–Kirchhoff stress at the nodes in MPa; empty where there is none.
    pub viscous: &'a [[f64; 4]],
}

impl<'a> Deformed<'a> {
    /// The model of an elastic material.
    pub fn elastic(label: impl Into<String>, mesh: &'a Mesh, fields: Vec<&'a [f64]>) -> Self {
        Self {
            label: label.into(),
            mesh,
            fields,
            viscous: &[],
        }
    }
}

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
    /// The states of a deformed model.
    pub fn new(laws: SheetLaws, model: &Deformed<'a>) -> Self {
        let (mesh, fields) = (model.mesh, &model.fields);
        let laws = laws.in_cells(mesh);
        let Some(cut) = laws.cut(mesh) else {
            return Self {
                states: nodal_states(&laws, mesh, fields, model.viscous),
                mesh: Cow::Borrowed(mesh),
                displacement: Cow::Borrowed(fields.last().copied().unwrap_or_default()),
            };
        };
        let mut fields: Vec<Vec<f64>> = fields.iter().map(|field| cut.field(field)).collect();
        Self {
            states: states_within_parts(&laws, &cut.mesh, &fields),
            mesh: Cow::Owned(cut.mesh),
            displacement: Cow::Owned(fields.pop().unwrap_or_default()),
        }
    }
}
