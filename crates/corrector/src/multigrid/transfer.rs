//! Transfer between two grids on one rectangle, along one axis at a time.

use super::vector::Vector;

/// Values at given positions as combinations of those at the nodes of a grid, along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Interpolation {
    /// For each position the first node and the shares of it and of those that follow.
    shares: Vec<(usize, [f64; 4])>,
    width: usize,
}

impl Interpolation {
    /// Interpolates by the polynomials through so many nodes around each position, or through all where there are fewer.
    pub fn around(nodes: &[f64], positions: &[f64], width: usize) -> Self {
        let width = width.min(nodes.len());
        Self::through(nodes, positions, width, |after| {
            after.saturating_sub(width / 2).min(nodes.len() - width)
        })
    }

    /// Interpolates by the polynomials of a degree through the nodes of each element.
    pub fn of_elements(nodes: &[f64], positions: &[f64], degree: usize) -> Self {
        let last = (nodes.len() - 1) / degree - 1;
        Self::through(nodes, positions, degree + 1, |after| {
            (after.saturating_sub(1) / degree).min(last) * degree
        })
    }

    /// Interpolates by the polynomials through so many nodes, the first of which follows from the number of nodes up to the position.
    fn through(
        nodes: &[f64],
        positions: &[f64],
        width: usize,
        first: impl Fn(usize) -> usize,
    ) -> Self {
        let share = |position: &f64| {
            let first = first(nodes.partition_point(|node| node <= position));
            (first, shares(&nodes[first..first + width], *position))
        };
        Self {
            shares: positions.iter().map(share).collect(),
            width,
        }
    }

    /// For each position the first node and the shares of it and of those that follow.
    pub fn shares(&self) -> impl Iterator<Item = (usize, &[f64])> {
        (0..self.shares.len()).map(|position| self.at(position))
    }

    /// The first node and the shares of it and of those that follow, for one of the positions.
    pub fn at(&self, position: usize) -> (usize, &[f64]) {
        let (first, shares) = &self.shares[position];
        (*first, &shares[..self.width])
    }
}

/// The shares of up to four nodes at a position, by the polynomial through them.
fn shares(nodes: &[f64], position: f64) -> [f64; 4] {
    let mut shares = [0.0; 4];
    for (i, (share, node)) in shares.iter_mut().zip(nodes).enumerate() {
        let others = nodes.iter().enumerate().filter(|(other, _)| *other != i);
        *share = others
            .map(|(_, other)| (position - other) / (node - other))
            .product();
    }
    shares
}

/// The linear prolongation between two grids, along one axis, and its transpose.
#[derive(Clone, Debug)]
struct Axis {
    /// For each fine node the coarse one before it and the share of the next one.
    fine: Vec<(usize, f32)>,
    /// For each coarse node the first fine one that it has a share in, and the shares.
    coarse: Vec<(usize, Vec<f32>)>,
}

impl Axis {
    fn new(coarse: &[f64], fine: &[f64]) -> Self {
        let linear = Interpolation::around(coarse, fine, 2);
        let positions: Vec<(usize, f32)> = linear
            .shares()
            .map(|(first, shares)| (first, shares[1] as f32))
            .collect();
        let share = |node: usize, &(before, next): &(usize, f32)| match node.wrapping_sub(before) {
            0 => 1.0 - next,
            1 => next,
            _ => 0.0,
        };
        let gather = |node: usize| {
            let shares = positions.iter().map(|position| share(node, position));
            let mut shares: Vec<f32> = shares.collect();
            let first = shares.iter().position(|share| *share != 0.0).unwrap_or(0);
            shares.drain(..first);
            let end = shares.iter().rposition(|share| *share != 0.0);
            shares.truncate(end.map_or(0, |end| end + 1));
            (first, shares)
        };
        Self {
            coarse: (0..coarse.len()).map(gather).collect(),
            fine: positions,
        }
    }
}

/// The linear prolongation from a coarser grid and its transpose.
#[derive(Clone, Debug)]
pub struct Transfer([Axis; 2]);

impl Transfer {
    /// The prolongation between two grids with the given coordinates along X and Y.
    pub fn new(coarse: &[Vec<f64>; 2], fine: &[Vec<f64>; 2]) -> Self {
        Self([0, 1].map(|axis| Axis::new(&coarse[axis], &fine[axis])))
    }

    /// b = Pᵀ r on the coarser grid's free lines.
    pub fn restrict(&self, r: &Vector, b: &mut Vector) {
        let [along_x, along_y] = &self.0;
        b.for_each_free_line(|line, b_x, b_y| {
            let (first, shares) = &along_x.coarse[line];
            for (axis, b) in [b_x, b_y].into_iter().enumerate() {
                b.fill(0.0);
                for (offset, share) in shares.iter().enumerate() {
                    let from = &r.line(first + offset)[axis][1..];
                    for ((before, next), r) in along_y.fine.iter().zip(from) {
                        let value = share * r;
                        b[before + 1] += (1.0 - next) * value;
                        b[before + 2] += next * value;
                    }
                }
            }
        });
    }

    /// x += P c on the finer grid's free lines.
    pub fn prolong(&self, c: &Vector, x: &mut Vector) {
        let [along_x, along_y] = &self.0;
        x.for_each_free_line(|line, x_x, x_y| {
            let (before, share) = along_x.fine[line];
            for (axis, x) in [x_x, x_y].into_iter().enumerate() {
                let (first, second) = (c.line(before)[axis], c.line(before + 1)[axis]);
                for ((before, next), x) in along_y.fine.iter().zip(&mut x[1..]) {
                    let at = |position: usize| {
                        first[position] + share * (second[position] - first[position])
                    };
                    *x += (1.0 - next) * at(before + 1) + next * at(before + 2);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_reproduced_between_uneven_nodes() {
        let cubic = |x: f64| 1.0 - x + 2.0 * x * x - 0.3 * x * x * x;
        let nodes = [0.0, 0.4, 1.0, 1.3, 2.5, 3.0];
        let positions = [0.0, 0.1, 0.4, 0.9, 1.2, 2.6, 3.0];
        let interpolation = Interpolation::around(&nodes, &positions, 4);
        for (position, (first, shares)) in positions.iter().zip(interpolation.shares()) {
            let pairs = shares.iter().zip(&nodes[first..]);
            let value: f64 = pairs.map(|(share, node)| share * cubic(*node)).sum();
            assert!((value - cubic(*position)).abs() < 1e-13, "{position}");
        }
    }
}
