//! One time step.

use super::motion::Motion;
use super::state::BodyState;
use crate::error::SolveFault;

/// A method to take a step.
pub(super) trait Stepper {
    /// Prepares for the supports that hold after a time.
    fn prepare(&mut self, motion: &Motion, held: &[bool]) -> Result<(), SolveFault>;

    /// The longest step in s that is safe at a state; `None` where any is.
    fn longest(&mut self, motion: &Motion, at: &BodyState) -> Result<Option<f64>, SolveFault>;

    /// The state a step later. `held` are the unknowns that supports hold in the step.
    fn step(
        &mut self,
        motion: &Motion,
        before: &BodyState,
        step: f64,
        held: &[bool],
    ) -> Result<BodyState, SolveFault>;

    /// Whether an exact step would conserve the sum of the energies; otherwise it may lose some.
    fn conserves(&self) -> bool;

    /// Factorisations so far.
    fn factorisations(&self) -> usize;
}
