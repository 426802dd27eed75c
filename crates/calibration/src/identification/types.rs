//! The settings and the result of an identification.

use super::band::Function;
use super::basis::{Form, Shape};
use super::joint::{Argument, Joint, State};
use crate::estimation::Answer;

/// The settings of an identification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentificationSettings {
    /// The forms of K(·) and D(·).
    pub forms: [Form; 2],
    /// Prior knowledge of their shapes.
    pub shapes: [Shape; 2],
    /// The argument of D(·).
    pub argument: Argument,
}

/// The verdict on a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordingVerdict {
    /// The answer.
    pub answer: Answer,
    /// Why a spring and a dashpot do not explain the recording, the likeliest cause first; empty where they do.
    pub reasons: Vec<String>,
    /// What makes intervals and bands invalid although the recording is explained.
    pub doubts: Vec<String>,
}

impl RecordingVerdict {
    /// The answer as text.
    pub fn words(&self) -> String {
        self.answer
            .given("one spring with one dashpot of this mass and length")
    }

    /// Whether intervals and bands are valid.
    pub fn is_sound(&self) -> bool {
        self.answer != Answer::NotExplained && self.doubts.is_empty()
    }
}

impl Identification {
    /// The functions with their symbols and units.
    pub fn functions(&self) -> [(&'static str, &'static str, &Function); 2] {
        [
            ("K", "N/mm", &self.stiffness),
            ("D", "N·s/mm", &self.damping),
        ]
    }

    /// Whether a spring and a dashpot explain the recording.
    pub fn is_explained(&self) -> bool {
        self.verdict.answer != Answer::NotExplained
    }
}

impl Default for IdentificationSettings {
    /// Free splines of the extension.
    fn default() -> Self {
        Self {
            forms: [Form::SPLINE; 2],
            shapes: [Shape::Free; 2],
            argument: Argument::Extension,
        }
    }
}

/// The motion that was found, at the instants of the recording.
#[derive(Clone, Debug, Default)]
pub struct FittedMotion {
    /// x in mm.
    pub extension: Vec<f64>,
    /// ẋ in mm/s.
    pub rate: Vec<f64>,
    /// ẍ in mm/s².
    pub acceleration: Vec<f64>,
    /// m ẍ + D ẋ + K x in N.
    pub force: Vec<f64>,
}

impl FittedMotion {
    /// The motion of a state.
    pub(super) fn new(joint: &Joint, state: &State) -> Self {
        let mut motion = Self::default();
        for instant in 0..joint.recording.times.len() {
            let at = joint.instant(instant, state);
            motion.extension.push(at.extension);
            motion.rate.push(at.rate);
            motion.acceleration.push(at.acceleration);
            motion.force.push(at.force);
        }
        motion
    }
}

/// The result of an identification.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Identification {
    /// The settings.
    pub settings: IdentificationSettings,
    /// K(·) in N/mm.
    pub stiffness: Function,
    /// D(·) in N·s/mm.
    pub damping: Function,
    /// The motion.
    pub motion: FittedMotion,
    /// Standard deviations of extension in mm and force in N, from either signal alone.
    pub noise: [f64; 2],
    /// ‖r‖²/(N − p) relative to this noise: one where force, motion and forms are consistent.
    pub misfit: f64,
    /// N − p.
    pub freedom: f64,
    /// Whether a spring and a dashpot explain the recording; where they do not, standard errors, intervals and bands are NaN.
    pub verdict: RecordingVerdict,
    /// Notes on what the recording does not determine, which is no fault of it.
    pub warnings: Vec<String>,
}
