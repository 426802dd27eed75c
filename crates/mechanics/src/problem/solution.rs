//! The equilibria of a model along a path, and the states of groups of its mesh.

use super::model::{Model, Work};
use super::reactions::GroupState;
use crate::mesh::Mesh;
use crate::solve::State;
use crate::statistics::larger;

/// The equilibria of a model at the load factors that it reaches.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The mesh of the model.
    pub mesh: Mesh,
    /// One for each load factor.
    pub states: Vec<State>,
    /// The states of some groups at each load factor.
    groups: Vec<Vec<GroupState>>,
    /// The resultant of all forces and moments together, relative to the largest of them, in each state.
    pub balances: Vec<f64>,
    /// The strain energy that is stored in each state, in mJ.
    pub energies: Vec<f64>,
    /// The work done on the material up to each state; `None` where it has no memory.
    pub works: Vec<Option<Work>>,
}

impl Solution {
    /// The states of a model, evaluated at groups of its mesh.
    pub fn new(model: &Model, groups: &[&str], states: Vec<State>) -> Self {
        let follow = |state| {
            let reactions = model.reactions(state);
            (reactions.at_groups(groups), reactions.balance().relative())
        };
        let (groups, balances) = states.iter().map(follow).unzip();
        let works: Vec<Option<Work>> = states.iter().map(|state| model.work(state)).collect();
        let energies = states.iter().zip(&works);
        let energies = energies
            .map(|(state, work)| model.strain_energy(state, *work))
            .collect();
        Self {
            mesh: model.mesh.clone(),
            groups,
            balances,
            energies,
            works,
            states,
        }
    }

    /// No states on a mesh, of a model that was not solved.
    pub fn empty(mesh: Mesh) -> Self {
        Self {
            mesh,
            states: Vec::new(),
            groups: Vec::new(),
            balances: Vec::new(),
            energies: Vec::new(),
            works: Vec::new(),
        }
    }

    /// The displacement fields before load factor number `step`, which a body with a memory remembers; empty where the material has no memory.
    pub fn past(&self, step: usize) -> Vec<&[f64]> {
        let remembers = self.works.iter().any(Option::is_some);
        let before = self.states.iter().take(step).filter(|_| remembers);
        before.map(|state| &state.displacement[..]).collect()
    }

    /// The number of load factors that were reached.
    pub fn reached(&self) -> usize {
        self.states.len()
    }

    /// ux, uy of node after node in mm at load factor number `step`; `None` where it was not reached.
    pub fn displacement(&self, step: usize) -> Option<&[f64]> {
        Some(&self.states.get(step)?.displacement)
    }

    /// The states of the groups at load factor number `step`; `None` where it was not reached.
    pub fn groups(&self, step: usize) -> Option<&[GroupState]> {
        self.groups.get(step).map(Vec::as_slice)
    }

    /// The states of the groups at the last load factor that was reached.
    pub fn last_groups(&self) -> Option<&[GroupState]> {
        self.groups.last().map(Vec::as_slice)
    }

    /// The worst balance of all states, NaN being the worst; `None` where there are no states.
    pub fn worst_balance(&self) -> Option<f64> {
        self.balances.iter().copied().reduce(larger)
    }
}
