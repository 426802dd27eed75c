//! The built-in hyperelastic reference: a plate of quadrilateral finite elements, with any law of the library.

use std::sync::Arc;

use crate::document::name_of;
use crate::error::{Error, SolveFault};
use crate::mesh::{CellShape, Grid, Mesh, Side};
use crate::problem::sheet_energy::SheetEnergy;
use crate::problem::{CellLaws, ClampedPlate, Model};
use crate::solve::{LinearSolver, NewtonSettings, State};

use error_estimate::{ErrorEstimate, SheetSolution, side_by_side};
pub use quarter::Quarter;
use recovery::Recovery;

pub mod convergence;
pub mod error_estimate;
mod quarter;
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
        name_of(&Self::NAMES, self)
    }

    /// Its cells.
    pub fn shape(self) -> CellShape {
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
    pub fn new(plate: &ClampedPlate, cells: [usize; 2], element: Element) -> Self {
        Self::graded(plate, cells, element, 1.0)
    }

    /// Meshes the problem with `cells` elements that become smaller towards the corners; see [`Grid`].
    pub fn graded(plate: &ClampedPlate, cells: [usize; 2], element: Element, grading: f64) -> Self {
        let grid = Grid::new(plate.size, cells, grading);
        let mesh = Mesh::of_grid(grid, element.shape());
        let energy = SheetEnergy::of_mesh(Arc::clone(&plate.law), &mesh, plate.thickness);
        Self {
            mesh,
            element,
            energy,
        }
    }

    /// The plate on this mesh.
    pub fn model(&self, plate: &ClampedPlate) -> Model<'_> {
        let name = format!("finite elements ({})", self.describe());
        plate.on(&self.mesh, &self.energy).named(name)
    }

    /// The strain energy.
    pub fn energy(&self) -> &SheetEnergy {
        &self.energy
    }

    /// `Q2, 120 × 40 cells`.
    pub fn describe(&self) -> String {
        format!("{}, {}", self.element.name(), self.mesh.describe())
    }

    /// The estimated error of each of several states, by recovery on this mesh; a [`SolveFault`] where the tangent at the state cannot be
    /// factorised. No loading history enters: where the material softens, the estimate is that of a first loading.
    pub fn estimates(
        &self,
        plate: &ClampedPlate,
        states: &[State],
        recovery: &Recovery,
    ) -> Vec<Result<ErrorEstimate, SolveFault>> {
        let quarter = Quarter::of(plate, &self.mesh, LinearSolver::Automatic);
        let by_quarter = quarter.and_then(|quarter| quarter.influences(states));
        let by_full_plate = || self.model(plate).influences(states, Side::Right.name(), 0);
        let influences = by_quarter.unwrap_or_else(by_full_plate);
        let laws = CellLaws::from(Arc::clone(&plate.law));
        let solved = states.iter().map(|state| SheetSolution {
            laws: &laws,
            thickness: plate.thickness,
            mesh: &self.mesh,
            displacement: &state.displacement,
        });
        side_by_side(solved.collect(), recovery, influences)
    }

    /// Solves all stretches of the plate, one after the other.
    ///
    /// # Errors
    /// [`Error::Solve`] with the stretch at which no solution was found.
    pub fn solve(
        &self,
        plate: &ClampedPlate,
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<State>, Error> {
        let model = self.model(plate);
        model.reach_all(&plate.stretches, settings, progress)
    }
}
