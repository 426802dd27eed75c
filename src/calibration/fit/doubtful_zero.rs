//! Zeros of strain or stress that a law finds elsewhere than the data have them.
//!
//! A short slack, a preload taken for rest, or an offset of the load cell leaves residuals that are often like noise, and parameters that
//! are wrong by many of their standard errors. So the zero of each test is tried as one more value.

use crate::calibration::data::{FoundZero, TestData};
use crate::calibration::regression::Misfit;
use crate::calibration::regression::refined_zero::Found;
use crate::calibration::settings::Weighting;
use crate::calibration::trust::Assessment;
use crate::material::parameters::Parameter;
use crate::material::registry::Law;
use crate::statistics::Estimate;

/// A zero is doubtful where it is this many halves of its 95 % interval away: one in a thousand by chance.
const DOUBTFUL: f64 = 1.7;

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
}

impl MovedTest {
    fn halves(&self) -> f64 {
        let [_, high] = self.by.interval;
        self.by.value.abs() / (high - self.by.value)
    }
}

impl WithGivenZeros<'_> {
    /// The warning about the most doubtful zero beside the parameters found, if one is.
    pub fn warning(&self, parameters: &[Parameter]) -> Option<String> {
        let kinds = [
            FoundZero::Strain { length: 1.0 },
            FoundZero::Stress { area: 1.0 },
        ];
        let given = (0..self.tests.len()).filter(|test| self.tests[*test].found_zero.is_none());
        let moved = given.flat_map(|test| kinds.map(|kind| self.with_zero(parameters, test, kind)));
        let doubtful = moved.flatten().filter(|moved| moved.halves() > DOUBTFUL);
        let most = doubtful.max_by(|a, b| a.halves().total_cmp(&b.halves()))?;
        Some(self.describe(&parameters[0], &most))
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
        let found = Found {
            misfit: Misfit::new(self.law, &tests, self.weighting),
            values: parameters.iter().map(|one| one.value).collect(),
            bounds: self.bounds.to_vec(),
        };
        let is_noise = |misfit: &Misfit, values: &[f64], bounds: &[[f64; 2]]| {
            self.assess(misfit, &tests, values, bounds, |own| own.is_noise())
        };
        let found = found.with_zeros(&is_noise);
        let moved = found.misfit.moved_tests(&found.values);
        let (misfit, values) = (&found.misfit, &found.values);
        let quality = self.assess(misfit, &moved, values, &found.bounds, |own| own.quality());
        let zero = quality.zeros.iter().find(|zero| zero.test == test)?;
        Some(MovedTest {
            test,
            kind,
            by: zero.by,
            first: found.values[0],
        })
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

    fn describe(&self, parameter: &Parameter, moved: &MovedTest) -> String {
        let error = moved.by.standard_error;
        let (what, unit, causes) = match moved.kind {
            FoundZero::Strain { .. } => (
                "strains (nominal)",
                "",
                "slack, a preload taken for rest, or a wrong length",
            ),
            FoundZero::Stress { .. } => ("stresses", " MPa", "an offset of the load cell"),
        };
        format!(
            "{}: the law follows the data better if all {what} are {} by {:.3e}{unit} (± {:.1e}, {:.0} standard errors): {causes}, or another law. {} \
             = {:.4e} would be {:.4e} then, and no interval holds this: check the zero, and state it (`--zero`) or correct the data",
            self.tests[moved.test].name,
            if moved.by.value > 0.0 {
                "larger"
            } else {
                "smaller"
            },
            moved.by.value.abs(),
            error,
            moved.by.value.abs() / error,
            parameter.key,
            parameter.value,
            moved.first
        )
    }
}
