//! A sheet that is moved by hand.

use std::collections::BTreeMap;

use super::Climb;
use super::field::{NEWTON, ShapeClimb};
use super::systems::Aim;
use crate::error::{Diagnostic, Error, SolveFault};
use crate::problem::{DeformedSheet, Grip, GroupState, Hand, HandMotion};
use crate::solve::{Attendance, Loading, follow};

/// A sheet moved by hand: the groups that supports hold are moved or pulled, and the corrected field follows. Loads stay unchanged.
pub struct Interactive<'a> {
    climb: Climb<'a>,
    hand: Hand,
    grips: BTreeMap<String, Grip>,
    climbed: ShapeClimb,
}

impl<'a> Interactive<'a> {
    /// Begins at one load factor.
    ///
    /// # Errors
    /// [`Error::Input`] where a mesh does not suit the problem, [`Error::Solve`] when no field was found there.
    pub fn new(mut climb: Climb<'a>, factor: f64) -> Result<Self, Error> {
        let climbed = climb.correct(factor)?;
        let levels = &climb.levels;
        let mesh = &levels.meshes[levels.finest()];
        let hand = Hand::take(levels.problem, mesh, &climbed.state).map_err(input)?;
        Ok(Self {
            grips: hand.grips(),
            hand,
            climb,
            climbed,
        })
    }

    /// The present corrected field.
    pub fn state(&self) -> &ShapeClimb {
        &self.climbed
    }

    /// The present corrected field, to be evaluated at any point of the sheet.
    pub fn deformed(&self) -> DeformedSheet {
        let levels = &self.climb.levels;
        let mesh = &levels.meshes[levels.finest()];
        levels.problem.deformed(mesh, &self.climbed.state)
    }

    /// Force of the hand on a group in N, its moment in N·mm and the group's mean displacement in mm.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn at_group(&self, name: &str) -> GroupState {
        let levels = &self.climb.levels;
        let model = levels.model(levels.finest()).expect("solved before");
        model.reactions(&self.climbed.state).at_group(name)
    }

    /// The positions of the grips, or the forces on them: all groups that supports hold.
    pub fn grips(&self) -> &BTreeMap<String, Grip> {
        &self.grips
    }

    /// Moves some grips by a few mm or degrees, or changes the forces on them; the others stay unchanged. A motion
    /// that is too large for one step is divided, with factors.
    ///
    /// # Errors
    /// [`Error::Input`] where a grip is not of the kind of its group's support, or where groups that share nodes would separate;
    /// [`Error::Solve`] when the field cannot follow. The state before is kept.
    pub fn move_grips(&mut self, grips: &[(&str, Grip)]) -> Result<&ShapeClimb, Error> {
        let mut all = self.grips.clone();
        for (name, grip) in grips {
            self.hand.check(name, grip).map_err(input)?;
            all.insert((*name).to_owned(), *grip);
        }
        let levels = &self.climb.levels;
        let mesh = &levels.meshes[levels.finest()];
        self.hand.agree(mesh, &all).map_err(input)?;
        self.climbed = self.moved(&all)?;
        self.grips = all;
        Ok(&self.climbed)
    }

    fn moved(&mut self, grips: &BTreeMap<String, Grip>) -> Result<ShapeClimb, Error> {
        let levels = &self.climb.levels;
        let model = levels.model(levels.finest())?;
        let before = &self.climbed.state.displacement[..];
        let load_factor = self.climbed.state.factor;
        let mut motion = HandMotion::new(&self.hand, &model, [&self.grips, grips], before);
        let systems = self.climb.systems.as_mut().expect("after a climb");
        let step = motion.step().to_vec();
        if step.iter().any(|own| *own != 0.0) {
            let potential = motion.potential(0.0, &[]);
            let others = systems.carried_along(&motion, &*potential, before, &step);
            drop(potential);
            if let Some(others) = others {
                let pairs = step.iter().zip(others);
                motion.expect(pairs.map(|(own, other)| own + other).collect());
            }
        }
        let aim = Aim {
            factor: 1.0,
            start: motion.expected(1.0),
            load_factor,
        };
        let mut climbed = match systems.reach(levels, &motion, aim) {
            Some(climbed) => climbed,
            None => {
                let followed = follow(&motion, &[1.0], NEWTON, Attendance::told(&|_| ()));
                let states = followed.map_err(|end| {
                    refused([&self.grips, grips], end.reached(), end.fault.clone())
                })?;
                let state = states.into_iter().next().expect("one");
                systems.of_factors(levels, state)
            }
        };
        climbed.state.factor = load_factor;
        Ok(climbed)
    }
}

/// The error of a motion that the field cannot follow.
fn refused([from, to]: [&BTreeMap<String, Grip>; 2], reached: f64, fault: SolveFault) -> Error {
    let moved = from.iter().filter(|(name, grip)| to[*name] != **grip);
    let moved = moved.map(|(name, grip)| format!("`{name}` from {grip} to {}", to[name]));
    let moved: Vec<String> = moved.collect();
    Error::Solve {
        model: "corrector".into(),
        step: format!(
            "a motion of the grips {} (also in parts; a fraction of {reached:.4} was reached, and the previous field is kept: move \
             them in smaller steps)",
            moved.join(" and ")
        ),
        fault,
    }
}

fn input(fault: Diagnostic) -> Error {
    Error::Input(vec![fault])
}
