//! Unknowns by nodes with two each, and conjugate gradients for their stiffness.

use super::aggregation::Motions;
use super::krylov::irregular;
use super::sparse::FactorFault;
use crate::statistics::extremes;

mod matrix;

pub use matrix::NodalMatrix;

/// The node and the component of each unknown of a stiffness. A component that is not an unknown, because it is held,
/// does not move: its row is that of the identity.
#[derive(Clone)]
pub struct Nodes {
    /// For each unknown: its node, and 0 or 1.
    of: Vec<(u32, u8)>,
    /// The position of each node, relative to the middle of all and to their extent.
    positions: Vec<[f64; 2]>,
    /// Which components of each node are unknowns.
    free: Vec<[bool; 2]>,
}

impl Nodes {
    /// The nodes of some unknowns, ascending, with their positions: unknowns 2 n and 2 n + 1 belong to node n.
    pub fn new(unknowns: &[usize], all_places: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut of = Vec::with_capacity(unknowns.len());
        let count = unknowns.chunk_by(|a, b| a / 2 == b / 2).count();
        let mut positions = Vec::with_capacity(count);
        let mut free = Vec::<[bool; 2]>::with_capacity(count);
        let mut last = usize::MAX;
        for (unknown, position) in unknowns.iter().zip(all_places) {
            if unknown / 2 != last {
                last = unknown / 2;
                positions.push(position);
                free.push([false; 2]);
            }
            let node = free.len() - 1;
            free[node][unknown % 2] = true;
            of.push((node as u32, (unknown % 2) as u8));
        }
        let extent = [0, 1].map(|axis| extremes(positions.iter().map(|position| position[axis])));
        let size = extent
            .iter()
            .fold(f64::MIN_POSITIVE, |size, [low, high]| size.max(high - low));
        for position in &mut positions {
            for (x, [low, high]) in position.iter_mut().zip(extent) {
                *x = (*x - 0.5 * (low + high)) / size;
            }
        }
        Self {
            of,
            positions,
            free,
        }
    }

    /// The number of nodes.
    pub fn count(&self) -> usize {
        self.positions.len()
    }

    /// The node of an unknown, and 0 or 1.
    pub fn of_unknown(&self, unknown: usize) -> (usize, usize) {
        let (node, component) = self.of[unknown];
        (node as usize, usize::from(component))
    }

    /// Translations and rotation of the components that are unknowns.
    pub fn motions(&self) -> Vec<Motions<2>> {
        let nodes = self.positions.iter().zip(&self.free);
        let motion = |([x, y], free): (&[f64; 2], &[bool; 2])| {
            let rows = [[1.0, 0.0, -y], [0.0, 1.0, *x]];
            [0, 1].map(|axis| if free[axis] { rows[axis] } else { [0.0; 3] })
        };
        nodes.map(motion).collect()
    }

    /// The components of all nodes, zero where there is no unknown.
    pub fn spread(&self, entries: &[f64]) -> Vec<[f64; 2]> {
        let mut all = vec![[0.0; 2]; self.positions.len()];
        for ((node, component), entry) in self.of.iter().zip(entries) {
            all[*node as usize][usize::from(*component)] = *entry;
        }
        all
    }

    /// Forces without any symmetry, with a large part of every smooth mode and some part of every other.
    pub fn uneven(&self) -> Vec<[f64; 2]> {
        let rough = irregular(2 * self.positions.len(), 1);
        let nodes = self
            .positions
            .iter()
            .zip(rough.chunks_exact(2))
            .zip(&self.free);
        let force = |(([x, y], rough), free): ((&[f64; 2], &[f64]), &[bool; 2])| {
            let smooth = [
                (7.3 * x + 3.1 * y + 1.0).sin() + (4.1 * y + 0.3).cos() + 0.7 * x,
                (6.1 * y - 2.3 * x + 0.4).sin() + (5.3 * x + 0.9).cos() - 0.6 * y,
            ];
            [0, 1].map(|axis| {
                if free[axis] {
                    smooth[axis] + rough[axis]
                } else {
                    0.0
                }
            })
        };
        nodes.map(force).collect()
    }

    /// The unknowns among the components of all nodes.
    pub fn gather(&self, all: &[[f64; 2]]) -> Vec<f64> {
        let entry = |(node, component): &(u32, u8)| all[*node as usize][usize::from(*component)];
        self.of.iter().map(entry).collect()
    }
}

/// The result of conjugate gradients.
pub struct Solution {
    /// The approximate solution.
    pub x: Vec<[f64; 2]>,
    /// Iterations, each one product and one cycle.
    pub iterations: usize,
    /// ‖b − A x‖_M over ‖b‖_M, with the preconditioner's norm, before the last iteration that was allowed, or where the iteration ended before.
    pub reduction: f64,
}

/// x of A x = b by conjugate gradients with a preconditioner z = M r, for so many iterations, or until the residual has fallen by `reduction`.
pub fn conjugate_gradients(
    matrix: &NodalMatrix,
    mut precondition: impl FnMut(&[[f64; 2]], &mut [[f64; 2]]),
    b: &[[f64; 2]],
    reduction: f64,
    most: usize,
) -> Result<Solution, FactorFault> {
    let size = b.len();
    let mut r = b.to_vec();
    let mut z = vec![[0.0; 2]; size];
    precondition(&r, &mut z);
    let mut square = product(&r, &z);
    let first = square;
    let mut solution = Solution {
        x: vec![[0.0; 2]; size],
        iterations: 0,
        reduction: 1.0,
    };
    if first == 0.0 {
        solution.reduction = 0.0;
        return Ok(solution);
    }
    let mut direction = z.clone();
    let mut image = vec![[0.0; 2]; size];
    while solution.iterations < most && solution.reduction > reduction {
        matrix.multiply(&direction, &mut image);
        let stiffness = product(&direction, &image);
        if !(stiffness > 0.0 && square > 0.0) {
            return Err(FactorFault::NotPositiveDefinite);
        }
        let length = square / stiffness;
        add(&mut solution.x, length, &direction);
        add(&mut r, -length, &image);
        solution.iterations += 1;
        if solution.iterations == most {
            break;
        }
        // z of the iteration before: rounding makes the preconditioner slightly unsymmetric (Polak and Ribière).
        let last = product(&r, &z);
        precondition(&r, &mut z);
        let next = product(&r, &z);
        let beta = (next - last) / square;
        for (direction, z) in direction.iter_mut().zip(&z) {
            for axis in 0..2 {
                direction[axis] = z[axis] + beta * direction[axis];
            }
        }
        square = next;
        solution.reduction = (next.max(0.0) / first).sqrt();
    }
    Ok(solution)
}

/// a ← a + s b.
fn add(a: &mut [[f64; 2]], s: f64, b: &[[f64; 2]]) {
    for (a, b) in a.iter_mut().zip(b) {
        for (a, b) in a.iter_mut().zip(b) {
            *a += s * b;
        }
    }
}

/// a · b.
pub fn product(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let terms = a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]);
    terms.sum()
}
