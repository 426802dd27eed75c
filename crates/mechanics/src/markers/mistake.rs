//! Mistakes in how a field of displacements was written.

/// What a field was written as, instead of displacements along x and y from rest to the deformed state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mistake {
    /// Positions in the deformed state.
    FinalPositions,
    /// Displacements from the deformed state to rest.
    Reversed,
    /// Displacements along y and x.
    Exchanged,
    /// Displacements against one of the axes.
    Mirrored(usize),
}

impl Mistake {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::FinalPositions,
        Self::Reversed,
        Self::Exchanged,
        Self::Mirrored(0),
        Self::Mirrored(1),
    ];

    /// The displacement that was intended at a position at rest.
    pub fn intended(self, [x, y]: [f64; 2], [ux, uy]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::FinalPositions => [ux - x, uy - y],
            Self::Reversed => [-ux, -uy],
            Self::Exchanged => [uy, ux],
            Self::Mirrored(0) => [-ux, uy],
            Self::Mirrored(_) => [ux, -uy],
        }
    }

    /// What the field seems to be, and what to do.
    pub fn words(self) -> (String, &'static str) {
        match self {
            Self::FinalPositions => (
                "final positions instead of displacements".to_owned(),
                "subtract the positions at rest: ux = x in the deformed state − x at rest",
            ),
            Self::Reversed => (
                "displacements with reversed sign".to_owned(),
                "reverse the sign of both components: displacements lead from rest to the deformed state",
            ),
            Self::Exchanged => (
                "displacements with x and y exchanged".to_owned(),
                "exchange the two components",
            ),
            Self::Mirrored(axis) => (
                format!("mirrored along {}", ["x", "y"][axis]),
                "reverse the sign of that component: positions and displacements share their axes",
            ),
        }
    }
}
