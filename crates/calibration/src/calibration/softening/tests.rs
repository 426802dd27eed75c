//! Softening: what comes back of its parameters, and what its intervals hold.

use rayon::prelude::*;

use super::*;
use crate::assertions::assert_contains;
use crate::calibration::tests::helpers::assert_parameters;
use crate::calibration::*;
use crate::document::Statements;
use crate::material::registry::Law;
use crate::material::{Card, HyperelasticLaw, NeoHooke, Softening};
use crate::statistics::normal_numbers;

const TRUTH: Softening = Softening {
    r: 1.8,
    m: 0.012,
    beta: 0.15,
};
const C10: f64 = 0.21;

/// Three cycles to rising stretches and a fourth to the second one again, with `rows` rows a branch.
fn strains(rows: i32) -> Vec<f64> {
    let tops = [0.4, 0.8, 1.2, 0.8];
    let branch = |top: f64, row: i32| top * f64::from(row) / f64::from(rows);
    let cycle = |top: f64| {
        let up = (0..rows).map(move |row| branch(top, row));
        up.chain((1..=rows).rev().map(move |row| branch(top, row)))
    };
    tops.into_iter().flat_map(cycle).chain([0.0]).collect()
}

/// A file of such cycles of neo-Hooke with the true softening, and white noise.
fn record(test: &str, noise: f64, seed: u64) -> TestData {
    record_after(0.0, test, noise, seed)
}

/// The same of a specimen that was stretched before, to a strain that the file need not state.
fn record_after(earlier: f64, test: &str, noise: f64, seed: u64) -> TestData {
    let law = NeoHooke { c10: C10 };
    let mut normal = normal_numbers(seed);
    let state = |x: f64| match test {
        "uniaxial" => {
            let actual = law.tension([1.0, 0.0], x);
            [actual.nominal_stress, actual.energy]
        }
        // Both stretches are equal: 2 P dλ is the work.
        _ => {
            let l: f64 = 1.0 + x;
            let energy = C10 * (2.0 * l * l + l.powi(-4) - 3.0);
            [2.0 * C10 * (l - l.powi(-5)), energy]
        }
    };
    let [_, mut most] = state(earlier);
    let mut text = format!("# test: {test}\nstretch [-],nominal_stress [MPa]\n");
    for x in strains(30) {
        let [stress, energy] = state(x);
        most = most.max(energy);
        let [factor, _] = TRUTH.factor(energy, most);
        text += &format!("{},{}\n", 1.0 + x, factor * stress + noise * normal());
    }
    let mut reading = Statements::new();
    reading.insert("cycle".into(), "all".into());
    TestData::parse("cycles.csv", &text, &reading).unwrap()
}

fn fitted(tests: &[TestData]) -> Fit {
    let law = Base::Law(Law::named("neo-hooke").unwrap());
    fit_softening(law, tests, &FitSettings::default()).unwrap()
}

const VALUES: [f64; 4] = [C10, TRUTH.r, TRUTH.m, TRUTH.beta];

#[test]
fn exact_cycles_give_the_parameters_back() {
    for tests in [
        vec![record("uniaxial", 0.0, 0)],
        vec![record("equibiaxial", 0.0, 0)],
        vec![record("uniaxial", 0.0, 0), record("equibiaxial", 0.0, 0)],
    ] {
        let fit = fitted(&tests);
        assert_parameters(&fit, &VALUES, 1e-6);
        let cycles = &fit.softened.as_ref().unwrap().cycles;
        assert_eq!(cycles.len(), 4 * tests.len());
        for cycle in cycles {
            assert!((cycle.measured - cycle.fitted).abs() < 1e-8, "{cycle:?}");
            // Trapezoids of 30 steps.
            assert!(
                (cycle.fitted - cycle.closed_form).abs() < 4e-3 * cycle.closed_form.abs().max(0.02),
                "{cycle:?}"
            );
            // Begin and end are at rest.
            assert!((cycle.closed_form - cycle.dissipated).abs() < 1e-12);
        }
        // The fourth cycle goes no farther than the second and the third.
        assert!(cycles[2].dissipated > 0.01 && cycles[3].dissipated == 0.0);
    }
}

/// The trapezoids of a finer record come nearer to the closed form, with the square of the step.
#[test]
fn the_work_of_a_measured_cycle_comes_to_the_closed_form() {
    let fit = fitted(&[record("uniaxial", 0.0, 0)]);
    let law = NeoHooke { c10: C10 };
    let loops = |rows: i32| {
        let mut most = 0.0_f64;
        let (mut work, mut before) = (0.0, [0.0; 2]);
        for x in strains(rows).into_iter().take(6 * rows as usize + 1) {
            let state = law.tension([1.0, 0.0], x);
            most = most.max(state.energy);
            let [factor, _] = TRUTH.factor(state.energy, most);
            let stress = factor * state.nominal_stress;
            work += 0.5 * (stress + before[1]) * (x - before[0]);
            before = [x, stress];
        }
        work
    };
    let cycles = &fit.softened.unwrap().cycles[..3];
    let closed: f64 = cycles.iter().map(|cycle| cycle.dissipated).sum();
    let [coarse, fine] = [40, 160].map(|rows| (loops(rows) / closed - 1.0).abs());
    assert!(
        fine < 2e-4 && coarse / fine > 12.0,
        "{coarse:.1e} {fine:.1e}"
    );
}

/// The 95 % intervals of noisy cycles hold the true values in 89 to 99 of 100 cases.
#[test]
fn intervals_of_noisy_cycles_hold_the_truth() {
    let seeds = 100;
    let held: Vec<[bool; 4]> = (0..seeds)
        .into_par_iter()
        .map(|seed| {
            let fit = fitted(&[record("uniaxial", 0.004, seed)]);
            std::array::from_fn(|index| fit.quality.estimates[index].holds(VALUES[index]))
        })
        .collect();
    for index in 0..4 {
        let count = held.iter().filter(|held| held[index]).count();
        assert!(
            (89..=99).contains(&count),
            "parameter {index}: {count} of {seeds}"
        );
    }
}

#[test]
fn softening_can_be_fitted_on_top_of_a_card_and_written_there() {
    let plain = Card::load("neo-hooke", std::path::Path::new(".")).unwrap();
    let text = plain.text.replace("0.05 MPa", &format!("{C10} MPa"));
    let card = Card::parse("own", "own.toml", &text).unwrap();
    let tests = [record("uniaxial", 0.002, 3)];
    let fit = fit_softening(Base::Card(&card), &tests, &FitSettings::default()).unwrap();
    assert_eq!(fit.parameters.len(), 3);
    assert_parameters(&fit, &VALUES[1..], 0.3);
    let provenance = Provenance {
        files: vec!["cycles.csv".into()],
        base_card: Some("own.toml".into()),
        ..Provenance::default()
    };
    let written = card_text(&fit, &tests, &provenance);
    let read = Card::parse("soft", "soft.toml", &written).unwrap();
    let softening = fit.softened.unwrap().softening;
    assert_eq!(read.law.softening(), Some(softening));
    assert_eq!(read.parameter("c10"), Some(C10));
    let record = read.fit.unwrap();
    assert!(record.softening && record.base_card.as_deref() == Some("own.toml"));
    let together = fitted(&tests);
    let text = card_text(&together, &tests, &Provenance::default());
    let read = Card::parse("soft", "soft.toml", &text).unwrap();
    assert_eq!(
        read.law.softening(),
        together.softened.map(|softened| softened.softening)
    );
}

#[test]
fn a_first_loading_alone_tells_nothing_of_softening() {
    let mut data = record("uniaxial", 0.0, 0);
    data.observations.truncate(25);
    let law = Base::Law(Law::named("neo-hooke").unwrap());
    let fault = fit_softening(law, &[data], &FitSettings::default()).unwrap_err();
    assert!(fault.to_string().contains("no test unloads"), "{fault}");
}

#[test]
fn an_earlier_stretch_that_is_stated_gives_the_parameters_back() {
    for test in ["uniaxial", "equibiaxial"] {
        let mut data = record_after(0.6, test, 0.0, 0);
        data.preconditioned = Some(0.6);
        let fit = fitted(std::slice::from_ref(&data));
        assert_parameters(&fit, &VALUES, 1e-6);
        let cycles = &fit.softened.as_ref().unwrap().cycles;
        assert!(cycles[0].dissipated == 0.0 && cycles[1].dissipated > 0.0);
    }
}

#[test]
fn an_earlier_stretch_is_read_and_must_be_possible() {
    let read = |stated: &str, columns: &str| {
        let text = format!("# test: uniaxial; cycle: all; preconditioned: {stated}\n{columns}");
        TestData::parse("cycles.csv", &text, &Statements::new()).map(|data| data.preconditioned)
    };
    let tension = "stretch [-],nominal_stress [MPa]\n1,0\n1.2,0.1\n1.1,0.04\n";
    let pressed = "stretch [-],nominal_stress [MPa]\n1,0\n0.8,-0.1\n0.9,-0.04\n";
    assert_eq!(read("1.5", tension).unwrap(), Some(0.5));
    assert_eq!(read("0.75", pressed).unwrap(), Some(-0.25));
    for (stated, columns) in [("50 %", tension), ("1.5", pressed)] {
        let fault = read(stated, columns).unwrap_err().to_string();
        assert_contains(&fault, "earlier stretch");
    }
}
