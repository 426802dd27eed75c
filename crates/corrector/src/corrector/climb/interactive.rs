//! Grips that are moved by hand: each state is near the one before.

use std::fmt;

use super::{
    Climb, ClimbSolution, CorrectionHistory, Ending, Field, NAME, ONLY_GRID_TOLERANCE, Provenance,
    Start,
};
use crate::error::{Error, SolveFault};
use crate::problem::{DeformedSheet, RigidMotion};

/// The positions of both grips.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grips {
    /// The grip at X = 0.
    pub left: RigidMotion,
    /// The grip at X = length.
    pub right: RigidMotion,
}

impl fmt::Display for Grips {
    /// `(0, 0) mm turned by 0° and (75, 0) mm turned by 2°`, left and right.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { left, right } = self;
        write!(f, "{left} and {right}")
    }
}

impl Climb<'_> {
    /// Corrects a field that is near the result, with the operators assembled before, to a share of its discretisation error; of the field
    /// itself where this is not known.
    fn near(&mut self, field: &mut Field, error: f64) -> Result<CorrectionHistory, SolveFault> {
        self.check_operators()?;
        let finest = self.levels.len() - 1;
        let limit = if error.is_nan() {
            ONLY_GRID_TOLERANCE * field.size()
        } else {
            self.settings.tolerance * error
        };
        let (sheet, most) = (self.sheet(), self.settings.max_iterations);
        let level = &mut self.levels[finest];
        let ending = Ending {
            most,
            weakest: self.weakest,
            enough: &|_, remaining_error| remaining_error <= limit,
        };
        let reached = level.iterate(sheet, field, &mut self.multigrid, &ending)?;
        if reached.remaining_error() > limit {
            return Err(SolveFault::Stalled {
                iterations: most,
                residual: reached.remaining_error(),
                tolerance: limit,
            });
        }
        Ok(reached)
    }
}

/// A plate moved by hand: its grips are moved, and the corrected field follows.
pub struct Interactive<'a> {
    climb: Climb<'a>,
    grips: Grips,
    climbed: ClimbSolution,
    /// The discretisation error relative to the size of the field; NaN on a single grid, or where it begins at rest.
    relative_error: f64,
}

impl<'a> Interactive<'a> {
    /// Begins at one stretch.
    ///
    /// # Errors
    /// [`Error::Solve`] when no field was found there.
    pub fn new(mut climb: Climb<'a>, stretch: f64) -> Result<Self, Error> {
        let climbed = climb.correct(stretch)?;
        let grips = Grips {
            right: RigidMotion {
                displacement: [stretch * climb.problem.size[0], 0.0],
                angle: 0.0,
            },
            ..Grips::default()
        };
        Ok(Self {
            relative_error: climbed.discretisation_error / climbed.field.size(),
            climb,
            grips,
            climbed,
        })
    }

    /// The present corrected field and forces at the grips.
    pub fn state(&self) -> &ClimbSolution {
        &self.climbed
    }

    /// The present corrected field, to be evaluated at any point of the plate.
    pub fn deformed(&self) -> DeformedSheet {
        self.climb.deformed(&self.climbed)
    }

    /// The positions of the grips.
    pub fn grips(&self) -> Grips {
        self.grips
    }

    /// Moves the grips by a few mm or degrees; the field between them follows. A motion that is too large for one step is divided.
    ///
    /// # Errors
    /// [`Error::Solve`] when the field cannot follow; the state before is kept.
    pub fn move_grips(&mut self, grips: Grips) -> Result<&ClimbSolution, Error> {
        const PARTS: [usize; 4] = [1, 2, 4, 8];
        let mut outcome = Err(SolveFault::Singular);
        for parts in PARTS {
            outcome = self.move_in(parts, grips);
            if outcome.is_ok() {
                break;
            }
        }
        self.climbed = outcome.map_err(|fault| Error::Solve {
            model: NAME.into(),
            step: format!(
                "a motion of the grips from {} to {grips} (also in {} parts; the previous field is kept: move them \
                 in smaller steps, or start anew at that stretch)",
                self.grips, PARTS[PARTS.len() - 1]
            ),
            fault,
        })?;
        self.grips = grips;
        Ok(&self.climbed)
    }

    fn move_in(&mut self, parts: usize, grips: Grips) -> Result<ClimbSolution, SolveFault> {
        let mut field = self.climbed.field.clone();
        let mut reached = None;
        for part in 1..=parts {
            let share = 1.0 / (parts - part + 1) as f64;
            self.impose(grips, share, &mut field);
            self.climb
                .linearise_below(self.climb.levels.len() - 1, &field)?;
            let error = self.relative_error * field.size();
            reached = Some((error, self.climb.near(&mut field, error)?));
        }
        let (error, reached) = reached.expect("one part at least");
        let cells = self.climb.grid().cells();
        Ok(ClimbSolution {
            force: self.climb.force(&field)?,
            field,
            discretisation_error: error,
            corrections: reached.corrections,
            provenance: Provenance::from_start(Start::StatesBefore, cells),
        })
    }

    /// Moves the grips by a share of the remaining motion, and the nodes between them in proportion.
    fn impose(&self, grips: Grips, share: f64, field: &mut Field) {
        let grid = self.climb.grid();
        let [length, width] = self.climb.problem.size;
        let last = grid.lines().count - 1;
        for (node, y) in grid.coordinates[1].iter().enumerate() {
            let targets = [grips.left, grips.right].map(|grip| grip.at([0.0, y - 0.5 * width]));
            for axis in [0, 1] {
                let component = &mut field.components[axis];
                let at = |line: usize| line * grid.lines().nodes + node;
                let left = share * (targets[0][axis] - component[at(0)]);
                let right = share * (targets[1][axis] - component[at(last)]);
                for (line, x) in grid.coordinates[0].iter().enumerate() {
                    component[at(line)] += left + (right - left) * x / length;
                }
            }
        }
    }
}
