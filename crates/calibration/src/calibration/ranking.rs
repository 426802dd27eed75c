//! The ranking of all laws.

use rayon::prelude::*;

use super::data::TestData;
use super::fit::fit;
use super::fitted::{Fit, Protocols};
use super::settings::FitSettings;
use crate::error::Error;
use crate::material::registry::{Law, MARLOW_TABLE, SWELLING};

/// By what laws are ranked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// By AICc.
    Aicc,
    /// By the error with which protocols of a biaxial test are predicted by the law fitted to the others.
    LeftOut,
}

impl Criterion {
    /// That of some fits: protocols that were left out, where all laws have them.
    pub fn of(fits: &[Fit]) -> Self {
        if fits.iter().all(|fit| fit.protocols.is_some()) {
            Self::LeftOut
        } else {
            Self::Aicc
        }
    }

    /// Its value for a fit: the smaller the better.
    pub fn value(self, fit: &Fit) -> f64 {
        let protocols = fit.protocols.as_ref().filter(|_| self == Self::LeftOut);
        protocols.map_or(fit.quality.aicc, Protocols::all_left_out_percent)
    }
}

/// All laws that keep their volume and can be fitted to some tests, the best one by their [`Criterion`] first; laws that cannot be fitted are
/// left out, with the reasons.
pub fn rank(tests: &[TestData], settings: &FitSettings) -> (Vec<Fit>, Vec<String>) {
    // A fibre law needs to see two directions.
    let axis = |axis: usize| {
        tests
            .iter()
            .flat_map(|test| &test.observations)
            .any(|one| one.axis == axis)
    };
    let both_axes = axis(0) && axis(1);
    let eligible: Vec<&'static Law> = Law::fitted()
        .filter(|law| ![MARLOW_TABLE, SWELLING].contains(&law.name))
        .filter(|law| {
            let (model, _) = law.unknown();
            // Stresses of the usual tests alone do not determine how a body changes its volume.
            model.bulk_modulus().is_none() && (both_axes || model.is_isotropic())
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
    let criterion = Criterion::of(&fits);
    fits.sort_by(|a, b| criterion.value(a).total_cmp(&criterion.value(b)));
    (fits, reasons)
}

/// Of ranked fits the first that is stable over the data and all of whose parameters are determined, otherwise the
/// first that is stable, otherwise the first; `None` where there is none.
pub fn best(fits: Vec<Fit>) -> Option<Fit> {
    let is_stable = |fit: &Fit| fit.quality.is_stable();
    let is_determined = |fit: &Fit| is_stable(fit) && fit.quality.is_identifiable();
    let determined = fits.iter().position(is_determined);
    let chosen = determined.or_else(|| fits.iter().position(is_stable));
    fits.into_iter().nth(chosen.unwrap_or(0))
}
