//! The contents of a plate's study: the plate, the models and how they are solved, the output.

use std::path::PathBuf;
use std::sync::Arc;

use crate::corrector::climb::ClimbSettings;
use crate::corrector::{CorrectorSettings, DifferenceScheme};
use crate::error::Diagnostic;
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::LatticeSettings;
use crate::material::Card;
use crate::mesh::Mesh;
use crate::problem::ClampedPlate;
use crate::results::Sheet;
use crate::solve::{LinearSolver, NewtonSettings};
use crate::studies::pictures::Pictures;
use crate::studies::sections::Tolerances;

/// A study, checked.
#[derive(Debug)]
pub struct Study {
    /// The file's name without its extension.
    pub name: String,
    /// The heading of the report.
    pub title: String,
    /// What is solved.
    pub problem: ClampedPlate,
    /// Where its material comes from.
    pub card: Card,
    /// Cells of the lattice.
    pub cells: [usize; 2],
    /// The options of the lattice.
    pub lattice: LatticeSettings,
    /// How the lattice is solved.
    pub mass_spring: NewtonSettings,
    /// How its field is corrected.
    pub corrector: Correction,
    /// The finite elements that the other models are compared with.
    pub reference: Reference,
    /// The requirements on the corrected field.
    pub tolerances: Tolerances,
    /// The pictures of its fields.
    pub pictures: Pictures,
    /// The output.
    pub output: OutputSettings,
    /// The file's text.
    pub text: String,
    /// The keys that the study does not state, with the defaults used.
    pub defaults: Vec<String>,
    /// Warnings, which do not stop the work.
    pub warnings: Vec<Diagnostic>,
}

/// How the field of the lattice is corrected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// The finite differences.
    pub scheme: DifferenceScheme,
    /// How much smaller its cells become towards the corners; see [`crate::mesh::Grid`].
    pub grading: f64,
    /// How exactly the corrector climbs; `None` where it is direct.
    pub climb: Option<ClimbSettings>,
    /// When the direct corrector stops.
    pub direct: CorrectorSettings,
}

impl Correction {
    /// Whether the corrected field has cells of its own, and not the lattice's nodes.
    pub fn is_graded(&self) -> bool {
        self.grading > 1.0 || self.scheme.has_own_nodes()
    }
}

/// The finite elements of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// The element.
    pub element: Element,
    /// Cells of the finest mesh.
    pub cells: [usize; 2],
    /// How much smaller the cells become towards the corners; see [`crate::mesh::Grid`].
    pub grading: f64,
    /// How they are solved.
    pub newton: NewtonSettings,
    /// How their systems are solved.
    pub linear_solver: LinearSolver,
}

/// The output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputSettings {
    /// The folder that receives everything.
    pub folder: PathBuf,
    /// Whether `.vtu` and `.pvd` files are written.
    pub vtk: bool,
    /// Whether pictures are written.
    pub plots: bool,
    /// Whether reports are written.
    pub report: bool,
}

impl Study {
    /// The same study of another material, such as a law of the caller's: see [`Card::of_law`].
    #[must_use]
    pub fn with_card(mut self, card: Card) -> Self {
        self.problem.law = Arc::clone(&card.law);
        self.card = card;
        self
    }

    /// What stresses follow from.
    pub fn sheet(&self) -> Sheet<'_> {
        Sheet {
            law: &*self.problem.law,
            thickness: self.problem.thickness,
            past: &[],
            viscous: None,
        }
    }

    /// What the study computes, in words.
    pub fn describe(&self) -> String {
        let [nx, ny] = self.cells;
        let [fx, fy] = self.reference.cells;
        let graded = if self.reference.grading > 1.0 {
            format!(" graded by {}", self.reference.grading)
        } else {
            String::new()
        };
        let stretches = match self.problem.stretches.len() {
            1 => "1 stretch".to_owned(),
            several => format!("{several} stretches"),
        };
        format!(
            "{stretches}, {nx} × {ny} cells, card {}, finite elements {} with {fx} × {fy} cells{graded}, output in {}",
            self.card.name,
            self.reference.element.name(),
            self.output.folder.display()
        )
    }

    /// Whether the reference is the corrected field once more: the same equations on the same nodes.
    pub fn is_its_own_reference(&self) -> bool {
        let scheme = self.corrector.scheme;
        let element = match scheme {
            DifferenceScheme::Bicubic => return false,
            DifferenceScheme::Gauss => Element::Q1,
            DifferenceScheme::Biquadratic => Element::Q2,
        };
        let Reference { cells, grading, .. } = self.reference;
        let cells = cells.map(|cells| cells * scheme.side());
        self.reference.element == element
            && grading == self.corrector.grading
            && cells == self.cells
    }

    /// The cells of the corrected fields.
    pub fn corrected_mesh(&self) -> Mesh {
        let Correction {
            scheme, grading, ..
        } = self.corrector;
        scheme.graded(self.problem.size, self.cells, grading)
    }

    /// The finite elements on three meshes, coarse to fine.
    pub fn finite_elements(&self) -> [FiniteElements; 3] {
        let Reference {
            element,
            grading,
            linear_solver,
            ..
        } = self.reference;
        let meshes = self.reference.meshes();
        meshes.map(|cells| {
            let elements = FiniteElements::graded(&self.problem, cells, element, grading);
            elements.solved_by(linear_solver)
        })
    }
}

impl Reference {
    /// Cells of the three meshes, coarse to fine.
    pub fn meshes(&self) -> [[usize; 2]; 3] {
        [4, 2, 1].map(|coarser| self.cells.map(|cells| cells / coarser))
    }
}
