//! A damped spring under a force that changes in time: the steady state of the steps themselves, and that of the body.
//!
//! Under f = F (1 + sin Ω t) all that is left after a while is u = F/k + Im(Û e^(iΩt)). The steps have a closed form too: with
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
        start: Start::at_rest(1),
        describe: Box::new(|_| "the spring".into()),
    };
    let settings = TimeSettings {
        duration: SETTLED + TAU / OMEGA,
        interval: h,
        step: Step::AtMost(h),
        integrator,
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
        let constants = rho.map_or([0.0, 0.0, 0.0, 0.5], generalised_alpha);
        let [u, v, a] = of_steps(constants, h);
        for now in settled(integrator, h) {
            let turn = Complex::from_polar(1.0, OMEGA * now.time);
            let expected = [
                FORCE / SPRING.k + (u * turn).im,
                (v * turn).im,
                (a * turn).im,
            ];
            let found = [&now.displacement, &now.velocity, &now.acceleration].map(|x| x[0]);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{integrator:?}, {} s: {found} {expected}",
                    now.time
                );
            }
        }
    }
}

/// A force that is taken at the wrong end of a step shifts the motion in time: an error of first order.
#[test]
fn a_force_that_changes_in_time_keeps_the_second_order() {
    for (integrator, _) in METHODS {
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
        // (Ω h)² is the largest share that a term of second order can have here, within a factor of a few.
        assert!(fine < (OMEGA * 0.02_f64).powi(2), "{integrator:?}: {fine}");
    }
}
