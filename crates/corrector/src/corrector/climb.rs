//! The corrector's fast path: solve a few springs, then climb from grid to grid.
//!
//! The springs are solved on a very coarse lattice and corrected on the first grid. The field then climbs from grid to grid, each
//! with about twice as many cells along both axes: it is interpolated by cubics, the governing equation is linearised once, and a
//! few conjugate-gradient iterations compute the correction on the finer grid. Each iteration takes one V-cycle as preconditioner
//! and one evaluation of F. No load steps and no factorisation are needed.
//!
//! **Initial iterate.** The change d is the difference between the field on a grid and on the one before. Changes
//! shrink by a ratio q from grid to grid, so that the next one is about q d: the iteration begins with it.
//!
//! **Stopping criterion.** All finer grids together would add d q/(1 − q): this is the discretisation error. The iteration ends
//! when its own error, estimated from the decrease of its corrections, is below a stated share of that.

use super::DifferenceScheme;
use crate::error::{Error, SolveFault};
use crate::material::softened_law::check_memory;
use crate::multigrid::Multigrid;
use crate::problem::ClampedPlate;

mod ascent;
mod correction_history;
mod forces;
mod grid;
mod interactive;
mod level;
mod load_path;
mod mesh;
mod multipliers;
mod provenance;
mod ratios;
mod sheet;
mod start;
mod sweep;
#[cfg(test)]
mod tests;

pub use crate::problem::RigidMotion;
use correction_history::CorrectionHistory;
pub use grid::{Field, Grid};
pub use interactive::{Grips, Interactive};
use level::{Ending, Level};
pub use mesh::between_nodes;
pub use provenance::{Provenance, Start};
pub(super) use ratios::{Ratios, geometric_tail};
use sheet::{Inverted, Sheet};

/// Accuracy of the climb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimbSettings {
    /// The iteration's error on the finest grid, relative to the discretisation error. Default: 1e-3.
    pub tolerance: f64,
    /// Iterations allowed after a linearisation. Default: 20.
    pub max_iterations: usize,
}

impl ClimbSettings {
    /// As few iterations as do not affect the discretisation error: the iteration's error is at most 8 % of it.
    pub const FAST: Self = Self {
        tolerance: 0.08,
        max_iterations: 20,
    };
}

impl Default for ClimbSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            ..Self::FAST
        }
    }
}

/// A corrected field at one stretch.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ClimbSolution {
    /// Displacements in mm on the finest grid.
    pub field: Field,
    /// Force on the moving grip in N.
    pub force: f64,
    /// The estimated discretisation error of the field, root mean square over the nodes in mm; NaN where there is one grid only. It is known
    /// within a factor of about two where the finest grid has twice as many cells along both axes as the one before, and that one at least
    /// four elements; otherwise its order is right, and it is mostly too large.
    pub discretisation_error: f64,
    /// The corrections on the finest grid, one after the other, root mean square over the nodes in mm.
    pub corrections: Vec<f64>,
    /// How the climb came to the field.
    pub provenance: Provenance,
}

/// A plate's grids, ready to correct at any stretch.
pub struct Climb<'a> {
    problem: &'a ClampedPlate,
    scheme: DifferenceScheme,
    settings: ClimbSettings,
    levels: Vec<Level>,
    multigrid: Multigrid,
    start: usize,
    ratios: Ratios,
    /// The smallest eigenvalue of the preconditioned operators found on the grids at this stretch.
    weakest: f64,
}

/// The name of the climb in messages.
const NAME: &str = "corrector (climb)";
/// Most unknowns of the coarsest grid: a factorisation solves those of 12 × 4 cells faster than coarser grids would.
const COARSEST: usize = 120;
/// Least number of nodes of the first grid, on which the springs are corrected, if the finest grid has as many.
const SPRINGS: usize = 30;
/// Number of linearisations of a grid's equation before the climb gives up.
const LINEARISATIONS: usize = 6;
/// The iteration's error on the first grid, relative to its first correction, where finer grids follow and where none does.
const START_TOLERANCE: f64 = 1e-3;
const ONLY_GRID_TOLERANCE: f64 = 1e-6;

impl<'a> Climb<'a> {
    /// Prepares the grids of a plate with `cells` equal cells.
    ///
    /// # Panics
    /// When the scheme takes cells together and their number is no multiple of that.
    pub fn even(
        problem: &'a ClampedPlate,
        cells: [usize; 2],
        scheme: DifferenceScheme,
        settings: ClimbSettings,
    ) -> Self {
        let boundaries = Grid::even(problem.size, elements(cells, scheme)).coordinates;
        Self::new(problem, boundaries, scheme, settings)
    }

    /// Prepares the grids of a plate with `cells` cells that become smaller towards the corners, where the field is
    /// singular; see [`mesh::Grid`](crate::mesh::Grid) and [`DifferenceScheme::grading`].
    ///
    /// # Panics
    /// When the scheme takes cells together and their number is no multiple of that, or the grading is below 1.
    pub fn graded(
        problem: &'a ClampedPlate,
        cells: [usize; 2],
        scheme: DifferenceScheme,
        grading: f64,
        settings: ClimbSettings,
    ) -> Self {
        assert!(grading >= 1.0, "a grading of {grading}");
        if grading == 1.0 {
            return Self::even(problem, cells, scheme, settings);
        }
        let boundaries = Grid::graded(problem.size, elements(cells, scheme), grading).coordinates;
        Self {
            ratios: Ratios::of_graded(scheme, grading),
            ..Self::new(problem, boundaries, scheme, settings)
        }
    }

    /// Prepares the grids of a plate between the given coordinates of element boundaries along X and Y, which
    /// begin at zero and end at the plate's size.
    pub fn new(
        problem: &'a ClampedPlate,
        boundaries: [Vec<f64>; 2],
        scheme: DifferenceScheme,
        settings: ClimbSettings,
    ) -> Self {
        let mut all = vec![boundaries];
        while let Some(coarser) = coarser(&all[all.len() - 1], scheme) {
            all.push(coarser);
        }
        let grids: Vec<Grid> = all
            .iter()
            .rev()
            .map(|[x, y]| Grid::new([x, y], scheme.side()))
            .collect();
        let start = grids.iter().position(|grid| grid.nodes() >= SPRINGS);
        let coordinates: Vec<_> = grids.iter().map(|grid| grid.coordinates.clone()).collect();
        let levels: Vec<Level> = (0..grids.len())
            .map(|index| Level::new(&grids[..=index]))
            .collect();
        Self {
            problem,
            scheme,
            settings,
            multigrid: Multigrid::new(&coordinates),
            start: start.unwrap_or(levels.len() - 1),
            ratios: Ratios::MEASURED,
            weakest: 1.0,
            levels,
        }
    }

    /// The finest grid.
    pub fn grid(&self) -> &Grid {
        &self.levels[self.levels.len() - 1].grid
    }

    /// Corrects at one stretch.
    ///
    /// # Errors
    /// [`Error::Solve`] when no field was found.
    pub fn correct(&mut self, stretch: f64) -> Result<ClimbSolution, Error> {
        check_memory(&*self.problem.law, "the climb")?;
        self.weakest = 1.0;
        let first = self.first_field(stretch)?;
        self.ascend(first, stretch)
    }

    fn sheet(&self) -> Sheet<'a> {
        Sheet {
            law: &*self.problem.law,
            thickness: self.problem.thickness,
            scheme: self.scheme,
        }
    }

    /// Linearises a grid's equation and iterates; repeats both until the iteration converges.
    fn solve(
        &mut self,
        index: usize,
        field: &mut Field,
        enough: &dyn Fn(f64, f64) -> bool,
    ) -> Result<CorrectionHistory, SolveFault> {
        let (sheet, most) = (self.sheet(), self.settings.max_iterations);
        let mut history: Option<CorrectionHistory> = None;
        self.check_operators()?;
        for _ in 0..LINEARISATIONS {
            let level = &mut self.levels[index];
            level.linearise(sheet, field, &mut self.multigrid)?;
            let first = history.as_ref().map(CorrectionHistory::first);
            let ending = Ending {
                most,
                weakest: self.weakest,
                enough: &|first_here, remaining_error| {
                    enough(first.unwrap_or(first_here), remaining_error)
                },
            };
            let mut reached = level.iterate(sheet, field, &mut self.multigrid, &ending)?;
            if let Some(history) = history.take() {
                reached = history.followed_by(reached);
            }
            if enough(reached.first(), reached.remaining_error()) {
                return Ok(reached);
            }
            history = Some(reached);
        }
        Err(SolveFault::Stalled {
            iterations: LINEARISATIONS * most,
            residual: history.map_or(f64::NAN, |history| {
                history.remaining_error() / history.first()
            }),
            tolerance: self.settings.tolerance,
        })
    }

    /// Assembles the operators of a grid and of all coarser ones at a field on it.
    fn linearise_below(&mut self, index: usize, field: &Field) -> Result<(), SolveFault> {
        let sheet = self.sheet();
        let mut field = field.clone();
        for index in (0..=index).rev() {
            self.levels[index].linearise(sheet, &field, &mut self.multigrid)?;
            if index > 0 {
                field = field.onto(&self.levels[index].grid, &self.levels[index - 1].grid);
            }
        }
        let inverted = self.multigrid.factorise_coarsest();
        inverted.map_err(|fault| fault.or(SolveFault::NotPositiveDefinite))
    }

    /// Without a factor of the coarsest operator that was assembled last, no iteration is possible.
    fn check_operators(&self) -> Result<(), SolveFault> {
        let factorised = self.multigrid.is_factorised().then_some(());
        factorised.ok_or(SolveFault::NotPositiveDefinite)
    }

    /// F(u) in N at the nodes of the finest grid: the reactions at the grips; `None` where J is not positive.
    pub fn forces(&mut self, field: &Field) -> Option<&Field> {
        let sheet = self.sheet();
        let level = self.levels.last_mut()?;
        level.evaluate_residual(sheet, field).ok()?;
        Some(&level.residual)
    }

    /// The force on the moving grip in N: the virtual work of all forces in a uniform stretch.
    fn force(&mut self, field: &Field) -> Result<f64, Inverted> {
        let length = self.problem.size[0];
        let coordinates = self.grid().coordinates[0].clone();
        let forces = self.forces(field).ok_or(Inverted)?;
        let lines = forces.components[0]
            .chunks_exact(field.width)
            .zip(coordinates);
        Ok(lines
            .map(|(line, x)| x / length * line.iter().sum::<f64>())
            .sum())
    }
}

/// A fault of a model at one stretch.
pub(super) fn at_stretch(model: &'static str, stretch: f64) -> impl Fn(SolveFault) -> Error {
    move |fault| Error::Solve {
        model: model.into(),
        step: ClampedPlate::describe_step(stretch),
        fault,
    }
}

/// The number of elements along both axes for so many cells.
fn elements(cells: [usize; 2], scheme: DifferenceScheme) -> [usize; 2] {
    cells.map(|cells| {
        assert!(cells.is_multiple_of(scheme.side()), "cells taken together");
        cells / scheme.side()
    })
}

/// Boundaries of about half as many elements, along the axes on which elements are short; `None` where there are few.
fn coarser(boundaries: &[Vec<f64>; 2], scheme: DifferenceScheme) -> Option<[Vec<f64>; 2]> {
    let elements = boundaries.each_ref().map(|boundaries| boundaries.len() - 1);
    let cells = elements.map(|elements| elements * scheme.side());
    if 2 * (cells[0] - 1) * (cells[1] + 1) <= COARSEST {
        return None;
    }
    let length = |axis: usize| boundaries[axis][elements[axis]] / elements[axis] as f64;
    let longer = [0, 1].map(|axis| length(axis) > 1.6 * length(1 - axis));
    // At least two cells along X: a single cell has no node between the grips.
    let enough = [elements[0].div_ceil(2) * scheme.side() > 1, elements[1] > 1];
    let halve = [0, 1].map(|axis| !longer[axis] && elements[axis] > 1 && enough[axis]);
    if halve == [false, false] {
        return None;
    }
    Some([0, 1].map(|axis| {
        if halve[axis] {
            thin_out(&boundaries[axis])
        } else {
            boundaries[axis].clone()
        }
    }))
}

/// Every second one of some positions; where the number of intervals is odd, positions between them.
fn thin_out(coordinates: &[f64]) -> Vec<f64> {
    let fine = coordinates.len() - 1;
    let coarse = fine.div_ceil(2);
    let at = |index: usize| {
        let position = (index * fine) as f64 / coarse as f64;
        let before = (position as usize).min(fine - 1);
        let share = position - before as f64;
        coordinates[before] + share * (coordinates[before + 1] - coordinates[before])
    };
    (0..=coarse).map(at).collect()
}
