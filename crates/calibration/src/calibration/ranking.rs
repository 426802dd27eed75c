//! The ranking of all laws.

use rayon::prelude::*;

use super::data::TestData;
use super::fit::fit;
use super::fitted::Fit;
use super::settings::{FitSettings, MEASURE};
use crate::error::Error;
use crate::material::parameters::StressMeasure;
use crate::material::registry::{LAWS, Law, MARLOW_TABLE, SWELLING};

/// All laws that keep their volume and can be fitted to some tests, the one with the smallest AICc first; laws that
/// cannot be fitted are left out, with the reasons.
pub fn rank(tests: &[TestData], settings: &FitSettings) -> (Vec<Fit>, Vec<String>) {
    // A fibre law needs to see two directions.
    let axis = |axis: usize| {
        tests
            .iter()
            .flat_map(|test| &test.observations)
            .any(|one| one.axis == axis)
    };
    let (both_axes, measure) = (axis(0) && axis(1), StressMeasure::Nominal);
    let eligible: Vec<&'static Law> = LAWS
        .iter()
        .filter(|law| ![MARLOW_TABLE, SWELLING].contains(&law.name))
        .filter(|law| {
            let own = law.with_values(&[], measure, MEASURE).0;
            // Stresses of the usual tests alone do not determine how a body changes its volume.
            own.bulk_modulus().is_none() && (both_axes || own.is_isotropic())
        })
        .collect();
    let outcomes: Vec<Result<Fit, Error>> = eligible
        .into_par_iter()
        .map(|law| fit(law, tests, settings))
        .collect();
    let (mut fits, mut reasons) = (Vec::new(), Vec::new());
    for outcome in outcomes {
        match outcome {
            Ok(fit) => fits.push(fit),
            Err(reason) => reasons.push(reason.to_string()),
        }
    }
    fits.sort_by(|a, b| a.quality.aicc.total_cmp(&b.quality.aicc));
    (fits, reasons)
}

/// Of ranked fits the first that is stable over the data and all of whose parameters are determined, otherwise the
/// first that is stable, otherwise the first; `None` where there is none.
pub fn best(fits: Vec<Fit>) -> Option<Fit> {
    let is_stable = |fit: &Fit| fit.quality.is_stable();
    let is_determined = |fit: &Fit| is_stable(fit) && fit.quality.is_identifiable();
    let chosen = fits.iter().position(is_determined);
    let chosen = chosen.or_else(|| fits.iter().position(is_stable));
    fits.into_iter().nth(chosen.unwrap_or(0))
}
