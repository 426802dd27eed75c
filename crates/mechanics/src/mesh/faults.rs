//! Faults of a mesh: degenerate cells, cells that overlap, and cells that touch without being joined.
//!
//! | fault | effect on the finite elements |
//! |---|---|
//! | cell without area, or turned inside out in part | no deformation gradient |
//! | cell given twice, cells that overlap | twice the stiffness there |
//! | seam: cells along the same line with nodes of their own | a slit that opens |
//! | hanging node: on a cell's side without being its node | a slit that opens between the side's ends |
//! | hinge: cells joined in a single node | a mechanism, or a stress without bound |
//! | parts that are not attached | each moves on its own |
//! | cell with very small or large angles (a warning) | large errors, bad condition |
//!
//! A side's node is at a position, or on a side, when it is nearer than a thousandth of the shortest edge there. The time
//! grows like n log n with the number of cells n.

use std::collections::HashSet;

use super::cells::Mesh;
use crate::error::Diagnostic;

mod cells;
mod finding;
mod parts;
mod sides;
mod touching;

pub use finding::{Exemptions, UnknownName};
use sides::Sides;

impl Mesh {
    /// Cells without area and cells that are turned inside out somewhere, as errors.
    pub fn cells_without_sense(&self) -> Vec<Diagnostic> {
        cells::without_sense(self)
    }

    /// All faults, each kind once with its number of positions and the first of them in mm: errors first, then warnings.
    pub fn faults(&self, allowed: Exemptions) -> Vec<Diagnostic> {
        let mut diagnostics = self.cells_without_sense();
        let twice = cells::given_twice(self);
        diagnostics.extend(cells::duplicate_cells(self, &twice));
        let again: HashSet<usize> = twice.iter().map(|[_, again]| *again).collect();
        let sides = Sides::new(self, &again);
        diagnostics.extend(sides.faults());
        diagnostics.extend(touching::faults(&sides, allowed));
        // These three checks may find the same fault from another side.
        let further = if diagnostics.is_empty() {
            vec![
                parts::hinges(&sides, allowed),
                touching::overlaps(self),
                cells::badly_shaped(self),
            ]
        } else {
            Vec::new()
        };
        diagnostics.extend(parts::parts(&sides, allowed));
        diagnostics.extend(further.into_iter().flatten());
        diagnostics
    }
}

#[cfg(test)]
mod tests;
