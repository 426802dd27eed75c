//! The corrected fields of a path, and how each was reached.

use crate::corrector::Multipliers;
use crate::corrector::climb::Way;
use crate::solve::State;

/// Where the corrector began at a load factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// At springs on a coarser mesh.
    Nested,
    /// On grids of a plate, as its study says.
    Grids,
    /// The same where the springs have no field: ū is the affine stretch.
    GridsAlone,
    /// At the springs' field, with what the correction had changed at the load factor before.
    Springs,
    /// At the equilibrium of the elements, which Newton's method reached from rest in load steps; ū is the
    /// springs' field.
    LoadSteps,
    /// The same, where the springs have no field: ū is that equilibrium itself, and nothing is left to correct.
    Alone,
}

/// The corrected fields of a path, and how each was reached.
pub struct Fields {
    /// The states.
    pub states: Vec<State>,
    /// Where the corrector began.
    pub starts: Vec<Start>,
    /// The multipliers, condition after condition.
    pub multipliers: Vec<Vec<Multipliers>>,
    /// How a climb came to them.
    pub climbs: Vec<Way>,
}
