//! The tests that every law must pass, shipped cards and a synthetic law alike.

use std::sync::Arc;

use nalgebra::{Matrix2, Vector4};

use super::curve::{self, Mode};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::registry::LAWS;
use super::samples;
use super::sheet::{COMPONENTS, Kinematics, PlaneTensor};

mod anisotropic;
mod changing_volume;
mod particular;

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

fn for_each_law(test: impl Fn(&str, &dyn HyperelasticLaw)) {
    test("synthetic", &Synthetic);
    for (name, law) in samples::all() {
        test(name, &*law);
    }
    for (name, law) in changing_volume::sheets() {
        test(&name, &*law);
    }
}

type NamedLaws = Vec<(String, Arc<dyn HyperelasticLaw>)>;

#[test]
fn every_law_of_the_registry_is_tested() {
    let mut cards = samples::cards();
    cards.extend(samples::changing_volume());
    for law in LAWS {
        assert!(
            cards.iter().any(|card| card.law_name == law.name),
            "{}",
            law.name
        );
    }
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

fn gradient(h: [f64; 4]) -> PlaneTensor {
    Vector4::from(h)
}

fn stress(law: &dyn HyperelasticLaw, h: &PlaneTensor) -> PlaneTensor {
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
            PlaneTensor::zeros(),
            "{name}"
        );
    });
}

#[test]
fn the_rest_tangent_is_the_incompressible_plane_stress_one() {
    // E₁₁₁₁ = 4μ, E₁₁₂₂ = 2μ, E₁₂₁₂ = μ, with μ the law's shear modulus (E = 3μ, ν = ½)
    for (name, law) in samples::all() {
        let mu = law.shear_modulus();
        if !law.is_isotropic() {
            continue;
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
    }
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
            let matrix = |v: PlaneTensor| Matrix2::new(v[0], v[1], v[2], v[3]);
            let objective = matrix(stress(law, &turn(rotation * f))) - rotation * p;
            let isotropic = matrix(stress(law, &turn(f * rotation))) - p * rotation;
            let turned = objective.norm() < 1e-12 * (1.0 + p.norm());
            assert_eq!(turned, law.is_objective(), "{name}");
            if !law.is_objective() {
                continue;
            }
            let alike = isotropic.norm() < 1e-12 * (1.0 + p.norm());
            assert_eq!(alike, law.is_isotropic(), "{name}");
        }
    });
}

#[test]
fn biaxial_stresses_are_those_of_the_sheet() {
    for_each_law(|name, law| {
        for strains in [[0.5, 0.2], [1.0, -0.2], [-0.3, 0.1], [1e-8, 3e-9]] {
            let sheet = stress(law, &gradient([strains[0], 0.0, 0.0, strains[1]]));
            let computed = law.biaxial(strains);
            for (computed, exact) in computed.iter().zip([sheet[0], sheet[3]]) {
                let scale = sheet.norm();
                assert!(
                    (computed - exact).abs() < 1e-13 * scale,
                    "{name} {strains:?}"
                );
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
        crate::assert_near(response.nominal_stress, e * x, 1e-7, &name);
        assert!((response.slope / e - 1.0).abs() < 1e-6, "{name}");
        // Homogeneity in the first two orders by Richardson: free of the O(x²) term.
        let half = strip(law, x / 2.0);
        let linear = 4.0 * half - response.nominal_stress;
        crate::assert_near(linear, e * x, 1e-12, &name);
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

/// Many points at once have the bits of each point by itself, whatever the machine's vectors.
#[test]
fn many_points_at_once_are_each_point_by_itself() {
    for_each_law(|name, law| {
        let gradient = |point: usize| {
            let x = |k: usize| ((point * 37 + k * 11) % 101) as f64 / 101.0;
            PlaneTensor::new(0.4 * x(0), 0.2 * x(1) - 0.1, 0.2 * x(2) - 0.1, -0.2 * x(3))
        };
        let points = 53;
        let lines: [Vec<f64>; 4] =
            std::array::from_fn(|k| (0..points).map(|point| gradient(point)[k]).collect());
        let gradients = lines.each_ref().map(|line| &line[..]);
        let mut stresses: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; points]);
        let mut responses: [Vec<f64>; COMPONENTS] = std::array::from_fn(|_| vec![0.0; points]);
        assert!(law.stresses(gradients, stresses.each_mut().map(|p| &mut p[..])));
        assert!(law.responses(gradients, responses.each_mut().map(|a| &mut a[..]), true));
        for point in 0..points {
            let kinematics = Kinematics::new(&gradient(point)).unwrap();
            let (_, stress) = law.stress(&kinematics);
            for k in 0..4 {
                assert_eq!(stresses[k][point], stress[k], "{name}");
            }
            let alone = law.response(&kinematics);
            assert_eq!(responses[0][point], alone.energy, "{name}");
            for k in 0..4 {
                let stress = alone.first_piola_kirchhoff_stress[k];
                assert_eq!(responses[1 + k][point], stress, "{name}");
            }
            let entries = (0..4).flat_map(|column| (column..4).map(move |row| (row, column)));
            for (entry, values) in entries.zip(&responses[5..]) {
                assert_eq!(values[point], alone.tangent[entry], "{name} {entry:?}");
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
