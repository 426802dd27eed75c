//! What happens at a group of a mesh: its mean displacement, and the moment of its supports.

use super::Discretised;
use super::loads::edge_lengths;
use crate::mesh::{Group, Mesh};
use crate::solve::State;

/// The share of each node in the mean of a group: over the length of its edges, or over its nodes where it has none.
///
/// ```text
/// ⟨u⟩ = Σ sᵢ uᵢ,   sᵢ = ∫ Nᵢ ds / ∫ ds
/// ```
///
/// A mean over nodes would depend on where they lie.
pub fn shares(mesh: &Mesh, group: &Group) -> Vec<(usize, f64)> {
    if group.edges.is_empty() {
        let share = 1.0 / group.nodes.len() as f64;
        return group.nodes.iter().map(|node| (*node, share)).collect();
    }
    let edges = group.edges.iter();
    let lengths: Vec<_> = edges.flat_map(|edge| edge_lengths(mesh, edge)).collect();
    let whole: f64 = lengths.iter().map(|(_, length)| length).sum();
    let shares = lengths.into_iter();
    shares
        .map(|(node, length)| (node, length / whole))
        .collect()
}

impl Discretised<'_> {
    /// The mean displacement of a group in mm, over the length of its edges, from a state.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn displacement(&self, state: &State, name: &str) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (node, share) in shares(self.mesh, &self.mesh.groups()[name]) {
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum += share * state.displacement[2 * node + axis];
            }
        }
        sum
    }

    /// The moment of the supports' forces on a group about the middle of its deformed nodes in N·mm,
    /// counter-clockwise, from a state.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn reaction_moment(&self, state: &State, name: &str) -> f64 {
        let nodes = &self.mesh.groups()[name].nodes;
        let place = |node: usize, axis: usize| {
            self.mesh.nodes[node][axis] + state.displacement[2 * node + axis]
        };
        let middle = [0, 1].map(|axis| {
            let places = nodes.iter().map(|node| place(*node, axis));
            places.sum::<f64>() / nodes.len() as f64
        });
        let forces = self.support_forces(state);
        let moment = |node: &usize| {
            let [x, y] = [0, 1].map(|axis| place(*node, axis) - middle[axis]);
            x * forces[2 * node + 1] - y * forces[2 * node]
        };
        nodes.iter().map(moment).sum()
    }
}
