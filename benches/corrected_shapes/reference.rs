//! The converged field of a shape: quadratic finite elements on a mesh graded towards the singular places.

use gelbench::error::Error;
use gelbench::mesh::{Interpolation, Mesh, NodalField};
use gelbench::solve::Assembly;

use super::meshes::Layout;
use super::opponent;
use super::shapes::{Case, Family};

/// Cells across of the mesh at whose nodes fields are compared: few of them are nodes of the meshes that are measured.
const COMPARED: usize = 19;

/// Cells across of the coarsest meshes, of which none is that of a mesh that is measured.
const REFERENCE_BASES: [usize; 2] = [5, 7];

/// A field that all others are measured against.
pub struct Reference {
    pub layout: Layout,
    pub nodes: usize,
    /// The mesh at whose nodes fields are compared, and the area of each in mm².
    compared: Mesh,
    areas: Vec<f64>,
    field: Vec<f64>,
    /// √(Σ A |u|²) of it.
    size: f64,
    /// The grip's force in N, or the strain energy in mJ.
    force: f64,
    /// Its own error, estimated from those of the meshes before, in percent.
    pub own_percent: f64,
}

impl Reference {
    /// On a mesh of so many nodes at most.
    pub fn new(case: &Case, most: usize) -> Result<Self, Error> {
        let bases = REFERENCE_BASES.into_iter();
        let families = bases.map(|base| Family {
            case,
            kind: case.kinds[1],
            grading: case.finest_grading,
            base,
        });
        let level = |family: &Family| family.levels(0..=most).last().copied().unwrap_or(2);
        let largest = families.max_by_key(|family| family.nodes(level(family)));
        let family = largest.expect("a family");
        let level = level(&family);
        let meshes = family.meshes(level + 1);
        let compared = compared(case);
        let mut reference = Self {
            layout: family.layout(level),
            nodes: meshes[level].nodes.len(),
            areas: compared.corner_areas(),
            compared,
            field: Vec::new(),
            size: f64::NAN,
            force: f64::NAN,
            own_percent: f64::NAN,
        };
        let mut fields = Vec::new();
        for last in level.saturating_sub(2)..=level {
            let found = opponent::nested(&case.problem, &meshes[..=last], [1e-6; 2])?;
            let exact = opponent::polished(&case.problem, &meshes[last], found.u)?;
            reference.force = force(case, &meshes[last], &exact);
            fields.push(reference.on(&meshes[last]).apply(&exact));
        }
        reference.field = fields.pop().expect("a mesh");
        reference.size = reference.field.weighted_norm(&reference.areas);
        let [coarse, fine] = [0, 1].map(|place| {
            let [a, b] = [place, place + 1].map(|place| fields.get(place));
            let (a, b) = (a.expect("a mesh"), b.unwrap_or(&reference.field));
            a.weighted_distance(b, &reference.areas)
        });
        // Changes shrink by a ratio from mesh to mesh, and all finer meshes would add s q/(1 − q).
        let ratio = (fine / coarse).clamp(0.25, 0.9);
        reference.own_percent = 100.0 * fine / reference.size * ratio / (1.0 - ratio);
        Ok(reference)
    }

    /// From the nodes of a mesh to those at which fields are compared.
    pub fn on(&self, mesh: &Mesh) -> Interpolation {
        mesh.interpolation_on(&self.compared)
    }

    /// 100 √(Σ A |u − v|² / Σ A |v|²) of a field u, v being this one.
    pub fn error_percent(&self, on: &Interpolation, u: &[f64]) -> f64 {
        let distance = on.apply(u).weighted_distance(&self.field, &self.areas);
        100.0 * distance / self.size
    }

    /// The same of two fields on one mesh.
    pub fn difference_percent(&self, on: &Interpolation, u: &[f64], exact: &[f64]) -> f64 {
        let difference = on.apply(&u.minus(exact));
        100.0 * difference.weighted_norm(&self.areas) / self.size
    }

    /// Deviation of the grip's force, or of the strain energy under loads, in percent, without sign.
    pub fn force_percent(&self, case: &Case, mesh: &Mesh, u: &[f64]) -> f64 {
        100.0 * (force(case, mesh, u) / self.force - 1.0).abs()
    }
}

/// Equal linear cells.
fn compared(case: &Case) -> Mesh {
    let family = Family {
        case,
        kind: case.kinds[0],
        grading: 1.0,
        base: COMPARED,
    };
    family.mesh(0)
}

/// The force on the right grip along X in N: the virtual work of all forces in a uniform stretch, which feels what an iteration left far
/// less than the sum of the reactions does. The strain energy in mJ where nothing is gripped.
fn force(case: &Case, mesh: &Mesh, u: &[f64]) -> f64 {
    let energy = case.problem.finite_elements(mesh);
    let mut forces = vec![0.0; u.len()];
    let energy = Assembly::residual(&energy, u, &mut forces).unwrap_or(f64::NAN);
    case.gripped.map_or(energy, |length| {
        let nodes = mesh.nodes.iter().zip(forces.chunks_exact(2));
        nodes.map(|([x, _], force)| x / length * force[0]).sum()
    })
}
