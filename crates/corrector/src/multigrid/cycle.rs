//! The V-cycle.

use super::coarsest::Factor;
use super::stencil::{Stencil, Sweep};
use super::strip::LineSmoother;
use super::transfer::Transfer;
use super::vector::{Lines, Vector};
use crate::solve::FactorFault;

/// One grid with its operator and the vectors of a cycle.
#[derive(Debug)]
struct Level {
    /// To the next coarser grid; none on the coarsest.
    transfer: Option<Transfer>,
    stencil: Stencil,
    lines: LineSmoother,
    x: Vector,
    b: Vector,
    r: Vector,
}

/// Grids from coarse to fine, whose V-cycle is a symmetric approximate inverse.
pub struct Multigrid {
    levels: Vec<Level>,
    coarsest: Option<Factor>,
}

impl Multigrid {
    /// Grids with the given coordinates along X and Y, coarse to fine; their operators are written later.
    pub fn new(grids: &[[Vec<f64>; 2]]) -> Self {
        let level = |index: usize| {
            let grid = &grids[index];
            let lines = Lines {
                count: grid[0].len(),
                nodes: grid[1].len(),
            };
            let coarser = index.checked_sub(1);
            Level {
                transfer: coarser.map(|coarser| Transfer::new(&grids[coarser], grid)),
                stencil: Stencil::zeros(lines),
                lines: LineSmoother::new(grid),
                x: Vector::zeros(lines),
                b: Vector::zeros(lines),
                r: Vector::zeros(lines),
            }
        };
        Self {
            levels: (0..grids.len()).map(level).collect(),
            coarsest: None,
        }
    }

    /// The operator of a grid, to be written.
    pub fn stencil(&mut self, level: usize) -> &mut Stencil {
        let level = &mut self.levels[level];
        level.lines.forget();
        &mut level.stencil
    }

    /// Factorises the operator of the coarsest grid, which has been written.
    ///
    /// # Errors
    /// [`FactorFault`] when it has none.
    pub fn factorise_coarsest(&mut self) -> Result<(), FactorFault> {
        self.coarsest = None;
        self.coarsest = Some(Factor::of(&self.levels[0].stencil)?);
        Ok(())
    }

    /// Whether the coarsest operator has a factor: without it there is no cycle.
    pub fn is_factorised(&self) -> bool {
        self.coarsest.is_some()
    }

    /// The right-hand side of a grid, to be written.
    pub fn right_hand_side(&mut self, level: usize) -> &mut Vector {
        &mut self.levels[level].b
    }

    /// One V-cycle from zero on a grid and all coarser ones; the result.
    ///
    /// # Panics
    /// Where the coarsest operator has no factor, see [`Self::is_factorised`].
    pub fn cycle(&mut self, level: usize) -> &Vector {
        self.descend(level);
        &self.levels[level].x
    }

    fn descend(&mut self, index: usize) {
        let (coarser, finer) = self.levels.split_at_mut(index);
        let level = &mut finer[0];
        let (Some(transfer), Some(below)) = (&level.transfer, coarser.last_mut()) else {
            let factor = self.coarsest.as_mut();
            let factor = factor.expect("the coarsest grid has a factor");
            factor.solve(&level.b, &mut level.x);
            return;
        };
        level.x.clear();
        let is_held = |line| level.lines.holds(line);
        (level.stencil).smooth(&mut level.x, &level.b, is_held, Sweep::DownFromZero);
        level.lines.factorise(&level.stencil);
        (level.lines).smooth(&level.stencil, &mut level.x, &level.b, false);
        level.stencil.residual(&level.x, &level.b, &mut level.r);
        transfer.restrict(&level.r, &mut below.b);
        self.descend(index - 1);
        let (coarser, finer) = self.levels.split_at_mut(index);
        let level = &mut finer[0];
        if let Some(transfer) = &level.transfer {
            transfer.prolong(&coarser[index - 1].x, &mut level.x);
        }
        (level.lines).smooth(&level.stencil, &mut level.x, &level.b, true);
        let is_held = |line| level.lines.holds(line);
        level
            .stencil
            .smooth(&mut level.x, &level.b, is_held, Sweep::Up);
    }
}
