//! A rectangular plate between two rigid grips: the boundary value problem that the models are compared on.

use std::sync::Arc;

use super::boundary::BoundaryProblem;
use super::boundary_conditions::Support;
use super::deformed::DeformedSheet;
use super::model::Model;
use crate::material::HyperelasticLaw;
use crate::mesh::{Mesh, Side};
use crate::solve::{PathEnd, Remembering, State};

/// A rectangular plate between two rigid grips that clamp its short sides.
///
/// The left grip rests, the right one moves along X; the long sides are free. The plate has no discretisation of its
/// own: every model meshes it. Its load factor is the stretch.
#[derive(Clone, Debug)]
pub struct ClampedPlate {
    /// Length between the grips and width in mm.
    pub size: [f64; 2],
    /// Thickness in mm.
    pub thickness: f64,
    /// The material.
    pub law: Arc<dyn HyperelasticLaw>,
    /// λ − 1 of the plate, the displacement of the right grip over the length, in loading order: 0.5 is a stretch to 150 %, −0.1
    /// a compression to 90 %. For a material without memory they have one sign and go from small to large.
    pub stretches: Vec<f64>,
}

impl ClampedPlate {
    /// The plate as a boundary value problem with the grips as supports.
    pub fn boundary_problem(&self) -> BoundaryProblem {
        let grip = |side: Side, along: f64| {
            let support = Support::Displacement([Some(along), Some(0.0)]);
            (side.name().to_owned(), support)
        };
        let grips = vec![grip(Side::Left, 0.0), grip(Side::Right, self.size[0])];
        BoundaryProblem::supported(self.thickness, Arc::clone(&self.law), grips)
    }

    /// The plate on a mesh of it with an energy of its nodal displacements; every first guess is a multiple of the
    /// state before, or the affine stretch.
    ///
    /// # Panics
    /// When the mesh is not one of the plate.
    pub fn on<'a>(&self, mesh: &'a Mesh, energy: &'a dyn Remembering) -> Model<'a> {
        let model = self.boundary_problem().on(mesh, energy);
        let model = model.expect("the sides of a plate are groups of its mesh");
        model
            .guessing(self.affine(mesh, 1.0))
            .describing_ends(Self::describe_end)
    }

    /// Marks the unknowns of `mesh` that the grips hold.
    pub fn held(&self, mesh: &Mesh) -> Vec<bool> {
        (0..2 * mesh.nodes.len())
            .map(|unknown| mesh.on_grip(unknown / 2))
            .collect()
    }

    /// The displacement that the grips impose on a node, if they hold it.
    pub fn grip_displacement(&self, mesh: &Mesh, node: usize, stretch: f64) -> Option<[f64; 2]> {
        if mesh.on(Side::Left, node) {
            Some([0.0, 0.0])
        } else {
            mesh.on(Side::Right, node)
                .then_some([stretch * self.size[0], 0.0])
        }
    }

    /// The affine stretch: ux = stretch · X, uy = 0.
    pub fn affine(&self, mesh: &Mesh, stretch: f64) -> Vec<f64> {
        mesh.nodes
            .iter()
            .flat_map(|[x, _]| [stretch * x, 0.0])
            .collect()
    }

    /// A state on a mesh, to be evaluated at any point of the plate.
    pub fn deformed(&self, mesh: &Mesh, state: &State) -> DeformedSheet {
        self.boundary_problem().deformed(mesh, state)
    }

    /// `50 % stretch`, for messages.
    pub fn describe_step(stretch: f64) -> String {
        format!("{} % stretch", Self::percent(stretch))
    }

    /// `50 % stretch (reached 43.2 %)`, for messages.
    pub fn describe_end(end: &PathEnd) -> String {
        format!(
            "{} (reached {} %)",
            Self::describe_step(end.factor),
            Self::percent(end.reached())
        )
    }

    /// A ratio in percent, as short as it can be written.
    pub fn percent(ratio: f64) -> String {
        let text = format!("{:.4}", 100.0 * ratio);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// Measured quantities of a plate in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Force on the moving grip in N.
    pub force: f64,
    /// Width at mid length in mm.
    pub mid_width: f64,
    /// Strain energy in mJ.
    pub energy: f64,
}

impl Measures {
    /// The measures of a state on a mesh of the plate.
    pub fn of(mesh: &Mesh, state: &State) -> Self {
        let on_right = (0..mesh.nodes.len()).filter(|node| mesh.on(Side::Right, *node));
        Self {
            force: on_right.map(|node| state.residual[2 * node]).sum(),
            mid_width: mesh.mid_width(&state.displacement),
            energy: state.convergence.energy,
        }
    }
}
