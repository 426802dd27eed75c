//! How a climb came to its field.

use std::fmt;

/// The first field from which a corrected field was made, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Springs alone, in equilibrium on a coarse lattice.
    Springs,
    /// Springs at the first of so many equal load steps.
    LoadSteps(usize),
    /// Newton's method with a sparse factor along a path of load steps.
    LoadPath,
    /// The state before, in [`super::Interactive`].
    StatesBefore,
}

impl fmt::Display for Start {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Springs => f.write_str("springs"),
            Self::LoadSteps(steps) => write!(f, "springs at the first of {steps} load steps"),
            Self::LoadPath => f.write_str("Newton's method along a path of load steps"),
            Self::StatesBefore => f.write_str("previous states"),
        }
    }
}

/// How a climb came to its field.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// The start of the field on the first grid.
    pub start: Start,
    /// Cells of the first grid.
    pub cells: [usize; 2],
    /// The distance of the start from the corrected field on the first grid, root mean square over its nodes in mm,
    /// in the first load step; NaN where nothing was corrected.
    pub away: f64,
    /// Cells of the finer grids on which the iteration found no field, so that Newton's method along a path of load steps was used there.
    pub by_load_path: Vec<[usize; 2]>,
}

impl Provenance {
    /// A climb from one start on a grid with so many cells.
    pub(super) fn from_start(start: Start, cells: [usize; 2]) -> Self {
        Self {
            start,
            cells,
            away: f64::NAN,
            by_load_path: Vec::new(),
        }
    }
}

impl fmt::Display for Provenance {
    /// `springs, corrected on 8 × 4 cells`, and `; Newton's method along a path of load steps on 60 × 20 cells` where it was needed.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [along, across] = self.cells;
        let corrected = match self.start {
            Start::LoadPath => "",
            _ => ", corrected",
        };
        write!(f, "{}{corrected} on {along} × {across} cells", self.start)?;
        for [along, across] in &self.by_load_path {
            write!(f, "; {} on {along} × {across} cells", Start::LoadPath)?;
        }
        Ok(())
    }
}
