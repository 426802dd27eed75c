//! The settings of a fit: weights, bounds, starts.

use super::data::{Test, TestData};
use crate::document::{Bound, name_of};
use crate::error::{Error, suggestion};
use crate::material::parameters::{Parameter, StrainMeasure};
use crate::material::registry::Law;
use crate::units::Dimension;

/// The weighting of residuals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// All differences of stress have the same weight.
    Absolute,
    /// All relative differences have the same weight: a residual is divided by the measured stress, but by no less than a
    /// hundredth of the largest one of its test, so that a stress near zero does not outweigh all others. Where the residuals are
    /// noise, they are divided by the fitted stress instead of the measured one, whose noise would affect the weight.
    Relative,
}

impl Weighting {
    /// The names that cards and the command line use.
    pub const NAMES: [(&'static str, Self); 2] =
        [("absolute", Self::Absolute), ("relative", Self::Relative)];

    /// The name that cards use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }

    /// The name, and the least divisor of relative residuals.
    pub fn describe(self) -> String {
        match self {
            Self::Absolute => self.name().into(),
            Self::Relative => format!(
                "{} (relative to {} % of the test's largest stress where a stress is smaller)",
                self.name(),
                100.0 * SMALLEST_SHARE
            ),
        }
    }

    /// The weight of a stress in MPa, measured or fitted.
    pub(in crate::calibration) fn weight_of(self, data: &TestData, stress: f64) -> f64 {
        match self {
            Self::Absolute => 1.0,
            Self::Relative => {
                let least = SMALLEST_SHARE * data.largest_stress;
                1.0 / stress.abs().max(least)
            }
        }
    }
}

/// Limits of parameters by key, in internal units; a parameter whose limits are equal has this value and is not fitted.
pub type Bounds = Vec<(String, [f64; 2])>;

/// The settings of a fit.
#[derive(Clone, Debug)]
pub struct FitSettings {
    /// The weighting of residuals.
    pub weighting: Weighting,
    /// Limits in addition to those that the law has.
    pub bounds: Bounds,
    /// The number of the best starts that are improved.
    pub starts: usize,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            weighting: Weighting::Absolute,
            bounds: Vec::new(),
            starts: 8,
        }
    }
}

impl FitSettings {
    /// The same without the bounds of some parameters.
    pub(in crate::calibration) fn without(&self, keys: &[&str]) -> Self {
        let all = self.bounds.iter();
        let bounds = all.filter(|(key, _)| !keys.contains(&&**key));
        Self {
            bounds: bounds.cloned().collect(),
            ..self.clone()
        }
    }
}

/// The least divisor of a relative residual, as a share of its test's largest stress.
pub const SMALLEST_SHARE: f64 = 0.01;

/// The strain measure that laws of a curve take in a fit.
pub const MEASURE: StrainMeasure = StrainMeasure::Nominal;

/// Parameters that the tests do not determine because none of them shears the sheet, with the values that they are held at.
pub fn held(law: &Law, tests: &[TestData], bounds: &Bounds) -> Vec<(&'static str, f64)> {
    let (_, entries) = law.unknown();
    let is_held = |(key, _): &&(&str, f64)| {
        !has_shear(tests) && bounds.iter().all(|(stated, _)| stated != key)
    };
    entries.of_shear.iter().filter(is_held).copied().collect()
}

/// Whether the sign of an angle shows in some tests: stretched along its axes, a sheet and its mirror image are the same.
fn has_shear(tests: &[TestData]) -> bool {
    tests.iter().any(|data| data.test == Test::SimpleShear)
}

/// Lower and upper limit of each parameter; `scale` is a typical stress of the data.
pub fn limits(
    law: &Law,
    tests: &[TestData],
    parameters: &[Parameter],
    bounds: &Bounds,
    scale: f64,
) -> Result<Vec<[f64; 2]>, Error> {
    check_bounds(law, parameters, bounds)?;
    let held = held(law, tests, bounds);
    let limit = |parameter: &Parameter| {
        let given = bounds.iter().find(|(key, _)| key == parameter.key);
        let is_stated = given.is_some_and(|(_, [low, high])| low == high);
        if let Some((_, value)) = held.iter().find(|(key, _)| *key == parameter.key) {
            return Ok([*value; 2]);
        }
        let [low, high] = match parameter.bound {
            // The law is periodic: all angles lie in the usual range.
            Bound::Any if parameter.dimension == Dimension::Angle && !is_stated => {
                let [low, high] = parameter.usual;
                [if has_shear(tests) { low } else { low.max(0.0) }, high]
            }
            Bound::Any => [f64::NEG_INFINITY, f64::INFINITY],
            // Negligible compared with the stresses of the data.
            Bound::Positive if parameter.is_stress() => [1e-9 * scale, f64::INFINITY],
            Bound::Positive => [1e-9, f64::INFINITY],
            Bound::NonNegative => [0.0, f64::INFINITY],
            Bound::Within(low, high) | Bound::Range(low, high, _) => [low, high],
        };
        let [from, to] = given.map_or([low, high], |(_, [l, h])| [low.max(*l), high.min(*h)]);
        if from < to || (from == to && is_stated) {
            return Ok([from, to]);
        }
        let message = format!("the bounds of {} allow no value of the law", parameter.key);
        let hint = format!("the law takes values from {low:.1e} to {high:.1e}");
        Err(Error::input(message, hint))
    };
    parameters.iter().map(limit).collect()
}

fn check_bounds(law: &Law, parameters: &[Parameter], bounds: &Bounds) -> Result<(), Error> {
    let known: Vec<_> = parameters.iter().map(|parameter| parameter.key).collect();
    for (key, [low, high]) in bounds {
        if !known.contains(&&**key) {
            let message = format!("{} has no parameter `{key}`", law.name);
            let hint = suggestion(key, &known, "its parameters are");
            return Err(Error::input(message, hint));
        }
        if bounds.iter().filter(|(other, _)| other == key).count() > 1 {
            return Err(Error::input(format!("{key} has two bounds"), "give one"));
        }
        if low > high {
            let message = format!("the bounds {low} … {high} of {key} are not in order");
            return Err(Error::input(message, "write the lower one first"));
        }
    }
    Ok(())
}
