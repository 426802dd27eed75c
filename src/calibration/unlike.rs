//! Noise that grows with the stress, and specimens that differ: what intervals of even noise do not hold.

use super::quality::Quality;
use super::settings::Weighting;
use super::test_data::{Observation, TestData};
use crate::material::HyperelasticLaw;
use crate::statistics::rank_correlation;

/// Standard normal deviates beyond which something is no chance: one in a thousand, on both sides.
const CLEARLY: f64 = 3.29;

/// Fewer rows tell nothing of either.
const FEWEST: usize = 10;

/// The warnings of a fit whose residuals are noise; none of others.
pub(super) fn unlike(
    quality: &Quality,
    law: &dyn HyperelasticLaw,
    tests: &[TestData],
    weighting: Weighting,
) -> Vec<String> {
    if !quality.has_intervals() || quality.verdict.is_none() {
        return Vec::new();
    }
    let independent = quality.effective_points() / quality.points as f64;
    let compared = Compared {
        law,
        weighting,
        independent: independent.min(1.0),
    };
    let uneven = compared.uneven(tests);
    uneven
        .into_iter()
        .chain(compared.specimens(tests))
        .collect()
}

struct Compared<'a> {
    law: &'a dyn HyperelasticLaw,
    weighting: Weighting,
    /// Independent points for each point.
    independent: f64,
}

impl Compared<'_> {
    /// The law's stress at an observation, and how far it is from the measured one, both by the weights of the fit.
    fn pair(&self, test: &TestData, one: &Observation) -> [f64; 2] {
        let fitted = test.stress_of(self.law, one);
        let weight = self.weighting.weight_of(test, fitted);
        [weight * fitted, weight * (one.stress - fitted)]
    }

    /// Whether what is left grows, or falls, with the stress.
    fn uneven(&self, tests: &[TestData]) -> Option<String> {
        let deviate = |test: &TestData| {
            let rows = test.observations.iter();
            let (stresses, left): (Vec<f64>, Vec<f64>) = rows
                .map(|one| {
                    let fitted = test.stress_of(self.law, one);
                    (fitted.abs(), self.pair(test, one)[1].abs())
                })
                .unzip();
            let count = self.independent * stresses.len() as f64;
            (stresses.len() >= FEWEST && count > 1.0)
                .then(|| rank_correlation(&stresses, &left) * (count - 1.0).sqrt())
        };
        let all: Vec<f64> = tests
            .iter()
            .filter_map(deviate)
            .filter(|z| z.is_finite())
            .collect();
        let whole = all.iter().sum::<f64>() / (all.len() as f64).sqrt();
        match self.weighting {
            Weighting::Absolute if whole > CLEARLY => Some(
                "what is left grows with the stress: the intervals are those of even noise and too narrow; see `--weighting relative`".into(),
            ),
            Weighting::Relative if whole < -CLEARLY => Some(
                "what is left, relative to the stress, is largest where the stress is small: see `--weighting absolute`".into(),
            ),
            _ => None,
        }
    }

    /// How many times the law's stress a test measured, and its variance by the noise.
    fn factor(&self, test: &TestData) -> Option<[f64; 2]> {
        let count = test.observations.len();
        let pairs = || test.observations.iter().map(|one| self.pair(test, one));
        let square: f64 = pairs().map(|[fitted, _]| fitted * fitted).sum();
        let along: f64 = pairs().map(|[fitted, left]| fitted * left).sum();
        let factor = along / square;
        let rest: f64 = pairs()
            .map(|[fitted, left]| (left - factor * fitted).powi(2))
            .sum();
        let variance = rest / (count as f64 - 1.0) / square / self.independent;
        (count >= FEWEST && variance > 0.0).then_some([1.0 + factor, variance])
    }

    /// Whether specimens of one kind of test differ by more than their noise.
    fn specimens(&self, tests: &[TestData]) -> Option<String> {
        let alike = |test: &&TestData| (test.test, &test.axes) == (tests[0].test, &tests[0].axes);
        if tests.len() < 2 || !tests.iter().all(|test| alike(&test)) {
            return None;
        }
        let factors: Option<Vec<[f64; 2]>> = tests.iter().map(|test| self.factor(test)).collect();
        let factors = factors?;
        let weight: f64 = factors.iter().map(|[_, variance]| 1.0 / variance).sum();
        let mean = factors
            .iter()
            .map(|[factor, variance]| factor / variance)
            .sum::<f64>()
            / weight;
        let squares: f64 = factors
            .iter()
            .map(|[factor, variance]| (factor - mean).powi(2) / variance)
            .sum();
        let freedom = factors.len() as f64 - 1.0;
        // χ² by Wilson's and Hilferty's cube root.
        let deviate = ((squares / freedom).cbrt() - 1.0 + 2.0 / (9.0 * freedom))
            / (2.0 / (9.0 * freedom)).sqrt();
        (deviate > CLEARLY).then(|| {
            let plain = factors.iter().map(|[factor, _]| factor).sum::<f64>() / factors.len() as f64;
            let spread = factors.iter().map(|[factor, _]| (factor - plain).powi(2)).sum::<f64>();
            let of_mean = 100.0 * (spread / freedom / factors.len() as f64).sqrt();
            let told: Vec<String> = factors.iter().map(|[factor, _]| format!("{factor:.3}")).collect();
            format!(
                "the specimens differ by more than the noise of each: they are {} times as stiff as the law. The intervals are of these \
                 specimens; their mean tells the material's stiffness to ± {of_mean:.2} % (standard error)",
                told.join(", "),
            )
        })
    }
}
