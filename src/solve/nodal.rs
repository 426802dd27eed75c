//! A stiffness by nodes with two unknowns each, and conjugate gradients for it.

use super::aggregation::Motions;
use super::aggregation::blocks::Blocks;
use super::krylov::irregular;
use super::pattern::SymmetricPattern;
use super::sparse::FactorFault;
use crate::statistics::extremes;

/// Which node and component each unknown of a stiffness is. A component without an unknown, because it is held, is
/// one that nothing moves: its row is that of the identity.
#[derive(Clone)]
pub struct Nodes {
    /// Of each unknown: its node, and 0 or 1.
    of: Vec<(u32, u8)>,
    /// Where each node is, relative to the middle of all and to their extent.
    places: Vec<[f64; 2]>,
    /// Which components of each node are unknowns.
    free: Vec<[bool; 2]>,
}

/// A stiffness by nodes.
pub struct NodalMatrix {
    /// The blocks of nodes.
    pub blocks: Blocks<2, 2>,
    /// For each stored entry of the symmetric pattern its block below or on the diagonal, and the one above it.
    slots: Vec<[u32; 2]>,
}

impl Nodes {
    /// The nodes of some unknowns with their places, ascending: 2 n and 2 n + 1 are those of node n.
    pub fn new(unknowns: &[usize], all_places: &[[f64; 2]]) -> Self {
        let (mut of, mut places, mut free) = (Vec::new(), Vec::new(), Vec::<[bool; 2]>::new());
        let mut last = usize::MAX;
        for (unknown, place) in unknowns.iter().zip(all_places) {
            if unknown / 2 != last {
                last = unknown / 2;
                places.push(*place);
                free.push([false; 2]);
            }
            let node = free.len() - 1;
            free[node][unknown % 2] = true;
            of.push((node as u32, (unknown % 2) as u8));
        }
        let extent = [0, 1].map(|axis| extremes(places.iter().map(|place| place[axis])));
        let size = extent
            .iter()
            .fold(f64::MIN_POSITIVE, |size, [low, high]| size.max(high - low));
        for place in &mut places {
            for (x, [low, high]) in place.iter_mut().zip(extent) {
                *x = (*x - 0.5 * (low + high)) / size;
            }
        }
        Self { of, places, free }
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// The node of an unknown, and 0 or 1.
    pub fn of_unknown(&self, unknown: usize) -> (usize, usize) {
        let (node, component) = self.of[unknown];
        (node as usize, usize::from(component))
    }

    /// Translations and rotation of the components that are unknowns.
    pub fn motions(&self) -> Vec<Motions<2>> {
        let nodes = self.places.iter().zip(&self.free);
        let motion = |([x, y], free): (&[f64; 2], &[bool; 2])| {
            let rows = [[1.0, 0.0, -y], [0.0, 1.0, *x]];
            [0, 1].map(|axis| if free[axis] { rows[axis] } else { [0.0; 3] })
        };
        nodes.map(motion).collect()
    }

    /// The components of all nodes, zero where there is no unknown.
    pub fn spread(&self, entries: &[f64]) -> Vec<[f64; 2]> {
        let mut all = vec![[0.0; 2]; self.places.len()];
        for ((node, component), entry) in self.of.iter().zip(entries) {
            all[*node as usize][usize::from(*component)] = *entry;
        }
        all
    }

    /// Forces without any symmetry, with a large part of every smooth mode and some of every other.
    pub fn uneven(&self) -> Vec<[f64; 2]> {
        let rough = irregular(2 * self.places.len(), 1);
        let nodes = self
            .places
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

impl NodalMatrix {
    /// The matrix of a pattern over the unknowns of some nodes; its values are taken later.
    pub fn new(nodes: &Nodes, pattern: &SymmetricPattern) -> Self {
        let (starts, columns) = adjacency(nodes, pattern);
        let blocks = Blocks {
            values: vec![[[0.0; 2]; 2]; columns.len()],
            starts,
            columns,
        };
        let find = |row: u32, column: u32| {
            let start = blocks.starts[row as usize];
            let own = &blocks.columns[start..blocks.starts[row as usize + 1]];
            let place = own.binary_search(&column);
            (start + place.expect("a block of the pattern")) as u32
        };
        let mut slots = Vec::with_capacity(pattern.entries());
        for column in 0..pattern.size() {
            let to = nodes.of[column].0;
            let mut found = (u32::MAX, [0; 2]);
            for row in pattern.column(column) {
                let from = nodes.of[*row].0;
                if from != found.0 {
                    found = (from, [find(from, to), find(to, from)]);
                }
                slots.push(found.1);
            }
        }
        Self { blocks, slots }
    }

    /// Takes the values of a pattern.
    pub fn take(&mut self, nodes: &Nodes, pattern: &SymmetricPattern, values: &[f64]) {
        self.blocks.values.fill([[0.0; 2]; 2]);
        let mut entries = self.slots.iter().zip(values);
        for column in 0..pattern.size() {
            let k = usize::from(nodes.of[column].1);
            for row in pattern.column(column) {
                let i = usize::from(nodes.of[*row].1);
                let ([lower, upper], value) = entries.next().expect("a value each");
                self.blocks.values[*lower as usize][i][k] = *value;
                self.blocks.values[*upper as usize][k][i] = *value;
            }
        }
        for (node, free) in nodes.free.iter().enumerate() {
            for axis in (0..2).filter(|axis| !free[*axis]) {
                let start = self.blocks.starts[node];
                let own = &self.blocks.columns[start..self.blocks.starts[node + 1]];
                let place = own.binary_search(&(node as u32)).expect("a diagonal");
                self.blocks.values[start + place][axis][axis] = 1.0;
            }
        }
    }
}

/// The nodes that each node is coupled with, itself among them, ascending: where those of each begin, and all of them.
fn adjacency(nodes: &Nodes, pattern: &SymmetricPattern) -> (Vec<usize>, Vec<u32>) {
    let count = nodes.places.len();
    let (mut above, mut begins) = (Vec::<u32>::new(), vec![0]);
    let (mut own, mut column) = (Vec::new(), 0);
    for unknowns in nodes.of.chunk_by(|one, other| one.0 == other.0) {
        let node = unknowns[0].0;
        own.clear();
        for _ in unknowns {
            let rows = pattern.column(column).iter().map(|row| nodes.of[*row].0);
            own.extend(rows.filter(|row| *row > node));
            column += 1;
        }
        own.sort_unstable();
        own.dedup();
        above.extend_from_slice(&own);
        begins.push(above.len());
    }
    let above = |node: usize| &above[begins[node]..begins[node + 1]];
    let mut starts = vec![0; count + 1];
    for node in 0..count {
        starts[node + 1] += 1 + above(node).len();
        above(node)
            .iter()
            .for_each(|other| starts[*other as usize + 1] += 1);
    }
    for node in 0..count {
        starts[node + 1] += starts[node];
    }
    let (mut columns, mut next) = (vec![0; starts[count]], starts.clone());
    let mut put = |node: usize, other: u32| {
        columns[next[node]] = other;
        next[node] += 1;
    };
    for node in 0..count {
        // All nodes below have put themselves here before.
        put(node, node as u32);
        above(node)
            .iter()
            .for_each(|other| put(*other as usize, node as u32));
    }
    for node in 0..count {
        above(node).iter().for_each(|other| put(node, *other));
    }
    (starts, columns)
}

/// What conjugate gradients found.
pub struct Found {
    /// The approximate solution.
    pub x: Vec<[f64; 2]>,
    /// Iterations, each one product and one cycle.
    pub iterations: usize,
    /// ‖b‖_M, with the preconditioner's norm.
    pub first: f64,
    /// ‖b − A x‖_M over ‖b‖_M.
    pub reduction: f64,
}

/// x of A x = b by conjugate gradients with a preconditioner z = M r, for so many iterations, or until the residual has fallen by what is
/// wanted at its first size.
///
/// # Errors
/// [`FactorFault::NotPositiveDefinite`] where a direction has no positive stiffness.
pub fn conjugate_gradients(
    matrix: &Blocks<2, 2>,
    mut precondition: impl FnMut(&[[f64; 2]], &mut [[f64; 2]]),
    b: &[[f64; 2]],
    reduction: impl FnOnce(f64) -> f64,
    most: usize,
) -> Result<Found, FactorFault> {
    let size = b.len();
    let mut r = b.to_vec();
    let mut z = vec![[0.0; 2]; size];
    precondition(&r, &mut z);
    let mut square = product(&r, &z);
    let first = square;
    let mut found = Found {
        x: vec![[0.0; 2]; size],
        iterations: 0,
        first: first.max(0.0).sqrt(),
        reduction: 1.0,
    };
    let reduction = reduction(found.first);
    if first == 0.0 {
        found.reduction = 0.0;
        return Ok(found);
    }
    let mut direction = z.clone();
    let mut image = vec![[0.0; 2]; size];
    while found.iterations < most && found.reduction > reduction {
        matrix.multiply(&direction, &mut image);
        let stiffness = product(&direction, &image);
        if !(stiffness > 0.0 && square > 0.0) {
            return Err(FactorFault::NotPositiveDefinite);
        }
        let length = square / stiffness;
        for i in 0..size {
            for axis in 0..2 {
                found.x[i][axis] += length * direction[i][axis];
                r[i][axis] -= length * image[i][axis];
            }
        }
        // z of before: rounding makes the preconditioner slightly unsymmetric (Polak and Ribière).
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
        found.iterations += 1;
        found.reduction = (next.max(0.0) / first).sqrt();
    }
    Ok(found)
}

/// a · b.
pub fn product(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let terms = a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1]);
    terms.sum()
}
