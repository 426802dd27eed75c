//! Effects of supports on the unknowns: the motions of held ones, ties, and the forces on rigid grips.

use std::collections::{BTreeMap, BTreeSet};

use super::boundary_conditions::{Drive, Support};
use super::corner_forces::{Hold, Part, reaction_parts};
use super::groups::{named, refused};
use super::rigid_motion::RigidMotion;
use crate::error::Diagnostic;
use crate::mesh::{Group, Mesh};
use crate::statistics::extremes;

/// How a held unknown moves.
#[derive(Clone, Copy)]
pub enum Motion {
    /// In proportion to the load factor, in mm at 1.
    Straight(f64),
    /// Like a coordinate of a point, at a place in mm relative to the centre, that is turned by an angle at 1.
    Turn {
        place: [f64; 2],
        axis: usize,
        angle: f64,
    },
}

impl Motion {
    /// The angle of the turn at load factor 1, in rad.
    pub fn angle(self) -> f64 {
        match self {
            Self::Straight(_) => 0.0,
            Self::Turn { angle, .. } => angle,
        }
    }

    pub fn at(self, factor: f64) -> f64 {
        match self {
            Self::Straight(displacement) => factor * displacement,
            Self::Turn { place, axis, angle } => {
                let turn = RigidMotion {
                    displacement: [0.0; 2],
                    angle: factor * angle,
                };
                turn.at(place)[axis]
            }
        }
    }
}

impl Support {
    /// The displacement in mm of a node at a place in mm, at a load factor, along an axis that the support holds.
    pub fn displacement(&self, place: [f64; 2], axis: usize, factor: f64) -> Option<f64> {
        motion(self, place, axis).map(|motion| motion.at(factor))
    }
}

/// Why a group does not suit its support, in words that follow the group's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
enum SupportMisfit {
    #[error(
        "has a node at the centre of its radial displacement, where the radial direction is not defined"
    )]
    NodeAtCentre,
    #[error("has no nodes")]
    NoNodes,
    #[error(
        "is not a straight line parallel to an axis, which a roller or an axis of symmetry needs"
    )]
    NotAlongAxis,
    #[error("is a single point, which defines no line to slide along")]
    NoLine,
}

impl SupportMisfit {
    fn remedy(self) -> &'static str {
        match self {
            Self::NodeAtCentre => "move the centre, or leave the node out",
            Self::NoNodes => "take a group with nodes",
            Self::NotAlongAxis => {
                "rotate the mesh, or hold the group with the kind \"displacement\""
            }
            Self::NoLine => "hold it with the kind \"displacement\" and x or y",
        }
    }
}

/// All supports of a problem on the unknowns of a mesh.
#[derive(Default)]
pub struct Constraints {
    /// Motion of each unknown that is held.
    pub held: BTreeMap<usize, Motion>,
    /// The unknown that each tied one follows.
    pub ties: BTreeMap<usize, usize>,
    /// Forces in N on the unknowns that others follow.
    pub forces: Vec<(usize, f64)>,
    /// The nodes that each support holds.
    holders: Vec<Holder>,
}

/// The nodes that a support holds.
struct Holder {
    hold: Hold,
    /// All nodes of its group.
    nodes: BTreeSet<usize>,
    /// Whether it holds edges, lines or cells, rather than nodes alone.
    has_parts: bool,
}

impl Holder {
    /// The nodes of a group at which the support holds the group itself along an axis, rather than another part that
    /// ends there; `is_supported` states whether the group has a support of its own.
    fn on(&self, mesh: &Mesh, group: &Group, is_supported: bool, axis: usize) -> BTreeSet<usize> {
        let own = &self.hold.nodes[axis];
        if is_supported && self.has_parts != group.has_parts() {
            // A point with a support of its own is not part of the edge around it.
            return BTreeSet::new();
        }
        if !self.has_parts || !group.has_parts() {
            let nodes = group.nodes.iter().copied();
            return nodes.filter(|node| own.contains(node)).collect();
        }
        let sides = group.edges.iter().chain(&group.lines).map(Vec::as_slice);
        let parts = sides.chain(group.cells.iter().map(|cell| mesh.cell(*cell)));
        let held = parts.filter(|part| part.iter().all(|node| own.contains(node)));
        held.flatten().copied().collect()
    }
}

impl Constraints {
    /// The effects of supports, by group, on the unknowns of a mesh; supports must agree on nodes that they share.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, or when a group does not suit its support.
    pub fn of(mesh: &Mesh, supports: &[(String, Support)]) -> Result<Self, Diagnostic> {
        let mut all = Self::default();
        for (name, support) in supports {
            let added = all.add(mesh, named("support", mesh, name)?, support);
            added.map_err(|misfit| {
                refused("support", name, &misfit.to_string()).hint(misfit.remedy())
            })?;
        }
        Ok(all)
    }

    /// Adds a support of a group, or returns why the group does not suit it.
    fn add(&mut self, mesh: &Mesh, group: &Group, support: &Support) -> Result<(), SupportMisfit> {
        if let Support::Radial { centre, .. } = support
            && group.nodes.iter().any(|node| mesh.nodes[*node] == *centre)
        {
            return Err(SupportMisfit::NodeAtCentre);
        }
        let mut axes = [false; 2];
        for axis in [0, 1] {
            if let Support::Grip(drives) = support
                && let Drive::Force(force) = drives[axis]
            {
                self.tie(group, axis, force)?;
                axes[axis] = true;
                continue;
            }
            let slides = *support == Support::Roller && normal(mesh, group)? != axis;
            for node in group.nodes.iter().filter(|_| !slides) {
                if let Some(motion) = motion(support, mesh.nodes[*node], axis) {
                    self.held.insert(2 * node + axis, motion);
                    axes[axis] = true;
                }
            }
        }
        self.holds(group, axes);
        Ok(())
    }

    /// Records that a support holds a group along some axes.
    pub fn holds(&mut self, group: &Group, axes: [bool; 2]) {
        let nodes = |holds: bool| {
            if holds {
                group.nodes.iter().copied().collect()
            } else {
                BTreeSet::new()
            }
        };
        self.holders.push(Holder {
            hold: Hold {
                // Where an edge and a point both hold a node, the force belongs to the edge.
                rank: usize::from(!group.has_parts()),
                nodes: axes.map(nodes),
                sides: group.edges.clone(),
            },
            nodes: group.nodes.iter().copied().collect(),
            has_parts: group.has_parts(),
        });
    }

    /// The parts of the supports' forces along an axis that act on a group. At a corner, the forces of supports that hold the other edge
    /// alone belong to that edge; where supports of both edges hold the node, the part of each edge follows from its tractions beside the
    /// corner, and the rest is shared. The forces of groups that meet in corners therefore add up to those of all supports.
    pub fn parts_on(&self, mesh: &Mesh, group: &Group, axis: usize) -> Vec<Part> {
        let holds: Vec<&Hold> = self.holders.iter().map(|own| &own.hold).collect();
        let parts = reaction_parts(mesh, &holds, axis);
        let nodes: BTreeSet<usize> = group.nodes.iter().copied().collect();
        let is_supported = self.holders.iter().any(|holder| holder.nodes == nodes);
        let on_group = |(holder, parts): (&Holder, Vec<Part>)| {
            let own = holder.on(mesh, group, is_supported, axis);
            let parts = parts.into_iter();
            parts.filter(move |part| own.contains(&part.at))
        };
        self.holders.iter().zip(parts).flat_map(on_group).collect()
    }

    /// Ties the nodes of a group along an axis to the first of them, which takes the force.
    fn tie(&mut self, group: &Group, axis: usize, force: f64) -> Result<(), SupportMisfit> {
        let mut unknowns = group.nodes.iter().map(|node| 2 * node + axis);
        let first = unknowns.next().ok_or(SupportMisfit::NoNodes)?;
        self.ties.extend(unknowns.map(|unknown| (unknown, first)));
        self.forces.push((first, force));
        Ok(())
    }
}

/// The motion that a support gives a node along an axis.
fn motion(support: &Support, node: [f64; 2], axis: usize) -> Option<Motion> {
    match *support {
        Support::Displacement(displacement) => displacement[axis].map(Motion::Straight),
        Support::LinearDisplacement(field) => {
            field[axis].map(|along| Motion::Straight(along.at(node)))
        }
        Support::Radial {
            centre,
            displacement,
        } => {
            let arm = [node[0] - centre[0], node[1] - centre[1]];
            let along = arm[axis] / arm[0].hypot(arm[1]);
            Some(Motion::Straight(displacement * along))
        }
        Support::Roller => Some(Motion::Straight(0.0)),
        Support::Rotation { centre, angle } => {
            let place = [node[0] - centre[0], node[1] - centre[1]];
            Some(Motion::Turn { place, axis, angle })
        }
        Support::Grip(drives) => match drives[axis] {
            Drive::Displacement(displacement) => Some(Motion::Straight(displacement)),
            Drive::Force(_) => None,
        },
    }
}

/// The axis across the straight line, parallel to the other axis, on which a group lies.
fn normal(mesh: &Mesh, group: &Group) -> Result<usize, SupportMisfit> {
    let extent = |axis: usize| {
        let places = group.nodes.iter().map(|node| mesh.nodes[*node][axis]);
        let [low, high] = extremes(places);
        high - low
    };
    let extents = [extent(0), extent(1)];
    if extents == [0.0; 2] {
        return Err(SupportMisfit::NoLine);
    }
    let axis = usize::from(extents[1] < extents[0]);
    if extents[axis] <= 1e-9 * extents[1 - axis] {
        return Ok(axis);
    }
    Err(SupportMisfit::NotAlongAxis)
}
