//! Zeros of strain or stress that a law finds elsewhere than the data have them.
//!
//! A short slack, a preload taken for rest, or an offset of the load cell leaves residuals that are often like noise, and parameters that
//! are wrong by many of their standard errors. So the zero of each test is tried as one more value.

use crate::calibration::data::{FoundZero, TestData};
use crate::calibration::least_squares::{Residuals, sum_of_squares};
use crate::calibration::regression::Misfit;
use crate::calibration::regression::refined_zero::Found;
use crate::calibration::settings::Weighting;
use crate::calibration::trust::Assessment;
use crate::material::parameters::Parameter;
use crate::material::registry::Law;
use crate::statistics::Estimate;

/// A zero is doubtful where it is this many halves of its 95 % interval away: one in a thousand by chance.
const DOUBTFUL: f64 = 1.7;

/// More points than this are thinned before all of them are tried.
const MANY: usize = 800;

/// A law fitted to tests with the zeros that they have.
pub struct WithGivenZeros<'a> {
    /// The law.
    pub law: &'static Law,
    /// The tests.
    pub tests: &'a [TestData],
    /// The weights of the residuals.
    pub weighting: Weighting,
    /// The bounds of the parameters.
    pub bounds: &'a [[f64; 2]],
    /// The least size of each parameter that counts.
    pub least: &'a [f64],
}

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

impl WithGivenZeros<'_> {
    /// The warning about the zero that describes the data best beside the parameters found, if one is.
    pub fn warning(&self, parameters: &[Parameter]) -> Option<String> {
        let kinds = [
            FoundZero::Strain { length: 1.0 },
            FoundZero::Stress { area: 1.0 },
        ];
        let given = (0..self.tests.len()).filter(|test| self.tests[*test].found_zero.is_none());
        let moved = given.flat_map(|test| kinds.map(|kind| self.with_zero(parameters, test, kind)));
        let doubtful = moved.flatten().filter(|moved| moved.halves() > DOUBTFUL);
        let doubtful: Vec<MovedTest> = doubtful.collect();
        let best = doubtful.iter().min_by(|a, b| a.sum.total_cmp(&b.sum))?;
        let of_test = doubtful.iter().filter(|moved| moved.test == best.test);
        let each: Vec<String> = of_test
            .map(|moved| moved.describe(&parameters[0]))
            .collect();
        Some(format!(
            "{}: the law follows the data better if {}; or another law does. No interval holds this: check the zero, and state it (`--zero`) or \
             correct the data",
            self.tests[best.test].name,
            each.join(", or if ")
        ))
    }

    /// The fit with the zero of a test as one more value; `None` where what is left is no noise.
    fn with_zero(
        &self,
        parameters: &[Parameter],
        test: usize,
        kind: FoundZero,
    ) -> Option<MovedTest> {
        let mut tests = self.tests.to_vec();
        tests[test].found_zero = Some(kind);
        let misfit = Misfit::new(self.law, &tests, self.weighting);
        let is_noise = |misfit: &Misfit, values: &[f64], bounds: &[[f64; 2]]| {
            self.assess(misfit, &tests, values, bounds, |own| own.is_noise())
        };
        // What some of many points show to be no noise, all of them do.
        if misfit.count() > MANY {
            let some = self
                .begun(misfit.thinned(MANY / 2), parameters)
                .with_zeros(&is_noise);
            if some.misfit.zeros().is_empty() {
                return None;
            }
        }
        let found = self.begun(misfit, parameters).with_zeros(&is_noise);
        let moved = found.misfit.moved_tests(&found.values);
        let (misfit, values) = (&found.misfit, &found.values);
        let quality = self.assess(misfit, &moved, values, &found.bounds, |own| own.quality());
        let zero = quality.zeros.iter().find(|zero| zero.test == test)?;
        Some(MovedTest {
            test,
            kind,
            by: zero.by,
            first: found.values[0],
            sum: sum_of_squares(misfit, values),
        })
    }

    /// The parameters by some residuals.
    fn begun<'m>(&self, misfit: Misfit<'m>, parameters: &[Parameter]) -> Found<'m> {
        Found {
            misfit,
            values: parameters.iter().map(|one| one.value).collect(),
            bounds: self.bounds.to_vec(),
        }
    }

    /// An answer of the assessment of values.
    pub fn assess<T>(
        &self,
        misfit: &Misfit,
        tests: &[TestData],
        values: &[f64],
        bounds: &[[f64; 2]],
        answer: impl FnOnce(&Assessment) -> T,
    ) -> T {
        answer(&Assessment {
            misfit,
            weighting: self.weighting,
            tests,
            law: &*misfit.build(values).0,
            values,
            bounds,
            least: self.least,
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
