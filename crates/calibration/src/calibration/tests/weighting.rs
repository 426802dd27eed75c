//! What is said of the residuals of laws with noise that is proportional to the stress, or the same everywhere, by the weights
//! that suit it; and of strains that were commanded.

use super::helpers::{Coverage, fit_with, law, parsed, uniaxial, weighted};
use crate::calibration::*;
use crate::statistics::normal_numbers;

const NOISE: f64 = 0.03;

/// A law, its values and the stretch to which it is pulled.
type Subject = (&'static str, &'static [f64], f64);

const SUBJECTS: [Subject; 5] = [
    ("neo-hooke", &[0.05], 2.0),
    ("mooney-rivlin", &[0.04, 0.02], 2.0),
    ("yeoh", &[0.03, 0.01, 0.002], 2.0),
    ("gent", &[0.1, 30.0], 2.0),
    ("ogden-1", &[0.05, 3.0], 2.0),
];

/// A test of a law with `points` points and noise that suits the weighting.
fn measured(
    test: &str,
    subject: Subject,
    weighting: Weighting,
    points: usize,
    seed: u64,
) -> TestData {
    let (name, values, most) = subject;
    let law = law(name, values);
    let stress = |x: f64| super::helpers::stress(&*law, test, x);
    let scale = 0.3 * stress(most - 1.0);
    let mut normal = normal_numbers(seed);
    let mut text = format!("# test: {test}\nstretch [-],nominal_stress [MPa]\n");
    for row in 0..points {
        let x = 0.02 + (most - 1.02) * row as f64 / (points - 1) as f64;
        let size = match weighting {
            Weighting::Absolute => scale,
            Weighting::Relative => stress(x),
        };
        let noise = NOISE * size * normal();
        text += &format!("{:.10},{:.10}\n", 1.0 + x, stress(x) + noise);
    }
    parsed(&text)
}

fn fitted(name: &str, tests: &[TestData], weighting: Weighting) -> Quality {
    fit_with(name, tests, &weighted(weighting)).unwrap().quality
}

fn coverage(tests: &[&str], subject: Subject, weighting: Weighting) -> Coverage {
    let points = 40 / tests.len();
    Coverage::over_seeds(subject.1, |seed| {
        let test = |(name, number): (&&str, u64)| {
            measured(name, subject, weighting, points, 3 * seed + number)
        };
        let data: Vec<TestData> = tests.iter().zip(0..).map(test).collect();
        fitted(subject.0, &data, weighting)
    })
}

/// One fit in a hundred may be called systematic, and one interval in twenty may miss the truth.
#[test]
fn noise_that_suits_the_weights_is_called_noise_and_intervals_hold_the_truth() {
    const ALL: [&str; 3] = ["uniaxial", "planar", "equibiaxial"];
    for weighting in [Weighting::Absolute, Weighting::Relative] {
        let mut sum = Coverage::default();
        for subject in SUBJECTS {
            let actual = coverage(&ALL[..1], subject, weighting);
            assert!(
                actual.systematic <= 3,
                "{} {weighting:?}: {actual:?}",
                subject.0
            );
            sum = sum.plus(actual);
        }
        let joint = coverage(&ALL, ("mooney-rivlin", &[0.04, 0.01], 1.6), weighting);
        assert!(joint.systematic <= 3 && joint.vague == 0, "{joint:?}");
        sum = sum.plus(joint);
        // A parameter at a bound has no interval that holds the truth.
        let share = sum.held as f64 / (sum.intervals + sum.unknown) as f64;
        assert!(sum.systematic <= 8, "{weighting:?}: {sum:?}");
        assert!((0.92..=0.99).contains(&share), "{weighting:?}: {sum:?}");
    }
}

#[test]
fn a_wrong_law_is_found_by_either_weighting() {
    let subject = ("yeoh", &[0.03, 0.01, 0.002][..], 2.5);
    for weighting in [Weighting::Absolute, Weighting::Relative] {
        let actual = (0..10).filter(|seed| {
            let data = [measured("uniaxial", subject, weighting, 40, *seed)];
            let verdict = fitted("neo-hooke", &data, weighting).verdict.unwrap();
            verdict.answer == Answer::Systematic
        });
        assert_eq!(actual.count(), 10, "{weighting:?}");
    }
}

/// Noise of 10 % in measured weights makes stresses softer by 2 %, which is four standard errors of 400 points.
#[test]
fn proportional_noise_does_not_make_a_law_softer() {
    let mut normal = normal_numbers(1);
    let mut rows = String::new();
    for row in 0..4000 {
        let stretch = 1.1 + row as f64 / 4000.0;
        let stress = 0.1 * (stretch - stretch.powi(-2)) * (1.0 + 0.1 * normal());
        rows += &format!("{stretch:.8},{stress:.10}\n");
    }
    let actual = fitted("neo-hooke", &[uniaxial(&rows)], Weighting::Relative);
    let one = actual.estimates[0];
    assert!((one.value / 0.05 - 1.0).abs() < 0.006, "{one:?}");
    assert!(one.interval[0] < 0.05 && 0.05 < one.interval[1], "{one:?}");
}

/// Lines of stretch and stress of neo-Hooke with C₁₀ = 0.05 MPa, with noise as a share of the largest stress.
fn neo_hooke(
    stretches: &[f64],
    noise: f64,
    seed: u64,
    line: impl Fn(f64, f64) -> String,
) -> String {
    let stress = |stretch: f64| 0.1 * (stretch - stretch.powi(-2));
    let largest = stretches.iter().copied().map(stress).fold(0.0, f64::max);
    let mut normal = normal_numbers(seed);
    let row = |l: &f64| line(*l, stress(*l) + noise * largest * normal());
    stretches.iter().map(row).collect()
}

fn answer(data: TestData) -> Answer {
    let actual = fitted("neo-hooke", &[data], Weighting::Absolute);
    actual.verdict.unwrap().answer
}

#[test]
fn commanded_strains_are_no_rounding() {
    let replicates: Vec<f64> = (0..30)
        .map(|row| 1.0 + 0.1 * (1 + row / 3) as f64)
        .collect();
    let percent: Vec<f64> = (1..=30).map(|row| 1.0 + 0.01 * row as f64).collect();
    for seed in 0..5 {
        for decimals in [1, 6] {
            let rows = neo_hooke(&replicates, 0.03, seed, |l, s| {
                format!("{l:.decimals$},{s:.6}\n")
            });
            assert!(answer(uniaxial(&rows)).has_intervals(), "{seed} {decimals}");
        }
        let rows = neo_hooke(&percent, 0.003, seed, |l, s| {
            format!("{:.0},{:.4}\n", 100.0 * (l - 1.0), 1e3 * s)
        });
        let head = "# test: uniaxial\nnominal_strain [%],nominal_stress [kPa]";
        let data = parsed(&format!("{head}\n{rows}"));
        assert!(answer(data).has_intervals(), "{seed}");
    }
}

#[test]
fn a_machine_s_unit_of_length_does_not_change_the_verdict() {
    let stretches: Vec<f64> = (0..=80).map(|row| 1.0 + 0.005 * row as f64).collect();
    for (noise, force, noisy) in [(0.01, 6, true), (0.0, 2, false)] {
        for (unit, factor) in [("mm", 1.0), ("in", 25.4), ("m", 1e3)] {
            let rows = neo_hooke(&stretches, noise, 1, |l, s| {
                format!("{:.7},{:.force$}\n", 20.0 * (l - 1.0) / factor, 10.0 * s)
            });
            let head = "# test: uniaxial; length: 20 mm; area: 10 mm^2; zero: none";
            let data = parsed(&format!("{head}\nExtension [{unit}],Load [N]\n{rows}"));
            assert_eq!(answer(data).has_intervals(), noisy, "{unit} {noise}");
        }
    }
}

/// Stresses with three decimals, and strains every 1/60 with three.
#[test]
fn data_that_were_rounded_are_called_so() {
    let stretches: Vec<f64> = (1..=60).map(|row| 1.0 + f64::from(row) / 60.0).collect();
    for (strain, stress) in [(10, 3), (3, 10), (2, 3)] {
        let rows = neo_hooke(&stretches, 0.0, 1, |l, s| {
            format!("{l:.strain$},{s:.stress$}\n")
        });
        let answer = answer(uniaxial(&rows));
        assert_eq!(answer, Answer::Rounding, "{strain} {stress}");
    }
}
