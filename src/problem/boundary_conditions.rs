//! Supports and loads.

use crate::units::Linear;

/// The longest turn in rad that is taken in one step: one beyond a half would lead to the state of the turn the other way round, and
/// codes that lead nodes along straight lines would take its chord.
pub const LONGEST_TURN: f64 = std::f64::consts::PI / 6.0;

/// What holds a group; everything grows with the load factor and is complete at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    /// Displacements ux, uy in mm; one that is not given is free. Both zero: a clamp; one zero: a roller or
    /// an axis of symmetry.
    Displacement([Option<f64>; 2]),
    /// Displacements ux, uy in mm that are linear in the place at rest; one that is not given is free.
    LinearDisplacement([Option<Linear>; 2]),
    /// A displacement in mm along the line from a point in mm through the place at rest, away from the point; none
    /// across it.
    Radial {
        /// The point.
        centre: [f64; 2],
        /// The displacement away from it.
        displacement: f64,
    },
    /// Free to slide along the straight line on which the group lies, parallel to an axis: a roller, or an axis of
    /// symmetry.
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
    /// Whether it holds what it holds where it is, and pulls nothing.
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

impl Load {
    /// Whether it is none.
    pub fn is_none(&self) -> bool {
        match self {
            Self::Traction(value) | Self::Force(value) => *value == [0.0; 2],
            Self::Pressure(pressure) => *pressure == 0.0,
        }
    }
}

/// What moves a rigid grip along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A displacement in mm.
    Displacement(f64),
    /// A total force in N of constant direction (dead).
    Force(f64),
}

/// What loads a group; everything grows with the load factor and is complete at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A traction in MPa on the reference area of the group's edges, of constant direction (dead).
    Traction([f64; 2]),
    /// A pressure in MPa on the group's edges that follows them: p t times the deformed length, t the thickness
    /// at rest, against the outward normal. The forces are p t ∫ Nₐ n ds over the deformed edges at every node. Edges may
    /// end anywhere.
    ///
    /// A fluid presses on the deformed thickness λ₃ t: its pressure q is p = λ₃ q here, less than q where
    /// the edge is stretched.
    Pressure(f64),
    /// A force in N, spread evenly over the length of the group's edges, whatever their cells are; over its nodes where it has no edges.
    Force([f64; 2]),
}
