use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::*;
use crate::document::{Statements, Table};

const PLACES: [f64; 9] = [-13.0, -10.0, -7.0, -4.0, -1.0, 2.0, 5.0, 8.0, 11.0];

fn settings(forms: [Form; 2]) -> IdentificationSettings {
    IdentificationSettings {
        forms,
        ..IdentificationSettings::default()
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
        let found = identify(
            &sample.recording(),
            IdentificationSettings::default(),
            &|_| (),
        )
        .unwrap();
        let within = |function: &Function, x: f64, truth: f64| {
            let [low, high] = function.band(x);
            (low..=high).contains(&truth)
        };
        PLACES.iter().all(|x| {
            within(&found.stiffness, *x, Sample::stiffness(*x))
                && within(&found.damping, *x, Sample::damping(*x))
        })
    });
    let good = good.count();
    assert!(good >= 9, "{good} of 10");
}

#[test]
fn without_noise_the_functions_are_found_to_the_accuracy_of_their_splines() {
    let exact = Sample::default().exact();
    let found = identify(&exact, IdentificationSettings::default(), &|_| ()).unwrap();
    for x in PLACES {
        let [k, d] = [&found.stiffness, &found.damping].map(|function| function.at(x).value);
        assert!((k / Sample::stiffness(x) - 1.0).abs() < 5e-4, "{x}: {k}");
        assert!((d / Sample::damping(x) - 1.0).abs() < 5e-3, "{x}: {d}");
    }
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
    let found = identify(
        &recording,
        settings([Form::Polynomial(1), Form::Constant]),
        &|_| (),
    )
    .unwrap();
    let [k, d] = [&found.stiffness, &found.damping].map(Function::powers);
    for (estimate, truth) in [(k[0], 0.2), (k[1], 0.01), (d[0], 0.05)] {
        assert!((estimate.value / truth - 1.0).abs() < 1e-5, "{estimate:?}");
        assert!(estimate.standard_error < 1e-4 * truth);
    }
    let text = law_text(&found, &recording, "a.csv");
    assert!(
        text.contains("coefficients = [\"0.2 N/mm\", \"0.01 N/mm\"]"),
        "{text}"
    );
    assert!(
        text.contains("kind = \"constant\"\nvalue = \"0.05 N·s/mm\""),
        "{text}"
    );
    let specimen = Recording {
        length: Some(50.0),
        area: Some(10.0),
        ..recording
    };
    let text = law_text(&found, &specimen, "a.csv");
    assert!(
        text.contains("coefficients = [\"1.0 MPa\", \"2.5 MPa\"]"),
        "{text}"
    );
}

#[test]
fn a_dashpot_may_depend_on_the_rate() {
    let damping = |v: f64| 0.05 / (1.0 + (v / 10.0).powi(2));
    let recording = machine(|_| 0.3, damping);
    let found = IdentificationSettings {
        argument: Argument::Rate,
        ..settings([Form::Constant, Form::SPLINE])
    };
    let found = identify(&recording, found, &|_| ()).unwrap();
    for v in [-10.0, -5.0, 3.0, 9.0] {
        let d = found.damping.at(v).value;
        assert!((d / damping(v) - 1.0).abs() < 5e-3, "{v}: {d}");
    }
    let text = law_text(&found, &recording, "a.csv");
    assert!(
        text.contains("of = \"stretch rate\"\nkind = \"table\"\nat = ["),
        "{text}"
    );
}

#[test]
fn a_shape_is_kept_against_the_data() {
    let recording = Sample::default().recording();
    let rise = |shape: Shape| {
        let wanted = IdentificationSettings {
            shapes: [Shape::Free, shape],
            ..IdentificationSettings::default()
        };
        let found = identify(&recording, wanted, &|_| ()).unwrap();
        let places = found.damping.places(200);
        let values: Vec<f64> = places.iter().map(|x| found.damping.at(*x).value).collect();
        let size = values.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
        let rises = values.windows(2).map(|pair| (pair[1] - pair[0]).max(0.0));
        rises.sum::<f64>() / size
    };
    assert!(rise(Shape::Free) > 0.3);
    assert!(rise(Shape::Decreasing) < 1e-3);
    let wanted = IdentificationSettings {
        shapes: [Shape::Increasing; 2],
        ..settings([Form::Constant, Form::SPLINE])
    };
    let told = identify(&recording, wanted, &|_| ())
        .unwrap_err()
        .to_string();
    assert!(told.contains("only splines"), "{told}");
}

#[test]
fn what_does_not_fit_or_is_not_determined_is_told() {
    let sample = Sample::default();
    let wrong = Recording {
        mass: 3e-4,
        ..sample.recording()
    };
    let found = identify(&wrong, IdentificationSettings::default(), &|_| ()).unwrap();
    assert!(
        !found.is_explained() && found.warnings[0].contains("do not fit together"),
        "{:?}",
        found.warnings
    );
    let right = identify(
        &sample.recording(),
        IdentificationSettings::default(),
        &|_| (),
    )
    .unwrap();
    assert!(
        right.warnings.is_empty() && right.is_explained(),
        "{:?}",
        right.warnings
    );
    // A gap that the splines cannot bridge: the noise is taken for ten times what it is.
    let mut gap = sample.recording();
    let rows = gap.times.len();
    for signal in [&mut gap.times, &mut gap.extension, &mut gap.force] {
        let mut row = 0..rows;
        signal.retain(|_| {
            row.next()
                .is_some_and(|row| !(rows / 4..5 * rows / 8).contains(&row))
        });
    }
    let found = identify(&gap, IdentificationSettings::default(), &|_| ()).unwrap();
    let told = |warning: &String| warning.contains("no rows between");
    assert!(found.warnings.iter().any(told), "{:?}", found.warnings);
    // A ramp: every extension has one speed, and K x + D v cannot be told apart by free splines.
    let mut ramp = machine(|_| 0.2, |_| 0.05);
    for (i, x) in ramp.extension.iter_mut().enumerate() {
        *x = 1.0 + 0.01 * i as f64;
        ramp.force[i] = 0.2 * *x + 0.05;
    }
    let told = identify(&ramp, IdentificationSettings::default(), &|_| ())
        .map(|_| ())
        .unwrap_err();
    assert_eq!(told.exit_code(), 2);
    assert!(
        told.to_string()
            .contains("does not determine K(·) and D(·)"),
        "{told}"
    );
}

#[test]
fn the_recording_that_comes_along_is_the_one_of_its_seed() {
    let text = include_str!("../../examples/spring_dashpot.csv");
    assert_eq!(text, Sample::default().csv());
    let table = Table::parse("spring_dashpot.csv", text).unwrap();
    let recording = Recording::of_table(&table, &Statements::new()).unwrap();
    assert!((recording.mass - 2e-4).abs() < 1e-12 && recording.length == Some(50.0));
}

/// Zeros, a drift, a lag and a wrong mass that the misfit hardly shows are named first, with their size.
#[test]
fn what_bends_the_functions_and_hides_from_the_misfit_is_named() {
    type Change<'a> = &'a dyn Fn(&mut Recording);
    let sound = Sample::default().recording();
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    let (force, extension) = (largest(&sound.force), largest(&sound.extension));
    let interval = 1e3 * (sound.times[1] - sound.times[0]);
    let count = sound.times.len() as f64;
    let cases: [(&str, f64, Change); 5] = [
        ("a zero error of the force of ", 0.05 * force, &|own| {
            own.force.iter_mut().for_each(|f| *f += 0.05 * force);
        }),
        (
            "a zero error of the extension of ",
            0.05 * extension,
            &|own| {
                own.extension
                    .iter_mut()
                    .for_each(|x| *x += 0.05 * extension);
            },
        ),
        ("a force that drifts by ", 0.1 * force, &|own| {
            let rows = own.force.iter_mut().enumerate();
            rows.for_each(|(i, f)| *f += 0.1 * force * i as f64 / count);
        }),
        ("a force that is recorded ", interval, &|own| {
            own.force.rotate_right(1);
            own.force[0] = own.force[1];
        }),
        (
            "a mass that is smaller by ",
            0.1 / 1.1 * 1.1e6 * sound.mass,
            &|own| own.mass *= 1.1,
        ),
    ];
    for (words, size, change) in cases {
        let mut recording = sound.clone();
        change(&mut recording);
        let found = identify(&recording, IdentificationSettings::default(), &|_| ()).unwrap();
        let told = asked_for(&found).unwrap_or_default();
        // Zeros of force and extension are much the same: that of the other may be named first.
        let own = told
            .split(", or alternatively ")
            .find_map(|one| one.strip_prefix(words));
        let own = own.unwrap_or_else(|| panic!("{words}: {told}"));
        let numbers: Vec<f64> = own
            .split([' ', '±'])
            .filter_map(|word| word.parse().ok())
            .collect();
        let [amount, error] = numbers[..] else {
            panic!("{own}");
        };
        assert!(
            (amount - size).abs() < 5.0 * error,
            "{words}: {amount} ± {error}, {size}"
        );
        assert!(
            error < 0.3 * size.abs(),
            "{words}: {amount} ± {error}, {size}"
        );
    }
}

/// A machine that swings about rest at two frequencies, with noise of a fiftieth of both signals.
fn swinging(stiffness: impl Fn(f64) -> f64, damping: impl Fn(f64) -> f64) -> Recording {
    swinging_by([6.0, 4.0], stiffness, damping)
}

/// The same with two amplitudes in mm.
fn swinging_by(
    [first, second]: [f64; 2],
    stiffness: impl Fn(f64) -> f64,
    damping: impl Fn(f64) -> f64,
) -> Recording {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut noise = |size: f64| -> f64 {
        let draw: f64 = StandardNormal.sample(&mut random);
        0.02 * size * draw
    };
    let mut recording = Recording::default();
    for i in 0..1200 {
        let t = 0.005 * f64::from(i);
        let (slow, fast) = (2.0 * t, 5.1 * t);
        let x = first * slow.sin() + second * fast.sin();
        let v = 2.0 * first * slow.cos() + 5.1 * second * fast.cos();
        recording.times.push(t);
        recording.extension.push(x + noise(first));
        let force = stiffness(x) * x + damping(v) * v;
        recording.force.push(force + noise(1.5));
    }
    recording
}

/// A step at rest and dry friction, which smooth functions go past.
#[test]
fn what_smooth_functions_go_past_is_named() {
    type Law<'a> = &'a dyn Fn(f64) -> f64;
    let (constant_k, constant_d): (Law, Law) = (&|_| 0.2, &|_| 0.004);
    let cases: [(&str, Law, Law); 2] = [
        (
            "a step of K(·) at rest by ",
            &|x| if x < 0.0 { 0.15 } else { 0.3 },
            constant_d,
        ),
        ("a dry friction of ", constant_k, &|v: f64| {
            0.004 + 0.1 / v.abs().max(1e-9)
        }),
    ];
    for (words, stiffness, damping) in cases {
        let recording = swinging(stiffness, damping);
        let found = identify(&recording, IdentificationSettings::default(), &|_| ()).unwrap();
        let told = asked_for(&found).unwrap_or_default();
        assert!(told.contains(words), "{words}: {told}");
    }
    let sound = swinging(constant_k, constant_d);
    let found = identify(&sound, IdentificationSettings::default(), &|_| ()).unwrap();
    assert_eq!(asked_for(&found), None);
}

/// A force that is a third of an interval late shifts D(·) by τ K, and in slow motion nothing tells: the lag that could hide is stated, with
/// what it does. In quick motion it is detected, or what could hide is small.
#[test]
fn a_lag_that_slow_motion_hides_is_stated_with_its_effect() {
    let late = |lag: f64, quicker: f64| {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut noise = |size: f64| -> f64 {
            let draw: f64 = StandardNormal.sample(&mut random);
            0.02 * size * draw
        };
        let mass = 2e-4;
        let state = |t: f64| {
            [(6.0, 4.4), (4.0, 8.2), (3.0, 13.2)].map(|(a, w): (f64, f64)| {
                let w = quicker * w;
                [
                    a * (w * t).sin(),
                    a * w * (w * t).cos(),
                    -a * w * w * (w * t).sin(),
                ]
            })
        };
        let sum = |t: f64, order: usize| state(t).iter().map(|own| own[order]).sum::<f64>();
        let force = |t: f64| mass * sum(t, 2) + 0.004 * sum(t, 1) + 0.2 * sum(t, 0);
        let times: Vec<f64> = (0..1200).map(|i| f64::from(i) / 300.0).collect();
        Recording {
            extension: times.iter().map(|t| sum(*t, 0) + noise(6.0)).collect(),
            force: times.iter().map(|t| force(t - lag) + noise(1.5)).collect(),
            times,
            mass,
            ..Recording::default()
        }
    };
    for lag in [0.0, 1.1e-3] {
        let found = identify(&late(lag, 1.0), IdentificationSettings::default(), &|_| ()).unwrap();
        let hidden = found.hidden_lag.unwrap();
        assert!(hidden.lag > lag && hidden.lag < 3.4e-3, "{hidden:?}");
        // τ d(K x)/dx
        let expected = 0.2 * hidden.lag;
        assert!((hidden.damping / expected - 1.0).abs() < 0.3, "{hidden:?}");
        let off = (found.damping.at(0.0).value - 0.004).abs();
        assert!(off < hidden.damping, "{off} {hidden:?}");
    }
    let quick = identify(&late(0.0, 4.0), IdentificationSettings::default(), &|_| ()).unwrap();
    assert!(
        quick
            .hidden_lag
            .is_none_or(|hidden| hidden.half_widths < 4.0)
    );
    let quick = identify(
        &late(1.1e-3, 4.0),
        IdentificationSettings::default(),
        &|_| (),
    )
    .unwrap();
    assert!(asked_for(&quick).is_some_and(|told| told.contains("recorded 1.")));
}

#[test]
fn spikes_of_force_and_extension_are_told() {
    let spiked = |signal: fn(&mut Recording) -> &mut Vec<f64>, by: f64| {
        let mut recording = swinging(|_| 0.2, |_| 0.004);
        let values = signal(&mut recording);
        (0..24).for_each(|i| values[20 + 49 * i] += by);
        let found = identify(&recording, IdentificationSettings::default(), &|_| ()).unwrap();
        found.warnings.join("; ")
    };
    let force = spiked(|own| &mut own.force, 0.6);
    assert!(
        force.contains("the force has 24 spikes, the first at 0.10000 s"),
        "{force}"
    );
    let extension = spiked(|own| &mut own.extension, 3.0);
    assert!(
        extension.contains("the extension has 24 spikes"),
        "{extension}"
    );
    assert!(!extension.contains("corners"), "{extension}");
}

/// What a recording asks for by the warnings.
fn asked_for(found: &Identification) -> Option<String> {
    let told = found.warnings.iter();
    let told = told.filter_map(|warning| warning.strip_prefix("the recording indicates "));
    told.map(|told| told.split(':').next().unwrap_or_default().to_owned())
        .next()
}

/// Nothing is asked for by sound recordings, nor where the forms are wrong.
#[test]
fn sound_recordings_are_suspected_of_nothing() {
    for seed in 1..6 {
        let sample = Sample {
            seed,
            ..Sample::default()
        };
        for forms in [[Form::SPLINE; 2], [Form::Constant; 2]] {
            let found = identify(&sample.recording(), settings(forms), &|_| ()).unwrap();
            assert_eq!(asked_for(&found), None, "{seed} {forms:?}");
        }
    }
}

/// Instants that are missing here and there leave a motion that is determined.
#[test]
fn a_recording_of_two_thirds_of_the_instants_has_the_functions_of_the_whole_one() {
    for seed in 1..7 {
        let whole = Sample {
            seed,
            ..Sample::default()
        };
        let whole = whole.recording();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let kept: Vec<usize> = (0..whole.times.len())
            .filter(|_| random.random_range(0..3) > 0)
            .collect();
        let of = |values: &[f64]| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>();
        let part = Recording {
            times: of(&whole.times),
            extension: of(&whole.extension),
            force: of(&whole.force),
            ..whole.clone()
        };
        let found = identify(&part, IdentificationSettings::default(), &|_| ()).unwrap();
        assert!(found.misfit < 1.2, "{seed}: {}", found.misfit);
        for x in PLACES {
            let k = found.stiffness.at(x).value;
            assert!(
                (k / Sample::stiffness(x) - 1.0).abs() < 0.1,
                "{seed} {x}: {k}"
            );
        }
    }
}

/// The way by polynomials, which is taken where the direct one does not converge, leads to the same functions.
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

/// Bands of steady vibrations are too narrow where there is much noise.
#[test]
fn a_steady_vibration_is_told() {
    let told = |amplitudes: [f64; 2]| {
        let recording = swinging_by(amplitudes, |x| 0.2 + 0.01 * x, |_| 0.04);
        let found = identify(&recording, IdentificationSettings::default(), &|_| ()).unwrap();
        let mut warnings = found.warnings.iter();
        warnings.any(|warning| warning.contains("steady vibration"))
    };
    assert!(told([6.0, 0.0]));
    assert!(!told([6.0, 4.0]));
}
