//! Passes over the numbers of a grid's fields, by one thread or several, with sums that do not depend on their number.

use rayon::join;

use crate::multigrid::Lines;

/// Nodes that one thread handles at a time, about: their numbers stay in its nearest caches.
const NODES_AT_ONCE: usize = 2_048;

/// A part of a grid's nodes: some of its lines.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// The number of the first node among all nodes.
    pub first: usize,
    /// The most nodes that are not divided.
    piece: usize,
    threaded: bool,
}

impl Part {
    /// All nodes of a grid.
    pub fn all(lines: Lines) -> Self {
        Self {
            first: 0,
            piece: lines.nodes * (NODES_AT_ONCE / lines.nodes).max(1),
            threaded: lines.threaded(),
        }
    }

    /// Calls `work` with pieces of the numbers to be changed and of those to be read, and adds what it returns by halves: the order of
    /// the sums depends on the grid alone.
    pub fn sweep<const CHANGED: usize, const READ: usize, const SUMS: usize>(
        self,
        changed: [&mut [f64]; CHANGED],
        read: [&[f64]; READ],
        work: &(impl Fn(Self, [&mut [f64]; CHANGED], [&[f64]; READ]) -> [f64; SUMS] + Sync),
    ) -> [f64; SUMS] {
        let lengths = changed.iter().map(|numbers| numbers.len());
        let count = lengths
            .chain(read.iter().map(|numbers| numbers.len()))
            .max();
        let pieces = count.unwrap_or(0).div_ceil(self.piece);
        if pieces <= 1 {
            return work(self, changed, read);
        }
        let middle = pieces / 2 * self.piece;
        let after = Self {
            first: self.first + middle,
            ..self
        };
        let (changed, changed_after) = halves(changed, |numbers| numbers.split_at_mut(middle));
        let (read, read_after) = halves(read, |numbers| numbers.split_at(middle));
        let before = || self.sweep(changed, read, work);
        let after = || after.sweep(changed_after, read_after, work);
        let (sums, more) = if self.threaded {
            join(before, after)
        } else {
            (before(), after())
        };
        std::array::from_fn(|k| sums[k] + more[k])
    }
}

/// Divides several slices.
fn halves<T: Default, const COUNT: usize>(
    slices: [T; COUNT],
    divide: impl Fn(T) -> (T, T),
) -> ([T; COUNT], [T; COUNT]) {
    let mut after = std::array::from_fn(|_| T::default());
    let mut positions = after.iter_mut();
    let before = slices.map(|slice| {
        let (before, rest) = divide(slice);
        *positions.next().expect("as many") = rest;
        before
    });
    (before, after)
}

/// Partial sums that are added side by side, in vectors.
const LANES: usize = 8;

/// Σ f(k) over the numbers of a piece.
#[inline(always)]
pub fn sum<const SUMS: usize>(count: usize, term: impl Fn(usize) -> [f64; SUMS]) -> [f64; SUMS] {
    let mut sums = [[0.0; SUMS]; LANES];
    let add = |sums: &mut [f64; SUMS], position: usize| {
        let terms = term(position);
        sums.iter_mut()
            .zip(terms)
            .for_each(|(sum, term)| *sum += term);
    };
    let in_vectors = count - count % LANES;
    for first in (0..in_vectors).step_by(LANES) {
        for (lane, sums) in sums.iter_mut().enumerate() {
            add(sums, first + lane);
        }
    }
    for (lane, position) in (in_vectors..count).enumerate() {
        add(&mut sums[lane], position);
    }
    std::array::from_fn(|k| sums.iter().map(|lane| lane[k]).sum())
}
