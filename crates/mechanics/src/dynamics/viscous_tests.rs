//! Viscous forces against closed forms.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use super::tests::{DENSITY, alpha, clamp, plate, run, solved};
use super::viscosity::{ElementMotion, ViscousLocal};
use super::*;
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{DashpotLaw, LatticeSettings, MassSpring, SpringLaw};
use crate::material::Card;
use crate::material::scalar_function::ScalarFunction;
use crate::material::viscosity::{Relaxation, ViscousMaterial};
use crate::mesh::{Mesh, Side};
use crate::solve::Remembering;

fn prony(share: f64, time: f64) -> ViscousMaterial {
    ViscousMaterial {
        shear_viscosity: 0.0,
        relaxation: vec![Relaxation { share, time }],
        ..ViscousMaterial::default()
    }
}

fn fluid(shear_viscosity: f64) -> ViscousMaterial {
    ViscousMaterial {
        shear_viscosity,
        ..ViscousMaterial::default()
    }
}

fn lattice() -> MassSpring {
    MassSpring::new(&plate(), [6, 2], LatticeSettings { area_term: false })
}

fn elements() -> FiniteElements {
    FiniteElements::new(&plate(), [3, 1], Element::Q2)
}

/// Both models with a viscous material each.
fn with_both(
    material: &ViscousMaterial,
    test: impl Fn(&str, &Mesh, &dyn Remembering, &dyn Viscosity),
) {
    let (springs, elements) = (lattice(), elements());
    let law = DashpotLaw::Material(material.clone());
    let dashpots = Dashpots::new(&springs, &law);
    test("springs", &springs.mesh, springs.potential(), &dashpots);
    let sheet = SheetViscosity::new(elements.energy(), material);
    test("elements", &elements.mesh, elements.energy(), &sheet);
}

/// Largest difference of the tangents to central differences of an element's forces, over the largest entry; those by
/// the displacement at rest only, where they are complete.
fn tangent_errors(
    potential: &dyn Remembering,
    viscosity: &dyn Viscosity,
    element: usize,
) -> [f64; 2] {
    let size = potential.element_unknowns(element).len();
    let wave = |scale: f64, phase: f64| -> Vec<f64> {
        (0..size)
            .map(|i| scale * (1.7 * i as f64 + phase).sin())
            .collect()
    };
    let (u, v, rest) = (wave(0.4, 0.1), wave(3.0, 0.7), vec![0.0; size]);
    let mut memory = vec![0.0; viscosity.memory(element)];
    if !memory.is_empty() {
        let long_rest = ElementMotion {
            displacement: &wave(0.2, 0.4),
            velocity: &rest,
            memory: &memory.clone(),
            elapsed: f64::INFINITY,
        };
        viscosity.remember(element, long_rest, &mut memory).unwrap();
    }
    let at = |displacement: &[f64], velocity: &[f64], tangents: Option<[&mut [f64]; 2]>| {
        let mut force = vec![0.0; size];
        let motion = ElementMotion {
            displacement,
            velocity,
            memory: &memory,
            elapsed: 0.3,
        };
        let local = ViscousLocal {
            force: &mut force,
            tangents,
        };
        viscosity.add_element(element, motion, local).unwrap();
        force
    };
    let mut errors = [0.0; 2];
    for (which, velocity) in [(0, &rest), (1, &v)] {
        let [mut by_displacement, mut by_velocity] = [(); 2].map(|()| vec![0.0; size * size]);
        at(&u, velocity, Some([&mut by_displacement, &mut by_velocity]));
        let tangent = [by_displacement, by_velocity][which].clone();
        let largest = tangent
            .iter()
            .fold(1e-300, |most: f64, k| most.max(k.abs()));
        for column in 0..size {
            let step = 1e-5;
            let moved = |step: f64| {
                let (mut u, mut v) = (u.clone(), velocity.clone());
                [&mut u, &mut v][which][column] += step;
                at(&u, &v, None)
            };
            let (up, down) = (moved(step), moved(-step));
            for row in column..size {
                let slope = (up[row] - down[row]) / (2.0 * step);
                let error = (slope - tangent[row * size + column]).abs() / largest;
                errors[which] = f64::max(errors[which], error);
            }
        }
    }
    errors
}

#[test]
fn tangents_are_derivatives() {
    let mut material = prony(0.4, 0.5);
    material.shear_viscosity = 0.02;
    with_both(&material, |name, _, energy, viscosity| {
        let errors = tangent_errors(energy, viscosity, 1);
        assert!(
            errors.iter().all(|error| *error < 1e-6),
            "{name}: {errors:?}"
        );
    });
    let law = DashpotLaw::Viscosity {
        by_stretch: ScalarFunction::Polynomial(vec![1.0, 0.5]),
        by_rate: ScalarFunction::Polynomial(vec![0.1, 0.0, 0.4]),
    };
    let springs = lattice();
    let errors = tangent_errors(springs.potential(), &Dashpots::new(&springs, &law), 1);
    assert!(errors[1] < 1e-6, "{errors:?}");
}

/// The right grip, at a displacement in mm that changes in time.
fn grip(mesh: &Mesh, displacement: f64, time: TimeFunction) -> MovingSupport {
    let nodes: Vec<usize> = (0..mesh.nodes.len())
        .filter(|node| mesh.on(Side::Right, *node))
        .collect();
    MovingSupport {
        displacement: nodes.iter().flat_map(|_| [displacement, 0.0]).collect(),
        unknowns: nodes
            .iter()
            .flat_map(|node| [2 * node, 2 * node + 1])
            .collect(),
        time,
        until: None,
    }
}

#[test]
fn a_plate_that_is_stretched_at_once_relaxes_as_in_closed_form() {
    let problem = plate();
    let (share, time) = (0.3, 2.0);
    let material = prony(share, time);
    with_both(&material, |name, mesh, energy, viscosity| {
        let start = solved(&problem, mesh, energy, 0.3);
        for relaxed in [false, true] {
            let body = Motion {
                energy,
                viscosity: Some(viscosity),
                mass: lumped_mass(mesh, DENSITY, problem.thickness),
                supports: vec![
                    clamp(mesh),
                    grip(mesh, 0.3 * problem.size[0], TimeFunction::Constant(1.0)),
                ],
                forces: Vec::new(),
                start: Start {
                    relaxed,
                    ..Start::held_at(start.clone())
                },
                describe: Box::new(|element| element.to_string()),
            };
            let history = run(
                &body,
                TimeSettings {
                    duration: 6.0,
                    interval: 0.25,
                    step: Step::AtMost(0.25),
                    integrator: alpha(0.5),
                    most_steps: crate::budget::Budget::USUAL.steps,
                },
            );
            let mut elastic = vec![0.0; start.len()];
            crate::solve::Assembly::residual(energy, &start, &mut elastic).unwrap();
            let long: f64 = body.supports[1]
                .unknowns
                .iter()
                .step_by(2)
                .map(|i| elastic[*i])
                .sum();
            for instant in &history.instants {
                let (now, force) = (instant.time, instant.support_forces[1][0]);
                let beta = share / (1.0 - share);
                let expected = if !relaxed {
                    1.0 + beta * (-now / time).exp()
                } else {
                    1.0
                };
                let error = (force / long / expected - 1.0).abs();
                assert!(error < 1e-6, "{name}, {relaxed}, {now} s: {error:.1e}");
            }
        }
    });
}

/// Energy lost in the third cycle of a strip with free edges, and the displacement amplitude in mm and the volume in mm³.
fn loss(
    mesh: &Mesh,
    energy: &dyn Remembering,
    viscosity: &dyn Viscosity,
    frequency: f64,
) -> (f64, f64) {
    let problem = plate();
    let amplitude = 1e-4;
    let on = |side| (0..mesh.nodes.len()).filter(move |node| mesh.on(side, *node));
    let corner = on(Side::Left)
        .find(|node| mesh.on(Side::Bottom, *node))
        .unwrap();
    let left = on(Side::Left).map(|node| 2 * node).chain([2 * corner + 1]);
    let right: Vec<usize> = on(Side::Right).map(|node| 2 * node).collect();
    let body = Motion {
        energy,
        viscosity: Some(viscosity),
        mass: lumped_mass(mesh, DENSITY, problem.thickness),
        supports: vec![
            MovingSupport::fixed(left.collect()),
            MovingSupport {
                displacement: vec![amplitude * problem.size[0]; right.len()],
                unknowns: right,
                time: TimeFunction::Sine {
                    mean: 0.0,
                    amplitude: 1.0,
                    frequency,
                },
                until: None,
            },
        ],
        forces: Vec::new(),
        start: Start::held_at(vec![0.0; energy.unknowns()]),
        describe: Box::new(|element| element.to_string()),
    };
    let period = 1.0 / frequency;
    let history = run(
        &body,
        TimeSettings {
            duration: 3.0 * period,
            interval: period,
            step: Step::AtMost(period / 400.0),
            integrator: alpha(0.8),
            most_steps: crate::budget::Budget::USUAL.steps,
        },
    );
    let spent = |instant: usize| history.instants[instant].energy.viscous_work;
    let volume = problem.size[0] * problem.size[1] * problem.thickness;
    (spent(3) - spent(2), PI * amplitude * amplitude * volume)
}

/// W = π ε² E″ in each mm³ and cycle: E″ = 3 η ω of the fluid, E β ω τ/(1 + ω² τ²) of a branch.
#[test]
fn a_cycle_loses_the_energy_of_the_closed_form() {
    let frequency = 1.0;
    let modulus = plate().law.youngs_modulus();
    let eta = 2e-3;
    with_both(&fluid(eta), |name, mesh, energy, viscosity| {
        let (lost, scale) = loss(mesh, energy, viscosity, frequency);
        let error = lost / (scale * 3.0 * eta * TAU * frequency) - 1.0;
        assert!(error.abs() < 1e-3, "{name}: {error:.1e}");
    });
    let tau = 0.2;
    with_both(&prony(0.5, tau), |name, mesh, energy, viscosity| {
        let (lost, scale) = loss(mesh, energy, viscosity, frequency);
        let x = TAU * frequency * tau;
        let error = lost / (scale * modulus * x / (1.0 + x * x)) - 1.0;
        assert!(error.abs() < 2e-3, "{name}: {error:.1e}");
    });
}

#[test]
fn springs_take_any_stiffness() {
    let modulus = ScalarFunction::Polynomial(vec![0.1, 0.3, 0.2]);
    let springs = lattice().with_spring_law(SpringLaw::SecantModulus(modulus));
    let u: Vec<f64> = (0..springs.potential().unknowns())
        .map(|i| 0.3 * (1.3 * i as f64).sin())
        .collect();
    let direction: Vec<f64> = (0..u.len()).map(|i| (0.7 * i as f64).cos()).collect();
    let errors = crate::solve::assembly::derivative_errors(springs.potential(), &u, &direction);
    assert!(errors.iter().all(|error| *error < 1e-8), "{errors:?}");
    let state = springs.spring_states(&u, &[])[0];
    let strain = state.stretch - 1.0;
    let expected = springs.springs[0].area * (0.1 + 0.3 * strain + 0.2 * strain * strain) * strain;
    assert!((state.force - expected).abs() < 1e-14);
    assert!(
        Card::load("pva-10", Path::new("."))
            .unwrap()
            .viscosity
            .is_none()
    );
}
