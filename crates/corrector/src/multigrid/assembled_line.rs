//! One line of a grid's operator, put together from the cells on both sides.

use pulp::NullaryFnOnce;

use super::line::INVERSE;

/// P₁₁, P₁₂, P₂₂, Q₁₁, Q₁₂, Q₂₂, R₁₁, R₁₂, R₂₁, R₂₂ of the cells of one column, with a cell of no stiffness at either end.
#[derive(Clone, Debug)]
pub struct CellStiffness(pub [Vec<f32>; 10]);

impl CellStiffness {
    /// Zeros for a column of so many cells.
    pub fn zeros(cells: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; cells + 2]))
    }
}

/// Puts a line together from the cells on both sides.
pub struct AssembleLine<'a> {
    pub left: &'a CellStiffness,
    pub right: &'a CellStiffness,
    pub target: &'a mut [f32],
    pub stride: usize,
    pub nodes: usize,
}

impl NullaryFnOnce for AssembleLine<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            left,
            right,
            target,
            stride,
            nodes,
        } = self;
        let adjacent = AdjacentColumns { left, right, nodes };
        let mut arrays = target.chunks_exact_mut(stride);
        let mut next = || &mut arrays.next().expect("an array a coefficient")[1..=nodes];
        for numbers in SYMMETRIC {
            adjacent.diagonal(numbers, next());
        }
        for numbers in FULL {
            adjacent.north(numbers, next());
        }
        for numbers in FULL {
            adjacent.east(numbers, next());
        }
        for above in [true, false] {
            for numbers in SYMMETRIC {
                adjacent.corner(numbers, above, next());
            }
        }
        invert(target, stride, nodes);
    }
}

/// Numbers of P, Q, R and Rᵀ in [`CellStiffness`] for each coefficient of a symmetric block, and of any block.
const SYMMETRIC: [[usize; 4]; 3] = [[0, 3, 6, 6], [1, 4, 7, 8], [2, 5, 9, 9]];
const FULL: [[usize; 4]; 4] = [[0, 3, 6, 6], [1, 4, 7, 8], [1, 4, 8, 7], [2, 5, 9, 9]];
const THIRD: f32 = 1.0 / 3.0;
const SIXTH: f32 = 1.0 / 6.0;

/// The columns of cells on both sides of a line.
struct AdjacentColumns<'a> {
    left: &'a CellStiffness,
    right: &'a CellStiffness,
    nodes: usize,
}

impl<'a> AdjacentColumns<'a> {
    /// A number of the four cells around each node: below and above it on the left, then on the right. Of the cells beside
    /// node j, cell j lies below it and cell j + 1 above it.
    #[inline(always)]
    fn around(&self, k: usize) -> [&'a [f32]; 4] {
        let (left, right) = (&self.left.0[k], &self.right.0[k]);
        [
            &left[..self.nodes],
            &left[1..=self.nodes],
            &right[..self.nodes],
            &right[1..=self.nodes],
        ]
    }

    /// The block of a node with itself, symmetric: Σ (P + Q)/3 + s (R + Rᵀ), s = sx sy.
    #[inline(always)]
    fn diagonal(&self, [p, q, r, t]: [usize; 4], out: &mut [f32]) {
        let [pa, pb, pc, pd] = self.around(p);
        let [qa, qb, qc, qd] = self.around(q);
        let [ra, rb, rc, rd] = self.around(r);
        let [ta, tb, tc, td] = self.around(t);
        for j in 0..self.nodes {
            let both = (pa[j] + pb[j]) + (pc[j] + pd[j]) + (qa[j] + qb[j]) + (qc[j] + qd[j]);
            let mixed = (ra[j] - rb[j]) - (rc[j] - rd[j]) + ((ta[j] - tb[j]) - (tc[j] - td[j]));
            out[j] = THIRD * both + mixed;
        }
    }

    /// N: P/6 − Q/3, and −R + Rᵀ of the cell to the right, R − Rᵀ of that to the left.
    #[inline(always)]
    fn north(&self, [p, q, r, t]: [usize; 4], out: &mut [f32]) {
        let [_, pb, _, pd] = self.around(p);
        let [_, qb, _, qd] = self.around(q);
        let [_, rb, _, rd] = self.around(r);
        let [_, tb, _, td] = self.around(t);
        for j in 0..self.nodes {
            let mixed = (rb[j] - tb[j]) - (rd[j] - td[j]);
            out[j] = SIXTH * (pb[j] + pd[j]) - THIRD * (qb[j] + qd[j]) + mixed;
        }
    }

    /// E: −P/3 + Q/6, and R − Rᵀ of the cell above, −R + Rᵀ of that below.
    #[inline(always)]
    fn east(&self, [p, q, r, t]: [usize; 4], out: &mut [f32]) {
        let [[_, _, pc, pd], [_, _, qc, qd]] = [p, q].map(|k| self.around(k));
        let [[_, _, rc, rd], [_, _, tc, td]] = [r, t].map(|k| self.around(k));
        for j in 0..self.nodes {
            let mixed = (rd[j] - td[j]) - (rc[j] - tc[j]);
            out[j] = SIXTH * (qc[j] + qd[j]) - THIRD * (pc[j] + pd[j]) + mixed;
        }
    }

    /// NE: −(P + Q)/6 − (R + Rᵀ) of the cell above; SE: −(P + Q)/6 + (R + Rᵀ) of that below.
    #[inline(always)]
    fn corner(&self, numbers: [usize; 4], above: bool, out: &mut [f32]) {
        let pick = |k: usize| {
            let [.., below, over] = self.around(k);
            if above { over } else { below }
        };
        let [p, q, r, t] = numbers.map(pick);
        let sign = if above { -1.0 } else { 1.0 };
        for j in 0..self.nodes {
            out[j] = sign * (r[j] + t[j]) - SIXTH * (p[j] + q[j]);
        }
    }
}

/// The inverse of the block of each node with itself, behind the blocks.
#[inline(always)]
fn invert(target: &mut [f32], stride: usize, nodes: usize) {
    let (blocks, inverses) = target.split_at_mut(INVERSE[0] * stride);
    let diagonal = |k: usize| &blocks[k * stride + 1..][..nodes];
    let (a, b, c) = (diagonal(0), diagonal(1), diagonal(2));
    let mut arrays = inverses.chunks_exact_mut(stride);
    let mut next = || &mut arrays.next().expect("three arrays")[1..=nodes];
    let (first, second, third) = (next(), next(), next());
    for j in 0..nodes {
        let inverse = 1.0 / (a[j] * c[j] - b[j] * b[j]);
        first[j] = c[j] * inverse;
        second[j] = -b[j] * inverse;
        third[j] = a[j] * inverse;
    }
}
