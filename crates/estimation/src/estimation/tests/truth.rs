//! A clamped plate whose field is known, and markers on it.

use std::sync::Arc;

use crate::estimation::{
    EdgeCondition, FieldEstimate, Knowledge, MeasuredForce, Specimen, estimate,
};
use crate::markers::Marker;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::{CellShape, Mesh, Outline};
use crate::problem::{BoundaryProblem, Support};
use crate::solve::{NewtonSettings, State};
use crate::statistics::normal_numbers;

pub(in super::super) const SIZE: [f64; 2] = [60.0, 30.0];
pub(super) const THICKNESS: f64 = 2.0;
pub(super) const C10: f64 = 0.05;
pub(in super::super) const STRETCH: f64 = 0.3;

pub(in super::super) fn law() -> Arc<dyn HyperelasticLaw> {
    Arc::new(NeoHooke { c10: C10 })
}

/// A clamped plate pulled by 30 %, on a mesh that no estimate uses: the field, and the force in N.
pub(in super::super) struct Truth {
    mesh: Mesh,
    displacement: Vec<f64>,
    pub(in super::super) force: f64,
}

/// The sheet with supports and without loads.
pub(super) fn sheet(supports: Vec<(String, Support)>) -> BoundaryProblem {
    BoundaryProblem {
        thickness: THICKNESS,
        law: law(),
        regions: Vec::new(),
        supports,
        loads: Vec::new(),
    }
}

/// A sheet held at its left edge, a group moved by shares of a translation: for each share the field in mm, and the force on the group in N.
pub(in super::super) fn solved(
    mesh: &Mesh,
    law: Arc<dyn HyperelasticLaw>,
    group: &str,
    motion: [f64; 2],
    factors: &[f64],
) -> Vec<(Vec<f64>, [f64; 2])> {
    let supports = vec![
        ("left".into(), Support::Displacement([Some(0.0); 2])),
        (group.into(), Support::Displacement(motion.map(Some))),
    ];
    let problem = BoundaryProblem {
        law,
        ..sheet(supports)
    };
    let energy = problem.finite_elements(mesh);
    let newton = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 30,
    };
    let discretised = problem.on(mesh, &energy).unwrap();
    let states = discretised.solve(factors, newton, &|_| ()).unwrap();
    let solution = |state: &State| {
        let force = discretised.reaction(state, group);
        (state.displacement.clone(), force)
    };
    states.iter().map(solution).collect()
}

impl Truth {
    pub(in super::super) fn new() -> Self {
        Self::on(Mesh::plate(SIZE, [26, 14], CellShape::Quad9))
    }

    /// The same on any mesh.
    pub(in super::super) fn on(mesh: Mesh) -> Self {
        let motion = [STRETCH * SIZE[0], 0.0];
        let (displacement, [force, _]) = solved(&mesh, law(), "right", motion, &[1.0]).remove(0);
        Self {
            mesh,
            displacement,
            force,
        }
    }

    pub(in super::super) fn at(&self, position: [f64; 2]) -> [f64; 2] {
        self.mesh.displacement_at(&self.displacement, position)
    }

    /// P₁₁, P₁₂, P₂₁, P₂₂ in MPa.
    pub(in super::super) fn stress(&self, position: [f64; 2]) -> [f64; 4] {
        let (cell, local) = self.mesh.locate(position);
        let gradient = self.mesh.gradient_at(&self.displacement, cell, local);
        let kinematics = Kinematics::new(&PlaneTensor::from(gradient)).unwrap();
        law().stress(&kinematics).1.into()
    }

    /// 21 × 11 markers with normal noise.
    pub(in super::super) fn markers(&self, noise: f64, seed: u64) -> Vec<Marker> {
        noisy(&grid(), &|position| self.at(position), noise, seed)
    }

    pub(super) fn error(&self, mesh: &Mesh, field: &[f64]) -> f64 {
        let exact = self.mesh.displacement_on(&self.displacement, mesh);
        let sum: f64 = exact.iter().zip(field).map(|(a, b)| (a - b).powi(2)).sum();
        (sum / field.len() as f64).sqrt()
    }
}

/// 21 × 11 positions on the sheet, 3 mm apart.
pub(in super::super) fn grid() -> Vec<[f64; 2]> {
    let positions =
        (0..21).flat_map(|i| (0..11).map(move |j| [3.0 * f64::from(i), 3.0 * f64::from(j)]));
    positions.collect()
}

/// Markers of a field with normal noise.
pub(super) fn noisy(
    positions: &[[f64; 2]],
    field: &dyn Fn([f64; 2]) -> [f64; 2],
    noise: f64,
    seed: u64,
) -> Vec<Marker> {
    let mut draw = normal_numbers(seed);
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

/// A mesh of the rectangle between two corners.
pub(in super::super) fn rectangle(low: [f64; 2], high: [f64; 2]) -> Mesh {
    let line = vec![low, [high[0], low[1]], high, [low[0], high[1]]];
    let outline = Outline::of_lines(vec![line]).unwrap();
    outline.mesh(2.0, CellShape::Triangle6)
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

/// A force measured on the right grip along x, in N.
pub(in super::super) fn measured_force(force: f64, standard_deviation: f64) -> MeasuredForce {
    MeasuredForce {
        edge: "right".into(),
        axis: 0,
        force,
        standard_deviation,
        common_deviation: 0.0,
    }
}

/// The estimate on a mesh of the sheet with its own law.
pub(in super::super) fn estimate_on(
    mesh: &Mesh,
    markers: &[Marker],
    knowledge: &Knowledge,
) -> FieldEstimate {
    estimate(&specimen(mesh), markers, knowledge).unwrap()
}

/// The index of the force of the right grip.
pub(in super::super) fn right(result: &FieldEstimate) -> usize {
    let mut forces = result.forces.iter();
    forces.position(|force| force.edge == "right").unwrap()
}
