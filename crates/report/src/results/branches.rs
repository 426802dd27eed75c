//! States that may be one of several.

use crate::solve::State;

/// Whether a state was reached through tangents that are not positive definite, or by a snap to another branch.
pub fn is_one_of_several(state: &State) -> bool {
    state.convergence.shifted_steps + state.convergence.snaps > 0
}

/// The warning about such states, each with its model; `None` where there are none.
pub fn one_of_several(states: &[String]) -> Option<String> {
    (!states.is_empty()).then(|| {
        format!(
            "the tangent was not positive definite, or the body snapped through, on the way to {}: there are several equilibria, and which one is \
             found depends on mesh and load steps",
            states.join(", ")
        )
    })
}
