//! A law fitted to the forces of a sheet on its mounting, which finite elements solve for every law that is tried.
//!
//! ```text
//! homogeneous law ─▶ finite elements of the mounted sheet ─▶ what the middle carries of the measured forces ─▶ law ─▶ …
//! ```
//!
//! Forces over cross-sections are not the stress of the middle: tines concentrate the load, and the sheet between them is slack. So the
//! sheet is solved with the present law p at some strains ε of its bars; there its middle has the strains m(ε; p), and its forces f are
//!
//! ```text
//! fₖ/Aₖ = Pₖ(m; p) + dₖ(ε; p) (Pₖ(m; p)² + P₁²)^½,   P₁ a fifth of the largest stress
//! ```
//!
//! d is the effect of the tines, or of the arms: near rest it is proportional to the strains, and far from it the share of the stress. m and
//! d are interpolated to all rows (cubic radial functions) from strains of which the first is none, where both vanish if the sheet is mounted
//! at rest. A measured force x differs from fₖ, as the law is not yet the right one; what the middle carried of it is
//!
//! ```text
//! Pₖ + (x/Aₖ − fₖ/Aₖ) (|Pₖ| + P₀) / (|fₖ/Aₖ| + P₀),   P₀ a fiftieth of the largest stress
//! ```
//!
//! which is in proportion to x where stresses are large. To this the law is fitted as to any test. What d and m change with the law enters by
//! its derivatives, taken from the finite elements of laws nearby: the fit is that of the finite elements once it does not change, and so are
//! its intervals.
//!
//! # References
//! J. W. Bandler et al., IEEE Trans. Microw. Theory Tech. 52, 337 (2004), doi:10.1109/TMTT.2003.820904 (space mapping);
//! N. T. Jacobs et al., J. Biomech. Eng. 135, 054508 (2013), doi:10.1115/1.4023965 (biaxial tests)

use super::data::{Mounting, TestData};
use super::fitted::{Fit, MountedFit};
use super::nearest::nearest;
use super::settings::FitSettings;
use crate::error::Error;
use crate::material::registry::Law;

mod interpolation;
mod middle;
mod search;
mod sheet;
mod solved;
#[cfg(test)]
mod tests;

use solved::{Solved, named};

/// The largest distance between neighbouring knots, as a share of the largest strains.
const NEAR: f64 = 0.07;
/// Forces that change by less, as a share of the largest one, are settled.
const SETTLED: f64 = 2e-4;

/// The mounting of some tests, which must all have the same one.
///
/// # Errors
/// [`Error::Input`] where they do not.
pub fn mounting(tests: &[TestData]) -> Result<Option<Mounting>, Error> {
    let first = tests.first().map(|test| test.mounted);
    if let Some(other) = tests.iter().find(|test| Some(test.mounted) != first) {
        let message = format!(
            "{} states another mounting, rest state or zero of force than {}",
            other.name, tests[0].name
        );
        let hint = "the tests of one fit are those of one specimen; fit each specimen for itself";
        return Err(Error::input(message, hint));
    }
    Ok(first.and_then(|mounted| mounted.mounting))
}

/// Refuses tests of a sheet on its mounting, or whose state at rest or zeros of force are found with the law, for fits that take neither into
/// account.
///
/// # Errors
/// [`Error::Input`] with the first of them.
pub fn refuse_mounted(tests: &[TestData]) -> Result<(), Error> {
    let is_solved = |test: &&TestData| {
        let mounted = &test.mounted;
        mounted.mounting.is_some() || mounted.estimates_stretches() || mounted.estimates_force_zero
    };
    let Some(test) = tests.iter().find(is_solved) else {
        return Ok(());
    };
    let message = format!(
        "{}: relaxation and softening are not fitted with the mounting, the state at rest or the zero of force of a sheet",
        test.name
    );
    Err(Error::input(
        message,
        "fit the law alone, or leave these statements out",
    ))
}

/// Values of a law, and of the state at rest, from which the iteration converges. At first the sheet is taken as free of stress as mounted:
/// with an isotropic law, a stretch as mounted would compensate for the missing anisotropy and lead far away.
fn begin(
    law: &'static Law,
    tests: &[TestData],
    mounting: Mounting,
    settings: &FitSettings,
) -> Result<Vec<f64>, Error> {
    let plain = FitSettings {
        bounds: Vec::new(),
        ..settings.clone()
    };
    let as_mounted: Vec<TestData> = tests.iter().map(TestData::as_mounted).collect();
    let on_few_knots = |tests: &[TestData]| Solved::new(tests, mounting, 4.0 * NEAR);
    let mut sheet = on_few_knots(&as_mounted);
    // A stiffening law without directions leads to the strains of the middle, at which any law is sought.
    let neo_hooke = sheet.neo_hookean(&as_mounted)?;
    let isotropic = named("fung-demiray");
    let begin = nearest(isotropic, &sheet.of_middle(&neo_hooke), &plain)?;
    let isotropic = sheet.nearly_settled(isotropic, begin.values(), &plain)?;
    let begin = sheet.extended(&isotropic, law, settings)?;
    let mut values = sheet.nearly_settled(law, begin, settings)?.values;
    if tests[0].mounted.estimates_stretches() {
        values.extend([1.0; 2]);
        let mut sheet = on_few_knots(tests);
        values = sheet.nearly_settled(law, values, settings)?.values;
    }
    Ok(values)
}

/// The law that is nearest to tests of a sheet on its mounting.
///
/// # Errors
/// As [`nearest`]; [`Error::Solve`] where the sheet has no equilibrium with the law of the homogeneous reading.
pub fn nearest_mounted(
    law: &'static Law,
    tests: &[TestData],
    mounting: Mounting,
    settings: &FitSettings,
) -> Result<Fit, Error> {
    let homogeneous = nearest(law, tests, settings)?;
    let begin = begin(law, tests, mounting, settings)?;
    let mut sheet = Solved::new(tests, mounting, NEAR);
    let reached = sheet.settled(law, begin, settings, SETTLED)?;
    let (fine, discretisation) = sheet.extrapolated(&reached)?;
    let values = reached.values;
    let tests = sheet.of_middle(&fine);
    let mut fit = sheet.about(law, (&fine, &tests), &values, settings).fit()?;
    if reached.change > SETTLED {
        fit.quality.warnings.push(format!(
            "the law and the sheet on its mounting have not settled: forces still change by {:.2} % of the largest",
            100.0 * reached.change
        ));
    }
    let bias_percent = sheet.bias(&homogeneous, &fit);
    fit.mounted = Some(MountedFit {
        bias_percent,
        homogeneous: homogeneous.law_parameters().to_vec(),
        tests,
        discretisation_percent: 100.0 * discretisation,
        rounds: reached.rounds,
    });
    Ok(fit)
}
