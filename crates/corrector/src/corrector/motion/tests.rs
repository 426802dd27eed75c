//! Springs against closed forms, and a plate against the integrators of `dynamics`.

use std::path::Path;

use super::*;
use crate::corrector::{DifferenceScheme, Solver};
use crate::dynamics::spring::Spring;
use crate::dynamics::{
    History, Integrator, MovingSupport, Start, Step, TimeSettings, Viscosity, follow, lumped_mass,
};
use crate::material::Card;
use crate::mesh::{CellShape, Mesh, Side};
use crate::problem::ClampedPlate;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::Potential;

fn motion<'a>(
    energy: &'a dyn Potential,
    viscosity: Option<&'a dyn Viscosity>,
    start: f64,
) -> Motion<'a> {
    Motion {
        energy,
        viscosity,
        mass: vec![1.0],
        supports: Vec::new(),
        forces: Vec::new(),
        start: Start::held_at(vec![start]),
        describe: Box::new(|_| "the spring".into()),
    }
}

fn windows(steps: usize) -> WindowSettings {
    WindowSettings {
        steps,
        tolerance: 1e-12,
        max_iterations: 20,
        size: 1.0,
    }
}

/// The motion by generalised-α with ρ∞ = 1 at so many instants after the start.
fn by_average_acceleration(body: &Motion, step: f64, count: f64) -> History {
    let settings = TimeSettings {
        duration: count * step,
        interval: step,
        step: Step::AtMost(step),
        integrator: Integrator::GeneralisedAlpha {
            spectral_radius: 1.0,
            tolerance: 1e-13,
        },
        most_steps: crate::budget::Budget::USUAL.steps,
    };
    let followed = follow(body, settings, &|_| ());
    followed.map_err(|end| end.fault).unwrap()
}

/// A wrong motion of the right size.
fn wrong(count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|i| vec![(0.05 * i as f64).cos()]).collect()
}

#[test]
fn a_damped_spring_is_corrected_to_its_closed_form_with_the_second_order() {
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.4,
    };
    let body = motion(&spring, Some(&spring), 1.0);
    let omega = (4.0_f64 - 0.04).sqrt();
    let exact = |t: f64| (-0.2 * t).exp() * ((omega * t).cos() + 0.2 / omega * (omega * t).sin());
    for beta in [0.0, 0.25] {
        let error = |count: usize| {
            let step = 5.0 / count as f64;
            let equation = EquationOfMotion::new(&body, step, beta).unwrap();
            let corrected = equation
                .correct(&wrong(count + 1), &body.start, windows(16), &|_| ())
                .unwrap();
            let all = corrected.displacement.iter().enumerate();
            all.map(|(i, u)| (u[0] - exact(step * i as f64)).abs())
                .fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(100), error(200));
        let order = (coarse / fine).log2();
        assert!(
            fine < 1e-3 && (order - 2.0).abs() < 0.05,
            "β = {beta}: {fine:.1e}, order {order}"
        );
    }
}

#[test]
fn the_result_depends_neither_on_the_data_nor_on_the_windows() {
    let spring = Spring {
        k: 1.0,
        q: 3.0,
        c: 0.2,
    };
    let body = motion(&spring, Some(&spring), 1.0);
    let equation = EquationOfMotion::new(&body, 0.05, 0.25).unwrap();
    let first = equation
        .correct(&wrong(101), &body.start, windows(10), &|_| ())
        .unwrap();
    let still = equation
        .correct(&vec![vec![1.0]; 101], &body.start, windows(1), &|_| ())
        .unwrap();
    for (a, b) in first.displacement.iter().zip(&still.displacement) {
        assert!((a[0] - b[0]).abs() < 1e-10, "{a:?} {b:?}");
    }
    assert_eq!((first.windows, still.windows), (10, 100));
    assert!(first.factorisations < 20, "{}", first.factorisations);
    let again = equation
        .correct(&first.displacement, &body.start, windows(10), &|_| ())
        .unwrap();
    assert!(again.multipliers.iter().all(|psi| psi[0].abs() < 1e-10));
    assert!(again.iterations <= 10, "{}", again.iterations);
}

#[test]
fn multipliers_balance_the_correction() {
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.0,
    };
    let body = motion(&spring, None, 1.0);
    let (h, count) = (0.1, 6);
    let equation = EquationOfMotion::new(&body, h, 0.0).unwrap();
    let data = wrong(count);
    let corrected = equation
        .correct(&data, &body.start, windows(count), &|_| ())
        .unwrap();
    let psi = |instant: usize| corrected.multipliers.get(instant).map_or(0.0, |psi| psi[0]);
    for (instant, data) in data.iter().enumerate().skip(1) {
        // Of the row that determines it, and of the next two.
        let square = h * h;
        let pull = psi(instant) / square
            + (4.0 - 2.0 / square) * psi(instant + 1)
            + psi(instant + 2) / square;
        let change = corrected.displacement[instant][0] - data[0];
        assert!((change + pull).abs() < 1e-12, "{instant}: {change} {pull}");
    }
}

#[test]
fn noise_is_removed_from_a_recorded_motion_with_an_unknown_start() {
    let spring = Spring {
        k: 4.0,
        q: 0.5,
        c: 0.0,
    };
    let body = motion(&spring, None, 1.0);
    let equation = EquationOfMotion::new(&body, 0.05, 0.25).unwrap();
    let exact = equation
        .correct(&wrong(121), &body.start, windows(10), &|_| ())
        .unwrap()
        .displacement;
    let noise = |i: usize| 0.1 * ((12.9898 * i as f64).sin() * 43_758.545).fract();
    let data: Vec<Vec<f64>> = exact
        .iter()
        .enumerate()
        .map(|(i, u)| vec![u[0] + noise(i)])
        .collect();
    let guess: Vec<Vec<f64>> = (0..121)
        .map(|i| vec![(0.11 * f64::from(i)).cos()])
        .collect();
    let settings = CorrectorSettings {
        tolerance: 1e-9,
        movement: 1e-7,
        max_steps: 200,
        solver: Solver::Automatic,
    };
    let smoothed = equation.smooth(&data, &guess, 121, settings).unwrap();
    let error = |fields: &[Vec<f64>]| {
        let squares = fields
            .iter()
            .zip(&exact)
            .map(|(a, b)| (a[0] - b[0]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let ratio = error(&smoothed) / error(&data);
    assert!(ratio < 2.0 * (2.0_f64 / 121.0).sqrt(), "{ratio}");
    // What is left of the noise is orthogonal to all motions of the body: it has no part along the exact one's change.
    let stretches = equation.smooth(&data, &guess, 40, settings).unwrap();
    assert!(error(&stretches) > error(&smoothed) && error(&stretches) < error(&data));
}

fn plate() -> (ClampedPlate, Mesh, SheetEnergy) {
    let problem = ClampedPlate {
        size: [30.0, 10.0],
        thickness: 2.0,
        law: Card::load("pva-10", Path::new(".")).unwrap().law,
        stretches: vec![0.1],
    };
    let mesh = Mesh::plate(problem.size, [6, 2], CellShape::Quad4);
    let energy = DifferenceScheme::Biquadratic.energy(&problem, &mesh);
    (problem, mesh, energy)
}

#[test]
fn a_plate_moves_as_by_the_average_acceleration() {
    let (problem, mesh, energy) = plate();
    let clamped = (0..mesh.nodes.len()).filter(|node| mesh.on(Side::Left, *node));
    let start: Vec<f64> = mesh
        .nodes
        .iter()
        .flat_map(|[x, y]| [0.1 * x, -0.05 * (y - 5.0) * x / 30.0])
        .collect();
    let body = Motion {
        energy: &energy,
        viscosity: None,
        mass: lumped_mass(&mesh, 1.1e-9, problem.thickness),
        supports: vec![MovingSupport::fixed(
            clamped.flat_map(|node| [2 * node, 2 * node + 1]).collect(),
        )],
        forces: Vec::new(),
        start: Start::held_at(start),
        describe: Box::new(|cell| mesh.describe_cell(cell)),
    };
    let step = 2e-5;
    let history = by_average_acceleration(&body, step, 100.0);
    let data = vec![body.start.displacement.clone(); 101];
    let equation = EquationOfMotion::new(&body, step, 0.25).unwrap();
    let corrected = equation
        .correct(&data, &body.start, windows(10), &|_| ())
        .unwrap();
    for (instant, u) in history.instants.iter().zip(&corrected.displacement) {
        let pairs = instant.displacement.iter().zip(u);
        let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most < 1e-7, "{}: {most:.1e}", instant.time);
    }
    assert!(
        corrected.factorisations < 10,
        "{}",
        corrected.factorisations
    );
}

#[test]
fn motions_that_three_instants_do_not_tell_are_refused() {
    let spring = Spring {
        k: 1.0,
        q: 0.0,
        c: 0.0,
    };
    let mut body = motion(&spring, None, 1.0);
    body.supports = vec![MovingSupport {
        until: Some(0.5),
        ..MovingSupport::fixed(vec![0])
    }];
    let fault = EquationOfMotion::new(&body, 0.1, 0.25)
        .map(|_| ())
        .unwrap_err();
    assert!(
        fault.to_string().contains("is released during the motion"),
        "{fault}"
    );
    let mut body = motion(&spring, None, 1.0);
    body.mass = vec![0.0];
    assert!(EquationOfMotion::new(&body, 0.1, 0.25).is_err());
}

/// β = ¼ is Newmark's average acceleration: under a force that changes in time the corrected motion is that of
/// generalised-α with ρ∞ = 1, whatever the motion that was given.
#[test]
fn a_motion_under_a_force_that_changes_in_time_is_that_of_newmarks_method() {
    let spring = Spring {
        k: 4.0,
        q: 3.0,
        c: 0.4,
    };
    let mut body = motion(&spring, Some(&spring), 0.5);
    body.forces = vec![crate::dynamics::MovingForce {
        force: vec![2.0],
        time: crate::dynamics::TimeFunction::Sine {
            mean: 0.3,
            amplitude: 1.0,
            frequency: 0.4,
        },
    }];
    let step = 0.05;
    let expected = by_average_acceleration(&body, step, 80.0);
    let equation = EquationOfMotion::new(&body, step, 0.25).unwrap();
    let given = wrong(expected.instants.len());
    let corrected = equation
        .correct(&given, &body.start, windows(16), &|_| ())
        .unwrap();
    for (corrected, expected) in corrected.displacement.iter().zip(&expected.instants) {
        let off = (corrected[0] - expected.displacement[0]).abs();
        assert!(off < 1e-8, "{} s: {off:.1e}", expected.time);
    }
}
