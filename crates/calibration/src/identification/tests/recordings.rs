//! Recordings that bias the functions, or determine them poorly, and the verdicts on them.

use super::*;
use crate::statistics::normal_numbers;

/// Zeros, a drift, a lag and a wrong mass that the misfit hardly shows are named first, with their size.
#[test]
fn what_bends_the_functions_and_hides_from_the_misfit_is_named() {
    type Change<'a> = &'a dyn Fn(&mut Recording);
    let sound = Sample::default().recording();
    let (force, extension) = (largest(&sound.force), largest(&sound.extension));
    let interval = 1e3 * (sound.times[1] - sound.times[0]);
    let count = sound.times.len() as f64;
    let cases: [(&str, f64, Change); 5] = [
        (
            "a zero error of the force of ",
            0.05 * force,
            &|recording| {
                recording.force.iter_mut().for_each(|f| *f += 0.05 * force);
            },
        ),
        (
            "a zero error of the extension of ",
            0.05 * extension,
            &|recording| {
                recording
                    .extension
                    .iter_mut()
                    .for_each(|x| *x += 0.05 * extension);
            },
        ),
        ("a force that drifts by ", 0.1 * force, &|recording| {
            let rows = recording.force.iter_mut().enumerate();
            rows.for_each(|(i, f)| *f += 0.1 * force * i as f64 / count);
        }),
        ("a force that is recorded ", interval, &|recording| {
            recording.force.rotate_right(1);
            recording.force[0] = recording.force[1];
        }),
        (
            "a mass that is smaller by ",
            0.1 / 1.1 * 1.1e6 * sound.mass,
            &|recording| recording.mass *= 1.1,
        ),
    ];
    for (words, size, change) in cases {
        let mut recording = sound.clone();
        change(&mut recording);
        let actual = identified(&recording);
        let message = asked_for(&actual).unwrap_or_default();
        // Zeros of force and extension are much the same: that of the other may be named first.
        let statement = message
            .split(", or alternatively ")
            .find_map(|one| one.strip_prefix(words));
        let statement = statement.unwrap_or_else(|| panic!("{words}: {message}"));
        let numbers: Vec<f64> = statement
            .split([' ', '±'])
            .filter_map(|word| word.parse().ok())
            .collect();
        let [amount, error] = numbers[..] else {
            panic!("{statement}");
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

/// A machine that swings about rest at two frequencies with these amplitudes in mm, with noise of a fiftieth of both signals.
fn swinging(
    [first, second]: [f64; 2],
    stiffness: impl Fn(f64) -> f64,
    damping: impl Fn(f64) -> f64,
) -> Recording {
    let mut normal = normal_numbers(11);
    let mut noise = |size: f64| 0.02 * size * normal();
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
        let recording = swinging([6.0, 4.0], stiffness, damping);
        let actual = identified(&recording);
        let message = asked_for(&actual).unwrap_or_default();
        assert!(message.contains(words), "{words}: {message}");
    }
    let sound = swinging([6.0, 4.0], constant_k, constant_d);
    let actual = identified(&sound);
    assert_eq!(asked_for(&actual), None);
}

/// Inertia does not turn with the sign of the force: a mass that is smaller than nothing, or a lag, would explain the recording too.
#[test]
fn a_force_of_the_wrong_sign_is_named_instead_of_an_impossible_mass() {
    let mut recording = swinging([6.0, 4.0], |_| 0.2, |_| 0.004);
    recording.mass = 1e-3;
    // m ẍ of 6 mm sin 2t + 4 mm sin 5.1t.
    let inertia = |t: f64| -1e-3 * (24.0 * (2.0 * t).sin() + 104.04 * (5.1 * t).sin());
    let forces = recording.force.iter_mut().zip(&recording.times);
    forces.for_each(|(force, t)| *force = -(*force + inertia(*t)));
    let constants = settings([Form::Constant; 2]);
    let actual = identify(&recording, constants, &|_| ()).unwrap();
    let expected = "K(·) is negative: reverse the sign of the force";
    let first = actual.verdict.reasons.first();
    assert!(
        first.is_some_and(|first| first.starts_with(expected)),
        "{:?}",
        actual.verdict
    );
    recording
        .force
        .iter_mut()
        .for_each(|force| *force = -*force);
    let actual = identify(&recording, constants, &|_| ()).unwrap();
    assert_eq!(asked_for(&actual), None);
}

/// What a recording asks for by its verdict.
fn asked_for(actual: &Identification) -> Option<String> {
    let first = actual.verdict.reasons.first()?;
    let asked = first.strip_prefix("the recording indicates ")?;
    Some(asked.split(':').next().unwrap_or_default().to_owned())
}

/// A mass that is 15 % too large leaves a misfit of 1.4: neither standard errors nor intervals are given.
#[test]
fn what_is_not_explained_has_no_intervals() {
    let mut recording = Sample::default().recording();
    recording.mass *= 1.15;
    let actual = identified(&recording);
    assert!(
        actual.misfit < 2.0 && !actual.is_explained(),
        "{}",
        actual.misfit
    );
    for (name, _, function) in actual.functions() {
        let estimate = function.at(2.0);
        assert!(estimate.value.is_finite(), "{name}");
        let ends = [estimate.interval, function.band(2.0)].concat();
        assert!(ends.iter().all(|end| end.is_nan()), "{name}: {ends:?}");
        assert!(estimate.standard_error.is_nan(), "{name}");
    }
}

/// A drift of the extension is no drift of the force, though either would explain much of the other.
#[test]
fn a_drift_of_the_extension_is_named_before_one_of_the_force() {
    let mut recording = Sample::default().recording();
    let count = recording.times.len() as f64;
    for (i, x) in recording.extension.iter_mut().enumerate() {
        *x += 1.3 * i as f64 / count;
    }
    let actual = identified(&recording);
    let asked = asked_for(&actual).unwrap_or_default();
    assert!(
        asked.starts_with("an extension that drifts by 1."),
        "{asked}"
    );
    assert!(!actual.is_explained());
}

/// Splines leave a misfit of 2 of a quick motion without noise, in which nothing can be measured.
#[test]
fn a_recording_without_noise_is_explained() {
    let sample = Sample {
        duration: 2.0,
        instants: 1001,
        ..Sample::default()
    };
    let actual = identified(&sample.exact());
    assert!(actual.verdict.is_sound(), "{:?}", actual.verdict);
    let mut wrong = sample.exact();
    wrong.mass *= 1.01;
    let actual = identified(&wrong);
    let asked = asked_for(&actual).unwrap_or_default();
    assert!(
        asked.starts_with("a mass that is smaller by 2.0"),
        "{asked}"
    );
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
            let actual = identified_with(&sample.recording(), settings(forms));
            assert_eq!(asked_for(&actual), None, "{seed} {forms:?}");
        }
    }
}

/// Bands of steady vibrations are too narrow where there is much noise.
#[test]
fn a_steady_vibration_is_told() {
    let is_steady = |amplitudes: [f64; 2]| {
        let recording = swinging(amplitudes, |x| 0.2 + 0.01 * x, |_| 0.04);
        let actual = identified(&recording);
        let mut doubts = actual.verdict.doubts.iter();
        doubts.any(|doubt| doubt.contains("steady vibration"))
    };
    assert!(is_steady([6.0, 0.0]));
    assert!(!is_steady([6.0, 4.0]));
}

/// A gap of a logger takes away what was not recorded, and nothing else.
#[test]
fn a_gap_leaves_the_functions_as_they_are() {
    let sample = Sample {
        noise: 0.02,
        ..Sample::default()
    };
    let complete = sample.recording();
    for missing in [300..360, 300..400] {
        let kept: Vec<usize> = (0..complete.times.len())
            .filter(|i| !missing.contains(i))
            .collect();
        let actual = identified(&part(&complete, &kept));
        assert!(
            actual.is_explained() && actual.misfit < 1.2,
            "{:?}",
            actual.verdict
        );
        for x in POSITIONS {
            let k = actual.stiffness.at(x).value;
            assert!((k / Sample::stiffness(x) - 1.0).abs() < 0.1, "{x}: {k}");
        }
    }
    // Five rows between two gaps say nothing of rates.
    let lonely: Vec<usize> = (0..complete.times.len())
        .filter(|i| !(300..320).contains(i) && !(325..345).contains(i))
        .collect();
    let actual = identified(&part(&complete, &lonely));
    let mut doubts = actual.verdict.doubts.iter();
    assert!(doubts.any(|doubt| doubt.contains("between neighbouring gaps")));
}

/// Wrong rows look like a lag, or like noise.
#[test]
fn wrong_rows_of_the_force_are_named_and_nothing_else() {
    let mut recording = Sample::default().recording();
    for row in [100, 400, 700] {
        recording.force[row] += 1.5;
    }
    let actual = identified(&recording);
    let [reason] = &actual.verdict.reasons[..] else {
        panic!("{:?}", actual.verdict);
    };
    let expected = "the force lies far from its values before and after in the rows of numbers 101 (0.33333 s), 401 (1.3333 s), 701 (2.3333 s): remove";
    assert!(reason.starts_with(expected), "{reason}");
}

/// The first number after some words.
fn size(text: &str, words: &str) -> f64 {
    let after = text.split(words).nth(1).unwrap_or_default();
    let number = after.split(' ').next().unwrap_or_default();
    number.parse().unwrap_or(f64::NAN)
}

/// K(·) x does not vanish at rest where either zero is off; which one it is only the machine tells.
#[test]
fn a_zero_error_of_either_signal_is_told_as_one_of_both_with_its_whole_size() {
    let mut recording = Sample::default().recording();
    recording.extension.iter_mut().for_each(|x| *x += 1.0);
    let actual = identified(&recording);
    let asked = asked_for(&actual).unwrap_or_default();
    assert!(
        size(&asked, "a zero error of the force of ") < 0.0,
        "{asked}"
    );
    let extension = size(&asked, "a zero error of the extension of ");
    assert!((extension - 1.0).abs() < 0.25, "{asked}");
    let remedy = "look up at the machine which zero is off";
    assert_contains(&actual.verdict.reasons[0], remedy);
}

/// A force that is two sampling intervals late: the noise of its rates makes it no smaller.
#[test]
fn a_lag_has_its_whole_size() {
    let mut recording = Sample::default().recording();
    let late = 1e3 * (recording.times[2] - recording.times[0]);
    recording.force.rotate_right(2);
    let first = recording.force[2];
    recording.force[..2].fill(first);
    let actual = identified(&recording);
    let asked = asked_for(&actual).unwrap_or_default();
    let lag = size(&asked, "a force that is recorded ");
    assert!((lag / late - 1.0).abs() < 0.12, "{asked}");
}
