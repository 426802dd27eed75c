//! The built-in hyperelastic reference: quadrilateral elements of an incompressible sheet in plane stress.

use std::sync::Arc;

use crate::error::Error;
use crate::mesh::{CellShape, Mesh};
use crate::problem::{Model, Problem, Solution};
use crate::sheet_energy::{SamplingPoint, SheetEnergy};
use crate::solve::NewtonSettings;

pub mod convergence;

/// Degree of the elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// Four nodes, bilinear, 2 × 2 Gauss points.
    Q1,
    /// Nine nodes, biquadratic, 3 × 3 Gauss points.
    Q2,
}

impl Element {
    /// The names that studies use.
    pub const NAMES: [(&'static str, Self); 2] = [("Q1", Self::Q1), ("Q2", Self::Q2)];

    /// The element's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Q1 => "Q1",
            Self::Q2 => "Q2",
        }
    }

    fn shape(self) -> CellShape {
        match self {
            Self::Q1 => CellShape::Quad4,
            Self::Q2 => CellShape::Quad9,
        }
    }

    /// Points and weights of the Gauss rule on −1…1.
    fn gauss_rule(self) -> Vec<(f64, f64)> {
        match self {
            Self::Q1 => {
                let x = 1.0 / 3.0_f64.sqrt();
                vec![(-x, 1.0), (x, 1.0)]
            }
            Self::Q2 => {
                let x = 0.6_f64.sqrt();
                vec![(-x, 5.0 / 9.0), (0.0, 8.0 / 9.0), (x, 5.0 / 9.0)]
            }
        }
    }
}

/// A finite-element model of a problem on one mesh.
#[derive(Clone, Debug)]
pub struct FiniteElements {
    /// The mesh.
    pub mesh: Mesh,
    /// The element.
    pub element: Element,
    energy: SheetEnergy,
}

impl FiniteElements {
    /// Meshes the problem with `cells` elements.
    pub fn new(problem: &Problem, cells: [usize; 2], element: Element) -> Self {
        let mesh = Mesh::plate(problem.size, cells, element.shape());
        let rule = element.gauss_rule();
        let points = |cell: usize| {
            let grid = rule.iter().flat_map(|x| rule.iter().map(move |y| (x, y)));
            grid.map(|(x, y)| {
                let (gradients, jacobian) = gradients(&mesh, cell, [x.0, y.0]);
                SamplingPoint {
                    gradients,
                    volume: problem.thickness * jacobian * x.1 * y.1,
                }
            })
            .collect()
        };
        let cells = (0..mesh.cell_count()).map(|cell| (mesh.cell(cell), points(cell)));
        let energy = SheetEnergy::new(Arc::clone(&problem.law), mesh.nodes.len(), cells);
        Self {
            mesh,
            element,
            energy,
        }
    }

    /// The model as the solver sees it.
    pub fn model(&self) -> Model<'_> {
        let name = format!("finite elements ({})", self.describe());
        Model {
            name,
            mesh: &self.mesh,
            potential: &self.energy,
            describe: Box::new(|cell| self.mesh.describe_cell(cell)),
        }
    }

    /// `Q2, 120 × 40 cells`.
    pub fn describe(&self) -> String {
        let [nx, ny] = self.mesh.cells;
        format!("{}, {nx} × {ny} cells", self.element.name())
    }

    /// Solves all stretches of the problem, one after the other.
    ///
    /// # Errors
    /// [`Error::Solve`] with the stretch at which no solution was found.
    pub fn solve(
        &self,
        problem: &Problem,
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<Solution>, Error> {
        problem.follow(&self.model(), settings, progress)
    }
}

/// Gradients of the shape functions by X in 1/mm, and the Jacobian of the map in mm², at a reference point.
fn gradients(mesh: &Mesh, cell: usize, point: [f64; 2]) -> (Vec<[f64; 2]>, f64) {
    let derivatives = mesh.shape.derivatives(point);
    let mut map = [[0.0; 2]; 2]; // ∂X_i/∂ξ_j
    for (node, derivative) in mesh.cell(cell).iter().zip(&derivatives) {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            map[i][j] += mesh.nodes[*node][i] * derivative[j];
        }
    }
    let jacobian = map[0][0] * map[1][1] - map[0][1] * map[1][0];
    let transform = |d: &[f64; 2]| {
        [
            (d[0] * map[1][1] - d[1] * map[1][0]) / jacobian,
            (d[1] * map[0][0] - d[0] * map[0][1]) / jacobian,
        ]
    };
    (derivatives.iter().map(transform).collect(), jacobian)
}
