//! One equilibrium of a loaded body.

use super::convergence::NewtonSettings;
use super::loading::{Loading, Stage, State};
use super::newton::Newton;
use super::potential::Potential;
use crate::error::SolveFault;

/// The equilibrium at a stage with the potential there, from a guess on which held unknowns are imposed.
///
/// # Errors
/// As [`Newton::solve`].
pub fn equilibrium(
    loading: &dyn Loading,
    potential: &dyn Potential,
    stage: Stage<'_>,
    newton: &mut Newton,
    mut displacement: Vec<f64>,
    settings: NewtonSettings,
) -> Result<State, SolveFault> {
    loading.impose(stage.factor, &mut displacement);
    let mut residual = vec![0.0; displacement.len()];
    let convergence = newton.solve(
        potential,
        &mut displacement,
        &mut residual,
        settings,
        &|element| loading.describe(element),
    )?;
    loading.impose(stage.factor, &mut displacement);
    Ok(stage.reached(displacement, residual, convergence))
}
