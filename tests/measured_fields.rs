//! Measured displacements made to satisfy the physics, as a user meets it.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use gelbench::boundary::{BoundaryProblem, Support};
use gelbench::material::Card;
use gelbench::mesh::{CellShape, Mesh};
use gelbench::solve::NewtonSettings;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::Value;
use tempfile::TempDir;

mod common;

use common::{gelbench, number, root, words};

/// Standard deviation of the example's noise in mm.
const NOISE: f64 = 0.25;

/// The plate 150 × 50 × 2 mm of 10 % PVA, clamped at its short sides and pulled by 25 and 50 %, by finite elements of
/// nine nodes: the mesh and both fields.
fn plate() -> (Mesh, Vec<Vec<f64>>) {
    let mesh = Mesh::plate([150.0, 50.0], [48, 16], CellShape::Quad9);
    let problem = BoundaryProblem {
        thickness: 2.0,
        law: Card::load("pva-10", root()).unwrap().law,
        supports: vec![
            ("left".into(), Support::Displacement([Some(0.0); 2])),
            (
                "right".into(),
                Support::Displacement([Some(75.0), Some(0.0)]),
            ),
        ],
        loads: Vec::new(),
    };
    let energy = problem.finite_elements(&mesh);
    let settings = NewtonSettings {
        tolerance: 1e-9,
        max_iterations: 50,
    };
    let discretised = problem.on(&mesh, &energy).unwrap();
    let solved = discretised.solve(&[0.25, 0.5, 0.75, 1.0], settings, &|_| {});
    let states = solved.unwrap();
    let fields = [1, 3].map(|step: usize| states[step].displacement.clone());
    drop(discretised);
    (mesh, fields.into())
}

/// The example's markers: 31 × 11 points, normal noise of a seed, one in fifty far off and one in fifty lost.
fn markers() -> String {
    let (mesh, fields) = plate();
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut text = String::from(
        "# Markers on a plate of PVA hydrogel, made by finite elements of nine nodes (48 x 16), seed 8 of ChaCha8:\n\
         # noise of 0.25 mm, one marker in fifty off by 3 to 8 mm, one in fifty lost.\n\
         frame,x [mm],y [mm],ux [mm],uy [mm]\n",
    );
    for (field, frame) in fields.iter().zip(1..) {
        for (i, j) in (0..31).flat_map(|i| (0..11).map(move |j| (i, j))) {
            let [x, y] = [5.0 * f64::from(i), 5.0 * f64::from(j)];
            let u = mesh.displacement_at(field, [x, y]);
            let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
            let noise = [NOISE * normal(), NOISE * normal()];
            let fate: f64 = random.random();
            let far = 3.0 + 5.0 * random.random::<f64>();
            let angle = std::f64::consts::TAU * random.random::<f64>();
            let off = if fate < 0.02 { far } else { 0.0 };
            let [ux, uy] = [
                u[0] + noise[0] + off * angle.cos(),
                u[1] + noise[1] + off * angle.sin(),
            ];
            let _ = match fate > 0.98 {
                true => writeln!(text, "{frame},{x},{y},,"),
                false => writeln!(text, "{frame},{x},{y},{ux:.4},{uy:.4}"),
            };
        }
    }
    text
}

#[test]
fn the_example_is_what_the_program_makes_of_its_seed() {
    let made = markers();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("measured_plate.csv");
    fs::write(path, &made).unwrap();
    let kept = fs::read_to_string(root().join("examples/measured_plate.csv")).unwrap();
    for (made, kept) in made.lines().zip(kept.lines()) {
        let numbers = |line: &str| -> Option<Vec<f64>> {
            line.split(',').map(|field| field.parse().ok()).collect()
        };
        match (numbers(made), numbers(kept)) {
            (Some(made), Some(kept)) => {
                assert!(
                    made.iter().zip(&kept).all(|(a, b)| (a - b).abs() < 2e-4),
                    "{kept:?}"
                );
            }
            _ => assert_eq!(made, kept),
        }
    }
    assert_eq!(made.lines().count(), kept.lines().count());
}
