//! Noise that grows with the stress, and specimens that differ: what intervals of even noise do not hold.

use super::quality::Quality;
use crate::calibration::data::{Observation, TestData};
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
    let specimens = residuals.specimens(tests, has_intervals);
    uneven.into_iter().chain(specimens).collect()
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

    /// Whether specimens of one kind of test differ by more than their noise.
    fn specimens(&self, tests: &[TestData], has_intervals: bool) -> Option<String> {
        let alike = |test: &&TestData| (test.test, &test.axes) == (tests[0].test, &tests[0].axes);
        if tests.len() < 2 || !tests.iter().all(|test| alike(&test)) {
            return None;
        }
        let factors: Option<Vec<[f64; 2]>> = tests.iter().map(|test| self.factor(test)).collect();
        let factors = factors?;
        let squares = cochran(&factors);
        let freedom = factors.len() as f64 - 1.0;
        // χ² by Wilson's and Hilferty's cube root.
        let deviate = ((squares / freedom).cbrt() - 1.0 + 2.0 / (9.0 * freedom))
            / (2.0 / (9.0 * freedom)).sqrt();
        (deviate > CLEARLY).then(|| {
            let plain = factors.iter().map(|[factor, _]| factor).sum::<f64>() / factors.len() as f64;
            let spread = factors.iter().map(|[factor, _]| (factor - plain).powi(2)).sum::<f64>();
            let of_mean = 100.0 * (spread / freedom / factors.len() as f64).sqrt();
            let told: Vec<String> = factors.iter().map(|[factor, _]| format!("{factor:.3}")).collect();
            let then = match has_intervals {
                true => "The intervals apply to these specimens only",
                false => "This alone makes the residuals of a joint fit systematic: fit each specimen by itself to judge the law",
            };
            format!(
                "the specimens differ by more than the noise of each: they are {} times as stiff as the law. {then}; their mean gives the \
                 material's stiffness to ± {of_mean:.2} % (standard error)",
                told.join(", "),
            )
        })
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
        let differ = "specimens differ";
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
