//! The mechanical problem: a sheet, its material, how it is held and how far it is stretched.

use std::sync::Arc;

use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::mesh::{Mesh, Side};
use crate::problem::DeformedSheet;
use crate::solve::{Convergence, Loading, NewtonSettings, Potential, State, follow, influence};

/// A rectangular plate between two rigid grips that clamp its short sides.
///
/// The left grip rests, the right one moves along X; the long sides are free. Free of any
/// discretisation: every model meshes it for itself.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Length between the grips and width in mm.
    pub size: [f64; 2],
    /// Thickness in mm.
    pub thickness: f64,
    /// The material.
    pub law: Arc<dyn HyperelasticLaw>,
    /// Grip displacements divided by the length, all of one sign, from small to large: 0.5 is a stretch to 150 %, −0.1 a
    /// compression to 90 %.
    pub stretches: Vec<f64>,
}

/// A discretised plate, as the solver sees it.
pub struct Model<'a> {
    /// The model's name for messages, such as `mass-spring (60 × 20 cells)`.
    pub name: String,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Its strain energy.
    pub potential: &'a dyn Potential,
    /// Names an element of the potential with its place, for messages.
    pub describe: Box<dyn Fn(usize) -> String + Sync + 'a>,
}

/// A model's equilibrium at one stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Grip displacement divided by the length.
    pub stretch: f64,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// Residual ∂Π/∂u in N: reactions at held unknowns.
    pub residual: Vec<f64>,
    /// Force on the moving grip in N.
    pub force: f64,
    /// Strain energy in mJ.
    pub energy: f64,
    /// Width at mid length in mm.
    pub mid_width: f64,
    /// Equilibria on the way from the stretch before, this one included; 1 when it was reached in one go.
    pub load_steps: usize,
    /// How the last of them was reached.
    pub convergence: Convergence,
}

/// A model of the plate between its grips; the load factor is the stretch.
struct PlateLoading<'a> {
    problem: &'a Problem,
    model: &'a Model<'a>,
}

impl Loading for PlateLoading<'_> {
    fn held(&self) -> Vec<bool> {
        self.problem.held(self.model.mesh)
    }

    fn impose(&self, stretch: f64, displacement: &mut [f64]) {
        let mesh = self.model.mesh;
        for node in 0..mesh.nodes.len() {
            if let Some(held) = self.problem.grip_displacement(mesh, node, stretch) {
                displacement[2 * node..2 * node + 2].copy_from_slice(&held);
            }
        }
    }

    fn potential(&self, _: f64) -> Box<dyn Potential + '_> {
        Box::new(self.model.potential)
    }

    /// The state before, scaled with the grips' motion, or the affine stretch.
    fn guess(&self, stretch: f64, previous: Option<&State>) -> Option<Vec<f64>> {
        Some(match previous {
            Some(previous) => {
                let ratio = stretch / previous.factor;
                previous.displacement.iter().map(|u| ratio * u).collect()
            }
            None => self.problem.affine(self.model.mesh, stretch),
        })
    }

    fn describe(&self, element: usize) -> String {
        (self.model.describe)(element)
    }

    fn describe_unknown(&self, unknown: usize) -> String {
        self.model.mesh.describe_unknown(unknown)
    }
}

impl Problem {
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

    /// Force on the moving grip: the sum of its reactions along X, in N.
    pub fn grip_force(&self, mesh: &Mesh, residual: &[f64]) -> f64 {
        let on_right = (0..mesh.nodes.len()).filter(|node| mesh.on(Side::Right, *node));
        on_right.map(|node| residual[2 * node]).sum()
    }

    /// Solves all stretches, one after the other, with any model of the plate. A stretch that cannot be
    /// reached from the one before in one go is approached by halves.
    ///
    /// # Errors
    /// [`Error::Solve`] with the stretch at which no solution was found.
    pub fn follow(
        &self,
        model: &Model,
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<Solution>, Error> {
        match self.follow_as_far(model, settings, progress) {
            (solutions, None) => Ok(solutions),
            (_, Some(end)) => Err(end),
        }
    }

    /// The same as far as there are solutions: those that were found, and why there are no more of them.
    pub fn follow_as_far(
        &self,
        model: &Model,
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> (Vec<Solution>, Option<Error>) {
        let plate = PlateLoading {
            problem: self,
            model,
        };
        let (states, end) = match follow(&plate, &self.stretches, settings, progress) {
            Ok(states) => (states, None),
            Err(end) => {
                let error = Error::Solve {
                    model: model.name.clone(),
                    step: format!(
                        "{} (reached {} %)",
                        Problem::describe_step(end.factor),
                        Self::percent(end.reached())
                    ),
                    fault: end.fault,
                };
                (end.states, Some(error))
            }
        };
        let solutions = states.into_iter();
        let solutions = solutions.map(|state| self.solution(model.mesh, state));
        (solutions.collect(), end)
    }

    /// The field in mm/mm that a motion of the right grip along X brings about, by the tangent at a solution.
    ///
    /// # Errors
    /// [`Error::Solve`] when the tangent cannot be factorised.
    pub fn influence(&self, model: &Model, solution: &Solution) -> Result<Vec<f64>, Error> {
        let plate = PlateLoading {
            problem: self,
            model,
        };
        let nodes = 0..model.mesh.nodes.len();
        let moves = |node| [f64::from(u8::from(model.mesh.on(Side::Right, node))), 0.0];
        let motion: Vec<f64> = nodes.flat_map(moves).collect();
        let state = (solution.stretch, &*solution.displacement);
        influence(&plate, state, &motion).map_err(|fault| Error::Solve {
            model: model.name.clone(),
            step: Problem::describe_step(solution.stretch),
            fault,
        })
    }

    fn solution(&self, mesh: &Mesh, state: State) -> Solution {
        Solution {
            stretch: state.factor,
            force: self.grip_force(mesh, &state.residual),
            energy: state.convergence.energy,
            mid_width: mesh.mid_width(&state.displacement),
            displacement: state.displacement,
            residual: state.residual,
            load_steps: state.load_steps,
            convergence: state.convergence,
        }
    }

    /// A solution on a mesh, ready to be asked at any point of the plate.
    pub fn deformed(&self, mesh: &Mesh, solution: &Solution) -> DeformedSheet {
        DeformedSheet::new(
            mesh.clone(),
            solution.displacement.clone(),
            Arc::clone(&self.law),
        )
    }

    /// `50 % stretch`, for messages.
    pub fn describe_step(stretch: f64) -> String {
        format!("{} % stretch", Self::percent(stretch))
    }

    /// A ratio in percent, as short as it can be written.
    pub fn percent(ratio: f64) -> String {
        let text = format!("{:.4}", 100.0 * ratio);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}
