//! The discretisation error of an estimated field, from the same equations on cells half as large.
//!
//! ```text
//! d = u_{h/2}(p) − u_h(p)                      at the motion p of the edges that was found
//! M δp = −AᵀWHd/v − Gᵀd_F/σ                    the response of the regression to d, as if it were in the data
//! e = d + S δp                                                                            [mm]
//! G = ∇u_{h/2} + ∇(S δp)                       in the middle of a cell                       [–]
//! ```
//!
//! with A, W, v, G, M of [`crate::estimation::regression`], S = ∂u/∂p, d_F the same difference of the
//! measured forces. The difference of two meshes is at least half of the coarser one's error where the order of convergence is one,
//! as near a singular corner, and a larger part of it elsewhere: ± 1.96 e covers the error.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::estimation::edges::Body;
use crate::estimation::equations::{BodyForce, Equations, Linear};
use crate::estimation::input::{Edge, EdgeCondition, MeasuredForce};
use crate::estimation::regression::VarianceComponents;
use crate::estimation::search::{MeshError, NearestField};
use crate::mesh::Mesh;
use crate::problem::corner_forces::{Hold, Share, reaction_shares};
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::vector::{difference, dot, moved};
use crate::solve::{Newton, NewtonSettings, Sum};

/// Meshes with more cells are not refined.
pub const MOST_REFINED_CELLS: usize = 25_000;

const SETTINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-8,
    max_iterations: 20,
};

/// The difference of the refined mesh's solution at the same motion of the edges.
pub struct MeshDifference {
    fine: Fine,
    /// H d, two numbers per marker.
    pub markers: Vec<f64>,
    /// The difference of the force of each body.
    forces: Vec<[f64; 2]>,
}

/// The equilibrium on the refined mesh.
struct Fine {
    mesh: Mesh,
    displacement: Vec<f64>,
    residual: Vec<f64>,
    /// The held unknowns of each edge along each axis.
    held: Vec<[Vec<usize>; 2]>,
}

impl Fine {
    /// The nodes and sides of the refined mesh that a body holds.
    fn hold(&self, body: &Body) -> Hold {
        let nodes = [0, 1].map(|axis| -> BTreeSet<usize> {
            let unknowns = body.edges.iter().flat_map(|edge| &self.held[*edge][axis]);
            unknowns.map(|unknown| unknown / 2).collect()
        });
        let held: BTreeSet<usize> = nodes.iter().flatten().copied().collect();
        Hold {
            rank: body.rank,
            sides: Hold::sides(&self.mesh, &held),
            nodes,
        }
    }

    /// ∇u_{h/2} in the middle of a coarse cell: for a quadrilateral the mean of its four parts, which meet there.
    fn gradient_at_centre(&self, coarse: usize) -> [f64; 4] {
        let first = 4 * coarse;
        let shape = self.mesh.shape(first);
        let at = |cell: usize, local| self.mesh.gradient_at(&self.displacement, cell, local);
        if shape.is_triangle() {
            return at(first + 3, shape.centre());
        }
        let parts = [0, 1, 2, 3].map(|part| at(first + part, shape.natural_nodes()[2]));
        [0, 1, 2, 3].map(|component| parts.iter().map(|part| part[component] / 4.0).sum())
    }
}

impl NearestField<'_> {
    /// The difference of a solution on cells half as large; `None` where the mesh is too large to be refined, or the
    /// refined one has no equilibrium.
    pub fn mesh_difference(&self) -> Option<MeshDifference> {
        let mesh = self.equations.task.specimen.mesh;
        if mesh.cell_count() > MOST_REFINED_CELLS {
            return None;
        }
        let fine = self.refined(mesh)?;
        let observations = self.equations.task.observations;
        let nearby = observations.interpolation.multiply(&self.field);
        let positions = observations.positions.iter();
        let markers =
            positions.flat_map(|position| fine.mesh.displacement_at(&fine.displacement, *position));
        Some(MeshDifference {
            markers: markers.zip(nearby).map(|(a, b)| a - b).collect(),
            forces: self.force_differences(&fine),
            fine,
        })
    }

    /// The discretisation error, where [`Self::mesh_difference`] exists; it is computed once.
    pub fn mesh_error(&self) -> Option<&MeshError> {
        let refined = self
            .known_mesh_error
            .get_or_init(|| self.compute_mesh_error());
        refined.as_ref()
    }

    /// The discretisation error, computed anew.
    pub fn compute_mesh_error(&self) -> Option<MeshError> {
        let mesh = self.equations.task.specimen.mesh;
        let refined = self.mesh_difference()?;
        let (linear, variances) = (&self.linear, &self.variances);
        let target = self.equations.mesh_target(&refined, linear, variances);
        let change = &self.fit.covariance * target;
        let fine = &refined.fine;
        let fine_field = fine.mesh.displacement_on(&fine.displacement, mesh);
        let difference = difference(&fine_field, &self.field);
        let columns = || self.linear.sensitivities.iter().zip(change.iter());
        let adapted: Vec<f64> = (0..difference.len())
            .map(|row| columns().map(|(column, change)| column[row] * change).sum())
            .collect();
        let gradient = |cell: usize| {
            let after = mesh.gradient_at(&adapted, cell, mesh.shape(cell).centre());
            let fine = fine.gradient_at_centre(cell);
            [0, 1, 2, 3].map(|component| fine[component] + after[component])
        };
        let followed = &self.linear.design * &change;
        Some(MeshError {
            displacement: moved(&difference, 1.0, &adapted),
            gradients: (0..mesh.cell_count())
                .into_par_iter()
                .map(gradient)
                .collect(),
            markers: moved(&refined.markers, 1.0, followed.as_slice()),
            forces: refined.forces,
            parameters: change,
        })
    }

    /// The same edges and law on cells half as large.
    fn refined(&self, mesh: &Mesh) -> Option<Fine> {
        let fine = mesh.refined();
        let mut coarse = vec![true; self.field.len()];
        for unknown in self.equations.newton.free() {
            coarse[*unknown] = false;
        }
        let edges = self.equations.edges.iter();
        let held: Vec<_> = edges
            .map(|edge| held_unknowns(mesh, &fine, edge, &coarse))
            .collect();
        let mut fixed = vec![false; 2 * fine.nodes.len()];
        for unknown in held.iter().flatten().flatten() {
            fixed[*unknown] = true;
        }
        let thickness = self.equations.task.specimen.thickness;
        let energy = SheetEnergy::of_mesh(self.equations.energy.laws().refined(), &fine, thickness);
        let forces = match &self.equations.body {
            Some(_) => {
                let coefficients = self.equations.body_coefficients(&self.parameters);
                BodyForce::new(&fine, &fixed).forces(coefficients, fixed.len())
            }
            None => vec![0.0; fixed.len()],
        };
        let pushed = Sum::with_forces(&energy, &forces);
        let mut displacement = mesh.displacement_on(&self.field, &fine);
        let mut residual = vec![0.0; displacement.len()];
        let describe = |cell: usize| fine.describe_cell(cell);
        let solved = Newton::new(&pushed, &fixed).and_then(|mut newton| {
            // The coarser field is near: one factor serves all steps if the tangent there is positive definite.
            let begun = newton.tangent.at(&pushed, &displacement, &describe);
            let method = if begun.is_ok() {
                Newton::solve_near
            } else {
                Newton::solve
            };
            method(
                &mut newton,
                &pushed,
                &mut displacement,
                &mut residual,
                SETTINGS,
                &describe,
            )
        });
        solved.ok()?;
        Some(Fine {
            mesh: fine,
            displacement,
            residual,
            held,
        })
    }

    /// d_F of each body.
    fn force_differences(&self, fine: &Fine) -> Vec<[f64; 2]> {
        let reactions = self.reactions();
        let bodies = &self.equations.bodies;
        let owned: Vec<Hold> = bodies.iter().map(|body| fine.hold(body)).collect();
        let holds: Vec<&Hold> = owned.iter().collect();
        let shares = reaction_shares(&fine.mesh, &holds).into_iter().zip(bodies);
        let difference = |(shares, body): ([Vec<Share>; 2], &Body)| {
            let fine_body = Body {
                shares,
                ..body.clone()
            };
            let (before, after) = (body.force(&reactions), fine_body.force(&fine.residual));
            [0, 1].map(|axis| after[axis] - before[axis])
        };
        shares.map(difference).collect()
    }
}

impl Equations<'_> {
    /// −AᵀWHd/v − Gᵀd_F/σ.
    pub fn mesh_target(
        &self,
        difference: &MeshDifference,
        linear: &Linear,
        variances: &VarianceComponents,
    ) -> DVector<f64> {
        let force = |measured: &MeasuredForce| -> f64 {
            let bodies = self.bodies.iter().zip(&difference.forces);
            let of_edge = bodies.filter(|(body, _)| body.name == measured.edge);
            of_edge.map(|(_, force)| force[measured.axis]).sum()
        };
        let measured = self.task.knowledge.measured_forces().iter();
        let forces: Vec<f64> = measured.map(force).collect();
        self.target_with_forces(&difference.markers, &forces, linear, variances)
    }

    /// −AᵀWd/v − Gᵀf/σ of displacements d at the markers and changes f of the measured forces in N.
    pub fn target_with_forces(
        &self,
        displacements: &[f64],
        forces: &[f64],
        linear: &Linear,
        variances: &VarianceComponents,
    ) -> DVector<f64> {
        let mut target = self.target_of(displacements, &linear.design, variances);
        let measured = self.task.knowledge.measured_forces().iter().zip(forces);
        for (row, (measured, force)) in measured.enumerate() {
            let slopes = linear.force_rows.0.row(row).transpose();
            target -= slopes * (force / measured.standard_deviation);
        }
        target
    }

    /// −AᵀWd/v of displacements d at the markers.
    pub fn target_of(
        &self,
        displacements: &[f64],
        design: &DMatrix<f64>,
        variances: &VarianceComponents,
    ) -> DVector<f64> {
        let weights = &self.task.observations.weights;
        let rows = displacements.iter().enumerate();
        let weighted =
            rows.map(|(row, d)| -variances.weight(weights, row) * d / variances.variance);
        let weighted = DVector::from_iterator(displacements.len(), weighted);
        design.tr_mul(&weighted)
    }
}

/// The unknowns of a refined mesh held by an edge: those between nodes of the edge whose unknowns are held.
fn held_unknowns(mesh: &Mesh, fine: &Mesh, edge: &Edge, held: &[bool]) -> [Vec<usize>; 2] {
    if edge.segment.inside {
        return [0, 1].map(|axis| held_inside(mesh, fine, edge, axis, held));
    }
    let mut boundary: Vec<usize> = fine.boundary().iter().flatten().copied().collect();
    boundary.sort_unstable();
    boundary.dedup();
    let pairs: Vec<[usize; 2]> = edge
        .segment
        .nodes
        .windows(2)
        .map(|pair| [pair[0], pair[1]])
        .collect();
    let on =
        |node: usize, ends: [usize; 2]| is_near(fine.nodes[node], ends.map(|end| mesh.nodes[end]));
    [0, 1].map(|axis| {
        let both = |pair: &[usize; 2]| pair.iter().all(|node| held[2 * node + axis]);
        let holds = |node: &&usize| pairs.iter().any(|pair| both(pair) && on(**node, *pair));
        let nodes = boundary.iter().filter(holds);
        match edge.condition {
            EdgeCondition::Free => Vec::new(),
            _ => nodes.map(|node| 2 * node + axis).collect(),
        }
    })
}

/// Whether a position is nearer to the straight line between two others than a tenth of its length.
fn is_near(position: [f64; 2], [from, to]: [[f64; 2]; 2]) -> bool {
    const NEAR: f64 = 0.1;
    let side = [to[0] - from[0], to[1] - from[1]];
    let square = dot(&side, &side);
    let along = [position[0] - from[0], position[1] - from[1]];
    let share = (dot(&along, &side) / square).clamp(0.0, 1.0);
    let off = [0, 1].map(|axis| along[axis] - share * side[axis]);
    dot(&off, &off) <= NEAR * NEAR * square
}

/// The unknowns of a refined mesh along an axis that a pad on the sheet holds: those in cells, and on sides of cells, whose nodes are all held.
fn held_inside(mesh: &Mesh, fine: &Mesh, edge: &Edge, axis: usize, held: &[bool]) -> Vec<usize> {
    let nodes = edge.segment.nodes.iter().copied();
    let pad: BTreeSet<usize> = nodes.filter(|node| held[2 * node + axis]).collect();
    let mut unknown_nodes = BTreeSet::new();
    for coarse in 0..mesh.cell_count() {
        let nodes = mesh.cell(coarse);
        let parts = (4 * coarse..4 * coarse + 4).flat_map(|part| fine.cell(part));
        let sides = mesh.shape(coarse).edges();
        let ends = sides.iter().map(|side| [nodes[side[0]], nodes[side[1]]]);
        let held_sides: Vec<_> = ends
            .filter(|ends| ends.iter().all(|end| held[2 * end + axis]))
            .collect();
        let is_held = nodes.iter().all(|node| held[2 * node + axis])
            && nodes.iter().any(|node| pad.contains(node));
        let on_side = |node: usize| {
            let mut near = held_sides
                .iter()
                .filter(|ends| ends.iter().any(|end| pad.contains(end)));
            near.any(|ends| is_near(fine.nodes[node], ends.map(|end| mesh.nodes[end])))
        };
        unknown_nodes.extend(parts.filter(|node| is_held || on_side(**node)).copied());
    }
    unknown_nodes
        .into_iter()
        .map(|node| 2 * node + axis)
        .collect()
}
