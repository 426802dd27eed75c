//! What the tangent at a state tells: the fields that small motions and forces of a group bring about, stability, and the equilibrium
//! next to it.

use rayon::prelude::*;

use super::constraints::Constraints;
use super::groups::shares;
use super::model::Model;
use crate::error::SolveFault;
use crate::solve::{
    Loading, Newton, NewtonSettings, Stage, State, Tangent, compliance, equilibrium, influence,
};

/// Unknowns of all tangents that are factorised at once.
const SIDE_BY_SIDE: usize = 400_000;

impl Model<'_> {
    /// The field in mm/mm that a motion of a group's held unknowns along an axis brings about, by the tangent at a
    /// state, while everything else that is held rests: the dual of the group's force, so that nodes at and beside corners which
    /// another group holds too move by their parts of it; the field in mm/N that a force on the group brings about where it
    /// is a grip with a given force, or where nothing holds it.
    ///
    /// # Errors
    /// A [`SolveFault`] when the tangent cannot be factorised.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn influence(
        &self,
        state: &State,
        name: &str,
        axis: usize,
    ) -> Result<Vec<f64>, SolveFault> {
        let mut one = self.influences(std::slice::from_ref(state), name, axis);
        one.swap_remove(0)
    }

    /// The same at each of some states, whose tangents have one pattern; side by side on the threads there are, where factors are small.
    ///
    /// # Panics
    /// As [`Self::influence`].
    pub fn influences(
        &self,
        states: &[State],
        name: &str,
        axis: usize,
    ) -> Vec<Result<Vec<f64>, SolveFault>> {
        let groups = states.par_chunks(self.in_turn(states.len()));
        groups
            .flat_map_iter(|group| self.influences_in_turn(group, name, axis))
            .collect()
    }

    /// How many of some tangents each thread takes after each other.
    fn in_turn(&self, count: usize) -> usize {
        let unknowns = 2 * self.mesh.nodes.len();
        let at_once = match self.linear_solver().is_multigrid(unknowns) {
            true => 1,
            false => (SIDE_BY_SIDE / unknowns.max(1)).clamp(1, rayon::current_num_threads()),
        };
        count.div_ceil(at_once).max(1)
    }

    /// The stable equilibria of a body without memory next to fields in mm at load factors, each by itself; side by side as above.
    ///
    /// # Errors
    /// As [`Newton::solve`] of one that is not found.
    pub fn equilibria_near(
        &self,
        fields: &[(f64, Vec<f64>)],
        settings: NewtonSettings,
    ) -> Result<Vec<State>, SolveFault> {
        let groups = fields.par_chunks(self.in_turn(fields.len()));
        let found = groups.map(|group| {
            let (potential, held) = (self.potential(group[0].0, &[]), self.held());
            let mut newton = Newton::with_solver(&*potential, &held, self.linear_solver())?;
            newton.shifts = false;
            let near = |(factor, field): &(f64, Vec<f64>)| {
                let (potential, stage) = (self.potential(*factor, &[]), Stage::first(*factor));
                let begin = (&mut newton, field.clone());
                equilibrium(self, &*potential, stage, begin, settings)
            };
            group.iter().map(near).collect::<Result<Vec<State>, _>>()
        });
        let found: Result<Vec<Vec<State>>, SolveFault> = found.collect();
        Ok(found?.into_iter().flatten().collect())
    }

    /// Looks whether an equilibrium at a stage is stable.
    ///
    /// # Errors
    /// [`SolveFault::NotPositiveDefinite`] where it is not.
    pub fn check_stability(
        &self,
        stage: Stage<'_>,
        displacement: &[f64],
    ) -> Result<(), SolveFault> {
        let potential = self.potential(stage.factor, stage.history);
        let mut tangent = Tangent::new(&*potential, &self.held(), self.linear_solver())?;
        let describe = |element| self.describe(element);
        tangent.at(&*potential, displacement, &describe).map(|_| ())
    }

    fn influences_in_turn(
        &self,
        states: &[State],
        name: &str,
        axis: usize,
    ) -> Vec<Result<Vec<f64>, SolveFault>> {
        let (potential, held) = (self.potential(states[0].factor, &[]), self.held());
        match Tangent::new(&*potential, &held, self.linear_solver()) {
            Err(fault) => vec![Err(fault); states.len()],
            Ok(mut tangent) => {
                let states = states.iter();
                let influence = |state| self.influence_by(&mut tangent, state, name, axis);
                states.map(influence).collect()
            }
        }
    }

    fn influence_by(
        &self,
        tangent: &mut Tangent,
        state: &State,
        name: &str,
        axis: usize,
    ) -> Result<Vec<f64>, SolveFault> {
        let Constraints {
            held, ties, forces, ..
        } = &self.constraints;
        let group = &self.mesh.groups()[name];
        let pulled = |unknown: &usize| forces.iter().any(|(master, _)| master == unknown);
        let (mut motion, mut force) = (vec![0.0; state.displacement.len()], None);
        for part in self.constraints.parts_on(self.mesh, group, axis) {
            let unknown = 2 * part.of + axis;
            if held.contains_key(&unknown) {
                motion[unknown] += part.factor;
            }
        }
        let mut unknowns = group.nodes.iter().map(|node| 2 * node + axis);
        if let Some(master) = unknowns.find(pulled) {
            let mut unit = vec![0.0; motion.len()];
            unit[master] = 1.0;
            force = Some(unit);
        }
        if force.is_none() && motion.iter().all(|motion| *motion == 0.0) {
            // Nothing holds or pulls the group: a unit of force on it, shared as its mean displacement is.
            let mut unit = vec![0.0; motion.len()];
            for (node, share) in shares(self.mesh, group) {
                unit[2 * node + axis] += share;
            }
            force = Some(unit);
        }
        let (stage, u) = (state.stage(), &state.displacement);
        let mut field = match force {
            Some(force) => compliance(tangent, self, stage, u, &force)?,
            None => influence(tangent, self, stage, u, &motion)?,
        };
        for (unknown, master) in ties {
            field[*unknown] = field[*master];
        }
        Ok(field)
    }
}
