//! A file with a whole specimen: its fields, thickness and mesh in a section, and what is known besides.

use std::path::{Path, PathBuf};

use super::conditions::Conditions;
use super::request::{MeshSource, Request};
use crate::document::{Bound, Section};
use crate::mesh::MeshReading;
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

/// Reads the section.
pub fn read(section: &Section) -> SpecimenFile {
    let path = |key| section.has(key).then(|| PathBuf::from(section.text(key)));
    let length = |key| {
        let has = section.has(key);
        has.then(|| section.quantity(key, Dimension::Length, Bound::Positive))
    };
    let mesh = path("mesh");
    let mesh_unit = length("mesh_unit").unwrap_or(1.0);
    let found = SpecimenFile {
        name: section.has("name").then(|| section.text("name")),
        fields: section
            .texts("fields")
            .into_iter()
            .map(PathBuf::from)
            .collect(),
        thickness: section.quantity("thickness", Dimension::Length, Bound::Positive),
        unit: length("unit"),
        mesh: mesh.map(|mesh| (mesh, mesh_unit)),
        outline: path("outline"),
        forces: path("forces"),
        cell_size: length("cell_size"),
    };
    if found.mesh.is_some() && found.outline.is_some() {
        section.fault("outline", "stands beside a mesh", "leave out one of them");
    }
    section.unknown_keys();
    found
}

impl SpecimenFile {
    /// A request like another one, for this specimen; paths are relative to `folder`.
    pub fn request(&self, folder: &Path, conditions: Conditions, like: &Request) -> Request {
        let at = |path: &PathBuf| folder.join(path);
        let mut reading = like.reading.clone();
        reading.unit = self.unit.or(reading.unit);
        Request {
            files: self.fields.iter().map(at).collect(),
            reading,
            thickness: self.thickness,
            mesh: match (&self.mesh, &self.outline) {
                (Some((mesh, unit)), _) => MeshSource::File(at(mesh), MeshReading::in_unit(*unit)),
                (None, Some(outline)) => MeshSource::Outline(at(outline)),
                (None, None) => MeshSource::Data,
            },
            cell_size: self.cell_size.or(like.cell_size),
            conditions,
            forces: self.forces.as_ref().map(at),
            ..like.clone()
        }
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
