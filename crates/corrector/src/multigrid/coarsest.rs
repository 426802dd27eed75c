//! The coarsest grid: a Cholesky factor within the band.

use super::stencil::Stencil;
use super::vector::{Lines, Vector};

/// The Cholesky factor of an operator on the free lines of a small grid.
///
/// Nodes are numbered along the shorter side, so that an unknown is coupled with few before it: K = L Lᵀ keeps within that band,
/// and takes n w² operations for n unknowns of w before each.
#[derive(Clone, Debug)]
pub struct Factor {
    numbers: Numbers,
    /// L, row by row; row i holds the columns from i − w to i.
    rows: Vec<f64>,
    solution: Vec<f64>,
}

/// The numbers of unknowns.
#[derive(Clone, Copy, Debug)]
struct Numbers {
    /// From a node to the next one on its line, and to the same node of the next line.
    steps: [usize; 2],
    unknowns: usize,
    /// How many unknowns before one are coupled with it at most.
    width: usize,
}

impl Numbers {
    fn new(lines: Lines) -> Self {
        let free = lines.count - 2;
        let across = lines.nodes.min(free);
        Self {
            steps: if across == lines.nodes {
                [2, 2 * across]
            } else {
                [2 * across, 2]
            },
            unknowns: 2 * lines.nodes * free,
            // The node after next to the one beside: the last of its two unknowns.
            width: 2 * (across + 1) + 1,
        }
    }

    /// The first unknown of a node of a free line.
    fn of(&self, line: usize, node: usize) -> usize {
        self.steps[1] * (line - 1) + self.steps[0] * node
    }
}

impl Factor {
    /// Factorises; nothing where the operator is not positive definite.
    pub fn of(stencil: &Stencil) -> Option<Self> {
        let numbers = Numbers::new(stencil.lines());
        let mut factor = Self {
            numbers,
            rows: vec![0.0; numbers.unknowns * (numbers.width + 1)],
            solution: vec![0.0; numbers.unknowns],
        };
        factor.take(stencil);
        factor.factorise().then_some(factor)
    }

    /// Where column j of row i is kept.
    fn position(&self, i: usize, j: usize) -> usize {
        (i + 1) * self.numbers.width + j
    }

    /// Row i from column `first` to the diagonal.
    fn row(&self, i: usize, first: usize) -> &[f64] {
        &self.rows[self.position(i, first)..=self.position(i, i)]
    }

    /// The first column of row i.
    fn first(&self, i: usize) -> usize {
        i.saturating_sub(self.numbers.width)
    }

    /// Writes the operator.
    fn take(&mut self, stencil: &Stencil) {
        let lines = stencil.lines();
        for line in 1..lines.count - 1 {
            for node in 0..lines.nodes {
                for (along, across) in [(0, 0), (0, 1), (1, 0), (1, 1), (1, -1)] {
                    let to = [line + along, node.wrapping_add_signed(across)];
                    if to[0] + 1 >= lines.count || to[1] >= lines.nodes {
                        continue;
                    }
                    let block = stencil.block([line, node], to).expect("neighbours");
                    let positions = [self.numbers.of(line, node), self.numbers.of(to[0], to[1])];
                    for (i, row) in block.iter().enumerate() {
                        for (k, entry) in row.iter().enumerate() {
                            let pair = [positions[0] + i, positions[1] + k];
                            let [column, row] = [pair[0].min(pair[1]), pair[0].max(pair[1])];
                            let position = self.position(row, column);
                            self.rows[position] = f64::from(*entry);
                        }
                    }
                }
            }
        }
    }

    /// L in place of K; false where K is not positive definite.
    fn factorise(&mut self) -> bool {
        for i in 0..self.numbers.unknowns {
            let first = self.first(i);
            for j in first..=i {
                let begin = self.first(j).max(first);
                let (row, other) = (self.row(i, begin), self.row(j, begin));
                let known = j - begin;
                let rest = row[known] - dot(&row[..known], &other[..known]);
                let entry = match i == j {
                    true if rest > 0.0 => rest.sqrt(),
                    true => return false,
                    false => rest / other[known],
                };
                let position = self.position(i, j);
                self.rows[position] = entry;
            }
        }
        true
    }

    /// x = K⁻¹ b.
    pub fn solve(&mut self, b: &Vector, x: &mut Vector) {
        let (lines, numbers) = (b.lines(), self.numbers);
        let mut solution = std::mem::take(&mut self.solution);
        for line in 1..lines.count - 1 {
            let [b_x, b_y] = b.line(line);
            for node in 0..lines.nodes {
                let position = numbers.of(line, node);
                solution[position] = f64::from(b_x[node + 1]);
                solution[position + 1] = f64::from(b_y[node + 1]);
            }
        }
        self.substitute(&mut solution);
        x.for_each_free_line(|line, x_x, x_y| {
            for node in 0..lines.nodes {
                let position = numbers.of(line, node);
                x_x[node + 1] = solution[position] as f32;
                x_y[node + 1] = solution[position + 1] as f32;
            }
        });
        self.solution = solution;
    }

    /// K⁻¹ b in place of b.
    fn substitute(&self, b: &mut [f64]) {
        for i in 0..b.len() {
            let first = self.first(i);
            let row = self.row(i, first);
            let known = i - first;
            b[i] = (b[i] - dot(&row[..known], &b[first..i])) / row[known];
        }
        for i in (0..b.len()).rev() {
            let first = self.first(i);
            let row = self.row(i, first);
            let known = i - first;
            b[i] /= row[known];
            let pivot = b[i];
            for (b, entry) in b[first..i].iter_mut().zip(row) {
                *b -= entry * pivot;
            }
        }
    }
}

/// a · b by four sums side by side, which does not wait for one sum.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    let mut sums = [0.0; 4];
    for (a, b) in a.zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
