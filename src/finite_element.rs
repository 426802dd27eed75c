//! The built-in hyperelastic reference: quadrilateral elements of an incompressible sheet in plane stress.

use std::sync::Arc;

use crate::error::Error;
use crate::mesh::{CellShape, Grid, Mesh};
use crate::problem::plate::{Model, Problem, Solution};
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::NewtonSettings;

use error_estimate::{ErrorEstimate, Solved};
use recovery::Recovery;

pub mod convergence;
pub mod error_estimate;
pub mod recovery;

/// Degree of the elements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Element {
    /// Four nodes, bilinear, 2 × 2 Gauss points.
    Q1,
    /// Nine nodes, biquadratic, 3 × 3 Gauss points. The default.
    #[default]
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
        Self::graded(problem, cells, element, 1.0)
    }

    /// Meshes the problem with `cells` elements that become smaller towards the corners; see [`Grid`].
    pub fn graded(problem: &Problem, cells: [usize; 2], element: Element, grading: f64) -> Self {
        let grid = Grid {
            size: problem.size,
            cells,
            grading,
        };
        let mesh = Mesh::of_grid(grid, element.shape());
        let energy = SheetEnergy::of_mesh(Arc::clone(&problem.law), &mesh, problem.thickness);
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

    /// The strain energy.
    pub fn energy(&self) -> &SheetEnergy {
        &self.energy
    }

    /// `Q2, 120 × 40 cells`.
    pub fn describe(&self) -> String {
        format!("{}, {}", self.element.name(), self.mesh.describe())
    }

    /// The estimated error of a solution, by the recovery on this mesh.
    ///
    /// # Errors
    /// [`Error::Solve`] when the tangent at the solution cannot be factorised.
    pub fn estimate(
        &self,
        problem: &Problem,
        solution: &Solution,
        recovery: &Recovery,
    ) -> Result<ErrorEstimate, Error> {
        let influence = problem.influence(&self.model(), solution)?;
        let solved = Solved {
            law: &*problem.law,
            thickness: problem.thickness,
            mesh: &self.mesh,
            displacement: &solution.displacement,
        };
        Ok(solved.estimate(recovery, &influence))
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
