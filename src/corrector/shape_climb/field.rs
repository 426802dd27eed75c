//! A field that has climbed, and what was done for it.

use crate::solve::{Approach, Convergence, NewtonSettings, State};

/// Where multigrid does not lead to the end.
pub const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// A field that has climbed.
#[derive(Clone, Debug)]
pub struct ShapeClimb {
    /// On the finest mesh. The potential of a state that was found near others is not evaluated: it is not a number.
    pub state: State,
    /// The estimated discretisation error of the field, root mean square over the nodes in mm; not a number where there is one
    /// mesh alone. That of a state between the first and the last of a path, or in the hand, is in proportion to the field.
    pub discretisation_error: f64,
    /// What the iteration left, estimated, root mean square over the nodes in mm.
    pub iteration_error: f64,
    /// What was done on each mesh, coarse to fine; on the finest one alone where the state was found near others.
    pub work: Vec<ShapeWork>,
}

/// The state at a load factor that an approach came to, with its potential and residual.
pub fn approached(
    factor: f64,
    (displacement, residual): (Vec<f64>, Vec<f64>),
    energy: f64,
    own: &Approach,
) -> State {
    State {
        factor,
        displacement,
        residual,
        history: Vec::new(),
        load_steps: 1,
        convergence: Convergence {
            residuals: vec![1.0, own.left()],
            energy,
            ..Convergence::default()
        },
    }
}

/// What was done on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeWork {
    /// Its nodes.
    pub nodes: usize,
    /// Tangents.
    pub linearisations: usize,
    /// Iterations, each with one cycle of multigrid; none where factors were taken.
    pub iterations: usize,
}
