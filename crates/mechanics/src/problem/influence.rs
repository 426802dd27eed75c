//! Results from the tangent at a state: the fields caused by small motions and forces of a group, stability, and the equilibrium nearby.

use rayon::prelude::*;

use super::constraints::Constraints;
use super::groups::shares;
use super::model::Model;
use crate::error::SolveFault;
use crate::solve::{Loading, Newton, NewtonSettings, Stage, State, Tangent, equilibrium};

/// Most unknowns of all tangents that are factorised at once.
const SIDE_BY_SIDE: usize = 400_000;

impl Model<'_> {
    /// The influence field of a group along an axis, by the tangent at each of some states; a [`SolveFault`] where the tangent cannot be
    /// factorised. It is the field in mm/mm caused by a motion of the group's held unknowns while all other held unknowns rest: the dual of
    /// the group's force, so that nodes at and beside corners that another group holds too move by their shares. For a grip with a given
    /// force, or a group that is not held, it is the field in mm/N caused by a force on the group.
    ///
    /// The tangents have one pattern. They are taken in parallel on the available threads, where factors are small.
    ///
    /// # Panics
    /// When the mesh has no such group.
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

    /// The number of tangents that each thread takes one after the other.
    fn in_turn(&self, count: usize) -> usize {
        let unknowns = 2 * self.mesh.nodes.len();
        let at_once = if self.linear_solver().is_multigrid(unknowns) {
            1
        } else {
            (SIDE_BY_SIDE / unknowns.max(1)).clamp(1, rayon::current_num_threads())
        };
        count.div_ceil(at_once).max(1)
    }

    /// The stable equilibria of a body without memory near fields in mm at load factors, each found independently, in parallel as above.
    ///
    /// # Errors
    /// As [`Newton::solve`] for an equilibrium that is not found.
    pub fn equilibria_near(
        &self,
        fields: &[(f64, Vec<f64>)],
        settings: NewtonSettings,
    ) -> Result<Vec<State>, SolveFault> {
        let groups = fields.par_chunks(self.in_turn(fields.len()));
        let solved = groups.map(|group| {
            let (potential, held) = (self.potential(group[0].0, &[]), self.held());
            let mut newton = Newton::with_solver(&*potential, &held, self.linear_solver())?;
            newton.shifts = false;
            let near = |(factor, field): &(f64, Vec<f64>)| {
                let (potential, stage) = (self.potential(*factor, &[]), Stage::first(*factor));
                let begin = field.clone();
                equilibrium(self, &*potential, stage, &mut newton, begin, settings)
            };
            group.iter().map(near).collect::<Result<Vec<State>, _>>()
        });
        let solved: Result<Vec<Vec<State>>, SolveFault> = solved.collect();
        Ok(solved?.into_iter().flatten().collect())
    }

    /// Checks that an equilibrium at a stage is stable.
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
            // The group is neither held nor pulled: a unit force acts on it, distributed as in its mean displacement.
            let mut unit = vec![0.0; motion.len()];
            for (node, share) in shares(self.mesh, group) {
                unit[2 * node + axis] += share;
            }
            force = Some(unit);
        }
        let (stage, u) = (state.stage(), &state.displacement);
        let potential = self.potential(stage.factor, stage.history);
        let describe = |element| self.describe(element);
        let mut field = match force {
            Some(force) => tangent.respond(&*potential, u, &force, &describe)?,
            None => tangent.influence(&*potential, u, &motion, &describe)?,
        };
        for (unknown, tie) in ties {
            field[*unknown] = tie.share * field[tie.master];
        }
        Ok(field)
    }
}
