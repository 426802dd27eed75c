//! The climb of a field from grid to grid.

use super::ratios::{Ratios, geometric_tail};
use super::{
    Climb, ClimbSolution, CorrectionHistory, Field, Inverted, Level, NAME, Provenance, at_stretch,
};
use crate::error::{Error, SolveFault};

/// The iteration's error on all grids but the finest, relative to that allowed there.
const COARSER_GRIDS: f64 = 3.0;
/// The estimated error of the iteration that is allowed relative to the change found, as a share of the tolerance:
/// the estimate is too small by a factor of 1.6 at most on the plates measured.
const ITERATION_SHARE: f64 = 0.7;
/// Times that the iteration continues where its change is smaller than expected.
const MOST_CONTINUATIONS: usize = 6;

/// An equilibrium on one grid.
pub(super) struct Equilibrium {
    /// The number of its grid among those of the climb.
    pub index: usize,
    /// The displacements in mm.
    pub field: Field,
    /// The remaining error in mm, root mean square over the nodes: of Newton's method, its relative residual as a share
    /// of the displacements.
    pub remaining_error: f64,
}

/// A field during the climb.
pub(super) struct Ascent {
    /// The grid that it has reached.
    index: usize,
    pub field: Field,
    /// The change of the field from the grid before to this one, where there was one, and its size.
    change: Option<Field>,
    size: f64,
    /// The ratio by which changes shrink from grid to grid.
    ratio: f64,
    ratios: Ratios,
    corrections: Vec<f64>,
    provenance: Provenance,
}

impl Ascent {
    /// Begins with the equilibrium on the first grid.
    pub fn new(equilibrium: Equilibrium, ratios: Ratios, provenance: Provenance) -> Self {
        let Equilibrium {
            index,
            field,
            remaining_error,
        } = equilibrium;
        Self {
            index,
            corrections: vec![field.size(), remaining_error],
            field,
            change: None,
            size: f64::NAN,
            ratio: ratios.first,
            ratios,
            provenance,
        }
    }

    /// Records that the field on a finer grid was found along a path of load steps, and the remaining error.
    fn note_load_path(&mut self, remaining_error: f64, cells: [usize; 2]) {
        self.corrections = vec![self.size, remaining_error];
        self.provenance.by_load_path.push(cells);
    }

    /// The field, and its change from the grid before, interpolated on the next grid.
    fn onto_next(&self, levels: &[Level]) -> (Field, Option<Field>) {
        let [coarse, fine] = [self.index, self.index + 1].map(|index| &levels[index].grid);
        let change = self.change.as_ref();
        (
            self.field.onto(coarse, fine),
            change.map(|change| change.onto(coarse, fine)),
        )
    }

    /// The size of the change from the interpolated field before to one on a finer grid, and the ratio of changes that follows.
    ///
    /// Cubics are more exact at their nodes than between them: they are compared at the nodes of the grid before.
    fn change_to(
        &self,
        [coarse, fine]: [&Level; 2],
        field: &Field,
        interpolated: &Field,
    ) -> [f64; 2] {
        let size = if fine.grid.has_cubics() {
            let mut change = field.onto(&fine.grid, &coarse.grid);
            change.add(-1.0, &self.field);
            change.size()
        } else {
            let mut change = field.clone();
            change.add(-1.0, interpolated);
            fine.size_of(&change)
        };
        [size, self.ratios.measured([self.size, size], self.ratio)]
    }

    /// Sets the field of a finer grid; `interpolated` is the one before on it.
    fn take(&mut self, levels: &[Level], index: usize, field: Field, mut interpolated: Field) {
        let pair = [self.index, index].map(|index| &levels[index]);
        [self.size, self.ratio] = self.change_to(pair, &field, &interpolated);
        interpolated.scale(-1.0);
        interpolated.add(1.0, &field);
        (self.index, self.field, self.change) = (index, field, Some(interpolated));
    }

    /// The sum of d q + d q² + … that all finer grids would add.
    fn discretisation_error(&self) -> f64 {
        geometric_tail(self.size, self.ratio)
    }
}

impl Climb<'_> {
    /// Climbs from the corrected field on the first grid to the finest one.
    pub(super) fn ascend(
        &mut self,
        mut ascent: Ascent,
        stretch: f64,
    ) -> Result<ClimbSolution, Error> {
        while ascent.index + 1 < self.levels.len() {
            if self.step_up(&mut ascent).is_err() {
                self.step_up_by_load_path(&mut ascent, stretch)?;
            }
        }
        let force = match self.force(&ascent.field) {
            Ok(force) => force,
            Err(Inverted) => {
                self.replace_by_load_path(&mut ascent, stretch)?;
                let force = self.force(&ascent.field);
                force.map_err(|fault| at_stretch(NAME, stretch)(fault.into()))?
            }
        };
        Ok(ClimbSolution {
            force,
            discretisation_error: ascent.discretisation_error(),
            field: ascent.field,
            corrections: ascent.corrections,
            provenance: ascent.provenance,
        })
    }

    /// Climbs one grid by the iteration: from the expected change, otherwise from zero change.
    fn step_up(&mut self, ascent: &mut Ascent) -> Result<(), SolveFault> {
        let index = ascent.index + 1;
        let (interpolated, change) = ascent.onto_next(&self.levels);
        let mut field = interpolated.clone();
        if let Some(change) = &change {
            field.add(ascent.ratio, change);
        }
        let mut settled = self.settle(index, ascent, &interpolated, &mut field);
        if settled.is_err() && change.is_some() {
            field.clone_from(&interpolated);
            settled = self.settle(index, ascent, &interpolated, &mut field);
        }
        let reached = settled?;
        self.weakest = reached.weakest;
        ascent.take(&self.levels, index, field, interpolated);
        ascent.corrections = reached.corrections;
        Ok(())
    }

    /// Iterates on a grid until the remaining error is below a share of the discretisation error: first of that from
    /// the expected change, then, on the finest grid, of that from the change found.
    fn settle(
        &mut self,
        index: usize,
        ascent: &Ascent,
        interpolated: &Field,
        field: &mut Field,
    ) -> Result<CorrectionHistory, SolveFault> {
        let finest = index + 1 == self.levels.len();
        let tolerance = if finest {
            self.settings.tolerance
        } else {
            COARSER_GRIDS * self.settings.tolerance
        };
        let (expected, ratio) = (ascent.ratio * ascent.size, ascent.ratio);
        let enough = |first: f64, remaining_error: f64| {
            let change = if expected.is_nan() { first } else { expected };
            remaining_error <= tolerance * geometric_tail(change, ratio)
        };
        let mut reached = self.solve(index, field, &enough)?;
        for _ in 0..if finest { MOST_CONTINUATIONS } else { 0 } {
            let pair = [ascent.index, index].map(|index| &self.levels[index]);
            let [change, ratio] = ascent.change_to(pair, field, interpolated);
            let limit = ITERATION_SHARE * tolerance * geometric_tail(change, ratio);
            if reached.remaining_error() <= limit {
                break;
            }
            self.weakest = reached.slowest();
            let more = self.solve(index, field, &|_, remaining_error| remaining_error <= limit)?;
            reached = reached.followed_by(more);
        }
        Ok(reached)
    }

    /// Climbs to the next grid, or a finer one, by Newton's method along a path of load steps from rest.
    fn step_up_by_load_path(&mut self, ascent: &mut Ascent, stretch: f64) -> Result<(), Error> {
        let equilibrium = self.along_load_path(ascent.index + 1, stretch)?;
        self.write_operators(&equilibrium);
        let [coarse, fine] =
            [ascent.index, equilibrium.index].map(|index| &self.levels[index].grid);
        let interpolated = ascent.field.onto(coarse, fine);
        ascent.take(
            &self.levels,
            equilibrium.index,
            equilibrium.field,
            interpolated,
        );
        ascent.note_load_path(equilibrium.remaining_error, fine.cells());
        Ok(())
    }

    /// Replaces the field on the finest grid by that of Newton's method along a path of load steps,
    /// where the last correction of the iteration turned a cell inside out.
    fn replace_by_load_path(&self, ascent: &mut Ascent, stretch: f64) -> Result<(), Error> {
        let equilibrium = self.along_load_path(ascent.index, stretch)?;
        ascent.field = equilibrium.field;
        ascent.note_load_path(equilibrium.remaining_error, self.grid().cells());
        Ok(())
    }
}
