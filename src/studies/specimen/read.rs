//! The study file of a specimen.

use std::path::Path;
use std::sync::Arc;

use super::outline::{MESH, Outline, SHAPES, read_outline};
use super::supports::Given;
use crate::document::{Bound, Section};
use crate::error::suggestion;
use crate::material::Card;
use crate::mesh::{CellShape, Mesh};
use crate::problem::{BoundaryProblem, Load};
use crate::studies::sections::{Tolerances, read_card};
use crate::units::Dimension;

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
    /// The group that is measured.
    pub group: String,
    /// What the corrected field has to reach.
    pub tolerances: Tolerances,
    /// How far the finite elements are refined locally; `None` where they have three meshes.
    pub refinement: Option<Refinement>,
    /// What is meshed, and how.
    pub outline: Outline,
}

/// What a study must say of the specimen; cells and lattice have defaults.
const MEASURES: &[&str] = &[
    "shape",
    "thickness",
    "length",
    "width",
    "hole_diameter",
    "file",
    "file_unit",
];

/// Reads a study; `None` where it has faults, which are recorded.
pub fn read(root: &Section, folder: &Path) -> Option<Specimen> {
    let material = root.section("material").requiring(&["card"]);
    let card = read_card(&material, folder);
    material.unknown_keys();

    let section = root.section("finite_element");
    let element = section.choice("element", &CellShape::NAMES);
    let refinement = read_refinement(&section, element);
    section.unknown_keys();
    let section = root.section("specimen").requiring(MEASURES);
    let name = section.choice("shape", &SHAPES.map(|name| (name, name)));
    let thickness = section.quantity("thickness", Dimension::Length, Bound::Positive);
    let element = element.unwrap_or(CellShape::Quad9);
    let outline = name.and_then(|name| read_outline(&section, name, folder, element));
    section.unknown_keys();
    let given = Given::read(root);

    let section = root
        .section("path")
        .requiring(&["factors", "measured_group"]);
    let factors = section.quantities("factors", Dimension::Ratio, Bound::Positive);
    if section.has("factors")
        && (factors.is_empty() || factors.windows(2).any(|pair| pair[1] <= pair[0]))
    {
        section.fault(
            "factors",
            "must be one or more ascending load factors",
            "such as [0.5, 1.0]",
        );
    }
    let group = section.text("measured_group");
    section.unknown_keys();
    let tolerances = Tolerances::read(&root.section("tolerances"), false);
    let (card, name, outline) = (card?, name?, outline?);
    let mesh = coarse(root, &outline)?;
    given.check_groups(&mesh);
    if section.has("measured_group") && !mesh.groups().contains_key(&group) {
        let known: Vec<_> = mesh.groups().keys().map(String::as_str).collect();
        let message = format!("the specimen has no group `{group}`");
        let hint = suggestion(&group, &known, "its groups are");
        section.fault("measured_group", &message, &hint);
    }
    let specimen = Specimen {
        name: name.replace('-', "_"),
        problem: BoundaryProblem {
            thickness,
            law: Arc::clone(&card.law),
            supports: given.supports(),
            loads: given.loads(),
        },
        card,
        factors,
        group,
        tolerances,
        refinement,
        outline,
    };
    given.check(root, &specimen.problem, &mesh);
    specimen.check_refinement(root);
    Some(specimen)
}

/// A coarse mesh with the groups of the specimen; `None` where its measures do not fit, which is recorded.
fn coarse(root: &Section, outline: &Outline) -> Option<Mesh> {
    if !outline.is_complete() {
        return None; // told already
    }
    let mesh = outline.coarse();
    if let Err(reason) = &mesh {
        root.fault("specimen", reason, "change its measures");
    }
    mesh.ok()
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

impl Specimen {
    /// A specimen on a mesh, as if it had been read from a file, with all loads at once.
    pub fn of_mesh(
        card: Card,
        problem: BoundaryProblem,
        mesh: Mesh,
        element: CellShape,
        group: &str,
    ) -> Self {
        Self {
            name: MESH.into(),
            problem,
            card,
            factors: vec![1.0],
            group: group.into(),
            tolerances: Tolerances {
                displacement_percent: 1.0,
                departure_percent: None,
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

    /// A force that nodes share equally is another one on a mesh that is refined locally.
    fn check_refinement(&self, root: &Section) {
        let forces = |(_, load): &(String, Load)| matches!(load, Load::Force(_));
        if self.refinement.is_some() && self.problem.loads.iter().any(forces) {
            let message =
                "a force is shared by the nodes of its group, which local refinement changes";
            let hint = "write it as a traction, or leave out `adaptive`";
            root.fault("load", message, hint);
        }
    }
}
