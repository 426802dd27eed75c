//! The boundary of a specimen as a chain of edges from corner to corner.

use std::collections::{BTreeMap, BTreeSet};

use super::knowledge::EdgeCondition;
use crate::error::Diagnostic;
use crate::mesh::Mesh;
pub use names::name_parts;
use names::{describe, group_of, number_alike};

mod names;

/// Turn of the boundary, in rad, from which on a node is a corner.
const CORNER: f64 = 0.7;

/// Share of a loop's length before and behind a node over which its turn is measured, so that steps of one cell are not corners.
const REACH: f64 = 0.02;

/// A part of the boundary that has one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Its group, or where it lies.
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
    pub places: Vec<f64>,
}

impl Segment {
    /// Its length in mm.
    pub fn length(&self) -> f64 {
        self.places[self.places.len() - 1]
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
                places: vec![0.0; inner.len()],
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
            return Err(fault.hint(match known.is_empty() {
                true => "the mesh has no groups at all".to_owned(),
                false => format!("its groups are {}", known.join(", ")),
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
                return Err(Diagnostic::error("", shared).hint("name each edge once"));
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
    let corner = corners(mesh, chain);
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
        let (nodes, places) = walk(mesh, edges);
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
            places,
        });
    }
}

/// Nodes along edges and their places in mm.
fn walk<'a>(mesh: &Mesh, edges: impl Iterator<Item = &'a Vec<usize>>) -> (Vec<usize>, Vec<f64>) {
    let (mut nodes, mut places, mut length) = (Vec::new(), vec![0.0], 0.0);
    for edge in edges {
        if nodes.is_empty() {
            nodes.push(edge[0]);
        }
        for node in edge[2..].iter().chain([&edge[1]]) {
            length += distance(mesh.nodes[nodes[nodes.len() - 1]], mesh.nodes[*node]);
            nodes.push(*node);
            places.push(length);
        }
    }
    (nodes, places)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Whether the boundary turns at the first node of each edge of a loop.
fn corners(mesh: &Mesh, chain: &[&Vec<usize>]) -> Vec<bool> {
    let count = chain.len();
    let node = |edge: usize| mesh.nodes[chain[edge % count][0]];
    let length: f64 = (0..count)
        .map(|edge| distance(node(edge), node(edge + 1)))
        .sum();
    // The first node at the reach or beyond, on both sides.
    let away = |edge: usize, step: usize| {
        let far = (1..count).map(|steps| node(edge + steps * step));
        let mut far = far.skip_while(|place| distance(*place, node(edge)) < REACH * length);
        far.next().unwrap_or(node(edge + step))
    };
    let turn = |edge: usize| {
        let (from, at, to) = (away(edge, count - 1), node(edge), away(edge, 1));
        let (a, b) = (
            [at[0] - from[0], at[1] - from[1]],
            [to[0] - at[0], to[1] - at[1]],
        );
        (a[0] * b[1] - a[1] * b[0])
            .atan2(a[0] * b[0] + a[1] * b[1])
            .abs()
    };
    let turns: Vec<f64> = (0..count).map(turn).collect();
    let sharpest = |edge: usize| {
        let near =
            |other: &usize| *other != edge && distance(node(*other), node(edge)) < REACH * length;
        let mut others = (0..count).filter(near);
        // The first of several equal ones.
        others.all(|other| (turns[other], edge) < (turns[edge], other))
    };
    (0..count)
        .map(|edge| turns[edge] > CORNER && sharpest(edge))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellShape, Shape};

    #[test]
    fn a_plate_has_four_edges_from_corner_to_corner() {
        for (cells, shape) in [([60, 20], CellShape::Quad4), ([7, 3], CellShape::Quad9)] {
            let mesh = Mesh::plate([150.0, 50.0], cells, shape);
            let all = segments(&mesh, &["left"]).unwrap();
            let mut lengths: Vec<f64> = all.iter().map(Segment::length).collect();
            lengths.sort_by(f64::total_cmp);
            let expected = [50.0, 50.0, 150.0, 150.0];
            assert!(
                lengths
                    .iter()
                    .zip(expected)
                    .all(|(l, e)| (l - e).abs() < 1e-9)
            );
            let named: Vec<_> = all.iter().filter(|part| part.condition.is_some()).collect();
            assert_eq!((named.len(), named[0].name.as_str()), (1, "left"));
            let degree = mesh.shape(0).degree();
            assert_eq!(named[0].nodes.len(), degree * cells[1] + 1);
            assert!(all.iter().any(|part| part.name == "bottom"));
        }
    }

    #[test]
    fn sides_without_a_group_have_names_of_their_own() {
        let shape = Shape::NotchedStrip {
            size: [100.0, 40.0],
            depth: 12.0,
            half_length: 12.0,
        };
        let all = segments(&shape.mesh(12, CellShape::Quad4), &[]).unwrap();
        let names: BTreeSet<&str> = all.iter().map(|part| part.name.as_str()).collect();
        assert!(all.len() > 4 && names.len() == all.len(), "{names:?}");
    }

    #[test]
    fn a_hole_is_one_closed_segment_without_corners() {
        let shape = Shape::StripWithHole {
            size: [100.0, 40.0],
            radius: 8.0,
        };
        let mesh = shape.mesh(8, CellShape::Quad4);
        let all = segments(&mesh, &[]).unwrap();
        assert_eq!(all.iter().filter(|part| part.outer).count(), 4);
        let hole: Vec<_> = all.iter().filter(|part| !part.outer).collect();
        assert_eq!(hole.len(), 1, "{hole:?}");
        assert_eq!(hole[0].ends()[0], hole[0].ends()[1]);
        assert_eq!(hole[0].name, "hole");
    }

    #[test]
    fn groups_that_cannot_be_edges_are_refused() {
        let mut mesh = Mesh::plate([3.0, 2.0], [3, 2], CellShape::Quad4);
        mesh.name_nodes("inner", &[4, 5].into());
        let told = |groups: &[&str]| segments(&mesh, groups).unwrap_err().to_string();
        assert!(told(&["lef"]).contains("no group `lef`"));
        for condition in [EdgeCondition::Free, EdgeCondition::Unknown] {
            let told = parts(&mesh, &[("inner".into(), condition)]).unwrap_err();
            assert!(told.to_string().contains("contains no edge"));
        }
    }

    #[test]
    fn nodes_of_a_held_group_that_are_no_edge_are_a_pad() {
        let mut mesh = Mesh::plate([3.0, 2.0], [3, 2], CellShape::Quad4);
        let names = |mesh: &Mesh| -> Vec<(String, bool, usize)> {
            let found = parts(mesh, &[("pad".into(), EdgeCondition::Rigid)]).unwrap();
            let own = found.into_iter().filter(|part| part.condition.is_some());
            own.map(|part| (part.name, part.inside, part.nodes.len()))
                .collect()
        };
        let inner: BTreeSet<usize> = (0..mesh.nodes.len())
            .filter(|node| {
                mesh.nodes[*node][1] == 1.0 && (0.5..2.5).contains(&mesh.nodes[*node][0])
            })
            .collect();
        mesh.name_nodes("pad", &inner);
        assert_eq!(names(&mesh), [("pad".to_owned(), true, 2)]);
        let edge: BTreeSet<usize> = (0..mesh.nodes.len())
            .filter(|node| mesh.nodes[*node][0] < 1.5)
            .collect();
        mesh.name_nodes("pad", &edge);
        let found = names(&mesh);
        assert!(found.contains(&("pad".to_owned(), true, 1)), "{found:?}");
        assert_eq!(found.len(), 4);
    }
}
