//! The tests that every law must pass, shipped cards and a synthetic law alike.

use std::path::Path;
use std::sync::Arc;

use nalgebra::{Matrix2, Vector4};

use super::law::{EnergyDerivatives, HyperelasticLaw, Invariants};
use super::registry::{CARDS, LAWS};
use super::sheet::{Gradient, Kinematics};
use super::{Card, NeoHooke, uniaxial};

/// All derivatives non-zero and all different, so that no slip in the chain rule can hide.
#[derive(Debug)]
struct Synthetic;

impl HyperelasticLaw for Synthetic {
    fn evaluate(&self, i: Invariants) -> EnergyDerivatives {
        let (a, b) = (i.i1_minus_3, i.i2_minus_3);
        EnergyDerivatives {
            energy: 0.5 * a
                + 0.3 * b
                + 0.11 * a * a
                + 0.07 * a * b
                + 0.05 * b * b
                + 0.02 * a * a * a,
            d1: 0.5 + 0.22 * a + 0.07 * b + 0.06 * a * a,
            d2: 0.3 + 0.07 * a + 0.10 * b,
            d11: 0.22 + 0.12 * a,
            d12: 0.07,
            d22: 0.10,
        }
    }
}

fn for_each_law(test: impl Fn(&str, &dyn HyperelasticLaw)) {
    test("synthetic", &Synthetic);
    for (name, _) in CARDS {
        test(name, &*Card::load(name, Path::new(".")).unwrap().law);
    }
    for (name, parameters) in SAMPLES {
        test(name, &*sample(name, parameters));
    }
}

/// Parameters of the laws that no shipped card uses.
const SAMPLES: [(&str, &str); 7] = [
    (
        "mooney-rivlin-3",
        "c10 = \"0.04 MPa\"\nc01 = \"0.01 MPa\"\nc11 = \"2 kPa\"",
    ),
    (
        "mooney-rivlin-5",
        "c10 = \"0.04 MPa\"\nc01 = \"0.01 MPa\"\nc20 = \"3 kPa\"\nc11 = \"2 kPa\"\nc02 = \"1 kPa\"",
    ),
    (
        "yeoh",
        "c10 = \"0.03 MPa\"\nc20 = \"-2 kPa\"\nc30 = \"1 kPa\"",
    ),
    ("gent", "mu = \"0.05 MPa\"\njm = 30"),
    ("arruda-boyce", "mu = \"0.05 MPa\"\nlambda_m = 2.5"),
    ("fung-demiray", "mu = \"0.05 MPa\"\nb = 0.4"),
    ("veronda-westmann", "c = \"0.05 MPa\"\nbeta = 0.4"),
];

fn sample(law: &str, parameters: &str) -> Arc<dyn HyperelasticLaw> {
    let card = CARDS[0].1;
    let (head, rest) = card.split_once("[parameters]").unwrap();
    let (_, rest) = rest.split_once("[data]").unwrap();
    let head = head.replace("marlow-exponential", law);
    let text = format!("{head}[parameters]\n{parameters}\n[data]{rest}");
    Card::parse(law, law, &text).unwrap().law
}

#[test]
fn every_law_of_the_registry_is_tested() {
    for (law, ..) in LAWS {
        let by_card = CARDS
            .iter()
            .any(|(name, _)| Card::load(name, Path::new(".")).unwrap().law_name == *law);
        assert!(
            by_card || SAMPLES.iter().any(|(name, _)| name == law),
            "{law}"
        );
    }
}

#[test]
fn laws_have_their_stated_small_strain_moduli_and_limits() {
    let modulus = |law: &str, parameters: &str| sample(law, parameters).shear_modulus();
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    near(
        modulus(
            "yeoh",
            "c10 = \"0.03 MPa\"\nc20 = \"5 kPa\"\nc30 = \"1 kPa\"",
        ),
        0.06,
    );
    near(modulus("gent", "mu = \"0.05 MPa\"\njm = 30"), 0.05);
    near(modulus("fung-demiray", "mu = \"0.05 MPa\"\nb = 0.4"), 0.05);
    near(
        modulus("veronda-westmann", "c = \"0.05 MPa\"\nbeta = 0.4"),
        0.02,
    );
    near(modulus("mooney-rivlin-5", SAMPLES[1].1), 0.1);
    let m = 2.5_f64.powi(-2);
    let series = 1.0
        + 0.6 * m
        + 99.0 / 175.0 * m * m
        + 513.0 / 875.0 * m.powi(3)
        + 42039.0 / 67375.0 * m.powi(4);
    near(
        modulus("arruda-boyce", "mu = \"0.05 MPa\"\nlambda_m = 2.5"),
        0.05 * series,
    );
    // Limits: all of these become the neo-Hookean law with C₁₀ = 0.025 MPa.
    let exact = uniaxial::uniaxial(&NeoHooke { c10: 0.025 }, 0.8).nominal_stress;
    for (law, parameters) in [
        ("gent", "mu = \"0.05 MPa\"\njm = 1e12"),
        ("fung-demiray", "mu = \"0.05 MPa\"\nb = 1e-12"),
        ("arruda-boyce", "mu = \"0.05 MPa\"\nlambda_m = 1e6"),
        (
            "yeoh",
            "c10 = \"0.025 MPa\"\nc20 = \"0 MPa\"\nc30 = \"0 MPa\"",
        ),
    ] {
        near(
            uniaxial::uniaxial(&*sample(law, parameters), 0.8).nominal_stress,
            exact,
        );
    }
}

#[test]
fn a_chain_beyond_its_limit_has_no_energy() {
    let gent = sample("gent", "mu = \"0.05 MPa\"\njm = 2");
    let state = Invariants {
        i1_minus_3: 2.1,
        i2_minus_3: 1.0,
    };
    assert!(!gent.evaluate(state).energy.is_finite());
}

const STATES: [[f64; 4]; 5] = [
    [0.1, 0.02, -0.03, -0.05],
    [0.9, 0.1, 0.2, -0.3],
    [-0.2, 0.15, 0.1, 0.3],
    [0.4, -0.3, 0.3, 0.5],
    [1e-3, 2e-3, -1e-3, 5e-4],
];

fn gradient(h: [f64; 4]) -> Gradient {
    Vector4::from(h)
}

fn stress(law: &dyn HyperelasticLaw, h: &Gradient) -> Gradient {
    Kinematics::new(h).unwrap().stress(law).1
}

/// The smallest error of central differences over step sizes: V-shaped in the step.
fn best_difference(exact: f64, scale: f64, function: impl Fn(f64) -> f64) -> f64 {
    (2..8)
        .map(|power| 10f64.powi(-power))
        .map(|step| ((function(step) - function(-step)) / (2.0 * step) - exact).abs() / scale)
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn rest_has_no_energy_and_no_stress() {
    for_each_law(|name, law| {
        let response = Kinematics::new(&Gradient::zeros()).unwrap().response(law);
        assert_eq!(response.energy, 0.0, "{name}");
        assert_eq!(
            response.first_piola_kirchhoff_stress,
            Gradient::zeros(),
            "{name}"
        );
    });
}

#[test]
fn the_rest_tangent_is_the_incompressible_plane_stress_one() {
    // E₁₁₁₁ = 4μ, E₁₁₂₂ = 2μ, E₁₂₁₂ = μ, with μ the law's shear modulus (E = 3μ, ν = ½)
    for_each_law(|name, law| {
        let mu = law.shear_modulus();
        let tangent = Kinematics::new(&Gradient::zeros())
            .unwrap()
            .response(law)
            .tangent;
        for (entry, expected) in [
            ((0, 0), 4.0),
            ((3, 3), 4.0),
            ((0, 3), 2.0),
            ((1, 1), 1.0),
            ((1, 2), 1.0),
        ] {
            assert!(
                (tangent[entry] / mu - expected).abs() < 1e-12,
                "{name} {entry:?}"
            );
        }
    });
}

#[test]
fn stress_is_the_derivative_of_the_energy() {
    for_each_law(|name, law| {
        for h in STATES.map(gradient) {
            let exact = stress(law, &h);
            for i in 0..4 {
                let energy = |step: f64| {
                    let mut moved = h;
                    moved[i] += step;
                    Kinematics::new(&moved).unwrap().stress(law).0
                };
                let error = best_difference(exact[i], exact.norm(), energy);
                assert!(error < 1e-8, "{name} {h:?} component {i}: {error:.1e}");
            }
        }
    });
}

#[test]
fn tangent_is_the_derivative_of_the_stress_and_symmetric() {
    for_each_law(|name, law| {
        for h in STATES.map(gradient) {
            let tangent = Kinematics::new(&h).unwrap().response(law).tangent;
            assert!(
                (tangent - tangent.transpose()).norm() < 1e-14 * tangent.norm(),
                "{name}"
            );
            for (i, k) in (0..16).map(|n| (n / 4, n % 4)) {
                let component = |step: f64| {
                    let mut moved = h;
                    moved[k] += step;
                    stress(law, &moved)[i]
                };
                let error = best_difference(tangent[(i, k)], tangent.norm(), component);
                assert!(error < 1e-8, "{name} {h:?} ({i}, {k}): {error:.1e}");
            }
        }
    });
}

#[test]
fn a_rotation_changes_nothing_but_the_frame() {
    let rotation = nalgebra::Rotation2::new(0.7).into_inner();
    for_each_law(|name, law| {
        for h in STATES {
            let f = Matrix2::new(1.0 + h[0], h[1], h[2], 1.0 + h[3]);
            let turn = |m: Matrix2<f64>| {
                Vector4::new(m[(0, 0)] - 1.0, m[(0, 1)], m[(1, 0)], m[(1, 1)] - 1.0)
            };
            let p = stress(law, &gradient(h));
            let p = Matrix2::new(p[0], p[1], p[2], p[3]);
            let matrix = |v: Gradient| Matrix2::new(v[0], v[1], v[2], v[3]);
            let objective = matrix(stress(law, &turn(rotation * f))) - rotation * p;
            let isotropic = matrix(stress(law, &turn(f * rotation))) - p * rotation;
            assert!(objective.norm() < 1e-12 * (1.0 + p.norm()), "{name}");
            assert!(isotropic.norm() < 1e-12 * (1.0 + p.norm()), "{name}");
        }
    });
}

#[test]
fn the_sheet_reproduces_the_closed_form_curves() {
    for_each_law(|name, law| {
        for lambda in [0.7, 0.95, 1.0 + 1e-8, 1.3, 2.0, 2.5_f64] {
            let sheet = |h22: f64| stress(law, &gradient([lambda - 1.0, 0.0, 0.0, h22]))[0];
            let lateral = -((lambda - 1.0) / (lambda + lambda.sqrt())); // λ^-1/2 − 1
            let scale = law.youngs_modulus() * (lambda - 1.0_f64).abs();
            for (mode, found, expected) in [
                (
                    "uniaxial",
                    sheet(lateral),
                    uniaxial::uniaxial(law, lambda - 1.0).nominal_stress,
                ),
                ("planar", sheet(0.0), uniaxial::planar(law, lambda)),
                (
                    "equibiaxial",
                    sheet(lambda - 1.0),
                    uniaxial::equibiaxial(law, lambda),
                ),
            ] {
                let error = (found - expected).abs() / expected.abs().max(scale);
                // The stretch itself is known to 2e-16/(λ − 1) only.
                let tolerance = 1e-13 + 4e-16 / (lambda - 1.0).abs();
                assert!(error < tolerance, "{name} {mode} at {lambda}: {error:.1e}");
            }
        }
    });
}

#[test]
fn the_uniaxial_slope_is_the_derivative_of_the_curve_and_the_stress_of_the_energy() {
    for_each_law(|name, law| {
        for x in [-0.3, -1e-3, 1e-3, 0.2, 1.0] {
            let exact = uniaxial::uniaxial(law, x);
            let curve = |step: f64| uniaxial::uniaxial(law, x + step).nominal_stress;
            let energy = |step: f64| uniaxial::uniaxial(law, x + step).energy;
            // Steps must stay on one side of rest.
            let scaled = |function: &dyn Fn(f64) -> f64, exact: f64| {
                best_difference(exact * x.abs(), exact.abs() * x.abs(), |step| {
                    function(step * x.abs())
                })
            };
            assert!(scaled(&curve, exact.slope) < 1e-8, "{name} at {x}");
            assert!(
                scaled(&energy, exact.nominal_stress) < 1e-8,
                "{name} at {x}"
            );
        }
    });
}

#[test]
fn no_digit_is_lost_near_rest() {
    // Small-strain limit with the first correction: P(1 + x) = E₀ x + O(x²), both from exact numbers.
    for_each_law(|name, law| {
        let x = 1e-8;
        let e = law.youngs_modulus();
        let response = uniaxial::uniaxial(law, x);
        assert!(
            (response.nominal_stress / (e * x) - 1.0).abs() < 1e-7,
            "{name}"
        );
        assert!((response.slope / e - 1.0).abs() < 1e-6, "{name}");
        // Homogeneity in the first two orders by Richardson: free of the O(x²) term.
        let half = uniaxial::uniaxial(law, x / 2.0).nominal_stress;
        let linear = 4.0 * half - response.nominal_stress;
        assert!(
            (linear / (e * x) - 1.0).abs() < 1e-12,
            "{name}: {:.1e}",
            linear / (e * x) - 1.0
        );
    });
}

#[test]
fn an_inverted_or_infinite_state_is_refused() {
    for h in [
        [-1.0, 0.0, 0.0, 0.0],
        [-2.0, 0.0, 0.0, 0.0],
        [f64::NAN, 0.0, 0.0, 0.0],
        [1e300, 0.0, 0.0, 1e300],
    ] {
        assert!(Kinematics::new(&gradient(h)).is_err(), "{h:?}");
    }
}

#[test]
fn eq_24_is_reproduced_exactly() {
    let card = Card::load("pva-10", Path::new(".")).unwrap();
    let cauchy = Card::load("pva-10-cauchy", Path::new(".")).unwrap();
    for strain in [0.0, 1e-6, 0.15, 0.5, 1.0_f64] {
        let published = 0.0611 * (2.2347 * strain).exp_m1();
        let nominal = uniaxial::uniaxial(&*card.law, strain).nominal_stress;
        let true_stress = uniaxial::uniaxial(&*cauchy.law, strain).nominal_stress * (1.0 + strain);
        assert!((nominal - published).abs() <= 1e-14 * published, "{strain}");
        assert!(
            (true_stress - published).abs() <= 1e-14 * published,
            "{strain}"
        );
    }
}

#[test]
fn a_law_without_the_second_invariant_is_its_limit() {
    let limit = super::MooneyRivlin {
        c10: 0.05,
        c01: 0.0,
    };
    let neo_hooke = super::NeoHooke { c10: 0.05 };
    for h in STATES.map(gradient) {
        assert_eq!(stress(&limit, &h), stress(&neo_hooke, &h));
    }
}
