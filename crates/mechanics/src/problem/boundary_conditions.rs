//! Supports and loads.

use crate::units::Linear;

/// The largest turn in rad that is taken in one step: a step of more than half a turn would lead to the state turned
/// the other way round, and codes that move nodes along straight lines would take the chord of the turn.
pub const LONGEST_TURN: f64 = std::f64::consts::PI / 6.0;

/// A support of a group; prescribed motions and forces grow with the load factor and are complete at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    /// Displacements ux, uy in mm; a component that is not given is free. Both zero: a clamp; one zero: a roller or
    /// an axis of symmetry.
    Displacement([Option<f64>; 2]),
    /// Displacements ux, uy in mm that are linear in the coordinates at rest; a component that is not given is free.
    LinearDisplacement([Option<Linear>; 2]),
    /// A displacement in mm along the line from a point in mm through the position at rest, away from the point; zero across the line.
    Radial {
        /// The point.
        centre: [f64; 2],
        /// The displacement away from the point.
        displacement: f64,
    },
    /// Free to slide along the straight line on which the group lies, in any direction: a roller, or an axis of symmetry.
    Roller,
    /// A rigid turn about a point in mm by an angle in rad, counter-clockwise.
    Rotation {
        /// The point.
        centre: [f64; 2],
        /// The angle.
        angle: f64,
    },
    /// A rigid grip that does not turn: all nodes have the same displacement along each axis.
    Grip([Drive; 2]),
}

impl Support {
    /// Whether it prescribes no motion but zero, and applies no force.
    pub fn rests(&self) -> bool {
        let is_zero = |linear: &Linear| linear.at_origin == 0.0 && linear.slope == [0.0; 2];
        match self {
            Self::Displacement(given) => given.iter().flatten().all(|value| *value == 0.0),
            Self::LinearDisplacement(given) => given.iter().flatten().all(is_zero),
            Self::Radial { displacement, .. } => *displacement == 0.0,
            Self::Roller => true,
            Self::Rotation { angle, .. } => *angle == 0.0,
            Self::Grip(drives) => drives.iter().all(|drive| match drive {
                Drive::Displacement(value) | Drive::Force(value) => *value == 0.0,
            }),
        }
    }
}

/// How a rigid grip is moved along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A displacement in mm.
    Displacement(f64),
    /// A total force in N of constant direction (dead).
    Force(f64),
}

/// A load on a group; it grows with the load factor and is complete at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A traction in MPa on the reference area of the group's edges, of constant direction (dead).
    Traction([f64; 2]),
    /// A pressure in MPa on the group's edges that follows the deformed edges: p t times the deformed length, t the
    /// thickness at rest, against the outward normal. The nodal forces are p t ∫ Nₐ n ds over the deformed edges.
    /// Edges may end anywhere.
    ///
    /// A fluid presses on the deformed thickness λ₃ t: its pressure q corresponds to p = λ₃ q here, less than q where the edge is stretched.
    Pressure(f64),
    /// A force in N, spread evenly over the length of the group's edges, independent of their cells; over its nodes where it has no edges.
    Force([f64; 2]),
}
