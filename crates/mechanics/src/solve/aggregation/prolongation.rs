//! From the next coarser level: rigid motions of each aggregate, smoothed.
//!
//! ```text
//! T R = B,   P = (1 − ω D⁻¹ A) T,   ω = 4 / (3 λ),   λ ≥ eigenvalues of D⁻¹ A
//! ```
//!
//! B holds the motions without strain, T those of each aggregate, orthonormal, and R the same motions on the coarser level.

use super::aggregates::Aggregates;
use super::blocks::{Blocks, add_matrix_product, add_product};

/// A motion whose part across the others of its aggregate is smaller than this share of it has no unknown of its own.
const DEPENDENT: f64 = 1e-6;

/// The motions without strain at a node: one column each for both translations and the rotation.
pub type Motions<const N: usize> = [[f64; 3]; N];

/// T, one block for each node, and R, one for each aggregate.
pub fn tentative<const N: usize>(
    aggregates: &Aggregates,
    motions: &[Motions<N>],
) -> (Vec<Motions<N>>, Vec<Motions<3>>) {
    let mut members = vec![Vec::new(); aggregates.count];
    for (node, aggregate) in aggregates.of.iter().enumerate() {
        members[*aggregate as usize].push(node);
    }
    let mut rigid = motions.to_vec();
    let coarse = members
        .iter()
        .map(|nodes| orthonormalise(&mut rigid, nodes))
        .collect();
    (rigid, coarse)
}

/// Makes the columns of some nodes orthonormal (Gram and Schmidt, twice); the triangular factor. Dependent columns become zero.
fn orthonormalise<const N: usize>(rigid: &mut [Motions<N>], nodes: &[usize]) -> Motions<3> {
    let mut factor = [[0.0; 3]; 3];
    for column in 0..3 {
        let product = |rigid: &[Motions<N>], a: usize, b: usize| -> f64 {
            let rows = nodes.iter().flat_map(|node| &rigid[*node]);
            rows.map(|row| row[a] * row[b]).sum()
        };
        let original = product(rigid, column, column).sqrt();
        for _ in 0..2 {
            for before in 0..column {
                let share = product(rigid, before, column);
                factor[before][column] += share;
                for node in nodes {
                    for row in &mut rigid[*node] {
                        row[column] -= share * row[before];
                    }
                }
            }
        }
        let length = product(rigid, column, column).sqrt();
        let independent = length > DEPENDENT * original;
        factor[column][column] = if independent { length } else { 0.0 };
        let scale = if independent { 1.0 / length } else { 0.0 };
        for node in nodes {
            for row in &mut rigid[*node] {
                row[column] *= scale;
            }
        }
    }
    factor
}

/// P; `inverses` are those of the blocks on the diagonal.
pub fn smoothed<const N: usize>(
    matrix: &Blocks<N, N>,
    inverses: &[[[f64; N]; N]],
    aggregates: &Aggregates,
    rigid: &[Motions<N>],
) -> Blocks<N, 3> {
    const NONE: u32 = u32::MAX;
    let weight = 4.0 / (3.0 * largest_eigenvalue(matrix, inverses));
    let mut positions = vec![NONE; aggregates.count];
    let mut prolongation = Blocks {
        starts: vec![0],
        ..Blocks::default()
    };
    let mut sums: Vec<(u32, Motions<N>)> = Vec::new();
    for row in 0..matrix.rows() {
        sums.clear();
        let row_aggregate = aggregates.of[row];
        positions[row_aggregate as usize] = 0;
        sums.push((row_aggregate, [[0.0; 3]; N]));
        for (node, block) in matrix.row(row) {
            let aggregate = aggregates.of[node];
            let position = &mut positions[aggregate as usize];
            if *position == NONE {
                *position = sums.len() as u32;
                sums.push((aggregate, [[0.0; 3]; N]));
            }
            add_matrix_product(&mut sums[*position as usize].1, block, &rigid[node]);
        }
        for (aggregate, sum) in &mut sums {
            let image = *sum;
            *sum = if *aggregate == row_aggregate {
                rigid[row]
            } else {
                [[0.0; 3]; N]
            };
            for (i, entries) in inverses[row].iter().enumerate() {
                for (entry, image) in entries.iter().zip(&image) {
                    for k in 0..3 {
                        sum[i][k] -= weight * entry * image[k];
                    }
                }
            }
        }
        sums.sort_unstable_by_key(|(aggregate, _)| *aggregate);
        for (aggregate, sum) in &sums {
            positions[*aggregate as usize] = NONE;
            prolongation.columns.push(*aggregate);
            prolongation.values.push(*sum);
        }
        prolongation.starts.push(prolongation.columns.len());
    }
    prolongation
}

/// The largest eigenvalue of D⁻¹ A by a few steps of the power method, made safe.
fn largest_eigenvalue<const N: usize>(matrix: &Blocks<N, N>, inverses: &[[[f64; N]; N]]) -> f64 {
    const STEPS: usize = 6;
    const MARGIN: f64 = 1.1;
    let size = matrix.rows();
    let irregular = super::super::krylov::irregular(N * size, 0);
    let chunks = irregular.chunks_exact(N);
    let mut now: Vec<[f64; N]> = chunks
        .map(|entries| std::array::from_fn(|i| entries[i]))
        .collect();
    let mut image = vec![[0.0; N]; size];
    let mut quotient = 1.0;
    for _ in 0..STEPS {
        matrix.multiply(&now, &mut image);
        let (mut above, mut below, mut most) = (0.0, 0.0, 0.0_f64);
        for ((now, image), inverse) in now.iter_mut().zip(&image).zip(inverses) {
            let mut next = [0.0; N];
            add_product(&mut next, inverse, image);
            for i in 0..N {
                // x · A x and (D⁻¹ A x) · A x: the second over the first is a Rayleigh quotient of D⁻¹ A.
                below += now[i] * image[i];
                above += next[i] * image[i];
                most = most.max(next[i].abs());
            }
            *now = next;
        }
        quotient = above / below;
        let scale = 1.0 / most;
        now.iter_mut().flatten().for_each(|x| *x *= scale);
    }
    MARGIN * quotient
}
