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

use std::collections::{BTreeMap, BTreeSet, HashSet};

use super::cells::Mesh;
use super::parts::Parts;
use crate::error::Diagnostic;

mod cells;
mod finding;
mod sides;
mod touching;

pub use finding::{Exemptions, UnknownName};
use finding::{Finding, at};
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
                hinges(&sides, allowed),
                touching::overlaps(self),
                cells::badly_shaped(self),
            ]
        } else {
            Vec::new()
        };
        diagnostics.extend(parts(&sides, allowed));
        diagnostics.extend(further.into_iter().flatten());
        diagnostics
    }
}

/// Parts that are not attached to each other.
fn parts(sides: &Sides, allowed: Exemptions) -> Option<Diagnostic> {
    if allowed.parts {
        return None;
    }
    let mesh = sides.mesh;
    let mut joined = Parts::new(mesh.nodes.len());
    for cell in sides.cells() {
        let nodes = mesh.cell(cell);
        nodes[1..]
            .iter()
            .for_each(|node| joined.join(nodes[0], *node));
    }
    // Cells of each part, and the centre of the first one.
    let mut parts: BTreeMap<usize, (usize, [f64; 2])> = BTreeMap::new();
    for cell in sides.cells() {
        let part = joined.first(mesh.cell(cell)[0]);
        parts.entry(part).or_insert((0, mesh.centre(cell))).0 += 1;
    }
    let mut parts: Vec<_> = parts.into_values().collect();
    if parts.len() < 2 {
        return None;
    }
    parts.sort_by_key(|(cells, _)| std::cmp::Reverse(*cells));
    let label =
        |(cells, position): &(usize, [f64; 2])| format!("{cells} cells near {} mm", at(*position));
    let shown: Vec<String> = parts.iter().take(Finding::SHOWN).map(label).collect();
    let more = match parts.len().saturating_sub(Finding::SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let message = format!(
        "{} parts are not attached to each other: {}{more}",
        parts.len(),
        shown.join(", ")
    );
    let remedy = "remove what does not belong to the specimen; where parts touch, merge their nodes (merge_nodes, --merge-nodes); if each has \
                  supports of its own, allow \"parts\"";
    Some(Diagnostic::error("", message).hint(remedy))
}

/// Nodes from which the boundary continues in two ways.
fn hinges(sides: &Sides, allowed: Exemptions) -> Option<Diagnostic> {
    if allowed.hinges {
        return None;
    }
    let mut once = BTreeSet::new();
    let begins = sides.boundary().into_iter().map(|side| side.ends[0]);
    let twice: BTreeSet<usize> = begins.filter(|node| !once.insert(*node)).collect();
    Finding::of(twice.into_iter().map(|node| sides.mesh.nodes[node])).error(
        [
            "node alone joins cells on both sides of it: a hinge",
            "nodes alone join cells on both sides of them: hinges",
        ],
        "join the cells along a side, or separate them; if the boundary is meant to touch itself in a node, allow \"hinges\"",
    )
}

#[cfg(test)]
mod tests;
