//! Nodes that are held or moved.

use std::collections::BTreeMap;

use crate::error::Diagnostic;
use crate::mesh::Mesh;
use crate::output::export::text::words;
use crate::output::export::xml::Xml;
use crate::problem::{BoundaryProblem, Support};

/// The nodes are those of a plane.
pub const PLANE: (&str, &str) = ("template", "Vec2d");

/// The largest turn in rad along one chord.
const LARGEST_CHORD: f64 = std::f64::consts::PI / 36.0;

/// The instants between which nodes move along straight lines, from rest on.
pub struct KeyTimes(Vec<[f64; 2]>);

impl KeyTimes {
    /// The instants of the load factors, and more between them where a support turns.
    pub fn new(problem: &BoundaryProblem, factors: &[f64]) -> Self {
        let turns = problem.supports.iter().map(|(_, support)| match support {
            Support::Rotation { angle, .. } => angle.abs(),
            _ => 0.0,
        });
        let turn = turns.fold(0.0, f64::max);
        let mut instants = vec![[0.0, 0.0]];
        for factor in factors {
            let [time, before] = instants[instants.len() - 1];
            let change = factor - before;
            let parts = (turn * change.abs() / LARGEST_CHORD).ceil().max(1.0) as usize;
            instants.extend((1..=parts).map(|part| {
                let share = part as f64 / parts as f64;
                [time + share * change.abs(), before + share * change]
            }));
        }
        Self(instants)
    }

    /// The times.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|[time, _]| *time)
    }

    /// The load factors at these times.
    pub fn factors(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|[_, factor]| *factor)
    }

    /// The last time.
    pub fn last(&self) -> f64 {
        self.0[self.0.len() - 1][0]
    }
}

/// Nodes with the same motion.
pub struct Held {
    nodes: Vec<usize>,
    /// The axes along which they are held.
    axes: [bool; 2],
    /// Displacements in mm at the key times.
    path: Vec<[f64; 2]>,
}

impl Held {
    /// The nodes that the supports of a problem hold, those with the same motion together.
    pub fn of(
        problem: &BoundaryProblem,
        mesh: &Mesh,
        times: &KeyTimes,
    ) -> Result<Vec<Self>, Diagnostic> {
        let held = problem.held_by(mesh)?;
        let mut alike: BTreeMap<([bool; 2], Vec<[u64; 2]>), Self> = BTreeMap::new();
        for (node, position) in mesh.nodes.iter().enumerate() {
            let supports = [0, 1].map(|axis| held.get(&(2 * node + axis)));
            let axes = supports.map(|support| support.is_some());
            if axes == [false; 2] {
                continue;
            }
            let at = |axis: usize, factor: f64| {
                let support = supports[axis].map(|number| &problem.supports[*number].1);
                let moved =
                    support.and_then(|support| support.displacement(*position, axis, factor));
                // Without the sign of a zero.
                moved.unwrap_or(0.0) + 0.0
            };
            let positions = times
                .factors()
                .map(|factor| [0, 1].map(|axis| at(axis, factor)));
            let path: Vec<[f64; 2]> = positions.collect();
            let bits = path.iter().map(|moved| moved.map(f64::to_bits)).collect();
            let motion = alike.entry((axes, bits)).or_insert(Self {
                nodes: Vec::new(),
                axes,
                path,
            });
            motion.nodes.push(node);
        }
        Ok(alike.into_values().collect())
    }

    /// Writes the constraint.
    pub fn write(&self, times: &KeyTimes, file: &mut Xml) {
        let nodes = words(&self.nodes);
        let axes = words(self.axes.map(u8::from));
        let times = words(times.times());
        let path = words(self.path.iter().flatten());
        let is_fixed = self.path.iter().all(|moved| *moved == [0.0; 2]);
        let (name, more): (_, &[(&str, &str)]) = match (is_fixed, self.axes) {
            (true, [true, true]) => ("FixedProjectiveConstraint", &[]),
            (true, _) => (
                "PartialFixedProjectiveConstraint",
                &[("fixedDirections", &axes)],
            ),
            (false, [true, true]) => (
                "LinearMovementProjectiveConstraint",
                &[("keyTimes", &times), ("movements", &path)],
            ),
            (false, _) => (
                "PartialLinearMovementProjectiveConstraint",
                &[
                    ("movedDirections", &axes),
                    ("keyTimes", &times),
                    ("movements", &path),
                ],
            ),
        };
        let first = [PLANE, ("indices", &*nodes)];
        let attributes = first.iter().chain(more).copied();
        file.empty(name, &attributes.collect::<Vec<_>>());
    }
}
