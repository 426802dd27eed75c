//! What deserves attention in an identification.

use super::recording::Recording;
use super::smoothing::{SignalSpline, bridged_parts, wanted_parts};
use super::types::Identification;
use crate::statistics::{Estimate, median};

/// A longest interval that leaves the motion less than this share of the parts that both signals ask for is a gap, ...
const FEW: f64 = 0.5;

/// ... and so is one of so many usual ones, and of such a part of the duration.
const INTERVALS: f64 = 20.0;
const PART: f64 = 0.05;

/// The warning about a gap in the rows: a spline has only as many parts as the gap leaves it, and what they miss is taken for noise.
fn gap(times: &[f64], [wanted, bridged]: [usize; 2]) -> Option<String> {
    let length = |pair: &[f64]| pair[1] - pair[0];
    let usual = median(times.windows(2).map(length));
    let longest = times
        .windows(2)
        .max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let duration = times.last()? - times.first()?;
    let is_few = (bridged as f64) < FEW * wanted as f64;
    (is_few || length(longest) > (INTERVALS * usual).max(PART * duration)).then(|| {
        format!(
            "there are no rows between {} and {} s: the motion may be told with less detail than it has, and the rest be taken for noise; \
             identify what lies before and after it by itself",
            longest[0], longest[1]
        )
    })
}

/// A corner alone is a jerk, or chance.
pub const FEWEST_CORNERS: usize = 4;

/// The warnings of an identification from the splines of extension and force, and the number of the motion's corners.
pub fn warnings(
    found: &Identification,
    recording: &Recording,
    signals: &(SignalSpline, SignalSpline),
    corners: usize,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if corners >= FEWEST_CORNERS {
        warnings.push(format!(
            "the motion has {corners} corners, as where a machine turns at a constant rate: the smooth motion that is fitted goes past them, \
             so that intervals and bands do not hold; drive it by sines, or identify the ways between corners by themselves"
        ));
    }
    if signals.0.coarse || signals.1.coarse {
        warnings
            .push("the motion is sampled too coarsely for its noise to be told from it".to_owned());
    }
    let excess = (found.misfit - 1.0) / (2.0 / found.freedom).sqrt();
    if excess > 4.0 {
        warnings.push(format!(
            "force and motion do not fit together: what is left is {:.2} times the noise; the mass, the length at rest or \
             the forms are wrong, the noise correlates, or there is more than one spring and one dashpot; intervals hold white \
             noise alone and are too narrow",
            found.misfit.sqrt()
        ));
    }
    let parts = [
        wanted_parts(&signals.0, &signals.1),
        bridged_parts(&recording.times),
    ];
    warnings.extend(gap(&recording.times, parts));
    for (name, _, function) in found.functions() {
        let estimates: Vec<_> = function
            .places(41)
            .into_iter()
            .map(|x| function.at(x))
            .collect();
        let negative = |estimate: &Estimate| estimate.interval[1] < 0.0;
        if estimates.iter().all(negative) {
            warnings.push(format!(
                "{name}(·) is negative: turn the sign of the force or of the extension"
            ));
        } else if estimates.iter().any(negative) {
            warnings.push(format!(
                "{name}(·) is negative somewhere: no passive spring does that"
            ));
        } else if estimates.iter().all(|estimate| estimate.interval[0] <= 0.0) {
            warnings.push(format!("the recording does not tell {name}(·) from zero"));
        }
    }
    if recording.mass == 0.0 {
        warnings.push("no mass is stated: inertia is left out".to_owned());
    }
    warnings
}
