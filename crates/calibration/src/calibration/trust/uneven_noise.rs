//! Noise that grows with the stress, and specimens that differ: intervals for noise of one size do not include either.

use std::collections::BTreeSet;

use super::quality::Quality;
use crate::calibration::data::{Observation, Test, TestData};
use crate::calibration::settings::Weighting;
use crate::material::HyperelasticLaw;
use crate::statistics::cochran;

/// The standard normal deviate that is exceeded by chance in one of a thousand cases, on both sides.
const SIGNIFICANT: f64 = 3.29;

/// Fewest rows that are judged.
const FEWEST: usize = 10;

/// The law's stresses at the rows of a protocol, and the residuals, both times the weights of the fit.
type Pairs = Vec<[f64; 2]>;

/// The warnings of a fit whose residuals are judged: noise that grows where they are noise, and specimens that differ in any case.
pub fn noise_warnings(
    quality: &Quality,
    law: &dyn HyperelasticLaw,
    tests: &[TestData],
    weighting: Weighting,
) -> Vec<String> {
    if quality.verdict.is_none() {
        return Vec::new();
    }
    let has_intervals = quality.has_intervals();
    let uneven = has_intervals.then(|| uneven(quality, weighting)).flatten();
    let protocols = |test: &TestData| pairs(test, law, weighting);
    let specimens = specimens(tests, protocols, has_intervals);
    uneven.into_iter().chain(specimens).collect()
}

/// The warning about weights that do not suit the noise.
fn uneven(quality: &Quality, weighting: Weighting) -> Option<String> {
    let does_not_suit = quality.verdict?.suits_other_weights;
    does_not_suit.then(|| match weighting {
        Weighting::Absolute => {
            "residuals grow with the stress, which the intervals take into account; `--weighting relative` uses such data better".into()
        }
        Weighting::Relative => {
            "relative residuals are largest where the stress is small, which the intervals take into account; see `--weighting absolute`".into()
        }
    })
}

/// The pairs of each protocol of a test.
fn pairs(test: &TestData, law: &dyn HyperelasticLaw, weighting: Weighting) -> Vec<Pairs> {
    let pair = |one: &Observation| {
        let fitted = test.stress_of(law, one);
        let weight = weighting.weight_of(test, fitted);
        [weight * fitted, weight * (one.stress - fitted)]
    };
    let all = test.protocols().into_iter();
    let protocols = all.filter(|rows| rows.len() >= FEWEST);
    protocols
        .map(|rows| rows.iter().map(pair).collect())
        .collect()
}

/// Whether specimens, or protocols, of one kind of test differ from the law by more than their noise. Only a user knows which of them are
/// one specimen: the residuals of a wrong law and of specimens that differ look the same.
fn specimens(
    tests: &[TestData],
    protocols: impl Fn(&TestData) -> Vec<Pairs>,
    has_intervals: bool,
) -> Option<String> {
    let alike = |test: &TestData| (test.test, &test.axes) == (tests[0].test, &tests[0].axes);
    if !tests.iter().all(alike) {
        return None;
    }
    let names: BTreeSet<_> = tests
        .iter()
        .filter_map(|test| test.specimen.as_ref())
        .collect();
    let is_stated = tests.iter().all(|test| test.specimen.is_some());
    if is_stated && names.len() > 1 {
        let of = |name: &&String| {
            let of_specimen = tests
                .iter()
                .filter(|test| test.specimen.as_ref() == Some(name));
            of_specimen.flat_map(&protocols).flatten().collect()
        };
        let groups: Vec<Pairs> = names.iter().map(of).collect();
        return Some(specimens_differ(&differing(&groups)?, has_intervals));
    }
    let what = match tests[0].test {
        Test::Biaxial => "protocols",
        _ => "tests",
    };
    let each: Vec<Pairs> = tests.iter().flat_map(protocols).collect();
    let differ = format!(
        "the stresses of the {} {what} are {} times those of the law, which is more than the noise of each",
        each.len(),
        listed(&differing(&each)?)
    );
    Some(if is_stated {
        format!("this law does not explain the specimen: {differ}; try another law")
    } else {
        format!(
            "{differ}. Either this law does not explain them, or they are specimens that differ: the residuals of both look alike. State \
             which: `--one-specimen`, or `# specimen name: NAME` in each file"
        )
    })
}

/// The factors of some groups of protocols where they differ by more than chance.
fn differing(groups: &[Pairs]) -> Option<Vec<f64>> {
    if groups.len() < 2 {
        return None;
    }
    let factors: Option<Vec<[f64; 2]>> = groups.iter().map(factor).collect();
    let factors = factors?;
    let freedom = factors.len() as f64 - 1.0;
    // χ² by Wilson's and Hilferty's cube root.
    let deviate = ((cochran(&factors) / freedom).cbrt() - 1.0 + 2.0 / (9.0 * freedom))
        / (2.0 / (9.0 * freedom)).sqrt();
    (deviate > SIGNIFICANT).then(|| factors.iter().map(|[factor, _]| *factor).collect())
}

/// How many times the law's stress was measured, and its variance by the noise of the rows, neighbours of which may correlate.
fn factor(pairs: &Pairs) -> Option<[f64; 2]> {
    let square: f64 = pairs.iter().map(|[fitted, _]| fitted * fitted).sum();
    let along: f64 = pairs
        .iter()
        .map(|[fitted, residual]| fitted * residual)
        .sum();
    let factor = along / square;
    let remainders = pairs
        .iter()
        .map(|[fitted, residual]| residual - factor * fitted);
    let rest: Vec<f64> = remainders.collect();
    let squares: f64 = rest.iter().map(|residual| residual * residual).sum();
    let products: f64 = rest.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let correlation = (products / squares).clamp(0.0, 0.99);
    let fewer = (1.0 + correlation) / (1.0 - correlation);
    let variance = fewer * squares / (pairs.len() as f64 - 1.0) / square;
    (pairs.len() >= FEWEST && variance > 0.0).then_some([1.0 + factor, variance])
}

/// Numbers of three decimals.
fn listed(factors: &[f64]) -> String {
    let each: Vec<String> = factors
        .iter()
        .map(|factor| format!("{factor:.3}"))
        .collect();
    each.join(", ")
}

/// The warning about specimens with some stiffnesses over that of the law.
fn specimens_differ(factors: &[f64], has_intervals: bool) -> String {
    let count = factors.len() as f64;
    let mean = factors.iter().sum::<f64>() / count;
    let spread = factors
        .iter()
        .map(|factor| (factor - mean).powi(2))
        .sum::<f64>();
    let of_mean = 100.0 * (spread / (count - 1.0) / count).sqrt();
    let then = if has_intervals {
        "The intervals apply to these specimens only"
    } else {
        "This alone makes the residuals of a joint fit systematic: fit each specimen by itself to judge the law"
    };
    format!(
        "the specimens differ by more than the noise of each: they are {} times as stiff as the law. {then}; their mean gives the \
         material's stiffness to ± {of_mean:.2} % (standard error)",
        listed(factors)
    )
}

#[cfg(test)]
mod tests {
    use crate::assertions::assert_contains;
    use crate::calibration::tests::helpers::{fit_with, fitted, parsed, uniaxial, weighted};
    use crate::calibration::{TestData, Weighting};
    use crate::statistics::normal_numbers;

    /// Tension of a neo-Hookean strip with noise of a size for each stress.
    fn tension(c10: f64, seed: u64, noise: fn(f64) -> f64) -> TestData {
        let mut normal = normal_numbers(seed);
        let mut rows = String::new();
        for row in 0..80 {
            let stretch = 1.02 + 0.0125 * f64::from(row);
            let stress = 2.0 * c10 * (stretch - stretch.powi(-2));
            rows += &format!("{stretch},{:.7}\n", stress + noise(stress) * normal());
        }
        uniaxial(&rows)
    }

    fn warned(tests: &[TestData], weighting: Weighting, words: &str) -> bool {
        let result = fit_with("neo-hooke", tests, &weighted(weighting)).unwrap();
        assert!(result.quality.has_intervals());
        result
            .quality
            .warnings
            .iter()
            .any(|message| message.contains(words))
    }

    #[test]
    fn noise_that_grows_with_the_stress_is_told_and_even_noise_is_not() {
        let grows = "grow with the stress";
        let mut result = 0;
        for seed in 0..10 {
            let uneven = tension(0.05, seed, |stress| 0.05 * stress);
            result += usize::from(warned(
                std::slice::from_ref(&uneven),
                Weighting::Absolute,
                grows,
            ));
            assert!(
                !warned(&[uneven], Weighting::Relative, "relative residuals"),
                "{seed}"
            );
            let even = tension(0.05, seed, |_| 0.002);
            assert!(!warned(&[even], Weighting::Absolute, grows), "{seed}");
        }
        // Of eighty points some seven in ten.
        assert!(result >= 6, "{result} of 10");
    }

    /// The warnings of a fit of neo-Hooke to three strips of some moduli, whose specimens have some names.
    fn of_strips(moduli: [f64; 3], names: [Option<&str>; 3]) -> String {
        let tests = moduli.iter().zip(names).zip(0..);
        let tests = tests.map(|((c10, name), seed)| TestData {
            specimen: name.map(str::to_owned),
            ..tension(*c10, seed, |_| 0.003)
        });
        let tests: Vec<TestData> = tests.collect();
        let result = fitted("neo-hooke", &tests);
        assert!(result.quality.has_intervals());
        result.quality.warnings.join("; ")
    }

    #[test]
    fn tests_that_differ_by_more_than_their_noise_are_specimens_or_a_wrong_law() {
        let unstated = [None; 3];
        // The second so different that all residuals together are systematic.
        for moduli in [[0.0502, 0.0518, 0.0509], [0.045, 0.055, 0.05]] {
            let warned = of_strips(moduli, unstated);
            assert!(
                warned.contains("Either this law does not explain them, or they are specimens")
            );
            assert!(!warned.contains("their mean gives"), "{warned}");
            let warned = of_strips(moduli, [Some("a"), Some("b"), Some("c")]);
            assert_contains(&warned, "the specimens differ by more than the noise");
            let warned = of_strips(moduli, [Some("a"); 3]);
            assert_contains(&warned, "this law does not explain the specimen");
        }
        for names in [unstated, [Some("a"); 3], [Some("a"), Some("b"), Some("c")]] {
            let warned = of_strips([0.05; 3], names);
            assert!(!warned.contains("specimen"), "{warned}");
        }
    }

    /// One sheet of Fung's energy c (e^Q − 1)/2, Q = 6 E₁² + 2.5 E₂² + 2 E₁ E₂ of Green's strains, at a ratio of strains.
    fn protocol(ratio: [f64; 2], seed: u64) -> String {
        let mut normal = normal_numbers(seed);
        let mut rows = String::new();
        for row in 0..30 {
            let stretch = ratio.map(|share| 1.0 + 0.3 * share * f64::from(row) / 29.0);
            let [e, f] = stretch.map(|l| 0.5 * (l * l - 1.0));
            let energy = 0.01 * (6.0 * e * e + 2.5 * f * f + 2.0 * e * f).exp();
            let stresses = [
                energy * (6.0 * e + f) * stretch[0] + 2e-4 * normal(),
                energy * (2.5 * f + e) * stretch[1] + 2e-4 * normal(),
            ];
            rows += &format!(
                "{},{},{:.6},{:.6}\n",
                stretch[0], stretch[1], stresses[0], stresses[1]
            );
        }
        rows
    }

    #[test]
    fn protocols_of_one_specimen_are_judged_alike_in_one_file_and_in_several() {
        let ratios = [[1.0, 1.0], [1.0, 0.5], [0.5, 1.0]];
        let parts: Vec<String> = (0..)
            .zip(ratios)
            .map(|(seed, ratio)| protocol(ratio, seed))
            .collect();
        let warned = |files: &[String], stated: &str| {
            let head = format!(
                "# test: biaxial\n{stated}stretch_1 [-],stretch_2 [-],nominal_stress_1 [MPa],nominal_stress_2 [MPa]\n"
            );
            let read = |rows: &String| parsed(&format!("{head}{rows}"));
            let tests: Vec<TestData> = files.iter().map(read).collect();
            let result = fitted("fung-demiray", &tests);
            let mut warnings = result.quality.warnings.into_iter();
            warnings.find(|one| one.contains("3 protocols")).unwrap()
        };
        let in_one = warned(&[parts.concat()], "");
        assert_eq!(in_one, warned(&parts, ""));
        assert_contains(&in_one, "--one-specimen");
        let stated = warned(&parts, "# specimen name: a\n");
        assert!(
            stated.starts_with("this law does not explain the specimen"),
            "{stated}"
        );
    }
}
