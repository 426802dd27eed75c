//! Why points or lines make no outline.

use crate::mesh::geometry::OutOfSize;

/// Why points or lines make no outline.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OutlineFault {
    /// Too few points.
    #[error("{0} points have no outline, which takes six that are not on a line")]
    TooFew(usize),
    /// All points lie on one line.
    #[error("the points lie on one line")]
    OneLine,
    /// No triangle between points is small enough.
    #[error("the points are too far apart to have an outline")]
    TooFarApart,
    /// The points lie in several parts.
    #[error("the points lie in two separated parts, one of them near ({:.4}, {:.4}) mm", .0[0], .0[1])]
    SeparatedPoints([f64; 2]),
    /// Points as no specimen has them.
    #[error("the points {0}")]
    Size(#[from] OutOfSize),
    /// Lines of too many points.
    #[error("the outline has {0} points, which is more than {most}; leave some out", most = Self::MOST_POINTS)]
    TooMany(usize),
    /// No line at all.
    #[error("the outline has no line")]
    NoLine,
    /// A line around nothing.
    #[error("a line of the outline encloses no area")]
    NoArea,
    /// Lines that cross.
    #[error("the outline crosses itself near ({:.4}, {:.4}) mm", .0[0], .0[1])]
    Crossing([f64; 2]),
    /// A line outside of the outer one.
    #[error("the outline has two separated parts, one of them near ({:.4}, {:.4}) mm", .0[0], .0[1])]
    SeparatedLines([f64; 2]),
}

impl OutlineFault {
    /// Points of an outline at most.
    pub const MOST_POINTS: usize = 30_000;
}
