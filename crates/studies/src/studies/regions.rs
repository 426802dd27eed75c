//! The regions of a mesh: its groups of cells, of which each may have a material of its own.

use crate::mesh::Mesh;

/// The names of the regions of a mesh: groups of some of its cells.
pub fn regions_of(mesh: &Mesh) -> Vec<&str> {
    let groups = mesh.groups().iter();
    let regions = groups.filter(|(_, group)| !group.cells.is_empty());
    regions.map(|(name, _)| &**name).collect()
}

/// The words for the parts into which all cells of a mesh are divided, as for several materials.
pub fn divided(mesh: &Mesh) -> Option<String> {
    let parts = regions_of(mesh).into_iter();
    let parts = parts.filter(|name| mesh.groups()[*name].cells.len() < mesh.cell_count());
    let parts: Vec<&str> = parts.collect();
    let cells = parts.iter().map(|name| mesh.groups()[*name].cells.len());
    let names = parts.iter().map(|name| format!("`{name}`"));
    (cells.sum::<usize>() == mesh.cell_count()).then(|| names.collect::<Vec<_>>().join(", "))
}
