//! The division of a reaction among the bodies that meet at a node; a body is a support, or whatever lies behind an edge.
//!
//! At a corner the reaction R of the node comes from both edges. The part q of an edge e follows from its tractions beside the corner:
//!
//! ```text
//! q = Rₘ ∫ₑ N ds / ∫ₑ Nₘ ds            N of the corner, m the next node of the edge            [N]
//! F = q + s (R − Σ q)                                                                       [N]
//! ```
//!
//! which is exact where the tractions are constant. The rest, as at singular corners, is divided in equal parts s
//! among the bodies of the lowest rank. All parts of a reaction add up to it, so that forces balance as reactions do.

use std::collections::{BTreeMap, BTreeSet};

use super::groups::edge_lengths;
use crate::mesh::Mesh;

/// The nodes and edges that a body holds.
pub struct Hold {
    /// Where bodies meet, those of the lowest rank get the rest.
    pub rank: usize,
    /// The nodes held along x and along y.
    pub nodes: [BTreeSet<usize>; 2],
    /// The edges of the boundary that it holds, by their nodes; empty for a pad on the sheet.
    pub sides: Vec<Vec<usize>>,
}

impl Hold {
    /// The edges of a mesh's boundary between some nodes.
    pub fn sides(mesh: &Mesh, nodes: &BTreeSet<usize>) -> Vec<Vec<usize>> {
        let sides = mesh.boundary().iter();
        let held = sides.filter(|side| side.iter().all(|node| nodes.contains(node)));
        held.cloned().collect()
    }

    /// The next node of the edges beside a node, and q over its reaction; `None` where there are no such edges, or one on both sides.
    fn adjacent(&self, mesh: &Mesh, corner: usize) -> Option<(usize, f64)> {
        let mut adjacent = self.sides.iter().filter(|side| side.contains(&corner));
        let (side, None) = (adjacent.next()?, adjacent.next()) else {
            return None;
        };
        // The two end nodes come first, then the middle one.
        let next = match side[..] {
            [_, _, middle] => middle,
            [from, to] if from == corner => to,
            _ => side[0],
        };
        let over = |node: usize| -> f64 {
            let lengths = self.sides.iter().flat_map(|side| edge_lengths(mesh, side));
            let at_node = lengths.filter(|(end, _)| *end == node);
            at_node.map(|(_, length)| length).sum()
        };
        Some((next, over(corner) / over(next)))
    }
}

/// A part of a body's force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The node at which it acts.
    pub at: usize,
    /// The node of whose reaction it is a multiple.
    pub of: usize,
    /// The multiple of the reaction.
    pub factor: f64,
}

/// A node and the factor of its reaction.
pub type Share = (usize, f64);

/// The factors of the reactions that make up the force of each body along each axis.
pub fn reaction_shares(mesh: &Mesh, holds: &[&Hold]) -> Vec<[Vec<Share>; 2]> {
    let along = |axis: usize| {
        let parts = reaction_parts(mesh, holds, axis).into_iter();
        parts.map(|parts| {
            let mut factors: BTreeMap<usize, f64> = BTreeMap::new();
            for part in parts {
                *factors.entry(part.of).or_insert(0.0) += part.factor;
            }
            factors.into_iter().collect()
        })
    };
    along(0).zip(along(1)).map(|(x, y)| [x, y]).collect()
}

/// The rest of the reaction at nodes where bodies of one rank meet: it is shared between them, though it may belong to any.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedRest {
    /// The bodies, by their numbers.
    pub bodies: Vec<usize>,
    /// R − Σ q, by reactions.
    pub factors: Vec<Share>,
}

/// The rests that bodies share along an axis.
pub fn shared_rests(mesh: &Mesh, holds: &[&Hold], axis: usize) -> Vec<SharedRest> {
    let mut rests = Vec::new();
    for (at, meeting) in meetings(mesh, holds, axis) {
        let shared = meeting
            .adjacent
            .iter()
            .map(|(_, next, factor)| (*next, -factor));
        if meeting.lowest.len() > 1 {
            rests.push(SharedRest {
                factors: [(at, 1.0)].into_iter().chain(shared).collect(),
                bodies: meeting.lowest,
            });
        }
    }
    rests
}

/// The parts of the force of each body along one axis.
pub fn reaction_parts(mesh: &Mesh, holds: &[&Hold], axis: usize) -> Vec<Vec<Part>> {
    let mut all: Vec<Vec<Part>> = vec![Vec::new(); holds.len()];
    for (at, Meeting { lowest, adjacent }) in meetings(mesh, holds, axis) {
        let share = 1.0 / lowest.len() as f64;
        let mut add = |body: usize, of: usize, factor: f64| all[body].push(Part { at, of, factor });
        lowest.iter().for_each(|body| add(*body, at, share));
        for (body, next, factor) in adjacent {
            add(body, next, factor);
            lowest
                .iter()
                .for_each(|other| add(*other, next, -share * factor));
        }
    }
    all
}

/// The bodies that hold a node.
struct Meeting {
    /// The bodies of the lowest rank, which get the rest.
    lowest: Vec<usize>,
    /// Where there are several: the bodies whose tractions beside the node are known, each with the next node and q over its reaction.
    adjacent: Vec<(usize, usize, f64)>,
}

/// Every node that is held along an axis, with the bodies that hold it.
fn meetings(mesh: &Mesh, holds: &[&Hold], axis: usize) -> BTreeMap<usize, Meeting> {
    let mut holders: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (body, hold) in holds.iter().enumerate() {
        for node in &hold.nodes[axis] {
            holders.entry(*node).or_default().push(body);
        }
    }
    let is_alone = |node: &usize| holders.get(node).is_some_and(|bodies| bodies.len() == 1);
    let meeting = |(at, bodies): (&usize, &Vec<usize>)| {
        let rank = bodies.iter().map(|body| holds[*body].rank).min();
        let lowest = bodies.iter().copied();
        let lowest = lowest.filter(|body| Some(holds[*body].rank) == rank);
        let several = bodies.iter().filter(|_| bodies.len() > 1);
        let adjacent = several.filter_map(|body| {
            let (next, factor) = holds[*body].adjacent(mesh, *at)?;
            is_alone(&next).then_some((*body, next, factor))
        });
        let meeting = Meeting {
            lowest: lowest.collect(),
            adjacent: adjacent.collect(),
        };
        (*at, meeting)
    };
    holders.iter().map(meeting).collect()
}
