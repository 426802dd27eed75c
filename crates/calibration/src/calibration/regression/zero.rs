//! Zeros of strain or stress that are values of a fit.

use crate::calibration::data::{FoundZero, TestData};
use crate::statistics::Estimate;

/// The zero of a test that is found with the law: its value, behind those of the law, is 1 + by/scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    pub test: usize,
    /// The largest strain, or stress in MPa.
    pub scale: f64,
}

impl Zero {
    /// By how much a value moves it: strain, or stress in MPa.
    pub fn by(self, value: f64) -> f64 {
        self.scale * (value - 1.0)
    }
}

/// A zero that was found again with the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedZero {
    /// The test, by its number.
    pub test: usize,
    /// By how much strains (nominal), or stresses in MPa, are larger.
    pub by: Estimate,
}

impl MovedZero {
    /// Of a value's estimate.
    pub(in crate::calibration) fn new(zero: Zero, value: &Estimate) -> Self {
        let by = Estimate {
            value: zero.by(value.value),
            standard_error: zero.scale * value.standard_error,
            interval: value.interval.map(|end| zero.by(end)),
        };
        Self {
            test: zero.test,
            by,
        }
    }

    /// The test with this zero.
    pub(in crate::calibration) fn applied(&self, test: &TestData) -> TestData {
        let mut moved = test.with_zero_moved(self.by.value);
        moved.remarks.extend(self.remark(test));
        moved
    }

    /// What is said of it.
    fn remark(&self, test: &TestData) -> Option<String> {
        let (by, error) = (self.by.value, self.by.standard_error);
        let moved = match test.found_zero? {
            FoundZero::Strain { length } => {
                let pulls = test.observations.last();
                let pulls = pulls.is_some_and(|one| test.drawn_strain(one) > 0.0);
                let side = if (by > 0.0) == pulls {
                    "before"
                } else {
                    "behind"
                };
                format!(
                    "displacement lies {:.4} ± {:.4} mm {side}",
                    length * by.abs(),
                    length * error
                )
            }
            FoundZero::Stress { area } => format!(
                "force is {:.4} ± {:.4} N {}",
                area * by.abs(),
                area * error,
                if by > 0.0 { "below" } else { "above" }
            ),
        };
        Some(format!(
            "estimated again together with the law, the zero of {moved} that value; the intervals include this uncertainty"
        ))
    }
}
