use std::sync::Arc;

use super::boundary_conditions::{Drive, Load, Support};
use crate::error::SolveFault;
use crate::material::{LinearElastic, PlaneState};
use crate::mesh::{CellShape, Shape};
use crate::solve::{Convergence, State};
use crate::units::parse_linear_length;
use samples::{CLAMP, NEWTON, moved, problem, solved, strip, turned};

mod branches;
mod corners;
mod parts_of_the_sheet;
mod regions;
pub mod samples;
mod softening;

/// Supports and loads by group.
type Conditions = (Vec<(&'static str, Support)>, Vec<(&'static str, Load)>);

fn kinds_of_problems() -> Vec<Conditions> {
    let right = |x, y| ("right", Support::Displacement([x, y]));
    let grip = |x, y| ("right", Support::Grip([x, y]));
    let pressure = ("top", Load::Pressure(0.01));
    let symmetric = [("left", Support::Roller), ("bottom", Support::Roller)];
    vec![
        (vec![("left", CLAMP), right(Some(6.0), Some(3.0))], vec![]),
        (
            vec![("left", CLAMP), right(Some(6.0), Some(0.0))],
            vec![pressure],
        ),
        (vec![("left", CLAMP)], vec![("top", Load::Pressure(0.0005))]),
        (
            symmetric.into(),
            vec![pressure, ("right", Load::Pressure(-0.02))],
        ),
        (
            symmetric.into(),
            vec![
                ("top", Load::Pressure(-0.02)),
                ("right", Load::Traction([0.03, 0.0])),
            ],
        ),
        (
            vec![("left", CLAMP)],
            vec![("right", Load::Traction([0.02, 0.001]))],
        ),
        (
            vec![("left", CLAMP), right(Some(3.0), None)],
            vec![("top", Load::Force([0.0, 0.05]))],
        ),
        (
            vec![("left", CLAMP), grip(Drive::Force(0.6), Drive::Force(0.01))],
            vec![pressure],
        ),
        (
            vec![
                ("left", CLAMP),
                grip(Drive::Force(0.6), Drive::Displacement(2.0)),
            ],
            vec![pressure],
        ),
        (
            vec![
                ("left", CLAMP),
                (
                    "right",
                    Support::Rotation {
                        centre: [15.0, 0.0],
                        angle: 0.4,
                    },
                ),
            ],
            vec![pressure],
        ),
    ]
}

#[test]
fn supports_and_loads_balance_in_every_kind_of_problem() {
    let cases = kinds_of_problems();
    for (number, (supports, loads)) in cases.iter().enumerate() {
        for (_, shape) in CellShape::NAMES {
            let by = [[0.0, 0.0], [700.0, -1000.0]][number % 2];
            let mut problem = problem(supports, loads);
            for (_, support) in &mut problem.supports {
                if let Support::Rotation { centre, .. } = support {
                    *centre = [centre[0] + by[0], centre[1] + by[1]];
                }
            }
            let solution = solved(&problem, &moved(strip(shape), 0.0, by), &["left", "right"]);
            let balance = solution.balance;
            assert!(balance.largest_force > 1e-3, "case {number}");
            assert!(
                balance.relative() < 1e-9,
                "case {number}, {shape:?}: {balance:?}"
            );
        }
    }
}

#[test]
fn the_force_beside_a_pressure_does_not_depend_on_the_place_of_the_specimen() {
    let (angle, pull) = (0.7, [6.0, 1.0]);
    let of = |angle: f64, by: [f64; 2], shape: CellShape| {
        let right = Support::Displacement(turned(pull, angle).map(Some));
        let problem = problem(
            &[("left", CLAMP), ("right", right)],
            &[("top", Load::Pressure(0.01))],
        );
        solved(
            &problem,
            &moved(strip(shape), angle, by),
            &["left", "right"],
        )
    };
    for (_, shape) in CellShape::NAMES {
        let here = of(0.0, [0.0; 2], shape);
        let size = here
            .reactions
            .iter()
            .flatten()
            .fold(0.0, |most: f64, force| most.max(force.abs()));
        for (angle, by) in [
            (0.0, [0.0, 1000.0]),
            (angle, [0.0; 2]),
            (-2.5, [-300.0, 5000.0]),
        ] {
            let there = of(angle, by, shape);
            for (here, there) in here.reactions.iter().zip(&there.reactions) {
                let expected = turned(*here, angle);
                let miss = (there[0] - expected[0]).hypot(there[1] - expected[1]);
                assert!(
                    miss < 1e-9 * size,
                    "{shape:?} {angle} {by:?}: {miss:.1e} N of {size}"
                );
            }
        }
    }
}

/// Rollers hold along axes only: the quarter ring is turned by right angles. Each of its symmetry lines carries half of
/// the pressure on the deformed bore.
#[test]
fn a_ring_s_supports_carry_the_pressure_on_its_bore() {
    let quarter = Shape::RingSector {
        radii: [10.0, 20.0],
        angle: std::f64::consts::FRAC_PI_2,
    };
    for shape in [CellShape::Quad4, CellShape::Triangle6, CellShape::Quad9] {
        let mesh = quarter.mesh(4, shape);
        for turns in 0..4 {
            let angle = f64::from(turns) * std::f64::consts::FRAC_PI_2;
            let mut mesh = moved(mesh.clone(), angle, [0.0; 2]);
            for node in &mut mesh.nodes {
                *node = node.map(|x| if x.abs() < 1e-12 { 0.0 } else { x } + 500.0);
            }
            let pressure = 0.03;
            let ends = [("start", Support::Roller), ("end", Support::Roller)];
            let problem = problem(&ends, &[("inside", Load::Pressure(pressure))]);
            let solution = solved(&problem, &mesh, &["start", "end"]);
            assert!(solution.balance.relative() < 1e-9, "{:?}", solution.balance);
            let at = |node: usize, axis: usize| {
                mesh.nodes[node][axis] + solution.state.displacement[2 * node + axis] - 500.0
            };
            let bore = mesh.groups()["inside"]
                .nodes
                .iter()
                .map(|node| at(*node, 0).hypot(at(*node, 1)));
            let corners = ["start", "end"].map(|group| {
                let nodes = mesh.groups()[group].nodes.iter();
                nodes
                    .map(|node| at(*node, 0).hypot(at(*node, 1)))
                    .fold(f64::INFINITY, f64::min)
            });
            let bore = bore.fold(0.0, f64::max);
            assert!(bore > 11.0, "{bore}");
            // Each line carries the pressure on the projection of the bore along it.
            let forces = solution
                .reactions
                .iter()
                .map(|force| force[0].hypot(force[1]));
            for (force, radius) in forces.zip(corners) {
                let exact = pressure * 2.0 * radius;
                assert!((force / exact - 1.0).abs() < 1e-10, "{force} {exact}");
            }
        }
    }
}

/// Suction on an end whose corners are free, where the tangent is not symmetric: p = 2 c₁₀ (λ − λ⁻²) √λ, in few iterations on any cells.
#[test]
fn suction_stretches_a_strip_as_far_as_it_must() {
    let stretch: f64 = 1.3;
    let pressure = 0.1 * (stretch - stretch.powi(-2)) * stretch.sqrt();
    let supports = [("left", Support::Roller), ("bottom", Support::Roller)];
    let problem = problem(&supports, &[("right", Load::Pressure(-pressure))]);
    for (_, shape) in CellShape::NAMES {
        let mesh = strip(shape);
        let energy = problem.finite_elements(&mesh);
        let model = problem.on(&mesh, &energy).unwrap();
        let states = model.solve(&[0.5, 1.0], NEWTON, &|_| ()).unwrap();
        for state in &states {
            let iterations = state.convergence.iterations();
            assert!(iterations <= 7, "{shape:?}: {iterations}");
        }
        for (position, u) in mesh.nodes.iter().zip(states[1].displacement.chunks(2)) {
            let exact = [
                (stretch - 1.0) * position[0],
                (stretch.powf(-0.5) - 1.0) * (position[1] + 5.0),
            ];
            let off = (u[0] - exact[0]).hypot(u[1] - exact[1]);
            assert!(off < 1e-8, "{shape:?} {position:?}: {off}");
        }
    }
}

/// A strip that is squeezed far beyond its buckling: what followed from a shifted tangent would be no sensitivity.
#[test]
fn an_influence_field_is_refused_where_the_tangent_is_not_positive_definite() {
    let mesh = Shape::Strip { size: [100.0, 5.0] }.mesh(2, CellShape::Quad4);
    let supports = [
        ("left", CLAMP),
        ("right", Support::Displacement([Some(-10.0), Some(0.0)])),
    ];
    let problem = problem(&supports, &[]);
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy).unwrap();
    let at = |factor: f64| State {
        factor,
        displacement: mesh
            .nodes
            .iter()
            .flat_map(|[x, _]| [-0.1 * factor * x, 0.0])
            .collect(),
        residual: Vec::new(),
        history: Vec::new(),
        load_steps: 1,
        convergence: Convergence::default(),
    };
    let influence = |factor| model.influences(&[at(factor)], "right", 0).remove(0);
    assert!(influence(0.001).is_ok());
    assert_eq!(influence(1.0), Err(SolveFault::NotPositiveDefinite));
}

/// The affine field u = G X is an equilibrium where the whole boundary moves so, and a radial motion of a round bore is one
/// of its nodes along their radii.
#[test]
fn linear_and_radial_displacements_are_those_of_the_place() {
    let linear = |text: &str| Some(parse_linear_length(text).unwrap());
    let fields = [
        linear("1 mm + 0.2 * X - 0.05 * Y"),
        linear("0.1 * Y + 0.1 * X"),
    ];
    for (_, shape) in CellShape::NAMES {
        let mut mesh = strip(shape);
        mesh.name_boundary("boundary", |_| true);
        let problem = problem(&[("boundary", Support::LinearDisplacement(fields))], &[]);
        let solution = solved(&problem, &mesh, &[]);
        for (position, u) in mesh
            .nodes
            .iter()
            .zip(solution.state.displacement.chunks_exact(2))
        {
            for (u, field) in u.iter().zip(fields) {
                assert!(
                    (u - field.unwrap().at(*position)).abs() < 1e-11,
                    "{shape:?}"
                );
            }
        }
        assert!(solution.balance.relative() < 1e-9, "{:?}", solution.balance);
    }
    let radii = [10.0, 20.0];
    let mesh = Shape::RingSector { radii, angle: 1.0 }.mesh(4, CellShape::Quad9);
    let radial = Support::Radial {
        centre: [0.0; 2],
        displacement: 2.0,
    };
    let solution = solved(&problem(&[("inside", radial)], &[]), &mesh, &[]);
    for node in &mesh.groups()["inside"].nodes {
        let [x, y] = mesh.nodes[*node];
        let u = &solution.state.displacement[2 * node..2 * node + 2];
        assert!(
            (u[0] - 0.2 * x).abs() < 1e-12 && (u[1] - 0.2 * y).abs() < 1e-12,
            "{u:?}"
        );
    }
    let through = Support::Radial {
        centre: mesh.nodes[mesh.groups()["inside"].nodes[0]],
        displacement: 2.0,
    };
    let refused = problem(&[("inside", through)], &[])
        .check(&mesh)
        .unwrap_err();
    assert!(refused[0].message.contains("at the centre"), "{refused:?}");
}

/// The steep lower side of a turned strip would take along the node that the others of the pulled grip follow.
#[test]
fn a_pulled_grip_and_an_inclined_line_share_no_node() {
    let mesh = moved(strip(CellShape::Quad4), 1.2, [0.0; 2]);
    let grip = Support::Grip([Drive::Force(0.6), Drive::Force(0.1)]);
    for supports in [
        [("left", grip), ("bottom", Support::Roller)],
        [("bottom", Support::Roller), ("left", grip)],
    ] {
        let faults = problem(&supports, &[]).check(&mesh).unwrap_err();
        assert!(faults[0].message.contains("off that line"), "{faults:?}");
    }
}

/// In a linear theory moments balance on the body at rest, those of a pressure on the deformed edge too.
#[test]
fn a_pressure_on_a_linear_sheet_balances() {
    for (_, shape) in CellShape::NAMES {
        let mut problem = problem(&[("left", CLAMP)], &[("top", Load::Pressure(0.0005))]);
        problem.law = Arc::new(LinearElastic {
            shear_modulus: 0.1,
            lame_modulus: 0.2,
            plane: PlaneState::Stress,
        });
        let balance = solved(&problem, &strip(shape), &[]).balance;
        assert!(balance.largest_force > 1e-3);
        assert!(balance.relative() < 1e-9, "{shape:?}: {balance:?}");
    }
}
