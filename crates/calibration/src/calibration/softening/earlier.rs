//! Whether records begin with the first loading of their specimens.
//!
//! A specimen that was stretched before its record (preconditioned) has softened up to that stretch already. Beyond it, the record still shows
//! the first loading; if it stays below, nothing softens any more, and the law found is that of the softened specimen.

use super::misfit::{Base, SofteningMisfit, WithoutSoftening};
use super::search::{judged, rough_minimum};
use crate::calibration::data::{Test, TestData};
use crate::calibration::least_squares::{Precision, Residuals, minimise, sum_of_squares};
use crate::calibration::settings::Weighting;
use crate::statistics::{f_tail, farthest};

/// The earlier stretches that are tried are equal steps to the largest one of the record, which is the last and not tried.
const STEPS: usize = 12;
/// More parameters are needed where chance gives as much as they do with a smaller probability.
const CERTAIN: f64 = 1e-3;
/// Residuals that are systematic with the earlier stretch too must fall at least to this share of their squares.
const SYSTEMATIC: f64 = 0.25;

/// The search for the parameters of a law that softens.
pub struct Search<'a> {
    /// Where the law comes from.
    pub base: Base<'a>,
    /// The tests.
    pub tests: &'a [TestData],
    /// The values at which it begins.
    pub start: &'a [f64],
    /// The bounds of all parameters.
    pub bounds: &'a [[f64; 2]],
    /// The largest energy of the tests, in mJ/mm³.
    pub largest: f64,
    /// The weights of the residuals.
    pub weighting: Weighting,
}

impl Search<'_> {
    /// What speaks against values that were found for records which begin with the first loading, or as they state.
    pub fn doubts(&self, misfit: &SofteningMisfit, values: &[f64]) -> Option<String> {
        let found = sum_of_squares(misfit, values);
        self.nothing_softens(misfit, values, found)
            .or_else(|| self.earlier_stretch(misfit.of_law, found))
    }

    /// The warning where the law alone follows the data as well.
    fn nothing_softens(
        &self,
        misfit: &SofteningMisfit,
        values: &[f64],
        found: f64,
    ) -> Option<String> {
        let law = WithoutSoftening(misfit);
        let start = &values[..misfit.of_law];
        let alone = match start {
            // The law is that of a card.
            [] => None,
            _ => minimise(&law, start, &self.bounds[..misfit.of_law], Precision::Full),
        };
        let alone = sum_of_squares(&law, alone.as_deref().unwrap_or(start));
        let more = values.len() - misfit.of_law;
        // Softening that is not there leaves residuals as before, whose number of independent points is not known.
        let freedom = misfit.count() as f64 - values.len() as f64;
        (chance(more, freedom, alone / found) > CERTAIN).then(|| {
            "these data show no softening: the law alone follows them as well. A specimen that was stretched further before its record does not \
             soften again below that stretch; its law is then that of the softened specimen. Give the record of the first loading too, or state the \
             law of the first loading (`--card`) and the earlier stretch (`--preconditioned`)"
                .to_owned()
        })
    }

    /// The warning where an earlier stretch that no record states describes the data far better.
    fn earlier_stretch(&self, of_law: usize, found: f64) -> Option<String> {
        let is_open = |test: &TestData| test.preconditioned.is_none() && test.test != Test::Biaxial;
        let strains = self.tests.iter().filter(|test| is_open(test));
        let far = farthest(strains.flat_map(|test| {
            let rows = test.observations.iter();
            rows.map(|one| test.drawn_strain(one))
        }));
        let tried = (1..STEPS).filter_map(|step| {
            let strain = far * step as f64 / STEPS as f64;
            let mut tests = self.tests.to_vec();
            for test in tests.iter_mut().filter(|test| is_open(test)) {
                test.preconditioned = Some(strain);
            }
            let misfit = SofteningMisfit::new(self.base, of_law, &tests, self.weighting);
            let (sum, values) = rough_minimum(&misfit, self.start, self.bounds, self.largest)?;
            let judged = judged(&misfit, &tests, &values, self.bounds, self.weighting);
            let explains = judged.is_noise() || sum < SYSTEMATIC * found;
            let freedom = judged.effective(misfit.count() as f64) - values.len() as f64;
            let chance = chance(1, freedom, found / sum);
            let is_better = explains && chance < CERTAIN / STEPS as f64;
            is_better.then_some((sum, strain))
        });
        let (sum, strain) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(format!(
            "the records do not begin with the first loading: an earlier stretch to about λ = {:.2} reduces the residuals to {:.0} % of their root \
             mean square. State it (`--preconditioned`, or `# preconditioned: 1.5` in the file), or give the record of the first loading",
            1.0 + strain,
            100.0 * (sum / found).sqrt()
        ))
    }
}

/// The probability that so many more parameters reduce a sum of squares by a ratio if none of them is needed.
fn chance(more: usize, freedom: f64, ratio: f64) -> f64 {
    f_tail(
        [more as f64, freedom],
        (ratio - 1.0) * freedom / more as f64,
    )
}
