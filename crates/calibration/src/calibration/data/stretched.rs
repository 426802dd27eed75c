//! Tests relative to another state of their sheet.

use super::mounting::RestState;
use super::test_data::{Observation, TestData};
use crate::material::parameters::StressMeasure;

impl Observation {
    /// The observation relative to a state at rest, of which the sheet was stretched by g along an axis as mounted: λ becomes g λ, and P
    /// becomes P/g, because the cross-section of an incompressible sheet is g times as large at rest.
    pub(in crate::calibration) fn stretched(
        &self,
        axis: usize,
        stretch: f64,
        measure: StressMeasure,
    ) -> Self {
        let mut moved = *self;
        moved.strains[axis] = stretch * (1.0 + self.strains[axis]) - 1.0;
        if axis == self.axis && measure == StressMeasure::Nominal {
            moved.stress /= stretch;
        }
        moved
    }
}

impl TestData {
    /// The test with its sheet taken as free of stress as mounted, where its state at rest would be estimated.
    pub(in crate::calibration) fn as_mounted(&self) -> Self {
        let mut test = self.clone();
        if test.mounted.estimates_stretches() {
            test.mounted.rest_state = RestState::AsMounted;
        }
        test
    }

    /// The test relative to a state at rest, of which the sheet was stretched along both axes as mounted.
    #[must_use]
    pub(in crate::calibration) fn stretched(&self, [first, second]: [f64; 2]) -> Self {
        if [first, second] == [1.0; 2] {
            return self.clone();
        }
        let measure = self.stress_measure;
        self.with_observations(|one| {
            one.stretched(0, first, measure)
                .stretched(1, second, measure)
        })
    }

    /// The test with other observations.
    #[must_use]
    pub(in crate::calibration) fn with_observations(
        &self,
        change: impl Fn(&Observation) -> Observation,
    ) -> Self {
        let mut all = self.clone();
        for one in all.observations.iter_mut().chain(&mut all.left_out) {
            *one = change(one);
        }
        all.largest_stress = Observation::largest_stress(&all.observations);
        all
    }
}
