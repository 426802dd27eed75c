//! A clamped plate whose field is known, and markers on it.

use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::estimation::{EdgeCondition, Knowledge, Specimen};
use crate::markers::Marker;
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::{CellShape, Mesh};
use crate::problem::{BoundaryProblem, Support};
use crate::solve::NewtonSettings;

pub(in super::super) const SIZE: [f64; 2] = [60.0, 30.0];
pub(super) const THICKNESS: f64 = 2.0;
pub(super) const C10: f64 = 0.05;
pub(in super::super) const STRETCH: f64 = 0.3;

pub(in super::super) fn law() -> Arc<dyn HyperelasticLaw> {
    Arc::new(NeoHooke { c10: C10 })
}

/// A clamped plate pulled by 30 %, on a mesh that no estimate uses: the field, and the force in N.
pub(in super::super) struct Truth {
    pub(in super::super) mesh: Mesh,
    displacement: Vec<f64>,
    pub(in super::super) force: f64,
}

/// The sheet held at its left edge, a group moved as a whole: the field in mm, and the force on the group in N.
pub(in super::super) fn solved(
    mesh: &Mesh,
    group: &str,
    motion: [f64; 2],
    factors: &[f64],
) -> (Vec<f64>, [f64; 2]) {
    let problem = BoundaryProblem {
        thickness: THICKNESS,
        law: law(),
        regions: Vec::new(),
        supports: vec![
            ("left".into(), Support::Displacement([Some(0.0); 2])),
            (group.into(), Support::Displacement(motion.map(Some))),
        ],
        loads: Vec::new(),
    };
    let energy = problem.finite_elements(mesh);
    let newton = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 30,
    };
    let discretised = problem.on(mesh, &energy).unwrap();
    let states = discretised.solve(factors, newton, &|_| ()).unwrap();
    let last = states.last().unwrap();
    let force = discretised.reaction(last, group);
    (last.displacement.clone(), [force[0], force[1]])
}

impl Truth {
    pub(in super::super) fn new() -> Self {
        Self::on(Mesh::plate(SIZE, [26, 14], CellShape::Quad9))
    }

    /// The same on any mesh.
    pub(in super::super) fn on(mesh: Mesh) -> Self {
        let motion = [STRETCH * SIZE[0], 0.0];
        let (displacement, [force, _]) = solved(&mesh, "right", motion, &[1.0]);
        Self {
            mesh,
            displacement,
            force,
        }
    }

    /// ux, uy of node after node in mm.
    pub(in super::super) fn field(&self) -> &[f64] {
        &self.displacement
    }

    pub(in super::super) fn at(&self, position: [f64; 2]) -> [f64; 2] {
        self.mesh.displacement_at(&self.displacement, position)
    }

    /// 21 × 11 markers with normal noise.
    pub(in super::super) fn markers(&self, noise: f64, seed: u64) -> Vec<Marker> {
        let grid =
            (0..21).flat_map(|i| (0..11).map(move |j| [3.0 * f64::from(i), 3.0 * f64::from(j)]));
        noisy(
            &grid.collect::<Vec<_>>(),
            &|position| self.at(position),
            noise,
            seed,
        )
    }

    pub(super) fn error(&self, mesh: &Mesh, field: &[f64]) -> f64 {
        let exact = self.mesh.displacement_on(&self.displacement, mesh);
        let sum: f64 = exact.iter().zip(field).map(|(a, b)| (a - b).powi(2)).sum();
        (sum / field.len() as f64).sqrt()
    }
}

/// Markers of a field with normal noise.
pub(super) fn noisy(
    positions: &[[f64; 2]],
    field: &dyn Fn([f64; 2]) -> [f64; 2],
    noise: f64,
    seed: u64,
) -> Vec<Marker> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let marker = |(number, position): (usize, &[f64; 2])| Marker {
        number,
        position: *position,
        displacement: field(*position).map(|u| u + noise * draw()),
        standard_deviation: None,
    };
    positions.iter().enumerate().map(marker).collect()
}

pub(super) fn estimate_mesh() -> Mesh {
    Mesh::plate(SIZE, [20, 10], CellShape::Quad9)
}

pub(in super::super) fn specimen(mesh: &Mesh) -> Specimen<'_> {
    Specimen {
        mesh,
        laws: law().into(),
        thickness: THICKNESS,
    }
}

pub(in super::super) fn with_grips(condition: EdgeCondition) -> Knowledge {
    let edge = |(name, condition): (&str, EdgeCondition)| (name.to_owned(), condition);
    let edges = [
        ("left", condition),
        ("right", condition),
        ("bottom", EdgeCondition::Free),
        ("top", EdgeCondition::Free),
    ];
    Knowledge {
        edges: edges.map(edge).to_vec(),
        ..Knowledge::default()
    }
}
