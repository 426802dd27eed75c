//! The boundary value problem of a sheet of any shape: supports and loads on the named groups of its mesh.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::error::Diagnostic;
use crate::material::HyperelasticLaw;
use crate::mesh::{Group, Mesh};
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::{Potential, State};
use crate::units::Linear;

mod balance;
mod contradictions;
mod deformed;
mod discretised;
mod groups;
mod loads;
pub mod plate;
mod pressure;
mod rigid;
pub mod sheet_energy;
mod supports;
mod ties;

pub use balance::{Balance, Resultant};
pub use deformed::{DeformedSheet, PointFault, Stress};
pub use discretised::Discretised;

use contradictions::contradictions;
use loads::Loaded;
use rigid::free_motions;
use supports::Supported;

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

impl BoundaryProblem {
    /// The finite-element energy of a mesh.
    pub fn finite_elements(&self, mesh: &Mesh) -> SheetEnergy {
        SheetEnergy::of_mesh(Arc::clone(&self.law), mesh, self.thickness)
    }

    /// A state on a mesh, ready to be asked at any point of the sheet.
    pub fn deformed(&self, mesh: &Mesh, state: &State) -> DeformedSheet {
        DeformedSheet::new(
            mesh.clone(),
            state.displacement.clone(),
            Arc::clone(&self.law),
        )
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

#[cfg(test)]
mod tests;
