//! One equilibrium of a loaded body.

use super::loading::{Loading, State};
use super::newton::{Newton, NewtonSettings};
use super::potential::Potential;
use crate::error::SolveFault;

/// The equilibrium at a load factor, with its potential, which belongs to a history, from a guess: held unknowns are imposed on it.
///
/// # Errors
/// As [`Newton::solve`].
pub fn equilibrium(
    loading: &dyn Loading,
    (potential, factor, history): (&dyn Potential, f64, &[f64]),
    (newton, mut displacement): (&mut Newton, Vec<f64>),
    settings: NewtonSettings,
) -> Result<State, SolveFault> {
    loading.impose(factor, &mut displacement);
    let mut residual = vec![0.0; displacement.len()];
    let convergence = newton.solve(
        potential,
        &mut displacement,
        &mut residual,
        settings,
        &|element| loading.describe(element),
    )?;
    loading.impose(factor, &mut displacement);
    Ok(State {
        factor,
        displacement,
        residual,
        history: history.to_vec(),
        load_steps: 1,
        convergence,
    })
}
