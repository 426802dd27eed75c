//! Everything that a run has computed.

use crate::compare::{Deviation, StepComparison};
use crate::corrector::plate::CorrectedState;
use crate::finite_element::FiniteElements;
use crate::finite_element::error_estimate::ErrorEstimate;
use crate::mass_spring::MassSpring;
use crate::problem::Solution;
use crate::study::Tolerances;

/// One finite-element mesh and its solutions.
#[derive(Debug)]
pub struct ReferenceMesh {
    /// The model.
    pub model: FiniteElements,
    /// One solution a stretch.
    pub solutions: Vec<Solution>,
}

/// All fields and figures of a study; the vectors have one entry a stretch.
#[derive(Debug)]
pub struct Results {
    /// The lattice; its mesh is that of the corrected fields too.
    pub springs: MassSpring,
    /// The lattice in equilibrium.
    pub uncorrected: Vec<Solution>,
    /// The corrected fields.
    pub corrected: Vec<CorrectedState>,
    /// The finite elements on three meshes, coarse to fine; the last is the reference.
    pub reference: [ReferenceMesh; 3],
    /// The estimated error of the finest of them.
    pub estimates: Vec<ErrorEstimate>,
    /// The reference field at the nodes of the lattice in mm.
    pub reference_on_lattice: Vec<Vec<f64>>,
    /// Deviations from the reference.
    pub comparison: Vec<StepComparison>,
    /// Wall-clock times: what, and seconds.
    pub times: Vec<(&'static str, f64)>,
}

impl Results {
    /// The finest finite-element mesh and its solutions.
    pub fn finest(&self) -> &ReferenceMesh {
        &self.reference[2]
    }

    /// The estimated error of the finest mesh's force at a stretch in %, without its sign.
    pub fn estimated_force_percent(&self, step: usize) -> f64 {
        100.0 * (self.estimates[step].force / self.finest().solutions[step].force).abs()
    }

    /// Every requirement on the corrected field with its worst value over all stretches.
    pub fn requirements(&self, tolerances: &Tolerances) -> Vec<Requirement> {
        let largest = |name, limit: f64, value: fn(&Deviation) -> f64| {
            let steps = self.comparison.iter();
            let worst = worst(steps.map(|step| value(&step.corrected).abs()), f64::max);
            Requirement {
                name,
                limit,
                worst,
                passed: worst <= limit,
                at_most: true,
            }
        };
        let steps = self.comparison.iter();
        let corrections = steps.map(|step| step.correction_percent(|d| d.departure_percent));
        let correction = worst(corrections, f64::min);
        vec![
            largest("displacement", tolerances.displacement_percent, |d| {
                d.displacement_percent
            }),
            largest("departure from affine", tolerances.departure_percent, |d| {
                d.departure_percent
            }),
            largest("force", tolerances.force_percent, |d| d.force_percent),
            Requirement {
                name: "correction of the departure",
                limit: tolerances.correction_percent,
                worst: correction,
                passed: correction >= tolerances.correction_percent,
                at_most: false,
            },
        ]
    }
}

/// A requirement on the corrected field, in percent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirement {
    /// The measure.
    pub name: &'static str,
    /// The study's tolerance.
    pub limit: f64,
    /// The worst value over all stretches.
    pub worst: f64,
    /// Whether the worst value is within the limit; one that is not a number is not.
    pub passed: bool,
    /// Whether the limit is the largest value that passes; else it is the smallest.
    pub at_most: bool,
}

/// The largest or smallest value; not a number when one of them is none.
fn worst(values: impl Iterator<Item = f64>, pick: fn(f64, f64) -> f64) -> f64 {
    let either = |a: f64, b: f64| match a.is_nan() || b.is_nan() {
        true => f64::NAN,
        false => pick(a, b),
    };
    values.reduce(either).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_not_a_number_is_the_worst() {
        assert_eq!(worst([3.0, 1.0, 2.0].into_iter(), f64::max), 3.0);
        assert_eq!(worst([3.0, 1.0, 2.0].into_iter(), f64::min), 1.0);
        assert!(worst([3.0, f64::NAN, 2.0].into_iter(), f64::max).is_nan());
        assert!(worst([].into_iter(), f64::max).is_nan());
    }
}
