//! A stiffness by nodes with two unknowns each, summed up element by element.

use super::Nodes;
use crate::solve::aggregation::blocks::{Blocks, add_product};
use crate::solve::grouped::grouped;
use crate::solve::pattern::SymmetricPattern;
use crate::solve::potential::{Evaluated, Potential};

/// No row, or no block.
const NONE: u32 = u32::MAX;

/// A symmetric stiffness by nodes: its blocks on and below the diagonal, K = L + D + Lᵀ.
pub struct NodalMatrix {
    /// Row by row; the last block of each row is that on the diagonal.
    pub blocks: Blocks<2, 2>,
    /// The row of each node of the potential.
    rows: Vec<u32>,
    elements: ElementBlocks,
    /// Blocks of components that are no unknowns.
    partly: Vec<PartlyFree>,
}

/// Where the pairs of nodes of each element have their block: the first two, the second with both, and so on; twice its number, and one
/// more where it is that of the pair turned around. Elements that do not have both unknowns of each of their nodes in turn have none.
#[derive(Default)]
struct ElementBlocks {
    pairs: Vec<u32>,
    starts: Vec<u32>,
}

/// A block with components that are no unknowns, and which of its entries belong to unknowns.
struct PartlyFree {
    block: usize,
    free: [[bool; 2]; 2],
    on_diagonal: bool,
}

impl NodalMatrix {
    /// The stiffness of a potential over the free unknowns of some nodes; its values are taken later.
    pub fn new(nodes: &Nodes, unknowns: &[usize], potential: &dyn Potential) -> Self {
        let mut rows = vec![NONE; potential.unknowns().div_ceil(2)];
        for (unknown, (node, _)) in unknowns.iter().zip(&nodes.of) {
            rows[unknown / 2] = *node;
        }
        let blocks = pattern(nodes.count(), &rows, potential);
        let mut partly = Vec::new();
        for row in 0..nodes.count() {
            for block in blocks.starts[row]..blocks.starts[row + 1] {
                let column = blocks.columns[block] as usize;
                let free =
                    nodes.free[row].map(|is_free| nodes.free[column].map(|other| is_free && other));
                if free != [[true; 2]; 2] {
                    partly.push(PartlyFree {
                        block,
                        free,
                        on_diagonal: row == column,
                    });
                }
            }
        }
        Self {
            elements: ElementBlocks::new(&blocks, &rows, potential),
            blocks,
            rows,
            partly,
        }
    }

    /// Takes the stiffness of a potential at `u`; its energy, and ∂Π/∂u at all unknowns. Nothing is known of the stiffness where there is
    /// none.
    pub fn linearise(
        &mut self,
        potential: &dyn Potential,
        u: &[f64],
        residual: &mut [f64],
    ) -> Evaluated {
        residual.fill(0.0);
        self.blocks.values.fill([[0.0; 2]; 2]);
        let (blocks, rows, elements) = (&mut self.blocks, &self.rows, &self.elements);
        let mut take = |element: usize, stiffness: &[f64]| {
            let pairs = elements.of(element);
            let unknowns = potential.element_unknowns(element);
            if pairs.is_empty() {
                add_each(blocks, rows, unknowns, stiffness)
            } else {
                add_pairs(blocks, pairs, unknowns.len(), stiffness)
            }
        };
        let energy = potential.evaluate(u, residual, Some(&mut take));
        if energy.is_err() {
            self.blocks.values.fill([[f64::NAN; 2]; 2]);
        }
        for partial in &self.partly {
            let block = &mut self.blocks.values[partial.block];
            for (i, (row, free)) in block.iter_mut().zip(partial.free).enumerate() {
                for k in (0..2).filter(|k| !free[*k]) {
                    row[k] = if partial.on_diagonal && i == k {
                        1.0
                    } else {
                        0.0
                    };
                }
            }
        }
        energy
    }

    /// The largest entry on the diagonal.
    pub fn stiffest(&self) -> f64 {
        let last = self.blocks.starts[1..].iter();
        let diagonal = last.map(|end| &self.blocks.values[end - 1]);
        diagonal.fold(0.0, |most: f64, block| {
            most.max(block[0][0].abs()).max(block[1][1].abs())
        })
    }

    /// y = K x.
    pub fn multiply(&self, x: &[[f64; 2]], y: &mut [[f64; 2]]) {
        let Blocks {
            starts,
            columns,
            values,
        } = &self.blocks;
        y.fill([0.0; 2]);
        for row in 0..y.len() {
            let below = starts[row]..starts[row + 1] - 1;
            let (x_row, mut sum) = (x[row], [0.0; 2]);
            for (column, block) in columns[below.clone()].iter().zip(&values[below.clone()]) {
                add_product(&mut sum, block, &x[*column as usize]);
                let before = &mut y[*column as usize];
                before[0] += block[0][0] * x_row[0] + block[1][0] * x_row[1];
                before[1] += block[0][1] * x_row[0] + block[1][1] * x_row[1];
            }
            add_product(&mut sum, &values[below.end], &x_row);
            y[row] = sum;
        }
    }

    /// All blocks, those above the diagonal too.
    pub fn full(&self) -> Blocks<2, 2> {
        let above = self.blocks.transposed(self.blocks.rows());
        let mut full = Blocks {
            starts: vec![0],
            ..Blocks::default()
        };
        for row in 0..self.blocks.rows() {
            let below = self.blocks.row(row);
            // The first one above is that on the diagonal.
            for (column, block) in below.chain(above.row(row).skip(1)) {
                full.columns.push(column as u32);
                full.values.push(*block);
            }
            full.starts.push(full.columns.len());
        }
        full
    }

    /// The values of a pattern over the unknowns of the nodes.
    pub fn entries(&self, nodes: &Nodes, pattern: &SymmetricPattern) -> Vec<f64> {
        let mut entries = Vec::with_capacity(pattern.entries());
        for column in 0..pattern.size() {
            let (to, k) = nodes.of_unknown(column);
            for row in pattern.column(column) {
                let (from, i) = nodes.of_unknown(*row);
                entries.push(self.blocks.values[find(&self.blocks, from, to)][i][k]);
            }
        }
        entries
    }
}

impl ElementBlocks {
    fn new(blocks: &Blocks<2, 2>, rows: &[u32], potential: &dyn Potential) -> Self {
        let count = |element: usize| {
            let nodes = potential.element_unknowns(element).len() / 2;
            nodes * (nodes + 1) / 2
        };
        let mut element_blocks = Self {
            pairs: Vec::with_capacity((0..potential.elements()).map(count).sum()),
            starts: Vec::with_capacity(potential.elements() + 1),
        };
        assert!(
            element_blocks.pairs.capacity() < NONE as usize,
            "fewer than 2³² pairs"
        );
        element_blocks.starts.push(0);
        for element in 0..potential.elements() {
            let unknowns = potential.element_unknowns(element);
            if has_both_unknowns_in_turn(unknowns) {
                let row = |node: usize| rows[unknowns[2 * node] as usize / 2];
                for a in 0..unknowns.len() / 2 {
                    for b in 0..=a {
                        element_blocks.pairs.push(match [row(a), row(b)] {
                            [NONE, _] | [_, NONE] => NONE,
                            [a, b] if a < b => 2 * find(blocks, b as usize, a as usize) as u32 + 1,
                            [a, b] => 2 * find(blocks, a as usize, b as usize) as u32,
                        });
                    }
                }
            }
            element_blocks
                .starts
                .push(element_blocks.pairs.len() as u32);
        }
        element_blocks
    }

    fn of(&self, element: usize) -> &[u32] {
        &self.pairs[self.starts[element] as usize..self.starts[element + 1] as usize]
    }
}

/// Whether unknowns are both of one node, both of another one, and so on.
fn has_both_unknowns_in_turn(unknowns: &[u32]) -> bool {
    let nodes = unknowns.chunks(2);
    let both =
        |pair: &[u32]| pair.len() == 2 && pair[0].is_multiple_of(2) && pair[1] == pair[0] + 1;
    let other = |position: usize| !unknowns[..position].contains(&unknowns[position]);
    nodes.clone().all(both) && (0..unknowns.len()).step_by(2).all(other)
}

/// The blocks on and below the diagonal of the nodes that elements couple, without values.
fn pattern(count: usize, rows: &[u32], potential: &dyn Potential) -> Blocks<2, 2> {
    let (mut members, mut begins) = (Vec::<u32>::new(), vec![0]);
    for element in 0..potential.elements() {
        let begin = members.len();
        for unknown in potential.element_unknowns(element) {
            let row = rows[*unknown as usize / 2];
            if row != NONE && !members[begin..].contains(&row) {
                members.push(row);
            }
        }
        begins.push(members.len());
    }
    let all = (0..potential.elements()).flat_map(|element| {
        let element_rows = members[begins[element]..begins[element + 1]].iter();
        element_rows.map(move |row| (*row as usize, element as u32))
    });
    let (around, elements) = grouped(count, all);
    let (mut starts, mut columns) = (vec![0], Vec::new());
    let mut seen = vec![NONE; count];
    for row in 0..count as u32 {
        let entries = around[row as usize]..around[row as usize + 1];
        let begin = columns.len();
        for element in &elements[entries] {
            let element = *element as usize;
            for column in &members[begins[element]..begins[element + 1]] {
                if *column < row && seen[*column as usize] != row {
                    seen[*column as usize] = row;
                    columns.push(*column);
                }
            }
        }
        columns[begin..].sort_unstable();
        columns.push(row);
        starts.push(columns.len());
    }
    columns.shrink_to_fit();
    Blocks {
        values: vec![[[0.0; 2]; 2]; columns.len()],
        starts,
        columns,
    }
}

/// Where a block on or below the diagonal is.
fn find(blocks: &Blocks<2, 2>, row: usize, column: usize) -> usize {
    let start = blocks.starts[row];
    let columns = &blocks.columns[start..blocks.starts[row + 1]];
    start + columns.binary_search(&(column as u32)).expect("a block")
}

/// Adds an element's stiffness, whose lower triangle is known.
fn add_pairs(blocks: &mut Blocks<2, 2>, pairs: &[u32], size: usize, stiffness: &[f64]) {
    let mut pairs = pairs.iter();
    for a in 0..size / 2 {
        let rows = [0, 1].map(|i| &stiffness[(2 * a + i) * size..][..=2 * a + 1]);
        for (b, pair) in (0..=a).zip(&mut pairs) {
            if *pair == NONE {
                continue;
            }
            let mut block = [0, 1].map(|i| [rows[i][2 * b], rows[i][2 * b + 1]]);
            if a == b {
                block[0][1] = block[1][0];
            } else if pair % 2 == 1 {
                block = [[block[0][0], block[1][0]], [block[0][1], block[1][1]]];
            }
            let sum = &mut blocks.values[*pair as usize / 2];
            for i in 0..2 {
                for k in 0..2 {
                    sum[i][k] += block[i][k];
                }
            }
        }
    }
}

/// The same of an element with any unknowns.
fn add_each(blocks: &mut Blocks<2, 2>, rows: &[u32], unknowns: &[u32], stiffness: &[f64]) {
    let size = unknowns.len();
    for (i, from) in unknowns.iter().enumerate() {
        for (k, to) in unknowns.iter().enumerate() {
            let [from, to] = [*from, *to].map(|unknown| unknown as usize);
            let [row, column] = [rows[from / 2], rows[to / 2]];
            if row != NONE && column != NONE && row >= column {
                let position = find(blocks, row as usize, column as usize);
                let value = stiffness[i.max(k) * size + i.min(k)];
                blocks.values[position][from % 2][to % 2] += value;
            }
        }
    }
}
