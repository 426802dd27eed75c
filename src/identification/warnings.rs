//! The warnings of an identification.

use super::basis::Form;
use super::corners::corners;
use super::recording::Recording;
use super::smoothing::{SignalSpline, bridged_parts, wanted_parts};
use super::spikes::{bridged, spikes};
use super::types::{FittedMotion, Identification};
use crate::statistics::Estimate;
use crate::units::number;

/// A longest interval is a gap if it leaves the motion less than this share of the parts that both signals ask for, ...
const FEW: f64 = 0.5;

/// ... or if it is as long as so many usual intervals and as such a part of the duration.
const INTERVALS: f64 = 20.0;
const PART: f64 = 0.05;

/// The warning about a gap in the rows: a spline has only as many parts as the gap allows, and features that these miss are taken for noise.
fn gap(recording: &Recording, [wanted, bridged]: [usize; 2]) -> Option<String> {
    let (times, usual) = (&recording.times, recording.interval());
    let length = |pair: &[f64]| pair[1] - pair[0];
    let longest = times
        .windows(2)
        .max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let duration = times.last()? - times.first()?;
    let is_few = (bridged as f64) < FEW * wanted as f64;
    (is_few || length(longest) > (INTERVALS * usual).max(PART * duration)).then(|| {
        format!(
            "there are no rows between {} and {} s: details of the motion there may be lost and counted as noise; identify the parts before and \
             after the gap separately",
            longest[0], longest[1]
        )
    })
}

/// Fewest corners that count: a single one is a jerk, or chance.
const FEWEST_CORNERS: usize = 4;

/// Rows of a recording that no smooth motion has.
pub struct Faults {
    /// The number of corners of the motion.
    corners: usize,
    /// The instants with spikes, of the extension and of the force.
    spikes: [Vec<usize>; 2],
}

impl Faults {
    /// Of a recording.
    pub fn of(recording: &Recording) -> Self {
        let Recording {
            times,
            extension,
            force,
            ..
        } = recording;
        let spikes = [extension, force].map(|values| spikes(times, values));
        Self {
            corners: corners(&bridged(times, extension, &spikes[0])).len(),
            spikes,
        }
    }

    /// Whether a smooth motion may be fitted.
    pub fn are_few(&self) -> bool {
        self.corners < FEWEST_CORNERS && self.spikes[0].is_empty()
    }

    fn warnings(&self, times: &[f64]) -> Vec<String> {
        let corners = (self.corners >= FEWEST_CORNERS).then(|| {
            format!(
                "the motion has {} corners, as where a machine reverses at a constant rate: the fitted smooth motion cannot follow them, so that \
                 intervals and bands are not valid; use sinusoidal motion, or identify the parts between corners separately",
                self.corners
            )
        });
        let spikes = ["extension", "force"].into_iter().zip(&self.spikes);
        let spikes = spikes.filter_map(|(signal, at)| {
            let first = times[*at.first()?];
            Some(format!(
                "the {signal} has {} spikes, the first at {} s: single values that are far from both neighbours bias the functions, and neither the \
                 misfit nor intervals tell of it; remove these rows",
                at.len(),
                number(first)
            ))
        });
        corners.into_iter().chain(spikes).collect()
    }
}

/// Whether a motion is a steady vibration, which passes every extension at one speed forward and at one backward: among instants of like
/// extension ẋ scatters by less than this share of its variance.
fn is_steady(motion: &FittedMotion) -> bool {
    const GROUPS: usize = 20;
    const SHARE: f64 = 0.1;
    let scatter = |group: &[[f64; 2]]| {
        let mean = group.iter().map(|[_, v]| v).sum::<f64>() / group.len() as f64;
        group.iter().map(|[_, v]| (v - mean).powi(2)).sum::<f64>()
    };
    let [mut within, mut all] = [0.0; 2];
    for forward in [true, false] {
        let pairs = motion.extension.iter().zip(&motion.rate);
        let one_way = pairs.filter(|(_, rate)| (**rate > 0.0) == forward);
        let mut one_way: Vec<[f64; 2]> = one_way.map(|(x, v)| [*x, *v]).collect();
        one_way.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let groups = one_way.chunks(one_way.len().div_ceil(GROUPS).max(1));
        within += groups.map(scatter).sum::<f64>();
        all += scatter(&one_way);
    }
    within < SHARE * all
}

/// The warnings about functions that are negative, or not distinguished from zero.
fn signs(found: &Identification) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, _, function) in found.functions() {
        let estimates: Vec<_> = function
            .places(41)
            .into_iter()
            .map(|x| function.at(x))
            .collect();
        let negative = |estimate: &Estimate| estimate.interval[1] < 0.0;
        if estimates.iter().all(negative) {
            warnings.push(format!(
                "{name}(·) is negative: reverse the sign of the force or of the extension"
            ));
        } else if estimates.iter().any(negative) {
            warnings.push(format!(
                "{name}(·) is negative somewhere: impossible for a passive spring or dashpot"
            ));
        } else if estimates.iter().all(|estimate| estimate.interval[0] <= 0.0) {
            warnings.push(format!(
                "the recording does not distinguish {name}(·) from zero"
            ));
        }
    }
    warnings
}

/// The warnings of an identification from the splines of extension and force, and the faults of its recording.
pub fn warnings(
    found: &Identification,
    recording: &Recording,
    signals: &(SignalSpline, SignalSpline),
    faults: &Faults,
) -> Vec<String> {
    let mut warnings = faults.warnings(&recording.times);
    if signals.0.coarse || signals.1.coarse {
        warnings
            .push("the motion is sampled too coarsely to distinguish it from its noise".to_owned());
    }
    let excess = (found.misfit - 1.0) / (2.0 / found.freedom).sqrt();
    if excess > 4.0 {
        warnings.push(format!(
            "force and motion do not fit together: the residual is {:.2} times the noise; the mass, the length at rest or the forms are wrong, the \
             noise is correlated, or there is more than one spring and one dashpot; intervals assume white noise and are too narrow",
            found.misfit.sqrt()
        ));
    }
    let by_splines = |form: &Form| matches!(form, Form::Spline(_));
    if found.settings.forms.iter().any(by_splines) && is_steady(&found.motion) {
        warnings.push(
            "the motion is a steady vibration, which passes every extension at one speed: it says little of D(·) between its ends, and with noise of \
             5 % bands include the true functions in about half of such recordings; drive the spring with several frequencies, or take constants or \
             polynomials"
                .to_owned(),
        );
    }
    let parts = [
        wanted_parts(&signals.0, &signals.1),
        bridged_parts(&recording.times),
    ];
    warnings.extend(gap(recording, parts));
    warnings.extend(signs(found));
    if recording.mass == 0.0 {
        warnings.push("no mass is stated: inertia is left out".to_owned());
    }
    warnings
}
