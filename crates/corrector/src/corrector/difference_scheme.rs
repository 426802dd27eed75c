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
//! | Gauss | ⅓ | both edges, weighted | 0.028 %, 0.39 %, 0.05 % |
//! | biquadratic | 0, ⅗ | over two by two cells, 3 × 3 points | 0.013 %, 0.18 %, 0.02 % |
//! | bicubic | 0.116, 0.742 | over three by three cells, 4 × 4 points | 0.009 %, 0.12 %, 0.01 % (60 × 21 cells) |
//!
//! The Gauss points integrate the energy of the cell to third order. The equations are then those of the
//! bilinear finite element: the corrector needs no more of that method than this stencil. The biquadratic scheme
//! passes parabolas through three nodes along each axis; its equations are those of the nine-node element on
//! two by two cells. The bicubic scheme passes cubics through four nodes, which lie at Lobatto's points of three by three
//! cells; it gains where the departure from affine shall be exact to 1e-3 % and better. Quartic ones gain from 1e-6 % on only,
//! and are left out.

use crate::mesh::{CellShape, Grid, Mesh};
use crate::problem::ClampedPlate;
use crate::problem::sheet_energy::SheetEnergy;

use super::sampling::{self, CUBIC, LINEAR, QUADRATIC};

/// Where in a cell the differences are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DifferenceScheme {
    /// In the four Gauss points: weighted differences.
    Gauss,
    /// In nine Gauss points of two by two cells: differences of second order. The default.
    #[default]
    Biquadratic,
    /// In sixteen Gauss points of three by three cells: differences of third order.
    Bicubic,
}

impl DifferenceScheme {
    /// The names that studies use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("gauss", Self::Gauss),
        ("biquadratic", Self::Biquadratic),
        ("bicubic", Self::Bicubic),
    ];

    /// Number of cells along each axis that are taken together: the degree of the polynomials.
    pub fn side(self) -> usize {
        match self {
            Self::Gauss => 1,
            Self::Biquadratic => 2,
            Self::Bicubic => 3,
        }
    }

    /// The grading of cells towards clamped corners with the least error in a given time; see [`Climb::graded`]. Measured on
    /// plates of three laws, two proportions and stretches of 10 to 100 %, with gradings of 1, 1.5, 2 and 3; that of the bicubic scheme
    /// on one plate, with 1.5 to 4.
    ///
    /// [`Climb::graded`]: super::climb::Climb::graded
    pub fn grading(self) -> f64 {
        match self {
            Self::Gauss => 1.5,
            Self::Biquadratic => 2.0,
            Self::Bicubic => 2.5,
        }
    }

    /// Whether its nodes are not those of equal cells even where the grading is 1.
    pub fn has_own_nodes(self) -> bool {
        self == Self::Bicubic
    }

    /// The four-node cells of a plate that the scheme corrects on, smaller towards the corners the larger the grading is; the nodes are
    /// those of [`Climb::graded`].
    ///
    /// # Panics
    /// When the scheme takes cells together and their number is no multiple of that, or the grading is below 1.
    ///
    /// [`Climb::graded`]: super::climb::Climb::graded
    pub fn graded(self, size: [f64; 2], cells: [usize; 2], grading: f64) -> Mesh {
        let grid = Grid {
            together: self.side(),
            ..Grid::new(size, cells, grading)
        };
        Mesh::of_grid(grid, CellShape::Quad4)
    }

    /// The scheme's energy on the nodes of a plate's mesh of four-node cells, as [`Self::graded`] makes them.
    ///
    /// # Panics
    /// When the scheme takes cells together and their number is no multiple of that.
    pub fn energy(self, problem: &ClampedPlate, mesh: &Mesh) -> SheetEnergy {
        let grid = mesh.grid();
        self.energy_between(problem, &[0, 1].map(|axis| grid.lines(axis)))
    }

    /// The scheme's energy between the lines of a plate's nodes, whose numbers run line by line along Y.
    ///
    /// # Panics
    /// When the scheme takes cells together and their number is no multiple of that.
    pub fn energy_between(
        self,
        problem: &ClampedPlate,
        coordinates: &[Vec<f64>; 2],
    ) -> SheetEnergy {
        match self {
            Self::Gauss => sampling::energy(problem, coordinates, &LINEAR),
            Self::Biquadratic => sampling::energy(problem, coordinates, &QUADRATIC),
            Self::Bicubic => sampling::energy(problem, coordinates, &CUBIC),
        }
    }

    /// Cells whose shape functions tell what the scheme takes a field for between the nodes of a plate's mesh of four-node cells, with
    /// the values of [`between_nodes`](super::climb::between_nodes). Nine-node cells pass through nodes in the middle of the bicubic scheme's cells.
    pub fn mesh(self, mesh: &Mesh) -> Mesh {
        let grid = mesh.grid();
        match self {
            Self::Gauss => mesh.clone(),
            Self::Biquadratic => {
                let pairs = grid.cells.map(|cells| cells / 2);
                Mesh::of_grid(Grid::new(grid.size, pairs, grid.grading), CellShape::Quad9)
            }
            Self::Bicubic => Mesh::of_grid(grid, CellShape::Quad9),
        }
    }

    /// The cells that are taken together, each as one of four nodes.
    pub fn elements(self, mesh: &Mesh) -> Mesh {
        let grid = mesh.grid();
        let elements = grid.cells.map(|cells| cells / self.side());
        Mesh::of_grid(
            Grid::new(grid.size, elements, grid.grading),
            CellShape::Quad4,
        )
    }
}
