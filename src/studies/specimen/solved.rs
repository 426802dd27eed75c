//! The states of one model of a specimen, and what follows from them at its groups.

use super::forces::worse;
use super::measured::Measured;
use super::read::Specimen;
use crate::problem::Model;
use crate::solve::State;

/// What happens at a group in one state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupState {
    /// Force of the supports on the specimen in N, with the signs of the axes; that of a pulled grip included.
    pub force: [f64; 2],
    /// Moment of that force about the mean deformed place of the group's nodes in N·mm, counter-clockwise.
    pub moment: f64,
    /// Mean displacement over the length of its edges in mm.
    pub displacement: [f64; 2],
}

/// The states of one model at the load factors that it reaches.
pub struct Solved {
    /// One a load factor.
    pub states: Vec<State>,
    /// The groups of [`Specimen::groups`] in each state.
    groups: Vec<Vec<GroupState>>,
    /// What is left of all forces and moments together over the largest of them, at the worst load factor.
    pub balance: Option<f64>,
}

impl Solved {
    /// The figures of a model's states.
    pub fn new(specimen: &Specimen, model: &Model, states: Vec<State>) -> Self {
        let balances = states.iter().map(|state| model.balance(state).relative());
        Self {
            balance: balances.reduce(worse),
            groups: states
                .iter()
                .map(|state| group_states(specimen, model, state))
                .collect(),
            states,
        }
    }

    /// How many load factors were reached.
    pub fn reached(&self) -> usize {
        self.states.len()
    }

    /// What happens at the groups in the last state; `None` where there is none.
    pub fn last(&self) -> Option<&[GroupState]> {
        self.groups.last().map(Vec::as_slice)
    }

    /// What happens at the groups in the state of a number; `None` where it was not reached.
    pub fn groups(&self, step: usize) -> Option<&[GroupState]> {
        self.groups.get(step).map(Vec::as_slice)
    }

    /// What is measured in a state, in N or mm; `None` where it was not reached.
    pub fn measured(&self, what: &Measured, step: usize) -> Option<f64> {
        self.groups(step).map(|groups| what.of(groups))
    }
}

/// What happens at all [groups](Specimen::groups) in a state.
pub fn group_states(specimen: &Specimen, model: &Model, state: &State) -> Vec<GroupState> {
    let names = specimen.groups().into_iter();
    names.map(|name| group_state(model, state, name)).collect()
}

fn group_state(model: &Model, state: &State, name: &str) -> GroupState {
    GroupState {
        force: model.reaction(state, name),
        moment: model.reaction_moment(state, name),
        displacement: model.displacement(state, name),
    }
}
