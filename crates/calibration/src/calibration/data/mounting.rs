//! How the sheet of a planar biaxial test is held, and its state at rest.

use crate::mesh::Shape;

/// How a sheet is held along both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting {
    /// The sheet as it is mounted.
    pub shape: Shape,
    /// Whether tines, or hooks on threads, slide along their bar.
    pub slides: bool,
    /// Distances in mm of the bars or grips, as mounted, to which the displacements are related.
    pub lengths: [f64; 2],
    /// Thickness in mm, as mounted.
    pub thickness: f64,
    /// The cross-sections in mm² by which the forces along both axes are divided.
    pub areas: [f64; 2],
    /// The side in mm of the square of four markers in the middle whose stretches were measured; `None` where they are those of the bars.
    pub markers: Option<f64>,
}

/// The state of a biaxial test's sheet without stress, relative to the state as it is mounted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RestState {
    /// It is free of stress as mounted.
    #[default]
    AsMounted,
    /// It is stretched by these ratios as mounted.
    Stated([f64; 2]),
    /// The ratios are found with the law.
    Estimated,
}

/// What is stated of the mounting of a test.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mounted {
    /// How the sheet is held; `None` where its state is taken as homogeneous.
    pub mounting: Option<Mounting>,
    /// Its state at rest.
    pub rest_state: RestState,
    /// Whether the zeros of both forces are found with the law.
    pub estimates_force_zero: bool,
}

impl RestState {
    /// The stretches that are possible as mounted.
    pub const RANGE: [f64; 2] = [0.7, 2.0];
}

impl Mounted {
    /// Whether the stretches as mounted are found with the law.
    pub fn estimates_stretches(&self) -> bool {
        self.rest_state == RestState::Estimated
    }

    /// The stated stretches as mounted; 1 where none are stated.
    pub fn stated_stretches(&self) -> [f64; 2] {
        match self.rest_state {
            RestState::Stated(stretches) => stretches,
            RestState::AsMounted | RestState::Estimated => [1.0; 2],
        }
    }
}
