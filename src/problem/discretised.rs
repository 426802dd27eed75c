//! A boundary value problem on a mesh: its solution, and what follows from its states.

use super::balance::{Balance, Body, Resultant};
use super::groups::shares;
use super::loads::Loaded;
use super::rigid::free_motions;
use super::supports::{Motion, Supported};
use super::ties::TiedPotential;
use crate::error::{Diagnostic, SolveFault};
use crate::mesh::Mesh;
use crate::solve::{
    Assembly, Loading, NewtonSettings, PathEnd, Potential, State, compliance, follow, influence,
};

/// A boundary value problem on a mesh, ready to be solved with any energy of its nodes.
pub struct Discretised<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) energy: &'a dyn Potential,
    pub(super) supported: Supported,
    pub(super) loaded: Loaded,
    /// E t in N/mm.
    pub(super) stiffness: f64,
    pub(super) names: Box<dyn Fn(usize) -> String + 'a>,
}

impl<'a> Discretised<'a> {
    /// With names for the elements of an energy whose elements are not the cells.
    #[must_use]
    pub fn named(self, names: impl Fn(usize) -> String + 'a) -> Self {
        Self {
            names: Box::new(names),
            ..self
        }
    }

    /// Imposes a displacement field in mm, complete at load factor 1, on the nodes of a group.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn impose_field(&mut self, name: &str, field: impl Fn([f64; 2]) -> [f64; 2]) {
        for node in &self.mesh.groups()[name].nodes {
            for (axis, value) in field(self.mesh.nodes[*node]).into_iter().enumerate() {
                let motion = Motion::Straight(value);
                self.supported.held.insert(2 * node + axis, motion);
            }
        }
        self.loaded.close(&self.supported);
    }

    /// Adds forces in N at load factor 1, one for each unknown: a body force, for instance.
    pub fn add_forces(&mut self, forces: &[f64]) {
        self.loaded.add_forces(forces);
    }

    /// Solves load factors, one after the other.
    ///
    /// # Errors
    /// [`PathEnd`] with the load factor that could not be reached and the states before it.
    pub fn solve(
        &self,
        factors: &[f64],
        settings: NewtonSettings,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<State>, PathEnd> {
        if let (Some(free), Some(factor)) =
            (self.free_motions().into_iter().next(), factors.first())
        {
            return Err(PathEnd {
                factor: *factor,
                fault: SolveFault::FreeMotion(free.message),
                states: Vec::new(),
                last: None,
            });
        }
        follow(self, factors, settings, progress)
    }

    /// The parts that can move without strain, each with its motion.
    pub fn free_motions(&self) -> Vec<Diagnostic> {
        free_motions(self.mesh, &self.supported)
    }

    /// The field in mm/mm that a motion of a group's held unknowns along an axis brings about, by the tangent at a
    /// state, while everything else that is held rests; the field in mm/N that a force on the group brings about where it
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
        let Supported { held, ties, forces } = &self.supported;
        let nodes = self.mesh.groups()[name].nodes.iter();
        let mut unknowns = nodes.map(|node| 2 * node + axis);
        let pulled = |unknown: &usize| forces.iter().any(|(master, _)| master == unknown);
        let (mut motion, mut force) = (vec![0.0; state.displacement.len()], None);
        for unknown in unknowns
            .clone()
            .filter(|unknown| held.contains_key(unknown))
        {
            motion[unknown] = 1.0;
        }
        if let Some(master) = unknowns.find(pulled) {
            let mut unit = vec![0.0; motion.len()];
            unit[master] = 1.0;
            force = Some(unit);
        }
        let at = (state.factor, &*state.displacement);
        if force.is_none() && motion.iter().all(|motion| *motion == 0.0) {
            // Nothing holds or pulls the group: a unit of force on it, shared as its mean displacement is.
            let mut unit = vec![0.0; motion.len()];
            for (node, share) in shares(self.mesh, &self.mesh.groups()[name]) {
                unit[2 * node + axis] += share;
            }
            force = Some(unit);
        }
        let mut field = match force {
            Some(force) => compliance(self, at, &force)?,
            None => influence(self, at, &motion)?,
        };
        for (unknown, master) in ties {
            field[*unknown] = field[*master];
        }
        Ok(field)
    }

    /// The force of the supports on a group in N, from a state: the internal forces of its nodes less the loads on them,
    /// along the axes along which supports hold or pull them.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn reaction(&self, state: &State, name: &str) -> [f64; 2] {
        let forces = self.support_forces(state);
        let nodes = &self.mesh.groups()[name].nodes;
        [0, 1].map(|axis| nodes.iter().map(|node| forces[2 * node + axis]).sum())
    }

    /// The forces of the supports in N at each unknown, from a state: those of grips that are pulled too. Not a number where
    /// the state is inverted.
    pub fn support_forces(&self, state: &State) -> Vec<f64> {
        let Supported { held, ties, forces } = &self.supported;
        let mut internal = vec![0.0; state.displacement.len()];
        let loads = self.loaded.without_pulls();
        let loaded = loads.at(self.energy, state.factor);
        let known = Assembly::residual(&loaded, &state.displacement, &mut internal);
        let masters = forces.iter().map(|(master, _)| master);
        let mut supports = vec![0.0; internal.len()];
        for unknown in held.keys().chain(ties.keys()).chain(masters) {
            supports[*unknown] = if known.is_ok() {
                internal[*unknown]
            } else {
                f64::NAN
            };
        }
        supports
    }

    /// The balance of all forces of supports and loads, and of their moments, on the deformed body.
    pub fn balance(&self, state: &State) -> Balance {
        /// Rounding of a body that moves without strain, relative to E t times its largest displacement.
        const NEGLIGIBLE: f64 = 1e-4;
        let u = &state.displacement;
        let moved = self.mesh.nodes.iter().zip(u.chunks_exact(2));
        let places: Vec<[f64; 2]> = moved.map(|(at, u)| [at[0] + u[0], at[1] + u[1]]).collect();
        let body = Body::new(&places);
        let supports = Resultant::of_nodes(&places, &self.support_forces(state), body.centre);
        let about = (body.centre, self.mesh.middle());
        let loads = self.loaded.resultant(state.factor, (&places, u), about);
        let largest = u.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        body.balance(supports, loads, NEGLIGIBLE * self.stiffness * largest)
    }
}

impl Loading for Discretised<'_> {
    fn held(&self) -> Vec<bool> {
        let unknowns = 0..2 * self.mesh.nodes.len();
        unknowns
            .map(|unknown| {
                let Supported { held, ties, .. } = &self.supported;
                held.contains_key(&unknown) || ties.contains_key(&unknown)
            })
            .collect()
    }

    fn impose(&self, factor: f64, displacement: &mut [f64]) {
        for (unknown, motion) in &self.supported.held {
            displacement[*unknown] = motion.at(factor);
        }
        for (unknown, master) in &self.supported.ties {
            displacement[*unknown] = displacement[*master];
        }
    }

    fn potential(&self, factor: f64) -> Box<dyn Potential + '_> {
        let loaded: Box<dyn Potential + '_> = if self.loaded.is_empty() {
            Box::new(self.energy)
        } else {
            Box::new(self.loaded.at(self.energy, factor))
        };
        if self.supported.ties.is_empty() {
            loaded
        } else {
            Box::new(TiedPotential::new(loaded, &self.supported.ties))
        }
    }

    fn guess(&self, _: f64, _: Option<&State>) -> Option<Vec<f64>> {
        None
    }

    fn describe(&self, element: usize) -> String {
        if element < self.energy.elements() {
            (self.names)(element)
        } else {
            "a loaded edge".to_owned()
        }
    }

    fn describe_unknown(&self, unknown: usize) -> String {
        self.mesh.describe_unknown(unknown)
    }
}
