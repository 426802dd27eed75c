//! Whether records begin with the first loading of their specimens.
//!
//! A specimen that was stretched before its record (preconditioned) has softened up to that stretch already. Beyond it, the record still shows
//! the first loading; if it stays below, nothing softens any more, and the law found is that of the softened specimen.

use super::misfit::{Softens, WithoutSoftening};
use crate::calibration::data::{Test, TestData};
use crate::calibration::least_squares::{Precision, Residuals, minimise, sum_of_squares};
use crate::calibration::regression::{Candidate, Misfit, improved};
use crate::calibration::solution::Solution;
use crate::statistics::{f_tail, farthest};

/// The earlier stretches that are tried are equal steps to the largest one of the record, which is the last and not tried.
const STEPS: usize = 12;
/// More parameters are needed where chance gives as much as they do with a smaller probability.
const CERTAIN: f64 = 1e-3;
/// Residuals that are systematic with the earlier stretch too must fall at least to this share of their squares.
const SYSTEMATIC: f64 = 0.25;

/// The search for the parameters of a law that softens.
pub struct Search<'a> {
    /// The values at which it begins.
    pub start: &'a [f64],
    /// The bounds of all parameters.
    pub bounds: &'a [[f64; 2]],
    /// The largest energy of the tests, in mJ/mm³.
    pub largest: f64,
}

impl Search<'_> {
    /// The best of several rough searches.
    pub fn rough_minimum(&self, misfit: &Misfit<Softens>) -> Option<Candidate> {
        let of_law = misfit.response.of_law;
        let mut starts = Vec::new();
        for r in [1.3, 2.0, 4.0] {
            for width in [0.05, 0.3] {
                for beta in [0.01, 0.3] {
                    let softening = [r, width * self.largest, beta];
                    let values = [&self.start[..of_law], &softening].concat();
                    let within = values.iter().zip(self.bounds);
                    let within = within.map(|(value, [low, high])| value.clamp(*low, *high));
                    starts.push(within.collect());
                }
            }
        }
        improved(misfit, starts, self.bounds).into_iter().next()
    }

    /// What speaks against values that were found for records which begin with the first loading, or as they state.
    pub fn doubts(&self, misfit: &Misfit<Softens>, values: &[f64]) -> Option<String> {
        let stated_sum = sum_of_squares(misfit, values);
        self.nothing_softens(misfit, values, stated_sum)
            .or_else(|| self.earlier_stretch(misfit, stated_sum))
    }

    /// The warning where the law alone follows the data as well.
    fn nothing_softens(
        &self,
        misfit: &Misfit<Softens>,
        values: &[f64],
        stated_sum: f64,
    ) -> Option<String> {
        let law = WithoutSoftening(misfit);
        let of_law = misfit.response.of_law;
        let start = &values[..of_law];
        let alone = match start {
            // The law is that of a card.
            [] => None,
            _ => minimise(&law, start, &self.bounds[..of_law], Precision::Full),
        };
        let alone = sum_of_squares(&law, alone.as_deref().unwrap_or(start));
        let more = values.len() - of_law;
        // Softening that is not there leaves residuals as before, whose number of independent points is not known.
        let freedom = misfit.count() as f64 - values.len() as f64;
        (chance(more, freedom, alone / stated_sum) > CERTAIN).then(|| {
            "these data show no softening: the law alone follows them as well. A specimen that was stretched further before its record does not \
             soften again below that stretch; its law is then that of the softened specimen. Give the record of the first loading too, or state the \
             law of the first loading (`--card`) and the earlier stretch (`--preconditioned`)"
                .to_owned()
        })
    }

    /// The warning where an earlier stretch that no record states describes the data far better.
    fn earlier_stretch(&self, stated: &Misfit<Softens>, stated_sum: f64) -> Option<String> {
        let response = &stated.response;
        let is_open = |test: &TestData| test.preconditioned.is_none() && test.test != Test::Biaxial;
        let strains = response.tests.iter().filter(|test| is_open(test));
        let far = farthest(strains.flat_map(|test| {
            let rows = test.observations.iter();
            rows.map(|one| test.drawn_strain(one))
        }));
        let tried = (1..STEPS).filter_map(|step| {
            let strain = far * step as f64 / STEPS as f64;
            let mut tests = response.tests.to_vec();
            for test in tests.iter_mut().filter(|test| is_open(test)) {
                test.preconditioned = Some(strain);
            }
            let response = Softens {
                tests: &tests,
                ..response.clone()
            };
            let misfit = Misfit::new(response, stated.weighting);
            let (sum, values) = self.rough_minimum(&misfit)?;
            let rough = Solution {
                misfit,
                values,
                bounds: self.bounds.to_vec(),
            };
            let judged = rough.judged();
            let explains = judged.is_noise() || sum < SYSTEMATIC * stated_sum;
            let points = rough.misfit.count() as f64;
            let freedom = judged.effective(points) - rough.values.len() as f64;
            let chance = chance(1, freedom, stated_sum / sum);
            let is_better = explains && chance < CERTAIN / STEPS as f64;
            is_better.then_some((sum, strain))
        });
        let (sum, strain) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(format!(
            "the records do not begin with the first loading: an earlier stretch to about λ = {:.2} reduces the residuals to {:.0} % of their root \
             mean square. State it (`--preconditioned`, or `# preconditioned: 1.5` in the file), or give the record of the first loading",
            1.0 + strain,
            100.0 * (sum / stated_sum).sqrt()
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
