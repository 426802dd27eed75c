//! The coarsest grid: a dense inverse.

use nalgebra::DMatrix;

use super::stencil::Stencil;
use super::vector::Vector;

/// The inverse of an operator on the free lines of a small grid.
#[derive(Clone, Debug)]
pub struct Inverse {
    size: usize,
    entries: Vec<f32>,
    right: Vec<f32>,
    solution: Vec<f32>,
}

impl Inverse {
    /// Inverts; nothing where the operator is not positive definite.
    pub fn of(stencil: &Stencil) -> Option<Self> {
        let lines = stencil.lines();
        let nodes = lines.nodes;
        let size = 2 * nodes * (lines.count - 2);
        let mut matrix = DMatrix::<f64>::zeros(size, size);
        let unknown = |[line, node]: [usize; 2]| 2 * ((line - 1) * nodes + node);
        for line in 1..lines.count - 1 {
            for node in 0..nodes {
                for [along, across] in [[0, 0], [0, 1], [1, 0], [1, 1], [1, -1]] {
                    let to = [line as isize + along, node as isize + across];
                    let inside = (1..lines.count as isize - 1).contains(&to[0])
                        && (0..nodes as isize).contains(&to[1]);
                    if !inside {
                        continue;
                    }
                    let to = to.map(|place| place as usize);
                    let block = stencil.block([line, node], to).expect("neighbours");
                    let (row, column) = (unknown([line, node]), unknown(to));
                    for i in 0..2 {
                        for k in 0..2 {
                            matrix[(row + i, column + k)] = f64::from(block[i][k]);
                            matrix[(column + k, row + i)] = f64::from(block[i][k]);
                        }
                    }
                }
            }
        }
        let inverse = matrix.cholesky()?.inverse();
        Some(Self {
            size,
            entries: inverse.iter().map(|entry| *entry as f32).collect(),
            right: vec![0.0; size],
            solution: vec![0.0; size],
        })
    }

    /// x = K⁻¹ b.
    pub fn solve(&mut self, b: &Vector, x: &mut Vector) {
        let lines = b.lines();
        for line in 1..lines.count - 1 {
            let [b_x, b_y] = b.line(line);
            for node in 0..lines.nodes {
                let place = 2 * ((line - 1) * lines.nodes + node);
                self.right[place] = b_x[node + 1];
                self.right[place + 1] = b_y[node + 1];
            }
        }
        self.solution.fill(0.0);
        for (column, right) in self.entries.chunks_exact(self.size).zip(&self.right) {
            for (sum, entry) in self.solution.iter_mut().zip(column) {
                *sum += entry * right;
            }
        }
        let solution = &self.solution;
        x.for_each_free_line(|line, x_x, x_y| {
            for node in 0..lines.nodes {
                let place = 2 * ((line - 1) * lines.nodes + node);
                x_x[node + 1] = solution[place];
                x_y[node + 1] = solution[place + 1];
            }
        });
    }
}
