//! The pattern of a sum of element matrices, and where each of their entries is added.

use super::connectivity::Connectivity;
use super::grouped::grouped;
use super::pattern::SymmetricPattern;

/// No free unknown, or no position.
pub const NOWHERE: u32 = u32::MAX;

/// Where the entries of element matrices are added.
#[derive(Debug, Default)]
pub struct Scatter {
    /// For each element, for each entry of its lower triangle, row by row: its position, or [`NOWHERE`].
    positions: Vec<u32>,
    starts: Vec<usize>,
}

impl Scatter {
    /// The pattern over the free unknowns, and where the entries of each element are added; `elements` are over the free unknowns,
    /// with [`NOWHERE`] for those that are not free.
    ///
    /// # Panics
    /// When the pattern has 2³² entries or more.
    pub fn new(elements: &Connectivity) -> (SymmetricPattern, Self) {
        let free = elements.unknowns();
        let around = Around::of(elements);
        let mut scatter = Self {
            positions: Vec::new(),
            starts: vec![0],
        };
        let mut size = 0;
        for element in 0..elements.elements() {
            let unknowns = elements.of(element).len();
            size += unknowns * (unknowns + 1) / 2;
            scatter.starts.push(size);
        }
        scatter.positions = vec![NOWHERE; size];
        let (mut starts, mut rows) = (vec![0], Vec::new());
        // The column in which a row was seen last, and where it is stored there.
        let mut seen = vec![(NOWHERE, NOWHERE); free];
        for column in 0..free as u32 {
            let first = rows.len();
            rows.push(column as usize);
            seen[column as usize].0 = column;
            for (element, _) in around.of_unknown(column) {
                for row in elements.of(*element as usize) {
                    let is_below = *row != NOWHERE && *row > column;
                    if is_below && seen[*row as usize].0 != column {
                        seen[*row as usize].0 = column;
                        rows.push(*row as usize);
                    }
                }
            }
            rows[first..].sort_unstable();
            for (position, row) in (first as u32..).zip(&rows[first..]) {
                seen[*row].1 = position;
            }
            for (element, local) in around.of_unknown(column) {
                let [element, local] = [*element, *local].map(|index| index as usize);
                scatter.put(elements.of(element), element, column, local, &seen);
            }
            starts.push(rows.len());
        }
        assert!(rows.len() < NOWHERE as usize, "fewer than 2³² entries");
        (SymmetricPattern::of_columns(starts, rows), scatter)
    }

    /// Records the positions of one local column of an element, below the diagonal of the whole.
    fn put(
        &mut self,
        unknowns: &[u32],
        element: usize,
        column: u32,
        local: usize,
        seen: &[(u32, u32)],
    ) {
        let start = self.starts[element];
        for (other, row) in unknowns.iter().enumerate() {
            if *row != NOWHERE && *row >= column {
                let (high, low) = (local.max(other), local.min(other));
                self.positions[start + high * (high + 1) / 2 + low] = seen[*row as usize].1;
            }
        }
    }

    /// The positions of the lower triangle of an element, row by row.
    pub fn of(&self, element: usize) -> &[u32] {
        &self.positions[self.starts[element]..self.starts[element + 1]]
    }
}

/// The elements around each free unknown, with its position in them.
struct Around {
    starts: Vec<usize>,
    elements: Vec<(u32, u32)>,
}

impl Around {
    fn of(elements: &Connectivity) -> Self {
        let free_unknowns = |element: usize| {
            let unknowns = elements.of(element).iter().enumerate();
            unknowns.filter(|(_, unknown)| **unknown != NOWHERE)
        };
        let all = (0..elements.elements()).flat_map(|element| {
            free_unknowns(element)
                .map(move |(local, unknown)| (*unknown as usize, (element as u32, local as u32)))
        });
        let (starts, elements) = grouped(elements.unknowns(), all);
        Self { starts, elements }
    }

    fn of_unknown(&self, unknown: u32) -> &[(u32, u32)] {
        let unknown = unknown as usize;
        &self.elements[self.starts[unknown]..self.starts[unknown + 1]]
    }
}
