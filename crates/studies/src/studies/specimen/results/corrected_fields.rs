//! The corrected fields of a path, and how each was reached.

use crate::corrector::Multipliers;
use crate::corrector::climb::Provenance;
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
    /// The same, where the springs have no field: ū is that equilibrium itself, which needs no correction.
    Alone,
}

/// How the corrected fields of a path were reached, at each load factor.
#[derive(Default)]
pub struct Correction {
    /// Where the corrector began.
    pub starts: Vec<Start>,
    /// The multipliers, condition after condition; none where they were not computed.
    pub multipliers: Vec<Vec<Multipliers>>,
    /// How a climb came to each field; empty where none climbed.
    pub climbs: Vec<Provenance>,
    /// The discretisation errors in mm of those that began at springs on a coarser mesh.
    pub discretisation_errors: Vec<f64>,
}

/// The corrected fields of a path, and how each was reached.
#[derive(Default)]
pub struct Fields {
    pub states: Vec<State>,
    pub correction: Correction,
}

impl Fields {
    /// Adds the field at the next load factor.
    pub fn push(&mut self, state: State, start: Start, multipliers: Vec<Multipliers>) {
        self.states.push(state);
        self.correction.starts.push(start);
        self.correction.multipliers.push(multipliers);
    }
}
