//! The boundary value problem of a sheet of any shape: supports and loads on the named groups of its mesh.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::balance::Body;
use super::boundary_conditions::{Load, Support};
use super::constraints::{Constraints, Tie};
use super::contradictions::{agreeing, contradictions};
use super::deformed::DeformedSheet;
use super::laws::{Region, SheetLaws};
use super::loads::{Loads, dead_forces};
use super::model::Model;
use super::rigid::free_motions;
use super::sheet_energy::SheetEnergy;
use crate::error::Diagnostic;
use crate::material::HyperelasticLaw;
use crate::mesh::Mesh;
use crate::solve::{Remembering, State};

/// A sheet between its supports under its loads.
#[derive(Clone, Debug)]
pub struct BoundaryProblem {
    /// Thickness in mm.
    pub thickness: f64,
    /// The material of all cells that belong to no region.
    pub law: Arc<dyn HyperelasticLaw>,
    /// Groups of cells of other materials, which share no cell.
    pub regions: Vec<Region>,
    /// Supports by group; those that share nodes must agree there.
    pub supports: Vec<(String, Support)>,
    /// Loads by group.
    pub loads: Vec<(String, Load)>,
}

/// Whether a group of a mesh consists of nodes without edges, lines or cells.
fn is_of_points(mesh: &Mesh, name: &str) -> bool {
    let group = mesh.groups().get(name);
    group.is_some_and(|group| !group.has_parts())
}

impl BoundaryProblem {
    /// A sheet of one material between supports, without loads.
    pub fn supported(
        thickness: f64,
        law: Arc<dyn HyperelasticLaw>,
        supports: Vec<(String, Support)>,
    ) -> Self {
        Self {
            thickness,
            law,
            regions: Vec::new(),
            supports,
            loads: Vec::new(),
        }
    }

    /// The finite-element energy of a mesh.
    pub fn finite_elements(&self, mesh: &Mesh) -> SheetEnergy {
        SheetEnergy::of_mesh(self.laws().in_cells(mesh), mesh, self.thickness)
    }

    /// The resultant in N of the loads on a group of a mesh with the displacements `u`, at a load factor.
    ///
    /// # Errors
    /// A [`Diagnostic`] for a load that does not suit the mesh.
    pub fn load_on(
        &self,
        mesh: &Mesh,
        name: &str,
        (factor, u): (f64, &[f64]),
    ) -> Result<[f64; 2], Diagnostic> {
        let loads = self.loads.iter().filter(|(group, _)| group == name);
        let loads: Vec<_> = loads.cloned().collect();
        if loads.is_empty() {
            return Ok([0.0; 2]);
        }
        let loads = Loads::of(mesh, &loads, self.thickness)?;
        Ok(loads.resultant(factor, u, &Body::new(mesh, u)).force)
    }

    /// The laws of its material.
    pub fn laws(&self) -> SheetLaws<'_> {
        SheetLaws {
            law: &self.law,
            regions: &self.regions,
        }
    }

    /// A state on a mesh, to be evaluated at any point of the sheet.
    pub fn deformed(&self, mesh: &Mesh, state: &State) -> DeformedSheet {
        DeformedSheet::new(
            mesh.clone(),
            state.displacement.clone(),
            self.laws().in_cells(mesh),
        )
    }

    /// Checks that the problem can be solved on a mesh: groups must exist and suit their supports and loads, supports
    /// must not contradict each other, and no part may move without strain.
    ///
    /// # Errors
    /// All faults, each with its position and a remedy.
    pub fn check(&self, mesh: &Mesh) -> Result<(), Vec<Diagnostic>> {
        let supports = self.supports.iter().map(std::slice::from_ref);
        let supports = supports.map(|support| Constraints::of(mesh, support).err());
        let loads = self.loads.iter().map(std::slice::from_ref);
        let loads = loads.map(|load| Loads::of(mesh, load, self.thickness).err());
        let mut faults: Vec<Diagnostic> = supports.chain(loads).flatten().collect();
        if faults.is_empty() {
            faults = contradictions(&self.supports, mesh).unwrap_or_else(|fault| vec![fault]);
        }
        if faults.is_empty() {
            let all = Constraints::of(mesh, &self.supports);
            faults = all.map_or_else(|fault| vec![fault], |all| free_motions(mesh, &all));
        }
        if faults.is_empty() {
            Ok(())
        } else {
            Err(faults)
        }
    }

    /// The groups of single nodes on which forces act: displacements there do not converge on finer meshes.
    pub fn forces_on_points(&self, mesh: &Mesh) -> Vec<&str> {
        let forces = self.loads.iter();
        let forces = forces
            .filter(|(name, load)| matches!(load, Load::Force(_)) && is_of_points(mesh, name));
        forces.map(|(name, _)| &**name).collect()
    }

    /// The groups of single nodes that supports move: on finer meshes the forces that this takes tend to zero, and so does the field.
    pub fn moved_points(&self, mesh: &Mesh) -> Vec<&str> {
        let moved = self.supports.iter();
        let moved = moved.filter(|(name, support)| !support.rests() && is_of_points(mesh, name));
        moved.map(|(name, _)| &**name).collect()
    }

    /// The groups whose loads act along held unknowns alone: such loads change only the supports' forces.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support or a load does not suit a group of the mesh.
    pub fn idle_loads(&self, mesh: &Mesh) -> Result<Vec<&str>, Diagnostic> {
        let held = Constraints::of(mesh, &self.supports)?.held;
        let mut idle = Vec::new();
        for load in &self.loads {
            let forces = dead_forces(mesh, load, self.thickness)?;
            let acts = |unknown: &usize| match load.1 {
                Load::Pressure(_) => true,
                Load::Traction(_) | Load::Force(_) => forces[*unknown] != 0.0,
            };
            let nodes = mesh.groups()[&load.0].nodes.iter();
            let unknowns = nodes.flat_map(|node| [2 * node, 2 * node + 1]);
            let mut loaded = unknowns.filter(acts).peekable();
            if loaded.peek().is_some() && loaded.all(|unknown| held.contains_key(&unknown)) {
                idle.push(&*load.0);
            }
        }
        Ok(idle)
    }

    /// The unknowns of a mesh that are held, each with the number of the support that holds it; of several, which must agree, the first. Where
    /// another support or a second line meets an inclined line, that line holds what they leave free.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, or when supports contradict each other.
    pub fn held_by(&self, mesh: &Mesh) -> Result<BTreeMap<usize, usize>, Diagnostic> {
        let all = agreeing(&self.supports, mesh)?;
        let mut by = BTreeMap::new();
        for (number, support) in self.supports.iter().enumerate().rev() {
            let constraints = Constraints::of(mesh, std::slice::from_ref(support))?;
            by.extend(
                constraints
                    .held
                    .into_keys()
                    .map(|unknown| (unknown, number)),
            );
        }
        for unknown in all.held.into_keys() {
            let slides = |(group, support): &(String, Support)| {
                let nodes = &mesh.groups()[group].nodes;
                *support == Support::Roller && nodes.contains(&(unknown / 2))
            };
            let mut supports = self.supports.iter();
            let line = match unknown % 2 {
                _ if by.contains_key(&unknown) => None,
                0 => supports.position(slides),
                _ => supports.rposition(slides),
            };
            by.extend(line.map(|number| (unknown, number)));
        }
        Ok(by)
    }

    /// The tied unknowns of a mesh, each with the unknown that it follows: those of grips with a given force, and of inclined lines.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, when a group does not suit its support, or when supports contradict each other.
    pub fn ties(&self, mesh: &Mesh) -> Result<BTreeMap<usize, Tie>, Diagnostic> {
        Ok(agreeing(&self.supports, mesh)?.ties)
    }

    /// The dead forces on the unknowns of a mesh in N at load factor 1: all loads except pressures, and the forces on grips.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a load names no group of the mesh, or when a group cannot carry it.
    pub fn dead_forces(&self, mesh: &Mesh) -> Result<Vec<f64>, Diagnostic> {
        let mut sum = vec![0.0; 2 * mesh.nodes.len()];
        for load in &self.loads {
            for (sum, force) in sum.iter_mut().zip(dead_forces(mesh, load, self.thickness)?) {
                *sum += force;
            }
        }
        for (unknown, force) in agreeing(&self.supports, mesh)?.forces {
            sum[unknown] += force;
        }
        Ok(sum)
    }

    /// The problem on a mesh with an energy of its nodal displacements.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support or a load names no group of the mesh, or when a group cannot carry it.
    pub fn on<'a>(
        &self,
        mesh: &'a Mesh,
        energy: &'a dyn Remembering,
    ) -> Result<Model<'a>, Diagnostic> {
        let constraints = agreeing(&self.supports, mesh)?;
        let loads = Loads::of(mesh, &self.loads, self.thickness)?;
        let moduli = self.laws().all().map(|law| law.youngs_modulus());
        let stiffness = moduli.fold(0.0, f64::max) * self.thickness;
        Ok(Model::new(mesh, energy, constraints, loads, stiffness))
    }
}
