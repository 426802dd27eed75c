//! The study file of a specimen.

use std::path::Path;
use std::sync::Arc;

use crate::boundary::{BoundaryProblem, Drive, Load, Support};
use crate::document::{Bound, Section};
use crate::error::Severity;
use crate::material::Card;
use crate::mesh::{Allowed, CellShape, Mesh, MeshReading, Shape, import};
use crate::study;
use crate::units::Dimension;

/// What the corrected field has to reach, in %.
#[derive(Clone, Copy)]
pub struct Tolerances {
    /// Largest deviation in displacement from the finite elements.
    pub displacement_percent: f64,
    /// Largest deviation in force.
    pub force_percent: f64,
    /// Smallest correction of the springs' deviation in displacement.
    pub correction_percent: f64,
}

/// When local refinement ends.
#[derive(Clone, Copy)]
pub struct Refinement {
    /// Estimated error in the energy norm in % at the worst load factor.
    pub error_percent: f64,
    /// Cells that are not exceeded.
    pub most_cells: usize,
}

/// A specimen, its supports and loads, and how finely it is meshed.
pub struct Specimen {
    /// For file names.
    pub name: String,
    /// Thickness, material, supports and loads.
    pub problem: BoundaryProblem,
    /// The card of its material.
    pub card: Card,
    /// Load factors, ascending.
    pub factors: Vec<f64>,
    /// The group whose force is compared, or its displacement where the force is given.
    pub measured: String,
    /// What the corrected field has to reach.
    pub tolerances: Tolerances,
    /// How far the finite elements are refined locally; nothing where they have three meshes.
    pub refinement: Option<Refinement>,
    outline: Outline,
}

/// What is meshed, and how.
enum Outline {
    /// A shape by its measures: cells across, cells of the lattice, finite elements.
    Shape {
        shape: Shape,
        cells: usize,
        lattice: CellShape,
        element: CellShape,
    },
    /// The mesh of a file, the finite elements on it, and whether straight edges are meant where they turn as a curve's.
    File {
        mesh: Box<Mesh>,
        element: CellShape,
        polygons: bool,
    },
}

/// The shape that is read from a file.
const MESH: &str = "mesh";

const SHAPES: [&str; 6] = [
    MESH,
    "strip",
    "strip-with-hole",
    "notched-strip",
    "dog-bone",
    "ring-sector",
];

/// Reads a study; nothing where it has faults, which are recorded.
pub fn read(root: &Section, folder: &Path) -> Option<Specimen> {
    let material = root.section("material");
    let card = study::read_card(&material, folder);
    material.unknown_keys();

    let section = root.section("finite_element");
    let chosen = section.choice(
        "element",
        &CellShape::NAMES.map(|element| (element.0, element)),
    );
    let refinement = read_refinement(&section, chosen.map(|(_, element)| element));
    section.unknown_keys();
    let section = root.section("specimen");
    let name = section.choice("shape", &SHAPES.map(|name| (name, name)));
    let thickness = section.quantity("thickness", Dimension::Length, Bound::Positive);
    let element = chosen.map_or(CellShape::Quad9, |(_, element)| element);
    let outline = name.and_then(|name| read_outline(&section, name, folder, element));
    section.unknown_keys();
    let supports = root.tables("support");
    let supports = supports.iter().filter_map(read_support).collect();
    let loads = if root.has("load") {
        root.tables("load")
    } else {
        Vec::new()
    };
    let loads = loads.iter().filter_map(read_load).collect();

    let section = root.section("path");
    let factors = section.quantities("factors", Dimension::Ratio, Bound::Positive);
    if factors.is_empty() || factors.windows(2).any(|pair| pair[1] <= pair[0]) {
        section.fault(
            "factors",
            "must be one or more ascending load factors",
            "such as [0.5, 1.0]",
        );
    }
    let measured = section.text("measured_group");
    section.unknown_keys();
    let section = root.section("tolerances");
    let percent = |key| 100.0 * section.quantity(key, Dimension::Ratio, Bound::Positive);
    let tolerances = Tolerances {
        displacement_percent: percent("displacement"),
        force_percent: percent("force"),
        correction_percent: percent("correction"),
    };
    section.unknown_keys();
    let card = card?;
    let specimen = Specimen {
        name: name?.replace('-', "_"),
        problem: BoundaryProblem {
            thickness,
            law: Arc::clone(&card.law),
            supports,
            loads,
        },
        card,
        factors,
        measured,
        tolerances,
        refinement,
        outline: outline?,
    };
    specimen.check(root);
    Some(specimen)
}

fn read_outline(
    section: &Section,
    name: &str,
    folder: &Path,
    element: CellShape,
) -> Option<Outline> {
    if name == MESH {
        let (mesh, allowed) = read_mesh(section, folder)?;
        return Some(Outline::File {
            mesh: Box::new(mesh),
            element,
            polygons: allowed.polygons,
        });
    }
    let shape = read_shape(section, name);
    let cells = section.count("cells", 2, 400);
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

/// The mesh of a file; nothing where it cannot be used, with the faults recorded.
fn read_mesh(section: &Section, folder: &Path) -> Option<(Mesh, Allowed)> {
    let file = section.text("file");
    let unit = section.quantity("file_unit", Dimension::Length, Bound::Positive);
    let merge_nodes = section
        .has("merge_nodes")
        .then(|| section.quantity("merge_nodes", Dimension::Length, Bound::Positive));
    let names = match section.has("allowed") {
        true => section.texts("allowed"),
        false => Vec::new(),
    };
    let allowed = Allowed::of_names(names.iter().map(String::as_str));
    if let Err(unknown) = &allowed {
        let hint = format!("one of {}", Allowed::NAMES.join(", "));
        section.fault(
            "allowed",
            &format!("\"{unknown}\" is not known here"),
            &hint,
        );
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
    let read = import(&folder.join(&file), reading);
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

/// What is measured at a group, with its unit.
#[derive(Clone, Copy, PartialEq)]
pub enum Measured {
    /// The force of the supports, where displacements are given.
    Force,
    /// The displacement of a grip along an axis, where its force is given.
    Displacement(usize),
}

impl Measured {
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Displacement(_) => "grip displacement",
        }
    }

    pub fn unit(self) -> &'static str {
        match self {
            Self::Force => "N",
            Self::Displacement(_) => "mm",
        }
    }
}

impl Specimen {
    /// A specimen on a mesh, as if it had been read from a file, with all loads at once.
    pub fn of_mesh(
        card: Card,
        problem: BoundaryProblem,
        mesh: Mesh,
        element: CellShape,
        measured: &str,
    ) -> Self {
        Self {
            name: MESH.into(),
            problem,
            card,
            factors: vec![1.0],
            measured: measured.into(),
            tolerances: Tolerances {
                displacement_percent: 1.0,
                force_percent: 1.0,
                correction_percent: 1.0,
            },
            refinement: None,
            outline: Outline::File {
                mesh: Box::new(mesh),
                element,
                polygons: false,
            },
        }
    }

    /// What is measured at the measured group.
    pub fn measured(&self) -> Measured {
        let supports = self.problem.supports.iter().rev();
        let own = supports.filter(|(group, _)| *group == self.measured);
        let axis = own.clone().find_map(|(_, support)| match support {
            Support::Grip(drives) => drives
                .iter()
                .position(|drive| matches!(drive, Drive::Force(force) if *force != 0.0)),
            _ => None,
        });
        axis.map_or(Measured::Force, Measured::Displacement)
    }

    /// The mesh of the springs and of the corrector; that of a file has a node wherever the file has one.
    pub fn lattice(&self) -> Mesh {
        match &self.outline {
            Outline::Shape {
                shape,
                cells,
                lattice,
                ..
            } => shape.mesh(*cells, *lattice),
            Outline::File { mesh, .. } if mesh.degree() == 1 => (**mesh).clone(),
            Outline::File { mesh, .. } => mesh.refined().linear(),
        }
    }

    /// The meshes of the finite elements, each twice as fine as the one before: the middle one is as fine as the
    /// lattice of a shape, the first one as that of a file.
    pub fn reference_meshes(&self) -> [Mesh; 3] {
        match &self.outline {
            Outline::Shape {
                shape,
                cells,
                element,
                ..
            } => [cells / 2, *cells, 2 * cells].map(|cells| shape.mesh(cells, *element)),
            Outline::File { mesh, .. } => {
                let fine = mesh.refined();
                let meshes = [(**mesh).clone(), fine.clone(), fine.refined()];
                meshes.map(|mesh| self.elements_on(&mesh))
            }
        }
    }

    /// The middle one of the three meshes of a file's specimen with its edges on the curves that they stand for, see
    /// [`Mesh::rounded`], and the whole change to those curves over the change to this mesh.
    pub fn rounded_mesh(&self) -> Option<(Mesh, f64)> {
        let Outline::File { mesh, polygons, .. } = &self.outline else {
            return None;
        };
        if *polygons && mesh.degree() == 1 {
            return None;
        }
        // What is left between a curve and chords falls with h², between a curve and parabolas with h⁴.
        let whole = if mesh.degree() == 1 {
            4.0 / 3.0
        } else {
            16.0 / 15.0
        };
        Some((self.elements_on(&mesh.rounded()?), whole))
    }

    /// The triangles that local refinement begins with: as coarse as the coarsest of three meshes.
    pub fn first_triangles(&self) -> Mesh {
        match &self.outline {
            Outline::Shape { shape, cells, .. } => shape.mesh(*cells / 2, CellShape::Triangle3),
            Outline::File { mesh, .. } => mesh.triangulated(),
        }
    }

    /// The mesh of the study's elements on some cells.
    pub fn elements_on(&self, cells: &Mesh) -> Mesh {
        let (Outline::Shape { element, .. } | Outline::File { element, .. }) = &self.outline;
        match (element.degree(), cells.degree()) {
            (1, 1) => cells.clone(),
            (1, _) => cells.linear(),
            _ => self.fitted(cells.quadratic()),
        }
    }

    /// A refined mesh with its sides on the outline; that of a file is the one of its mesh.
    pub fn fitted(&self, mut mesh: Mesh) -> Mesh {
        if let Outline::Shape { shape, .. } = &self.outline {
            shape.fit(&mut mesh);
        }
        mesh
    }

    /// Records measures that do not fit and groups that the shape does not have.
    fn check(&self, root: &Section) {
        if !self.problem.thickness.is_finite() {
            return; // told already
        }
        let mesh = match &self.outline {
            Outline::Shape { shape, cells, .. } => {
                if shape.measures().iter().any(|measure| !measure.is_finite()) {
                    return;
                }
                if let Err(reason) = shape.check() {
                    root.fault("specimen", &reason, "change its measures");
                    return;
                }
                if !cells.is_multiple_of(2) {
                    let hint = "one of the meshes has half as many";
                    root.fault("specimen", "cells must be even", hint);
                }
                &shape.mesh(2, CellShape::Quad4)
            }
            Outline::File { mesh, .. } => mesh,
        };
        let energy = self.problem.finite_elements(mesh);
        if let Err(fault) = self.problem.on(mesh, &energy) {
            let hint = fault.hint.unwrap_or_default();
            root.fault("support", &fault.message, &hint);
            return;
        }
        let forces = |(_, load): &(String, Load)| matches!(load, Load::Force(_));
        if self.refinement.is_some() && self.problem.loads.iter().any(forces) {
            let message =
                "a force is shared by the nodes of its group, which local refinement changes";
            root.fault(
                "load",
                message,
                "write it as a traction, or leave out `adaptive`",
            );
        }
        if !mesh.groups().contains_key(&self.measured) {
            let known: Vec<_> = mesh.groups().keys().map(String::as_str).collect();
            let message = format!("the specimen has no group `{}`", self.measured);
            root.fault(
                "path",
                &message,
                &format!("its groups are {}", known.join(", ")),
            );
        }
    }
}

fn read_refinement(section: &Section, element: Option<CellShape>) -> Option<Refinement> {
    let error = section.quantity("error", Dimension::Ratio, Bound::Within(1e-6, 0.5));
    let most_cells = section.count("most_cells", 10, 200_000);
    if !section.flag("adaptive") {
        return None;
    }
    if element.is_some_and(|element| !element.is_triangle()) {
        let message = "adaptive refinement is that of triangles";
        section.fault("element", message, "take \"T2\" or \"T1\"");
    }
    Some(Refinement {
        error_percent: 100.0 * error,
        most_cells,
    })
}

fn read_shape(section: &Section, name: &str) -> Shape {
    let length = |key| section.quantity(key, Dimension::Length, Bound::Positive);
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

/// A vector of two quantities under `x` and `y`; one that is missing is nothing.
fn components(section: &Section, dimension: Dimension) -> [Option<f64>; 2] {
    ["x", "y"].map(|key| {
        let given = section.has(key);
        given.then(|| section.quantity(key, dimension, Bound::Any))
    })
}

/// What moves a grip along an axis, by the keys of a displacement and of a force.
fn drive(section: &Section, (displacement, force): (&'static str, &'static str)) -> Drive {
    match (section.has(displacement), section.has(force)) {
        (true, false) => {
            Drive::Displacement(section.quantity(displacement, Dimension::Length, Bound::Any))
        }
        (false, true) => Drive::Force(section.quantity(force, Dimension::Force, Bound::Any)),
        _ => {
            let message = format!("a grip needs either {displacement} or {force}");
            let hint = format!(
                "{displacement} = \"0 mm\" holds it, {force} = \"0 N\" leaves it free to move"
            );
            section.fault("kind", &message, &hint);
            Drive::Displacement(f64::NAN)
        }
    }
}

fn read_support(section: &Section) -> Option<(String, Support)> {
    let group = section.text("group");
    let support = match section.choice(
        "kind",
        &[
            ("clamp", 0),
            ("displacement", 1),
            ("roller", 2),
            ("symmetry", 2),
            ("grip", 3),
            ("rotation", 4),
        ],
    )? {
        0 => Support::Displacement([Some(0.0); 2]),
        1 => {
            let displacement = components(section, Dimension::Length);
            if displacement == [None; 2] {
                section.fault("kind", "needs x or y", "x = \"0 mm\" is a roller along y");
            }
            Support::Displacement(displacement)
        }
        2 => Support::Roller,
        3 => Support::Grip([("x", "x_force"), ("y", "y_force")].map(|keys| drive(section, keys))),
        _ => {
            let centre = section.quantities("centre", Dimension::Length, Bound::Any);
            let centre = centre.try_into().unwrap_or_else(|_| {
                section.fault(
                    "centre",
                    "must be two lengths",
                    "such as [\"0 mm\", \"0 mm\"]",
                );
                [f64::NAN; 2]
            });
            Support::Rotation {
                centre,
                angle: section.quantity("angle", Dimension::Angle, Bound::Any),
            }
        }
    };
    section.unknown_keys();
    Some((group, support))
}

fn read_load(section: &Section) -> Option<(String, Load)> {
    let group = section.text("group");
    let load = match section.choice("kind", &[("traction", 0), ("pressure", 1), ("force", 2)])? {
        0 => Load::Traction(components(section, Dimension::Stress).map(Option::unwrap_or_default)),
        1 => Load::Pressure(section.quantity("pressure", Dimension::Stress, Bound::Any)),
        _ => Load::Force(components(section, Dimension::Force).map(Option::unwrap_or_default)),
    };
    section.unknown_keys();
    Some((group, load))
}
