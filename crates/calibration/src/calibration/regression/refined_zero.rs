//! Zeros of strain or stress that were found at the beginning of a record, found again with the law.
//!
//! The parabola that follows a beginning back to rest, [`crate::calibration::data`], sees a few rows; the law sees all of them. Taken as known, the
//! zero that the parabola finds makes the law's parameters wrong by many of their standard errors. So the zero is one more
//! value of the fit, r(p, δ) = σᵢ − σ(p; λᵢ + δ) or σᵢ + δ − σ(p; λᵢ), and its uncertainty is part of the intervals. Where what
//! is left then is no noise, the law would take its own misfit for a zero: the zero stays.

use super::misfit::{Misfit, Zero};
use super::reweighed::settled;
use crate::calibration::data::{FoundZero, TestData};
use crate::calibration::least_squares::descend;
use crate::statistics::Estimate;

/// Zeros are moved by less than this share of the largest strain or stress.
const FARTHEST: f64 = 0.25;

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
    fn applied(&self, test: &TestData) -> TestData {
        let mut moved = test.with_zero_moved(self.by.value);
        moved.remarks.extend(self.remark(test));
        moved
    }

    /// What is said of it.
    fn remark(&self, test: &TestData) -> Option<String> {
        let (by, error) = (self.by.value, self.by.standard_error);
        let told = match test.found_zero? {
            FoundZero::Strain { length } => {
                let pulls = test.observations.last();
                let pulls = pulls.is_some_and(|one| test.drawn_strain(one) > 0.0);
                let side = if (by > 0.0) == pulls {
                    "before"
                } else {
                    "behind"
                };
                format!(
                    "estimated again together with the law, the zero of displacement lies {:.4} ± {:.4} mm {side} that value",
                    length * by.abs(),
                    length * error
                )
            }
            FoundZero::Stress { area } => format!(
                "estimated again together with the law, the zero of force is {:.4} ± {:.4} N {} that value",
                area * by.abs(),
                area * error,
                if by > 0.0 { "below" } else { "above" }
            ),
        };
        Some(format!("{told}; the intervals include this uncertainty"))
    }
}

/// The tests with the zeros that were found again.
pub fn with_zeros(tests: &[TestData], zeros: &[MovedZero]) -> Vec<TestData> {
    let mut moved = tests.to_vec();
    for zero in zeros {
        moved[zero.test] = zero.applied(&tests[zero.test]);
    }
    moved
}

/// Whether what values within their bounds leave is noise.
pub type IsNoise<'a> = dyn Fn(&Misfit, &[f64], &[[f64; 2]]) -> bool + 'a;

/// Values with their bounds, and the residuals that they leave.
pub struct Found<'a> {
    pub misfit: Misfit<'a>,
    pub values: Vec<f64>,
    pub bounds: Vec<[f64; 2]>,
}

impl<'a> Found<'a> {
    /// With the zeros among the values, where the records had any and what is left is noise then.
    pub fn with_zeros(self, is_noise: &IsNoise) -> Self {
        self.wider(is_noise).unwrap_or(self)
    }

    fn wider(&self, is_noise: &IsNoise) -> Option<Found<'a>> {
        let misfit = self.misfit.with_zeros();
        let count = misfit.zeros().len();
        if count == 0 {
            return None;
        }
        let mut values = self.values.clone();
        values.resize(values.len() + count, 1.0);
        let mut bounds = self.bounds.clone();
        bounds.resize(values.len(), [1.0 - FARTHEST, 1.0 + FARTHEST]);
        let values = descend(&misfit, &values, &bounds)?;
        let noise = |misfit: &Misfit, values: &[f64]| is_noise(misfit, values, &bounds);
        let (misfit, values) = settled(&misfit, values, &bounds, noise);
        is_noise(&misfit, &values, &bounds).then_some(Found {
            misfit,
            values,
            bounds,
        })
    }
}
