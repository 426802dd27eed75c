//! Possible faults of a recording that hardly increase its misfit: each is one more parameter, tried in one linearised step.
//!
//! ```text
//! r = z τ + J δ + noise,   δ of variance P⁻¹           z the derivative of both signals by a suspect, J those by motion and functions, over the noise
//! I = zᵀz − zᵀJ (JᵀJ + P)⁻¹ Jᵀz,   τ = zᵀr / I,   t = τ √I
//! ```
//!
//! An error of the force's zero by a fiftieth of its range changes K(·) by far more than its interval and leaves a misfit of 1.05: the test
//! of one degree of freedom detects it. It also detects features that smooth functions miss: a step of K(·) at rest, and dry friction.

use nalgebra::DVector;

use super::basis::{Basis, Form};
use super::joint::{Column, Joint, State};
use super::penalty::PenalisedFit;
use super::smoothing::RESOLUTION;
use super::types::{FittedMotion, Identification};
use crate::solve::vector::largest;

/// t above which a suspect is reported: by chance in less than one recording of a thousand, with eight tried.
const LIMIT: f64 = 4.0;

/// The share of the residuals in excess of the noise that a suspect has to explain: where forms are wrong, or the noise is not white, any
/// suspect explains a little of it.
const TAKEN: f64 = 0.5;

/// The least share of zᵀz in I: a smaller one is part of K(·), D(·) or the motion.
const LEAST_SHARE: f64 = 1e-6;

/// A mass that is smaller by more than this share of itself is negative, beyond the error of one linearised step.
const TURNED: f64 = 1.5;

/// A possible fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Suspect {
    /// A constant on the force in N.
    ForceZero,
    /// A constant on the extension in mm.
    ExtensionZero,
    /// A force that drifts, in N over the recording.
    ForceDrift,
    /// An extension that drifts, in mm over the recording.
    ExtensionDrift,
    /// A force that is late, in s.
    Lag,
    /// A mass that is larger than stated, in tonne.
    Mass,
    /// A force that is counted in the direction opposite to the extension: a mass that is negative.
    SignOfForce,
    /// A K(·) that steps at rest, in N/mm.
    StepOfK,
    /// A force of constant size against the motion, in N.
    Friction,
}

impl Suspect {
    const ALL: [Self; 8] = [
        Self::ForceZero,
        Self::ExtensionZero,
        Self::ForceDrift,
        Self::ExtensionDrift,
        Self::Lag,
        Self::Mass,
        Self::StepOfK,
        Self::Friction,
    ];

    /// Whether it belongs to the body rather than to the recording.
    fn is_of_body(self) -> bool {
        matches!(self, Self::StepOfK | Self::Friction)
    }

    /// A description of the suspect with its amount.
    fn words(self, amount: f64, error: f64) -> String {
        let (what, factor, unit) = match self {
            Self::ForceZero => ("a zero error of the force of", 1.0, "N"),
            Self::ExtensionZero => ("a zero error of the extension of", 1.0, "mm"),
            Self::ForceDrift => ("a force that drifts by", 1.0, "N over the recording"),
            Self::ExtensionDrift => ("an extension that drifts by", 1.0, "mm over the recording"),
            Self::Lag => ("a force that is recorded", 1e3, "ms later than the motion"),
            Self::Mass if amount < 0.0 => ("a mass that is smaller by", -1e6, "g"),
            Self::Mass => ("a mass that is larger by", 1e6, "g"),
            Self::SignOfForce => return "a force of the wrong sign".to_owned(),
            Self::StepOfK => ("a step of K(·) at rest by", 1.0, "N/mm"),
            Self::Friction => ("a dry friction of", 1.0, "N"),
        };
        let error = f64::abs(factor) * error;
        format!("{what} {:.3} ± {error:.3} {unit}", factor * amount)
    }
}

/// The derivatives of both signals with respect to a suspect, over the noise.
fn column(joint: &Joint, motion: &FittedMotion, suspect: Suspect) -> Column {
    let recording = joint.recording;
    let times = &recording.times;
    let duration = times[times.len() - 1] - times[0];
    let force = &motion.force;
    let rate = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(times.len() - 1));
        (force[b] - force[a]) / (times[b] - times[a])
    };
    let of = |i: usize| {
        let (x, v) = (motion.extension[i], motion.rate[i]);
        match suspect {
            Suspect::ForceZero => [0.0, 1.0],
            Suspect::ExtensionZero => [1.0, 0.0],
            Suspect::ForceDrift => [0.0, (times[i] - times[0]) / duration - 0.5],
            Suspect::ExtensionDrift => [(times[i] - times[0]) / duration - 0.5, 0.0],
            Suspect::Lag => [0.0, -rate(i)],
            Suspect::Mass | Suspect::SignOfForce => [0.0, motion.acceleration[i]],
            Suspect::StepOfK => [0.0, 0.5 * x.abs()],
            Suspect::Friction => [0.0, v.signum()],
        }
    };
    let over = |[x, f]: [f64; 2]| [x / joint.noise[0], f / joint.noise[1]];
    (0..times.len()).map(|i| over(of(i))).collect()
}

/// A suspect in one linearised step from a fit.
#[derive(Clone, Copy, Debug)]
pub struct Suspected {
    suspect: Suspect,
    /// Its size.
    amount: f64,
    /// The standard error of the size; infinite where it is part of the functions or the motion.
    error: f64,
    /// The squares of the residuals that it explains.
    explained: f64,
    /// The largest change of a signal by it, over the largest value of that signal.
    effect: f64,
}

impl Suspected {
    /// The size in standard errors.
    fn size(&self) -> f64 {
        (self.amount / self.error).abs()
    }
}

/// Tries all suspects.
fn trials(
    joint: &Joint,
    state: &State,
    fit: &Identification,
    penalised: &PenalisedFit,
) -> Vec<Suspected> {
    // A form that is wrong looks like a body of another kind.
    let is_free = |function: &Basis| matches!(function.form, Form::Spline(_));
    let are_free = joint.functions.iter().all(is_free);
    let possible = Suspect::ALL.into_iter().filter(|suspect| match suspect {
        Suspect::Mass => joint.recording.mass > 0.0,
        other => are_free || !other.is_of_body(),
    });
    let tried: Vec<Suspect> = possible.collect();
    let columns: Vec<Column> = tried
        .iter()
        .map(|suspect| column(joint, &fit.motion, *suspect))
        .collect();
    let Ok(equations) = joint.linearise(state, &columns) else {
        return Vec::new();
    };
    let (reduced, count) = (&equations.reduced, state.functions.len());
    let gradient = reduced.gradient.rows(0, count) - &penalised.penalty * &state.functions;
    let trial = |(index, suspect): (usize, &Suspect)| {
        let position = count + index;
        let mixed: DVector<f64> = reduced
            .information
            .view((0, position), (count, 1))
            .column(0)
            .into();
        let follow = &penalised.inverse * &mixed;
        let information = reduced.information[(position, position)] - mixed.dot(&follow);
        let square: f64 = columns[index].iter().flatten().map(|z| z * z).sum();
        let score = reduced.gradient[position] - follow.dot(&gradient);
        let is_separate = information > LEAST_SHARE * square;
        let (amount, error) = if is_separate {
            let error = (fit.misfit.max(1.0) / information).sqrt();
            (score / information, error)
        } else {
            (0.0, f64::INFINITY)
        };
        Suspected {
            suspect: *suspect,
            amount,
            error,
            explained: score * score / information,
            effect: amount.abs() * relative_size(joint, &columns[index]),
        }
    };
    tried.iter().enumerate().map(trial).collect()
}

/// The largest change of a signal by one unit of a suspect, over the largest value of that signal.
fn relative_size(joint: &Joint, column: &Column) -> f64 {
    let signals = [&joint.recording.extension, &joint.recording.force];
    let of_signal = |index: usize| {
        let most = column.iter().map(|of| of[index].abs()).fold(0.0, f64::max);
        most * joint.noise[index] / largest(signals[index])
    };
    of_signal(0).max(of_signal(1))
}

/// The suspects that are surely present in the recording of a fit, the surest first.
pub fn examine(
    joint: &Joint,
    state: &State,
    fit: &Identification,
    penalised: &PenalisedFit,
) -> Vec<Suspected> {
    let excess = (fit.misfit - 1.0).max(0.0) * fit.freedom;
    let is_sure = |suspected: &Suspected| {
        // Friction never drives a motion.
        let is_possible = suspected.suspect != Suspect::Friction || suspected.amount > 0.0;
        let is_significant = suspected.size() > LIMIT;
        is_possible
            && is_significant
            && suspected.explained > TAKEN * excess
            && suspected.effect > RESOLUTION
    };
    let mut sure = trials(joint, state, fit, penalised);
    sure.retain(is_sure);
    // No mass is negative: one that seems to be is that of a force with the other sign.
    for suspected in &mut sure {
        if suspected.suspect == Suspect::Mass && suspected.amount < -TURNED * joint.recording.mass {
            suspected.suspect = Suspect::SignOfForce;
        }
    }
    sure.sort_by(|a, b| b.size().total_cmp(&a.size()));
    sure
}

/// The reason why suspects make a recording doubtful, with a remedy.
pub fn description(suspects: &[Suspected]) -> Option<String> {
    let descriptions = suspects
        .iter()
        .map(|suspected| suspected.suspect.words(suspected.amount, suspected.error));
    let words: Vec<String> = descriptions.collect();
    let remedy = if suspects.first()?.suspect.is_of_body() {
        "smooth functions cannot follow it, and no interval or band includes it"
    } else {
        "correct this in the data first, because no interval includes it"
    };
    Some(format!(
        "the recording indicates {}: {remedy}",
        words.join(", or alternatively ")
    ))
}
