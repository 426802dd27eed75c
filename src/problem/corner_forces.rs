//! Which part of a reaction belongs to which body, a support or what stands behind an edge, where bodies meet.
//!
//! At a corner the reaction R of the node comes from both edges. What an edge e gives, q, is told by its tractions beside the corner:
//!
//! ```text
//! q = Rₘ ∫ₑ N ds / ∫ₑ Nₘ ds            N of the corner, m the next node of the edge            [N]
//! F = q + s (R − Σ q)                                                                       [N]
//! ```
//!
//! which is exact where the tractions are constant. The rest, as at singular corners, belongs in equal parts s to the bodies of the
//! lowest rank. All parts of one reaction add up to it, so that forces balance as reactions do.

use std::collections::{BTreeMap, BTreeSet};

use super::groups::edge_lengths;
use crate::mesh::Mesh;

/// What a body holds.
pub struct Hold {
    /// Which bodies have the rest where they meet: the lowest.
    pub rank: usize,
    /// The nodes held along x and along y.
    pub nodes: [BTreeSet<usize>; 2],
    /// The edges of the boundary that it holds, by their nodes; none of a pad on the sheet.
    pub sides: Vec<Vec<usize>>,
}

impl Hold {
    /// The edges of a mesh's boundary between some nodes.
    pub fn sides(mesh: &Mesh, nodes: &BTreeSet<usize>) -> Vec<Vec<usize>> {
        let sides = mesh.boundary().iter();
        let own = sides.filter(|side| side.iter().all(|node| nodes.contains(node)));
        own.cloned().collect()
    }

    /// The next node of the edges beside one, and q over its reaction; `None` where there are no such edges, or one on both sides.
    fn beside(&self, mesh: &Mesh, corner: usize) -> Option<(usize, f64)> {
        let mut beside = self.sides.iter().filter(|side| side.contains(&corner));
        let (side, None) = (beside.next()?, beside.next()) else {
            return None;
        };
        // The ends stand first, then the middle.
        let next = match side[..] {
            [_, _, middle] => middle,
            [from, to] if from == corner => to,
            _ => side[0],
        };
        let over = |node: usize| -> f64 {
            let lengths = self.sides.iter().flat_map(|side| edge_lengths(mesh, side));
            let own = lengths.filter(|(own, _)| *own == node);
            own.map(|(_, length)| length).sum()
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
    /// That multiple.
    pub factor: f64,
}

/// A node and the factor of its reaction.
pub type Share = (usize, f64);

/// The factors of the reactions that make up the force of each body along each axis.
pub fn reaction_shares(mesh: &Mesh, holds: &[Hold]) -> Vec<[Vec<Share>; 2]> {
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

/// The parts of the force of each body along one axis.
pub fn reaction_parts(mesh: &Mesh, holds: &[Hold], axis: usize) -> Vec<Vec<Part>> {
    let mut holders: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (body, hold) in holds.iter().enumerate() {
        for node in &hold.nodes[axis] {
            holders.entry(*node).or_default().push(body);
        }
    }
    let is_alone = |node: &usize| holders.get(node).is_some_and(|bodies| bodies.len() == 1);
    let mut all: Vec<Vec<Part>> = vec![Vec::new(); holds.len()];
    for (&at, bodies) in &holders {
        let lowest = bodies.iter().map(|body| holds[*body].rank).min();
        let rest = bodies.iter().copied();
        let rest: Vec<usize> = rest
            .filter(|body| Some(holds[*body].rank) == lowest)
            .collect();
        let share = 1.0 / rest.len() as f64;
        let mut add = |body: usize, of: usize, factor: f64| all[body].push(Part { at, of, factor });
        rest.iter().for_each(|body| add(*body, at, share));
        for body in bodies.iter().filter(|_| bodies.len() > 1) {
            let beside = holds[*body].beside(mesh, at);
            let Some((next, factor)) = beside.filter(|(next, _)| is_alone(next)) else {
                continue;
            };
            add(*body, next, factor);
            rest.iter()
                .for_each(|other| add(*other, next, -share * factor));
        }
    }
    all
}
