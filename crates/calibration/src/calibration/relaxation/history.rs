//! Tests as histories: what was measured over time, and the stress of a viscous material with the same strains.
//!
//! ```text
//! S = S∞ + Σ Qᵢ,   Q̇ᵢ + Qᵢ/τᵢ = βᵢ Ṡ∞,   βᵢ = gᵢ/(1 − Σ g),   P = λ S                      [MPa]
//! ```
//!
//! Strains are straight lines between the rows of a file. A step in which the stretch changes by more than [`FINE`] is divided, and in
//! each part S∞ changes evenly, where the recursion of [`ViscousMaterial::recursions`] is exact: it is the one by which
//! motions are computed. Free edges stay free of stress, because the stress that relaxes is proportional to that of the law.

use crate::calibration::data::{Observation, TestData};
use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::material::viscosity::ViscousMaterial;
use crate::statistics::extremes;

/// Longer steps of the stretch are divided.
const FINE: f64 = 0.01;
/// Rows are gathered until there are no more of them along one axis of a test.
const MOST: usize = 1500;
/// A history whose first strain is more than this share of its largest one begins stretched.
const BEGUN: f64 = 0.5;

/// What was measured at an instant, or the mean over some neighbouring ones.
#[derive(Clone, Copy, Debug)]
pub struct State {
    /// In s.
    pub time: f64,
    /// Strains and stress.
    pub observation: Observation,
    /// How many rows it is the mean of.
    pub count: f64,
}

/// A point of the history at which the stress is computed.
#[derive(Clone, Copy, Debug)]
struct Node {
    observation: Observation,
    /// Time since the node before, in s.
    elapsed: f64,
    /// Whether a state was measured here.
    measured: bool,
}

/// The history of a test along one axis.
#[derive(Clone, Debug)]
pub struct History {
    /// The number of the test.
    pub test: usize,
    /// What was measured, in the order of time.
    pub states: Vec<State>,
    nodes: Vec<Node>,
    /// Whether it begins stretched: the rise is not in the file.
    pub begins_stretched: bool,
}

impl History {
    /// The histories of all tests along all axes; many rows are gathered where `gathered`.
    ///
    /// # Errors
    /// [`Error::Input`] where a test has no times, or they run back.
    pub fn all(tests: &[TestData], gathered: bool) -> Result<Vec<Self>, Error> {
        let mut all = Vec::new();
        for (test, data) in tests.iter().enumerate() {
            let times = times(data)?;
            for axis in [0, 1] {
                let timed = data.observations.iter().zip(times);
                let rows = timed.filter(|(one, _)| one.axis == axis);
                let states: Vec<State> = rows
                    .map(|(one, time)| State {
                        time: *time,
                        observation: *one,
                        count: 1.0,
                    })
                    .collect();
                if states.windows(2).any(|pair| pair[1].time < pair[0].time) {
                    let message = format!("{}: the times decrease", data.name);
                    let hint =
                        "one file is one run of the machine: give each run a file of its own";
                    return Err(Error::input(message, hint));
                }
                if states.is_empty() {
                    continue;
                }
                let states = if gathered { gather(states) } else { states };
                all.push(Self::new(test, states, data.rise));
            }
        }
        Ok(all)
    }

    fn new(test: usize, states: Vec<State>, rise: f64) -> Self {
        let strain = |state: &State| state.observation.strain().abs();
        let largest = states.iter().map(strain).fold(0.0, f64::max);
        let begins_stretched = strain(&states[0]) > BEGUN * largest;
        let first = states[0].observation;
        let rest = Observation {
            strains: first.strains.map(|x| 0.0 * x),
            ..first
        };
        let mut nodes = vec![Node {
            observation: if begins_stretched { rest } else { first },
            elapsed: 0.0,
            measured: !begins_stretched,
        }];
        if begins_stretched {
            add_steps(&mut nodes, first, rise);
        }
        for pair in states.windows(2) {
            add_steps(&mut nodes, pair[1].observation, pair[1].time - pair[0].time);
        }
        Self {
            test,
            states,
            nodes,
            begins_stretched,
        }
    }

    /// S∞ of a law at all nodes, in MPa.
    pub fn long_time_stress(&self, data: &TestData, law: &dyn HyperelasticLaw) -> Vec<f64> {
        let stress = |node: &Node| {
            let one = &node.observation;
            let x = one.strain();
            let stress = data.stress_of(law, one);
            data.stress_measure.to_nominal(stress, x) / (1.0 + x)
        };
        self.nodes.iter().map(stress).collect()
    }

    /// The stress of a material at all states, in the measure of the data, from S∞ at the nodes.
    pub fn stresses(&self, data: &TestData, long: &[f64], material: &ViscousMaterial) -> Vec<f64> {
        let mut branches = vec![0.0; material.relaxation.len()];
        let mut before = long[0];
        let mut result = Vec::with_capacity(self.states.len());
        for (node, now) in self.nodes.iter().zip(long) {
            let recursions = material.recursions(node.elapsed);
            for (q, recursion) in branches.iter_mut().zip(recursions) {
                *q = recursion.keeps * *q + recursion.takes * (now - before);
            }
            before = *now;
            if node.measured {
                let one = &node.observation;
                let x = one.strain();
                let nominal = (1.0 + x) * (now + branches.iter().sum::<f64>());
                result.push(data.stress_measure.of_nominal(nominal, x));
            }
        }
        result
    }

    /// From the first to the last time, in s.
    pub fn duration(&self) -> f64 {
        self.states[self.states.len() - 1].time - self.states[0].time
    }
}

/// The times of a test.
fn times(data: &TestData) -> Result<&[f64], Error> {
    data.known_times()?.ok_or_else(|| {
        let message = format!("{}: there is no column of times", data.name);
        let hint = "relaxation is fitted to what was measured over time: name a column `time [s]`";
        Error::input(message, hint)
    })
}

/// Adds nodes up to an observation, in steps that are fine enough; a sudden change is a single step.
fn add_steps(nodes: &mut Vec<Node>, to: Observation, elapsed: f64) {
    let from = nodes[nodes.len() - 1].observation;
    let change = (to.strain() - from.strain()).abs();
    let steps = if elapsed > 0.0 {
        (change / FINE).ceil().clamp(1.0, 1000.0)
    } else {
        1.0
    };
    for step in 1..=steps as usize {
        let share = step as f64 / steps;
        let strains = [0, 1].map(|axis| {
            let (start, end) = (from.strains[axis], to.strains[axis]);
            if step as f64 == steps {
                end
            } else {
                start + share * (end - start)
            }
        });
        nodes.push(Node {
            observation: Observation { strains, ..to },
            elapsed: elapsed / steps,
            measured: step as f64 == steps,
        });
    }
}

/// The means of neighbouring rows, the more of them the longer the strain has rested, until few enough are left.
fn gather(states: Vec<State>) -> Vec<State> {
    let mut share = 0.01;
    let mut gathered = states.clone();
    while gathered.len() > MOST {
        gathered = gathered_by(&states, share);
        share *= 1.5;
    }
    gathered
}

/// Means over no more than a share of the time since the strain moved by as large a share of its range.
fn gathered_by(states: &[State], share: f64) -> Vec<State> {
    let strain = |state: &State| state.observation.strain();
    let [low, high] = extremes(states.iter().map(strain));
    let moved = share * (high - low);
    let mut groups: Vec<Vec<State>> = Vec::new();
    let (mut reference, mut since) = (strain(&states[0]), states[0].time);
    let mut first_strain = reference;
    for state in states {
        if (strain(state) - reference).abs() > moved {
            (reference, since) = (strain(state), state.time);
        }
        let fits = |group: &Vec<State>| {
            let rested = group[0].time - since;
            let near = (strain(state) - first_strain).abs() <= moved;
            near && state.time - group[0].time <= share * rested.max(0.0)
        };
        match groups.last_mut() {
            Some(group) if fits(group) => group.push(*state),
            _ => {
                first_strain = strain(state);
                groups.push(vec![*state]);
            }
        }
    }
    groups.iter().map(|group| mean(group)).collect()
}

fn mean(group: &[State]) -> State {
    let count = group.len() as f64;
    let observations: Vec<Observation> = group.iter().map(|state| state.observation).collect();
    State {
        time: group.iter().map(|state| state.time).sum::<f64>() / count,
        observation: Observation::mean(&observations),
        count,
    }
}
