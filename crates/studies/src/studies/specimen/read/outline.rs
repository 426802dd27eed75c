//! The outline of a specimen's study: a shape by its measures, or the mesh of a file.

use crate::document::{Bound, Section};
use crate::error::{Diagnostic, Severity};
use crate::mesh::{CellShape, Exemptions, Mesh, MeshReading, Shape};
use crate::studies::specimen::problem::{HALVINGS, MESH, Outline};
use crate::units::Dimension;

/// Cells across a specimen at most; how many fit into the budget depends on its measures.
const MOST_CELLS: usize = 10_000;

/// The names of the shapes.
pub const SHAPES: [&str; 6] = [
    MESH,
    "strip",
    "strip-with-hole",
    "notched-strip",
    "dog-bone",
    "ring-sector",
];

/// Reads the mesh that a study names as `file`: the mesh and what deserves attention, or its faults.
pub type Import<'a> =
    dyn Fn(&str, MeshReading) -> Result<(Mesh, Vec<Diagnostic>), Vec<Diagnostic>> + 'a;

/// The outline under a shape's name; `None` where it has faults, which are recorded.
pub fn read_outline(
    section: &Section,
    name: &str,
    import: &Import,
    element: CellShape,
) -> Option<Outline> {
    if name == MESH {
        let (mesh, allowed) = read_mesh(section, import)?;
        return Some(Outline::File {
            mesh: Box::new(mesh),
            element,
            polygons: allowed.polygons,
            halvings: HALVINGS,
        });
    }
    let shape = read_shape(section, name);
    let cells = section.count("cells", 2, MOST_CELLS);
    if !cells.is_multiple_of(2) {
        let hint = format!("one of the meshes has half as many; take {}", cells + 1);
        section.fault("cells", "must be even", &hint);
    }
    let kinds = [
        ("quadrilaterals", CellShape::Quad4),
        ("triangles", CellShape::Triangle3),
    ];
    let lattice = section.choice("lattice", &kinds)?;
    Some(Outline::Shape {
        shape,
        cells,
        lattice,
        element,
    })
}

/// The mesh of a file; `None` where it cannot be used, with the faults recorded.
fn read_mesh(section: &Section, import: &Import) -> Option<(Mesh, Exemptions)> {
    let file = section.text("file");
    let unit = section.unit("file_unit", Dimension::Length);
    let merge_nodes = section
        .has("merge_nodes")
        .then(|| section.quantity("merge_nodes", Dimension::Length, Bound::Positive));
    let names = if section.has("allowed") {
        section.texts("allowed")
    } else {
        Vec::new()
    };
    let allowed = Exemptions::of_names(names.iter().map(String::as_str));
    if let Err(unknown) = &allowed {
        let hint = format!("one of {}", Exemptions::NAMES.join(", "));
        section.fault("allowed", &unknown.to_string(), &hint);
    }
    if file.is_empty() {
        section.fault("file", "must name a mesh", "such as \"specimen.msh\"");
    }
    if file.is_empty() || !unit.is_finite() || merge_nodes.is_some_and(f64::is_nan) {
        return None;
    }
    let reading = MeshReading {
        unit,
        merge_nodes,
        allowed: allowed.ok()?,
    };
    let read = import(&file, reading);
    let (mesh, told) = match read {
        Ok((mesh, told)) => (Some(mesh), told),
        Err(told) => (None, told),
    };
    for found in told {
        let hint = found.hint.unwrap_or_default();
        match found.severity {
            Severity::Error => section.fault("file", &found.message, &hint),
            Severity::Warning => section.warning("file", &found.message, &hint),
        }
    }
    Some((mesh?, reading.allowed))
}

fn read_shape(section: &Section, name: &str) -> Shape {
    let length = |key| section.quantity(key, Dimension::Length, Bound::SIZE);
    if name == "ring-sector" {
        return Shape::RingSector {
            radii: [length("inner_radius"), length("outer_radius")],
            angle: section.quantity("angle", Dimension::Angle, Bound::Positive),
        };
    }
    let size = [length("length"), length("width")];
    match name {
        "strip-with-hole" => Shape::StripWithHole {
            size,
            radius: 0.5 * length("hole_diameter"),
        },
        "notched-strip" => Shape::NotchedStrip {
            size,
            depth: length("notch_depth"),
            half_length: 0.5 * length("notch_length"),
        },
        "dog-bone" => Shape::DogBone {
            size,
            narrow: [length("narrow_length"), length("narrow_width")],
            shoulder: length("shoulder_length"),
        },
        _ => Shape::Strip { size },
    }
}
