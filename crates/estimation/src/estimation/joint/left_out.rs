//! Frames with the law of the others.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::descent::{Course, Descent};
use super::found::{ForcePrediction, FrameOutcome, JointSettings, Told};
use super::frame::FrameInformation;
use crate::error::Error;
use crate::estimation::given::MeasuredForce;

/// The forces of a frame, and what is left of its markers in mm.
type CrossPrediction = (Vec<ForcePrediction>, f64);

/// What was found of every frame: its share, and its forces with the law of the other groups of frames. What no other
/// group can tell is left open.
///
/// # Errors
/// As the search.
pub fn outcomes(
    descent: &Descent,
    course: &Course,
    says: &[FrameInformation],
    inverse: &DMatrix<f64>,
    settings: &JointSettings,
    told: Told,
) -> Result<Vec<FrameOutcome>, Error> {
    let count = course.states.len();
    let groups = settings.groups.clamp(1, count);
    let mut foreign: Vec<CrossPrediction> = Vec::with_capacity(count);
    for group in 0..groups {
        let own = group * count / groups..(group + 1) * count / groups;
        told(&format!("frames left out, group {} of {groups}", group + 1));
        let others = match groups {
            1 => None,
            _ => descent.without(course, &own, told)?,
        };
        let values = others.as_ref().unwrap_or(&course.values);
        let found: Result<Vec<CrossPrediction>, Error> = own
            .into_par_iter()
            .map(|index| {
                let frame = descent.frames[index];
                let found = frame.foreign(&descent.law, values, Some(&course.states[index]))?;
                let forces = frame.measured().iter().zip(found.forces);
                let prediction = |(measured, there): (&MeasuredForce, f64)| ForcePrediction {
                    measured: measured.clone(),
                    predicted: others.is_some().then_some(there),
                };
                Ok((forces.map(prediction).collect(), found.left))
            })
            .collect();
        foreign.extend(found?);
    }
    let parameters = course.values.len() as f64;
    let outcome = |((forces, left), say): (CrossPrediction, &FrameInformation)| FrameOutcome {
        share: say.information.dot(inverse) / parameters,
        forces,
        left,
    };
    Ok(foreign.into_iter().zip(says).map(outcome).collect())
}
