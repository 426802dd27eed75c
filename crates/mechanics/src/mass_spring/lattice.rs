//! The energy of springs and cells.

use std::sync::Arc;

use super::spring::{Spring, SpringPose};
use super::spring_law::SpringLaw;
use crate::material::law::{HyperelasticLaw, TensionResponse};
use crate::mesh::Mesh;
use crate::mesh::geometry::polygon_area;
use crate::solve::{Connectivity, Evaluated, Inadmissible, Local, Potential, Remembering};

/// The energy of a lattice: springs, then cells.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    pub laws: Vec<Arc<dyn HyperelasticLaw>>,
    pub spring_law: SpringLaw,
    /// Unknowns of the springs, then of the cells.
    connectivity: Connectivity,
    pub springs: Vec<Spring>,
    /// Reference vector of each spring over its squared rest length in 1/mm.
    directions: Vec<[f64; 2]>,
    corners: Vec<Vec<[f64; 2]>>,
    /// κ in N/mm.
    pub area_stiffness: f64,
}

/// λ − 1 of a spring with direction n x₀ = `direction` over x₀², whose ends move by `relative`,
/// without cancellation at small displacements.
///
/// `direction` is the reference vector divided by the squared rest length.
fn strain(direction: [f64; 2], relative: [f64; 2]) -> f64 {
    let inverse = direction[0].hypot(direction[1]); // 1/x₀
    let linear = 2.0 * (direction[0] * relative[0] + direction[1] * relative[1]);
    let quadratic = (relative[0].powi(2) + relative[1].powi(2)) * inverse * inverse;
    let square = linear + quadratic; // λ² − 1
    square / (1.0 + (1.0 + square).max(0.0).sqrt())
}

impl Lattice {
    pub fn new(
        laws: Vec<Arc<dyn HyperelasticLaw>>,
        mesh: &Mesh,
        springs: Vec<Spring>,
        area_stiffness: f64,
    ) -> Self {
        let mut connectivity = Connectivity::new(2 * mesh.nodes.len());
        for spring in &springs {
            connectivity.push_nodes(&spring.nodes);
        }
        let mut corners = Vec::new();
        for cell in 0..mesh.cell_count() {
            let nodes = mesh.corners(cell);
            connectivity.push_nodes(nodes);
            corners.push(nodes.iter().map(|node| mesh.nodes[*node]).collect());
        }
        let direction = |spring: &Spring| {
            let [from, to] = spring.nodes.map(|node| mesh.nodes[node]);
            [0, 1].map(|axis| (to[axis] - from[axis]) / spring.rest_length.powi(2))
        };
        Self {
            laws,
            spring_law: SpringLaw::Material,
            connectivity,
            directions: springs.iter().map(direction).collect(),
            springs,
            corners,
            area_stiffness,
        }
    }

    /// The law of a spring.
    fn law(&self, spring: usize) -> &dyn HyperelasticLaw {
        &*self.laws[usize::from(self.springs[spring].law)]
    }

    /// The sheet's tension curve along a spring.
    fn tension(&self, spring: usize, strain: f64) -> TensionResponse {
        let unit =
            self.directions[spring].map(|component| component * self.springs[spring].rest_length);
        self.spring_law.tension(self.law(spring), unit, strain)
    }

    /// Geometry of a spring with the displacements `u` of its ends, and with the largest energy so far from a history.
    pub fn pose_after(&self, index: usize, u: &[f64], history: &[f64]) -> SpringPose {
        let pose = self.pose(index, u);
        let softened = self.law(index).softening().zip(history.get(index));
        let response = softened.map(|(softening, most)| softening.tension(pose.response, *most));
        SpringPose {
            response: response.unwrap_or(pose.response),
            ..pose
        }
    }

    /// Geometry of a spring that was never loaded, with the displacements `u` of its ends.
    pub fn pose(&self, index: usize, u: &[f64]) -> SpringPose {
        let rest_length = self.springs[index].rest_length;
        let direction = self.directions[index];
        let relative = [u[2] - u[0], u[3] - u[1]];
        let strain = strain(direction, relative);
        let current =
            [0, 1].map(|axis| direction[axis] * rest_length + relative[axis] / rest_length);
        let stretch = 1.0 + strain;
        SpringPose {
            stretch,
            unit: current.map(|component| component / stretch),
            response: self.tension(index, strain),
        }
    }

    /// Energy a x₀ Ψ(λ), force a P and stiffness of one spring.
    fn evaluate_spring(&self, index: usize, u: &[f64], local: Local<'_>, history: &[f64]) -> f64 {
        let Spring {
            rest_length, area, ..
        } = self.springs[index];
        let pose = self.pose_after(index, u, history);
        let response = pose.response;
        let force = area * response.nominal_stress;
        pose.add_force(force, local.residual);
        if let Some(stiffness) = local.stiffness {
            let along = area * response.slope / rest_length;
            let across = force / (pose.stretch * rest_length);
            pose.add_stiffness([along, across], stiffness);
        }
        area * rest_length * response.energy
    }

    /// Energy ½ κ A₀ (A/A₀ − 1)² of one cell; a cell without a positive area is refused.
    ///
    /// ```text
    /// A = ½ Σ (xᵢ yᵢ₊₁ − xᵢ₊₁ yᵢ),   ∂A/∂xᵢ = ½ (yᵢ₊₁ − yᵢ₋₁),   ∂A/∂yᵢ = ½ (xᵢ₋₁ − xᵢ₊₁)
    /// ```
    fn evaluate_cell(&self, cell: usize, u: &[f64], local: Local<'_>) -> Option<f64> {
        let corners = &self.corners[cell];
        let count = corners.len();
        let next = |i: usize| (i + 1) % count;
        let before = |i: usize| (i + count - 1) % count;
        // Positions relative to the first corner, so that no digit is lost far from the origin.
        let (mut reference, mut positions) = ([[0.0; 2]; 4], [[0.0; 2]; 4]);
        for (i, axis) in (0..count).flat_map(|i| [(i, 0), (i, 1)]) {
            reference[i][axis] = corners[i][axis] - corners[0][axis];
            positions[i][axis] = reference[i][axis] + u[2 * i + axis] - u[axis];
        }
        let current = polygon_area(&positions[..count]);
        if current.is_nan() || current <= 0.0 {
            return None;
        }
        if self.area_stiffness == 0.0 {
            return Some(0.0);
        }
        let rest = polygon_area(&reference[..count]);
        let change = current / rest - 1.0;
        let slope: Vec<f64> = (0..count)
            .flat_map(|i| {
                let (from, to) = (positions[before(i)], positions[next(i)]);
                [0.5 * (to[1] - from[1]), 0.5 * (from[0] - to[0])]
            })
            .collect();
        for (r, slope) in local.residual.iter_mut().zip(&slope) {
            *r += self.area_stiffness * change * slope;
        }
        if let Some(stiffness) = local.stiffness {
            let size = 2 * count;
            for (i, k) in (0..size * size).map(|n| (n / size, n % size)) {
                stiffness[i * size + k] += self.area_stiffness / rest * slope[i] * slope[k];
            }
            for i in 0..count {
                for (other, sign) in [(next(i), 0.5), (before(i), -0.5)] {
                    let value = sign * self.area_stiffness * change;
                    let (x, y) = (2 * i, 2 * other + 1);
                    stiffness[x * size + y] += value;
                    stiffness[y * size + x] += value;
                }
            }
        }
        Some(0.5 * self.area_stiffness * rest * change * change)
    }
}

impl Potential for Lattice {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        self.evaluate_after(element, u, local, &[])
    }

    /// Describes a spring whose force falls while it lengthens.
    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        let direction = *self.directions.get(element)?;
        let strain = strain(direction, [u[2] - u[0], u[3] - u[1]]);
        let falls = self.tension(element, strain).slope < 0.0;
        falls.then(|| format!("stretch {:.2}", 1.0 + strain))
    }
}

impl Remembering for Lattice {
    fn evaluate_after(
        &self,
        element: usize,
        u: &[f64],
        local: Local<'_>,
        history: &[f64],
    ) -> Evaluated {
        let energy = match element.checked_sub(self.springs.len()) {
            None => Some(self.evaluate_spring(element, u, local, history)),
            Some(cell) => self.evaluate_cell(cell, u, local),
        };
        energy
            .filter(|energy| energy.is_finite())
            .ok_or(Inadmissible { element })
    }

    /// The largest energy of each spring; areas do not soften.
    fn remember(&self, history: &mut Vec<f64>, u: &[f64]) {
        if self.laws.iter().all(|law| law.softening().is_none()) {
            return;
        }
        history.resize(self.springs.len(), 0.0);
        for (index, most) in history.iter_mut().enumerate() {
            let displacements = self.connectivity.values(index, u);
            *most = most.max(self.pose(index, &displacements).response.energy);
        }
    }

    fn dissipated(&self, history: &[f64]) -> f64 {
        let springs = self.springs.iter().zip(history).enumerate();
        let parts = springs.filter_map(|(index, (spring, most))| {
            let softening = self.law(index).softening()?;
            Some(spring.area * spring.rest_length * softening.dissipated(*most))
        });
        parts.sum()
    }
}
