//! The scene is read back, and the forces of its springs are computed by independent formulas.

use std::sync::Arc;

use super::*;
use crate::mass_spring::LatticeSettings;
use crate::mesh::{CellShape, Mesh, Shape};
use crate::problem::{ClampedPlate, Support};
use gelbench_mechanics::solve::Assembly;

/// The numbers of an attribute of a component.
fn attribute(scene: &str, component: &str, name: &str) -> Vec<f64> {
    let start = scene
        .find(&format!("<{component} "))
        .unwrap_or_else(|| panic!("{component}"));
    let tag = &scene[start..start + scene[start..].find('>').unwrap()];
    let value = tag.split(&format!(" {name}=\"")).nth(1).unwrap();
    let value = value.split('"').next().unwrap();
    value
        .split_whitespace()
        .map(|word| word.parse().unwrap())
        .collect()
}

/// The forces in N of a scene's springs on its nodes, displaced by `u`, and those to first order in `u`.
fn spring_forces(scene: &str, u: &[f64]) -> [Vec<f64>; 2] {
    let positions = attribute(scene, "MechanicalObject", "position");
    let mut forces = [vec![0.0; u.len()], vec![0.0; u.len()]];
    for spring in attribute(scene, "SpringForceField", "spring").chunks_exact(5) {
        let ends = [spring[0] as usize, spring[1] as usize];
        let (stiffness, rest) = (spring[2], spring[4]);
        let difference =
            |of: &[f64]| [0, 1].map(|axis| of[2 * ends[1] + axis] - of[2 * ends[0] + axis]);
        let (at_rest, moved) = (difference(&positions), difference(u));
        assert!((at_rest[0].hypot(at_rest[1]) - rest).abs() < 1e-12);
        let now = [at_rest[0] + moved[0], at_rest[1] + moved[1]];
        let length = now[0].hypot(now[1]);
        let full = stiffness * (length - rest) / length;
        let along = (at_rest[0] * moved[0] + at_rest[1] * moved[1]) / (rest * rest);
        for axis in [0, 1] {
            let parts = [full * now[axis], stiffness * along * at_rest[axis]];
            for (forces, part) in forces.iter_mut().zip(parts) {
                forces[2 * ends[0] + axis] += part;
                forces[2 * ends[1] + axis] -= part;
            }
        }
    }
    forces
}

fn card(text: &str) -> Card {
    let text = format!("law = \"neo-hooke\"\n{text}[parameters]\nc10 = \"50 kPa\"\n");
    Card::parse("gel", "gel", &text).unwrap()
}

fn pulled(card: &Card, supports: Vec<(String, Support)>) -> BoundaryProblem {
    BoundaryProblem {
        thickness: 2.0,
        law: Arc::clone(&card.law),
        regions: Vec::new(),
        supports,
        loads: Vec::new(),
    }
}

fn clamp(group: &str, x: f64) -> (String, Support) {
    (
        group.to_owned(),
        Support::Displacement([Some(x), Some(0.0)]),
    )
}

fn scene(card: &Card, problem: &BoundaryProblem, springs: &MassSpring) -> Result<InputFile, Error> {
    let scene = Scene {
        title: "gel",
        problem,
        card,
        regions: &[],
        springs,
        factors: &[0.5, 1.0],
    };
    scene.input_file()
}

/// Lattices of equal cells, and of cells of any shape.
fn lattices(card: &Card) -> [MassSpring; 2] {
    let plate = ClampedPlate {
        size: [30.0, 20.0],
        thickness: 2.0,
        law: Arc::clone(&card.law),
        stretches: vec![0.5],
    };
    let holed = Shape::StripWithHole {
        size: [30.0, 20.0],
        radius: 4.0,
    };
    let mesh: Mesh = holed.mesh(8, CellShape::Quad4);
    [
        MassSpring::new(&plate, [6, 5], LatticeSettings::default()),
        MassSpring::on_mesh(&card.law, 2.0, mesh),
    ]
}

#[test]
fn springs_of_the_scene_have_the_linearised_forces_of_the_lattice() {
    let card = card("");
    for springs in lattices(&card) {
        let problem = pulled(&card, vec![clamp("left", 0.0), clamp("right", 5.0)]);
        let text = scene(&card, &problem, &springs).unwrap().text;
        let count = 2 * springs.mesh.nodes.len();
        let u: Vec<f64> = (0..count).map(|i| 1e-5 * (i as f64 * 1.7).sin()).collect();
        let mut linear = vec![0.0; count];
        let rest = vec![0.0; count];
        Assembly::add_product(springs.potential(), &rest, &u, &mut linear).unwrap();
        let largest = linear
            .iter()
            .fold(0.0, |most: f64, force| most.max(force.abs()));
        let [full, first_order] = spring_forces(&text, &u);
        for ((linear, full), first) in linear.iter().zip(full).zip(first_order) {
            // Residuals are forces on the springs.
            assert!((linear + first).abs() < 1e-12 * largest, "{linear} {first}");
            assert!((linear + full).abs() < 1e-5 * largest, "{linear} {full}");
        }
    }
}

/// A strain along x of a sheet of E with ν = ⅓: F = 9/8 E t W ε at each end.
#[test]
fn a_stretched_scene_has_the_force_of_its_youngs_modulus() {
    let card = card("");
    let springs = &lattices(&card)[0];
    let problem = pulled(&card, vec![clamp("left", 0.0), clamp("right", 5.0)]);
    let text = scene(&card, &problem, springs).unwrap().text;
    let strain = 1e-4;
    let nodes = &springs.mesh.nodes;
    let u: Vec<f64> = nodes.iter().flat_map(|[x, _]| [strain * x, 0.0]).collect();
    let [_, forces] = spring_forces(&text, &u);
    let of_end = |end: f64| -> f64 {
        let at_end = nodes.iter().zip(forces.chunks_exact(2));
        at_end
            .filter(|(node, _)| node[0] == end)
            .map(|(_, force)| force[0])
            .sum()
    };
    let expected = 9.0 / 8.0 * 0.3 * 2.0 * 20.0 * strain;
    assert!((of_end(0.0) - expected).abs() < 1e-12 && (of_end(30.0) + expected).abs() < 1e-12);
}

#[test]
fn held_and_moved_nodes_masses_and_dampings_are_written() {
    let stated = "density = \"1000 kg/m^3\"\nviscosity = { shear = \"5 Pa·s\" }\n";
    let card = card(stated);
    let springs = &lattices(&card)[0];
    let roller = (
        "bottom".to_owned(),
        Support::Displacement([None, Some(0.0)]),
    );
    let problem = pulled(&card, vec![clamp("left", 0.0), clamp("right", 5.0), roller]);
    let written = scene(&card, &problem, springs).unwrap();
    let text = written.text;
    let nodes = &springs.mesh.nodes;
    let at = |component: &str, is_there: &dyn Fn(&[f64; 2]) -> bool| {
        let indices = attribute(&text, component, "indices");
        let expected = (0..nodes.len()).filter(|node| is_there(&nodes[*node]));
        let expected: Vec<f64> = expected.map(|node| node as f64).collect();
        assert_eq!(indices, expected, "{component}");
    };
    at("FixedProjectiveConstraint", &|[x, _]| *x == 0.0);
    let inside = |x: f64| x != 0.0 && x != 30.0;
    at("PartialFixedProjectiveConstraint", &|[x, y]| {
        *y == 0.0 && inside(*x)
    });
    assert_eq!(
        attribute(&text, "PartialFixedProjectiveConstraint", "fixedDirections"),
        [0.0, 1.0]
    );
    let moved = "LinearMovementProjectiveConstraint";
    at(moved, &|[x, _]| *x == 30.0);
    assert_eq!(attribute(&text, moved, "keyTimes"), [0.0, 0.5, 1.0]);
    assert_eq!(
        attribute(&text, moved, "movements"),
        [0.0, 0.0, 2.5, 0.0, 5.0, 0.0]
    );
    let mass: f64 = attribute(&text, "DiagonalMass", "vertexMass").iter().sum();
    assert!((mass - 1e-9 * 30.0 * 20.0 * 2.0).abs() < 1e-18, "{mass}");
    let first = &attribute(&text, "SpringForceField", "spring")[..5];
    // d = 3 η a/x₀ and k = a E/x₀ with E = 0.3 MPa and 3 η = 15e-6 MPa s.
    assert!((first[3] / first[2] - 15e-6 / 0.3).abs() < 1e-16);
    assert_eq!(written.remarks.len(), 1, "{:?}", written.remarks);
}

/// A turn goes along chords of 5°.
#[test]
fn turned_nodes_move_along_short_chords() {
    let card = card("");
    let springs = &lattices(&card)[0];
    let turn = Support::Rotation {
        centre: [30.0, 10.0],
        angle: 0.5,
    };
    let problem = pulled(&card, vec![clamp("left", 0.0), ("right".to_owned(), turn)]);
    let text = scene(&card, &problem, springs).unwrap().text;
    let times = attribute(&text, "LinearMovementProjectiveConstraint", "keyTimes");
    assert_eq!(times.len(), 7);
    let path = attribute(&text, "LinearMovementProjectiveConstraint", "movements");
    let node = attribute(&text, "LinearMovementProjectiveConstraint", "indices")[0] as usize;
    let arm = springs.mesh.nodes[node][1] - 10.0;
    for (time, moved) in times.iter().zip(path.chunks_exact(2)) {
        let (sine, cosine) = (0.5 * time).sin_cos();
        assert!((moved[0] + sine * arm).abs() < 1e-12);
        assert!((moved[1] - (cosine - 1.0) * arm).abs() < 1e-12);
    }
}

#[test]
fn dead_forces_grow_with_the_load_factor() {
    let card = card("");
    let springs = &lattices(&card)[0];
    let mut problem = pulled(&card, vec![clamp("left", 0.0)]);
    problem.loads = vec![("right".to_owned(), Load::Traction([0.01, 0.0]))];
    let text = scene(&card, &problem, springs).unwrap().text;
    assert_eq!(
        attribute(&text, "LinearForceField", "times"),
        [0.0, 0.5, 1.0]
    );
    let mut total = 0.0;
    for part in text.split("<LinearForceField ").skip(1) {
        let part = format!("<LinearForceField {part}");
        let points = attribute(&part, "LinearForceField", "points").len();
        let forces = attribute(&part, "LinearForceField", "forces");
        assert_eq!(forces[2], 0.5 * forces[4]);
        total += points as f64 * forces[4];
    }
    assert!((total - 0.01 * 2.0 * 20.0).abs() < 1e-14, "{total}");
}

#[test]
fn what_a_scene_of_springs_cannot_say_is_refused() {
    let card = card("");
    let plain = &lattices(&card)[0];
    let mut problem = pulled(&card, vec![clamp("left", 0.0)]);
    problem.loads = vec![("right".to_owned(), Load::Pressure(0.01))];
    let fault = scene(&card, &problem, plain).unwrap_err().to_string();
    assert!(fault.contains("a pressure follows the edge"), "{fault}");
    let grip = Support::Grip([
        crate::problem::Drive::Force(1.0),
        crate::problem::Drive::Displacement(0.0),
    ]);
    let problem = pulled(&card, vec![clamp("left", 0.0), ("right".to_owned(), grip)]);
    let fault = scene(&card, &problem, plain).unwrap_err().to_string();
    assert!(fault.contains("grip with a given force"), "{fault}");
    let plate = ClampedPlate {
        size: [30.0, 20.0],
        thickness: 2.0,
        law: Arc::clone(&card.law),
        stretches: vec![0.5],
    };
    let with_areas = MassSpring::new(&plate, [6, 5], LatticeSettings { area_term: true });
    let problem = pulled(&card, vec![clamp("left", 0.0)]);
    let fault = scene(&card, &problem, &with_areas).unwrap_err().to_string();
    assert!(fault.contains("area terms"), "{fault}");
}
