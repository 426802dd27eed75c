//! Noise that grows with the stress, and specimens that differ: what intervals of even noise do not hold.

use std::collections::BTreeSet;

use super::quality::Quality;
use crate::calibration::data::{Observation, SPECIMEN, TestData};
use crate::calibration::settings::Weighting;
use crate::material::HyperelasticLaw;
use crate::statistics::cochran;

/// Standard normal deviates beyond which something is no chance: one in a thousand, on both sides.
const CLEARLY: f64 = 3.29;

/// Fewer rows tell nothing of either.
const FEWEST: usize = 10;

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
    let residuals = WeightedResiduals { law, weighting };
    let uneven = has_intervals.then(|| uneven(quality, weighting)).flatten();
    let differing = residuals.differing(tests, has_intervals);
    uneven.into_iter().chain(differing).collect()
}

struct WeightedResiduals<'a> {
    law: &'a dyn HyperelasticLaw,
    weighting: Weighting,
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

impl WeightedResiduals<'_> {
    /// The law's stress at an observation, and how far it is from the measured one, both by the weights of the fit.
    fn fitted_and_residual(&self, test: &TestData, one: &Observation) -> [f64; 2] {
        let fitted = test.stress_of(self.law, one);
        let weight = self.weighting.weight_of(test, fitted);
        [weight * fitted, weight * (one.stress - fitted)]
    }

    /// How many times the law's stress a test measured, and its variance by the noise of its own, neighbours of which may correlate.
    fn factor(&self, test: &TestData) -> Option<[f64; 2]> {
        let count = test.observations.len();
        let rows = test.observations.iter();
        let pairs: Vec<[f64; 2]> = rows
            .map(|one| self.fitted_and_residual(test, one))
            .collect();
        let square: f64 = pairs.iter().map(|[fitted, _]| fitted * fitted).sum();
        let along: f64 = pairs.iter().map(|[fitted, left]| fitted * left).sum();
        let factor = along / square;
        let rest: Vec<f64> = pairs
            .iter()
            .map(|[fitted, left]| left - factor * fitted)
            .collect();
        let squares: f64 = rest.iter().map(|left| left * left).sum();
        let products: f64 = rest.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let correlation = (products / squares).clamp(0.0, 0.99);
        let fewer = (1.0 + correlation) / (1.0 - correlation);
        let variance = fewer * squares / (count as f64 - 1.0) / square;
        (count >= FEWEST && variance > 0.0).then_some([1.0 + factor, variance])
    }

    /// Whether tests of one kind differ by more than their noise: those of several specimens, or those of one that the law does not describe.
    fn differing(&self, tests: &[TestData], has_intervals: bool) -> Option<String> {
        let alike = |test: &&TestData| (test.test, &test.axes) == (tests[0].test, &tests[0].axes);
        if tests.len() < 2 || !tests.iter().all(|test| alike(&test)) {
            return None;
        }
        let factors: Option<Vec<[f64; 2]>> = tests.iter().map(|test| self.factor(test)).collect();
        let factors = factors?;
        let freedom = factors.len() as f64 - 1.0;
        // χ² by Wilson's and Hilferty's cube root.
        let deviate = ((cochran(&factors) / freedom).cbrt() - 1.0 + 2.0 / (9.0 * freedom))
            / (2.0 / (9.0 * freedom)).sqrt();
        (deviate > CLEARLY).then(|| {
            let factors: Vec<f64> = factors.iter().map(|[factor, _]| *factor).collect();
            difference(&factors, count_of_specimens(tests), has_intervals)
        })
    }
}

/// How many specimens the tests state; `None` where not all of them state one.
fn count_of_specimens(tests: &[TestData]) -> Option<usize> {
    let names: Option<BTreeSet<&String>> =
        tests.iter().map(|test| test.head.get(SPECIMEN)).collect();
    names.map(|names| names.len())
}

/// The warning about tests that are some times as stiff as the law.
fn difference(factors: &[f64], specimens: Option<usize>, has_intervals: bool) -> String {
    let count = factors.len() as f64;
    let mean = factors.iter().sum::<f64>() / count;
    let spread = factors.iter().map(|factor| (factor - mean).powi(2));
    let of_mean = 100.0 * (spread.sum::<f64>() / (count - 1.0) / count).sqrt();
    let stiffness: Vec<String> = factors
        .iter()
        .map(|factor| format!("{factor:.3}"))
        .collect();
    let differ = format!(
        "the tests differ by more than the noise of each: they are {} times as stiff as the law",
        stiffness.join(", ")
    );
    let of_one = "this law does not describe all of its protocols";
    let of_several = format!(
        "they differ, and their mean gives the material's stiffness to ± {of_mean:.2} % (standard error); {}",
        if has_intervals {
            "the intervals apply to these specimens only"
        } else {
            "fit each specimen by itself to judge the law"
        }
    );
    match specimens {
        Some(1) => format!("{differ}. They are of one specimen: {of_one}"),
        Some(_) => format!("{differ}. The specimens: {of_several}"),
        None => format!(
            "{differ}. Either they are of one specimen: then {of_one}. Or they are of several: then {of_several}. State which with --specimen NAME \
             for one, or with `# {SPECIMEN}: NAME` at the top of each file"
        ),
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use crate::calibration::{FitSettings, TestData, Weighting, fit};
    use crate::document::Statements;
    use crate::material::registry::Law;

    #[test]
    fn protocols_of_one_specimen_are_no_specimens_that_differ() {
        let warning = |specimens| super::difference(&[0.9, 1.1], specimens, false);
        let [one, several, unknown] = [Some(1), Some(2), None].map(warning);
        let says = |text: &str| {
            [
                one.contains(text),
                several.contains(text),
                unknown.contains(text),
            ]
        };
        assert_eq!(
            says("does not describe all of its protocols"),
            [true, false, true]
        );
        assert_eq!(says("fit each specimen by itself"), [false, true, true]);
        assert_eq!(says("--specimen NAME"), [false, false, true]);
    }

    /// Tension of a neo-Hookean strip with noise of a size for each stress.
    fn tension(c10: f64, seed: u64, noise: fn(f64) -> f64) -> TestData {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut text = "# test: uniaxial\nstretch [-],nominal_stress [MPa]\n".to_owned();
        for row in 0..80 {
            let stretch = 1.02 + 0.0125 * f64::from(row);
            let stress = 2.0 * c10 * (stretch - stretch.powi(-2));
            let draw: f64 = StandardNormal.sample(&mut random);
            text += &format!("{stretch},{:.7}\n", stress + noise(stress) * draw);
        }
        TestData::parse("a.csv", &text, &Statements::default()).unwrap()
    }

    fn warned(tests: &[TestData], weighting: Weighting, words: &str) -> bool {
        let settings = FitSettings {
            weighting,
            ..FitSettings::default()
        };
        let found = fit(Law::named("neo-hooke").unwrap(), tests, &settings).unwrap();
        assert!(found.quality.has_intervals());
        found
            .quality
            .warnings
            .iter()
            .any(|told| told.contains(words))
    }

    #[test]
    fn noise_that_grows_with_the_stress_is_told_and_even_noise_is_not() {
        let grows = "grow with the stress";
        let mut found = 0;
        for seed in 0..10 {
            let uneven = tension(0.05, seed, |stress| 0.05 * stress);
            found += usize::from(warned(
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
        assert!(found >= 6, "{found} of 10");
    }

    #[test]
    fn specimens_that_differ_by_more_than_their_noise_are_told() {
        let differ = "tests differ";
        let of = |moduli: [f64; 3]| {
            let tests = moduli
                .iter()
                .zip(0..)
                .map(|(c10, seed)| tension(*c10, seed, |_| 0.003));
            warned(&tests.collect::<Vec<_>>(), Weighting::Absolute, differ)
        };
        assert!(of([0.0502, 0.0518, 0.0509]));
        // So different that all residuals together are systematic.
        assert!(of([0.045, 0.055, 0.05]));
        assert!(!of([0.05; 3]));
    }
}
