//! The search for the parameters of a law that softens, and what the residuals there are.

use rayon::prelude::*;

use super::misfit::{SOFTENING, SofteningMisfit};
use crate::calibration::data::TestData;
use crate::calibration::least_squares::{Precision, descend, minimise, sum_of_squares};
use crate::calibration::settings::Weighting;
use crate::calibration::trust::{AT_BOUND, Judged, Values, at_bound, rounded};

/// The best values from several softenings.
pub fn minimum(
    misfit: &SofteningMisfit,
    start: &[f64],
    bounds: &[[f64; 2]],
    largest: f64,
) -> Option<Vec<f64>> {
    let (_, best) = rough_minimum(misfit, start, bounds, largest)?;
    Some(descend(misfit, &best, bounds).unwrap_or(best))
}

/// The sum of squares and the values of the best of several rough searches.
pub fn rough_minimum(
    misfit: &SofteningMisfit,
    start: &[f64],
    bounds: &[[f64; 2]],
    largest: f64,
) -> Option<(f64, Vec<f64>)> {
    let of_law = start.len() - SOFTENING.len();
    let mut starts = Vec::new();
    for r in [1.3, 2.0, 4.0] {
        for width in [0.05, 0.3] {
            for beta in [0.01, 0.3] {
                let own = [r, width * largest, beta];
                let mut values: Vec<f64> = start[..of_law].iter().copied().chain(own).collect();
                for (value, [low, high]) in values.iter_mut().zip(bounds) {
                    *value = value.clamp(*low, *high);
                }
                starts.push(values);
            }
        }
    }
    let improved = |start: &Vec<f64>| {
        let found = minimise(misfit, start, bounds, Precision::Rough)?;
        Some((sum_of_squares(misfit, &found), found))
    };
    let rough: Vec<(f64, Vec<f64>)> = starts.par_iter().filter_map(improved).collect();
    rough.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The residuals at some values.
pub fn judged(
    misfit: &SofteningMisfit,
    tests: &[TestData],
    values: &[f64],
    bounds: &[[f64; 2]],
    weighting: Weighting,
) -> Judged {
    let at_bound = at_bound(values, bounds, AT_BOUND);
    let rounded = rounded(tests, &*misfit.law(values), weighting);
    Judged::of(
        misfit,
        misfit.curves(),
        Values::held(values, at_bound),
        rounded,
    )
}
