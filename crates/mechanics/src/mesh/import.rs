//! Meshes of other programs: Gmsh (ASCII, 2.2 and 4.1), Abaqus and CalculiX (`.inp`), and VTK (`.vtu`, `.vtk`).
//!
//! Lines with a physical group make up the named parts of the boundary. Regardless of the names in the file, the edges on the
//! four sides of the mesh's box are `left`, `right`, `bottom` and `top`, and all edges of the boundary `boundary`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::cells::Mesh;
use super::faults::Exemptions;
use crate::error::{Diagnostic, Severity};

mod abaqus;
mod field;
mod frd;
mod given;
mod gmsh;
mod pvd;
mod raw;
mod sides;
mod unstructured;
mod vtk;
mod vtu;

pub use raw::ImportFault;
use raw::{Raw, read_text};
use sides::doubtful_sides;

pub use field::{ImportedField, ImportedSeries, ImportedStep, import_field, import_series};
pub use given::MeshData;

/// How a mesh is read from a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshReading {
    /// The length of the file's unit in mm.
    pub unit: f64,
    /// Distance in mm up to which nodes are merged into one.
    pub merge_nodes: Option<f64>,
    /// Apparent faults that are intended.
    pub allowed: Exemptions,
    /// Whether the sheet is in plane strain, which elements may contradict; they are not compared where it is not known.
    pub is_plane_strain: Option<bool>,
}

impl MeshReading {
    /// Reads the file as it is and reports every fault.
    pub fn in_unit(unit: f64) -> Self {
        Self {
            unit,
            merge_nodes: None,
            allowed: Exemptions::default(),
            is_plane_strain: None,
        }
    }
}

/// Reads a mesh, with warnings. Cells with nodes in the middle of their sides keep them; linear cells in a mesh with such cells become quadratic.
///
/// # Errors
/// Contents of the file that cannot be read, or every kind of fault of its mesh, see [`Mesh::faults`].
pub fn import(
    path: &Path,
    reading: MeshReading,
) -> Result<(Mesh, Vec<Diagnostic>), Vec<Diagnostic>> {
    let name = path.display().to_string();
    let raw = read(path).map_err(|reason| unreadable(&name, reason))?;
    sound(raw, &name, reading)
}

fn unreadable(name: &str, reason: ImportFault) -> Vec<Diagnostic> {
    let hint =
        "a mesh file is Gmsh's .msh (ASCII, 2.2 or 4.1), Abaqus' .inp, .vtu or .vtk, and is flat";
    vec![Diagnostic::error("", format!("{name} {reason}")).hint(hint)]
}

/// A mesh without faults from the contents of `name`, with warnings.
fn sound(
    mut raw: Raw,
    name: &str,
    reading: MeshReading,
) -> Result<(Mesh, Vec<Diagnostic>), Vec<Diagnostic>> {
    raw.collapse_quadrilaterals();
    if let Some(tolerance) = reading.merge_nodes {
        raw.merge_nodes(tolerance / reading.unit);
    }
    let lost = raw.lines.clone();
    let areas: Vec<String> = raw.areas.keys().cloned().collect();
    let contradicts = raw.is_plane_strain && reading.is_plane_strain == Some(false);
    let mesh = raw.mesh(reading.unit);
    let mesh = mesh.map_err(|reason| unreadable(name, reason))?;
    let mut faults = mesh.faults(reading.allowed);
    let wrong = faults.iter().any(|fault| fault.severity == Severity::Error);
    if !wrong {
        faults.extend(lost_groups(&lost, &mesh));
        faults.extend(contradicts.then(plane_strain));
        let is_named =
            |side: &str| lost.contains_key(side) || areas.iter().any(|area| area == side);
        faults.extend(doubtful_sides(&mesh, is_named));
        if !reading.allowed.polygons {
            faults.extend(mesh.polygons().iter().map(|polygon| polygon.warning(&mesh)));
        }
    }
    for fault in &mut faults {
        fault.message = format!("{name}: {}", fault.message);
    }
    if wrong {
        return Err(faults);
    }
    let degree = mesh.degree();
    let mixed = (0..mesh.cell_count()).any(|cell| mesh.shape(cell).degree() < degree);
    Ok((if mixed { mesh.quadratic() } else { mesh }, faults))
}

fn read(path: &Path) -> Result<Raw, ImportFault> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("msh") => gmsh::read(&read_text(path)?),
        Some("inp") => abaqus::read(&read_text(path)?),
        Some("vtu" | "vtk") => vtk::read(path),
        _ => Err("is not a .msh, .inp, .vtu or .vtk file".into()),
    }
}

/// The warning about elements of plane strain.
fn plane_strain() -> Diagnostic {
    let message = "its elements are those of plane strain (CPE), and the sheet is in plane stress";
    let hint = "write sheet = \"plane-strain\" beside the card, or take elements CPS";
    Diagnostic::warning("", message).hint(hint)
}

/// Warnings about lines in groups that are not edges of the boundary.
fn lost_groups(groups: &BTreeMap<String, Vec<[u64; 2]>>, mesh: &Mesh) -> Vec<Diagnostic> {
    let warning_of = |(name, lines): (&String, &Vec<[u64; 2]>)| {
        let lines: BTreeSet<[u64; 2]> = lines.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
        let group = mesh.groups().get(name);
        let kept = group.map_or(0, |group| group.edges.len());
        let inner = group.map_or(0, |group| group.lines.len());
        let message = match lines.len().saturating_sub(kept) {
            0 => return None,
            lost if lost == inner => format!(
                "{} of the group `{name}` are sides of cells inside the sheet, not edges of the boundary: supports act on them, tractions and \
                 pressures do not",
                match kept {
                    0 => "the lines".to_owned(),
                    _ => format!("{inner} of {} lines", lines.len()),
                }
            ),
            _ if kept + inner == 0 => {
                format!("no line of the group `{name}` is a side of a cell; the group is left out")
            }
            lost => format!(
                "{} of {} lines of the group `{name}` are not sides of cells and are left out",
                lost.saturating_sub(inner),
                lines.len()
            ),
        };
        let hint = "edges of the boundary are sides of only one cell, with its nodes";
        Some(Diagnostic::warning("", message).hint(hint))
    };
    groups.iter().filter_map(warning_of).collect()
}

#[cfg(test)]
mod tests;
