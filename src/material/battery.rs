//! The tests that every law must pass, shipped cards and a synthetic law alike.

use std::path::Path;
use std::sync::Arc;

use nalgebra::{Matrix2, Vector4};

use super::curve::{self, Mode};
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::{HyperelasticLaw, InvariantLaw};
use super::registry::LAWS;
use super::samples::{self, SAMPLES};
use super::sheet::{Gradient, Kinematics};
use super::{Card, Gent, NeoHooke};

/// All derivatives non-zero and all different, so that no slip in the chain rule can hide.
#[derive(Debug)]
struct Synthetic;

impl InvariantLaw for Synthetic {
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

fn sample(law: &str, parameters: &str) -> Arc<dyn HyperelasticLaw> {
    samples::card(law, parameters).law
}

fn for_each_law(test: impl Fn(&str, &dyn HyperelasticLaw)) {
    test("synthetic", &Synthetic);
    for (name, law) in samples::all() {
        test(name, &*law);
    }
}

#[test]
fn every_law_of_the_registry_is_tested() {
    let cards = samples::cards();
    for law in LAWS {
        assert!(
            cards.iter().any(|card| card.law_name == law.name),
            "{}",
            law.name
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

const STATES: [[f64; 4]; 5] = [
    [0.1, 0.02, -0.03, -0.05],
    [0.9, 0.1, 0.2, -0.3],
    [-0.2, 0.15, 0.1, 0.3],
    [0.4, -0.3, 0.3, 0.5],
    [1e-3, 2e-3, -1e-3, 5e-4],
];

fn strip(law: &dyn HyperelasticLaw, strain: f64) -> f64 {
    law.tension([1.0, 0.0], strain).nominal_stress
}

fn gradient(h: [f64; 4]) -> Gradient {
    Vector4::from(h)
}

fn stress(law: &dyn HyperelasticLaw, h: &Gradient) -> Gradient {
    law.stress(&Kinematics::new(h).unwrap()).1
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
        let response = law.response(&Kinematics::rest());
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
        if !law.is_isotropic() {
            return;
        }
        let tangent = law.response(&Kinematics::rest()).tangent;
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
                    law.stress(&Kinematics::new(&moved).unwrap()).0
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
            let tangent = law.response(&Kinematics::new(&h).unwrap()).tangent;
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
            let alike = isotropic.norm() < 1e-12 * (1.0 + p.norm());
            assert_eq!(alike, law.is_isotropic(), "{name}");
        }
    });
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
            let found = match mode {
                Some(mode) => mode.nominal_stress(&Synthetic, x),
                None => curve::simple_shear(&Synthetic, x),
            };
            let expected = closed_form(&Synthetic, mode, x);
            assert!((found / expected - 1.0).abs() < 1e-13, "{mode:?} at {x}");
        }
    }
}

#[test]
fn biaxial_stresses_are_those_of_the_sheet() {
    for_each_law(|name, law| {
        for strains in [[0.5, 0.2], [1.0, -0.2], [-0.3, 0.1], [1e-8, 3e-9]] {
            let sheet = stress(law, &gradient([strains[0], 0.0, 0.0, strains[1]]));
            let found = law.biaxial(strains);
            for (found, exact) in found.iter().zip([sheet[0], sheet[3]]) {
                let scale = sheet.norm();
                assert!((found - exact).abs() < 1e-13 * scale, "{name} {strains:?}");
            }
        }
    });
}

#[test]
fn the_tension_curve_is_that_of_a_strip_with_free_edges() {
    for_each_law(|name, law| {
        for x in [-0.3, -0.05, 1e-8, 0.3, 1.0, 1.5] {
            let curve = law.tension([1.0, 0.0], x);
            let strip = curve::tension(&|kinematics| law.response(kinematics), x);
            let scale = law.youngs_modulus() * f64::abs(x);
            let error = (curve.nominal_stress - strip.nominal_stress).abs() / scale;
            assert!(error < 1e-10, "{name} at {x}: {error:.1e}");
            let error = (curve.slope / strip.slope - 1.0).abs();
            assert!(error < 1e-6, "{name} at {x}: slope {error:.1e}");
        }
    });
}

/// An independent form of the energy: principal stretches from the eigenvalues of C.
#[test]
fn ogden_has_the_energy_of_its_principal_stretches() {
    let law = sample("ogden-3", SAMPLES[9].1);
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
        let found = law.stress(&Kinematics::new(&gradient(h)).unwrap()).0;
        assert!(
            (found - expected).abs() < 1e-14 + 1e-9 * expected,
            "{h:?}: {found} {expected}"
        );
    }
}

#[test]
fn ogden_with_powers_of_two_is_mooney_rivlin_in_both_conventions() {
    let exact = super::MooneyRivlin {
        c10: 0.02,
        c01: 0.005,
    };
    let ogden = sample("ogden-2", SAMPLES[8].1);
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

/// Stress and tangent at equal principal stretches, where eigenvectors have no direction, and beside it.
#[test]
fn the_tangent_is_smooth_where_the_principal_stretches_meet() {
    for_each_law(|name, law| {
        let tangent = |x: f64| {
            let h = gradient([0.3 + x, 0.5 * x, 0.2 * x, 0.3 - x]);
            law.response(&Kinematics::new(&h).unwrap()).tangent
        };
        let at = tangent(0.0);
        for x in [1e-9, 1e-6, 6e-3, 8e-3] {
            let change = (tangent(x) - at).norm() / at.norm();
            assert!(change < 30.0 * x + 1e-7, "{name} at {x}: {change:.1e}");
        }
    });
}

/// The strip's stress near rest, to the second order of its curve, in every mode.
#[test]
fn no_digit_of_stress_and_tangent_is_lost_near_rest() {
    for_each_law(|name, law| {
        let stress_by_strain = |h: [f64; 4], x: f64| stress(law, &gradient(h.map(|v| v * x))) / x;
        for h in [
            [1.0, 0.0, 0.0, -0.5],
            [1.0, 0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 1.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.6, 0.3, -0.2, 0.4],
        ] {
            // Richardson's extrapolation is free of the first-order change of the secant.
            let extrapolated = |x: f64| 2.0 * stress_by_strain(h, 0.5 * x) - stress_by_strain(h, x);
            let (small, large) = (extrapolated(1e-8), extrapolated(1e-6));
            let error = (small - large).norm() / large.norm();
            assert!(error < 1e-10, "{name} {h:?}: stress {error:.1e}");
            let tangent = |x: f64| {
                let h = gradient(h.map(|v| v * x));
                law.response(&Kinematics::new(&h).unwrap()).tangent
            };
            let extrapolated = |x: f64| 2.0 * tangent(0.5 * x) - tangent(x);
            let (small, large) = (extrapolated(1e-8), extrapolated(1e-6));
            let error = (small - large).norm() / large.norm();
            assert!(error < 1e-10, "{name} {h:?}: tangent {error:.1e}");
        }
    });
}

#[test]
fn a_strip_along_the_fibres_is_stiffer_than_one_across() {
    let aligned = sample(
        "holzapfel-gasser-ogden",
        "mu = \"0.02 MPa\"\nk1 = \"0.03 MPa\"\nk2 = 0.3\nkappa = 0\nangle = \"0 deg\"\nfamilies = \"one\"",
    );
    let along = aligned.tension([1.0, 0.0], 0.2).nominal_stress;
    let across = aligned.tension([0.0, 1.0], 0.2).nominal_stress;
    let neo_hooke = strip(&NeoHooke { c10: 0.01 }, 0.2);
    // Fibres along: P = P_matrix + 2 λ k₁ E e^(k₂ E²), E = λ² − 1.
    let e: f64 = 1.2 * 1.2 - 1.0;
    let expected = neo_hooke + 2.0 * 1.2 * 0.03 * e * (0.3 * e * e).exp();
    assert!((along / expected - 1.0).abs() < 1e-13, "{along} {expected}");
    // Across, the fibres are pressed and carry nothing.
    assert!(
        (across / neo_hooke - 1.0).abs() < 1e-13,
        "{across} {neo_hooke}"
    );
}

#[test]
fn the_uniaxial_slope_is_the_derivative_of_the_curve_and_the_stress_of_the_energy() {
    for_each_law(|name, law| {
        for x in [-0.3, -1e-3, 1e-3, 0.2, 1.0] {
            let exact = law.tension([1.0, 0.0], x);
            let curve = |step: f64| law.tension([1.0, 0.0], x + step).nominal_stress;
            let energy = |step: f64| law.tension([1.0, 0.0], x + step).energy;
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
        let response = law.tension([1.0, 0.0], x);
        assert!(
            (response.nominal_stress / (e * x) - 1.0).abs() < 1e-7,
            "{name}"
        );
        assert!((response.slope / e - 1.0).abs() < 1e-6, "{name}");
        // Homogeneity in the first two orders by Richardson: free of the O(x²) term.
        let half = strip(law, x / 2.0);
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
    let limit = super::MooneyRivlin {
        c10: 0.05,
        c01: 0.0,
    };
    let neo_hooke = super::NeoHooke { c10: 0.05 };
    for h in STATES.map(gradient) {
        assert_eq!(stress(&limit, &h), stress(&neo_hooke, &h));
    }
}

/// Many points at once have the bits of each point by itself, whatever the machine's vectors.
#[test]
fn many_points_at_once_are_each_point_by_itself() {
    for_each_law(|name, law| {
        let gradient = |point: usize| {
            let x = |k: usize| ((point * 37 + k * 11) % 101) as f64 / 101.0;
            Gradient::new(0.4 * x(0), 0.2 * x(1) - 0.1, 0.2 * x(2) - 0.1, -0.2 * x(3))
        };
        let points = 53;
        let lines: [Vec<f64>; 4] =
            std::array::from_fn(|k| (0..points).map(|point| gradient(point)[k]).collect());
        let gradients = lines.each_ref().map(|line| &line[..]);
        let mut stresses: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; points]);
        let mut tangents: [Vec<f64>; 10] = std::array::from_fn(|_| vec![0.0; points]);
        assert!(law.stresses(gradients, stresses.each_mut().map(|p| &mut p[..])));
        assert!(law.tangents(gradients, tangents.each_mut().map(|a| &mut a[..])));
        for point in 0..points {
            let kinematics = Kinematics::new(&gradient(point)).unwrap();
            let (_, stress) = law.stress(&kinematics);
            let tangent = law.response(&kinematics).tangent;
            for k in 0..4 {
                assert_eq!(stresses[k][point], stress[k], "{name}");
            }
            let entries = (0..4).flat_map(|column| (column..4).map(move |row| (row, column)));
            for (entry, values) in entries.zip(&tangents) {
                assert_eq!(values[point], tangent[entry], "{name} {entry:?}");
            }
        }
        let inverted = [&[0.0, -2.0][..], &[0.0; 2], &[0.0; 2], &[0.0; 2]];
        let mut two: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; 2]);
        assert!(
            !law.stresses(inverted, two.each_mut().map(|p| &mut p[..])),
            "{name}"
        );
    });
}
