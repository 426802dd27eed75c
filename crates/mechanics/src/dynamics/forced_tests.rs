//! A damped spring under a force that changes in time: the steady state of the steps themselves, and that of the body.
//!
//! Under f = F (1 + sin Ω t) what remains after a while is u = F/k + Im(Û e^(iΩt)). The steps have a closed form too: with
//! z = e^(iΩh) every instant is z times the one before, and
//!
//! ```text
//! (z − 1) Û = h V̂ + h² (½ − β + β z) Â,   (z − 1) V̂ = h (1 − γ + γ z) Â
//! m (αₘ + (1 − αₘ) z) Â + (α_f + (1 − α_f) z) (c V̂ + k Û − F) = 0
//! ```
//!
//! are three linear equations for Û, V̂ and Â. Central differences are the case αₘ = α_f = β = 0, γ = ½.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::spring::Spring;
use super::tests::{alpha, run};
use super::*;

const SPRING: Spring = Spring {
    k: 4.0,
    q: 0.0,
    c: 1.0,
};
const FORCE: f64 = 8.0;
/// Ω in rad/s, above the spring's own 2 rad/s.
const OMEGA: f64 = 3.0;
/// What begins dies out as e^(−c t/2m): after so many s it is below 1e-13.
const SETTLED: f64 = 60.0;

/// αₘ, α_f, β, γ.
type Constants = [f64; 4];

/// Those of Chung and Hulbert, eq. 14, 17, 20 and 25.
fn generalised_alpha(rho: f64) -> Constants {
    let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
    let difference = alpha_f - alpha_m;
    let beta = 0.25 * (1.0 + difference) * (1.0 + difference);
    [alpha_m, alpha_f, beta, 0.5 + difference]
}

/// Those of central differences where there is no ρ∞.
fn constants_of(rho: Option<f64>) -> Constants {
    rho.map_or([0.0, 0.0, 0.0, 0.5], generalised_alpha)
}

/// Û, V̂ and Â of the steps.
fn of_steps([alpha_m, alpha_f, beta, gamma]: Constants, h: f64) -> [Complex<f64>; 3] {
    let z = Complex::from_polar(1.0, OMEGA * h);
    let blend = |old: f64, new: f64| z * new + old;
    let v = blend(1.0 - gamma, gamma) * h / (z - 1.0);
    let u = (v * h + blend(0.5 - beta, beta) * h * h) / (z - 1.0);
    let forces = blend(alpha_f, 1.0 - alpha_f);
    let a =
        forces * FORCE / (blend(alpha_m, 1.0 - alpha_m) + forces * (v * SPRING.c + u * SPRING.k));
    [u * a, v * a, a]
}

/// Û of the body.
fn exact() -> Complex<f64> {
    Complex::new(FORCE, 0.0) / Complex::new(SPRING.k - OMEGA * OMEGA, SPRING.c * OMEGA)
}

/// The last instants of the motion with steps of `h`.
fn settled(integrator: Integrator, h: f64) -> Vec<Instant> {
    let motion = Motion {
        energy: &SPRING,
        viscosity: Some(&SPRING),
        mass: vec![1.0],
        supports: Vec::new(),
        forces: vec![MovingForce {
            force: vec![FORCE],
            time: TimeFunction::Sine {
                mean: 1.0,
                amplitude: 1.0,
                frequency: OMEGA / TAU,
            },
        }],
        start: Start::held_at(vec![0.0; 1]),
        describe: Box::new(|_| "the spring".into()),
    };
    let settings = TimeSettings {
        duration: SETTLED + TAU / OMEGA,
        interval: h,
        step: Step::AtMost(h),
        integrator,
        most_steps: crate::budget::Budget::USUAL.steps,
    };
    let instants = run(&motion, settings).instants;
    let last = instants.len() - 1;
    let late = instants[..last].iter().filter(|now| now.time > SETTLED);
    late.cloned().collect()
}

const METHODS: [(Integrator, Option<f64>); 5] = [
    (Integrator::VelocityVerlet, None),
    (alpha(1.0), Some(1.0)),
    (alpha(0.8), Some(0.8)),
    (alpha(0.5), Some(0.5)),
    (alpha(0.0), Some(0.0)),
];

#[test]
fn the_steady_state_is_that_of_the_difference_equations() {
    let h = 0.1;
    for (integrator, rho) in METHODS {
        let [u, v, a] = of_steps(constants_of(rho), h);
        for now in settled(integrator, h) {
            let turn = Complex::from_polar(1.0, OMEGA * now.time);
            let expected = [
                FORCE / SPRING.k + (u * turn).im,
                (v * turn).im,
                (a * turn).im,
            ];
            let computed = [&now.displacement, &now.velocity, &now.acceleration].map(|x| x[0]);
            for (computed, expected) in computed.into_iter().zip(expected) {
                assert!(
                    (computed - expected).abs() < 1e-9,
                    "{integrator:?}, {} s: {computed} {expected}",
                    now.time
                );
            }
        }
    }
}

/// A force that is taken at the wrong end of a step shifts the motion in time: an error of first order.
#[test]
fn a_force_that_changes_in_time_keeps_the_second_order() {
    for (integrator, rho) in METHODS {
        let error = |h: f64| {
            let off = settled(integrator, h).into_iter().map(|now| {
                let turn = Complex::from_polar(1.0, OMEGA * now.time);
                (now.displacement[0] - FORCE / SPRING.k - (exact() * turn).im).abs()
            });
            off.fold(0.0, f64::max) / exact().norm()
        };
        let [coarse, fine] = [0.04, 0.02].map(error);
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "{integrator:?}: order {order}");
        // How far the steps' own closed form is from the body's.
        let bound = (of_steps(constants_of(rho), 0.02)[0] - exact()).norm() / exact().norm();
        assert!(
            (0.9..1.0 + 1e-6).contains(&(fine / bound)),
            "{integrator:?}: {fine} {bound}"
        );
    }
}

/// What holds an unknown must carry its inertia, spring and dashpot, less the load; it does the work that the energies gain.
#[test]
fn a_support_carries_inertia_spring_and_dashpot_less_the_load() {
    let (amplitude, load) = (0.5, 0.3);
    let frequency = OMEGA / TAU;
    let sine = TimeFunction::Sine {
        mean: 0.0,
        amplitude,
        frequency,
    };
    let motion = Motion {
        energy: &SPRING,
        viscosity: Some(&SPRING),
        mass: vec![2.0],
        supports: vec![MovingSupport {
            unknowns: vec![0],
            displacement: vec![1.0],
            time: sine,
            until: None,
        }],
        forces: vec![MovingForce {
            force: vec![load],
            time: TimeFunction::Constant(1.0),
        }],
        start: Start::held_at(vec![0.0; 1]),
        describe: Box::new(|_| "the spring".into()),
    };
    for integrator in [Integrator::VelocityVerlet, alpha(0.8)] {
        let history = run(&motion, every(integrator, 1.0, 0.01, 0.01));
        for now in &history.instants {
            let (sine, cosine) = (OMEGA * now.time).sin_cos();
            // The first instant is the one before the support begins to move.
            let cosine = if now.time > 0.0 { cosine } else { 0.0 };
            let [u, v, a] = [sine, OMEGA * cosine, -OMEGA * OMEGA * sine].map(|x| amplitude * x);
            let carried = 2.0 * a + SPRING.k * u + SPRING.c * v - load;
            assert!((now.support_forces[0][0] - carried).abs() < 1e-12);
            let energy = now.energy;
            assert!((energy.kinetic - v * v).abs() < 1e-12);
            assert!((energy.stored - 0.5 * SPRING.k * u * u).abs() < 1e-12);
            // ∫ c v² dt of the exact motion, by the trapezoidal rule of second order.
            let square = amplitude * amplitude * OMEGA * OMEGA;
            let twice = 2.0 * OMEGA * now.time;
            let spent = SPRING.c * square * (0.5 * now.time + twice.sin() / (4.0 * OMEGA));
            assert!((energy.viscous_work - spent).abs() < 1e-3 * square);
        }
        assert!(history.energy_error() < 1e-3, "{}", history.energy_error());
    }
}

fn every(integrator: Integrator, duration: f64, interval: f64, step: f64) -> TimeSettings {
    TimeSettings {
        duration,
        interval,
        step: Step::AtMost(step),
        integrator,
        most_steps: crate::budget::Budget::USUAL.steps,
    }
}

/// The spring without its dashpot, let go at 1 mm.
fn released(spring: &Spring) -> Motion<'_> {
    Motion {
        energy: spring,
        viscosity: None,
        mass: vec![1.0],
        supports: Vec::new(),
        forces: Vec::new(),
        start: Start::held_at(vec![1.0]),
        describe: Box::new(|_| "the spring".into()),
    }
}

/// ω = 2 rad/s: the longest stable step of central differences is 2/ω = 1 s, and half of that is taken; generalised-α
/// takes a hundredth of the period.
#[test]
fn automatic_steps_are_shares_of_the_longest_stable_one_and_of_the_period() {
    for (integrator, step) in [
        (Integrator::VelocityVerlet, 0.5),
        (alpha(1.0), 0.01 * 0.5 * TAU),
    ] {
        // Six steps of central differences are a turn, since cos θ = 1 − ½ (ω h)²: the energy that they sway by is back.
        let duration = 41.999 * step;
        let settings = TimeSettings {
            step: Step::Automatic,
            ..every(integrator, duration, duration, step)
        };
        let history = run(&released(&SPRING), settings);
        assert_eq!((history.steps, history.halved), (42, 0), "{integrator:?}");
    }
}

/// ρ∞ = 0 damps fast motions away; that is no motion that explodes.
#[test]
fn numerical_damping_is_no_explosion() {
    let history = run(&released(&SPRING), every(alpha(0.0), 20.0, 1.0, 0.5));
    assert_eq!(history.halved, 0);
    let [first, .., last] = &history.instants[..] else {
        panic!("instants");
    };
    let total = |instant: &Instant| instant.energy.kinetic + instant.energy.stored;
    assert!(total(last) < 0.5 * total(first), "{last:?}");
}

/// The kinks of a function are ends of steps, not instants that anybody asked for.
#[test]
fn kinks_between_instants_are_met_and_not_told() {
    let mut motion = released(&SPRING);
    motion.supports = vec![MovingSupport {
        unknowns: vec![0],
        displacement: vec![3.0],
        time: TimeFunction::Ramp {
            begin: 0.13,
            end: 0.88,
        },
        until: None,
    }];
    motion.start = Start::held_at(vec![0.0; 1]);
    let history = run(&motion, every(alpha(1.0), 1.0, 0.25, 0.25));
    assert_eq!(history.times(), [0.0, 0.25, 0.5, 0.75, 1.0]);
    let speeds: Vec<f64> = history.instants.iter().map(|now| now.velocity[0]).collect();
    // 3 mm in 0.75 s.
    for (speed, expected) in speeds.into_iter().zip([0.0, 4.0, 4.0, 4.0, 0.0]) {
        assert!((speed - expected).abs() < 1e-12);
    }
    // ½ k u² at the end, and the kinetic energy that was given and taken back.
    let end = &history.instants[4].energy;
    assert!((end.external_work - 0.5 * SPRING.k * 9.0).abs() < 1e-12);
    assert!(history.energy_error() < 1e-12);
}
