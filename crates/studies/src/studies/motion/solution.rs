//! The motions of the models of a sheet.

use web_time::Instant as Clock;

use super::problem::MovingSheet;
use crate::dynamics::frequency::principal;
use crate::dynamics::{History, Instant, TimeSettings, Viscosity, follow};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::problem::{Model, mean_displacement};
use crate::results::models::ModelStyle;

/// One model's motion.
pub struct ModelMotion {
    /// Its name.
    pub style: ModelStyle,
    /// Its mesh.
    pub mesh: Mesh,
    /// Its instants; those of a corrected motion have no energies.
    pub history: History,
    /// Why it ended before its time, where it did.
    pub end: Option<Error>,
    /// The first longitudinal vibration about the undeformed sheet, with the supports as at the end, in Hz; `None` where bending and
    /// other vibrations hide it, or where the sheet can move freely.
    pub frequency: Option<f64>,
    /// Computing time in s.
    pub seconds: f64,
}

/// The correction of the springs' motion.
pub struct Correction {
    /// The corrected motion at the instants that are written; `None` where there is none.
    pub motion: Option<ModelMotion>,
    /// What was done, or why nothing was.
    pub note: String,
    /// Why it ended before the springs' motion did, where it did.
    pub end: Option<Error>,
}

/// The motions of all models.
pub struct Motions {
    /// Of the springs.
    pub springs: ModelMotion,
    /// Of the finite elements, with which the others are compared.
    pub elements: ModelMotion,
    /// Of the springs, corrected.
    pub correction: Correction,
}

impl Motions {
    /// Both models.
    pub fn models(&self) -> [&ModelMotion; 2] {
        [&self.springs, &self.elements]
    }

    /// All motions, the finite elements last.
    pub fn all(&self) -> Vec<&ModelMotion> {
        let corrected = self.correction.motion.as_ref();
        let springs = std::iter::once(&self.springs);
        springs.chain(corrected).chain([&self.elements]).collect()
    }

    /// The instants of the model that has more of them: all, unless both ended before.
    pub fn times(&self) -> Vec<f64> {
        let [springs, elements] = self.models().map(|model| model.history.times());
        if springs.len() < elements.len() {
            elements
        } else {
            springs
        }
    }
}

impl ModelMotion {
    /// Its instants.
    pub fn instants(&self) -> &[Instant] {
        &self.history.instants
    }

    /// The mean displacement of a group in mm.
    pub fn displacement_of(&self, group: &str, now: &Instant) -> [f64; 2] {
        mean_displacement(&self.mesh, group, &now.displacement)
    }
}

impl MovingSheet {
    /// Computes the motion of one model; `progress` is told the instants that are reached.
    pub fn moved(
        &self,
        style: ModelStyle,
        model: &Model,
        viscosity: Option<&dyn Viscosity>,
        time: TimeSettings,
        progress: &dyn Fn(f64),
    ) -> Result<ModelMotion, Error> {
        let start = Clock::now();
        let motion = self.motion(model, viscosity)?;
        let held = motion.held(time.duration);
        let rest = vec![0.0; motion.mass.len()];
        // A sheet that can move freely has no slowest vibration.
        let longitudinal = principal(&motion, &held, &rest, 0).ok().flatten();
        let (history, end) = match follow(&motion, time, progress) {
            Ok(history) => (history, None),
            Err(end) => {
                let error = Error::Solve {
                    model: model.name.clone(),
                    step: end.describe(),
                    fault: end.fault,
                };
                // The start alone is no motion.
                if end.history.instants.len() < 2 {
                    return Err(error);
                }
                (end.history, Some(error))
            }
        };
        Ok(ModelMotion {
            style,
            mesh: model.mesh.clone(),
            history,
            end,
            frequency: longitudinal.map(|mode| mode.frequency),
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// The force in N of the measured group at all instants; none where no support holds it.
    pub(super) fn measured_forces(&self, model: &ModelMotion) -> Vec<[f64; 2]> {
        let instants = model.instants().iter();
        instants
            .filter_map(|now| self.measured_force(&now.support_forces))
            .collect()
    }

    /// The axis along which the measured group has the larger force in a motion, x for a plate; `None` where no support holds it.
    pub(super) fn measured_axis(&self, model: &ModelMotion) -> Option<usize> {
        let forces = self.measured_forces(model);
        let is_across = self.specimen.grids().is_none() && larger_axis(&forces) == 1;
        (!forces.is_empty()).then_some(usize::from(is_across))
    }

    /// The axis along which the measured group moves more in a motion, x for a plate.
    pub(super) fn moved_axis(&self, model: &ModelMotion) -> usize {
        let group = &self.specimen.group;
        let instants = model.instants().iter();
        let moved: Vec<_> = instants
            .map(|now| model.displacement_of(group, now))
            .collect();
        usize::from(self.specimen.grids().is_none() && larger_axis(&moved) == 1)
    }
}

/// The axis along which some vectors have the largest component.
pub fn larger_axis(vectors: &[[f64; 2]]) -> usize {
    let largest = |axis: usize| {
        let sizes = vectors.iter().map(|vector| vector[axis].abs());
        sizes.fold(0.0, f64::max)
    };
    usize::from(largest(1) > largest(0))
}
