//! Zeros of strain or stress that a law finds elsewhere than the data have them.
//!
//! A short slack, a preload taken for rest, or an offset of the load cell leaves residuals that are often like noise, and parameters that
//! are wrong by many of their standard errors. So the zero of each test is tried as one more value.

use crate::calibration::data::{FoundZero, TestData};
use crate::calibration::fitted::Fit;
use crate::calibration::least_squares::{Residuals, sum_of_squares};
use crate::calibration::regression::{Elastic, Misfit, Response};
use crate::calibration::settings::limits;
use crate::calibration::solution::Solution;
use crate::material::parameters::Parameter;
use crate::statistics::Estimate;

/// A zero is doubtful where it is this many halves of its 95 % interval away: one in a thousand by chance.
const DOUBTFUL: f64 = 1.7;

/// More points than this are thinned before all of them are tried.
const MANY: usize = 800;

/// A test with another zero.
struct MovedTest {
    test: usize,
    kind: FoundZero,
    by: Estimate,
    /// The first parameter of the law then.
    first: f64,
    /// The sum of squares of the residuals then.
    sum: f64,
}

impl MovedTest {
    fn halves(&self) -> f64 {
        let [_, high] = self.by.interval;
        self.by.value.abs() / (high - self.by.value)
    }

    fn describe(&self, parameter: &Parameter) -> String {
        let (what, unit, causes) = match self.kind {
            FoundZero::Strain { .. } => (
                "strains (nominal)",
                "",
                "slack, a preload taken for rest, or a wrong length",
            ),
            FoundZero::Stress { .. } => ("stresses", " MPa", "an offset of the load cell"),
        };
        let Estimate {
            value,
            standard_error,
            ..
        } = self.by;
        format!(
            "all {what} are {} by {:.3e}{unit} (± {standard_error:.1e}, {:.0} standard errors; {causes}), where {} = {:.4e} would be {:.4e}",
            if value > 0.0 { "larger" } else { "smaller" },
            value.abs(),
            value.abs() / standard_error,
            parameter.key,
            parameter.value,
            self.first
        )
    }
}

impl Fit {
    /// Adds the warning about a zero of strain or stress that the law finds elsewhere than the tests have it, if there is one. It takes
    /// about as long as the fit.
    pub fn doubt_zeros(&mut self, tests: &[TestData]) {
        let kinds = [
            FoundZero::Strain { length: 1.0 },
            FoundZero::Stress { area: 1.0 },
        ];
        let given = (0..tests.len()).filter(|test| tests[*test].found_zero.is_none());
        let moved = given.flat_map(|test| kinds.map(|kind| self.with_zero(tests, test, kind)));
        let doubtful = moved.flatten().filter(|moved| moved.halves() > DOUBTFUL);
        let doubtful: Vec<MovedTest> = doubtful.collect();
        let Some(best) = doubtful.iter().min_by(|a, b| a.sum.total_cmp(&b.sum)) else {
            return;
        };
        let of_test = doubtful.iter().filter(|moved| moved.test == best.test);
        let each: Vec<String> = of_test
            .map(|moved| moved.describe(&self.parameters[0]))
            .collect();
        self.quality.warnings.push(format!(
            "{}: the law follows the data better if {}; or another law does. No interval holds this: check the zero, and state it (`--zero`) or \
             correct the data",
            tests[best.test].name,
            each.join(", or if ")
        ));
    }

    /// The fit with the zero of a test as one more value; `None` where what is left is no noise.
    fn with_zero(&self, tests: &[TestData], test: usize, kind: FoundZero) -> Option<MovedTest> {
        self.parameters.first()?;
        let mut tests = tests.to_vec();
        tests[test].found_zero = Some(kind);
        let response = Elastic::new(self.law, &tests);
        let bounds = &self.settings.bounds;
        let bounds = limits(self.law, &self.parameters, bounds, response.stiffness).ok()?;
        let solved = |misfit| {
            let begun = Solution {
                misfit,
                values: self.parameters.iter().map(|one| one.value).collect(),
                bounds: bounds.clone(),
            };
            begun.with_zeros()
        };
        let misfit = Misfit::new(response, self.settings.weighting);
        // What some of many points show to be no noise, all of them do.
        if misfit.count() > MANY {
            let some = solved(misfit.thinned(MANY / 2));
            if some.misfit.response.zeros().is_empty() {
                return None;
            }
        }
        let solution = solved(misfit);
        let quality = solution.quality();
        let zero = quality.zeros.iter().find(|zero| zero.test == test)?;
        Some(MovedTest {
            test,
            kind,
            by: zero.by,
            first: solution.values[0],
            sum: sum_of_squares(&solution.misfit, &solution.values),
        })
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use crate::calibration::settings::MEASURE;
    use crate::calibration::{FitSettings, TestData, fit};
    use crate::document::Statements;
    use crate::material::parameters::StressMeasure;
    use crate::material::registry::Law;

    /// The warnings of a fit of neo-Hooke to a table of it, with all strains and stresses off.
    fn told(strain: f64, stress: f64, seed: u64) -> String {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let rows = (0..60).map(|row| {
            let l = 1.0 + 0.8 * f64::from(row) / 59.0;
            let z: f64 = StandardNormal.sample(&mut random);
            let nominal = 0.06 * (l - l.powi(-2)) + stress + 4e-4 * z;
            format!("{},{nominal}\n", l + strain)
        });
        told_of_rows(Law::named("neo-hooke").unwrap(), rows.collect())
    }

    /// The warnings of a fit to a table of stretches and stresses.
    fn told_of_rows(law: &'static Law, rows: String) -> String {
        let text = format!("# test: uniaxial\nstretch [-],nominal_stress [MPa]\n{rows}");
        let data = TestData::parse("a.csv", &text, &Statements::new()).unwrap();
        let fit = fit(law, &[data], &FitSettings::default()).unwrap();
        fit.quality.warnings.join("; ")
    }

    #[test]
    fn zeros_that_the_law_finds_elsewhere_are_told_and_sound_ones_are_not() {
        for seed in 0..20 {
            let sound = told(0.0, 0.0, seed);
            assert!(
                !sound.contains("follows the data better"),
                "{seed}: {sound}"
            );
            let shifted = told(0.015, 0.0, seed);
            assert!(
                shifted.contains("all strains (nominal) are smaller by 1."),
                "{seed}: {shifted}"
            );
            let offset = told(0.0, -2e-3, seed);
            assert!(
                offset.contains("follows the data better"),
                "{seed}: {offset}"
            );
        }
    }

    /// The warnings of a fit of a law to a table of it, in tension or compression, where the specimen is slack at first.
    fn told_of_slack(name: &str, truth: &[f64], [side, slack]: [f64; 2], seed: u64) -> String {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let law = Law::named(name).unwrap();
        let (true_law, _) = law.with_values(truth, StressMeasure::Nominal, MEASURE);
        let stress = |strain: f64| {
            let loaded = side * (strain - slack).max(0.0);
            true_law.tension([1.0, 0.0], loaded).nominal_stress
        };
        let rows = (0..60).map(|row| {
            let strain = 0.4 * f64::from(row) / 59.0;
            let z: f64 = StandardNormal.sample(&mut random);
            let nominal = stress(strain) + 5e-3 * stress(0.4) * z;
            format!("{},{nominal}\n", 1.0 + side * strain)
        });
        told_of_rows(law, rows.collect())
    }

    /// A slack of three rows: too short to be seen as a bend, and taken up by parameters.
    #[test]
    fn a_short_slack_is_told_whatever_the_law_takes_up() {
        let laws: [(&str, &[f64]); 3] = [
            ("neo-hooke", &[0.03]),
            ("yeoh", &[0.03, 0.003, 0.0005]),
            ("mooney-rivlin", &[0.02, 0.01]),
        ];
        for ((name, truth), side) in laws.iter().flat_map(|law| [(law, 1.0), (law, -1.0)]) {
            for seed in 0..4 {
                let sound = told_of_slack(name, truth, [side, 0.0], seed);
                let told = "follows the data better";
                assert!(!sound.contains(told), "{name} {side} {seed}: {sound}");
                let slack = told_of_slack(name, truth, [side, 0.02], seed);
                let way = if side > 0.0 { "smaller" } else { "larger" };
                let told = ["1.7", "1.8", "1.9", "2.0", "2.1", "2.2", "2.3"]
                    .map(|by| format!("all strains (nominal) are {way} by {by}"));
                let is_told = told.iter().any(|told| slack.contains(told));
                assert!(is_told, "{name} {side} {seed}: {slack}");
            }
        }
    }
}
