//! Groups that are moved by hand: from their state in an equilibrium they are moved, or pulled by other forces.
//!
//! ```text
//! uᵢ = d + (R(θ) − 1) aᵢ + wᵢ,   aᵢ = Xᵢ − X̄ + wᵢ                                            [mm]
//! ```
//!
//! d is the mean displacement of the group and θ its turn since the hand took it, X̄ the mean place of the group at rest, and wᵢ
//! the displacement that its support gave the node i at that time beyond the mean: zero where the group is clamped.

use std::collections::BTreeMap;

use super::boundary::BoundaryProblem;
use super::boundary_conditions::{Drive, Support};
use super::constraints::Constraints;
use super::grip::{Grip, RigidMotion};
use super::groups::{refused, shares};
use crate::error::Diagnostic;
use crate::mesh::Mesh;
use crate::solve::State;

mod motion;

pub use motion::HandMotion;

/// How a group is held along an axis.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Hold {
    Free,
    Held,
    /// By a force; the unknown that the others follow.
    Pulled(usize),
}

/// A node of a group in the hand.
struct HeldNode {
    node: usize,
    /// aᵢ.
    arm: [f64; 2],
    /// wᵢ.
    own: [f64; 2],
}

/// A group in the hand.
struct HeldGroup {
    holds: [Hold; 2],
    nodes: Vec<HeldNode>,
    /// Its grip at the time when it is taken.
    grip: Grip,
}

/// All groups of a problem that supports hold, taken into the hand at an equilibrium.
pub struct Hand {
    groups: BTreeMap<String, HeldGroup>,
    /// The load factor of the equilibrium; the loads stay at it.
    factor: f64,
    /// Displacements in mm that differ by less are equal but for rounding.
    rounding: f64,
}

impl Hand {
    /// Takes the groups of a problem at an equilibrium on a mesh.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, or when a group does not suit its support.
    pub fn take(problem: &BoundaryProblem, mesh: &Mesh, state: &State) -> Result<Self, Diagnostic> {
        let mut supports: BTreeMap<&str, Vec<(String, Support)>> = BTreeMap::new();
        for own in &problem.supports {
            supports.entry(&own.0).or_default().push(own.clone());
        }
        let groups = supports.into_iter().map(|(name, own)| {
            let constraints = Constraints::of(mesh, &own)?;
            let group = HeldGroup::take(mesh, name, &constraints, state);
            Ok((name.to_owned(), group))
        });
        let [low, high] = mesh.bounding_box();
        Ok(Self {
            groups: groups.collect::<Result<_, Diagnostic>>()?,
            factor: state.factor,
            rounding: 1e-9 * (high[0] - low[0]).hypot(high[1] - low[1]),
        })
    }

    /// The grips of the groups at the time when they are taken.
    pub fn grips(&self) -> BTreeMap<String, Grip> {
        let groups = self.groups.iter();
        groups
            .map(|(name, group)| (name.clone(), group.grip))
            .collect()
    }

    /// Checks that the hand can apply a grip to a group.
    ///
    /// # Errors
    /// A [`Diagnostic`] when no support holds such a group, or when its support is of another kind.
    pub fn check(&self, name: &str, grip: &Grip) -> Result<(), Diagnostic> {
        let Some(group) = self.groups.get(name) else {
            let known: Vec<_> = self.groups.keys().map(String::as_str).collect();
            let fault = Diagnostic::error("support", format!("no support holds a group `{name}`"));
            return Err(fault.hint(format!("supports hold {}", known.join(", "))));
        };
        group.refusal(grip).map_or(Ok(()), |(reason, hint)| {
            Err(refused("support", name, reason).hint(hint))
        })
    }

    /// Checks that grips agree at the nodes that groups share.
    ///
    /// # Errors
    /// A [`Diagnostic`] with the first node at which they do not.
    pub fn agree(&self, mesh: &Mesh, grips: &BTreeMap<String, Grip>) -> Result<(), Diagnostic> {
        let mut demands: BTreeMap<usize, (&str, f64)> = BTreeMap::new();
        for (name, group) in &self.groups {
            for (unknown, demand) in group.displacements(&grips[name]) {
                let (other, earlier) = *demands.entry(unknown).or_insert((name, demand));
                if (demand - earlier).abs() > self.rounding {
                    let place = mesh.describe_unknown(unknown);
                    let fault = format!(
                        "the grips of `{other}` and `{name}` contradict each other at {place}"
                    );
                    return Err(Diagnostic::error("support", fault)
                        .hint("move both groups, or only along what they share"));
                }
            }
        }
        Ok(())
    }
}

impl HeldGroup {
    fn take(mesh: &Mesh, name: &str, constraints: &Constraints, state: &State) -> Self {
        let group = &mesh.groups()[name];
        let u = |node: usize| [u(state, node, 0), u(state, node, 1)];
        let mut means = [[0.0; 2]; 2];
        for (node, share) in shares(mesh, group) {
            for (mean, own) in means.iter_mut().zip([mesh.nodes[node], u(node)]) {
                (0..2).for_each(|axis| mean[axis] += share * own[axis]);
            }
        }
        let [place, mean] = means;
        let pulled = |axis: usize| {
            let mut forces = constraints.forces.iter();
            forces.find(|(master, _)| master % 2 == axis)
        };
        let is_held = |axis: usize| {
            let nodes = &mut group.nodes.iter();
            nodes.any(|node| constraints.held.contains_key(&(2 * node + axis)))
        };
        let holds = [0, 1].map(|axis| match pulled(axis) {
            Some((master, _)) => Hold::Pulled(*master),
            None if is_held(axis) => Hold::Held,
            None => Hold::Free,
        });
        let nodes = group.nodes.iter().map(|node| {
            let own = [0, 1].map(|axis| u(*node)[axis] - mean[axis]);
            let arm = [0, 1].map(|axis| mesh.nodes[*node][axis] - place[axis] + own[axis]);
            HeldNode {
                node: *node,
                arm,
                own,
            }
        });
        let displacement = [0, 1].map(|axis| match holds[axis] {
            Hold::Held => mean[axis],
            _ => 0.0,
        });
        let drive = |axis: usize| match pulled(axis) {
            Some((_, force)) => Drive::Force(state.factor * force),
            None => Drive::Displacement(displacement[axis]),
        };
        let is_pulled = holds.iter().any(|own| matches!(own, Hold::Pulled(_)));
        Self {
            nodes: nodes.collect(),
            holds,
            grip: match is_pulled {
                true => Grip::Drives([0, 1].map(drive)),
                false => Grip::Motion(RigidMotion {
                    displacement,
                    angle: 0.0,
                }),
            },
        }
    }

    /// Why the hand cannot apply a grip to the group, and what it can do instead.
    fn refusal(&self, grip: &Grip) -> Option<(&'static str, &'static str)> {
        let free = |axis: usize| self.holds[axis] == Hold::Free;
        match (grip, &self.grip) {
            (Grip::Motion(motion), Grip::Motion(_)) => {
                let [x, y] = motion.displacement;
                if ![x, y, motion.angle].iter().all(|own| own.is_finite()) {
                    return Some(("has a motion that is not finite", "give finite numbers"));
                }
                let slides = (0..2).any(|axis| free(axis) && motion.displacement[axis] != 0.0);
                let turns = (0..2).any(free) && motion.angle != 0.0;
                (slides || turns).then_some((
                    "slides freely along an axis: it cannot be moved along it, nor turned",
                    "move it across, or hold it along both axes",
                ))
            }
            (Grip::Drives(drives), Grip::Drives(own)) => {
                let fits = drives.iter().zip(own).all(|pair| match pair {
                    (Drive::Force(value), Drive::Force(_))
                    | (Drive::Displacement(value), Drive::Displacement(_)) => value.is_finite(),
                    _ => false,
                });
                (!fits).then_some((
                    "has other drives: forces and displacements stay what they are, and are finite",
                    "give a force where its support has one, a displacement where it has none",
                ))
            }
            (_, Grip::Drives(_)) => Some((
                "is a grip with a force, which is not moved rigidly",
                "give its two drives",
            )),
            (_, Grip::Motion(_)) => Some((
                "is no grip with a force: it has no drives",
                "give a rigid motion",
            )),
        }
    }

    /// The displacements in mm of the unknowns that a grip prescribes.
    fn displacements(&self, grip: &Grip) -> impl Iterator<Item = (usize, f64)> {
        let motion = match grip {
            Grip::Motion(motion) => *motion,
            Grip::Drives(drives) => RigidMotion {
                displacement: drives.map(|drive| match drive {
                    Drive::Displacement(displacement) => displacement,
                    Drive::Force(_) => 0.0,
                }),
                angle: 0.0,
            },
        };
        let held = [0, 1].map(|axis| self.holds[axis] == Hold::Held);
        self.nodes.iter().flat_map(move |own| {
            let moved = motion.at(own.arm);
            let axes = (0..2).filter(move |axis| held[*axis]);
            axes.map(move |axis| (2 * own.node + axis, moved[axis] + own.own[axis]))
        })
    }
}

fn u(state: &State, node: usize, axis: usize) -> f64 {
    state.displacement[2 * node + axis]
}
