//! The weights of markers where nothing is said of them: all alike, unless some are farther off than noise can be.
//!
//! ```text
//! m e^(−d²/2) < 10⁻³      d: the largest standardised residual of m markers
//! ```
//!
//! is a marker that noise makes in less than one of a thousand frames. A marker like that is a gross error as long as there are few:
//! many are a misfit of the equations, which must not be weighted away.

use super::MarkerStudy;
use super::report::{outliers, used};
use crate::corrector::estimation::{FieldEstimate, Knowledge, Robust};
use crate::error::Error;

/// The largest share of gross errors among markers; more outliers are none.
const MOST: f64 = 0.1;

/// Probability by noise below which a marker is a gross error.
const CHANCE: f64 = 1e-3;

impl MarkerStudy {
    /// The estimate with the weights that are said, else with Tukey's where there are gross errors; these may also keep an estimate
    /// without such weights from being found.
    pub(super) fn weighted(
        &self,
        knowledge: Knowledge,
        solve: &dyn Fn(&Knowledge) -> Result<FieldEstimate, Error>,
    ) -> Result<FieldEstimate, Error> {
        let found = solve(&knowledge);
        let in_doubt = match &found {
            Ok(found) => has_gross_errors(found),
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
        let without = without.filter(|found| has_gross_errors(found) && !has_many(found));
        without.map_or(found, Ok)
    }

    /// What is said of gross errors that were found without being asked for.
    pub(super) fn of_gross_errors(&self, estimate: &FieldEstimate) -> Option<String> {
        (self.conditions.robust.is_none() && estimate.robust == Robust::Tukey).then(|| {
            format!(
                "{} of {} markers are outliers, some farther off than noise can be: markers have less say the farther they are off, by Tukey's weights \
                 (robust = \"no\" gives them the say of all others)",
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

/// Whether there are more outliers than gross errors can be.
pub(super) fn has_many(estimate: &FieldEstimate) -> bool {
    outliers(estimate) as f64 > MOST * used(estimate) as f64
}
