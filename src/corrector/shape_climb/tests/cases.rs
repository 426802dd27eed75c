//! Shapes, supports and loads of all kinds, with a law of all in turn.

use std::sync::Arc;

use crate::material::{HyperelasticLaw, samples};
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::{BoundaryProblem, Drive, Load, Model, Support};
use crate::solve::{NewtonSettings, State};
use crate::units::Linear;

pub const EXACT: NewtonSettings = NewtonSettings {
    tolerance: 1e-11,
    max_iterations: 60,
};

/// A problem with its meshes.
pub struct Case {
    pub name: String,
    pub problem: BoundaryProblem,
    pub meshes: Vec<Mesh>,
    /// Whether the tangent is symmetric, so that multigrid serves.
    pub is_symmetric: bool,
}

const HOLE: Shape = Shape::StripWithHole {
    size: [40.0, 20.0],
    radius: 4.0,
};
const NOTCHED: Shape = Shape::NotchedStrip {
    size: [40.0, 20.0],
    depth: 4.0,
    half_length: 5.0,
};
const RING: Shape = Shape::RingSector {
    radii: [10.0, 20.0],
    angle: std::f64::consts::FRAC_PI_2,
};
const CLAMP: Support = Support::Displacement([Some(0.0), Some(0.0)]);

type Setting = (
    &'static str,
    Shape,
    Vec<(&'static str, Support)>,
    Vec<(&'static str, Load)>,
);

/// Supports and loads of every kind for a law of a shear modulus, in MPa.
fn settings(mu: f64) -> Vec<Setting> {
    let by = |x: f64, y: f64| Support::Displacement([Some(x), Some(y)]);
    let linear = |at_origin, slope| Some(Linear { at_origin, slope });
    let spread = [linear(8.0, [0.0, 0.05]), linear(1.0, [0.0, -0.1])];
    let pulled = Support::Grip([Drive::Force(16.0 * mu), Drive::Displacement(0.5)]);
    let along = Support::Displacement([Some(8.0), None]);
    let turned = Support::Rotation {
        centre: [0.0; 2],
        angle: 0.3,
    };
    let widened = Support::Radial {
        centre: [0.0; 2],
        displacement: 2.0,
    };
    let rollers = vec![("start", Support::Roller), ("end", Support::Roller)];
    let [left, outside] = ["left", "outside"].map(|name| (name, CLAMP));
    let symmetric = vec![
        ("left", Support::Roller),
        ("bottom", Support::Roller),
        ("right", along),
    ];
    let traction = Load::Traction([0.2 * mu, 0.02 * mu]);
    vec![
        ("clamps", HOLE, vec![left, ("right", by(8.0, 2.0))], vec![]),
        (
            "grip with a force",
            HOLE,
            vec![left, ("right", pulled)],
            vec![],
        ),
        ("symmetry", HOLE, symmetric, vec![]),
        ("traction", NOTCHED, vec![left], vec![("right", traction)]),
        (
            "pressure",
            RING,
            rollers,
            vec![("inside", Load::Pressure(0.15 * mu))],
        ),
        ("turn", RING, vec![outside, ("inside", turned)], vec![]),
        ("bore", RING, vec![outside, ("inside", widened)], vec![]),
        (
            "spread",
            NOTCHED,
            vec![left, ("right", Support::LinearDisplacement(spread))],
            vec![],
        ),
        (
            "pressure to a free end",
            NOTCHED,
            vec![left],
            vec![("top", Load::Pressure(0.01 * mu))],
        ),
    ]
}

/// All settings with all elements.
pub fn all() -> Vec<Case> {
    let mut laws = samples::all();
    laws.extend(
        samples::changing_volume()
            .into_iter()
            .map(|card| ("", card.law)),
    );
    let mut laws = laws.into_iter().cycle();
    let mut cases = Vec::new();
    for (element, kind) in CellShape::NAMES {
        for place in 0..settings(1.0).len() {
            let (law_name, law) = laws.next().expect("a law");
            cases.push(case(place, &law, kind, &format!("{element}, {law_name}")));
        }
    }
    cases
}

/// The setting of a number with a law and an element.
pub fn case(place: usize, law: &Arc<dyn HyperelasticLaw>, kind: CellShape, told: &str) -> Case {
    let (name, shape, supports, loads) = settings(law.shear_modulus()).swap_remove(place);
    let across = 2;
    Case {
        name: format!("{name}, {told}"),
        problem: BoundaryProblem {
            thickness: 2.0,
            law: Arc::clone(law),
            supports: supports
                .into_iter()
                .map(|(name, own)| (name.to_owned(), own))
                .collect(),
            loads: loads
                .into_iter()
                .map(|(name, own)| (name.to_owned(), own))
                .collect(),
        },
        meshes: (0..3)
            .map(|level| shape.mesh(across << level, kind))
            .collect(),
        is_symmetric: name != "pressure to a free end",
    }
}

impl Case {
    /// On the finest mesh.
    pub fn with_model<T>(&self, ask: impl FnOnce(&Model) -> T) -> T {
        let mesh = &self.meshes[self.meshes.len() - 1];
        let energy = self.problem.finite_elements(mesh);
        ask(&self.problem.on(mesh, &energy).unwrap())
    }

    /// The direct path.
    pub fn direct(&self, factors: &[f64]) -> Vec<State> {
        let states = self.with_model(|model| model.solve(factors, EXACT, &|_| ()));
        states.unwrap_or_else(|end| panic!("{}: {end}", self.name))
    }
}

/// Root mean square over the nodes in mm.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    (squares.sum::<f64>() / (0.5 * a.len() as f64)).sqrt()
}
