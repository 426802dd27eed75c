//! The finite elements compared with mathematics: what all of these cases need.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::error::Error;
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::problem::{BoundaryProblem, Model, Support};
use crate::solve::{NewtonSettings, State};
use crate::statistics::larger;

pub mod cantilever;
pub mod cook;
pub mod curved_meshes;
pub mod hole;
pub mod manufactured;
pub mod own_error;
pub mod patch;
pub mod ring;

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-13,
    max_iterations: 40,
};

/// A neo-Hookean sheet with μ = 0.1 MPa, E = 0.3 MPa, 2 mm thick, without supports and loads.
fn sheet() -> BoundaryProblem {
    BoundaryProblem::supported(2.0, Arc::new(NeoHooke { c10: 0.05 }), Vec::new())
}

/// The sheet with some groups at given displacements in mm.
fn held(supports: &[(&str, [Option<f64>; 2])]) -> BoundaryProblem {
    let support = |(group, displacement): &(&str, [Option<f64>; 2])| {
        ((*group).to_owned(), Support::Displacement(*displacement))
    };
    BoundaryProblem {
        supports: supports.iter().map(support).collect(),
        ..sheet()
    }
}

/// A rectangle of `size` mm whose inner lines are bent: no cell is a parallelogram.
fn distorted(size: [f64; 2], cells: [usize; 2], shape: CellShape) -> Mesh {
    let map = move |[s, t]: [f64; 2]| {
        let bulge = (PI * s).sin() * (PI * t).sin();
        [size[0] * (s + 0.08 * bulge), size[1] * (t - 0.1 * bulge)]
    };
    let block = Block {
        map: Box::new(map),
        cells,
        sides: ["bottom", "right", "top", "left"],
    };
    let mut mesh = mesh_of_blocks(&[block], shape);
    mesh.name_boundary("boundary", |_| true);
    mesh
}

/// Solves to load factor 1 in some steps; the last state.
fn solve(model: &Model, steps: usize) -> Result<State, Error> {
    let factors: Vec<f64> = (1..=steps).map(|i| i as f64 / steps as f64).collect();
    model.reach(&factors, NEWTON)
}

/// Largest distance of a field from another one at the nodes of a mesh, over the largest size of the other.
fn largest_error(mesh: &Mesh, actual: &[f64], exact: impl Fn([f64; 2]) -> [f64; 2]) -> f64 {
    let (mut worst, mut largest) = (0.0, 0.0);
    for (position, u) in mesh.nodes.iter().zip(actual.chunks_exact(2)) {
        let exact = exact(*position);
        worst = larger(worst, (u[0] - exact[0]).hypot(u[1] - exact[1]));
        largest = larger(largest, exact[0].hypot(exact[1]));
    }
    worst / largest
}

/// First Piola–Kirchhoff stress of a law at a displacement gradient, components 11, 12, 21, 22, in MPa.
fn stress(law: &dyn HyperelasticLaw, gradient: [f64; 4]) -> [f64; 4] {
    use crate::material::sheet::Kinematics;
    let kinematics = Kinematics::new(&nalgebra::Vector4::from(gradient));
    kinematics.map_or([f64::NAN; 4], |kinematics| law.stress(&kinematics).1.into())
}
