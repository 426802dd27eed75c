//! The boundary value problem of a sheet of any shape: supports and loads on the named groups of its mesh.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::error::{Diagnostic, SolveFault};
use crate::material::HyperelasticLaw;
use crate::mesh::{Group, Mesh};
use crate::sheet_energy::SheetEnergy;
use crate::solve::{
    Assembly, Loading, NewtonSettings, PathEnd, Potential, State, compliance, follow, influence,
};
use crate::units::Linear;

mod balance;
mod contradictions;
mod loads;
mod pressure;
mod rigid;
mod supports;
mod ties;

pub use balance::{Balance, Resultant};

use balance::Body;
use contradictions::contradictions;
use loads::Loaded;
use rigid::free_motions;
use supports::{Motion, Supported};
use ties::Tied;

/// What holds a group; everything grows with the load factor and is complete at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    /// Displacements ux, uy in mm; one that is not given is free. Both zero: a clamp; one zero: a roller or
    /// an axis of symmetry.
    Displacement([Option<f64>; 2]),
    /// Displacements ux, uy in mm that are linear in the place at rest; one that is not given is free.
    LinearDisplacement([Option<Linear>; 2]),
    /// A displacement in mm along the line from a point in mm through the place at rest, away from the point; none
    /// across it.
    Radial {
        /// The point.
        centre: [f64; 2],
        /// The displacement away from it.
        displacement: f64,
    },
    /// Free to slide along the straight line on which the group lies, parallel to an axis: a roller, or an axis of
    /// symmetry.
    Roller,
    /// A rigid turn about a point in mm by an angle in rad, counter-clockwise.
    Rotation {
        /// The point.
        centre: [f64; 2],
        /// The angle.
        angle: f64,
    },
    /// A rigid grip that does not turn: all nodes have the same displacement along each axis.
    Grip([Drive; 2]),
}

/// What moves a rigid grip along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A displacement in mm.
    Displacement(f64),
    /// A total force in N of constant direction (dead).
    Force(f64),
}

/// What loads a group; everything grows with the load factor and is complete at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A traction in MPa on the reference area of the group's edges, of constant direction (dead).
    Traction([f64; 2]),
    /// A pressure in MPa on the group's edges that follows them: p t times the deformed length, t the thickness
    /// at rest, against the outward normal. The forces are p t ∫ Nₐ n ds over the deformed edges at every node. Edges may
    /// end anywhere.
    ///
    /// A fluid presses on the deformed thickness λ₃ t: its pressure q is p = λ₃ q here, less than q where
    /// the edge is stretched.
    Pressure(f64),
    /// A force in N, shared equally by the group's nodes.
    Force([f64; 2]),
}

/// A sheet between its supports under its loads.
#[derive(Clone, Debug)]
pub struct BoundaryProblem {
    /// Thickness in mm.
    pub thickness: f64,
    /// The material.
    pub law: Arc<dyn HyperelasticLaw>,
    /// Supports by group; those that share nodes must agree there.
    pub supports: Vec<(String, Support)>,
    /// Loads by group.
    pub loads: Vec<(String, Load)>,
}

/// A boundary value problem on a mesh, ready to be solved with any energy of its nodes.
pub struct Discretised<'a> {
    mesh: &'a Mesh,
    energy: &'a dyn Potential,
    supported: Supported,
    loaded: Loaded,
    /// E t in N/mm.
    stiffness: f64,
    names: Box<dyn Fn(usize) -> String + 'a>,
}

impl BoundaryProblem {
    /// The finite-element energy of a mesh.
    pub fn finite_elements(&self, mesh: &Mesh) -> SheetEnergy {
        SheetEnergy::of_mesh(Arc::clone(&self.law), mesh, self.thickness)
    }

    /// Everything that keeps the problem from being solved on a mesh: supports and loads on groups that it does not have or
    /// that cannot carry them, supports that contradict each other, parts that can move without strain.
    ///
    /// # Errors
    /// All faults, each with its place and a remedy.
    pub fn check(&self, mesh: &Mesh) -> Result<(), Vec<Diagnostic>> {
        let supports = (0..self.supports.len()).map(|n| self.supported(mesh, n..n + 1).err());
        let unknowns = 2 * mesh.nodes.len();
        let loads = self.loads.iter().map(|(name, load)| {
            let mut loaded = Loaded::new(unknowns);
            self.load(mesh, name, load, &mut loaded).err()
        });
        let mut faults: Vec<Diagnostic> = supports.chain(loads).flatten().collect();
        if faults.is_empty() {
            faults = contradictions(self, mesh).unwrap_or_else(|fault| vec![fault]);
        }
        if faults.is_empty() {
            let supported = self.supported(mesh, 0..self.supports.len());
            faults = supported.map_or_else(|fault| vec![fault], |all| free_motions(mesh, &all));
        }
        match faults.is_empty() {
            true => Ok(()),
            false => Err(faults),
        }
    }

    /// The unknowns of a mesh that are held, each with the number of the support that holds it: the first one of
    /// several, which agree.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, or when supports contradict each other.
    pub fn held_by(&self, mesh: &Mesh) -> Result<BTreeMap<usize, usize>, Diagnostic> {
        self.all_supported(mesh)?;
        let mut by = BTreeMap::new();
        for number in (0..self.supports.len()).rev() {
            let own = self.supported(mesh, number..number + 1)?;
            by.extend(own.held.into_keys().map(|unknown| (unknown, number)));
        }
        Ok(by)
    }

    /// The unknowns of a mesh that follow others, each with the one that it follows: those of grips with a given force.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, when a group cannot be held so, or when supports contradict
    /// each other.
    pub fn ties(&self, mesh: &Mesh) -> Result<BTreeMap<usize, usize>, Diagnostic> {
        Ok(self.all_supported(mesh)?.ties)
    }

    /// What all supports do to the unknowns of a mesh, once they agree.
    fn all_supported(&self, mesh: &Mesh) -> Result<Supported, Diagnostic> {
        match contradictions(self, mesh)?.into_iter().next() {
            Some(fault) => Err(fault),
            None => self.supported(mesh, 0..self.supports.len()),
        }
    }

    /// Adds a load on a group of a mesh.
    fn load(
        &self,
        mesh: &Mesh,
        name: &str,
        load: &Load,
        loaded: &mut Loaded,
    ) -> Result<(), Diagnostic> {
        let group = group("load", mesh, name)?;
        let added = loaded.add(mesh, group, load, self.thickness);
        added.map_err(|reason| refused("load", name, &reason))
    }

    /// What some of the supports do to the unknowns of a mesh.
    fn supported(&self, mesh: &Mesh, which: Range<usize>) -> Result<Supported, Diagnostic> {
        let mut supported = Supported::default();
        for (name, support) in &self.supports[which] {
            let added = supported.add(mesh, group("support", mesh, name)?, support);
            added.map_err(|reason| refused("support", name, &reason))?;
        }
        Ok(supported)
    }

    /// The dead forces on the unknowns of a mesh in N at load factor 1: all loads but pressures, and the forces of grips.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a load names no group of the mesh, or when a group cannot carry it.
    pub fn dead_forces(&self, mesh: &Mesh) -> Result<Vec<f64>, Diagnostic> {
        let mut sum = vec![0.0; 2 * mesh.nodes.len()];
        for (name, load) in &self.loads {
            let forces = loads::dead_forces(mesh, group("load", mesh, name)?, load, self.thickness)
                .map_err(|reason| refused("load", name, &reason))?;
            for (sum, force) in sum.iter_mut().zip(forces) {
                *sum += force;
            }
        }
        let supported = self.all_supported(mesh)?;
        for (unknown, force) in supported.forces {
            sum[unknown] += force;
        }
        Ok(sum)
    }

    /// The problem on the nodes of a mesh with an energy of them.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support or a load names no group of the mesh, or when a group cannot carry it.
    pub fn on<'a>(
        &self,
        mesh: &'a Mesh,
        energy: &'a dyn Potential,
    ) -> Result<Discretised<'a>, Diagnostic> {
        let supported = self.all_supported(mesh)?;
        let mut loaded = Loaded::new(2 * mesh.nodes.len());
        for (name, load) in &self.loads {
            self.load(mesh, name, load, &mut loaded)?;
        }
        loaded.close(&supported);
        Ok(Discretised {
            mesh,
            energy,
            supported,
            loaded,
            stiffness: self.law.youngs_modulus() * self.thickness,
            names: Box::new(|cell| mesh.describe_cell(cell)),
        })
    }
}

/// A support or a load that does not suit a group.
fn refused(what: &str, group: &str, reason: &str) -> Diagnostic {
    Diagnostic::error(what, format!("the group `{group}` {reason}"))
}

fn group<'a>(what: &str, mesh: &'a Mesh, name: &str) -> Result<&'a Group, Diagnostic> {
    let groups = mesh.groups();
    groups.get(name).ok_or_else(|| {
        let known: Vec<_> = groups.keys().map(String::as_str).collect();
        let fault = Diagnostic::error(what, format!("the mesh has no group `{name}`"));
        fault.hint(format!("its groups are {}", known.join(", ")))
    })
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
    /// is a grip with a given force.
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
        let mut field = match force {
            Some(force) => compliance(self, at, &force)?,
            None => influence(self, at, &motion)?,
        };
        for (unknown, master) in ties {
            field[*unknown] = field[*master];
        }
        Ok(field)
    }

    /// The mean displacement of a group in mm, from a state.
    ///
    /// # Panics
    /// When the mesh has no such group.
    pub fn displacement(&self, state: &State, name: &str) -> [f64; 2] {
        let nodes = &self.mesh.groups()[name].nodes;
        [0, 1].map(|axis| {
            let sum: f64 = nodes
                .iter()
                .map(|node| state.displacement[2 * node + axis])
                .sum();
            sum / nodes.len() as f64
        })
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
            Box::new(Tied::new(loaded, &self.supported.ties))
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

#[cfg(test)]
mod tests;
