//! Zeros of strain or stress, and stretches as mounted, that are values of a fit.

use crate::calibration::data::{FoundZero, Observation, TestData};
use crate::statistics::{Estimate, farthest};

/// A zero, or a stretch as mounted, that is found with the law: its value, after those of the law, is 1 + by/scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Zero {
    /// The zero that was found in the record of a test.
    Record {
        /// The test, by its number.
        test: usize,
        /// The largest strain, or stress in MPa.
        scale: f64,
    },
    /// What the load cell of an axis reads without load, over the cross-section as mounted.
    Force {
        /// 0 or 1.
        axis: usize,
        /// The largest stress in MPa.
        scale: f64,
    },
    /// The stretch of a sheet along an axis as mounted.
    Stretch {
        /// 0 or 1.
        axis: usize,
    },
}

impl Zero {
    /// The zeros that are found with a law fitted to some tests.
    pub fn of(tests: &[TestData]) -> Vec<Self> {
        let of_record = |(test, data): (usize, &TestData)| {
            let strains = data.observations.iter().map(|one| data.drawn_strain(one));
            let scale = match data.found_zero? {
                FoundZero::Strain { .. } => farthest(strains).abs(),
                FoundZero::Stress { .. } => data.largest_stress,
            };
            Some(Self::Record { test, scale })
        };
        let mut zeros: Vec<Self> = tests.iter().enumerate().filter_map(of_record).collect();
        let mounted = || tests.iter().map(|data| data.mounted);
        // Forces are read before they are related to the cross-section at rest.
        if mounted().any(|mounting| mounting.estimates_force_zero) {
            let scale = TestData::largest_stress(tests);
            zeros.extend([0, 1].map(|axis| Self::Force { axis, scale }));
        }
        if mounted().any(|mounting| mounting.estimates_stretches()) {
            zeros.extend([0, 1].map(|axis| Self::Stretch { axis }));
        }
        zeros
    }

    /// The values within which it is sought.
    pub fn bounds(self) -> [f64; 2] {
        match self {
            Self::Record { .. } | Self::Force { .. } => [0.75, 1.25],
            Self::Stretch { .. } => [0.8, 1.6],
        }
    }

    /// By how much a value moves it: strain, or stress in MPa.
    pub fn by(self, value: f64) -> f64 {
        match self {
            Self::Record { scale, .. } | Self::Force { scale, .. } => scale * (value - 1.0),
            Self::Stretch { .. } => value - 1.0,
        }
    }

    /// An observation of a test as it is then.
    pub fn moved(
        self,
        value: f64,
        (test, data): (usize, &TestData),
        one: &Observation,
    ) -> Observation {
        let by = self.by(value);
        let mut moved = *one;
        match self {
            Self::Record { test: number, .. } if number == test => return data.moved(one, by),
            Self::Force { axis, .. } if axis == one.axis => moved.stress -= by,
            Self::Stretch { axis } => return one.stretched(axis, 1.0 + by, data.stress_measure),
            _ => {}
        }
        moved
    }
}

/// A zero that was found with the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedZero {
    /// What it is.
    pub zero: Zero,
    /// Its value.
    pub(in crate::calibration) value: f64,
    /// By how much strains (nominal), stretches, or stresses in MPa, are larger.
    pub by: Estimate,
}

impl MovedZero {
    /// Of a value's estimate.
    pub(in crate::calibration) fn new(zero: Zero, value: &Estimate) -> Self {
        let ends = value.interval.map(|end| zero.by(end));
        let by = Estimate {
            value: zero.by(value.value),
            standard_error: value.standard_error * zero.by(2.0),
            interval: ends,
        };
        Self {
            zero,
            value: value.value,
            by,
        }
    }

    /// A test with this zero.
    pub(in crate::calibration) fn applied(&self, number: usize, test: &TestData) -> TestData {
        let mut moved =
            test.with_observations(|one| self.zero.moved(self.value, (number, test), one));
        moved.remarks.extend(self.remark(number, test));
        moved
    }

    /// What is said of it.
    fn remark(&self, number: usize, test: &TestData) -> Option<String> {
        let (by, error) = (self.by.value, self.by.standard_error);
        match self.zero {
            Zero::Record { test: record, .. } => {
                if record == number {
                    self.remark_on_record(test)
                } else {
                    None
                }
            }
            Zero::Force { axis, .. } => Some(format!(
                "estimated together with the law: the load cell of axis {} reads {by:.4e} ± {error:.1e} MPa without load; the intervals \
                 include this uncertainty",
                axis + 1
            )),
            Zero::Stretch { axis } => Some(format!(
                "estimated together with the law: the sheet is stretched by {:.4} ± {error:.4} along axis {} as mounted; the intervals \
                 include this uncertainty",
                1.0 + by,
                axis + 1
            )),
        }
    }

    fn remark_on_record(&self, test: &TestData) -> Option<String> {
        let (by, error) = (self.by.value, self.by.standard_error);
        let moved = match test.found_zero? {
            FoundZero::Strain { length, .. } => {
                let last = test.observations.last();
                let pulls = last.is_some_and(|one| test.drawn_strain(one) > 0.0);
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
