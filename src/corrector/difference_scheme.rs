//! The governing equation of a plate by finite differences on the nodes of its lattice.
//!
//! The energy of each cell is sampled at four points (±s, ±s) of its reference square. At each of them
//! the displacement gradient is made of differences along the cell's edges, weighted by the distance to
//! the edge:
//!
//! ```text
//! ∂u/∂X (ξ, η) = ½ (1 − η) (u₁ − u₀)/hx + ½ (1 + η) (u₂ − u₃)/hx
//! ∂u/∂Y (ξ, η) = ½ (1 − ξ) (u₃ − u₀)/hy + ½ (1 + ξ) (u₂ − u₁)/hy
//! Π = Σ ¼ hx hy t Ψ(∂u/∂X, ∂u/∂Y)                                              [mJ]
//! ```
//!
//! F = ∂Π/∂u is the balance of forces at a node, and B = ∂²Π/∂u∂u is symmetric.
//!
//! | scheme | s² | differences | error on the PVA plate, 60 × 20 cells, at 15 % stretch: displacement, departure from affine, force |
//! |---|---|---|---|
//! | corners | 1 | one-sided, along one edge each | 0.062 %, 0.88 %, 0.11 % |
//! | Gauss | ⅓ | both edges, weighted | 0.028 %, 0.39 %, 0.05 % |
//! | biquadratic | 0, ⅗ | over two by two cells, 3 × 3 points | 0.013 %, 0.18 %, 0.02 % |
//!
//! The Gauss points integrate the energy of the cell to third order. The equations are then those of the
//! bilinear finite element: the corrector needs no more of that method than this stencil. The biquadratic scheme
//! passes parabolas through three nodes along each axis; its equations are those of the nine-node element on
//! two by two cells.

use std::sync::Arc;

use crate::mesh::{CellShape, Grid, Mesh};
use crate::problem::ClampedPlate;
use crate::problem::sheet_energy::SheetEnergy;

/// Where in a cell the differences are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DifferenceScheme {
    /// In the four corners: one-sided differences.
    Corners,
    /// In the four Gauss points: weighted differences.
    Gauss,
    /// In nine Gauss points of two by two cells: differences of second order. The default.
    #[default]
    Biquadratic,
}

impl DifferenceScheme {
    /// The names that studies use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("corners", Self::Corners),
        ("gauss", Self::Gauss),
        ("biquadratic", Self::Biquadratic),
    ];

    /// Number of cells along each axis that are taken together.
    pub fn side(self) -> usize {
        match self {
            Self::Corners | Self::Gauss => 1,
            Self::Biquadratic => 2,
        }
    }

    /// The grading of cells towards clamped corners with the least error in a given time; see [`Climb::graded`]. Measured on
    /// plates of three laws, two proportions and stretches of 10 to 100 %, with gradings of 1, 1.5, 2 and 3.
    ///
    /// [`Climb::graded`]: super::climb::Climb::graded
    pub fn grading(self) -> f64 {
        match self {
            Self::Corners | Self::Gauss => 1.5,
            Self::Biquadratic => 2.0,
        }
    }

    /// The cells that are taken together, on the nodes of a plate's mesh.
    pub fn mesh(self, mesh: &Mesh) -> Mesh {
        match self {
            Self::Corners | Self::Gauss => mesh.clone(),
            Self::Biquadratic => {
                let grid = mesh.grid();
                let pairs = grid.cells.map(|cells| cells / 2);
                Mesh::of_grid(Grid::new(grid.size, pairs, grid.grading), CellShape::Quad9)
            }
        }
    }

    /// The four-node cells of a plate that the scheme corrects on, smaller towards the corners the larger the grading is; the nodes are
    /// those of [`Climb::graded`].
    ///
    /// # Panics
    /// When the scheme takes cells two by two and their number is odd, or the grading is below 1.
    ///
    /// [`Climb::graded`]: super::climb::Climb::graded
    pub fn graded(self, size: [f64; 2], cells: [usize; 2], grading: f64) -> Mesh {
        let grid = Grid {
            together: self.side(),
            ..Grid::new(size, cells, grading)
        };
        Mesh::of_grid(grid, CellShape::Quad4)
    }

    /// The scheme's energy on the nodes of a plate's mesh of four-node cells.
    ///
    /// # Panics
    /// When the scheme takes cells two by two and their number is odd.
    pub fn energy(self, problem: &ClampedPlate, mesh: &Mesh) -> SheetEnergy {
        let s = match self {
            Self::Corners => 1.0,
            Self::Gauss => 1.0 / 3.0_f64.sqrt(),
            Self::Biquadratic => {
                let pairs = self.mesh(mesh);
                assert_eq!(pairs.nodes.len(), mesh.nodes.len(), "pairs of cells");
                return SheetEnergy::of_mesh(Arc::clone(&problem.law), &pairs, problem.thickness);
            }
        };
        let mut energy = SheetEnergy::new(Arc::clone(&problem.law), mesh.nodes.len());
        for cell in 0..mesh.cell_count() {
            let step = mesh.cell_size(cell);
            for local in [[-s, -s], [s, -s], [s, s], [-s, s]] {
                let derivatives = CellShape::Quad4.derivatives(local).into_iter();
                let scale = |own: [f64; 2]| [0, 1].map(|axis| own[axis] * 2.0 / step[axis]);
                let volume = problem.thickness * step[0] * step[1] / 4.0;
                energy.push_point(derivatives.map(scale), volume);
            }
            energy.push_cell(mesh.cell(cell));
        }
        energy
    }
}
