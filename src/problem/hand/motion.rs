//! The way of the hand from one place of its grips to another.

use std::collections::BTreeMap;

use super::{Hand, Hold};
use crate::problem::boundary_conditions::Drive;
use crate::problem::grip::Grip;
use crate::problem::model::Model;
use crate::solve::vector::difference;
use crate::solve::{LinearSolver, Loading, Potential, State};

/// A motion of the hand from one place of its grips to another, as a share of it from 0 to 1 in place of the load factor.
pub struct HandMotion<'a> {
    hand: &'a Hand,
    model: &'a Model<'a>,
    grips: [&'a BTreeMap<String, Grip>; 2],
    /// The equilibrium at its beginning.
    before: &'a [f64],
    /// About what is added up to its end.
    step: Vec<f64>,
}

impl<'a> HandMotion<'a> {
    /// From one place of all grips to another; both [agree](Hand::agree) and were [checked](Hand::check).
    pub fn new(
        hand: &'a Hand,
        model: &'a Model<'a>,
        grips: [&'a BTreeMap<String, Grip>; 2],
        before: &'a [f64],
    ) -> Self {
        let mut all = Self {
            hand,
            model,
            grips,
            before,
            step: Vec::new(),
        };
        let mut end = before.to_vec();
        all.impose(1.0, &mut end);
        all.step = difference(&end, before);
        all
    }

    /// About what is added up to the end: at first at what is held alone.
    pub fn step(&self) -> &[f64] {
        &self.step
    }

    /// Says about what is added up to the end.
    pub fn expect(&mut self, step: Vec<f64>) {
        self.step = step;
    }

    /// The field that is expected a share of the way.
    pub fn expected(&self, share: f64) -> Vec<f64> {
        let pairs = self.before.iter().zip(&self.step);
        pairs.map(|(before, step)| before + share * step).collect()
    }

    /// A grip a share of the way.
    fn grip(&self, name: &str, share: f64) -> Grip {
        let [from, to] = self.grips.map(|grips| grips[name]);
        from.towards(to, share)
    }
}

impl Loading for HandMotion<'_> {
    fn held(&self) -> Vec<bool> {
        self.model.held()
    }

    fn impose(&self, share: f64, displacement: &mut [f64]) {
        for (name, group) in &self.hand.groups {
            for (unknown, own) in group.displacements(&self.grip(name, share)) {
                displacement[unknown] = own;
            }
        }
        for (unknown, master) in self.model.ties() {
            displacement[*unknown] = displacement[*master];
        }
    }

    fn potential<'b>(&'b self, share: f64, history: &'b [f64]) -> Box<dyn Potential + 'b> {
        let mut pulls = Vec::new();
        for (name, group) in &self.hand.groups {
            if let Grip::Drives(drives) = self.grip(name, share) {
                for own in group.holds.into_iter().zip(drives) {
                    if let (Hold::Pulled(master), Drive::Force(force)) = own {
                        pulls.push((master, force));
                    }
                }
            }
        }
        let model = self.model;
        let energy = model.energy_after(history);
        model.tied(model.loads.with_pulls(energy, self.hand.factor, &pulls))
    }

    fn linear_solver(&self) -> LinearSolver {
        self.model.linear_solver()
    }

    fn guess(&self, share: f64, previous: Option<&State>) -> Option<Vec<f64>> {
        previous.is_none().then(|| self.expected(share))
    }

    fn follows_its_branch(&self) -> bool {
        false
    }

    fn describe(&self, element: usize) -> String {
        self.model.describe(element)
    }

    fn describe_unknown(&self, unknown: usize) -> String {
        self.model.describe_unknown(unknown)
    }
}
