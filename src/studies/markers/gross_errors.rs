//! The weights of markers where nothing is said of them: all alike, unless some are farther off than noise can be.
//!
//! ```text
//! m e^(−d²/2) < 10⁻³      d: the largest standardised residual of m markers
//! ```
//!
//! is a marker that noise makes in less than one of a thousand frames. Many gross errors hide each other: then the median of all d is far
//! below that of noise. A marker like that is a gross error as long as there are few, or as they lie scattered among the others: many
//! that lie together are a misfit of the equations, which must not be weighted away.

use super::MarkerStudy;
use super::report::{outliers, used};
use crate::corrector::estimation::{FieldEstimate, Knowledge, Robust};
use crate::error::Error;
use crate::markers::Marker;
use crate::statistics::{nearest, robust_deviation};

/// The largest share of gross errors among markers, wherever they lie; and where they are scattered.
const MOST: f64 = 0.1;
const MOST_SCATTERED: f64 = 0.45;

/// The scatter by the median over that by squares below which many markers may be gross errors, and are: 1 of normal noise, 0.8 of Laplace's.
const IN_DOUBT: f64 = 0.75;
const HIDDEN: f64 = 0.5;

/// Neighbours of a marker among which others like it are counted.
const AROUND: usize = 4;

/// Probability by noise below which a marker is a gross error.
const CHANCE: f64 = 1e-3;

impl MarkerStudy {
    /// The estimate with the weights that are said, else with Tukey's where there are gross errors; these may also keep an estimate
    /// without such weights from being found.
    pub(super) fn weighted(
        &self,
        markers: &[Marker],
        knowledge: Knowledge,
        solve: &dyn Fn(&Knowledge) -> Result<FieldEstimate, Error>,
    ) -> Result<FieldEstimate, Error> {
        let found = solve(&knowledge);
        let in_doubt = match &found {
            Ok(found) => has_gross_errors(found) || scatter_by_median(found) < IN_DOUBT,
            Err(fault) => matches!(fault, Error::Solve { .. }),
        };
        if self.conditions.robust.is_some() || !in_doubt {
            return found;
        }
        let robust = Knowledge {
            robust: Robust::Tukey,
            ..knowledge
        };
        let without = solve(&robust).ok();
        let are_errors = |found: &FieldEstimate| !has_many(found) || are_scattered(markers, found);
        let without = without.filter(|found| has_gross_errors(found) && are_errors(found));
        without.map_or(found, Ok)
    }

    /// What is said of gross errors that were found without being asked for.
    pub(super) fn of_gross_errors(&self, estimate: &FieldEstimate) -> Option<String> {
        (self.conditions.robust.is_none() && estimate.robust == Robust::Tukey).then(|| {
            format!(
                "{} of {} markers are outliers, some farther off than noise can explain: Tukey's weights reduce the weight of a marker the farther it is off \
                 (robust = \"no\" gives all markers full weight)",
                outliers(estimate),
                used(estimate)
            )
        })
    }
}

fn has_gross_errors(estimate: &FieldEstimate) -> bool {
    let distances = estimate.markers.iter().flatten();
    let largest = distances.map(|marker| marker.standardised_residual);
    let largest = largest.fold(0.0, f64::max);
    used(estimate) as f64 * (-0.5 * largest * largest).exp() < CHANCE
}

/// The scatter of the standardised residuals by their median, over that of noise.
fn scatter_by_median(estimate: &FieldEstimate) -> f64 {
    let markers = estimate.markers.iter().flatten();
    robust_deviation(markers.map(|marker| marker.standardised_residual))
}

/// Fewer degrees of freedom tell nothing of the shape of noise.
const FEWEST: f64 = 20.0;

/// Noise below this share of the largest displacement is that of the numbers: of a computed field.
const ROUNDING: f64 = 1e-6;

/// Whether gross errors are so many that they make the noise of an estimate that is explained, though no weights were asked for.
pub(super) fn has_hidden(estimate: &FieldEstimate) -> bool {
    let displacement = estimate.displacement.iter();
    let largest = displacement.fold(0.0, |most: f64, u| most.max(u.abs()));
    estimate.robust == Robust::No
        && estimate.is_explained()
        && estimate.degrees_of_freedom >= FEWEST
        && estimate.noise > ROUNDING * largest
        && scatter_by_median(estimate) < HIDDEN
}

/// Whether outliers lie among the others as by chance: of the neighbours of one as many are outliers as of all markers, within three
/// standard deviations.
fn are_scattered(markers: &[Marker], estimate: &FieldEstimate) -> bool {
    let pairs = markers.iter().zip(&estimate.markers);
    let used: Vec<_> = pairs
        .filter_map(|(marker, own)| Some((marker.place, own.as_ref()?.outlier)))
        .collect();
    let places: Vec<[f64; 2]> = used.iter().map(|(place, _)| *place).collect();
    let around = nearest(&places, AROUND);
    let outliers = (0..used.len()).filter(|index| used[*index].1);
    let (mut count, mut alike, mut neighbours) = (0.0, 0.0, 0.0);
    for own in outliers {
        count += 1.0;
        neighbours += around[own].len() as f64;
        alike += around[own].iter().filter(|other| used[**other].1).count() as f64;
    }
    let share = count / used.len() as f64;
    // Each pair is counted from both ends.
    let deviation = (2.0 * share * (1.0 - share) / neighbours).sqrt();
    share < MOST_SCATTERED && alike / neighbours < share + 3.0 * deviation
}

/// Whether there are more outliers than gross errors can be.
pub(super) fn has_many(estimate: &FieldEstimate) -> bool {
    outliers(estimate) as f64 > MOST * used(estimate) as f64
}
