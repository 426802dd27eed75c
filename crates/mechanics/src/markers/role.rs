//! What the columns of a table of markers are.

use crate::document::{self, ColumnRole};

/// The role of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The position along x.
    X,
    /// The position along y.
    Y,
    /// The displacement along x.
    Ux,
    /// The displacement along y.
    Uy,
    /// Standard deviation of each component of the displacement.
    StandardDeviation,
    /// The number of the frame.
    Frame,
    /// The time of the frame.
    Time,
    /// The number of the marker.
    Id,
}

/// Columns of markers by their roles, as the user names them.
pub type ChosenColumns = document::ChosenColumns<Role>;

impl ColumnRole for Role {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("x", Self::X),
        ("y", Self::Y),
        ("ux", Self::Ux),
        ("uy", Self::Uy),
        ("standard_deviation", Self::StandardDeviation),
        ("frame", Self::Frame),
        ("time", Self::Time),
        ("id", Self::Id),
    ];
    const EXAMPLE: &'static str = "x=x_px,y=y_px,ux=disp_u,uy=disp_v";
}

impl Role {
    /// The roles of positions and displacements.
    pub(super) const LENGTHS: [Self; 4] = [Self::X, Self::Y, Self::Ux, Self::Uy];
}
