//! Parts that are not attached, and parts that are joined in a single node.

use std::collections::{BTreeMap, BTreeSet};

use super::finding::{Exemptions, Finding, at};
use super::sides::Sides;
use crate::error::Diagnostic;
use crate::mesh::parts::Parts;

/// Parts that are not attached to each other.
pub fn parts(sides: &Sides, allowed: Exemptions) -> Option<Diagnostic> {
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
pub fn hinges(sides: &Sides, allowed: Exemptions) -> Option<Diagnostic> {
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
