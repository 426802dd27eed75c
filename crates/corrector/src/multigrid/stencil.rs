//! The symmetric operator of a grid: nine blocks of 2 × 2 per node, of which five are kept.
//!
//! A block couples a node with itself, with the next one on its line (N), and with three on the line after
//! (E, NE, SE); the other four are transposes of the neighbours' blocks. The blocks come from the bilinear
//! functions of rectangular cells whose tangent A is constant:
//!
//! ```text
//! K = Σ_cells ∫ A_iJkL ∂φa/∂X_J ∂φb/∂X_L dV
//!   = Σ_cells P dx(a,b) my(a,b) + Q mx(a,b) dy(a,b) + R sx(a) sy(b) + Rᵀ sy(a) sx(b)
//! P = t A_i1k1 hy/hx,   Q = t A_i2k2 hx/hy,   R = ¼ t A_i1k2                                   [N/mm]
//! d = ±1, m = ⅓ or ⅙ for the same or different ends, s = ±1 according to the side of the cell
//! ```

use std::cell::RefCell;

use pulp::Arch;
use rayon::prelude::*;

use super::assembled_line::{AssembleLine, CellStiffness};
use super::line::{
    COEFFICIENTS, EAST, ITSELF, LineResidual, LineStencil, NORTH, NORTH_EAST, SOUTH_EAST,
    SmoothLine,
};
use super::vector::{Lines, Neighbours, Vector};

/// The order of a sweep over all lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// Odd lines, then even ones, from zero: the lines beside odd ones are still zero.
    DownFromZero,
    /// The reverse.
    Up,
}

/// The operator of a grid.
#[derive(Clone, Debug)]
pub struct Stencil {
    lines: Lines,
    coefficients: Vec<f32>,
}

impl Stencil {
    /// An operator without any coefficients yet.
    pub fn zeros(lines: Lines) -> Self {
        Self {
            lines,
            coefficients: vec![0.0; lines.count * COEFFICIENTS * lines.stride()],
        }
    }

    /// The grid's lines.
    pub fn lines(&self) -> Lines {
        self.lines
    }

    /// Puts all free lines together from the columns of cells on both sides of them; `column` writes the
    /// stiffness of a column. Whether `column` always succeeded.
    pub fn assemble(&mut self, column: impl Fn(usize, &mut CellStiffness) -> bool + Sync) -> bool {
        let lines = self.lines;
        let chunk = if lines.threaded() {
            (lines.count / 64).max(8)
        } else {
            lines.count
        };
        let size = COEFFICIENTS * lines.stride();
        let fill = |(index, coefficients): (usize, &mut [f32])| {
            let mut left = CellStiffness::zeros(lines.nodes - 1);
            let mut right = left.clone();
            let first = (index * chunk).max(1);
            let end = (index * chunk + chunk).min(lines.count - 1);
            if first >= end {
                return true;
            }
            let mut fine = column(first - 1, &mut left);
            for line in first..end {
                fine &= column(line, &mut right);
                let target = &mut coefficients[(line - index * chunk) * size..][..size];
                Arch::new().dispatch(AssembleLine {
                    left: &left,
                    right: &right,
                    target,
                    stride: lines.stride(),
                    nodes: lines.nodes,
                });
                std::mem::swap(&mut left, &mut right);
            }
            fine
        };
        if lines.threaded() {
            let chunks = self.coefficients.par_chunks_mut(chunk * size).enumerate();
            chunks.map(fill).reduce(|| true, |a, b| a & b)
        } else {
            fill((0, &mut self.coefficients))
        }
    }

    /// The coefficients of a line.
    pub fn line(&self, line: usize) -> LineStencil<'_> {
        let stride = self.lines.stride();
        LineStencil {
            coefficients: &self.coefficients[line * COEFFICIENTS * stride..]
                [..COEFFICIENTS * stride],
            stride,
        }
    }

    /// r = b − K x on all free lines.
    pub fn residual(&self, x: &Vector, b: &Vector, r: &mut Vector) {
        r.for_each_free_line(|line, r_x, r_y| {
            Arch::new().dispatch(LineResidual {
                before: self.line(line - 1),
                current: self.line(line),
                x: [x.line(line - 1), x.line(line), x.line(line + 1)],
                b: b.line(line),
                r_x,
                r_y,
            });
        });
    }

    /// One Gauss–Seidel sweep in four colours over all lines but those that are `left_out`: odd lines, then even ones, and on each
    /// odd nodes before even ones; the other way round where it goes `Up`.
    pub fn smooth(
        &self,
        x: &mut Vector,
        b: &Vector,
        left_out: impl Fn(usize) -> bool + Sync,
        sweep: Sweep,
    ) {
        let lines = self.lines;
        let down = sweep == Sweep::DownFromZero;
        for parity in if down { [1, 0] } else { [0, 1] } {
            x.for_each_of_parity(parity, |line, adjacent: Neighbours, x_x, x_y| {
                if left_out(line) {
                    return;
                }
                SCRATCH.with_borrow_mut(|scratch| {
                    for line in &mut *scratch {
                        line.resize(lines.padded(), 0.0);
                    }
                    Arch::new().dispatch(SmoothLine {
                        before: self.line(line - 1),
                        current: self.line(line),
                        adjacent: (!down || parity == 0)
                            .then(|| [adjacent.line(line - 1), adjacent.line(line + 1)]),
                        b: b.line(line),
                        x_x,
                        x_y,
                        scratch,
                        first: usize::from(down),
                    });
                });
            });
        }
    }

    /// The entry of the whole matrix for the coupling of two nodes [line, node] and two axes, for tests and for
    /// the coarsest grid; zero where they are no neighbours or `from` does not come first.
    pub fn block(&self, from: [usize; 2], to: [usize; 2]) -> Option<[[f32; 2]; 2]> {
        let c = |k: usize| self.line(from[0]).array(k)[from[1] + 1];
        let step = [
            to[0] as isize - from[0] as isize,
            to[1] as isize - from[1] as isize,
        ];
        let block = match step {
            [0, 0] => ITSELF,
            [0, 1] => NORTH,
            [1, 0] => EAST,
            [1, 1] => NORTH_EAST,
            [1, -1] => SOUTH_EAST,
            _ => return None,
        };
        let [a, b, d, e] = block.map(c);
        Some([[a, b], [d, e]])
    }
}

thread_local! {
    static SCRATCH: RefCell<[Vec<f32>; 2]> = const { RefCell::new([const { Vec::new() }; 2]) };
}
