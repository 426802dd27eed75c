//! Line relaxation where cells are long: strips of nodes that are close to each other along one axis are solved for as a whole
//! along it.
//!
//! A point smoother leaves errors that are smooth along the short sides of long cells only, and coarser grids with half as many
//! cells along both axes do not see them. Grids that are graded towards corners have such cells beside all of their sides:
//!
//! ```text
//! ┌┬─┬───┬─┬┐   lines along X are solved for in the columns beside the left and the right side,
//! ├┼─┼───┼─┼┤   lines along Y in the rows beside the bottom and the top
//! ├┼─┼───┼─┼┤
//! └┴─┴───┴─┴┘
//! ```
//!
//! On the lines of one colour, every second one (zebra), the [`tridiagonal`](super::tridiagonal) system that the strip leaves of K is
//! solved.
//!
//! # References
//! U. Trottenberg, C. Oosterlee, A. Schüller, Multigrid, Academic Press (2001), § 5.1

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use super::line::{COLOURS, LineStencil, residual, store};
use super::stencil::Stencil;
use super::tridiagonal::{FACTOR, Factorise, LANES, PAIR, substitute};
use super::vector::{Lines, Vector};

/// Cells whose sides differ by more than this factor are long: with more a cycle leaves more than half of some errors.
const LONG: f64 = 2.0;
/// Spacings that differ by less are equal.
const EQUAL: f64 = 1e-6;

/// Along which axis lines are solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    X,
    Y,
}

/// Neighbouring positions along an axis, on which lines along it are solved for.
#[derive(Clone, Debug)]
struct Strip {
    axis: Axis,
    range: Range<usize>,
    lines: Lines,
    factors: Vec<f32>,
    corrections: Vec<f32>,
}

/// The strips of a grid, in the order in which they are smoothed.
#[derive(Clone, Debug)]
pub struct LineSmoother {
    strips: Vec<Strip>,
    factorised: bool,
}

impl LineSmoother {
    /// The strips of a grid with the given coordinates along X and Y; none where all cells are equal: where these are long,
    /// coarser grids have half as many cells along their short sides alone.
    pub fn new(grid: &[Vec<f64>; 2]) -> Self {
        let lines = Lines {
            count: grid[0].len(),
            nodes: grid[1].len(),
        };
        let mut strips = Vec::new();
        if !grid.iter().all(|positions| is_even(positions)) {
            let [x, y] = grid.each_ref().map(|positions| spacings(positions));
            let along_x = close(&x, longest(&y), 1..lines.count - 1);
            let along_y = close(&y, longest(&x), 0..lines.nodes);
            for (axis, ranges) in [(Axis::X, along_x), (Axis::Y, along_y)] {
                strips.extend(
                    ranges
                        .into_iter()
                        .map(|range| Strip::new(axis, range, lines)),
                );
            }
        }
        Self {
            strips,
            factorised: false,
        }
    }

    /// The positions of the strips along X, then of those along Y.
    #[cfg(test)]
    pub fn ranges(&self) -> Vec<Range<usize>> {
        let ranges = self.strips.iter().map(|strip| strip.range.clone());
        ranges.collect()
    }

    /// Whether all nodes of a line of the grid are solved for on lines across it: they need no other smoother.
    pub fn holds(&self, line: usize) -> bool {
        let mut across = self.strips.iter().filter(|strip| strip.axis == Axis::X);
        across.any(|strip| strip.range.contains(&line))
    }

    /// Forgets the factors, because the operator is about to change.
    pub fn forget(&mut self) {
        self.factorised = false;
    }

    /// Factorises the lines' systems where that has not been done.
    pub fn factorise(&mut self, stencil: &Stencil) {
        if !self.factorised {
            self.strips
                .iter_mut()
                .for_each(|strip| strip.factorise(stencil));
            self.factorised = true;
        }
    }

    /// One sweep over all strips, odd lines before even ones; the other way round where `reversed`.
    pub fn smooth(&mut self, stencil: &Stencil, x: &mut Vector, b: &Vector, reversed: bool) {
        let mut colours = [1, 0];
        if reversed {
            self.strips.reverse();
            colours.reverse();
        }
        for strip in &mut self.strips {
            for colour in colours {
                strip.relax(stencil, x, b, colour);
            }
        }
        if reversed {
            self.strips.reverse();
        }
    }
}

fn spacings(positions: &[f64]) -> Vec<f64> {
    positions.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn longest(spacings: &[f64]) -> f64 {
    spacings.iter().copied().fold(0.0, f64::max)
}

/// Whether positions have equal distances.
pub fn is_even(positions: &[f64]) -> bool {
    let spacings = spacings(positions);
    let shortest = spacings.iter().copied().fold(f64::INFINITY, f64::min);
    longest(&spacings) <= (1.0 + EQUAL) * shortest
}

/// Runs of positions among some whose neighbours are close, as compared with the longest spacing along the other axis.
fn close(spacings: &[f64], other: f64, among: Range<usize>) -> Vec<Range<usize>> {
    let last = spacings.len() - 1;
    let is_close = |position: usize| {
        let shorter = spacings[position.saturating_sub(1)].min(spacings[position.min(last)]);
        LONG * shorter < other
    };
    let mut runs: Vec<Range<usize>> = Vec::new();
    for position in among.filter(|position| is_close(*position)) {
        match runs.last_mut() {
            Some(run) if run.end == position => run.end += 1,
            _ => runs.push(position..position + 1),
        }
    }
    runs
}

impl Strip {
    fn new(axis: Axis, range: Range<usize>, lines: Lines) -> Self {
        let batches = match axis {
            Axis::X => lines.padded() / LANES,
            Axis::Y => 2 * batches_of_lines(lines),
        };
        let positions = batches * range.len();
        let at_once = match axis {
            Axis::X => positions,
            Axis::Y => positions / 2,
        };
        Self {
            axis,
            range,
            lines,
            factors: vec![0.0; positions * FACTOR],
            corrections: vec![0.0; at_once * PAIR],
        }
    }

    /// The number of a line in a batch, and of a node on it, where it is free.
    fn free_line(&self, [parity, batch, lane]: [usize; 3]) -> Option<usize> {
        let line = 2 * (batch * LANES + lane) + parity;
        (line > 0 && line + 1 < self.lines.count).then_some(line)
    }

    fn factorise(&mut self, stencil: &Stencil) {
        let mut factors = std::mem::take(&mut self.factors);
        let size = self.range.len() * FACTOR;
        let factorise = |(batch, factors): (usize, &mut [f32])| {
            let positions = self.range.clone().zip(factors.chunks_exact_mut(FACTOR));
            positions
                .for_each(|(position, numbers)| self.gather(stencil, batch, position, numbers));
            Arch::new().dispatch(Factorise { factors });
        };
        self.lines.for_each_piece(&mut factors, size, factorise);
        self.factors = factors;
    }

    /// Writes Dₖ and Eₖ of a batch's lines at a position.
    fn gather(&self, stencil: &Stencil, batch: usize, position: usize, numbers: &mut [f32]) {
        let lanes = numbers.chunks_exact_mut(LANES);
        match self.axis {
            Axis::X => {
                let line_stencil = stencil.line(position);
                for (k, lanes) in [0, 1, 2, 7, 8, 9, 10].into_iter().zip(lanes) {
                    lanes.copy_from_slice(&line_stencil.array(k)[1 + batch * LANES..][..LANES]);
                }
            }
            Axis::Y => {
                let batches = batches_of_lines(self.lines);
                let (parity, batch) = (batch / batches, batch % batches);
                for (k, lanes) in [0, 1, 2, 3, 4, 5, 6].into_iter().zip(lanes) {
                    for (lane, number) in lanes.iter_mut().enumerate() {
                        let line = self.free_line([parity, batch, lane]);
                        *number =
                            line.map_or(0.0, |line| stencil.line(line).array(k)[position + 1]);
                    }
                }
            }
        }
    }

    /// Solves for the lines of one colour.
    fn relax(&mut self, stencil: &Stencil, x: &mut Vector, b: &Vector, colour: usize) {
        let mut corrections = std::mem::take(&mut self.corrections);
        let positions = self.range.len();
        let factors = match self.axis {
            Axis::X => &self.factors[..],
            Axis::Y => &self.factors[colour * self.factors.len() / 2..],
        };
        let solve = |(batch, corrections): (usize, &mut [f32])| {
            Arch::new().dispatch(Batch {
                strip: self,
                stencil,
                x,
                b,
                colour,
                batch,
                factors: &factors[batch * positions * FACTOR..][..positions * FACTOR],
                corrections,
            });
        };
        let size = positions * PAIR;
        self.lines.for_each_piece(&mut corrections, size, solve);
        self.add(&corrections, x, colour);
        self.corrections = corrections;
    }

    /// Adds the corrections of one colour.
    fn add(&self, corrections: &[f32], x: &mut Vector, colour: usize) {
        let positions = self.range.len();
        let start = self.range.start;
        match self.axis {
            Axis::X => x.for_each_free_line(|line, x_x, x_y| {
                if !self.range.contains(&line) {
                    return;
                }
                for (component, x) in [x_x, x_y].into_iter().enumerate() {
                    let batches = x[1..].chunks_exact_mut(LANES).enumerate();
                    for (batch, x) in batches {
                        let position = batch * positions + line - start;
                        let correction_of_line =
                            &corrections[(2 * position + component) * LANES..][..LANES];
                        for ((x, correction), correction_of_line) in
                            x.iter_mut().zip(correction_of_line).zip(&COLOURS[colour])
                        {
                            *x += correction_of_line * correction;
                        }
                    }
                }
            }),
            Axis::Y => x.for_each_of_parity(colour, |line, _, x_x, x_y| {
                let (batch, lane) = (line / 2 / LANES, line / 2 % LANES);
                for (component, x) in [x_x, x_y].into_iter().enumerate() {
                    let first = 2 * batch * positions + component;
                    let correction_of_line =
                        corrections[first * LANES + lane..].iter().step_by(PAIR);
                    let x = x[start + 1..=self.range.end].iter_mut();
                    x.zip(correction_of_line)
                        .for_each(|(x, correction)| *x += correction);
                }
            }),
        }
    }
}

/// Batches of lines of one parity.
fn batches_of_lines(lines: Lines) -> usize {
    lines.count.div_ceil(2).div_ceil(LANES)
}

/// The residual of a batch of lines, and the corrections that it asks for.
struct Batch<'a> {
    strip: &'a Strip,
    stencil: &'a Stencil,
    x: &'a Vector,
    b: &'a Vector,
    colour: usize,
    batch: usize,
    factors: &'a [f32],
    corrections: &'a mut [f32],
}

impl WithSimd for Batch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        match self.strip.axis {
            Axis::X => self.residual_along_x(simd),
            Axis::Y => self.residual_along_y(simd),
        }
        substitute(self.factors, self.corrections);
    }
}

impl Batch<'_> {
    /// b − K x of a line at the nodes that begin at a position.
    #[inline(always)]
    fn residual<S: Simd>(&self, simd: S, line: usize, position: usize) -> [S::f32s; 2] {
        let stencils: [LineStencil; 2] = [self.stencil.line(line - 1), self.stencil.line(line)];
        let x = [
            self.x.line(line - 1),
            self.x.line(line),
            self.x.line(line + 1),
        ];
        residual::<S>(simd, stencils, x, self.b.line(line), position)
    }

    #[inline(always)]
    fn residual_along_x<S: Simd>(&mut self, simd: S) {
        for (position, line) in self.strip.range.clone().enumerate() {
            for lane in (0..LANES).step_by(S::F32_LANES) {
                let r = self.residual(simd, line, self.batch * LANES + lane);
                for (component, r) in r.into_iter().enumerate() {
                    let target = (2 * position + component) * LANES + lane;
                    store::<S>(self.corrections, target, r);
                }
            }
        }
    }

    #[inline(always)]
    fn residual_along_y<S: Simd>(&mut self, simd: S) {
        let Range { start, end } = self.strip.range.clone();
        for lane in 0..LANES {
            let Some(line) = self.strip.free_line([self.colour, self.batch, lane]) else {
                continue;
            };
            for first in (start / LANES * LANES..end).step_by(S::F32_LANES) {
                let mut nodes = [[0.0; LANES]; 2];
                let r = self.residual(simd, line, first);
                for (nodes, r) in nodes.iter_mut().zip(r) {
                    store::<S>(nodes, 0, r);
                }
                for node in first.max(start)..(first + S::F32_LANES).min(end) {
                    let target = 2 * (node - start) * LANES + lane;
                    self.corrections[target] = nodes[0][node - first];
                    self.corrections[target + LANES] = nodes[1][node - first];
                }
            }
        }
    }
}
