//! Relaxation against closed forms, and what its intervals hold.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::*;
use crate::assertions::assert_contains;
use crate::calibration::tests::helpers::{assert_parameters, bounded, law, parsed, uniaxial};
use crate::calibration::*;
use crate::material::Card;
use crate::material::registry::Law;
use crate::material::viscosity::{Relaxation, ViscousMaterial};

fn series(terms: &[(f64, f64)]) -> ViscousMaterial {
    let terms = terms.iter().map(|(share, time)| Relaxation {
        share: *share,
        time: *time,
    });
    ViscousMaterial {
        relaxation: terms.collect(),
        ..ViscousMaterial::default()
    }
}

/// A file of rows of time, nominal strain and nominal stress.
fn data(rows: impl Iterator<Item = [f64; 3]>, head: &str) -> TestData {
    let rows: String = rows.map(|[t, x, p]| format!("{t},{x},{p}\n")).collect();
    let names = "time [s],nominal_strain [-],nominal_stress [MPa]";
    parsed(&format!("# test: uniaxial{head}\n{names}\n{rows}"))
}

/// P = S λ of a history with S∞ of neo-Hooke, 1 MPa.
fn followed(strains: &[[f64; 2]], head: &str, material: &ViscousMaterial) -> Vec<f64> {
    let test = data(strains.iter().map(|[t, x]| [*t, *x, 1.0]), head);
    let tests = [test];
    let history = &History::all(&tests, false).unwrap()[0];
    let long = history.long_time_stress(&tests[0], &*law("neo-hooke", &[1.0]));
    history.stresses(&tests[0], &long, material)
}

/// S∞ of neo-Hooke with C₁₀ = 1 MPa.
fn long(x: f64) -> f64 {
    2.0 * (1.0 - (1.0 + x).powi(-3))
}

#[test]
fn a_sudden_stretch_relaxes_as_in_closed_form() {
    let material = series(&[(0.3, 2.0), (0.2, 0.1)]);
    let strains: Vec<[f64; 2]> = (0..60).map(|i| [0.1 * f64::from(i), 0.4]).collect();
    let actual = followed(&strains, "", &material);
    for ([time, x], stress) in strains.iter().zip(actual) {
        let expected = (1.0 + x) * long(*x) * material.relaxation_function(*time);
        assert!(
            (stress / expected - 1.0).abs() < 1e-12,
            "{time}: {stress} {expected}"
        );
    }
}

/// With S∞ that rises evenly for a time T: S = S∞ + β S∞ (τ/T) (1 − e^(−t/τ)) on the ramp, and that at T times e^(−(t − T)/τ) then.
#[test]
fn a_ramp_and_hold_of_one_maxwell_element_is_the_closed_form() {
    let (share, tau, rise): (f64, f64, f64) = (0.4, 1.5, 2.0);
    let beta = share / (1.0 - share);
    // Strains at which S∞ rises evenly to that of 0.3: the recursion is exact in steps of any length.
    let top = long(0.3);
    let strain = |s: f64| (1.0 - 0.5 * s).powf(-1.0 / 3.0) - 1.0;
    let times: Vec<f64> = (0..=400).map(|i| 0.02 * f64::from(i)).collect();
    let s_of = |t: f64| top * (t / rise).min(1.0);
    let strains: Vec<[f64; 2]> = times.iter().map(|t| [*t, strain(s_of(*t))]).collect();
    let actual = followed(&strains, "", &series(&[(share, tau)]));
    for ([t, x], stress) in strains.iter().zip(actual) {
        let on_ramp = |t: f64| beta * top * tau / rise * -(-t / tau).exp_m1();
        let q = if *t <= rise {
            on_ramp(*t)
        } else {
            on_ramp(rise) * (-(t - rise) / tau).exp()
        };
        let expected = (1.0 + x) * (s_of(*t) + q);
        assert!(
            (stress - expected).abs() < 1e-12,
            "{t}: {stress} {expected}"
        );
    }
}

/// A file with the hold alone, whose rise is stated, is the same ramp; where it is not, the rise was sudden.
#[test]
fn a_rise_that_is_not_in_the_file_can_be_stated() {
    let material = series(&[(0.4, 1.5)]);
    let hold = |i: i32| [2.0 + 0.1 * f64::from(i), 0.01];
    let complete: Vec<[f64; 2]> = [[0.0, 0.0]].into_iter().chain((0..20).map(hold)).collect();
    let part: Vec<[f64; 2]> = complete[1..].to_vec();
    let of_complete = followed(&complete, "", &material);
    let stated = followed(&part, "; ramp: 2 s", &material);
    let sudden = followed(&part, "", &material);
    for ((a, b), c) in of_complete[1..].iter().zip(&stated).zip(&sudden) {
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        assert!(c / a > 1.01 || c / of_complete[1] < 0.99, "{c} {a}");
    }
}

/// Steady cycles at small strain: storage and loss modulus from the last cycle, and those of the material.
#[test]
fn steady_cycles_have_the_storage_and_the_loss_modulus() {
    let material = series(&[(0.3, 2.0), (0.2, 0.1)]);
    for frequency in [0.02, 0.3, 3.0] {
        let amplitude = 1e-5;
        let (cycles, each) = ((40.0 * f64::max(1.0, frequency)) as usize, 400);
        let step = 1.0 / (frequency * each as f64);
        let strains: Vec<[f64; 2]> = (0..=cycles * each)
            .map(|i| {
                let t = step * i as f64;
                [t, amplitude * (TAU * frequency * t).sin()]
            })
            .collect();
        let actual = followed(&strains, "", &material);
        let last = cycles * each - each..cycles * each;
        let [mut storage, mut loss] = [0.0; 2];
        for i in last {
            let (sine, cosine) = (TAU * i as f64 / each as f64).sin_cos();
            storage += actual[i] * sine * 2.0 / (each as f64 * amplitude);
            loss += actual[i] * cosine * 2.0 / (each as f64 * amplitude);
        }
        let expected = material.complex_modulus(6.0, TAU * frequency);
        assert!(
            (storage / expected[0] - 1.0).abs() < 2e-4,
            "{frequency}: {storage} {expected:?}"
        );
        assert!(
            (loss / expected[1] - 1.0).abs() < 2e-3,
            "{frequency}: {loss} {expected:?}"
        );
    }
}

/// The material of the round trips: C₁₀ in MPa and two terms.
const TRUTH: [f64; 5] = [0.05, 0.2, 0.4, 0.25, 6.0];

/// Ramp in 1 s to 20 %, and hold, with noise whose neighbours have a correlation.
fn ramp_and_hold(noise: f64, correlation: f64, seed: u64) -> TestData {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut white = || {
        let (a, b): (f64, f64) = (random.random(), random.random());
        (-2.0 * (1.0 - a).ln()).sqrt() * (TAU * b).cos()
    };
    let mut before = None;
    let mut normal = || {
        let fresh = white();
        let last = before.map_or(fresh, |last| {
            correlation * last + (1.0 - correlation * correlation).sqrt() * fresh
        });
        before = Some(last);
        last
    };
    let times = (0..=40)
        .map(|i| 0.05 * f64::from(i))
        .chain((1..=90).map(|i| 2.0 + 0.3 * f64::from(i)));
    let strains: Vec<[f64; 2]> = times.map(|t| [t, 0.2 * t.min(1.0)]).collect();
    let stresses = followed(
        &strains,
        "",
        &series(&[(TRUTH[1], TRUTH[2]), (TRUTH[3], TRUTH[4])]),
    );
    let rows = strains.iter().zip(stresses);
    let rows: Vec<[f64; 3]> = rows
        .map(|([t, x], p)| [*t, *x, TRUTH[0] * p + noise * normal()])
        .collect();
    data(rows.into_iter(), "")
}

fn fitted(tests: &[TestData], terms: Terms) -> Fit {
    let law = Law::named("neo-hooke").unwrap();
    fit_relaxation(law, tests, &FitSettings::default(), terms).unwrap()
}

#[test]
fn the_series_of_a_ramp_and_hold_is_found_again_and_its_card_runs() {
    let tests = [ramp_and_hold(0.0, 0.0, 0)];
    let fit = fitted(&tests, Terms::Exactly(2));
    assert_parameters(&fit, &TRUTH, 1e-5);
    let text = card_text(&fit, &tests, &Provenance::default());
    let card = Card::parse("x", "x.toml", &text).unwrap();
    assert_eq!(card.viscosity, fit.relaxed.as_ref().unwrap().material);
    assert_eq!(card.fit.unwrap().relaxation_terms, Some(2));
    assert_eq!(card.viscosity.covered.times, Some([0.05, 29.0]));
    let [slow, fast] = card.viscosity.covered.rates.unwrap();
    assert!((slow - 0.2).abs() < 1e-9 && (fast - 0.2).abs() < 1e-9);
}

#[test]
fn terms_are_as_many_as_there_are() {
    let fit = fitted(&[ramp_and_hold(2e-5, 0.0, 3)], Terms::Automatic);
    let relaxed = fit.relaxed.as_ref().unwrap();
    assert_eq!(relaxed.material.relaxation.len(), 2, "{:?}", relaxed.tried);
    // A law that does not relax needs none.
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let rows = (1..100).map(|i| {
        let x = 0.004 * f64::from(i);
        [
            0.1 * f64::from(i),
            x,
            0.05 * (1.0 + x) * long(x) + 1e-4 * (random.random::<f64>() - 0.5),
        ]
    });
    let elastic = fitted(&[data(rows, "")], Terms::Automatic);
    assert!(
        elastic
            .relaxed
            .as_ref()
            .unwrap()
            .material
            .relaxation
            .is_empty(),
        "{:?}",
        elastic.relaxed.unwrap().tried
    );
}

/// The time of one term is stated: the others are sought at all times, also while terms are counted.
#[test]
fn a_term_with_bounds_of_its_own_leaves_the_others_free() {
    let tests = [ramp_and_hold(2e-5, 0.0, 3)];
    let settings = bounded("relaxation.1.time", [TRUTH[2]; 2]);
    for terms in [Terms::Exactly(2), Terms::Automatic] {
        let law = Law::named("neo-hooke").unwrap();
        let fit = fit_relaxation(law, &tests, &settings, terms).unwrap();
        assert_eq!(fit.parameters.len(), TRUTH.len());
        assert_parameters(&fit, &TRUTH, 0.05);
    }
}

/// 45 % of the stress relaxes; noise of half a percent of the largest stress leaves few independent points, whose AICc could not judge.
#[test]
fn relaxation_is_seen_however_the_noise_correlates() {
    for correlation in [0.9, 0.95] {
        let denied = (0..12_u64).into_par_iter().filter(|seed| {
            let fit = fitted(&[ramp_and_hold(2e-4, correlation, *seed)], Terms::Automatic);
            let relaxed = fit.relaxed.unwrap();
            relaxed.material.relaxation.is_empty() || fit.parameters[0].value > 0.06
        });
        assert_eq!(denied.count(), 0, "{correlation}");
    }
}

/// The true parameters lie in their 95 % intervals in 90 to 98 of 100 seeds.
#[test]
fn intervals_hold_the_truth() {
    let held = |seed: u64| {
        let fit = fitted(&[ramp_and_hold(1e-4, 0.0, seed)], Terms::Exactly(2));
        let estimates = fit.quality.estimates.iter().zip(TRUTH);
        let inside = estimates.map(|(estimate, truth)| estimate.holds(truth));
        inside.collect::<Vec<bool>>()
    };
    let trials: Vec<Vec<bool>> = (0..100_u64).into_par_iter().map(held).collect();
    let counts: Vec<usize> = (0..TRUTH.len())
        .map(|index| trials.iter().filter(|held| held[index]).count())
        .collect();
    println!("held in 100 seeds: {counts:?}");
    assert!(
        counts.iter().all(|count| (90..=98).contains(count)),
        "{counts:?}"
    );
    let mean = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
    assert!((90.0..=98.0).contains(&mean), "{mean}");
}

#[test]
fn what_cannot_be_fitted_is_told_with_a_remedy() {
    let without = [uniaxial("1.1,0.1\n1.2,0.2\n1.3,0.3\n")];
    let backwards = [data(
        [
            [0.0, 0.1, 0.1],
            [2.0, 0.2, 0.2],
            [1.0, 0.3, 0.3],
            [3.0, 0.3, 0.2],
        ]
        .into_iter(),
        "",
    )];
    let good = [ramp_and_hold(1e-4, 0.0, 0)];
    let names = "time [s],stretch_1,stretch_2,nominal_stress_1 [MPa],nominal_stress_2 [MPa]";
    let rows = "0,1,1,0,0\n1,1.1,1.1,0.1,0.1\n2,1.2,1.2,0.2,0.2\n";
    let head = "# test: biaxial; rest state: estimated";
    let mounted = [parsed(&format!("{head}\n{names}\n{rows}"))];
    for (law, tests, message) in [
        ("neo-hooke", &without[..], "no column of times"),
        ("neo-hooke", &backwards, "the times decrease"),
        ("neo-hooke", &mounted, "are not fitted with the mounting"),
        ("marlow-table", &good, "takes a curve as it is"),
        ("ogden-hill-1", &good, "is compressible"),
    ] {
        let law = Law::named(law).unwrap();
        let output = fit_relaxation(law, tests, &FitSettings::default(), Terms::Automatic);
        let output = output.map(|_| ()).unwrap_err().to_string();
        assert_contains(&output, message);
    }
}

/// A relaxation slower than the test: its time is at the bound, which is reported.
#[test]
fn a_time_beyond_the_data_is_told() {
    let material = series(&[(0.5, 3000.0)]);
    let strains: Vec<[f64; 2]> = (0..200)
        .map(|i| [0.1 * f64::from(i), 0.2 * (0.1 * f64::from(i)).min(1.0)])
        .collect();
    let stresses = followed(&strains, "", &material);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let rows = strains.iter().zip(stresses);
    let rows: Vec<[f64; 3]> = rows
        .map(|([t, x], p)| [*t, *x, p + 1e-4 * (random.random::<f64>() - 0.5)])
        .collect();
    let fit = fitted(&[data(rows.into_iter(), "")], Terms::Exactly(1));
    let output = fit.quality.warnings.join("\n");
    assert!(
        output.contains("at the limit of what the data resolve")
            || output.contains("not identifiable"),
        "{output}"
    );
}

/// Ten thousand rows are gathered, and give the same series.
#[test]
fn many_rows_are_gathered() {
    let material = series(&[(0.3, 2.0)]);
    let strains: Vec<[f64; 2]> = (0..20_000)
        .map(|i| {
            let t = 0.005 * f64::from(i);
            [t, 0.2 * t.min(1.0)]
        })
        .collect();
    let stresses = followed(&strains, "", &material);
    let test = data(
        strains
            .iter()
            .zip(&stresses)
            .map(|([t, x], p)| [*t, *x, *p]),
        "",
    );
    let tests = [test];
    let gathered = &History::all(&tests, true).unwrap()[0];
    assert!(gathered.states.len() <= 1500, "{}", gathered.states.len());
    assert!((gathered.states.iter().map(|state| state.count).sum::<f64>() - 2e4).abs() < 1e-6);
    assert_parameters(&fitted(&tests, Terms::Exactly(1)), &[1.0, 0.3, 2.0], 1e-3);
}
