//! The boundary of a specimen as a chain of edges from corner to corner.

use std::collections::{BTreeMap, BTreeSet};

use super::knowledge::EdgeCondition;
use crate::error::Diagnostic;
use crate::mesh::geometry::distance;
use crate::mesh::{Mesh, corners};

/// A part of the boundary that has one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Its group, or its position.
    pub name: String,
    /// Number of its condition; `None` where no group names it.
    pub condition: Option<usize>,
    /// Whether it is a part of the outer boundary, rather than of a hole.
    pub outer: bool,
    /// Whether it is a pad on the sheet instead of a part of the boundary, with all of its nodes in any order.
    pub inside: bool,
    /// Its nodes in order, with the specimen to the left, including those in the middle of edges; in a closed one the
    /// first node is repeated as the last.
    pub nodes: Vec<usize>,
    /// Length along the boundary from the first node to each one in mm; zeros for a pad.
    pub positions: Vec<f64>,
}

impl Segment {
    /// Its length in mm.
    pub fn length(&self) -> f64 {
        self.positions[self.positions.len() - 1]
    }

    /// Both end nodes; they are the same for a closed one.
    pub fn ends(&self) -> [usize; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }
}

/// The boundary in segments, and the pads on the sheet: groups, or parts of them, that are not on the boundary and are held as one body.
///
/// # Errors
/// As [`segments`]; a [`Diagnostic`] when a group inside of the sheet is neither rigid nor of known displacement.
pub fn parts(mesh: &Mesh, edges: &[(String, EdgeCondition)]) -> Result<Vec<Segment>, Diagnostic> {
    let names: Vec<&str> = edges.iter().map(|(name, _)| name.as_str()).collect();
    let mut all = segments(mesh, &names)?;
    for (number, (name, condition)) in edges.iter().enumerate() {
        let on_edges: BTreeSet<usize> = all
            .iter()
            .filter(|part| part.condition == Some(number))
            .flat_map(|part| part.nodes.iter().copied())
            .collect();
        let nodes = mesh.groups()[name].nodes.iter();
        let inner: Vec<usize> = nodes
            .filter(|node| !on_edges.contains(node))
            .copied()
            .collect();
        let held = matches!(condition, EdgeCondition::Rigid | EdgeCondition::Known(_));
        if on_edges.is_empty() && !held {
            let fault = format!("the group `{name}` contains no edge of the boundary");
            let hint = "name boundary edges, or all their nodes; make a pad inside the sheet rigid or known";
            return Err(Diagnostic::error("", fault).hint(hint));
        }
        if held && !inner.is_empty() {
            all.push(Segment {
                name: name.clone(),
                condition: Some(number),
                outer: false,
                inside: true,
                positions: vec![0.0; inner.len()],
                nodes: inner,
            });
        }
    }
    Ok(all)
}

/// The boundary of `mesh` in segments: from corner to corner, and where another one of the `groups` begins.
///
/// # Errors
/// A [`Diagnostic`] when a group is missing or has no nodes, when the mesh has separate parts, or parts that
/// touch in one node.
pub fn segments(mesh: &Mesh, groups: &[&str]) -> Result<Vec<Segment>, Diagnostic> {
    let labels = labels(mesh, groups)?;
    let loops = loops(mesh)?;
    let parts = loops.iter().filter(|chain| is_outer(mesh, chain)).count();
    if parts != 1 {
        let fault = Diagnostic::error("", format!("the mesh has {parts} separate parts"));
        return Err(fault.hint("give each part as a mesh of its own"));
    }
    let mut all = Vec::new();
    for chain in &loops {
        divide(mesh, groups, chain, &labels, &mut all);
    }
    number_alike(&mut all);
    Ok(all)
}

/// The number of the group of every boundary edge that has one, by its first node.
fn labels(mesh: &Mesh, groups: &[&str]) -> Result<BTreeMap<usize, usize>, Diagnostic> {
    let mut labels = BTreeMap::new();
    for (number, name) in groups.iter().enumerate() {
        let Some(group) = mesh.groups().get(*name) else {
            let known: Vec<_> = mesh.groups().keys().map(String::as_str).collect();
            let fault = Diagnostic::error("", format!("the mesh has no group `{name}`"));
            return Err(fault.hint(if known.is_empty() {
                "the mesh has no groups at all".to_owned()
            } else {
                format!("its groups are {}", known.join(", "))
            }));
        };
        let within = |edge: &&Vec<usize>| {
            let has = |node: &usize| group.nodes.binary_search(node).is_ok();
            group.edges.contains(edge) || (group.edges.is_empty() && edge.iter().all(has))
        };
        let before = labels.len();
        for edge in mesh.boundary().iter().filter(within) {
            if let Some(other) = labels.insert(edge[0], number)
                && other != number
            {
                let shared = format!("the groups `{}` and `{name}` share edges", groups[other]);
                return Err(Diagnostic::error("", shared).hint(
                    "name each edge once: `boundary` is all of them, holes included, and left, right, bottom, top are the sides of the outer one",
                ));
            }
        }
        if labels.len() == before && group.nodes.is_empty() {
            let fault = format!("the group `{name}` contains no node");
            return Err(Diagnostic::error("", fault).hint("name nodes or boundary edges"));
        }
    }
    Ok(labels)
}

/// The closed chains of boundary edges.
fn loops(mesh: &Mesh) -> Result<Vec<Vec<&Vec<usize>>>, Diagnostic> {
    let mut from = BTreeMap::new();
    for edge in mesh.boundary() {
        if from.insert(edge[0], edge).is_some() {
            let [x, y] = mesh.nodes[edge[0]];
            let fault = format!("the boundary touches itself at ({x:.1}, {y:.1}) mm");
            return Err(Diagnostic::error("", fault).hint("repair the mesh there"));
        }
    }
    let mut loops = Vec::new();
    while let Some((_, first)) = from.pop_first() {
        let mut chain = vec![first];
        while let Some(next) = from.remove(&chain[chain.len() - 1][1]) {
            chain.push(next);
        }
        loops.push(chain);
    }
    Ok(loops)
}

/// Whether a loop runs counter-clockwise.
fn is_outer(mesh: &Mesh, chain: &[&Vec<usize>]) -> bool {
    let area = |edge: &&Vec<usize>| {
        let ([ax, ay], [bx, by]) = (mesh.nodes[edge[0]], mesh.nodes[edge[1]]);
        ax * by - bx * ay
    };
    chain.iter().map(area).sum::<f64>() > 0.0
}

/// Divides a loop and appends its segments.
fn divide(
    mesh: &Mesh,
    groups: &[&str],
    chain: &[&Vec<usize>],
    labels: &BTreeMap<usize, usize>,
    all: &mut Vec<Segment>,
) {
    let count = chain.len();
    let label = |edge: usize| labels.get(&chain[edge % count][0]).copied();
    let line: Vec<[f64; 2]> = chain.iter().map(|edge| mesh.nodes[edge[0]]).collect();
    let corner = corners(&line);
    let cuts: Vec<usize> = (0..count)
        .filter(|edge| corner[*edge] || label(*edge) != label(edge + count - 1))
        .collect();
    let outer = is_outer(mesh, chain);
    let starts = if cuts.is_empty() { vec![0] } else { cuts };
    for (index, start) in starts.iter().enumerate() {
        let end = match starts.get(index + 1) {
            Some(next) => *next,
            None => starts[0] + count,
        };
        let edges = (*start..end).map(|edge| chain[edge % count]);
        let (nodes, positions) = walk(mesh, edges);
        let condition = label(*start);
        let name = match condition {
            Some(number) => groups[number].to_owned(),
            None => group_of(mesh, &nodes).unwrap_or_else(|| describe(mesh, &nodes, outer)),
        };
        all.push(Segment {
            name,
            condition,
            outer,
            inside: false,
            nodes,
            positions,
        });
    }
}

/// Nodes along edges and their arc lengths in mm.
fn walk<'a>(mesh: &Mesh, edges: impl Iterator<Item = &'a Vec<usize>>) -> (Vec<usize>, Vec<f64>) {
    let (mut nodes, mut positions, mut length) = (Vec::new(), vec![0.0], 0.0);
    for edge in edges {
        if nodes.is_empty() {
            nodes.push(edge[0]);
        }
        for node in edge[2..].iter().chain([&edge[1]]) {
            length += distance(mesh.nodes[nodes[nodes.len() - 1]], mesh.nodes[*node]);
            nodes.push(*node);
            positions.push(length);
        }
    }
    (nodes, positions)
}

/// Numbers parts of the same name that no group names, in their order; numbers are left out if a named part would then have the same name.
fn number_alike(all: &mut [Segment]) {
    let named = all.iter().filter(|part| part.condition.is_some());
    let taken: BTreeSet<String> = named.map(|part| part.name.clone()).collect();
    let is_taken = |base: &str, number: usize| taken.contains(&format!("{base} {number}"));
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for part in all.iter().filter(|part| part.condition.is_none()) {
        *counts.entry(part.name.clone()).or_default() += 1;
    }
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for part in all.iter_mut().filter(|part| part.condition.is_none()) {
        let is_alone = counts[&part.name] == 1;
        if is_alone && !(1..=taken.len() + 1).any(|number| is_taken(&part.name, number)) {
            continue;
        }
        let number = numbers.entry(part.name.clone()).or_default();
        *number += 1;
        while is_taken(&part.name, *number) {
            *number += 1;
        }
        part.name = format!("{} {number}", part.name);
    }
}

/// Makes groups of the parts between corners whose names in results are given, such as `bottom 2` for a side of several parts; names of
/// groups and unknown names have no effect.
pub fn name_parts<'a>(mesh: &mut Mesh, names: impl Iterator<Item = &'a str>) {
    let wanted: Vec<&str> = names
        .filter(|name| !mesh.groups().contains_key(*name))
        .collect();
    // The user of the mesh reports that it cannot be divided.
    let Some(parts) = (!wanted.is_empty())
        .then(|| segments(mesh, &[]).ok())
        .flatten()
    else {
        return;
    };
    for part in parts.iter().filter(|part| wanted.contains(&&*part.name)) {
        let within = |edge: &&Vec<usize>| {
            let mut runs = part.nodes.windows(edge.len());
            runs.any(|run| run[0] == edge[0] && run[run.len() - 1] == edge[1])
        };
        let edges = mesh.boundary().iter().filter(within).cloned().collect();
        mesh.name_edges(&part.name, edges);
    }
}

/// The smallest group of the mesh that all of an edge belongs to.
fn group_of(mesh: &Mesh, nodes: &[usize]) -> Option<String> {
    let groups = mesh.groups().iter();
    let has = |node: &usize, members: &[usize]| members.binary_search(node).is_ok();
    let outlines = groups.filter(|(_, group)| {
        !group.edges.is_empty() && nodes.iter().all(|node| has(node, &group.nodes))
    });
    let smallest = outlines.min_by_key(|(_, group)| group.nodes.len());
    smallest.map(|(name, _)| name.clone())
}

/// A name that gives the position of a part.
fn describe(mesh: &Mesh, nodes: &[usize], outer: bool) -> String {
    let at = |node: usize| {
        let [x, y] = mesh.nodes[node];
        format!("({x:.1}, {y:.1})")
    };
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    match (outer, first == last) {
        (true, true) => "the outer edge".to_owned(),
        (false, true) => format!("the hole at {} mm", at(first)),
        _ => format!("edge {} to {} mm", at(first), at(last)),
    }
}

#[cfg(test)]
mod tests;
