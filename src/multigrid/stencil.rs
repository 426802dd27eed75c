//! The symmetric operator of a grid: nine blocks of 2 × 2 a node, of which five are kept.
//!
//! A block couples a node with itself, with the next one on its line (N), and with three on the line after
//! (E, NE, SE); the other four are transposes of the neighbours' blocks. The blocks come from the bilinear
//! functions of rectangular cells whose tangent A is constant:
//!
//! ```text
//! K = Σ_cells ∫ A_iJkL ∂φa/∂X_J ∂φb/∂X_L dV
//!   = Σ_cells P dx(a,b) my(a,b) + Q mx(a,b) dy(a,b) + R sx(a) sy(b) + Rᵀ sy(a) sx(b)
//! P = t A_i1k1 hy/hx,   Q = t A_i2k2 hx/hy,   R = ¼ t A_i1k2                                   [N/mm]
//! d = ±1, m = ⅓ or ⅙ for the same and for different ends, s = ±1 by the side of the cell
//! ```

use std::cell::RefCell;

use pulp::{Arch, NullaryFnOnce, Simd, WithSimd};
use rayon::prelude::*;

use super::vector::{Lines, Neighbours, Pair, Vector};

/// Coefficients kept for a node: the blocks, and the inverse of its own block.
const COEFFICIENTS: usize = 20;

/// P₁₁, P₁₂, P₂₂, Q₁₁, Q₁₂, Q₂₂, R₁₁, R₁₂, R₂₁, R₂₂ of the cells of one column, with a cell of no stiffness at
/// either end.
#[derive(Clone, Debug)]
pub struct CellStiffness(pub [Vec<f32>; 10]);

impl CellStiffness {
    /// Zeros for a column of so many cells.
    pub fn zeros(cells: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; cells + 2]))
    }
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
        let chunk = match lines.threaded() {
            true => (lines.count / 64).max(8),
            false => lines.count,
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

    fn line(&self, line: usize) -> LineStencil<'_> {
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
                own: self.line(line),
                x: [x.line(line - 1), x.line(line), x.line(line + 1)],
                b: b.line(line),
                r_x,
                r_y,
            });
        });
    }

    /// One Gauss–Seidel sweep in four colours: odd lines, then even ones, and on each odd nodes before even
    /// ones; the other way round where `reversed`.
    pub fn smooth(&self, x: &mut Vector, b: &Vector, reversed: bool) {
        let lines = self.lines;
        for parity in if reversed { [0, 1] } else { [1, 0] } {
            x.for_each_of_parity(parity, |line, beside: Neighbours, x_x, x_y| {
                SCRATCH.with_borrow_mut(|scratch| {
                    for line in &mut *scratch {
                        line.resize(lines.padded(), 0.0);
                    }
                    Arch::new().dispatch(SmoothLine {
                        before: self.line(line - 1),
                        own: self.line(line),
                        beside: [beside.line(line - 1), beside.line(line + 1)],
                        b: b.line(line),
                        x_x,
                        x_y,
                        scratch,
                        first: usize::from(!reversed),
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
        match step {
            [0, 0] => Some([[c(0), c(1)], [c(1), c(2)]]),
            [0, 1] => Some([[c(3), c(4)], [c(5), c(6)]]),
            [1, 0] => Some([[c(7), c(8)], [c(9), c(10)]]),
            [1, 1] => Some([[c(11), c(12)], [c(12), c(13)]]),
            [1, -1] => Some([[c(14), c(15)], [c(15), c(16)]]),
            _ => None,
        }
    }
}

/// The coefficients of one line: own block 0–2, N 3–6, E 7–10, NE 11–13, SE 14–16, inverse of the own block 17–19.
#[derive(Clone, Copy)]
struct LineStencil<'a> {
    coefficients: &'a [f32],
    stride: usize,
}

impl<'a> LineStencil<'a> {
    #[inline(always)]
    fn array(&self, k: usize) -> &'a [f32] {
        &self.coefficients[k * self.stride..][..self.stride]
    }

    /// The coefficients of a block, row by row, of the nodes of a vector.
    #[inline(always)]
    fn block<S: Simd>(&self, [a, b, c, d]: [usize; 4], place: usize) -> [S::f32s; 4] {
        [
            load::<S>(self.array(a), place),
            load::<S>(self.array(b), place),
            load::<S>(self.array(c), place),
            load::<S>(self.array(d), place),
        ]
    }
}

struct AssembleLine<'a> {
    left: &'a CellStiffness,
    right: &'a CellStiffness,
    target: &'a mut [f32],
    stride: usize,
    nodes: usize,
}

impl NullaryFnOnce for AssembleLine<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        const THIRD: f32 = 1.0 / 3.0;
        const SIXTH: f32 = 1.0 / 6.0;
        let nodes = self.nodes;
        let mut arrays = self.target.chunks_exact_mut(self.stride);
        let mut next = || &mut arrays.next().expect("an array a coefficient")[1..=nodes];
        // Of the cells beside node j, cell j lies below it and cell j + 1 above it.
        let left = |k: usize| (&self.left.0[k][..nodes], &self.left.0[k][1..=nodes]);
        let right = |k: usize| (&self.right.0[k][..nodes], &self.right.0[k][1..=nodes]);
        // Own block, symmetric: Σ (P + Q)/3 + s (R + Rᵀ), s = sx sy.
        for (p, q, r, t) in [(0, 3, 6, 6), (1, 4, 7, 8), (2, 5, 9, 9)] {
            let out = next();
            let ((pa, pb), (pc, pd)) = (left(p), right(p));
            let ((qa, qb), (qc, qd)) = (left(q), right(q));
            let ((ra, rb), (rc, rd)) = (left(r), right(r));
            let ((ta, tb), (tc, td)) = (left(t), right(t));
            for j in 0..nodes {
                let both = (pa[j] + pb[j]) + (pc[j] + pd[j]) + (qa[j] + qb[j]) + (qc[j] + qd[j]);
                let mixed = (ra[j] - rb[j]) - (rc[j] - rd[j]) + ((ta[j] - tb[j]) - (tc[j] - td[j]));
                out[j] = THIRD * both + mixed;
            }
        }
        // N: P/6 − Q/3, and −R + Rᵀ of the cell to the right, R − Rᵀ of that to the left.
        for (p, q, r, t) in [(0, 3, 6, 6), (1, 4, 7, 8), (1, 4, 8, 7), (2, 5, 9, 9)] {
            let out = next();
            let ((_, pb), (_, pd)) = (left(p), right(p));
            let ((_, qb), (_, qd)) = (left(q), right(q));
            let ((_, rb), (_, rd)) = (left(r), right(r));
            let ((_, tb), (_, td)) = (left(t), right(t));
            for j in 0..nodes {
                let mixed = (rb[j] - tb[j]) - (rd[j] - td[j]);
                out[j] = SIXTH * (pb[j] + pd[j]) - THIRD * (qb[j] + qd[j]) + mixed;
            }
        }
        // E: −P/3 + Q/6, and R − Rᵀ of the cell above, −R + Rᵀ of that below.
        for (p, q, r, t) in [(0, 3, 6, 6), (1, 4, 7, 8), (1, 4, 8, 7), (2, 5, 9, 9)] {
            let out = next();
            let ((pc, pd), (qc, qd)) = (right(p), right(q));
            let ((rc, rd), (tc, td)) = (right(r), right(t));
            for j in 0..nodes {
                let mixed = (rd[j] - td[j]) - (rc[j] - tc[j]);
                out[j] = SIXTH * (qc[j] + qd[j]) - THIRD * (pc[j] + pd[j]) + mixed;
            }
        }
        // NE: −(P + Q)/6 − (R + Rᵀ) of the cell above; SE: −(P + Q)/6 + (R + Rᵀ) of that below.
        for above in [true, false] {
            for (p, q, r, t) in [(0, 3, 6, 6), (1, 4, 7, 8), (2, 5, 9, 9)] {
                let out = next();
                let pick = |k: usize| if above { right(k).1 } else { right(k).0 };
                let (p, q, r, t) = (pick(p), pick(q), pick(r), pick(t));
                let sign = if above { -1.0 } else { 1.0 };
                for j in 0..nodes {
                    out[j] = sign * (r[j] + t[j]) - SIXTH * (p[j] + q[j]);
                }
            }
        }
        let (blocks, inverses) = self.target.split_at_mut(17 * self.stride);
        let own = |k: usize| &blocks[k * self.stride + 1..][..nodes];
        let (a, b, c) = (own(0), own(1), own(2));
        let (first, rest) = inverses.split_at_mut(self.stride);
        let (second, third) = rest.split_at_mut(self.stride);
        let (first, second, third) = (
            &mut first[1..=nodes],
            &mut second[1..=nodes],
            &mut third[1..=nodes],
        );
        for j in 0..nodes {
            let inverse = 1.0 / (a[j] * c[j] - b[j] * b[j]);
            first[j] = c[j] * inverse;
            second[j] = -b[j] * inverse;
            third[j] = a[j] * inverse;
        }
    }
}

/// The numbers of a vector that begin at a place.
#[inline(always)]
fn load<S: Simd>(numbers: &[f32], place: usize) -> S::f32s {
    S::as_simd_f32s(&numbers[place..place + S::F32_LANES]).0[0]
}

#[inline(always)]
fn store<S: Simd>(numbers: &mut [f32], place: usize, vector: S::f32s) {
    S::as_mut_simd_f32s(&mut numbers[place..place + S::F32_LANES]).0[0] = vector;
}

/// The part of both lines of a pair that begins at a place.
#[inline(always)]
fn load_pair<S: Simd>(pair: Pair, place: usize) -> [S::f32s; 2] {
    [load::<S>(pair[0], place), load::<S>(pair[1], place)]
}

/// a x + b y.
#[inline(always)]
fn combine<S: Simd>(simd: S, [a, b]: [S::f32s; 2], [x, y]: [S::f32s; 2]) -> S::f32s {
    simd.add_f32s(simd.mul_f32s(a, x), simd.mul_f32s(b, y))
}

/// r − A x for a block A = [a b; c d].
#[inline(always)]
fn subtract<S: Simd>(
    simd: S,
    r: [S::f32s; 2],
    [a, b, c, d]: [S::f32s; 4],
    x: [S::f32s; 2],
) -> [S::f32s; 2] {
    [
        simd.sub_f32s(r[0], combine(simd, [a, b], x)),
        simd.sub_f32s(r[1], combine(simd, [c, d], x)),
    ]
}

/// r less the part of K x that comes from the lines before and after, at the vector that begins at a place.
#[inline(always)]
fn subtract_beside<S: Simd>(
    simd: S,
    r: [S::f32s; 2],
    [before, own]: [LineStencil; 2],
    [left, right]: [Pair; 2],
    place: usize,
) -> [S::f32s; 2] {
    let middle = place + 1;
    let r = subtract(
        simd,
        r,
        own.block::<S>([7, 8, 9, 10], middle),
        load_pair::<S>(right, middle),
    );
    let r = subtract(
        simd,
        r,
        own.block::<S>([11, 12, 12, 13], middle),
        load_pair::<S>(right, place + 2),
    );
    let r = subtract(
        simd,
        r,
        own.block::<S>([14, 15, 15, 16], middle),
        load_pair::<S>(right, place),
    );
    let r = subtract(
        simd,
        r,
        before.block::<S>([7, 9, 8, 10], middle),
        load_pair::<S>(left, middle),
    );
    let r = subtract(
        simd,
        r,
        before.block::<S>([11, 12, 12, 13], place),
        load_pair::<S>(left, place),
    );
    subtract(
        simd,
        r,
        before.block::<S>([14, 15, 15, 16], place + 2),
        load_pair::<S>(left, place + 2),
    )
}

/// r less the part of K x that comes from the neighbours on the line itself.
#[inline(always)]
fn subtract_along<S: Simd>(
    simd: S,
    r: [S::f32s; 2],
    own: LineStencil,
    x: Pair,
    place: usize,
) -> [S::f32s; 2] {
    let r = subtract(
        simd,
        r,
        own.block::<S>([3, 4, 5, 6], place + 1),
        load_pair::<S>(x, place + 2),
    );
    subtract(
        simd,
        r,
        own.block::<S>([3, 5, 4, 6], place),
        load_pair::<S>(x, place),
    )
}

struct LineResidual<'a> {
    before: LineStencil<'a>,
    own: LineStencil<'a>,
    x: [Pair<'a>; 3],
    b: Pair<'a>,
    r_x: &'a mut [f32],
    r_y: &'a mut [f32],
}

impl WithSimd for LineResidual<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let [left, own, right] = self.x;
        for place in (0..self.r_x.len() - 2).step_by(S::F32_LANES) {
            let middle = place + 1;
            let b = load_pair::<S>(self.b, middle);
            let r = subtract_beside(simd, b, [self.before, self.own], [left, right], place);
            let r = subtract_along(simd, r, self.own, own, place);
            let block = self.own.block::<S>([0, 1, 1, 2], middle);
            let [r_x, r_y] = subtract(simd, r, block, load_pair::<S>(own, middle));
            store::<S>(self.r_x, middle, r_x);
            store::<S>(self.r_y, middle, r_y);
        }
    }
}

struct SmoothLine<'a> {
    before: LineStencil<'a>,
    own: LineStencil<'a>,
    beside: [Pair<'a>; 2],
    b: Pair<'a>,
    x_x: &'a mut [f32],
    x_y: &'a mut [f32],
    scratch: &'a mut [Vec<f32>; 4],
    /// The place in a line at which the nodes of the first colour begin.
    first: usize,
}

impl WithSimd for SmoothLine<'_> {
    type Output = ();

    /// Both colours are solved for at all nodes and taken over at their own: twice the arithmetic, but in
    /// vectors.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let nodes = self.x_x.len() - 2;
        let [g_x, g_y, t_x, t_y] = self.scratch;
        for place in (0..nodes).step_by(S::F32_LANES) {
            let b = load_pair::<S>(self.b, place + 1);
            let [x, y] = subtract_beside(simd, b, [self.before, self.own], self.beside, place);
            store::<S>(g_x, place, x);
            store::<S>(g_y, place, y);
        }
        for colour in [self.first, 1 - self.first] {
            for place in (0..nodes).step_by(S::F32_LANES) {
                let g = [load::<S>(g_x, place), load::<S>(g_y, place)];
                let r = subtract_along(simd, g, self.own, [self.x_x, self.x_y], place);
                let [a, b, c, d] = self.own.block::<S>([17, 18, 18, 19], place + 1);
                store::<S>(t_x, place, combine(simd, [a, b], r));
                store::<S>(t_y, place, combine(simd, [c, d], r));
            }
            for (x, t) in [(&mut *self.x_x, &*t_x), (&mut *self.x_y, &*t_y)] {
                let own = x[1 + colour..=nodes].iter_mut().step_by(2);
                let new = t[colour..nodes].iter().step_by(2);
                own.zip(new).for_each(|(x, t)| *x = *t);
            }
        }
    }
}

thread_local! {
    static SCRATCH: RefCell<[Vec<f32>; 4]> = const { RefCell::new([const { Vec::new() }; 4]) };
}
