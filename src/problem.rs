//! The mechanical problem: a sheet, its material, how it is held and how far it is stretched.

use std::sync::Arc;

use crate::error::{Error, SolveFault};
use crate::material::HyperelasticLaw;
use crate::mesh::{Mesh, Side};
use crate::solve::{Convergence, Newton, NewtonSettings, Potential};

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
    /// Grip displacements divided by the length, ascending: 0.5 is a stretch to 150 %.
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
    pub describe: Box<dyn Fn(usize) -> String + 'a>,
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

/// How often the way to a stretch is halved before it is given up.
const HALVINGS: usize = 5;

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

    /// A first guess for `stretch`: the previous solution scaled with the grips' motion, or the affine
    /// stretch. The grips' displacements are exact in it.
    pub fn first_guess(&self, mesh: &Mesh, stretch: f64, previous: Option<&Solution>) -> Vec<f64> {
        let mut guess = match previous {
            Some(previous) => {
                let ratio = stretch / previous.stretch;
                previous.displacement.iter().map(|u| ratio * u).collect()
            }
            None => self.affine(mesh, stretch),
        };
        for node in 0..mesh.nodes.len() {
            if let Some(held) = self.grip_displacement(mesh, node, stretch) {
                guess[2 * node..2 * node + 2].copy_from_slice(&held);
            }
        }
        guess
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
        let fault = |stretch: f64, fault: SolveFault| Error::Solve {
            model: model.name.clone(),
            step: Problem::describe_step(stretch),
            fault,
        };
        let mut newton = Newton::new(model.potential, &self.held(model.mesh))
            .map_err(|cause| fault(self.stretches[0], cause))?;
        let mut solutions: Vec<Solution> = Vec::new();
        for &stretch in &self.stretches {
            let solution = self
                .reach(
                    model,
                    &mut newton,
                    settings,
                    solutions.last(),
                    stretch,
                    HALVINGS,
                )
                .map_err(|cause| fault(stretch, cause))?;
            solutions.push(solution);
            progress(stretch);
        }
        Ok(solutions)
    }

    /// Solves one stretch from the solution before it, through intermediate ones where it must.
    fn reach(
        &self,
        model: &Model,
        newton: &mut Newton,
        settings: NewtonSettings,
        previous: Option<&Solution>,
        stretch: f64,
        halvings: usize,
    ) -> Result<Solution, SolveFault> {
        let direct = self.solve_at(model, newton, settings, previous, stretch);
        if direct.is_ok() || halvings == 0 {
            return direct;
        }
        let half = 0.5 * (previous.map_or(0.0, |previous| previous.stretch) + stretch);
        let half = self.reach(model, newton, settings, previous, half, halvings - 1)?;
        let solution = self.reach(model, newton, settings, Some(&half), stretch, halvings - 1)?;
        Ok(Solution {
            load_steps: half.load_steps + solution.load_steps,
            ..solution
        })
    }

    fn solve_at(
        &self,
        model: &Model,
        newton: &mut Newton,
        settings: NewtonSettings,
        previous: Option<&Solution>,
        stretch: f64,
    ) -> Result<Solution, SolveFault> {
        let mesh = model.mesh;
        let mut displacement = self.first_guess(mesh, stretch, previous);
        let mut residual = vec![0.0; displacement.len()];
        let convergence = newton.solve(
            model.potential,
            &mut displacement,
            &mut residual,
            settings,
            &model.describe,
        )?;
        Ok(Solution {
            stretch,
            force: self.grip_force(mesh, &residual),
            energy: convergence.energy,
            mid_width: mesh.mid_width(&displacement),
            displacement,
            residual,
            load_steps: 1,
            convergence,
        })
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
