//! A file that describes a specimen: its fields, thickness and mesh in a section, beside the known conditions.

use std::path::{Path, PathBuf};

use crate::document::{Bound, Section};
use crate::units::Dimension;

/// What the section `[specimen]` holds; paths are relative to the file.
#[derive(Clone, Debug, Default)]
pub struct SpecimenFile {
    /// The specimen's name; that of the file where it is left out.
    pub name: Option<String>,
    /// The files of the field.
    pub fields: Vec<PathBuf>,
    /// Thickness at rest in mm.
    pub thickness: f64,
    /// The field's unit in mm where the files do not say it.
    pub unit: Option<f64>,
    /// The specimen's mesh, and its unit in mm.
    pub mesh: Option<(PathBuf, f64)>,
    /// The specimen's edge as a table.
    pub outline: Option<PathBuf>,
    /// A testing machine's table.
    pub forces: Option<PathBuf>,
    /// Size of the cells of a mesh that is made, in mm.
    pub cell_size: Option<f64>,
}

impl SpecimenFile {
    pub(super) fn read(section: &Section) -> Self {
        let path = |key| section.stated(key, Section::text).map(PathBuf::from);
        let length = |key| section.optional_quantity(key, Dimension::Length, Bound::Positive);
        let mesh = path("mesh");
        let mesh_unit = length("mesh_unit").unwrap_or(1.0);
        let file = Self {
            name: section.stated("name", Section::text),
            fields: section.texts("fields").iter().map(PathBuf::from).collect(),
            thickness: section.quantity("thickness", Dimension::Length, Bound::Positive),
            unit: length("unit"),
            mesh: mesh.map(|mesh| (mesh, mesh_unit)),
            outline: path("outline"),
            forces: path("forces"),
            cell_size: length("cell_size"),
        };
        if file.mesh.is_some() && file.outline.is_some() {
            section.fault(
                "outline",
                "must not be given together with a mesh",
                "leave out one of them",
            );
        }
        section.unknown_keys();
        file
    }

    /// The files that it names, relative to `folder`.
    pub fn inputs<'a>(&'a self, folder: &'a Path) -> impl Iterator<Item = PathBuf> + 'a {
        let mesh = self.mesh.iter().map(|(mesh, _)| mesh);
        let others = self.outline.iter().chain(&self.forces);
        self.fields
            .iter()
            .chain(mesh)
            .chain(others)
            .map(|path| folder.join(path))
    }
}
