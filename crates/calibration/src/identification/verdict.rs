//! Whether one spring with one dashpot explains a recording, and what else makes their functions doubtful.

use super::band::Function;
use super::basis::Form;
use super::recording::Recording;
use super::smoothing::{SignalSpline, exceeds_resolution};
use super::suspects::{Suspected, description};
use super::types::{FittedMotion, Identification, RecordingVerdict};
use crate::estimation::Answer;
use crate::units::number;

/// The number of arguments at which the sign of a function is examined.
const POSITIONS: usize = 41;

/// The doubt about a motion with `count` corners.
fn of_corners(count: usize) -> String {
    format!(
        "the motion has {count} corners, as where a machine reverses at a constant rate: the fitted smooth motion cannot follow them, so that \
         intervals and bands are not valid; use sinusoidal motion, or identify the parts between corners separately"
    )
}

/// The reason of values of a signal at some instants that are far from both neighbours, as a logger's wrong ones are.
fn of_spikes((signal, instants): (&str, &Vec<usize>), times: &[f64]) -> Option<String> {
    /// The rows that are named.
    const MOST: usize = 12;
    let named = instants.iter().take(MOST);
    let named = named.map(|i| format!("{} ({} s)", i + 1, number(times[*i])));
    let named = named.collect::<Vec<_>>().join(", ");
    let more = match instants.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!instants.is_empty()).then(|| {
        format!(
            "the {signal} lies far from its values before and after in the rows of numbers {named}{more}: remove these rows first, because they hide \
             other errors or look like them"
        )
    })
}

/// The doubt about a motion that is followed across gaps.
const BRIDGED: &str = "the recording has gaps with too few rows between them, across which one smooth motion is fitted, so that intervals and bands \
                       are not valid: remove the rows between neighbouring gaps, or record without gaps";

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
        let one_direction = pairs.filter(|(_, rate)| (**rate > 0.0) == forward);
        let mut one_direction: Vec<[f64; 2]> = one_direction.map(|(x, v)| [*x, *v]).collect();
        one_direction.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let groups = one_direction.chunks(one_direction.len().div_ceil(GROUPS).max(1));
        within += groups.map(scatter).sum::<f64>();
        all += scatter(&one_direction);
    }
    within < SHARE * all
}

/// At how many of its positions a function is significantly negative.
fn negative_positions(function: &Function) -> usize {
    let positions = function.positions(POSITIONS).into_iter();
    positions
        .filter(|x| function.at(*x).interval[1] < 0.0)
        .count()
}

/// What a function of this name that is significantly negative throughout says of the recording.
fn of_signs(name: &str) -> String {
    format!("{name}(·) is negative: reverse the sign of the force or of the extension")
}

/// The doubts about functions that are significantly negative somewhere, which is impossible for a passive body.
fn negative(result: &Identification) -> Vec<String> {
    let mut doubts = Vec::new();
    for (name, _, function) in result.functions() {
        let count = negative_positions(function);
        if count == POSITIONS {
            doubts.push(of_signs(name));
        } else if count > 0 {
            doubts.push(format!(
                "{name}(·) is negative somewhere: impossible for a passive spring or dashpot"
            ));
        }
    }
    doubts
}

/// Notes on what a recording does not determine, which is no fault of it.
pub fn notes(result: &Identification, recording: &Recording) -> Vec<String> {
    let is_undetermined = |function: &Function| {
        function
            .positions(POSITIONS)
            .into_iter()
            .all(|x| function.at(x).holds(0.0))
    };
    let functions = result.functions().into_iter();
    let unknown = functions.filter(|(_, _, function)| is_undetermined(function));
    let undetermined =
        unknown.map(|(name, ..)| format!("the recording does not distinguish {name}(·) from zero"));
    let mass = (recording.mass == 0.0).then(|| "no mass is stated: inertia is left out".to_owned());
    undetermined.chain(mass).collect()
}

/// The evidence for a verdict in addition to the identified functions.
pub struct Evidence<'a> {
    pub recording: &'a Recording,
    /// The splines of extension and force.
    pub signals: &'a (SignalSpline, SignalSpline),
    /// The instants of spikes of extension and force.
    pub spikes: [Vec<usize>; 2],
    /// Whether the motion is fitted across gaps.
    pub is_bridged: bool,
    /// The number of corners of the motion, where it has some.
    pub corners: Option<usize>,
    /// What the recording surely indicates, the surest first.
    pub suspects: &'a [Suspected],
}

impl Evidence<'_> {
    /// The verdict on the recording of some functions.
    pub fn verdict(&self, result: &Identification) -> RecordingVerdict {
        let spikes = ["extension", "force"].into_iter().zip(&self.spikes);
        let reasons: Vec<String> = spikes
            .filter_map(|spikes| of_spikes(spikes, &self.recording.times))
            .collect();
        if !reasons.is_empty() {
            return RecordingVerdict {
                answer: Answer::NotExplained,
                reasons,
                doubts: Vec::new(),
            };
        }
        let (reason, doubt) = match self.excess(result) {
            Some(excess) if result.misfit > MOST_MISFIT => (Some(excess), None),
            excess => (None, excess),
        };
        let suspected = description(self.suspects);
        // Where the force is counted with the wrong sign, inertia is too, and whatever changes it seems suspect.
        let is_reversed = negative_positions(&result.stiffness) == POSITIONS;
        let suspected = if is_reversed && (suspected.is_some() || reason.is_some()) {
            Some(of_signs("K"))
        } else {
            suspected
        };
        let reasons: Vec<String> = suspected.into_iter().chain(reason).collect();
        let doubts = if reasons.is_empty() {
            doubt.into_iter().chain(self.doubts(result)).collect()
        } else {
            self.shape_doubts()
        };
        RecordingVerdict {
            answer: if reasons.is_empty() {
                Answer::Explained
            } else {
                Answer::NotExplained
            },
            reasons,
            doubts,
        }
    }

    /// Residuals that are larger than the noise, and large enough to be measured.
    fn excess(&self, result: &Identification) -> Option<String> {
        let errors = (result.misfit - 1.0) / (2.0 / result.freedom).sqrt();
        let (measured, fitted) = (self.recording, &result.motion);
        let is_measurable = exceeds_resolution(&measured.extension, &fitted.extension)
            || exceeds_resolution(&measured.force, &fitted.force);
        (errors > 4.0 && is_measurable).then(|| {
            format!(
                "the residuals of force and motion are {:.2} times the noise: the mass, the length at rest or the forms are wrong, the noise is \
                 correlated, or there is more than one spring and one dashpot",
                result.misfit.sqrt()
            )
        })
    }

    /// The doubts about a motion that no smooth spline follows.
    fn shape_doubts(&self) -> Vec<String> {
        let corners = self.corners.map(of_corners);
        let bridged = self.is_bridged.then(|| BRIDGED.to_owned());
        corners.into_iter().chain(bridged).collect()
    }

    fn doubts(&self, result: &Identification) -> Vec<String> {
        let (extension, force) = self.signals;
        let mut doubts = self.shape_doubts();
        if extension.coarse || force.coarse {
            doubts.push(
                "the motion is sampled too coarsely to distinguish it from its noise".to_owned(),
            );
        }
        let by_splines = |form: &Form| matches!(form, Form::Spline(_));
        if result.settings.forms.iter().any(by_splines) && is_steady(&result.motion) {
            doubts.push(
                "the motion is a steady vibration, which passes every extension at one speed: it says little of D(·) between its ends, and with \
                 noise of 5 % bands include the true functions in about half of such recordings; drive the spring with several frequencies, or \
                 take constants or polynomials"
                    .to_owned(),
            );
        }
        doubts.extend(negative(result));
        doubts
    }
}

/// A misfit above this is more than noise: a spring and a dashpot do not explain the recording.
const MOST_MISFIT: f64 = 2.0;
