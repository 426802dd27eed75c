//! The motion of one model.

use web_time::Instant as Clock;

use super::problem::MovingPlate;
use crate::dynamics::frequency::principal;
use crate::dynamics::{History, TimeSettings, Viscosity, follow};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::problem::Model;
use crate::results::models::ModelStyle;

/// One model's motion.
pub struct ModelMotion {
    /// Its name.
    pub name: &'static str,
    /// Its name in names of files.
    pub file: &'static str,
    /// Its mesh.
    pub mesh: Mesh,
    /// Its instants.
    pub history: History,
    /// Why it ended before its time, where it did.
    pub end: Option<Error>,
    /// The first longitudinal vibration about the undeformed plate, with the right grip as at the end, in Hz; `None` where bending and
    /// other vibrations hide it.
    pub frequency: Option<f64>,
    /// Computing time in s.
    pub seconds: f64,
}

impl MovingPlate {
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
        let fault = |time: String, fault| Error::Solve {
            model: model.name.clone(),
            step: time,
            fault,
        };
        let held = motion.held(time.duration);
        let rest = vec![0.0; motion.mass.len()];
        let longitudinal = principal(&motion, &held, &rest, 0);
        let longitudinal = longitudinal.map_err(|found| fault("rest".into(), found))?;
        let (history, end) = match follow(&motion, time, progress) {
            Ok(history) => (history, None),
            Err(end) => {
                let error = fault(end.describe(), end.fault);
                // The start alone is no motion.
                if end.history.instants.len() < 2 {
                    return Err(error);
                }
                (end.history, Some(error))
            }
        };
        Ok(ModelMotion {
            name: style.name,
            file: style.key,
            mesh: model.mesh.clone(),
            history,
            end,
            frequency: longitudinal.map(|mode| mode.frequency),
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}
