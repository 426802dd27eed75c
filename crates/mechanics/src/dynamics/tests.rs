//! Single springs against closed forms, and plates.

use std::f64::consts::TAU;
use std::path::Path;

use super::spring::Spring;
use super::*;
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::material::Card;
use crate::mesh::{Mesh, Side};
use crate::problem::ClampedPlate;
use crate::solve::{NewtonSettings, Remembering};

fn motion(spring: &Spring, start: f64) -> Motion<'_> {
    Motion {
        energy: spring,
        viscosity: (spring.c > 0.0).then_some(spring),
        mass: vec![1.0],
        supports: Vec::new(),
        forces: Vec::new(),
        start: Start::held_at(vec![start]),
        describe: Box::new(|_| "the spring".into()),
    }
}

const VERLET: Integrator = Integrator::VelocityVerlet;

pub const fn alpha(spectral_radius: f64) -> Integrator {
    Integrator::GeneralisedAlpha {
        spectral_radius,
        tolerance: 1e-12,
    }
}

fn settings(integrator: Integrator, duration: f64, step: f64) -> TimeSettings {
    TimeSettings {
        duration,
        interval: step,
        step: Step::AtMost(step),
        integrator,
        most_steps: crate::budget::Budget::USUAL.steps,
    }
}

pub fn run(motion: &Motion, settings: TimeSettings) -> History {
    follow(motion, settings, &|_| ())
        .map_err(|end| (end.time, end.fault))
        .unwrap()
}

/// Frequency in Hz from the first and the last rise through zero, which cubics place between instants.
fn frequency_of(history: &History, unknown: usize) -> f64 {
    let (t, u) = (history.times(), history.displacement(unknown));
    let crossings: Vec<f64> = (2..u.len() - 1)
        .filter(|i| u[i - 1] < 0.0 && u[*i] >= 0.0)
        .map(|i| {
            // Inverse interpolation through four instants.
            let points: Vec<[f64; 2]> = (i - 2..i + 2).map(|k| [u[k], t[k]]).collect();
            let weight = |a: usize, b: usize| {
                if a == b {
                    1.0
                } else {
                    -points[b][0] / (points[a][0] - points[b][0])
                }
            };
            (0..4)
                .map(|a| points[a][1] * (0..4).map(|b| weight(a, b)).product::<f64>())
                .sum()
        })
        .collect();
    (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0])
}

#[test]
fn a_linear_spring_has_its_frequency_and_its_error_is_of_second_order() {
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.0,
    };
    let exact = 2.0 / TAU;
    let period = 1.0 / exact;
    for integrator in [VERLET, alpha(1.0), alpha(0.8)] {
        let error = |steps: f64| {
            let settings = settings(integrator, 10.2 * period, period / steps);
            let history = run(&motion(&spring, 1.0), settings);
            (frequency_of(&history, 0) / exact - 1.0).abs()
        };
        let [coarse, fine, finest] = [100.0, 200.0, 4000.0].map(error);
        assert!(finest < 1e-6, "{integrator:?}: {finest:.2e}");
        assert!(coarse > 1e-5, "{integrator:?}: {coarse:.2e}");
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.02, "{integrator:?}: order {order}");
    }
}

#[test]
fn a_dashpot_damps_as_in_closed_form_with_any_strength() {
    for (c, integrator) in [0.4, 4.0, 40.0]
        .into_iter()
        .flat_map(|c| [(c, VERLET), (c, alpha(1.0)), (c, alpha(0.6))])
    {
        let spring = Spring { k: 4.0, q: 0.0, c };
        let exact = |t: f64| {
            let (half, square) = (0.5 * c, 4.0 - 0.25 * c * c);
            let omega = square.abs().sqrt();
            let (even, odd) = match square.partial_cmp(&0.0) {
                Some(std::cmp::Ordering::Greater) => ((omega * t).cos(), (omega * t).sin() / omega),
                Some(std::cmp::Ordering::Less) => ((omega * t).cosh(), (omega * t).sinh() / omega),
                _ => (1.0, t),
            };
            (-half * t).exp() * (even + half * odd)
        };
        let error = |step: f64| {
            let history = run(&motion(&spring, 1.0), settings(integrator, 2.0, step));
            assert!(
                history.energy_error() < 10.0 * step,
                "{}",
                history.energy_error()
            );
            let instants = history.instants.iter();
            instants
                .map(|now| (now.displacement[0] - exact(now.time)).abs())
                .fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(0.01), error(0.005));
        let order = (coarse / fine).log2();
        assert!(
            fine < 2e-3 && order > 1.7,
            "c = {c}, {integrator:?}: {fine:.1e}, order {order:.2}"
        );
    }
}

#[test]
fn a_step_that_explodes_is_halved_and_the_automatic_one_is_stable() {
    let spring = Spring {
        k: 1.0,
        q: 50.0,
        c: 0.0,
    };
    let body = motion(&spring, 1.0);
    let with = |step, interval| TimeSettings {
        duration: 20.0,
        interval,
        step,
        integrator: VERLET,
        most_steps: crate::budget::Budget::USUAL.steps,
    };
    let halved = run(&body, with(Step::AtMost(0.4), 0.5));
    assert!(halved.halved > 0);
    let automatic = run(&body, with(Step::Automatic, 0.5));
    for history in [halved, automatic] {
        assert!(history.energy_error() < 0.2, "{}", history.energy_error());
        assert_eq!(history.instants.len(), 41);
        assert!(history.displacement(0).iter().all(|u| u.abs() < 1.1));
    }
}

#[test]
fn the_automatic_step_follows_a_tangent_that_grows() {
    // The start is soft: a step chosen there is 12 times too long at the amplitude that the push leads to.
    let spring = Spring {
        k: 1.0,
        q: 50.0,
        c: 0.0,
    };
    let mut body = motion(&spring, 0.0);
    body.start.velocity = vec![5.0];
    let history = run(
        &body,
        TimeSettings {
            duration: 20.0,
            interval: 0.1,
            step: Step::Automatic,
            integrator: VERLET,
            most_steps: crate::budget::Budget::USUAL.steps,
        },
    );
    assert!(history.energy_error() < 0.2, "{}", history.energy_error());
}

#[test]
fn a_support_that_shakes_and_lets_go_does_work() {
    // Two unknowns: a grip and a mass on a spring; here the grip is the whole body, released while it moves.
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.0,
    };
    for integrator in [VERLET, alpha(1.0)] {
        let mut body = motion(&spring, 0.0);
        body.supports = vec![MovingSupport {
            unknowns: vec![0],
            displacement: vec![2.0],
            time: TimeFunction::Ramp {
                begin: 0.1,
                end: 1.1,
            },
            until: Some(0.6),
        }];
        let history = run(
            &body,
            TimeSettings {
                duration: 3.0,
                interval: 0.05,
                step: Step::AtMost(1e-3),
                integrator,
                most_steps: crate::budget::Budget::USUAL.steps,
            },
        );
        let at = |time: f64| {
            let near = |now: &&Instant| (now.time - time).abs() < 1e-9;
            history.instants.iter().find(near).unwrap()
        };
        let end = at(0.6);
        assert!((end.displacement[0] - 1.0).abs() < 1e-12);
        // ½ k u² + ½ m v² at the release.
        assert!((end.energy.external_work - 4.0).abs() < 1e-12);
        assert!((at(0.35).support_forces[0][0] - 2.0).abs() < 1e-12);
        assert_eq!(at(1.0).support_forces[0], [0.0; 2]);
        let exact = |t: f64| (2.0 * (t - 0.6)).cos() + (2.0 * (t - 0.6)).sin();
        assert!((at(2.5).displacement[0] - exact(2.5)).abs() < 1e-5);
        assert!(history.energy_error() < 1e-5);
    }
}

#[test]
fn dead_forces_push() {
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.0,
    };
    let mut body = motion(&spring, 0.0);
    body.forces = vec![MovingForce {
        force: vec![8.0],
        time: TimeFunction::Constant(0.5),
    }];
    let history = run(&body, settings(VERLET, 1.0, 1e-3));
    let last = history.instants.last().unwrap();
    assert!((last.displacement[0] - (1.0 - 2.0_f64.cos())).abs() < 1e-6);
    assert!((last.energy.external_work - 4.0 * last.displacement[0]).abs() < 1e-12);
}

/// A plate in equilibrium between its grips.
pub fn solved(
    problem: &ClampedPlate,
    mesh: &Mesh,
    potential: &dyn Remembering,
    stretch: f64,
) -> Vec<f64> {
    let newton = NewtonSettings {
        tolerance: 1e-11,
        max_iterations: 50,
    };
    let state = problem.on(mesh, potential).reach(&[stretch], newton);
    state.unwrap().displacement
}

pub fn clamp(mesh: &Mesh) -> MovingSupport {
    let nodes = (0..mesh.nodes.len()).filter(|node| mesh.on(Side::Left, *node));
    MovingSupport::fixed(nodes.flat_map(|node| [2 * node, 2 * node + 1]).collect())
}

pub fn plate() -> ClampedPlate {
    ClampedPlate {
        size: [30.0, 10.0],
        thickness: 2.0,
        law: Card::load("pva-10", Path::new(".")).unwrap().law,
        stretches: vec![0.3],
    }
}

pub const DENSITY: f64 = 1.1e-9;

#[test]
fn the_energy_of_an_undamped_plate_stays_for_ten_thousand_steps() {
    let problem = plate();
    let springs = MassSpring::new(&problem, [12, 4], LatticeSettings { area_term: false });
    let elements = FiniteElements::new(&problem, [6, 2], Element::Q1);
    for model in [springs.model(&problem), elements.model(&problem)] {
        let body = Motion {
            energy: model.energy,
            viscosity: None,
            mass: lumped_mass(model.mesh, DENSITY, problem.thickness),
            supports: vec![clamp(model.mesh)],
            forces: Vec::new(),
            start: Start::held_at(solved(&problem, model.mesh, model.energy, 0.3)),
            describe: Box::new(|element| model.mesh.describe_cell(element)),
        };
        let step = 2e-6;
        for integrator in [VERLET, alpha(1.0)] {
            let history = run(
                &body,
                TimeSettings {
                    duration: 1e4 * step,
                    interval: 100.0 * step,
                    step: Step::AtMost(step),
                    integrator,
                    most_steps: crate::budget::Budget::USUAL.steps,
                },
            );
            assert_eq!(history.steps, 10_000);
            assert!(
                history.energy_error() < 1e-4,
                "{} {integrator:?}: {:.2e}",
                model.name,
                history.energy_error()
            );
        }
    }
}
