//! What the tests of this room share: a strip, problems on it, and their solutions.

use std::sync::Arc;

use super::super::balance::Balance;
use super::super::boundary::BoundaryProblem;
use super::super::boundary_conditions::{Load, Support};
use crate::material::NeoHooke;
use crate::mesh::{CellShape, Mesh, Shape};
use crate::solve::{NewtonSettings, State};

/// Tight.
pub const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-13,
    max_iterations: 40,
};

/// Holds both displacements.
pub const CLAMP: Support = Support::Displacement([Some(0.0); 2]);

/// A strip of 30 × 10 mm, 4 cells across.
pub fn strip(shape: CellShape) -> Mesh {
    Shape::Strip { size: [30.0, 10.0] }.mesh(4, shape)
}

/// A sheet of 2 mm between supports, under loads, by group.
pub fn problem(supports: &[(&str, Support)], loads: &[(&str, Load)]) -> BoundaryProblem {
    let owned = |group: &str| group.to_owned();
    BoundaryProblem {
        thickness: 2.0,
        law: Arc::new(NeoHooke { c10: 0.05 }),
        regions: Vec::new(),
        supports: supports
            .iter()
            .map(|(group, support)| (owned(group), *support))
            .collect(),
        loads: loads
            .iter()
            .map(|(group, load)| (owned(group), *load))
            .collect(),
    }
}

/// A state at load factor 1 with what follows from it.
pub struct Solution {
    pub state: State,
    pub balance: Balance,
    pub reactions: Vec<[f64; 2]>,
}

/// The state at load factor 1 with the reactions of some groups.
pub fn solved(problem: &BoundaryProblem, mesh: &Mesh, groups: &[&str]) -> Solution {
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).unwrap();
    let state = model.solve(&[0.5, 1.0], NEWTON, &|_| ()).unwrap().remove(1);
    let reactions = model.reactions(&state);
    Solution {
        balance: reactions.balance(),
        reactions: groups
            .iter()
            .map(|group| reactions.at_group(group).force)
            .collect(),
        state,
    }
}

/// The mesh turned by an angle in rad about the origin and then moved.
pub fn moved(mut mesh: Mesh, angle: f64, by: [f64; 2]) -> Mesh {
    for node in &mut mesh.nodes {
        let [x, y] = turned(*node, angle);
        *node = [x + by[0], y + by[1]];
    }
    mesh
}

/// A vector turned by an angle in rad.
pub fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}
