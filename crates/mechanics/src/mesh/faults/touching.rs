//! Cells that touch or overlap without being joined: doubled nodes, hanging nodes, nodes inside of other cells.

use std::collections::{BTreeMap, BTreeSet};

use super::finding::{Exemptions, Finding};
use super::sides::{Side, Sides};
use crate::error::Diagnostic;
use crate::mesh::buckets::Buckets;
use crate::mesh::cells::Mesh;
use crate::mesh::geometry::{bounding_box, distance};
use crate::mesh::parts::Parts;

/// Positions nearer than this share of the shortest edge around are the same position.
const NEAR: f64 = 1e-3;
/// A node is inside of a cell when it lies this far from its sides, in natural coordinates.
const INSIDE: f64 = 1e-2;

/// Doubled and hanging nodes.
pub fn faults(sides: &Sides, allowed: Exemptions) -> Vec<Diagnostic> {
    let boundary = Boundary::new(sides);
    let (mut doubled, mut hanging) = (Vec::new(), boundary.both_corner_and_middle());
    for node in boundary.shortest.keys() {
        for (side, which) in boundary.touched(*node) {
            match which {
                Contact::Node(other) => doubled.push([*node, other]),
                Contact::Side => hanging.push((*node, side)),
            }
        }
    }
    if allowed.seams {
        // A node on the other side of a slit does not hang; a hanging node has a neighbour among the side's own nodes.
        hanging.retain(|(node, side)| boundary.is_neighbour(*node, *side));
    }
    let seam = boundary.seam(&doubled);
    // A node that hangs on both sides of a seam, or on a side whose own node is at its position, is doubled.
    let doubled: BTreeSet<usize> = doubled.into_iter().flatten().collect();
    let hanging: BTreeSet<usize> = hanging.into_iter().map(|(node, _)| node).collect();
    let mut diagnostics = Vec::new();
    if !allowed.seams {
        diagnostics.extend(seam.or_else(|| boundary.doubled_alone(&doubled)));
    }
    let positions = hanging.iter().map(|node| sides.mesh.nodes[*node]);
    diagnostics.extend(Finding::of(positions).error(
        [
            "node hangs on a cell's side without being its node",
            "nodes hang on a cell's side without being its nodes",
        ],
        "cells must meet side to side: divide the larger cell through the node, or join the parts before meshing \
         (BooleanFragments or Coherence in Gmsh)",
    ));
    diagnostics
}

/// The part of the boundary at a node.
enum Contact {
    Node(usize),
    Side,
}

/// The sides of the boundary, and the squares of a grid that their boxes touch.
struct Boundary<'a> {
    sides: &'a Sides<'a>,
    all: Vec<Side>,
    /// The length of the shortest side at each node of the boundary.
    shortest: BTreeMap<usize, f64>,
    buckets: Buckets,
}

impl<'a> Boundary<'a> {
    fn new(sides: &'a Sides) -> Self {
        let all = sides.boundary();
        let mut boundary = Self {
            sides,
            shortest: BTreeMap::new(),
            buckets: Buckets::default(),
            all,
        };
        for side in &boundary.all {
            let length = boundary.length(*side);
            for node in side.ends.into_iter().chain(side.middle) {
                let known = boundary.shortest.entry(node).or_insert(length);
                *known = known.min(length);
            }
        }
        let boxes = boundary.all.iter().map(|side| boundary.around(*side));
        let boxes: Vec<_> = boxes.collect();
        if !boxes.is_empty() {
            let extent = bounding_box(boxes.iter().flatten().copied());
            boundary.buckets = Buckets::new(extent, boxes);
        }
        boundary
    }

    fn node(&self, node: usize) -> [f64; 2] {
        self.sides.mesh.nodes[node]
    }

    fn length(&self, side: Side) -> f64 {
        let [a, b] = side.ends.map(|node| self.node(node));
        distance(a, b)
    }

    /// The box around a side, including a margin for nearby nodes.
    fn around(&self, side: Side) -> [[f64; 2]; 2] {
        let [a, b] = side.ends.map(|node| self.node(node));
        let bow = self.bow(side);
        let margin = NEAR * self.length(side) + bow[0].abs().max(bow[1].abs());
        [
            [0, 1].map(|axis| a[axis].min(b[axis]) - margin),
            [0, 1].map(|axis| a[axis].max(b[axis]) + margin),
        ]
    }

    /// The vector from the middle of a side's chord to its middle.
    fn bow(&self, side: Side) -> [f64; 2] {
        let [a, b] = side.ends.map(|node| self.node(node));
        side.middle.map_or([0.0; 2], |middle| {
            let m = self.node(middle);
            [0, 1].map(|axis| m[axis] - 0.5 * (a[axis] + b[axis]))
        })
    }

    /// The sides that a node lies on without being their node.
    fn touched(&self, node: usize) -> Vec<(Side, Contact)> {
        let position = self.node(node);
        let around = self
            .buckets
            .around(position)
            .iter()
            .map(|side| self.all[*side]);
        let touch = |side: Side| {
            let nodes: Vec<usize> = side.ends.into_iter().chain(side.middle).collect();
            if nodes.contains(&node) {
                return None;
            }
            let near = NEAR * self.length(side).min(self.shortest[&node]);
            let is_near = |other: [f64; 2]| distance(position, other) <= near;
            if let Some(other) = nodes.into_iter().find(|other| is_near(self.node(*other))) {
                return Some((side, Contact::Node(other)));
            }
            let foot = self.foot(side, position)?;
            is_near(foot).then_some((side, Contact::Side))
        };
        around.filter_map(touch).collect()
    }

    /// The point of a side that is nearest to a position beside it.
    fn foot(&self, side: Side, position: [f64; 2]) -> Option<[f64; 2]> {
        let [a, b] = side.ends.map(|node| self.node(node));
        let bow = self.bow(side);
        let chord = [b[0] - a[0], b[1] - a[1]];
        let square = chord[0].powi(2) + chord[1].powi(2);
        let at =
            |t: f64| [0, 1].map(|axis| a[axis] + t * chord[axis] + 4.0 * t * (1.0 - t) * bow[axis]);
        // The parameter along the chord; the side's own bow moves a point along it only where the middle node is off the middle.
        let mut t = 0.5;
        for _ in 0..20 {
            let here = at(t);
            let miss = (0..2).map(|axis| (position[axis] - here[axis]) * chord[axis]);
            t += miss.sum::<f64>() / square;
        }
        (0.0..=1.0).contains(&t).then(|| at(t))
    }

    /// Nodes that are a corner of one cell and in the middle of another one's side, with that side.
    fn both_corner_and_middle(&self) -> Vec<(usize, Side)> {
        let corners: BTreeSet<usize> = self.all.iter().flat_map(|side| side.ends).collect();
        let middles = self
            .all
            .iter()
            .filter_map(|side| Some((side.middle?, *side)));
        middles
            .filter(|(middle, _)| corners.contains(middle))
            .collect()
    }

    /// Whether a side of the boundary, or half of one, leads from a node to an end of a side, or is its own middle.
    fn is_neighbour(&self, node: usize, side: Side) -> bool {
        let ends = side.ends;
        let leads = |other: &Side| {
            let other_ends = other.ends;
            other_ends.contains(&node) && other_ends.iter().any(|end| ends.contains(end))
        };
        side.middle == Some(node) || self.all.iter().any(leads)
    }

    /// Sides of the boundary that lie on each other.
    fn seam(&self, doubled: &[[usize; 2]]) -> Option<Diagnostic> {
        let mut same = Parts::new(self.sides.mesh.nodes.len());
        doubled
            .iter()
            .for_each(|[one, other]| same.join(*one, *other));
        let mut known: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut twice = Vec::new();
        for side in &self.all {
            let [a, b] = side.ends.map(|node| same.first(node));
            let count = known.entry([a.min(b), a.max(b)]).or_insert(0);
            *count += 1;
            if *count == 2 {
                twice.push(self.sides.position(*side));
            }
        }
        Finding::of(twice).error(
            [
                "side lies on another cell's without sharing its nodes: a seam of doubled nodes",
                "sides lie on another cell's without sharing its nodes: a seam of doubled nodes",
            ],
            SEAM,
        )
    }

    fn doubled_alone(&self, doubled: &BTreeSet<usize>) -> Option<Diagnostic> {
        Finding::of(doubled.iter().map(|node| self.node(*node))).error(
            [
                "node lies where another one lies",
                "nodes lie where others lie",
            ],
            SEAM,
        )
    }
}

const SEAM: &str = "join them with merge_nodes = \"1e-6 mm\" in [specimen] (--merge-nodes for measured fields); if a slit is meant, allow \"seams\"";

/// Nodes and centres of cells inside of other cells.
pub fn overlaps(mesh: &Mesh) -> Option<Diagnostic> {
    let corners = (0..mesh.nodes.len()).map(|node| mesh.nodes[node]);
    let centres = (0..mesh.cell_count()).map(|cell| mesh.position(cell, mesh.shape(cell).centre()));
    let mut covered = Finding::default();
    for (index, position) in corners.chain(centres).enumerate() {
        let centre_cell = index.checked_sub(mesh.nodes.len());
        if mesh.holds_inside(position, INSIDE, |cell| {
            centre_cell == Some(cell) || (centre_cell.is_none() && mesh.cell(cell).contains(&index))
        }) {
            covered.add(position);
        }
    }
    covered.error(
        [
            "place is covered by two cells, which overlap",
            "places are covered by two cells, which overlap",
        ],
        "remove cells that lie on other cells, or join the parts before meshing (BooleanFragments or Coherence in Gmsh)",
    )
}
