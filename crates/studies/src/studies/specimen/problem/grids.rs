//! The meshes of a plate: grids of lines, whose cells may become smaller towards the clamped corners.

use crate::corrector::climb::ClimbSettings;
use crate::corrector::{CorrectorSettings, DifferenceScheme};
use crate::finite_element::Element;
use crate::mass_spring::LatticeSettings;
use crate::mesh::{CellShape, Grid, Mesh};

/// How often the cells of the finite elements are halved: three meshes show their own error.
pub const HALVINGS: usize = 2;

/// A rectangle between two grips, with the grids of its models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateGrids {
    /// Length between the grips and width in mm.
    pub size: [f64; 2],
    /// Cells of the lattice.
    pub cells: [usize; 2],
    /// The options of the lattice.
    pub lattice: LatticeSettings,
    /// How the field of the lattice is corrected.
    pub correction: GridCorrection,
    /// The finite elements that the other models are compared with.
    pub elements: GridElements,
}

/// How the field of a plate's lattice is corrected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridCorrection {
    /// The finite differences.
    pub scheme: DifferenceScheme,
    /// How much smaller its cells become towards the corners; see [`Grid`].
    pub grading: f64,
    /// How exactly the corrector climbs; `None` where it is direct.
    pub climb: Option<ClimbSettings>,
    /// When the direct corrector stops.
    pub direct: CorrectorSettings,
}

impl GridCorrection {
    /// Whether the corrected field has cells of its own, and not the lattice's nodes.
    pub fn is_graded(&self) -> bool {
        self.grading > 1.0 || self.scheme.has_own_nodes()
    }
}

/// The finite elements of a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridElements {
    /// The element.
    pub element: Element,
    /// Cells of the finest of three meshes.
    pub cells: [usize; 2],
    /// How much smaller the cells become towards the corners; see [`Grid`].
    pub grading: f64,
}

impl GridElements {
    /// The mesh of a level: 2 is the finest of a study, each has cells of half the size of those of the one before.
    pub fn mesh(&self, size: [f64; 2], level: usize) -> Mesh {
        let cells = self.cells.map(|cells| (cells << level) >> HALVINGS);
        self.mesh_of(size, cells)
    }

    /// The finest mesh, or one whose cells are twice as large, or four times where both numbers of cells can be halved twice; `None` where
    /// there is none.
    pub fn coarser_mesh(&self, size: [f64; 2], halvings: usize) -> Option<Mesh> {
        let twice = self.cells.map(|cells| cells.div_ceil(2));
        let cells = match halvings {
            0 => self.cells,
            1 if twice != self.cells => twice,
            2 if self.cells.iter().all(|cells| cells.is_multiple_of(4)) => {
                twice.map(|cells| cells / 2)
            }
            _ => return None,
        };
        Some(self.mesh_of(size, cells))
    }

    fn mesh_of(&self, size: [f64; 2], cells: [usize; 2]) -> Mesh {
        Mesh::of_grid(Grid::new(size, cells, self.grading), self.element.shape())
    }
}

impl PlateGrids {
    /// The lattice.
    pub fn lattice(&self) -> Mesh {
        Mesh::plate(self.size, self.cells, CellShape::Quad4)
    }

    /// Whether the finite elements are the corrected field once more: the same equations on the same nodes.
    pub fn is_own_reference(&self) -> bool {
        let scheme = self.correction.scheme;
        let element = match scheme {
            DifferenceScheme::Bicubic => return false,
            DifferenceScheme::Gauss => Element::Q1,
            DifferenceScheme::Biquadratic => Element::Q2,
        };
        let cells = self.elements.cells.map(|cells| cells * scheme.side());
        self.elements.element == element
            && self.elements.grading == self.correction.grading
            && cells == self.cells
    }
}
