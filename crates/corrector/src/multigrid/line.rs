//! One line of a grid's operator: its coefficients, its residual and its smoothing in vectors of numbers.

use pulp::{Simd, WithSimd};

use super::vector::{Pair, VECTOR};

// Where the coefficients of a node stand: the block of the node with itself, and those with the neighbours that come after
// it, row by row.

/// Couples a node with itself; symmetric.
pub const ITSELF: [usize; 4] = [0, 1, 1, 2];
/// Couples a node with the next one of its line.
pub const NORTH: [usize; 4] = [3, 4, 5, 6];
/// Couples a node with its neighbour on the next line.
pub const EAST: [usize; 4] = [7, 8, 9, 10];
/// Couples a node with the one after its neighbour on the next line; symmetric.
pub const NORTH_EAST: [usize; 4] = [11, 12, 12, 13];
/// Couples a node with the one before its neighbour on the next line; symmetric.
pub const SOUTH_EAST: [usize; 4] = [14, 15, 15, 16];
/// The inverse of the block that couples a node with itself; symmetric.
pub const INVERSE: [usize; 4] = [17, 18, 18, 19];

/// Coefficients kept for a node.
pub const COEFFICIENTS: usize = 20;

/// The block that couples the neighbour with the node.
const fn transposed([a, b, c, d]: [usize; 4]) -> [usize; 4] {
    [a, c, b, d]
}

/// The coefficients of one line.
#[derive(Clone, Copy)]
pub struct LineStencil<'a> {
    pub coefficients: &'a [f32],
    pub stride: usize,
}

impl<'a> LineStencil<'a> {
    /// A coefficient of all nodes.
    #[inline(always)]
    pub fn array(&self, k: usize) -> &'a [f32] {
        &self.coefficients[k * self.stride..][..self.stride]
    }

    /// The coefficients of a block, row by row, of the nodes of a vector.
    #[inline(always)]
    fn block<S: Simd>(&self, [a, b, c, d]: [usize; 4], position: usize) -> [S::f32s; 4] {
        [
            load::<S>(self.array(a), position),
            load::<S>(self.array(b), position),
            load::<S>(self.array(c), position),
            load::<S>(self.array(d), position),
        ]
    }
}

/// The numbers of a vector that begin at a position.
#[inline(always)]
fn load<S: Simd>(numbers: &[f32], position: usize) -> S::f32s {
    S::as_simd_f32s(&numbers[position..position + S::F32_LANES]).0[0]
}

/// Writes a vector of numbers at a position.
#[inline(always)]
pub fn store<S: Simd>(numbers: &mut [f32], position: usize, vector: S::f32s) {
    S::as_mut_simd_f32s(&mut numbers[position..position + S::F32_LANES]).0[0] = vector;
}

/// The part of both lines of a pair that begins at a position.
#[inline(always)]
fn load_pair<S: Simd>(pair: Pair, position: usize) -> [S::f32s; 2] {
    [load::<S>(pair[0], position), load::<S>(pair[1], position)]
}

/// a x + b y.
#[inline(always)]
fn combine<S: Simd>(simd: S, [a, b]: [S::f32s; 2], [x, y]: [S::f32s; 2]) -> S::f32s {
    simd.mul_add_e_f32s(b, y, simd.mul_f32s(a, x))
}

/// r − A x for a block A = [a b; c d] of a line, at the nodes of a vector that begins at a position, and x at those that begin at another one.
#[inline(always)]
fn subtract<S: Simd>(
    simd: S,
    r: [S::f32s; 2],
    (line, block): (LineStencil, [usize; 4]),
    x: Pair,
    [node, neighbour]: [usize; 2],
) -> [S::f32s; 2] {
    let [a, b, c, d] = line.block::<S>(block, node);
    let x = load_pair::<S>(x, neighbour);
    [
        simd.sub_f32s(r[0], combine(simd, [a, b], x)),
        simd.sub_f32s(r[1], combine(simd, [c, d], x)),
    ]
}

/// r less the part of K x that comes from the lines before and after, at the vector that begins at a position.
#[inline(always)]
fn subtract_beside<S: Simd>(
    simd: S,
    r: [S::f32s; 2],
    [before, current]: [LineStencil; 2],
    [left, right]: [Pair; 2],
    position: usize,
) -> [S::f32s; 2] {
    let (below, node, above) = (position, position + 1, position + 2);
    let west = transposed(EAST);
    let r = subtract(simd, r, (current, EAST), right, [node, node]);
    let r = subtract(simd, r, (current, NORTH_EAST), right, [node, above]);
    let r = subtract(simd, r, (current, SOUTH_EAST), right, [node, below]);
    let r = subtract(simd, r, (before, west), left, [node, node]);
    let r = subtract(simd, r, (before, NORTH_EAST), left, [below, below]);
    subtract(simd, r, (before, SOUTH_EAST), left, [above, above])
}

/// r less the part of K x that comes from the neighbours on the line itself.
#[inline(always)]
fn subtract_along<S: Simd>(
    simd: S,
    r: [S::f32s; 2],
    current: LineStencil,
    x: Pair,
    position: usize,
) -> [S::f32s; 2] {
    let (below, node, above) = (position, position + 1, position + 2);
    let south = transposed(NORTH);
    let r = subtract(simd, r, (current, NORTH), x, [node, above]);
    subtract(simd, r, (current, south), x, [below, below])
}

/// b − K x at the vector of nodes that begins at a position; `x` are the lines before, at and after.
#[inline(always)]
pub fn residual<S: Simd>(
    simd: S,
    [before, current]: [LineStencil; 2],
    [left, middle, right]: [Pair; 3],
    b: Pair,
    position: usize,
) -> [S::f32s; 2] {
    let b = load_pair::<S>(b, position + 1);
    let r = subtract_beside(simd, b, [before, current], [left, right], position);
    let r = subtract_along(simd, r, current, middle, position);
    subtract(simd, r, (current, ITSELF), middle, [position + 1; 2])
}

/// r = b − K x on a line.
pub struct LineResidual<'a> {
    pub before: LineStencil<'a>,
    pub current: LineStencil<'a>,
    pub x: [Pair<'a>; 3],
    pub b: Pair<'a>,
    pub r_x: &'a mut [f32],
    pub r_y: &'a mut [f32],
}

impl WithSimd for LineResidual<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for position in (0..self.r_x.len() - 2).step_by(S::F32_LANES) {
            let middle = position + 1;
            let stencils = [self.before, self.current];
            let [r_x, r_y] = residual(simd, stencils, self.x, self.b, position);
            store::<S>(self.r_x, middle, r_x);
            store::<S>(self.r_y, middle, r_y);
        }
    }
}

/// Gauss–Seidel on a line, in two colours.
pub struct SmoothLine<'a> {
    pub before: LineStencil<'a>,
    pub current: LineStencil<'a>,
    /// The lines before and after; none where they are zero.
    pub adjacent: Option<[Pair<'a>; 2]>,
    pub b: Pair<'a>,
    pub x_x: &'a mut [f32],
    pub x_y: &'a mut [f32],
    pub scratch: &'a mut [Vec<f32>; 2],
    /// The position in a line at which the nodes of the first colour begin.
    pub first: usize,
}

/// One at the nodes of a colour, zero at the others, from a position that is even.
pub const COLOURS: [[f32; VECTOR]; 2] = {
    let mut current = [[0.0; VECTOR]; 2];
    let mut position = 0;
    while position < VECTOR {
        current[position % 2][position] = 1.0;
        position += 1;
    }
    current
};

impl WithSimd for SmoothLine<'_> {
    type Output = ();

    /// Each colour is solved for at all nodes, and the result taken over at the nodes of that colour: twice the arithmetic,
    /// but in vectors. Nodes of one colour are no neighbours.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let nodes = self.x_x.len() - 2;
        let [g_x, g_y] = self.scratch;
        for position in (0..nodes).step_by(S::F32_LANES) {
            let b = load_pair::<S>(self.b, position + 1);
            let [x, y] = match self.adjacent {
                Some(adjacent) => {
                    subtract_beside(simd, b, [self.before, self.current], adjacent, position)
                }
                None => b,
            };
            store::<S>(g_x, position, x);
            store::<S>(g_y, position, y);
        }
        for colour in [self.first, 1 - self.first] {
            let current = load::<S>(&COLOURS[colour], 0);
            let other = load::<S>(&COLOURS[1 - colour], 0);
            for position in (0..nodes).step_by(S::F32_LANES) {
                let g = [load::<S>(g_x, position), load::<S>(g_y, position)];
                let r = subtract_along(simd, g, self.current, [self.x_x, self.x_y], position);
                let [a, b, c, d] = self.current.block::<S>(INVERSE, position + 1);
                let [x, y] = load_pair::<S>([self.x_x, self.x_y], position + 1);
                let x = combine(simd, [current, other], [combine(simd, [a, b], r), x]);
                let y = combine(simd, [current, other], [combine(simd, [c, d], r), y]);
                store::<S>(self.x_x, position + 1, x);
                store::<S>(self.x_y, position + 1, y);
            }
        }
    }
}
