//! Intervals where more than white noise of one size makes parameters uncertain: zeros that were found in records, parameters at
//! bounds, tests of unequal noise.

use super::helpers::{Coverage, fitted, law, parsed};
use crate::calibration::*;
use crate::statistics::normal_numbers;

/// A law with its values.
type Subject = (&'static str, &'static [f64]);

/// Nominal stress in a usual test.
fn stress((name, values): Subject, test: &str, x: f64) -> f64 {
    super::helpers::stress(&*law(name, values), test, x)
}

/// Rows with noise of a standard deviation.
fn rows(points: usize, noise: f64, seed: u64, row: &dyn Fn(f64) -> [f64; 2]) -> String {
    let mut normal = normal_numbers(seed);
    let line = |index: usize| {
        let [x, y] = row(index as f64 / (points - 1) as f64);
        format!("{x:.9},{:.9}\n", y + noise * normal())
    };
    (0..points).map(line).collect()
}

/// Over the tests of all seeds.
fn coverage((name, truth): Subject, tests: &(dyn Fn(u64) -> Vec<TestData> + Sync)) -> Coverage {
    Coverage::over_seeds(truth, |seed| fitted(name, &tests(seed)).quality)
}

const PULLED: [Subject; 4] = [
    ("neo-hooke", &[0.05]),
    ("mooney-rivlin", &[0.03, 0.02]),
    ("yeoh", &[0.03, 0.01, 0.002]),
    ("ogden-1", &[0.05, 3.0]),
];

/// A record of a machine, of a specimen of 20 mm and 10 mm², to 80 %.
fn record(subject: Subject, beginning: &str, seed: u64) -> Vec<TestData> {
    let force = |x: f64| 10.0 * stress(subject, "uniaxial", x.max(0.0));
    let noise = 3e-3 * force(0.8);
    let row = |share: f64| match beginning {
        "preload" => [20.0 * 0.77 * share, force(0.03 + 0.77 * share)],
        "slack" => [20.0 * (0.8 * share), force(0.8 * share - 0.05)],
        _ => [20.0 * 0.8 * share, force(0.8 * share) - 0.05 * force(0.8)],
    };
    let head = "# test: uniaxial; length: 20 mm; area: 10 mm^2\nExtension [mm],Load [N]\n";
    vec![parsed(&(head.to_owned() + &rows(200, noise, seed, &row)))]
}

#[test]
fn intervals_hold_the_uncertainty_of_zeros_that_were_found() {
    for beginning in ["preload", "slack", "offset"] {
        let each =
            PULLED.map(|subject| coverage(subject, &|seed| record(subject, beginning, seed)));
        let all = each.into_iter().fold(Coverage::default(), Coverage::plus);
        assert!(all.fits >= 150, "{beginning}: {all:?}");
        assert!((0.9..=0.99).contains(&all.share()), "{beginning}: {all:?}");
    }
}

#[test]
fn intervals_beside_a_parameter_at_its_bound_hold_the_truth() {
    let subject: Subject = ("neo-hooke-simo-pister", &[0.05, 0.49]);
    let actual = coverage(subject, &|seed| {
        let row = |share: f64| [1.0 + 0.8 * share, stress(subject, "uniaxial", 0.8 * share)];
        let noise = 0.01 * stress(subject, "uniaxial", 0.8);
        let head = "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n";
        vec![parsed(&(head.to_owned() + &rows(40, noise, seed, &row)))]
    });
    assert!(actual.intervals > 50 && actual.share() > 0.9, "{actual:?}");
}

#[test]
fn tests_of_unequal_noise_have_intervals_that_hold_the_truth() {
    let subject: Subject = ("mooney-rivlin", &[0.04, 0.01]);
    for noises in [[1e-2, 1e-3, 1e-3], [1e-3, 1e-3, 1e-2], [1e-3; 3]] {
        let actual = coverage(subject, &|seed| {
            let tests = ["uniaxial", "planar", "equibiaxial"]
                .into_iter()
                .enumerate();
            let test = |(number, test): (usize, &str)| {
                let row = |share: f64| {
                    [
                        1.02 + 0.6 * share,
                        stress(subject, test, 0.02 + 0.6 * share),
                    ]
                };
                let noise = noises[number] * stress(subject, test, 0.6);
                let seed = 3 * seed + number as u64;
                let head = format!("# test: {test}\nstretch [-],nominal_stress [MPa]\n");
                parsed(&(head + &rows(20, noise, seed, &row)))
            };
            tests.map(test).collect()
        });
        assert!(actual.fits >= 37, "{noises:?}: {actual:?}");
        assert!(
            (0.88..=1.0).contains(&actual.share()),
            "{noises:?}: {actual:?}"
        );
    }
}

/// A plate that comes into contact after a tenth of its way: the force before, which is subtracted, is the mean of few readings.
#[test]
fn the_reading_without_load_is_uncertain_too() {
    let subject = ("neo-hooke", &[0.05][..]);
    let force = |x: f64| -8.0 * stress(subject, "uniaxial", -x.max(0.0));
    let row = |share: f64| [20.0 * 0.44 * share, force(0.44 * share - 0.04)];
    let head = "# test: compression; length: 20 mm; area: 8 mm^2\nExtension [mm],Load [N]\n";
    let errors = (0..120).map(|seed| {
        let table = head.to_owned() + &rows(100, 2e-3, seed, &row);
        let quality = fitted(subject.0, &[parsed(&table)]).quality;
        let estimate = quality.estimates[0];
        (estimate.value - subject.1[0]) / estimate.standard_error
    });
    let errors: Vec<f64> = errors.collect();
    // In standard errors: 1.4 with the reading taken as known.
    let size = (errors.iter().map(|error| error * error).sum::<f64>() / 120.0).sqrt();
    assert!((0.8..1.2).contains(&size), "{size}");
}
