//! The potential of loads.
//!
//! ```text
//! dead forces        Π = −s Σ fᵢ uᵢ                                                   [mJ]
//! ```
//!
//! Pressures have a module of their own.

use super::Load;
use super::balance::Resultant;
use super::pressure::Pressures;
use super::supports::Supported;
use crate::mesh::{Group, Mesh};
use crate::solve::{DeadForces, Potential, Sum};

/// All loads of a problem at load factor 1.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// Dead force in N on each unknown, without those of grips.
    forces: Vec<f64>,
    /// Forces of grips: unknown, force in N.
    pulls: Vec<(usize, f64)>,
    /// The unknowns that have dead forces or pulls.
    pushed: Vec<usize>,
    pressures: Pressures,
}

impl Loaded {
    /// No loads on so many unknowns.
    pub fn new(unknowns: usize) -> Self {
        Self {
            forces: vec![0.0; unknowns],
            ..Self::default()
        }
    }

    /// Whether there are none.
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
        let pushed = unknowns.filter(|unknown| self.force(*unknown) != 0.0);
        self.pushed = pushed.collect();
    }

    /// The dead force on an unknown and the pull of a grip there, in N.
    fn force(&self, unknown: usize) -> f64 {
        let own = self.pulls.iter().filter(|(pulled, _)| *pulled == unknown);
        self.forces[unknown] + own.map(|(_, force)| force).sum::<f64>()
    }

    /// Adds a load on a group.
    ///
    /// # Errors
    /// Says why the group cannot carry it.
    pub fn add(
        &mut self,
        mesh: &Mesh,
        group: &Group,
        load: &Load,
        thickness: f64,
    ) -> Result<(), String> {
        let forces = dead_forces(mesh, group, load, thickness)?;
        if let Load::Pressure(pressure) = load {
            self.pressures.add(mesh, group, pressure * thickness);
        }
        self.add_forces(&forces);
        Ok(())
    }

    /// Adds the forces on rigid grips, and finds where pressures end; all loads must be known.
    pub fn close(&mut self, supported: &Supported) {
        self.pulls.clone_from(&supported.forces);
        self.find_pushed();
        let is_held = |unknown| supported.held.contains_key(&unknown);
        self.pressures.close(&is_held);
    }

    /// The same loads without the forces on grips.
    pub fn without_pulls(&self) -> Self {
        let mut loads = Self {
            pulls: Vec::new(),
            ..self.clone()
        };
        loads.find_pushed();
        loads
    }

    /// The resultant of all loads but the pulls of grips about a point, at a load factor; `places` are the deformed
    /// ones of the nodes, `middle` the point to which the mesh's own coordinates are relative.
    pub fn resultant(
        &self,
        factor: f64,
        (places, u): (&[[f64; 2]], &[f64]),
        (centre, middle): ([f64; 2], [f64; 2]),
    ) -> Resultant {
        let forces: Vec<f64> = self.forces.iter().map(|force| factor * force).collect();
        let dead = Resultant::of_nodes(places, &forces, centre);
        let about = [0, 1].map(|axis| centre[axis] - middle[axis]);
        dead.plus(self.pressures.resultant(factor, u, about))
    }

    /// The potential of an energy with these loads at a load factor.
    pub fn at<'a>(&'a self, energy: &'a dyn Potential, factor: f64) -> Sum<'a> {
        let unknowns = energy.unknowns();
        let force = |unknown: &usize| (*unknown, factor * self.force(*unknown));
        let forces = DeadForces::new(unknowns, self.pushed.iter().map(force));
        let pressures = self.pressures.at(factor, unknowns);
        Sum::new(Sum::new(energy, pressures), forces)
    }
}

/// The forces in N of a dead load on the unknowns of a mesh; a pressure has none.
///
/// # Errors
/// Says why the group cannot carry the load.
pub fn dead_forces(
    mesh: &Mesh,
    group: &Group,
    load: &Load,
    thickness: f64,
) -> Result<Vec<f64>, String> {
    let mut forces = vec![0.0; 2 * mesh.nodes.len()];
    match load {
        Load::Force(force) => {
            let share = 1.0 / group.nodes.len() as f64;
            for node in &group.nodes {
                forces[2 * node] += share * force[0];
                forces[2 * node + 1] += share * force[1];
            }
        }
        Load::Traction(traction) => {
            need_edges(group, "a traction")?;
            for edge in &group.edges {
                for (node, length) in edge_lengths(mesh, edge) {
                    forces[2 * node] += traction[0] * thickness * length;
                    forces[2 * node + 1] += traction[1] * thickness * length;
                }
            }
        }
        Load::Pressure(_) => need_edges(group, "a pressure")?,
    }
    Ok(forces)
}

fn need_edges(group: &Group, what: &str) -> Result<(), String> {
    if group.edges.is_empty() {
        return Err(format!("has no edges of the boundary, which {what} needs"));
    }
    Ok(())
}

/// The share of an edge's length that belongs to each of its nodes, in mm.
pub fn edge_lengths(mesh: &Mesh, edge: &[usize]) -> Vec<(usize, f64)> {
    const GAUSS: [(f64, f64); 3] = [
        (-0.774_596_669_241_483_4, 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (0.774_596_669_241_483_4, 5.0 / 9.0),
    ];
    let mut shares: Vec<(usize, f64)> = edge.iter().map(|node| (*node, 0.0)).collect();
    for (x, weight) in GAUSS {
        let (values, slopes) = edge_functions(edge.len(), x);
        let tangent = [0, 1].map(|axis| {
            let nodes = edge.iter().zip(&slopes);
            nodes
                .map(|(node, slope)| slope * mesh.nodes[*node][axis])
                .sum::<f64>()
        });
        let length = tangent[0].hypot(tangent[1]);
        for (share, value) in shares.iter_mut().zip(values) {
            share.1 += weight * value * length;
        }
    }
    shares
}

/// Values and derivatives of an edge's functions at −1 ≤ x ≤ 1: both ends, then the middle.
fn edge_functions(nodes: usize, x: f64) -> (Vec<f64>, Vec<f64>) {
    if nodes == 2 {
        return (vec![0.5 * (1.0 - x), 0.5 * (1.0 + x)], vec![-0.5, 0.5]);
    }
    (
        vec![0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x],
        vec![x - 0.5, x + 0.5, -2.0 * x],
    )
}
