//! The motions of the models of a sheet.

use web_time::Instant as Clock;

use super::problem::MovingSheet;
use crate::dynamics::frequency::principal;
use crate::dynamics::{History, Instant, TimeSettings, Viscosity, follow};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::problem::{GroupState, Model, mean_displacement};
use crate::results::ViscousStress;
use crate::studies::ModelKind;
use crate::studies::series::{ModelSeries, ModelState, larger_axis};

/// One model's motion.
pub struct ModelMotion {
    pub kind: ModelKind,
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
    /// The states of the measured group at its instants; without a force where no support holds it.
    pub groups: Vec<GroupState>,
    /// The viscous stresses at its instants.
    pub viscous: Vec<ViscousStress>,
    /// The finite elements' displacements at its nodes; none of themselves.
    pub expected: Vec<Vec<f64>>,
}

/// The correction of the springs' motion.
#[derive(Default)]
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
    pub springs: ModelMotion,
    /// Of the finite elements, with which the others are compared.
    pub elements: ModelMotion,
    pub correction: Correction,
}

impl Motions {
    /// The motions of springs and finite elements, and the correction, with viscous stresses and the finite elements' displacements.
    pub fn new(
        sheet: &MovingSheet,
        mut springs: ModelMotion,
        mut elements: ModelMotion,
        mut correction: Correction,
    ) -> Self {
        let times = longer([&springs, &elements]).history.times();
        let (law, material) = (&*sheet.specimen.problem.law, &sheet.viscosity);
        let mut corrected = correction.motion.as_mut();
        for model in [Some(&mut springs), corrected.as_deref_mut()]
            .into_iter()
            .flatten()
        {
            model.expected = elements.displacements_on(&model.mesh);
        }
        let all = [Some(&mut springs), corrected, Some(&mut elements)];
        for model in all.into_iter().flatten() {
            let motion = model.history.instants.iter();
            let motion: Vec<[&[f64]; 2]> = motion
                .map(|now| [&now.displacement[..], &now.velocity])
                .collect();
            model.viscous = ViscousStress::over_time(law, material, &model.mesh, &times, &motion);
        }
        Self {
            springs,
            elements,
            correction,
        }
    }

    /// The states of all models at the instants, the finite elements last.
    pub fn series(&self) -> Vec<ModelSeries<'_>> {
        let times = self.times();
        let all = self.all().into_iter();
        all.map(|model| model.series(&times)).collect()
    }

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
        longer(self.models()).history.times()
    }
}

/// The model that has more instants.
fn longer([springs, elements]: [&ModelMotion; 2]) -> &ModelMotion {
    if springs.instants().len() < elements.instants().len() {
        elements
    } else {
        springs
    }
}

impl ModelMotion {
    /// Its instants.
    pub fn instants(&self) -> &[Instant] {
        &self.history.instants
    }

    /// Its displacements at the nodes of a mesh at all instants.
    pub fn displacements_on(&self, mesh: &Mesh) -> Vec<Vec<f64>> {
        let onto_mesh = self.mesh.interpolation_on(mesh);
        let instants = self.instants().iter();
        instants
            .map(|now| onto_mesh.apply(&now.displacement))
            .collect()
    }

    /// Its states at the times of the instants.
    fn series(&self, times: &[f64]) -> ModelSeries<'_> {
        let instants = self.instants().iter().enumerate();
        let states = instants.map(|(instant, now)| ModelState {
            at: times[instant],
            displacement: &now.displacement,
            velocity: Some(&now.velocity),
            viscous: self.viscous.get(instant),
            groups: std::slice::from_ref(&self.groups[instant]),
            expected: self.expected.get(instant).map(Vec::as_slice),
            ..ModelState::default()
        });
        ModelSeries {
            kind: self.kind,
            mesh: &self.mesh,
            states: states.collect(),
        }
    }
}

impl MovingSheet {
    /// Computes the motion of one model; the instants that are reached are reported to `progress`.
    pub fn moved(
        &self,
        kind: ModelKind,
        model: &Model,
        viscosity: Option<&dyn Viscosity>,
        time: TimeSettings,
        progress: &dyn Fn(f64),
    ) -> Result<ModelMotion, Error> {
        let start = Clock::now();
        let motion = self.motion(model, viscosity)?;
        let held = motion.held(time.duration);
        // A sheet that can move freely has no slowest vibration.
        let longitudinal = principal(&motion, &held).ok().flatten();
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
            kind,
            mesh: model.mesh.clone(),
            groups: self.measured_states(model.mesh, &history.instants),
            history,
            end,
            frequency: longitudinal.map(|mode| mode.frequency),
            seconds: start.elapsed().as_secs_f64(),
            viscous: Vec::new(),
            expected: Vec::new(),
        })
    }

    /// The states of the measured group at some instants of a model on a mesh; without a force where no support holds it.
    pub(super) fn measured_states(&self, mesh: &Mesh, instants: &[Instant]) -> Vec<GroupState> {
        let group = &self.specimen.group;
        let state = |now: &Instant| GroupState {
            force: self.measured_force(&now.support_forces).unwrap_or_default(),
            displacement: mean_displacement(mesh, group, &now.displacement),
            ..GroupState::default()
        };
        instants.iter().map(state).collect()
    }

    /// The force in N of the measured group at all instants; none where no support holds it.
    pub(super) fn measured_forces(&self, model: &ModelMotion) -> Vec<[f64; 2]> {
        let groups = model.groups.iter().filter(|_| self.is_measured_held());
        groups.map(|state| state.force).collect()
    }

    /// The axis along which the measured group has the larger force in a motion, x for a plate; `None` where no support holds it.
    pub(super) fn measured_axis(&self, model: &ModelMotion) -> Option<usize> {
        self.is_measured_held()
            .then(|| self.larger_axis(model, |state| state.force))
    }

    /// The axis along which a vector of the measured group is larger in a motion, x for a plate.
    pub(super) fn larger_axis(
        &self,
        model: &ModelMotion,
        of: fn(&GroupState) -> [f64; 2],
    ) -> usize {
        let is_along_y = larger_axis(model.groups.iter().map(of)) == 1;
        usize::from(self.specimen.grids().is_none() && is_along_y)
    }
}
