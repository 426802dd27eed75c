//! The potential of loads.
//!
//! ```text
//! dead forces        Π = −s Σ fᵢ uᵢ                                                   [mJ]
//! ```
//!
//! Pressures have a module of their own.

use super::balance::{Body, Resultant};
use super::boundary_conditions::Load;
use super::constraints::Constraints;
use super::groups::{edge_lengths, named, refused, shares};
use super::pressure::Pressures;
use crate::error::Diagnostic;
use crate::mesh::Mesh;
use crate::solve::{Assembly, DeadForces, Potential, Sum};

/// All loads of a problem at load factor 1.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Dead force in N on each unknown, without the forces on grips.
    forces: Vec<f64>,
    /// Forces of grips: unknown, force in N.
    pulls: Vec<(usize, f64)>,
    /// The unknowns with dead forces or pulls, which may be zero.
    pushed: Vec<usize>,
    pressures: Pressures,
}

impl Loads {
    /// Loads by group on a mesh.
    pub fn of(mesh: &Mesh, loads: &[(String, Load)], thickness: f64) -> Result<Self, Diagnostic> {
        let mut sum = Self {
            forces: vec![0.0; 2 * mesh.nodes.len()],
            ..Self::default()
        };
        for load in loads {
            let forces = dead_forces(mesh, load, thickness)?;
            if let (name, Load::Pressure(pressure)) = load {
                let group = named("load", mesh, name)?;
                sum.pressures.add(mesh, group, pressure * thickness);
            }
            sum.add_forces(&forces);
        }
        Ok(sum)
    }

    /// Whether there are no loads.
    pub fn is_empty(&self) -> bool {
        self.pressures.edges.is_empty() && self.pushed.is_empty()
    }

    /// Adds dead forces in N.
    pub fn add_forces(&mut self, forces: &[f64]) {
        for (sum, force) in self.forces.iter_mut().zip(forces) {
            *sum += force;
        }
        self.find_pushed();
    }

    fn find_pushed(&mut self) {
        let unknowns = 0..self.forces.len();
        let mut masters: Vec<usize> = self.pulls.iter().map(|(master, _)| *master).collect();
        masters.sort_unstable();
        let is_pulled = |unknown: &usize| masters.binary_search(unknown).is_ok();
        let pushed = unknowns.filter(|unknown| self.forces[*unknown] != 0.0 || is_pulled(unknown));
        self.pushed = pushed.collect();
    }

    /// The dead force on an unknown and the pull of a grip there, in N.
    fn force(&self, unknown: usize) -> f64 {
        let pulls = self.pulls.iter().filter(|(pulled, _)| *pulled == unknown);
        self.forces[unknown] + pulls.map(|(_, force)| force).sum::<f64>()
    }

    /// Adds the forces on rigid grips, and finds where pressures end; all loads must have been added before.
    pub fn close(&mut self, constraints: &Constraints) {
        self.pulls.clone_from(&constraints.forces);
        self.find_pushed();
        let is_held = |unknown| constraints.held.contains_key(&unknown);
        self.pressures.close(&is_held);
    }

    /// The loads without the forces on grips.
    pub fn without_pulls(&self) -> Self {
        let mut loads = Self {
            pulls: Vec::new(),
            ..self.clone()
        };
        loads.find_pushed();
        loads
    }

    /// The resultant of all loads but the pulls of grips about the centre of the body with the displacements `u`, at a
    /// load factor.
    pub fn resultant(&self, factor: f64, u: &[f64], body: &Body) -> Resultant {
        let forces: Vec<f64> = self.forces.iter().map(|force| factor * force).collect();
        let dead = body.resultant(&forces);
        dead.plus(self.pressures.resultant(factor, u, body.from_middle))
    }

    /// The forces in N of all loads but the pulls of grips on the unknowns, at a load factor.
    pub fn nodal_forces(&self, factor: f64, u: &[f64]) -> Vec<f64> {
        let mut opposed = vec![0.0; u.len()];
        let pressures = self.pressures.at(factor, u.len());
        let evaluated = Assembly::residual(&pressures, u, &mut opposed);
        evaluated.expect("a pressure acts in every state");
        let forces = self.forces.iter().zip(opposed);
        forces
            .map(|(dead, opposed)| factor * dead - opposed)
            .collect()
    }

    /// The potential of an energy with these loads at a load factor.
    pub fn on<'a>(&'a self, energy: impl Potential + 'a, factor: f64) -> Box<dyn Potential + 'a> {
        if self.is_empty() {
            return Box::new(energy);
        }
        let unknowns = energy.unknowns();
        let pushed = self.pushed.iter();
        let forces = pushed.map(|unknown| (*unknown, factor * self.force(*unknown)));
        let forces = DeadForces::new(unknowns, forces);
        let pressures = self.pressures.at(factor, unknowns);
        Box::new(Sum::new(Sum::new(energy, pressures), forces))
    }
}

/// The forces in N of a dead load of a group on the unknowns of a mesh; a pressure has none.
pub fn dead_forces(
    mesh: &Mesh,
    (name, load): &(String, Load),
    thickness: f64,
) -> Result<Vec<f64>, Diagnostic> {
    let group = named("load", mesh, name)?;
    let need_edges = |what: &str| {
        if group.edges.is_empty() {
            let reason = format!("has no edges of the boundary, which {what} needs");
            let hint = "a load of kind \"force\" is spread over the lines and nodes of any group";
            Err(refused("load", name, &reason).hint(hint))
        } else {
            Ok(())
        }
    };
    let mut forces = vec![0.0; 2 * mesh.nodes.len()];
    match load {
        Load::Force(force) => {
            for (node, share) in shares(mesh, group) {
                forces[2 * node] += share * force[0];
                forces[2 * node + 1] += share * force[1];
            }
        }
        Load::Traction(traction) => {
            need_edges("a traction")?;
            for edge in &group.edges {
                for (node, length) in edge_lengths(mesh, edge) {
                    forces[2 * node] += traction[0] * thickness * length;
                    forces[2 * node + 1] += traction[1] * thickness * length;
                }
            }
        }
        Load::Pressure(_) => need_edges("a pressure")?,
    }
    Ok(forces)
}

#[cfg(test)]
mod tests;
