//! Fits of the published data, compared with values found elsewhere.

use std::path::Path;

use super::*;
use crate::assertions::assert_contains;
use crate::document::Statements;
use crate::material::Card;
use crate::material::curve::Mode;
use crate::material::registry::{CARDS, DATA};

pub mod biaxial;
pub mod helpers;
mod minimum;
mod quality;
mod simple_shear;
mod uncertainty;
mod verdict;
mod weighting;

use helpers::{
    assert_parameters, bounded, fit_with, fitted, law, parsed, read, uniaxial, weighted,
};

fn data(names: &[&str]) -> Vec<TestData> {
    let file = |name: &&str| read(&format!("../../materials/data/{name}.csv"));
    names.iter().map(file).collect()
}

fn values(fit: &Fit) -> Vec<f64> {
    fit.parameters
        .iter()
        .map(|parameter| parameter.value)
        .collect()
}

/// Half a unit of the last digit given.
fn agree(law: &str, actual: &[f64], expected: &[(f64, f64)]) {
    for (actual, (expected, last_digit)) in actual.iter().zip(expected) {
        assert!(
            (actual - expected).abs() <= 0.5 * last_digit,
            "{law}: {actual} is not {expected}"
        );
    }
}

#[test]
fn eq_24_gives_the_parameters_found_elsewhere() {
    let tests = data(&["pva_10_uniaxial"]);
    for (law, expected) in [
        ("neo-hooke", &[(0.188 / 2.0, 5e-4)][..]),
        ("mooney-rivlin", &[(0.3065, 1e-4), (-0.3592, 1e-4)]),
        ("yeoh", &[(0.03079, 1e-5), (0.02223, 1e-5), (0.0021, 1e-4)]),
        ("fung-demiray", &[(0.0832, 1e-4), (0.6425, 1e-4)]),
        ("veronda-westmann", &[(0.1189, 1e-4), (0.5015, 1e-4)]),
        ("ogden-1", &[(0.05344, 1e-5), (5.781, 1e-3)]),
    ] {
        let fit = fitted(law, &tests);
        agree(law, &values(&fit), expected);
    }
    let unstable = fitted("mooney-rivlin", &tests).quality;
    assert!(
        unstable
            .stable
            .iter()
            .all(|range| range.stretches == [1.0, 1.0])
    );
    assert!(
        unstable
            .warnings
            .iter()
            .any(|warning| warning.contains("unstable from rest"))
    );
}

#[test]
fn treloars_rubber_gives_the_parameters_found_elsewhere() {
    let tests = data(&["treloar_1944_uniaxial"]);
    agree(
        "neo-hooke",
        &values(&fitted("neo-hooke", &tests)),
        &[(0.285388, 1e-6)],
    );
    agree(
        "yeoh",
        &values(&fitted("yeoh", &tests)),
        &[(0.176284, 1e-6), (-0.00185474, 1e-8), (4.64103e-5, 1e-10)],
    );
    let all = data(&[
        "treloar_1944_uniaxial",
        "treloar_1944_equibiaxial",
        "treloar_1944_planar",
    ]);
    let ogden = fitted("ogden-3", &all);
    assert!(
        ogden.quality.sum_of_squares <= 0.2085,
        "{}",
        ogden.quality.sum_of_squares
    );
}

#[test]
fn a_rising_cauchy_curve_is_found_unstable() {
    let row = |i: i32| {
        let strain = f64::from(i) / 99.0;
        format!("{strain},{}\n", 0.0611 * (2.2347 * strain).exp_m1())
    };
    let rows: String = (0..100).map(row).collect();
    let text = format!("# test: uniaxial\nnominal_strain [-],cauchy_stress [MPa]\n{rows}");
    let fit = fitted("veronda-westmann", &[parsed(&text)]);
    let [_, high] = fit.quality.stable[0].stretches;
    assert!((high - 1.595).abs() < 1e-3, "{high}");
    assert!(fit.quality.r_squared > 0.999 && !fit.quality.is_stable());
}

#[test]
fn every_card_with_data_is_found_again() {
    let mut count = 0;
    for (name, _) in CARDS {
        let card = Card::load(name, Path::new(".")).unwrap();
        let Some(record) = &card.fit else { continue };
        let read = |file: &String| {
            let (file, text) = DATA.iter().find(|(known, _)| known == file).unwrap();
            TestData::parse(file, text, &Statements::new()).unwrap()
        };
        let tests: Vec<TestData> = record.data.iter().map(read).collect();
        let again = fitted(&card.law_name, &tests);
        let estimates = &again.quality.estimates;
        for ((old, new), estimate) in card.parameters.iter().zip(&again.parameters).zip(estimates) {
            let difference = (old.value - new.value).abs() / estimate.standard_error;
            assert!(difference < 1e-3, "{name} {}: {difference:.1e}", old.key);
        }
        count += 1;
    }
    assert_eq!(count, 5);
}

#[test]
fn all_laws_are_ranked_and_fibres_need_two_directions() {
    let tests = data(&["treloar_1944_uniaxial"]);
    let (fits, reasons) = rank(&tests, &FitSettings::default());
    assert!(reasons.is_empty(), "{reasons:?}");
    assert!(
        fits.iter()
            .all(|fit| fit.law.name != "holzapfel-gasser-ogden")
    );
    assert!(
        fits.windows(2)
            .all(|pair| pair[0].quality.aicc <= pair[1].quality.aicc)
    );
    assert!(fits[0].law.name.starts_with("ogden"));
    // The nearest one has six parameters, not all of which these data determine.
    assert!(!fits[0].quality.is_identifiable());
    let last = fits[fits.len() - 2..].iter().map(|fit| fit.law.name);
    let mut last: Vec<&str> = last.collect();
    last.sort_unstable();
    assert_eq!(last, ["mooney-rivlin", "neo-hooke"]);
    let untested = &fits[0].quality.untested;
    assert_eq!(untested[..], [Mode::Planar, Mode::Equibiaxial]);
}

/// Strips along and across the fibres of a known law, and a sheet stretched both ways.
#[test]
fn the_parameters_of_aligned_fibres_are_found_from_two_directions() {
    let name = "holzapfel-gasser-ogden";
    let truth = [0.02, 0.03, 0.8, 0.1, 0.5];
    let built = law(name, &truth);
    let file = |direction: usize| {
        let unit = [[1.0, 0.0], [0.0, 1.0]][direction - 1];
        let row = |i: i32| {
            let x = f64::from(i) / 40.0;
            format!("{},{}\n", 1.0 + x, built.tension(unit, x).nominal_stress)
        };
        let rows: String = (1..=40).map(row).collect();
        let head = format!("# test: uniaxial; direction: {direction}");
        parsed(&format!("{head}\nstretch [-],nominal_stress [MPa]\n{rows}"))
    };
    let row = |i: i32| {
        let x = f64::from(i) / 60.0;
        let [first, second] = built.biaxial([x, x]);
        format!("{},{first},{second}\n", 1.0 + x)
    };
    let rows: String = (1..=40).map(row).collect();
    let text = format!(
        "# test: equibiaxial\nstretch [-],nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n{rows}"
    );
    let tests = [file(1), file(2), parsed(&text)];
    assert_parameters(&fitted(name, &tests), &truth, 1e-4);
}

#[test]
fn bounds_weights_and_few_points_are_respected() {
    let tests = data(&["treloar_1944_uniaxial"]);
    let bound = fit_with("gent", &tests, &bounded("jm", [90.0, 200.0])).unwrap();
    assert_eq!(values(&bound)[1], 90.0);
    assert!(bound.quality.at_bound[1]);
    let relative = fit_with("gent", &tests, &weighted(Weighting::Relative))
        .unwrap()
        .quality;
    let absolute = fitted("gent", &tests).quality;
    assert!(relative.largest_relative_error_percent < absolute.largest_relative_error_percent);
    assert!(relative.rmse > absolute.rmse);
    // The floor of the relative residuals is said, and holds.
    let message = Weighting::Relative.describe();
    assert_contains(&message, "1 % of the test's largest stress");
    let small = Observation {
        stress: 1e-6 * tests[0].largest_stress,
        ..tests[0].observations[0]
    };
    let weight = Weighting::Relative.weight_of(&tests[0], small.stress) * tests[0].largest_stress;
    assert!((weight - 100.0).abs() < 1e-9, "{weight}");

    let few = [uniaxial("1.1,0.1\n1.2,0.2\n")];
    let refused = fit_with("gent", &few, &FitSettings::default())
        .unwrap_err()
        .to_string();
    assert_contains(&refused, "2 parameters need at least 3 points");
    let refused = fit_with("gent", &tests, &bounded("jn", [1.0, 2.0]))
        .unwrap_err()
        .to_string();
    assert_contains(&refused, "did you mean `jm`");
}

#[test]
fn the_deviation_is_normalised_by_the_larger_mean() {
    // A bound makes the law twice as stiff as the data, or half as stiff: both are 50 % of the larger mean.
    let row = |i: i32| {
        let stretch = 1.0 + 0.02 * f64::from(i);
        format!("{stretch},{}\n", 0.2 * (stretch - stretch.powi(-2)))
    };
    let rows: String = (1..=20).map(row).collect();
    let tests = [uniaxial(&rows)];
    for c10 in [0.2, 0.05] {
        let settings = bounded("c10", [c10, c10 * (1.0 + 1e-12)]);
        let fit = fit_with("neo-hooke", &tests, &settings).unwrap();
        let actual = fit.quality.nmad_percent;
        assert!((actual - 50.0).abs() < 1e-6, "{c10}: {actual}");
    }
}

#[test]
fn the_card_of_a_measured_curve_is_the_curve() {
    let tests = data(&["pva_10_uniaxial"]);
    let fit = fitted("marlow-table", &tests);
    let text = card_text(&fit, &tests, &Provenance::default());
    let card = Card::parse("table", "table.toml", &text).unwrap();
    for one in &tests[0].observations {
        let actual = tests[0].stress_of(&*card.law, one);
        assert!(
            (actual - one.stress).abs() <= 1e-10 * one.stress.max(1e-6),
            "{one:?}"
        );
    }
}

/// Bounds that exclude where the data lead, that lie outside of the law, and an active one of a stress.
#[test]
fn every_bound_is_kept_or_refused() {
    let tests = data(&["treloar_1944_uniaxial"]);
    let with = |law: &str, key: &str, range: [f64; 2]| fit_with(law, &tests, &bounded(key, range));
    for (law, key, range, held) in [
        ("neo-hooke", "c10", [0.0, 0.01], 0.01),
        ("neo-hooke", "c10", [0.9, 1.0], 0.9),
        ("yeoh", "c30", [-1.0, 1e-5], 1e-5),
    ] {
        let fit = with(law, key, range).unwrap();
        let (index, parameter) = fit
            .parameters
            .iter()
            .enumerate()
            .find(|(_, one)| one.key == key)
            .unwrap();
        assert!(
            (parameter.value / held - 1.0).abs() < 1e-6,
            "{law} {key}: {}",
            parameter.value
        );
        assert!(fit.quality.at_bound[index], "{law} {key}");
    }
    for (law, key, range) in [
        ("neo-hooke", "c10", [-2.0, -1.0]),
        ("gent", "jm", [-5.0, -1.0]),
    ] {
        let refused = with(law, key, range).unwrap_err().to_string();
        assert_contains(&refused, "allow no value of the law");
    }
}

#[test]
fn data_that_do_not_determine_a_parameter_give_it_no_certainty() {
    // A Gent solid far below its limit: J_m may be anything.
    let row = |i: i32| {
        let x = f64::from(i) / 50.0;
        let wiggle = 1e-4 * (f64::from(i) * 1.7).sin();
        format!(
            "{},{}\n",
            1.0 + x,
            0.1 * ((1.0 + x) - (1.0 + x).powi(-2)) - 0.02 * x * x + wiggle
        )
    };
    let rows: String = (1..=20).map(row).collect();
    let fit = fitted("gent", &[uniaxial(&rows)]);
    assert!(
        !fit.quality.is_identifiable(),
        "{:?}",
        fit.quality.estimates
    );
}

#[test]
fn stability_is_asked_for_as_far_as_each_test_goes() {
    let all = data(&[
        "treloar_1944_uniaxial",
        "treloar_1944_equibiaxial",
        "treloar_1944_planar",
    ]);
    let gent = fitted("gent", &all).quality;
    assert!(gent.stable[2].stretches[1] < 7.6 && gent.is_stable());
}
