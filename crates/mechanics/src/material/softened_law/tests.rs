use std::f64::consts::PI;
use std::sync::Arc;

use super::*;
use crate::material::curve::Mode;
use crate::material::{Card, NeoHooke, samples};

const RUBBER: Softening = Softening {
    r: 2.1,
    m: 0.01,
    beta: 0.1,
};

/// Laws with several widths, among them those of m or β alone.
fn softenings() -> [Softening; 3] {
    let [of_m, of_beta] = [(0.02, 0.0), (0.0, 0.3)].map(|(m, beta)| Softening { r: 1.6, m, beta });
    [RUBBER, of_m, of_beta]
}

/// W₀ = C₁₀ (I₁ − 3) and P₀ of neo-Hooke, by hand.
fn neo_hooke(c10: f64, mode: Mode, l: f64) -> [f64; 2] {
    match mode {
        Mode::Uniaxial => [c10 * (l * l + 2.0 / l - 3.0), 2.0 * c10 * (l - l.powi(-2))],
        Mode::Planar => [
            c10 * (l * l + l.powi(-2) - 2.0),
            2.0 * c10 * (l - l.powi(-3)),
        ],
        Mode::Equibiaxial => [
            c10 * (2.0 * l * l + l.powi(-4) - 3.0),
            2.0 * c10 * (l - l.powi(-5)),
        ],
    }
}

/// erf by the series 2/√π e^(−x²) Σ 2ⁿ x²ⁿ⁺¹/(2n + 1)!!, another way than the library's.
fn erf(x: f64) -> f64 {
    if x > 6.0 {
        return 1.0;
    }
    let mut term = x;
    let mut sum = x;
    for n in 1..300 {
        term *= 2.0 * x * x / f64::from(2 * n + 1);
        sum += term;
    }
    2.0 / PI.sqrt() * (-x * x).exp() * sum
}

#[test]
fn the_usual_tests_unload_as_the_formula_of_ogden_and_roxburgh_says() {
    let c10 = 0.3;
    for softening in softenings() {
        for (name, mode) in Mode::ALL {
            let [most, _] = neo_hooke(c10, mode, 1.8);
            let law = SoftenedLaw {
                virgin: Arc::new(NeoHooke { c10 }),
                softening,
                largest_energy: most,
            };
            for stretch in [1.05, 1.3, 1.7, 1.8, 2.2] {
                let [energy, stress] = neo_hooke(c10, mode, stretch);
                let x = (most - energy).max(0.0) / (softening.m + softening.beta * most);
                let expected = stress * (1.0 - erf(x) / softening.r);
                let computed = mode.nominal_stress(&law, stretch - 1.0);
                crate::assert_near(computed, expected, 1e-12, &(&name, &stretch));
            }
        }
    }
}

/// The work of a cycle by Gauss points is the closed form of D, and Ψ is the work on the way back.
#[test]
fn the_work_of_a_cycle_is_what_is_dissipated() {
    let gauss = |function: &dyn Fn(f64) -> f64, [low, high]: [f64; 2]| {
        let cells = 400;
        let h = (high - low) / f64::from(cells);
        let point = |cell: i32, position: f64| low + h * (f64::from(cell) + 0.5 + position);
        let root = 0.5 / 3.0_f64.sqrt();
        let pairs = |cell| function(point(cell, -root)) + function(point(cell, root));
        (0..cells).map(|cell| 0.5 * h * pairs(cell)).sum::<f64>()
    };
    for softening in softenings() {
        for (name, virgin) in samples::all() {
            let top = 0.4;
            let most = virgin.tension([1.0, 0.0], top).energy;
            let back = SoftenedLaw {
                virgin: Arc::clone(&virgin),
                softening,
                largest_energy: most,
            };
            let stress =
                |law: &dyn HyperelasticLaw, x: f64| law.tension([1.0, 0.0], x).nominal_stress;
            let up = gauss(&|x| stress(&*virgin, x), [0.0, top]);
            let down = |to: f64| gauss(&|x| stress(&back, x), [to, top]);
            let dissipated = softening.dissipated(most);
            assert!(dissipated > 0.0 && dissipated < most, "{name}");
            let cycle = up - down(0.0);
            assert!(
                (cycle - dissipated).abs() < 1e-7 * most,
                "{name}: {cycle} {dissipated}"
            );
            let half = back.tension([1.0, 0.0], 0.5 * top).energy;
            assert!((up - down(0.5 * top) - half).abs() < 1e-7 * most, "{name}");
        }
    }
}

/// ∂Ψ/∂F = P and ∂P/∂F by differences, in the middle of the transition and away from it, for all laws and sheets.
#[test]
fn stress_and_tangent_are_derivatives_of_the_energy() {
    let plane_strain = samples::changing_volume()
        .into_iter()
        .filter_map(|card| card.law.in_plane_strain());
    let of_bodies = samples::changing_volume().into_iter().map(|card| card.law);
    let laws = samples::all().into_iter().map(|(_, law)| law);
    for virgin in laws.chain(of_bodies).chain(plane_strain) {
        for (softening, share) in softenings().into_iter().zip([0.97, 0.7, 0.9]) {
            let h = [0.3, 0.08, -0.05, 0.12];
            let at = |h: [f64; 4]| Kinematics::new(&PlaneTensor::from(h)).unwrap();
            let (energy, _) = virgin.stress(&at(h));
            let law = SoftenedLaw {
                virgin: Arc::clone(&virgin),
                softening: Softening {
                    m: softening.m * energy / 0.05,
                    ..softening
                },
                largest_energy: energy / share,
            };
            let response = law.response(&at(h));
            let (_, alone) = law.stress(&at(h));
            assert!((alone - response.first_piola_kirchhoff_stress).norm() < 1e-14 * alone.norm());
            for component in 0..4 {
                let moved = |step: f64| {
                    let mut h = h;
                    h[component] += step;
                    law.stress(&at(h))
                };
                let slope = |step: f64| {
                    let ((up, p), (down, q)) = (moved(step), moved(-step));
                    ((up - down) / (2.0 * step), (p - q) / (2.0 * step))
                };
                // Richardson's extrapolation of two steps.
                let ((e1, p1), (e2, p2)) = (slope(2e-4), slope(1e-4));
                let (by_energy, column) = ((4.0 * e2 - e1) / 3.0, (4.0 * p2 - p1) / 3.0);
                let stress = response.first_piola_kirchhoff_stress;
                let error = (by_energy - stress[component]).abs() / stress.norm();
                assert!(error < 1e-7, "{virgin:?} {softening:?}: {error:.1e}");
                let tangent = response.tangent.column(component);
                let error = (column - tangent).norm() / response.tangent.norm();
                assert!(error < 1e-7, "{virgin:?} {softening:?}: {error:.1e}");
            }
            assert!(
                (response.tangent - response.tangent.transpose()).norm()
                    < 1e-12 * response.tangent.norm()
            );
        }
    }
}

/// A rotation of the deformed sheet turns the stress; beyond the largest energy, and with a huge r, nothing softens.
#[test]
fn softening_is_objective_and_ends_where_it_should() {
    let virgin: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.2 });
    let law = |r: f64, largest_energy: f64| SoftenedLaw {
        virgin: Arc::clone(&virgin),
        softening: Softening { r, ..RUBBER },
        largest_energy,
    };
    let f = nalgebra::Matrix2::new(1.4, 0.2, -0.1, 0.9);
    let state = |f: nalgebra::Matrix2<f64>| {
        Kinematics::new(&PlaneTensor::new(f.m11 - 1.0, f.m12, f.m21, f.m22 - 1.0)).unwrap()
    };
    let turn = nalgebra::Rotation2::new(0.6).into_inner();
    let softened = law(2.0, 0.1);
    let p = |kinematics| {
        let (_, p) = softened.stress(&kinematics);
        nalgebra::Matrix2::new(p[0], p[1], p[2], p[3])
    };
    assert!((p(state(turn * f)) - turn * p(state(f))).norm() < 1e-14);
    let (energy, stress) = virgin.stress(&state(f));
    assert!(energy < 0.1 && p(state(f)).norm() < 0.95 * stress.norm());
    for same in [law(2.0, 0.9 * energy), law(2.0, energy)] {
        assert_eq!(same.stress(&state(f)), (energy, stress));
    }
    let (_, hardly) = law(1e6, 0.1).stress(&state(f));
    assert!((hardly - stress).norm() < 2e-6 * stress.norm());
}

#[test]
fn a_card_says_how_its_material_softens() {
    let plain = Card::load("neo-hooke", std::path::Path::new(".")).unwrap();
    let with = |softening: &str| {
        let text = format!("{}\n[softening]\n{softening}", plain.text);
        Card::parse("x", "x.toml", &text).map_err(|fault| fault.to_string())
    };
    assert!(plain.law.softening().is_none());
    let card = with("r = 2.1\nm = \"10 kPa\"\nbeta = 0.1").unwrap();
    assert_eq!(card.law.softening(), Some(RUBBER));
    let alone = with("r = 2.1\nbeta = 0.1").unwrap().law.softening();
    assert_eq!(alone.unwrap().m, 0.0);
    let [first, soft] = [&plain, &card].map(|card| card.law.tension([1.0, 0.0], 0.3));
    assert_eq!(first, soft);
    for (text, message) in [
        ("r = 0.9\nm = \"1 kPa\"", "greater than 1"),
        ("r = 2\nm = \"0 kPa\"", "both be zero"),
        ("r = 2\nm = 0.1", "unit"),
        ("r = 2\nm = \"1 kPa\"\nbetta = 0.1", "did you mean `beta`"),
    ] {
        let fault = with(text).unwrap_err();
        assert!(fault.contains(message), "{fault}");
    }
}
