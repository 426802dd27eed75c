//! What particular laws must reproduce.

use std::path::Path;

use super::*;
use crate::material::curve;
use crate::material::{Card, Gent, MooneyRivlin, NeoHooke};

pub(super) fn sample(law: &str, parameters: &str) -> Arc<dyn HyperelasticLaw> {
    samples::card(law, parameters).law
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
    near(
        modulus("mooney-rivlin-5", &samples::parameters("mooney-rivlin-5")),
        0.1,
    );
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
    let exact = strip(&NeoHooke { c10: 0.025 }, 0.8);
    for (law, parameters) in [
        ("gent", "mu = \"0.05 MPa\"\njm = 1e12"),
        ("fung-demiray", "mu = \"0.05 MPa\"\nb = 1e-12"),
        ("arruda-boyce", "mu = \"0.05 MPa\"\nlambda_m = 1e6"),
        (
            "yeoh",
            "c10 = \"0.025 MPa\"\nc20 = \"0 MPa\"\nc30 = \"0 MPa\"",
        ),
    ] {
        near(strip(&*sample(law, parameters), 0.8), exact);
    }
}

#[test]
fn a_chain_beyond_its_limit_has_no_energy() {
    let gent = Gent { mu: 0.05, jm: 2.0 };
    let state = Invariants {
        i1_minus_3: 2.1,
        i2_minus_3: 1.0,
    };
    assert!(!gent.evaluate(state).energy.is_finite());
}

/// Closed forms of the tests for a law Ψ(I₁, I₂), by λ.
///
/// ```text
/// planar       P = 2 (Ψ₁ + Ψ₂) (λ − λ⁻³)        I₁ = I₂ = λ² + 1 + λ⁻²
/// equibiaxial  P = 2 (Ψ₁ + λ² Ψ₂) (λ − λ⁻⁵)     I₁ = 2λ² + λ⁻⁴        I₂ = λ⁴ + 2λ⁻²
/// shear        P = 2 (Ψ₁ + Ψ₂) γ                I₁ = I₂ = 3 + γ²
/// ```
fn closed_form(law: &dyn InvariantLaw, mode: Option<Mode>, x: f64) -> f64 {
    let at = |i1_minus_3: f64, i2_minus_3: f64| {
        law.evaluate(Invariants {
            i1_minus_3,
            i2_minus_3,
        })
    };
    let lambda = 1.0 + x;
    match mode {
        Some(Mode::Planar) => {
            let excess = (x * (2.0 + x) / lambda).powi(2);
            let w = at(excess, excess);
            2.0 * (w.d1 + w.d2) * (lambda - lambda.powi(-3))
        }
        Some(Mode::Equibiaxial) => {
            let d = x * (2.0 + x);
            let square = 1.0 + d;
            let w = at(
                d * d * (3.0 + 2.0 * d) / (square * square),
                d * d * (3.0 + d) / square,
            );
            2.0 * (w.d1 + square * w.d2) * (lambda - lambda.powi(-5))
        }
        _ => {
            let w = at(x * x, x * x);
            2.0 * (w.d1 + w.d2) * x
        }
    }
}

#[test]
fn the_sheet_reproduces_the_closed_form_curves() {
    for x in [-0.3, -0.05, 0.3, 1.0, 1.5] {
        for mode in [Some(Mode::Planar), Some(Mode::Equibiaxial), None] {
            let computed = match mode {
                Some(mode) => mode.nominal_stress(&Synthetic, x),
                None => curve::simple_shear(&Synthetic, x),
            };
            let expected = closed_form(&Synthetic, mode, x);
            assert!((computed / expected - 1.0).abs() < 1e-13, "{mode:?} at {x}");
        }
    }
}

/// An independent form of the energy: principal stretches from the eigenvalues of C.
#[test]
fn ogden_has_the_energy_of_its_principal_stretches() {
    let law = sample("ogden-3", &samples::parameters("ogden-3"));
    let terms = [[0.04, 1.3], [0.001, 5.0], [0.01, -2.5_f64]];
    for h in STATES {
        let f = Matrix2::new(1.0 + h[0], h[1], h[2], 1.0 + h[3]);
        let squares = (f.transpose() * f).symmetric_eigenvalues();
        let stretches = [
            squares[0].sqrt(),
            squares[1].sqrt(),
            1.0 / f.determinant().abs(),
        ];
        let expected: f64 = terms
            .iter()
            .map(|[mu, alpha]| {
                let sum: f64 = stretches.iter().map(|stretch| stretch.powf(*alpha)).sum();
                2.0 * mu / (alpha * alpha) * (sum - 3.0)
            })
            .sum();
        let computed = law.stress(&Kinematics::new(&gradient(h)).unwrap()).0;
        assert!(
            (computed - expected).abs() < 1e-14 + 1e-9 * expected,
            "{h:?}: {computed} {expected}"
        );
    }
}

#[test]
fn ogden_with_powers_of_two_is_mooney_rivlin_in_both_conventions() {
    let exact = MooneyRivlin {
        c10: 0.02,
        c01: 0.005,
    };
    let ogden = sample("ogden-2", &samples::parameters("ogden-2"));
    let other = sample(
        "ogden-2",
        "mu_1 = \"0.04 MPa\"\nalpha_1 = 2\nmu_2 = \"0.01 MPa\"\nalpha_2 = -2\nconvention = \"2mu/alpha^2\"",
    );
    for h in STATES.map(gradient) {
        let expected = stress(&exact, &h);
        for law in [&ogden, &other] {
            assert!((stress(&**law, &h) - expected).norm() < 1e-14, "{h:?}");
        }
    }
}

#[test]
fn eq_24_is_reproduced_exactly() {
    let card = Card::load("pva-10", Path::new(".")).unwrap();
    let cauchy = Card::load("pva-10-cauchy", Path::new(".")).unwrap();
    for strain in [0.0, 1e-6, 0.15, 0.5, 1.0_f64] {
        let published = 0.0611 * (2.2347 * strain).exp_m1();
        let nominal = strip(&*card.law, strain);
        let true_stress = strip(&*cauchy.law, strain) * (1.0 + strain);
        assert!((nominal - published).abs() <= 1e-14 * published, "{strain}");
        assert!(
            (true_stress - published).abs() <= 1e-14 * published,
            "{strain}"
        );
    }
}

#[test]
fn a_law_without_the_second_invariant_is_its_limit() {
    let limit = MooneyRivlin {
        c10: 0.05,
        c01: 0.0,
    };
    let neo_hooke = NeoHooke { c10: 0.05 };
    for h in STATES.map(gradient) {
        assert_eq!(stress(&limit, &h), stress(&neo_hooke, &h));
    }
}
