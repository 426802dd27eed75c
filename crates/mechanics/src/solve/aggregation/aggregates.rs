//! Aggregates: the nodes of a level in small connected groups, each of which is one node of the next coarser level.

use super::blocks::Blocks;

/// The size of a block relative to those on the diagonal, root of their product, above which two nodes are strongly coupled: on
/// the finest level, whose cells may be long and thin, and on the others.
pub const STRONG: [f64; 2] = [0.15, 0.08];

/// A node with so many times more neighbours than the mean, such as a rigid grip, is an aggregate of its own.
const CROWDED: usize = 6;

/// The aggregate of each node, and how many there are.
pub struct Aggregates {
    /// The aggregate of each node.
    pub of: Vec<u32>,
    /// Their number.
    pub count: usize,
}

const NONE: u32 = u32::MAX;

impl Aggregates {
    /// Groups the nodes of a symmetric matrix, strongly coupled from a relative size of blocks on: a node with all its strongly coupled neighbours where none of these is in a
    /// group yet, then every other node with the neighbour it is coupled with most strongly, then what is left.
    ///
    /// # References
    /// P. Vaněk, J. Mandel, M. Brezina, Computing 56, 179 (1996), doi:10.1007/BF02238511
    pub fn of<const N: usize>(matrix: &Blocks<N, N>, strong_from: f64) -> Self {
        let strengths = strengths(matrix);
        let rows = matrix.rows();
        let crowded = CROWDED * matrix.columns.len() / rows.max(1);
        let lonely = |row: usize| matrix.starts[row + 1] - matrix.starts[row] > crowded;
        let strong = |row: usize| {
            let positions = matrix.starts[row]..matrix.starts[row + 1];
            let all =
                positions.map(|position| (matrix.columns[position] as usize, strengths[position]));
            all.filter(move |(column, strength)| {
                *column != row && *strength > strong_from * strong_from && !lonely(*column)
            })
        };
        let mut of = vec![NONE; rows];
        let mut count = 0;
        for row in 0..rows {
            let alone = lonely(row);
            let free =
                of[row] == NONE && (alone || strong(row).all(|(other, _)| of[other] == NONE));
            if !free {
                continue;
            }
            of[row] = count;
            if !alone {
                strong(row).for_each(|(other, _)| of[other] = count);
            }
            count += 1;
        }
        let roots = of.clone();
        let open = of.iter_mut().enumerate();
        for (row, aggregate) in open.filter(|(_, aggregate)| **aggregate == NONE) {
            let near = strong(row).filter(|(other, _)| roots[*other] != NONE);
            let nearest = near.fold((NONE, 0.0), |best, (other, strength)| {
                let better = strength > best.1;
                if better {
                    (roots[other], strength)
                } else {
                    best
                }
            });
            *aggregate = nearest.0;
        }
        for row in 0..rows {
            if of[row] == NONE {
                of[row] = count;
                for (other, _) in strong(row) {
                    if of[other] == NONE {
                        of[other] = count;
                    }
                }
                count += 1;
            }
        }
        Self {
            of,
            count: count as usize,
        }
    }
}

/// ‖Aᵢₖ‖² / (‖Aᵢᵢ‖ ‖Aₖₖ‖) of every block.
fn strengths<const N: usize>(matrix: &Blocks<N, N>) -> Vec<f64> {
    let square = |block: &[[f64; N]; N]| block.iter().flatten().map(|x| x * x).sum::<f64>();
    let diagonal_size = |row: usize| {
        let diagonal = matrix.row(row).find(|(column, _)| *column == row);
        diagonal.map_or(0.0, |(_, block)| square(block).sqrt())
    };
    let sizes: Vec<f64> = (0..matrix.rows()).map(diagonal_size).collect();
    let of_row = |row: usize| {
        let size = sizes[row];
        let sizes = &sizes;
        matrix
            .row(row)
            .map(move |(column, block)| square(block) / (size * sizes[column]))
    };
    (0..matrix.rows()).flat_map(of_row).collect()
}
