//! A field computed on another mesh by another method, without noise, interpolated onto a finer mesh and brought into equilibrium.
//!
//! ```text
//! minimise ½ ‖u − ū‖²   subject to   F(u) = 0 at inner nodes and free edges,   u = ū at the other edges
//! ```
//!
//! ū is the given field interpolated at the nodes. There are as many equations as unknowns, so that the field does
//! not depend on the norm; the multipliers ζ, K ζ = ū − u, show where the given field contradicts the physics. An
//! edge with known displacements has these instead of ū, a rigid one the rigid motion nearest to ū.

use std::collections::BTreeSet;

use super::edges::{Body, bodies};
use super::equations::{approach, solve, unloaded};
use super::input::{Edge, EdgeCondition, Knowledge, Specimen};
use super::outcome::{EdgeForce, FieldEstimate, MarkerEstimate, StressEstimate};
use crate::error::{Error, SolveFault};
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::mesh::Mesh;
use crate::problem::RigidMotion;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::vector::difference;
use crate::solve::{Newton, NewtonSettings};
use crate::statistics::Estimate;

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 40,
};

/// The rule by which data and physics are balanced.
const RULE: &str =
    "equilibrium holds exactly; edges that are not free keep the displacements of the given field";

/// Shares of the given field that are solved one after the other; each row is tried where the one before leads to no equilibrium.
const PARTS: [&[f64]; 3] = [
    &[1.0],
    &[0.5, 1.0],
    &[0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0],
];

/// Brings the field `displacement` of the mesh `given` onto the specimen's mesh. The result has no uncertainty: all
/// standard errors are zero, and the residual at each node of the given mesh is no noise.
///
/// # Errors
/// [`Error::Input`] when the mesh and the conditions do not match, [`Error::Solve`] when no equilibrium is found.
pub fn transfer(
    specimen: &Specimen,
    given: &Mesh,
    displacement: &[f64],
    knowledge: &Knowledge,
) -> Result<FieldEstimate, Error> {
    let mesh = specimen.mesh;
    let edges = Edge::of_boundary(mesh, knowledge)?;
    let start = given.displacement_on(displacement, mesh);
    let imposed = imposed(mesh, &edges, &start);
    if imposed.iter().all(Option::is_none) {
        return Err(unloaded());
    }
    let energy = SheetEnergy::of_mesh(specimen.laws.clone(), mesh, specimen.thickness);
    let held: Vec<bool> = imposed.iter().map(Option::is_some).collect();
    let mut newton = Newton::new(&energy, &held).map_err(solve)?;
    let (field, residual, steps) = equilibrium(&mut newton, &energy, mesh, &start, &imposed)?;
    let describe = |cell: usize| mesh.describe_cell(cell);
    newton
        .tangent
        .at(&energy, &field, &describe)
        .map_err(solve)?;
    let pull = difference(&field, &start);
    let multipliers = newton.tangent.changes(&[pull]).map_err(solve)?.remove(0);
    let mut reactions = residual;
    for unknown in newton.free() {
        reactions[*unknown] = 0.0;
    }
    let cells = (0..mesh.cell_count()).map(|cell| state(specimen, &field, cell));
    Ok(FieldEstimate {
        displacement_error: vec![0.0; field.len()],
        cells: cells.collect::<Result<_, _>>()?,
        forces: forces(mesh, &edges, &reactions),
        markers: differences(mesh, &field, given, displacement),
        known_noise: true,
        rule: RULE.into(),
        edges: edges.iter().map(Edge::outcome).collect(),
        steps,
        reactions,
        multipliers,
        displacement: field,
        ..FieldEstimate::default()
    })
}

/// The values of the held unknowns. Where edges meet, known displacements take precedence over rigid ones and these over unknown ones.
fn imposed(mesh: &Mesh, edges: &[Edge], start: &[f64]) -> Vec<Option<f64>> {
    let mut imposed: Vec<Option<f64>> = vec![None; start.len()];
    let mut impose = |node: usize, values: [Option<f64>; 2]| {
        for (axis, value) in values.into_iter().enumerate() {
            imposed[2 * node + axis] = imposed[2 * node + axis].or(value);
        }
    };
    let mut ranked: Vec<&Edge> = edges.iter().collect();
    ranked.sort_by_key(|edge| edge.condition.rank());
    for Edge {
        segment, condition, ..
    } in ranked
    {
        match condition {
            EdgeCondition::Free => {}
            EdgeCondition::Known(values) => {
                segment.nodes.iter().for_each(|node| impose(*node, *values));
            }
            EdgeCondition::Unknown => {
                for node in &segment.nodes {
                    impose(*node, [0, 1].map(|axis| Some(start[2 * node + axis])));
                }
            }
            EdgeCondition::Rigid => {
                let sides = edges.iter().filter(|other| {
                    other.condition == EdgeCondition::Rigid && other.segment.name == segment.name
                });
                let nodes = sides.flat_map(|side| side.segment.nodes.iter().copied());
                let body: Vec<usize> = nodes.collect::<BTreeSet<_>>().into_iter().collect();
                for (node, u) in body.iter().zip(rigid(mesh, &body, start)) {
                    impose(*node, u.map(Some));
                }
            }
        }
    }
    imposed
}

/// The rigid motion of nodes that is nearest to a field, in the sense of least squares.
fn rigid(mesh: &Mesh, nodes: &[usize], field: &[f64]) -> Vec<[f64; 2]> {
    let pairs = nodes.iter().map(|node| {
        let rest = mesh.nodes[*node];
        let moved = [0, 1].map(|axis| rest[axis] + field[2 * node + axis]);
        (1.0, rest, moved)
    });
    let (middle, motion) = RigidMotion::nearest(&pairs.collect::<Vec<_>>());
    let arm = |node: &usize| [0, 1].map(|axis| mesh.nodes[*node][axis] - middle[axis]);
    nodes.iter().map(|node| motion.at(arm(node))).collect()
}

/// The equilibrium with the imposed values, its residual, and the number of shares that it took.
fn equilibrium(
    newton: &mut Newton,
    energy: &SheetEnergy,
    mesh: &Mesh,
    start: &[f64],
    imposed: &[Option<f64>],
) -> Result<(Vec<f64>, Vec<f64>, usize), Error> {
    let describe = |cell: usize| mesh.describe_cell(cell);
    let mut fault = SolveFault::Singular;
    for parts in PARTS {
        let mut field: Vec<f64> = start.iter().map(|u| parts[0] * u).collect();
        let mut residual = vec![0.0; field.len()];
        let mut before = parts[0];
        let solved = parts.iter().try_for_each(|part| {
            field.iter_mut().for_each(|u| *u *= part / before);
            let pairs = field.iter().zip(imposed);
            let wanted: Vec<f64> = pairs
                .map(|(u, imposed)| imposed.map_or(*u, |value| part * value))
                .collect();
            before = *part;
            approach(newton, energy, &mut field, &wanted, &describe)?;
            newton
                .solve(energy, &mut field, &mut residual, NEWTON, &describe)
                .map(|_| ())
        });
        match solved {
            Ok(()) => return Ok((field, residual, parts.len())),
            Err(last) => fault = last,
        }
    }
    Err(solve(fault))
}

fn state(specimen: &Specimen, field: &[f64], cell: usize) -> Result<StressEstimate, Error> {
    let mesh = specimen.mesh;
    let gradient = mesh.gradient_at(field, cell, mesh.shape(cell).centre());
    let kinematics = Kinematics::new(&PlaneTensor::from(gradient)).map_err(|_| {
        solve(SolveFault::Inverted {
            element: mesh.describe_cell(cell),
        })
    })?;
    let law = specimen.laws.of(cell);
    let (_, stress) = law.stress(&kinematics);
    Ok(StressEstimate {
        first_piola_kirchhoff_stress: stress.into(),
        stress_error: [0.0; 4],
        mesh_error: 0.0,
        thickness: specimen.thickness * law.thickness_stretch(&kinematics),
        thickness_error: 0.0,
    })
}

/// The forces of the bodies that hold the sheet.
fn forces(mesh: &Mesh, edges: &[Edge], reactions: &[f64]) -> Vec<EdgeForce> {
    let edges = edges.iter().map(|edge| (&edge.segment, edge.condition));
    let force = |body: Body| EdgeForce {
        force: body.force(reactions).map(Estimate::exact),
        edge: body.name,
    };
    bodies(mesh, edges).into_iter().map(force).collect()
}

/// The given field at its nodes minus the corrected one.
fn differences(
    mesh: &Mesh,
    field: &[f64],
    given: &Mesh,
    displacement: &[f64],
) -> Vec<Option<MarkerEstimate>> {
    let pairs = given.nodes.iter().zip(displacement.chunks_exact(2));
    let difference = |(position, u): (&[f64; 2], &[f64])| {
        let there = mesh.displacement_at(field, *position);
        Some(MarkerEstimate {
            residual: [u[0] - there[0], u[1] - there[1]],
            standardised_residual: 0.0,
            trust: 1.0,
            outlier: false,
        })
    };
    pairs.map(difference).collect()
}
