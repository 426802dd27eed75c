//! The outline of a specimen's study: a shape by its measures, or the mesh of a file.

use crate::document::{Bound, Section};
use crate::error::{Diagnostic, Severity};
use crate::mesh::{CellShape, Exemptions, Mesh, MeshReading, Rakes, Shape};
use crate::studies::specimen::problem::{HALVINGS, MESH, Outline};
use crate::units::Dimension;

/// Cells across a specimen at most; how many fit into the budget depends on its measures.
const MOST_CELLS: usize = 10_000;

/// Tines at one side of a sheet at most.
const MOST_TINES: usize = 20;

/// The names of the shapes.
pub const SHAPES: [&str; 8] = [
    MESH,
    "strip",
    "strip-with-hole",
    "notched-strip",
    "dog-bone",
    "ring-sector",
    "square-on-rakes",
    "cruciform",
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
    let merge_nodes = section.optional_quantity("merge_nodes", Dimension::Length, Bound::Positive);
    let names = section.optional_texts("allowed");
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
        is_plane_strain: None,
    };
    let read = import(&file, reading);
    let (mesh, diagnostics) = match read {
        Ok((mesh, diagnostics)) => (Some(mesh), diagnostics),
        Err(diagnostics) => (None, diagnostics),
    };
    for diagnostic in diagnostics {
        let hint = diagnostic.hint.unwrap_or_default();
        match diagnostic.severity {
            Severity::Error => section.fault("file", &diagnostic.message, &hint),
            Severity::Warning => section.warning("file", &diagnostic.message, &hint),
        }
    }
    Some((mesh?, reading.allowed))
}

/// A mesh of a shape with some measures, whose groups are those of all its meshes; `None` for that of a file.
pub fn usual_mesh(name: &str) -> Option<Mesh> {
    let usual = |key: &'static str| match key {
        "length" => 90.0,
        "width" | "outer_radius" => 30.0,
        "hole_diameter" | "narrow_width" | "shoulder_length" => 10.0,
        "narrow_length" | "inner_radius" => 20.0,
        "angle" | "tine_diameter" | "tine_inset" => 1.0,
        "tines" => 3.0,
        _ => 5.0,
    };
    let shape = (name != MESH).then(|| shape_of(name, &usual))?;
    Some(shape.mesh(4, CellShape::Quad4))
}

fn read_shape(section: &Section, name: &str) -> Shape {
    shape_of(name, &|key| match key {
        "angle" => section.quantity(key, Dimension::Angle, Bound::Positive),
        "tines" => section.count(key, 1, MOST_TINES) as f64,
        key => section.quantity(key, Dimension::Length, Bound::SIZE),
    })
}

/// A shape by its measures.
fn shape_of(name: &str, measure: &dyn Fn(&'static str) -> f64) -> Shape {
    if name == "ring-sector" {
        return Shape::RingSector {
            radii: [measure("inner_radius"), measure("outer_radius")],
            angle: measure("angle"),
        };
    }
    let size = [measure("length"), measure("width")];
    match name {
        "strip-with-hole" => Shape::StripWithHole {
            size,
            radius: 0.5 * measure("hole_diameter"),
        },
        "notched-strip" => Shape::NotchedStrip {
            size,
            depth: measure("notch_depth"),
            half_length: 0.5 * measure("notch_length"),
        },
        "square-on-rakes" => Shape::SquareOnRakes(Rakes {
            size,
            tines: measure("tines") as usize,
            spacing: measure("tine_spacing"),
            inset: measure("tine_inset"),
            radius: 0.5 * measure("tine_diameter"),
        }),
        "cruciform" => Shape::Cruciform {
            size,
            arm_width: measure("arm_width"),
            fillet: measure("fillet"),
        },
        "dog-bone" => Shape::DogBone {
            size,
            narrow: [measure("narrow_length"), measure("narrow_width")],
            shoulder: measure("shoulder_length"),
        },
        _ => Shape::Strip { size },
    }
}
