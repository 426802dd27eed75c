use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::assertions::assert_contains;
use crate::document::{Statements, Table};

mod recordings;

const POSITIONS: [f64; 9] = [-13.0, -10.0, -7.0, -4.0, -1.0, 2.0, 5.0, 8.0, 11.0];

fn settings(forms: [Form; 2]) -> IdentificationSettings {
    IdentificationSettings {
        forms,
        ..IdentificationSettings::default()
    }
}

fn identified(recording: &Recording) -> Identification {
    identified_with(recording, IdentificationSettings::default())
}

fn identified_with(recording: &Recording, settings: IdentificationSettings) -> Identification {
    identify(recording, settings, &|_| ()).unwrap()
}

/// Some instants of a recording.
fn part(recording: &Recording, kept: &[usize]) -> Recording {
    let of = |values: &[f64]| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>();
    Recording {
        times: of(&recording.times),
        extension: of(&recording.extension),
        force: of(&recording.force),
        ..recording.clone()
    }
}

/// All trials are in `gelbench validate spring-identification`.
#[test]
fn known_functions_lie_within_their_bands_in_nine_of_ten_trials() {
    let good = (5001..5011).filter(|seed| {
        let sample = Sample {
            seed: *seed,
            ..Sample::default()
        };
        let actual = identified(&sample.recording());
        let within = |function: &Function, x: f64, truth: f64| {
            let [low, high] = function.band(x);
            (low..=high).contains(&truth)
        };
        POSITIONS.iter().all(|x| {
            within(&actual.stiffness, *x, Sample::stiffness(*x))
                && within(&actual.damping, *x, Sample::damping(*x))
        })
    });
    let good = good.count();
    assert!(good >= 9, "{good} of 10");
}

#[test]
fn without_noise_the_functions_are_found_to_the_accuracy_of_their_splines() {
    let exact = Sample::default().exact();
    let actual = identified(&exact);
    for x in POSITIONS {
        let [k, d] = [&actual.stiffness, &actual.damping].map(|function| function.at(x).value);
        assert!((k / Sample::stiffness(x) - 1.0).abs() < 5e-4, "{x}: {k}");
        assert!((d / Sample::damping(x) - 1.0).abs() < 5e-3, "{x}: {d}");
    }
    assert!(actual.verdict.is_sound(), "{:?}", actual.verdict);
}

/// A massless spring and dashpot that a machine moves: f = K x + D ẋ.
fn machine(stiffness: impl Fn(f64) -> f64, damping: impl Fn(f64) -> f64) -> Recording {
    let mut recording = Recording::default();
    for i in 0..600 {
        let t = 0.01 * f64::from(i);
        let (slow, fast) = (2.0 * t, 5.1 * t);
        let x = 5.0 + 3.0 * slow.sin() + 1.5 * fast.sin();
        let v = 6.0 * slow.cos() + 7.65 * fast.cos();
        recording.times.push(t);
        recording.extension.push(x);
        recording.force.push(stiffness(x) * x + damping(v) * v);
    }
    recording
}

#[test]
fn constants_and_polynomials_come_back_with_their_coefficients() {
    let recording = machine(|x| 0.2 + 0.01 * x, |_| 0.05);
    let actual = identified_with(&recording, settings([Form::Polynomial(1), Form::Constant]));
    let [k, d] = [&actual.stiffness, &actual.damping].map(Function::powers);
    for (estimate, truth) in [(k[0], 0.2), (k[1], 0.01), (d[0], 0.05)] {
        assert!((estimate.value / truth - 1.0).abs() < 1e-5, "{estimate:?}");
        assert!(estimate.standard_error < 1e-4 * truth);
    }
    let text = law_text(&actual, &recording, "a.csv");
    assert_contains(&text, "coefficients = [\"0.2 N/mm\", \"0.01 N/mm\"]");
    assert_contains(&text, "kind = \"constant\"\nvalue = \"0.05 N·s/mm\"");
    let specimen = Recording {
        length: Some(50.0),
        area: Some(10.0),
        ..recording
    };
    let text = law_text(&actual, &specimen, "a.csv");
    assert_contains(&text, "coefficients = [\"1.0 MPa\", \"2.5 MPa\"]");
}

#[test]
fn a_dashpot_may_depend_on_the_rate() {
    let damping = |v: f64| 0.05 / (1.0 + (v / 10.0).powi(2));
    let recording = machine(|_| 0.3, damping);
    let by_rate = IdentificationSettings {
        argument: Argument::Rate,
        ..settings([Form::Constant, Form::SPLINE])
    };
    let actual = identified_with(&recording, by_rate);
    for v in [-10.0, -5.0, 3.0, 9.0] {
        let d = actual.damping.at(v).value;
        assert!((d / damping(v) - 1.0).abs() < 5e-3, "{v}: {d}");
    }
    let text = law_text(&actual, &recording, "a.csv");
    assert_contains(&text, "of = \"stretch rate\"\nkind = \"table\"\nat = [");
}

#[test]
fn a_shape_is_kept_against_the_data() {
    let recording = Sample::default().recording();
    let rise = |shape: Shape| {
        let wanted = IdentificationSettings {
            shapes: [Shape::Free, shape],
            ..IdentificationSettings::default()
        };
        let actual = identified_with(&recording, wanted);
        let positions = actual.damping.positions(200);
        let values: Vec<f64> = positions
            .iter()
            .map(|x| actual.damping.at(*x).value)
            .collect();
        let size = largest(&values);
        let rises = values.windows(2).map(|pair| (pair[1] - pair[0]).max(0.0));
        rises.sum::<f64>() / size
    };
    assert!(rise(Shape::Free) > 0.3);
    assert!(rise(Shape::Decreasing) < 1e-3);
    let wanted = IdentificationSettings {
        shapes: [Shape::Increasing; 2],
        ..settings([Form::Constant, Form::SPLINE])
    };
    let message = identify(&recording, wanted, &|_| ())
        .unwrap_err()
        .to_string();
    assert_contains(&message, "only splines");
}

#[test]
fn what_does_not_fit_or_is_not_determined_is_told() {
    let sample = Sample::default();
    let wrong = Recording {
        mass: 3e-4,
        ..sample.recording()
    };
    let actual = identified(&wrong);
    let reasons = actual.verdict.reasons.join("; ");
    assert!(
        !actual.is_explained() && reasons.contains("times the noise"),
        "{reasons}"
    );
    let right = identified(&sample.recording());
    assert!(
        right.warnings.is_empty() && right.verdict.is_sound(),
        "{:?}",
        right.verdict
    );
    // A ramp: every extension has one speed, and K x + D v cannot be told apart by free splines.
    let mut ramp = machine(|_| 0.2, |_| 0.05);
    for (i, x) in ramp.extension.iter_mut().enumerate() {
        *x = 1.0 + 0.01 * i as f64;
        ramp.force[i] = 0.2 * *x + 0.05;
    }
    let message = identify(&ramp, IdentificationSettings::default(), &|_| ())
        .map(|_| ())
        .unwrap_err();
    assert_eq!(message.exit_code(), 2);
    assert!(
        message
            .to_string()
            .contains("does not determine K(·) and D(·)"),
        "{message}"
    );
}

#[test]
fn the_recording_that_comes_along_is_the_one_of_its_seed() {
    let text = include_str!("../../../../examples/spring_dashpot.csv");
    assert_eq!(text, Sample::default().csv());
    let table = Table::parse("spring_dashpot.csv", text).unwrap();
    let recording = Recording::of_table(&table, &Statements::new()).unwrap();
    assert!((recording.mass - 2e-4).abs() < 1e-12 && recording.length == Some(50.0));
}

/// Instants that are missing here and there leave a motion that is determined.
#[test]
fn a_recording_of_two_thirds_of_the_instants_has_the_functions_of_the_whole_one() {
    for seed in 1..7 {
        let complete = Sample {
            seed,
            ..Sample::default()
        };
        let complete = complete.recording();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let kept: Vec<usize> = (0..complete.times.len())
            .filter(|_| random.random_range(0..3) > 0)
            .collect();
        let part = part(&complete, &kept);
        let actual = identified(&part);
        assert!(actual.misfit < 1.2, "{seed}: {}", actual.misfit);
        for x in POSITIONS {
            let k = actual.stiffness.at(x).value;
            assert!(
                (k / Sample::stiffness(x) - 1.0).abs() < 0.1,
                "{seed} {x}: {k}"
            );
        }
    }
}

/// The iteration that begins with polynomials, for cases in which the direct one does not converge, leads to the same functions.
#[test]
fn from_the_motion_of_polynomials_the_functions_are_the_same() {
    let recording = Sample::default().recording();
    let smooth = |signal: &[f64], degree| smooth(&recording.times, signal, degree).unwrap();
    let signals = (smooth(&recording.extension, 5), smooth(&recording.force, 3));
    let settings = IdentificationSettings::default();
    let (joint, start) = begin(&recording, settings, &signals).unwrap();
    let squares = |fit: &Fit| joint.sum_of_squares(&fit.state);
    let (direct, _) = nearest_fit(&joint, start.clone(), &|_| ()).unwrap();
    let simple = joint.with_polynomials();
    let mut first = Fit::new(&simple, simple.state(start.motion));
    first.improve(&|_| ()).unwrap();
    let mut fit = Fit::new(&joint, joint.state(first.state.motion));
    fit.improve(&|_| ()).unwrap();
    let ratio = squares(&fit) / squares(&direct);
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    let apart = (&fit.state.functions - &direct.state.functions).amax();
    assert!(apart < 1e-3 * direct.state.functions.amax(), "{apart}");
}
