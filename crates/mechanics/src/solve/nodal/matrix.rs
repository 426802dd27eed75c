//! A stiffness by nodes with two unknowns each, summed up element by element.

use super::Nodes;
use crate::solve::aggregation::blocks::{Blocks, add_product};
use crate::solve::pattern::SymmetricPattern;
use crate::solve::potential::{Evaluated, Potential};

/// No row: an unknown that is held.
const NONE: u32 = u32::MAX;

/// A symmetric stiffness by nodes: its blocks on and below the diagonal, K = L + D + Lᵀ.
pub struct NodalMatrix {
    /// Row by row; the last block of each row is that on the diagonal.
    pub blocks: Blocks<2, 2>,
    /// The row of each unknown of the potential.
    rows: Vec<u32>,
    /// The components that are no unknowns: the row, and 0 or 1.
    held: Vec<(usize, usize)>,
}

impl NodalMatrix {
    /// The stiffness of a potential over the free unknowns of some nodes; its values are taken later.
    pub fn new(nodes: &Nodes, unknowns: &[usize], potential: &dyn Potential) -> Self {
        let mut rows = vec![NONE; potential.unknowns()];
        for (unknown, (node, _)) in unknowns.iter().zip(&nodes.of) {
            rows[*unknown] = *node;
        }
        let components = (0..nodes.count()).flat_map(|row| [(row, 0), (row, 1)]);
        Self {
            blocks: pattern(nodes.count(), &rows, potential),
            rows,
            held: components
                .filter(|(row, component)| !nodes.free[*row][*component])
                .collect(),
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
        let Self { blocks, rows, held } = self;
        blocks.values.fill([[0.0; 2]; 2]);
        for (row, component) in held {
            blocks.values[blocks.starts[*row + 1] - 1][*component][*component] = 1.0;
        }
        let mut take = |element: usize, stiffness: &[f64]| {
            add(blocks, rows, potential.element_unknowns(element), stiffness);
        };
        let energy = potential.evaluate(u, residual, Some(&mut take));
        if energy.is_err() {
            self.blocks.values.fill([[f64::NAN; 2]; 2]);
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

/// The blocks on and below the diagonal of the nodes that elements couple, without values.
fn pattern(count: usize, rows: &[u32], potential: &dyn Potential) -> Blocks<2, 2> {
    let mut before = vec![Vec::<u32>::new(); count];
    for element in 0..potential.elements() {
        let unknowns = potential.element_unknowns(element).iter();
        let mut nodes: Vec<u32> = unknowns.map(|unknown| rows[*unknown as usize]).collect();
        nodes.retain(|row| *row != NONE);
        nodes.sort_unstable();
        nodes.dedup();
        for (position, row) in nodes.iter().enumerate() {
            before[*row as usize].extend_from_slice(&nodes[..position]);
        }
    }
    let mut blocks = Blocks {
        starts: vec![0],
        ..Blocks::default()
    };
    for (row, mut columns) in (0..).zip(before) {
        columns.sort_unstable();
        columns.dedup();
        blocks.columns.extend(columns);
        blocks.columns.push(row);
        blocks.starts.push(blocks.columns.len());
    }
    blocks.columns.shrink_to_fit();
    blocks.values = vec![[[0.0; 2]; 2]; blocks.columns.len()];
    blocks
}

/// Where a block on or below the diagonal is.
fn find(blocks: &Blocks<2, 2>, row: usize, column: usize) -> usize {
    let start = blocks.starts[row];
    let columns = &blocks.columns[start..blocks.starts[row + 1]];
    start + columns.binary_search(&(column as u32)).expect("a block")
}

/// Adds the stiffness of an element, whose lower triangle is known.
fn add(blocks: &mut Blocks<2, 2>, rows: &[u32], unknowns: &[u32], stiffness: &[f64]) {
    let size = unknowns.len();
    for (i, from) in unknowns.iter().enumerate() {
        // Both unknowns of a node follow each other.
        let mut last = (NONE, 0);
        for (k, to) in unknowns.iter().enumerate() {
            let [from, to] = [*from, *to].map(|unknown| unknown as usize);
            let [row, column] = [rows[from], rows[to]];
            if row != NONE && column != NONE && row >= column {
                if last.0 != column {
                    last = (column, find(blocks, row as usize, column as usize));
                }
                let value = stiffness[i.max(k) * size + i.min(k)];
                blocks.values[last.1][from % 2][to % 2] += value;
            }
        }
    }
}
