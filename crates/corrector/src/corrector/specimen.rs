//! The corrector of a sheet of any shape: the field nearest to given data that is in equilibrium under the loads
//! and follows the supports.

use super::condition::{Condition, Equilibrium, Linear};
use super::{Correction, Corrector, CorrectorSettings, Describe};
use crate::error::SolveFault;
use crate::problem::Model;
use crate::solve::{
    Assembly, Convergence, Loading, Newton, NewtonSettings, Stage, State, equilibrium,
};

/// Name of the condition F.
pub const EQUILIBRIUM: &str = "equilibrium";
/// The name of the condition that the supports impose.
pub const SUPPORTS: &str = "supports";

/// Names of a mesh's cells and nodes by their positions.
impl Describe for Model<'_> {
    fn element(&self, element: usize) -> String {
        self.describe(element)
    }

    fn unknown(&self, unknown: usize) -> String {
        self.describe_unknown(unknown)
    }
}

/// A corrected field at one load factor.
#[derive(Debug)]
#[non_exhaustive]
pub struct CorrectedField {
    /// The field with the residual of the energy used in the correction.
    pub state: State,
    /// How it was reached, with the multipliers.
    pub correction: Correction,
}

/// Corrects a displacement field on the nodes of a model at a stage; the iteration begins at `start`.
///
/// # Errors
/// A [`SolveFault`] when no corrected field was found.
pub fn correct(
    model: &Model,
    data: &[f64],
    start: &[f64],
    stage: Stage<'_>,
    settings: CorrectorSettings,
) -> Result<CorrectedField, SolveFault> {
    let potential = model.potential(stage.factor, stage.history);
    let size = potential.unknowns();
    let assembly = Assembly::new(&*potential, &vec![false; size]);
    let held = model.held();
    let free: Vec<usize> = (0..size).filter(|unknown| !held[*unknown]).collect();
    let mut imposed = data.to_vec();
    model.impose(stage.factor, &mut imposed);
    let supports = (0..size)
        .filter(|unknown| held[*unknown])
        .map(|unknown| (unknown, imposed[unknown]));
    let conditions: Vec<Box<dyn Condition + '_>> = vec![
        Box::new(Equilibrium::new(EQUILIBRIUM, &*potential, &assembly, free)),
        Box::new(Linear::prescribed(SUPPORTS, size, supports)),
    ];
    let corrector = Corrector::new(conditions, vec![1.0; size], settings).named(model);
    correct_by(&corrector, model, data, start, stage, true)
}

/// The state of a model that is nearest to a displacement field under a corrector's conditions. Where these are all that is known of the
/// model, the state is stable.
pub(super) fn correct_by(
    corrector: &Corrector,
    model: &Model,
    data: &[f64],
    start: &[f64],
    stage: Stage<'_>,
    all_is_known: bool,
) -> Result<CorrectedField, SolveFault> {
    let correction = corrector.correct(data, start)?;
    let mut displacement = correction.field().to_vec();
    if all_is_known {
        // Tied unknowns, on which no condition depends, follow their masters.
        model.impose(stage.factor, &mut displacement);
        model.check_stability(stage, &displacement)?;
    }
    let convergence = correction.convergence(f64::NAN);
    Ok(CorrectedField {
        state: state_at(model, stage, displacement, convergence)?,
        correction,
    })
}

/// A displacement field as a state of a model, with its energy and residual.
pub(super) fn state_at(
    model: &Model,
    stage: Stage<'_>,
    displacement: Vec<f64>,
    mut convergence: Convergence,
) -> Result<State, SolveFault> {
    let potential = model.potential(stage.factor, stage.history);
    let mut residual = vec![0.0; displacement.len()];
    let energy = Assembly::residual(&*potential, &displacement, &mut residual);
    convergence.energy = energy.map_err(|fault| fault.named(|element| model.describe(element)))?;
    Ok(stage.reached(displacement, residual, convergence))
}

/// The corrected field without multipliers, by Newton's method from `start`. There are as many conditions as
/// unknowns, so that a step of the correction is a Newton step, whatever the data are: the field is that of
/// [`correct`], without a factor of twice the size; on large meshes without any factor.
///
/// # Errors
/// A [`SolveFault`] when no corrected field was found.
pub fn correct_without_multipliers(
    model: &Model,
    start: &[f64],
    stage: Stage<'_>,
    settings: NewtonSettings,
) -> Result<State, SolveFault> {
    let potential = model.potential(stage.factor, stage.history);
    let mut newton = Newton::with_solver(&*potential, &model.held(), model.linear_solver())?;
    let start = start.to_vec();
    equilibrium(model, &*potential, stage, &mut newton, start, settings)
}
