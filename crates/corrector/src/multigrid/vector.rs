//! Two values for each node of a grid.

use rayon::prelude::*;

use super::NODES_WORTH_A_THREAD;

/// Numbers of single precision in the widest vector of today's machines.
pub const VECTOR: usize = 16;

/// The lines of a grid: how many there are, and how many nodes each has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lines {
    /// Nodes along X.
    pub count: usize,
    /// Nodes along Y.
    pub nodes: usize,
}

impl Lines {
    /// Entries of a line that are computed: its nodes, and zeros after them up to a multiple of the vector length.
    pub fn padded(self) -> usize {
        self.nodes.next_multiple_of(VECTOR)
    }

    /// Positions that a line takes: those that are worked on, and one more at either end that stays zero.
    pub fn stride(self) -> usize {
        self.padded() + 2
    }

    /// Lines with an even number come first, then those with an odd one.
    fn position(self, line: usize) -> usize {
        line / 2 + (line % 2) * self.count.div_ceil(2)
    }

    /// Whether several threads pay.
    pub fn threaded(self) -> bool {
        self.count * self.nodes >= NODES_WORTH_A_THREAD && rayon::current_num_threads() > 1
    }

    /// Calls `work` with the number of each piece of some numbers and the piece, by several threads where they pay.
    pub fn for_each_piece(
        self,
        numbers: &mut [f32],
        size: usize,
        work: impl Fn((usize, &mut [f32])) + Sync + Send,
    ) {
        if self.threaded() {
            numbers.par_chunks_mut(size).enumerate().for_each(work);
        } else {
            numbers.chunks_mut(size).enumerate().for_each(work);
        }
    }
}

/// A vector on a grid: ux and uy, or forces along both axes.
#[derive(Clone, Debug)]
pub struct Vector {
    lines: Lines,
    /// Each line by line, with its two ends.
    components: [Vec<f32>; 2],
}

/// A line of both components with its two ends.
pub type Pair<'a> = [&'a [f32]; 2];

/// The lines of one parity, to be read while those of the other are written.
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    lines: Lines,
    parity: usize,
    values: [&'a [f32]; 2],
}

impl<'a> Neighbours<'a> {
    /// A line of the other parity.
    #[inline(always)]
    pub fn line(&self, line: usize) -> Pair<'a> {
        debug_assert_ne!(line % 2, self.parity);
        let stride = self.lines.stride();
        let [x, y] = self.values;
        let begin = line / 2 * stride;
        [&x[begin..][..stride], &y[begin..][..stride]]
    }
}

impl Vector {
    /// Zeros.
    pub fn zeros(lines: Lines) -> Self {
        let zeros = vec![0.0; lines.count * lines.stride()];
        Self {
            lines,
            components: [zeros.clone(), zeros],
        }
    }

    /// The grid's lines.
    pub fn lines(&self) -> Lines {
        self.lines
    }

    /// Makes all values zero.
    pub fn clear(&mut self) {
        let (stride, threaded) = (self.lines.stride(), self.lines.threaded());
        for component in &mut self.components {
            if threaded {
                let lines = component.par_chunks_mut(stride).with_min_len(8);
                lines.for_each(|line| line.fill(0.0));
            } else {
                component.fill(0.0)
            }
        }
    }

    /// A line of both components with its two ends.
    #[inline(always)]
    pub fn line(&self, line: usize) -> Pair<'_> {
        let stride = self.lines.stride();
        let begin = self.lines.position(line) * stride;
        let [x, y] = &self.components;
        [&x[begin..][..stride], &y[begin..][..stride]]
    }

    /// Calls `write` with each free line's number and its two components.
    pub fn for_each_free_line(&mut self, write: impl Fn(usize, &mut [f32], &mut [f32]) + Sync) {
        for parity in [1, 0] {
            self.for_each_of_parity(parity, |line, _, x, y| write(line, x, y));
        }
    }

    /// Calls `write` with each free line of one parity: its number, the lines beside it, its two components.
    pub fn for_each_of_parity(
        &mut self,
        parity: usize,
        write: impl Fn(usize, Neighbours<'_>, &mut [f32], &mut [f32]) + Sync,
    ) {
        let lines = self.lines;
        let stride = lines.stride();
        let even = lines.count.div_ceil(2) * stride;
        let [x, y] = &mut self.components;
        let (even_x, odd_x) = x.split_at_mut(even);
        let (even_y, odd_y) = y.split_at_mut(even);
        let (x, y, adjacent) = match parity {
            0 => (even_x, even_y, [&*odd_x, &*odd_y]),
            _ => (odd_x, odd_y, [&*even_x, &*even_y]),
        };
        let neighbours = Neighbours {
            lines,
            parity,
            values: adjacent,
        };
        let last = lines.count - 1;
        let visit = |(position, (x, y)): (usize, (&mut [f32], &mut [f32]))| {
            let line = 2 * position + parity;
            if line > 0 && line < last {
                write(line, neighbours, x, y);
            }
        };
        if lines.threaded() {
            let pairs = x.par_chunks_mut(stride).zip(y.par_chunks_mut(stride));
            pairs.enumerate().with_min_len(8).for_each(visit);
        } else {
            let pairs = x.chunks_mut(stride).zip(y.chunks_mut(stride));
            pairs.enumerate().for_each(visit);
        }
    }
}
