//! Results from a state of a model: the forces of its supports, the state of groups, and the balance of all forces.

use std::collections::BTreeMap;

use super::balance::{Balance, Body, Resultant};
use super::constraints::Constraints;
use super::groups::{mean, shares};
use super::model::Model;
use crate::solve::{Assembly, State};

/// Force, position and displacement of a group in one state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupState {
    /// Force of the group's supports on the sheet in N, with the signs of the axes, including that of a pulled grip. At a corner
    /// that the group shares with another one, forces of supports of the other group are excluded; where supports of both groups
    /// hold the node, the part of each group follows from its tractions beside the corner, and the rest is shared.
    pub force: [f64; 2],
    /// Moment of that force about `position` in N·mm, counter-clockwise; in a linear theory about the same point of the body at rest.
    pub moment: f64,
    /// Mean deformed position in mm: over the length of its edges at rest, else over its cells, lines or nodes.
    pub position: [f64; 2],
    /// Mean displacement over the length of its edges in mm.
    pub displacement: [f64; 2],
    /// The sum of the magnitudes of the forces on its nodes in N, of which `force` is the resultant.
    pub size: f64,
    /// Rounding of forces in N, in proportion to E t times the largest displacement.
    pub rounding: f64,
}

impl GroupState {
    /// Force along x and y in N and moment in N·mm; zero where they are of the size of rounding.
    pub fn carried(&self) -> [f64; 3] {
        let is_rounding = self.size > 0.0 && self.size <= 10.0 * self.rounding;
        let [x, y] = self.force;
        [x, y, self.moment].map(|value| if is_rounding { 0.0 } else { value })
    }
}

/// Rounding of forces relative to E t times the largest displacement: a body that moves without strain has no other forces.
const ROUNDING: f64 = 1e-11;

/// The forces of the supports of a model in one state, and what follows from them.
pub struct Reactions<'a> {
    model: &'a Model<'a>,
    state: &'a State,
    /// Force in N at each unknown, including grips that are pulled.
    forces: Vec<f64>,
}

impl Model<'_> {
    /// The forces of the supports in a state: the internal forces of its nodes less the loads on them, along the axes
    /// along which supports hold or pull them. NaN where the state is inverted.
    pub fn reactions<'a>(&'a self, state: &'a State) -> Reactions<'a> {
        let Constraints {
            held, ties, forces, ..
        } = &self.constraints;
        let mut internal = vec![0.0; state.displacement.len()];
        let loads = self.loads.without_pulls();
        let potential = loads.on(self.energy_after(&state.history), state.factor);
        if Assembly::residual(&*potential, &state.displacement, &mut internal).is_err() {
            internal.fill(f64::NAN);
        }
        let of_ties = ties.values().map(|tie| &tie.master);
        let masters = forces.iter().map(|(master, _)| master).chain(of_ties);
        let mut supports = vec![0.0; internal.len()];
        for unknown in held.keys().chain(ties.keys()).chain(masters) {
            supports[*unknown] = internal[*unknown];
        }
        Reactions {
            model: self,
            state,
            forces: supports,
        }
    }

    /// The force of the supports on a group in N, from a state.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn reaction(&self, state: &State, name: &str) -> [f64; 2] {
        self.reactions(state).at_group(name).force
    }
}

impl Reactions<'_> {
    /// Force, position and displacement of a group.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn at_group(&self, name: &str) -> GroupState {
        let mesh = self.model.mesh;
        let group = &mesh.groups()[name];
        let u = &self.state.displacement;
        let mut forces: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for axis in [0, 1] {
            for part in self.model.constraints.parts_on(mesh, group, axis) {
                let force = forces.entry(part.at).or_default();
                force[axis] += part.factor * self.forces[2 * part.of + axis];
            }
        }
        let turning = if self.model.energy.is_objective() {
            1.0
        } else {
            0.0
        };
        let arm = |node: usize, axis: usize| mesh.nodes[node][axis] + turning * u[2 * node + axis];
        let position = |node: usize, axis: usize| mesh.nodes[node][axis] + u[2 * node + axis];
        let shares = shares(mesh, group);
        let (middle, about) = (mean(&shares, &position), mean(&shares, &arm));
        let moment = |(node, force): (&usize, &[f64; 2])| {
            let [x, y] = [0, 1].map(|axis| arm(*node, axis) - about[axis]);
            x * force[1] - y * force[0]
        };
        GroupState {
            size: forces.values().map(|[x, y]| x.hypot(*y)).sum(),
            rounding: self.rounding(),
            force: [0, 1].map(|axis| forces.values().map(|force| force[axis]).sum()),
            moment: forces.iter().map(moment).sum(),
            position: middle,
            displacement: mean(&shares, &|node, axis| u[2 * node + axis]),
        }
    }

    /// Force, position and displacement of some groups.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn at_groups(&self, names: &[&str]) -> Vec<GroupState> {
        names.iter().map(|name| self.at_group(name)).collect()
    }

    /// The balance of all forces of supports and loads, and of their moments, on the deformed body; in a linear theory on the
    /// body at rest.
    pub fn balance(&self) -> Balance {
        /// Forces of which rounding may be more than this share would be judged by rounding alone: they count as large as this limit.
        const ROUNDING_LIMIT: f64 = 1e-7;
        let (model, u) = (self.model, &self.state.displacement);
        let factor = self.state.factor;
        let (body, loads) = if model.energy.is_objective() {
            let body = Body::new(model.mesh, u);
            let loads = model.loads.resultant(factor, u, &body);
            (body, loads)
        } else {
            // Pressures, too, act on the nodes of the body at rest.
            let body = Body::new(model.mesh, &vec![0.0; u.len()]);
            let loads = body.resultant(&model.loads.nodal_forces(factor, u));
            (body, loads)
        };
        let supports = body.resultant(&self.forces);
        let rounding = self.rounding();
        // NaN in an inverted state does not count as small.
        let is_small = |size: f64| size <= 10.0 * rounding;
        if is_small(supports.size) && is_small(loads.size) {
            let none = Resultant::default();
            return body.balance(none, none, rounding);
        }
        body.balance(supports, loads, rounding / ROUNDING_LIMIT)
    }

    /// Rounding of forces in N.
    fn rounding(&self) -> f64 {
        let u = self.state.displacement.iter();
        let largest = u.fold(0.0, |most: f64, u| most.max(u.abs()));
        ROUNDING * self.model.stiffness * largest
    }
}
