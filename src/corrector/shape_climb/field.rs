//! A field that has climbed, and the work for it.

use crate::solve::{Approach, Convergence, NewtonSettings, State};

/// Newton settings where multigrid does not converge.
pub const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// A field that has climbed.
#[derive(Clone, Debug)]
pub struct ShapeClimb {
    /// The state on the finest mesh. The potential of a state that was found near others is not evaluated: it is NaN.
    pub state: State,
    /// The estimated discretisation error of the field, root mean square over the nodes in mm; NaN where there is one mesh only.
    /// For a state between the first and the last of a path, or in the hand, it is in proportion to the field.
    pub discretisation_error: f64,
    /// The estimated error that the iteration left, root mean square over the nodes in mm.
    pub iteration_error: f64,
    /// The work on each mesh, coarse to fine; on the finest one alone where the state was found near others.
    pub work: Vec<ShapeWork>,
}

/// The state at a load factor that an approach reached, with its potential and residual.
pub fn approached(
    factor: f64,
    displacement: Vec<f64>,
    residual: Vec<f64>,
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

/// The work on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeWork {
    /// The number of its nodes.
    pub nodes: usize,
    /// The number of tangents.
    pub linearisations: usize,
    /// Iterations, each with one cycle of multigrid; zero where factors were used.
    pub iterations: usize,
}
