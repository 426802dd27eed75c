//! Nested correction on any shape: springs are solved and corrected on the coarsest of some meshes, and the field is carried from mesh to mesh.
//!
//! ```text
//! u₀ on the next mesh = I u + q I s          I: interpolation by the elements, s: the change on the mesh before
//! s q + s q² + … = s q/(1 − q)               what all finer meshes would add: the discretisation error
//! ```
//!
//! Changes shrink from mesh to mesh by the ratio q, so that u₀ is about as far from the equilibrium as the discretisation error: Newton's
//! method needs a factor or two on each mesh and no load steps. All supports, loads, laws without a memory, and elements are admitted; where
//! the iteration does not converge from u₀, load steps from rest lead to the field.
//!
//! ```
//! use std::sync::Arc;
//!
//! use gelbench_corrector::corrector::nested::NestedMeshes;
//! use gelbench_mechanics::material::NeoHooke;
//! use gelbench_mechanics::mesh::{CellShape, Mesh, Shape};
//! use gelbench_mechanics::problem::{BoundaryProblem, Support};
//!
//! let strip = Shape::StripWithHole { size: [40.0, 20.0], radius: 4.0 };
//! let meshes: Vec<Mesh> = (0..3).map(|level| strip.mesh(3 << level, CellShape::Quad4)).collect();
//! let problem = BoundaryProblem {
//!     thickness: 2.0,
//!     law: Arc::new(NeoHooke { c10: 0.05 }),
//!     regions: Vec::new(),
//!     supports: vec![
//!         ("left".into(), Support::Displacement([Some(0.0), Some(0.0)])),
//!         ("right".into(), Support::Displacement([Some(20.0), Some(0.0)])),
//!     ],
//!     loads: Vec::new(),
//! };
//! let nested = NestedMeshes::new(&problem, &meshes);
//! let [half, whole] = [0.5, 1.0].map(|factor| nested.correct(factor));
//! assert!(whole?.discretisation_error > half?.discretisation_error);
//! # Ok::<(), gelbench_base::error::Error>(())
//! ```

use super::climb::{Ratios, geometric_tail};
use super::specimen::correct_without_multipliers;
use crate::error::Error;
use crate::mass_spring::MassSpring;
use crate::material::softened_law::check_memory;
use crate::mesh::{Interpolation, Mesh};
use crate::problem::sheet_energy::SheetEnergy;
use crate::problem::{BoundaryProblem, Model};
use crate::solve::vector::{add_scaled, difference, norm};
use crate::solve::{Loading, NewtonSettings, Stage, State};

/// The springs are a first guess, which the correction changes by some hundredths.
const SPRINGS: NewtonSettings = NewtonSettings {
    tolerance: 5e-2,
    max_iterations: 8,
};

/// The tolerance on all meshes but the finest: the change to the next mesh is far larger.
const COARSER: NewtonSettings = NewtonSettings {
    tolerance: 1e-4,
    max_iterations: 60,
};

const FINEST: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// Iterations after which a start was no good guess: load steps from rest take about as many.
const MOST_FROM_GUESS: usize = 8;

/// A corrected field on the finest mesh.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NestedCorrection {
    /// The state on the finest mesh.
    pub state: State,
    /// The estimated discretisation error of the field, root mean square over the nodes in mm; NaN where there is one mesh only.
    pub discretisation_error: f64,
}

/// The meshes of a problem from coarse to fine, each with about half the spacing of the one before; they need not be nested.
pub struct NestedMeshes<'a> {
    problem: &'a BoundaryProblem,
    meshes: &'a [Mesh],
    energies: Vec<SheetEnergy>,
    /// Interpolations from each mesh to the next finer one.
    interpolations: Vec<Interpolation>,
}

impl<'a> NestedMeshes<'a> {
    /// Prepares the meshes.
    ///
    /// # Panics
    /// Without a mesh.
    pub fn new(problem: &'a BoundaryProblem, meshes: &'a [Mesh]) -> Self {
        assert!(!meshes.is_empty(), "a mesh");
        let energies = meshes.iter().map(|mesh| problem.finite_elements(mesh));
        let pairs = meshes.windows(2);
        Self {
            energies: energies.collect(),
            interpolations: pairs
                .map(|pair| pair[0].interpolation_on(&pair[1]))
                .collect(),
            problem,
            meshes,
        }
    }

    /// Corrects the springs' field at a load factor.
    ///
    /// # Errors
    /// [`Error::Input`] where a mesh does not suit the problem or the law has a memory, [`Error::Solve`] where no field was found.
    pub fn correct(&self, factor: f64) -> Result<NestedCorrection, Error> {
        for law in self.problem.laws().all() {
            check_memory(&**law, "nested correction")?;
        }
        let mut state = self.correct_on_coarsest(factor)?;
        let (mut change, mut size) = (None::<Vec<f64>>, f64::NAN);
        let mut ratio = Ratios::MEASURED.first;
        for level in 1..self.meshes.len() {
            let model = self.model(level)?;
            let interpolation = &self.interpolations[level - 1];
            let mut carried = interpolation.apply(&state.displacement);
            model.impose(factor, &mut carried);
            let mut start = carried.clone();
            if let Some(change) = &change {
                add_scaled(&mut start, ratio, &interpolation.apply(change));
                model.impose(factor, &mut start);
            }
            state = self.equilibrium(&model, level, factor, &start)?;
            let difference = difference(&state.displacement, &carried);
            let before = size;
            size = norm(&difference) / (model.mesh.nodes.len() as f64).sqrt();
            if size > 0.0 {
                ratio = Ratios::MEASURED.measured([before, size], ratio);
            }
            change = Some(difference);
        }
        Ok(NestedCorrection {
            state,
            discretisation_error: geometric_tail(size, ratio),
        })
    }

    /// The corrected springs' field on the coarsest mesh; where the springs have none, or it is no good guess, finite
    /// elements begin at rest.
    fn correct_on_coarsest(&self, factor: f64) -> Result<State, Error> {
        let (problem, mesh) = (self.problem, &self.meshes[0]);
        let lattice = match mesh.degree() {
            1 => mesh.clone(),
            _ => mesh.refined().linear(),
        };
        let springs = MassSpring::on_mesh(problem.laws(), problem.thickness, lattice);
        let by_springs = problem
            .on(&springs.mesh, springs.potential())?
            .describing(|element| springs.describe_element(element));
        let model = self.model(0)?;
        match by_springs.reach(&[factor], SPRINGS) {
            Ok(state) => {
                let start = springs
                    .mesh
                    .interpolation_on(mesh)
                    .apply(&state.displacement);
                self.equilibrium(&model, 0, factor, &start)
            }
            Err(_) => model.reach(&[factor], self.settings(0)),
        }
    }

    /// The equilibrium near a field, or by load steps from rest.
    fn equilibrium(
        &self,
        model: &Model,
        level: usize,
        factor: f64,
        start: &[f64],
    ) -> Result<State, Error> {
        let settings = self.settings(level);
        let near = NewtonSettings {
            max_iterations: MOST_FROM_GUESS,
            ..settings
        };
        let corrected = correct_without_multipliers(model, start, Stage::first(factor), near);
        corrected.or_else(|_| model.reach(&[factor], settings))
    }

    fn settings(&self, level: usize) -> NewtonSettings {
        if level + 1 == self.meshes.len() {
            FINEST
        } else {
            COARSER
        }
    }

    fn model(&self, level: usize) -> Result<Model<'_>, Error> {
        let model = self
            .problem
            .on(&self.meshes[level], &self.energies[level])?;
        Ok(model.named("corrector"))
    }
}
