//! The coarsest grid: a Cholesky factor of its operator.

use super::stencil::Stencil;
use super::vector::{Lines, Vector};
use crate::solve::{Cholesky, FactorFault};

/// The Cholesky factor of an operator on the free lines of a small grid.
pub struct Factor {
    cholesky: Cholesky,
    solution: Vec<f64>,
}

/// The first unknown of a node of a free line.
fn unknown(lines: Lines, line: usize, node: usize) -> usize {
    2 * ((line - 1) * lines.nodes + node)
}

/// The lower triangle of the operator by columns: rows and values.
fn columns(stencil: &Stencil) -> Vec<Vec<(usize, f64)>> {
    let lines = stencil.lines();
    let nodes =
        (1..lines.count - 1).flat_map(|line| (0..lines.nodes).map(move |node| [line, node]));
    let column = |[line, node]: [usize; 2], axis: usize| {
        let mut column = Vec::with_capacity(10);
        // Ascending by the numbers of unknowns.
        for (along, across) in [(0, 0), (0, 1), (1, -1), (1, 0), (1, 1)] {
            let to = [line + along, node.wrapping_add_signed(across)];
            if to[0] + 1 >= lines.count || to[1] >= lines.nodes {
                continue;
            }
            let block = stencil.block([line, node], to).expect("neighbours");
            let above = if to == [line, node] { axis } else { 0 };
            let first = unknown(lines, to[0], to[1]);
            column.extend((above..2).map(|k| (first + k, f64::from(block[axis][k]))));
        }
        column
    };
    let of_node = |node| [column(node, 0), column(node, 1)];
    nodes.flat_map(of_node).collect()
}

impl Factor {
    /// Factorises.
    ///
    /// # Errors
    /// [`FactorFault`] where the operator is not positive definite.
    pub fn of(stencil: &Stencil) -> Result<Self, FactorFault> {
        let columns = columns(stencil);
        Ok(Self {
            cholesky: Cholesky::of_columns(&columns)?,
            solution: vec![0.0; columns.len()],
        })
    }

    /// x = K⁻¹ b.
    pub fn solve(&mut self, b: &Vector, x: &mut Vector) {
        let lines = b.lines();
        let solution = &mut self.solution;
        for line in 1..lines.count - 1 {
            let [b_x, b_y] = b.line(line);
            for node in 0..lines.nodes {
                let position = unknown(lines, line, node);
                solution[position] = f64::from(b_x[node + 1]);
                solution[position + 1] = f64::from(b_y[node + 1]);
            }
        }
        self.cholesky.substitute(solution);
        let solution = &self.solution;
        x.for_each_free_line(|line, x_x, x_y| {
            for node in 0..lines.nodes {
                let position = unknown(lines, line, node);
                x_x[node + 1] = solution[position] as f32;
                x_y[node + 1] = solution[position + 1] as f32;
            }
        });
    }
}
