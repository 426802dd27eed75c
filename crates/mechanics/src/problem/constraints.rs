//! Effects of supports on the unknowns: the motions of held ones, ties, and the forces on rigid grips.

use std::collections::{BTreeMap, BTreeSet};

use super::boundary_conditions::{Drive, Support};
use super::corner_forces::{Hold, Part, reaction_parts};
use super::groups::{named, refused};
use super::rigid_motion::RigidMotion;
use crate::error::Diagnostic;
use crate::mesh::{Group, Mesh, geometry};

/// Load factors at which motions are compared; two different motions, a turn and a line, agree at two of them at most.
pub const FACTORS: [f64; 3] = [0.3, 0.7, 1.0];

/// How a held unknown moves.
#[derive(Clone, Copy)]
pub enum Motion {
    /// A displacement in proportion to the load factor, in mm at 1.
    Straight(f64),
    /// Like a coordinate of a point, at a position in mm relative to the centre, that is turned by an angle at 1.
    Turn {
        position: [f64; 2],
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
            Self::Turn {
                position,
                axis,
                angle,
            } => {
                let turn = RigidMotion {
                    displacement: [0.0; 2],
                    angle: factor * angle,
                };
                turn.at(position)[axis]
            }
        }
    }
}

impl Support {
    /// The displacement in mm of a node at a position in mm, at a load factor, along an axis that the support holds.
    pub fn displacement(&self, position: [f64; 2], axis: usize, factor: f64) -> Option<f64> {
        motion(self, position, axis).map(|motion| motion.at(factor))
    }
}

/// Why a group does not suit its support, as a predicate that follows the group's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
enum SupportMisfit {
    #[error(
        "has a node at the centre of its radial displacement, where the radial direction is not defined"
    )]
    NodeAtCentre,
    #[error("has no nodes")]
    NoNodes,
    #[error("is not a straight line, which a roller or an axis of symmetry needs")]
    NotStraight,
    #[error("slides along a line, and another support moves a node of it off that line")]
    MovedOffLine,
    #[error("is a single point, which defines no line to slide along")]
    NoLine,
}

impl SupportMisfit {
    fn remedy(self) -> &'static str {
        match self {
            Self::NodeAtCentre => "move the centre, or leave the node out",
            Self::NoNodes => "take a group with nodes",
            Self::NotStraight => "hold the group with the kind \"displacement\"",
            Self::MovedOffLine => {
                "leave the node out of one of the groups, or move it along the line"
            }
            Self::NoLine => "hold it with the kind \"displacement\" and x or y",
        }
    }
}

/// An unknown that is a multiple of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tie {
    /// The unknown that it follows.
    pub master: usize,
    /// What it is a multiple of: u = share · u of the master.
    pub share: f64,
}

/// A node that slides along a line that is parallel to no axis.
#[derive(Clone, Copy)]
struct Slide {
    node: usize,
    /// The unit normal of the line.
    normal: [f64; 2],
}

/// All supports of a problem on the unknowns of a mesh.
#[derive(Default)]
pub struct Constraints {
    /// Motion of each unknown that is held.
    pub held: BTreeMap<usize, Motion>,
    /// The unknown that each tied one follows: in grips with a given force, and along inclined lines.
    pub ties: BTreeMap<usize, Tie>,
    /// Forces in N on the unknowns that others follow.
    pub forces: Vec<(usize, f64)>,
    /// The nodes that each support holds.
    holders: Vec<Holder>,
    /// The nodes that slide along inclined lines, with the name of their group.
    slides: Vec<(String, Slide)>,
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
        let held_nodes = &self.hold.nodes[axis];
        if is_supported && self.has_parts != group.has_parts() {
            // A point with a support of its own is not part of the edge around it.
            return BTreeSet::new();
        }
        if !self.has_parts || !group.has_parts() || self.nodes.iter().eq(&group.nodes) {
            let nodes = group.nodes.iter().copied();
            return nodes.filter(|node| held_nodes.contains(node)).collect();
        }
        let sides = group.edges.iter().chain(&group.lines).map(Vec::as_slice);
        let parts = sides.chain(group.cells.iter().map(|cell| mesh.cell(*cell)));
        let held = parts.filter(|part| part.iter().all(|node| held_nodes.contains(node)));
        held.flatten().copied().collect()
    }
}

impl Constraints {
    /// The effects of supports, by group, on the unknowns of a mesh; supports must agree on nodes that they share.
    pub fn of(mesh: &Mesh, supports: &[(String, Support)]) -> Result<Self, Diagnostic> {
        let mut all = Self::each(mesh, supports)?;
        for (group, slide) in std::mem::take(&mut all.slides) {
            all.slide(slide).map_err(|misfit| {
                refused("support", &group, &misfit.to_string()).hint(misfit.remedy())
            })?;
        }
        Ok(all)
    }

    /// The effects of supports without the nodes that slide along inclined lines, which other supports may hold too.
    pub fn each(mesh: &Mesh, supports: &[(String, Support)]) -> Result<Self, Diagnostic> {
        let mut all = Self::default();
        for (name, support) in supports {
            let added = all.add(mesh, name, named("support", mesh, name)?, support);
            added.map_err(|misfit| {
                refused("support", name, &misfit.to_string()).hint(misfit.remedy())
            })?;
        }
        Ok(all)
    }

    /// Adds a support of a group, or returns why the group does not suit it.
    fn add(
        &mut self,
        mesh: &Mesh,
        name: &str,
        group: &Group,
        support: &Support,
    ) -> Result<(), SupportMisfit> {
        if let Support::Radial { centre, .. } = support
            && group.nodes.iter().any(|node| mesh.nodes[*node] == *centre)
        {
            return Err(SupportMisfit::NodeAtCentre);
        }
        if *support == Support::Roller {
            return self.roll(mesh, name, group);
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
            for node in &group.nodes {
                if let Some(motion) = motion(support, mesh.nodes[*node], axis) {
                    self.held.insert(2 * node + axis, motion);
                    axes[axis] = true;
                }
            }
        }
        self.holds(group, axes);
        Ok(())
    }

    /// Lets a group slide along its straight line.
    fn roll(&mut self, mesh: &Mesh, name: &str, group: &Group) -> Result<(), SupportMisfit> {
        let normal = normal(mesh, group)?;
        if let Some(axis) = normal.iter().position(|along| *along == 1.0) {
            for node in &group.nodes {
                self.held.insert(2 * node + axis, Motion::Straight(0.0));
            }
            self.holds(group, [axis == 0, axis == 1]);
        } else {
            let slides = group.nodes.iter().map(|node| {
                let slide = Slide {
                    node: *node,
                    normal,
                };
                (name.to_owned(), slide)
            });
            self.slides.extend(slides);
            self.holds(group, [true; 2]);
        }
        Ok(())
    }

    /// Holds a node on an inclined line, n · u = 0, as far as other supports leave it free.
    fn slide(&mut self, Slide { node, normal }: Slide) -> Result<(), SupportMisfit> {
        let unknowns = [2 * node, 2 * node + 1];
        let along = usize::from(normal[1].abs() < normal[0].abs());
        let across = 1 - along;
        let share = -normal[along] / normal[across];
        match unknowns.map(|unknown| self.held.get(&unknown).copied()) {
            [None, None] => {
                // Others of a pulled grip follow it already, and would follow one that follows.
                let is_pulled = |(pulled, _): &(usize, f64)| *pulled == unknowns[across];
                if self.forces.iter().any(is_pulled) {
                    return Err(SupportMisfit::MovedOffLine);
                }
                let tie = Tie {
                    master: unknowns[along],
                    share,
                };
                match unknowns.iter().find_map(|unknown| self.ties.get(unknown)) {
                    None => {
                        self.ties.insert(unknowns[across], tie);
                    }
                    Some(known) if *known == tie => (),
                    Some(Tie { master, .. }) if master / 2 == node => {
                        // Two lines meet here.
                        for unknown in unknowns {
                            self.ties.remove(&unknown);
                            self.held.insert(unknown, Motion::Straight(0.0));
                        }
                    }
                    Some(_) => return Err(SupportMisfit::MovedOffLine),
                }
            }
            [Some(x), Some(y)] => {
                let off = |factor: f64| normal[0] * x.at(factor) + normal[1] * y.at(factor);
                let size = |factor: f64| x.at(factor).abs() + y.at(factor).abs();
                if FACTORS.iter().any(|at| off(*at).abs() > 1e-9 * size(*at)) {
                    return Err(SupportMisfit::MovedOffLine);
                }
            }
            [x, y] => {
                let (axis, motion) = if x.is_some() { (0, x) } else { (1, y) };
                let Some(Motion::Straight(displacement)) = motion else {
                    return Err(SupportMisfit::MovedOffLine);
                };
                let other = 1 - axis;
                let follows = -normal[axis] / normal[other] * displacement;
                self.held.insert(unknowns[other], Motion::Straight(follows));
            }
        }
        Ok(())
    }

    /// Records that a support holds a group along some axes.
    pub fn holds(&mut self, group: &Group, axes: [bool; 2]) {
        let nodes: BTreeSet<usize> = group.nodes.iter().copied().collect();
        let held = |holds: bool| nodes.iter().copied().filter(|_| holds).collect();
        self.holders.push(Holder {
            hold: Hold {
                // Where an edge and a point both hold a node, the force belongs to the edge.
                rank: usize::from(!group.has_parts()),
                nodes: axes.map(held),
                sides: group.edges.clone(),
            },
            nodes,
            has_parts: group.has_parts(),
        });
    }

    /// The parts of the supports' forces along an axis that act on a group. At a corner, the forces of supports that hold the other edge
    /// alone belong to that edge; where supports of both edges hold the node, the part of each edge follows from its tractions beside the
    /// corner, and the rest is shared. The forces of groups that meet in corners therefore add up to those of all supports.
    pub fn parts_on(&self, mesh: &Mesh, group: &Group, axis: usize) -> Vec<Part> {
        let holds: Vec<&Hold> = self.holders.iter().map(|holder| &holder.hold).collect();
        let parts = reaction_parts(mesh, &holds, axis);
        let nodes: BTreeSet<usize> = group.nodes.iter().copied().collect();
        let is_supported = self.holders.iter().any(|holder| holder.nodes == nodes);
        let on_group = |(holder, parts): (&Holder, Vec<Part>)| {
            let held_nodes = holder.on(mesh, group, is_supported, axis);
            let parts = parts.into_iter();
            parts.filter(move |part| held_nodes.contains(&part.at))
        };
        self.holders.iter().zip(parts).flat_map(on_group).collect()
    }

    /// Ties the nodes of a group along an axis to the first of them, which takes the force.
    fn tie(&mut self, group: &Group, axis: usize, force: f64) -> Result<(), SupportMisfit> {
        let mut unknowns = group.nodes.iter().map(|node| 2 * node + axis);
        let first = unknowns.next().ok_or(SupportMisfit::NoNodes)?;
        let tie = Tie {
            master: first,
            share: 1.0,
        };
        self.ties.extend(unknowns.map(|unknown| (unknown, tie)));
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
        // Its line tells along which direction it holds.
        Support::Roller => None,
        Support::Rotation { centre, angle } => {
            let position = [node[0] - centre[0], node[1] - centre[1]];
            Some(Motion::Turn {
                position,
                axis,
                angle,
            })
        }
        Support::Grip(drives) => match drives[axis] {
            Drive::Displacement(displacement) => Some(Motion::Straight(displacement)),
            Drive::Force(_) => None,
        },
    }
}

/// The unit normal of the straight line on which a group lies; exactly that of an axis where the line is parallel to the other one.
fn normal(mesh: &Mesh, group: &Group) -> Result<[f64; 2], SupportMisfit> {
    /// Distance from the line relative to its length.
    const STRAIGHT: f64 = 1e-9;
    let positions = || group.nodes.iter().map(|node| mesh.nodes[*node]);
    let extents = geometry::sides(positions());
    if extents == [0.0; 2] {
        return Err(SupportMisfit::NoLine);
    }
    let across = usize::from(extents[1] < extents[0]);
    if extents[across] <= STRAIGHT * extents[1 - across] {
        return Ok([0, 1].map(|axis| if axis == across { 1.0 } else { 0.0 }));
    }
    // Through the ends along the axis of the larger extent.
    let order = |a: &[f64; 2], b: &[f64; 2]| a[1 - across].total_cmp(&b[1 - across]);
    let (first, last) = (positions().min_by(order), positions().max_by(order));
    let (Some(first), Some(last)) = (first, last) else {
        return Err(SupportMisfit::NoNodes);
    };
    let along = [0, 1].map(|axis| last[axis] - first[axis]);
    let length = along[0].hypot(along[1]);
    let normal = [-along[1] / length, along[0] / length];
    let distance = |position: [f64; 2]| {
        (normal[0] * (position[0] - first[0]) + normal[1] * (position[1] - first[1])).abs()
    };
    if positions().any(|position| distance(position) > STRAIGHT * length) {
        return Err(SupportMisfit::NotStraight);
    }
    Ok(normal)
}
