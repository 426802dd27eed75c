//! The quantity that is compared at the measured group: the force of its supports, or a displacement where that force is given.

use std::collections::BTreeMap;

use crate::mesh::Mesh;
use crate::problem::{Drive, GroupState, Load, Solution, Support};
use crate::statistics::farthest;
use crate::studies::specimen::problem::Specimen;

/// A force or a displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The force of the supports.
    Force,
    /// The mean displacement, where the force is given or none acts.
    Displacement,
}

/// What is measured, where, and along which axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measured {
    pub quantity: Quantity,
    pub group: String,
    /// Its number among [`Specimen::groups`].
    pub index: usize,
    /// Along x (0) or y (1).
    pub axis: usize,
}

impl Measured {
    /// The value in N or mm, from what happens at all groups.
    pub fn of(&self, groups: &[GroupState]) -> f64 {
        let group = &groups[self.index];
        match self.quantity {
            Quantity::Force => group.force[self.axis],
            Quantity::Displacement => group.displacement[self.axis],
        }
    }

    /// The value at the load factor of a number, in N or mm; `None` where a solution has not reached it.
    pub fn at(&self, solution: &Solution, step: usize) -> Option<f64> {
        solution.groups(step).map(|groups| self.of(groups))
    }

    /// The size beside which the value at a load factor is negligible: of a force that of the forces on the group's nodes in N, of a
    /// displacement the largest one in mm; `None` where it is not negligible, or a solution has not reached the load factor.
    pub fn negligible_beside(&self, solution: &Solution, step: usize) -> Option<f64> {
        /// A share of the sum of the sizes of the nodes' forces: those on a closed edge cancel but for discretisation errors.
        const NO_FORCE: f64 = 1e-3;
        const NO_DISPLACEMENT: f64 = 1e-9;
        let groups = solution.groups(step)?;
        let (limit, scale) = match self.quantity {
            Quantity::Force => {
                let GroupState { size, rounding, .. } = groups[self.index];
                ((NO_FORCE * size).max(rounding), size.max(rounding))
            }
            Quantity::Displacement => {
                let field = solution.displacement(step)?.iter();
                let largest = farthest(field.copied()).abs();
                (NO_DISPLACEMENT * largest, largest)
            }
        };
        (self.of(groups).abs() <= limit).then_some(scale)
    }

    /// `force` or `displacement of the group`.
    pub fn name(&self) -> &'static str {
        match self.quantity {
            Quantity::Force => "force",
            Quantity::Displacement => "displacement of the group",
        }
    }

    /// N or mm.
    pub fn unit(&self) -> &'static str {
        match self.quantity {
            Quantity::Force => "N",
            Quantity::Displacement => "mm",
        }
    }

    /// `x` or `y`.
    pub fn axis_name(&self) -> &'static str {
        ["x", "y"][self.axis]
    }

    /// `the force along x of the supports on the group `left``.
    pub fn describe(&self) -> String {
        let (axis, group) = (self.axis_name(), &self.group);
        match self.quantity {
            Quantity::Force => {
                format!("the force along {axis} of the supports on the group `{group}`")
            }
            Quantity::Displacement => {
                format!("the mean displacement along {axis} of the group `{group}`")
            }
        }
    }
}

/// The unknowns that are held, each with the number of the support that holds it.
type Held = BTreeMap<usize, usize>;

/// A group that loads push, and the axis along which they do; `None` where they have no direction.
struct Pushed<'a> {
    group: &'a str,
    axis: Option<usize>,
}

impl Specimen {
    /// The quantity that is measured, chosen by the groups' last state in a model on a mesh: the force along the axis of its larger component.
    /// A force that follows from equilibrium alone does not depend on the model; then it is the displacement of a group that loads push.
    pub fn measured(&self, mesh: &Mesh, last: &[GroupState]) -> Measured {
        let held = self.problem.held_by(mesh).unwrap_or_default();
        let moved = self.pushed().filter(|pushed| moves(mesh, &held, pushed));
        let moved: Vec<_> = moved.collect();
        let force = self.along_larger(&self.group, last, Quantity::Force);
        let held_along = self.held_along(mesh, &held);
        let nodes = |group: &str| &mesh.groups()[group].nodes;
        let pushed = moved
            .iter()
            .find(|pushed| nodes(pushed.group) == nodes(&self.group));
        // A support that does more than the load along another axis is what is measured.
        let is_transverse = |pushed: &Pushed| {
            held_along[force.axis] && pushed.axis.is_some_and(|axis| axis != force.axis)
        };
        if let Some(pushed) = pushed.filter(|pushed| !is_transverse(pushed)) {
            return self.displaced(pushed, last);
        }
        if held_along == [false; 2] {
            return self.along_larger(&self.group, last, Quantity::Displacement);
        }
        match moved.first() {
            Some(first) if self.holds_alone(mesh, &held, force.axis) => {
                let mut along = moved
                    .iter()
                    .filter(|pushed| pushed.axis == Some(force.axis));
                self.displaced(along.next().unwrap_or(first), last)
            }
            _ => force,
        }
    }

    /// The force along x, where no equilibrium shows which component is larger.
    pub fn measured_at_rest(&self) -> Measured {
        let at_rest = vec![GroupState::default(); self.groups().len()];
        self.along_larger(&self.group, &at_rest, Quantity::Force)
    }

    fn displaced(&self, pushed: &Pushed, last: &[GroupState]) -> Measured {
        let larger = self.along_larger(pushed.group, last, Quantity::Displacement);
        Measured {
            axis: pushed.axis.unwrap_or(larger.axis),
            ..larger
        }
    }

    /// A quantity of a group along the axis of its larger component in the last state.
    fn along_larger(&self, group: &str, last: &[GroupState], quantity: Quantity) -> Measured {
        let index = self.groups().iter().position(|name| *name == group);
        let index = index.expect("a group that is held, loaded or measured");
        let at = |axis| Measured {
            quantity,
            group: group.to_owned(),
            index,
            axis,
        };
        let size = |axis| at(axis).of(last).abs();
        at(usize::from(size(1) > size(0)))
    }

    /// Whether supports hold the measured group along each axis, by whatever name: more of its nodes than its ends alone.
    fn held_along(&self, mesh: &Mesh, held: &Held) -> [bool; 2] {
        let nodes = &mesh.groups()[&self.group].nodes;
        [0, 1].map(|axis| {
            let held_nodes = nodes
                .iter()
                .filter(|node| held.contains_key(&(2 * *node + axis)));
            2 * held_nodes.count() > nodes.len()
        })
    }

    /// Grips with a given force, then loads.
    fn pushed(&self) -> impl Iterator<Item = Pushed<'_>> {
        let grips = self.problem.supports.iter().filter_map(|(group, support)| {
            let Support::Grip(drives) = support else {
                return None;
            };
            let [x, y] = drives.map(|drive| match drive {
                Drive::Force(force) => force.abs(),
                Drive::Displacement(_) => 0.0,
            });
            (x != 0.0 || y != 0.0).then_some(Pushed {
                group,
                axis: Some(usize::from(y > x)),
            })
        });
        let loads = self.problem.loads.iter().map(|(group, load)| Pushed {
            group,
            axis: match load {
                Load::Traction([x, y]) | Load::Force([x, y]) => {
                    Some(usize::from(y.abs() > x.abs()))
                }
                Load::Pressure(_) => None,
            },
        });
        grips.chain(loads)
    }

    /// Whether no other nodes than those of the measured group are held along an axis.
    fn holds_alone(&self, mesh: &Mesh, held: &Held, axis: usize) -> bool {
        let nodes = &mesh.groups()[&self.group].nodes;
        held.keys()
            .filter(|unknown| *unknown % 2 == axis)
            .all(|unknown| nodes.contains(&(unknown / 2)))
    }
}

/// Whether supports leave some of a group free to move as it is pushed.
fn moves(mesh: &Mesh, held: &Held, pushed: &Pushed) -> bool {
    let nodes = &mesh.groups()[pushed.group].nodes;
    let free = |axis: usize| {
        nodes
            .iter()
            .any(|node| !held.contains_key(&(2 * node + axis)))
    };
    pushed.axis.map_or(free(0) || free(1), free)
}
