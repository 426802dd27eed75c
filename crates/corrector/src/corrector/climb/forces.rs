//! The governing equation F(u) = ∂Π/∂u on a grid, evaluated for many elements at a time.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::grid::{Field, Grid};
use super::sweep::Part;
use crate::corrector::sampling::Rule;
use crate::material::HyperelasticLaw;

/// Most elements that are evaluated together, and most of their points: their numbers stay in the nearest cache.
const MOST: usize = 32;
const CAPACITY: usize = 9 * MOST;

/// Numbers of double precision in the widest vector of present machines.
const VECTOR: usize = 8;

/// Least number of columns of elements that one thread handles at a time.
const COLUMNS_AT_ONCE: usize = 8;

/// F(u) in N at all nodes, from elements with `NODES` nodes along each axis; at the grips these are the reactions.
/// Returns whether all points are admissible, J > 0.
pub fn forces<const NODES: usize>(
    law: &dyn HyperelasticLaw,
    thickness: f64,
    grid: &Grid,
    rule: &Rule<NODES>,
    u: &Field,
    forces: &mut Field,
) -> bool {
    let order = NODES - 1;
    let columns = (grid.coordinates[0].len() - 1) / order;
    let [f_x, f_y] = &mut forces.components;
    Part::all(grid.lines()).sweep([f_x, f_y], [], &|_, changed, []| {
        changed.into_iter().for_each(|numbers| numbers.fill(0.0));
        []
    });
    // Columns share their border lines: first the even ones, then the odd ones, so that each sum has two terms.
    let mut admissible = true;
    for colour in [0, 1] {
        let offset = colour * order * u.width;
        let pair = 2 * order * u.width;
        let pairs = (columns - colour).div_ceil(2);
        let threads = grid.lines().threaded();
        let at_once = if threads {
            COLUMNS_AT_ONCE
        } else {
            pairs.max(1)
        };
        let work = |(chunk, (f_x, f_y)): (usize, (&mut [f64], &mut [f64]))| {
            let first = chunk * at_once;
            let columns = Columns {
                first: 2 * first + colour,
                count: at_once.min(pairs - first),
                elements: (u.width - 1) / order,
            };
            let sheet = (law, thickness, grid, rule);
            Workspace::<NODES>::new().columns(sheet, u, columns, [f_x, f_y])
        };
        if offset >= f_x.len() || pairs == 0 {
            continue;
        }
        let (f_x, f_y) = (&mut f_x[offset..], &mut f_y[offset..]);
        let size = at_once * pair;
        admissible &= if threads {
            let chunks = f_x.par_chunks_mut(size).zip(f_y.par_chunks_mut(size));
            chunks.enumerate().map(work).reduce(|| true, |a, b| a & b)
        } else {
            let chunks = f_x.chunks_mut(size).zip(f_y.chunks_mut(size));
            chunks.enumerate().map(work).fold(true, |a, b| a & b)
        };
    }
    admissible
}

type Plate<'a, const NODES: usize> = (&'a dyn HyperelasticLaw, f64, &'a Grid, &'a Rule<NODES>);

/// Every second one of some columns of elements.
#[derive(Clone, Copy)]
struct Columns {
    first: usize,
    count: usize,
    /// The number of elements in each column.
    elements: usize,
}

/// Neighbours in a column that are evaluated together.
struct Run {
    /// The number of the column among those of its kind.
    position: usize,
    first: usize,
    count: usize,
    /// Where they begin in the block.
    lane: usize,
}

impl Columns {
    /// The runs of a block of elements, column by column.
    fn runs(self, block: Range<usize>) -> impl Iterator<Item = Run> {
        let positions = block.start / self.elements..block.end.div_ceil(self.elements);
        positions.map(move |position| {
            let begin = position * self.elements;
            let from = block.start.max(begin);
            Run {
                position,
                first: from - begin,
                count: block.end.min(begin + self.elements) - from,
                lane: from - block.start,
            }
        })
    }

    /// The column of a run.
    fn column(self, run: &Run) -> usize {
        self.first + 2 * run.position
    }
}

/// Elements with so many nodes along each axis that are evaluated together: a multiple of the vector length.
const fn block(nodes: usize) -> usize {
    let elements = CAPACITY / (nodes * nodes) / VECTOR * VECTOR;
    assert!(elements > 0);
    if elements < MOST { elements } else { MOST }
}

/// A block of elements: numbers of one kind lie side by side, one for each element. It is on the stack, so that an evaluation allocates nothing.
struct Workspace<const NODES: usize> {
    /// Displacements of axis, line and node along Y.
    displacements: [f64; 2 * CAPACITY],
    /// Forces of axis, line and node along Y.
    forces: [f64; 2 * CAPACITY],
    gradients: [[f64; CAPACITY]; 4],
    stresses: [[f64; CAPACITY]; 4],
    /// Sides of the elements along X and Y in mm.
    sides: [[f64; MOST]; 2],
}

/// The numbers of a vector that begin at a position.
#[inline(always)]
fn load<S: Simd>(numbers: &[f64], position: usize) -> S::f64s {
    S::as_simd_f64s(&numbers[position..position + S::F64_LANES]).0[0]
}

#[inline(always)]
fn store<S: Simd>(numbers: &mut [f64], position: usize, vector: S::f64s) {
    S::as_mut_simd_f64s(&mut numbers[position..position + S::F64_LANES]).0[0] = vector;
}

/// Σ cₖ xₖ.
#[inline(always)]
fn combine<S: Simd, const NODES: usize>(
    simd: S,
    factors: &[f64; NODES],
    vectors: [S::f64s; NODES],
) -> S::f64s {
    let mut sum = simd.mul_f64s(simd.splat_f64s(factors[0]), vectors[0]);
    for k in 1..NODES {
        sum = simd.mul_add_e_f64s(simd.splat_f64s(factors[k]), vectors[k], sum);
    }
    sum
}

impl<const NODES: usize> Workspace<NODES> {
    const BLOCK: usize = block(NODES);

    fn new() -> Self {
        Self {
            displacements: [0.0; 2 * CAPACITY],
            forces: [0.0; 2 * CAPACITY],
            gradients: [[0.0; CAPACITY]; 4],
            stresses: [[0.0; CAPACITY]; 4],
            sides: [[1.0; MOST]; 2],
        }
    }

    /// Adds the forces of some columns of elements to those of their lines, which begin with that of the first column.
    fn columns(
        &mut self,
        (law, thickness, grid, rule): Plate<'_, NODES>,
        u: &Field,
        columns: Columns,
        mut forces: [&mut [f64]; 2],
    ) -> bool {
        let elements = columns.count * columns.elements;
        let mut admissible = true;
        for first in (0..elements).step_by(Self::BLOCK) {
            let block = first..(first + Self::BLOCK).min(elements);
            let padded = block.len().next_multiple_of(VECTOR);
            for run in columns.runs(block.clone()) {
                self.gather(grid, u, columns.column(&run), &run);
            }
            self.pad(block.len(), padded);
            let points = padded * NODES * NODES;
            Arch::new().dispatch(Gradients {
                rule,
                padded,
                sides: &self.sides,
                displacements: &self.displacements,
                gradients: self.gradients.each_mut().map(|h| &mut h[..points]),
            });
            admissible &= law.stresses(
                self.gradients.each_ref().map(|h| &h[..points]),
                self.stresses.each_mut().map(|p| &mut p[..points]),
            );
            Arch::new().dispatch(NodalForces {
                rule,
                thickness,
                padded,
                sides: &self.sides,
                stresses: self.stresses.each_ref().map(|p| &p[..points]),
                forces: &mut self.forces,
            });
            for run in columns.runs(block) {
                self.add(u.width, &run, &mut forces);
            }
        }
        admissible
    }

    /// Copies the displacements of some elements of a column.
    fn gather(&mut self, grid: &Grid, u: &Field, column: usize, run: &Run) {
        let order = NODES - 1;
        let lanes = run.lane..run.lane + run.count;
        let width = grid.span(0, column * order, (column + 1) * order);
        self.sides[0][lanes.clone()].fill(width);
        for (element, height) in self.sides[1][lanes.clone()].iter_mut().enumerate() {
            let node = (run.first + element) * order;
            *height = grid.span(1, node, node + order);
        }
        let mut kinds = self.displacements.chunks_exact_mut(Self::BLOCK);
        for component in &u.components {
            for line in 0..NODES {
                let line = &component[(column * order + line) * u.width..][..u.width];
                for node in 0..NODES {
                    let kind = kinds.next().expect("a place for each node");
                    let from = line[run.first * order + node..].iter().step_by(order);
                    let to = kind[lanes.clone()].iter_mut();
                    to.zip(from).for_each(|(to, u)| *to = *u);
                }
            }
        }
    }

    /// Repeats the last of some elements up to a multiple of the vector length.
    fn pad(&mut self, count: usize, padded: usize) {
        let displacements = self.displacements.chunks_exact_mut(Self::BLOCK);
        let kinds = displacements.take(2 * NODES * NODES);
        for kind in kinds.chain(self.sides.iter_mut().map(|side| &mut side[..])) {
            let last = kind[count - 1];
            kind[count..padded].fill(last);
        }
    }

    /// Adds the nodal forces of some elements of a column to its lines. Of two elements at a node, the one below comes first,
    /// wherever blocks begin.
    fn add(&self, width: usize, run: &Run, forces: &mut [&mut [f64]; 2]) {
        let order = NODES - 1;
        let column = 2 * run.position * order * width + run.first * order;
        for (axis, forces) in forces.iter_mut().enumerate() {
            for line in 0..NODES {
                let target = &mut forces[column + line * width..][..run.count * order + 1];
                for node in (0..NODES).rev() {
                    let kind = (axis * NODES + line) * NODES + node;
                    let forces_of_run = &self.forces[kind * Self::BLOCK + run.lane..][..run.count];
                    let target = target[node..].iter_mut().step_by(order);
                    target
                        .zip(forces_of_run)
                        .for_each(|(sum, force)| *sum += force);
                }
            }
        }
    }
}

struct Gradients<'a, const NODES: usize> {
    rule: &'a Rule<NODES>,
    padded: usize,
    sides: &'a [[f64; MOST]; 2],
    displacements: &'a [f64],
    gradients: [&'a mut [f64]; 4],
}

impl<const NODES: usize> WithSimd for Gradients<'_, NODES> {
    type Output = ();

    /// ∂u/∂X = Σ φ (Σ φ′ u) / hx, ∂u/∂Y = Σ φ′ (Σ φ u) / hy: the inner sums over lines, the outer ones along them.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Rule {
            values,
            derivatives,
            ..
        } = self.rule;
        let [h11, h12, h21, h22] = self.gradients;
        let mut components = [[h11, h12], [h21, h22]];
        let (zero, one) = (simd.splat_f64s(0.0), simd.splat_f64s(1.0));
        for first in (0..self.padded).step_by(S::F64_LANES) {
            let by_width = simd.div_f64s(one, load::<S>(&self.sides[0], first));
            let by_height = simd.div_f64s(one, load::<S>(&self.sides[1], first));
            for (axis, [h_x, h_y]) in components.iter_mut().enumerate() {
                for across in 0..NODES {
                    let (mut slopes, mut means) = ([zero; NODES], [zero; NODES]);
                    for node in 0..NODES {
                        let mut u = [zero; NODES];
                        for (line, u) in u.iter_mut().enumerate() {
                            let kind = (axis * NODES + line) * NODES + node;
                            *u = load::<S>(self.displacements, kind * block(NODES) + first);
                        }
                        slopes[node] = combine(simd, &derivatives[across], u);
                        means[node] = combine(simd, &values[across], u);
                    }
                    for along in 0..NODES {
                        let position = (across * NODES + along) * self.padded + first;
                        let x = combine(simd, &values[along], slopes);
                        let y = combine(simd, &derivatives[along], means);
                        store::<S>(h_x, position, simd.mul_f64s(by_width, x));
                        store::<S>(h_y, position, simd.mul_f64s(by_height, y));
                    }
                }
            }
        }
    }
}

struct NodalForces<'a, const NODES: usize> {
    rule: &'a Rule<NODES>,
    thickness: f64,
    padded: usize,
    sides: &'a [[f64; MOST]; 2],
    stresses: [&'a [f64]; 4],
    forces: &'a mut [f64],
}

impl<const NODES: usize> WithSimd for NodalForces<'_, NODES> {
    type Output = ();

    /// The transpose of [`Gradients`], weighted with the volume V = t hx hy of each point.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let values = weighted(&self.rule.weights, &self.rule.values);
        let derivatives = weighted(&self.rule.weights, &self.rule.derivatives);
        let thickness = simd.splat_f64s(self.thickness);
        let zero = simd.splat_f64s(0.0);
        let [p11, p12, p21, p22] = self.stresses;
        for first in (0..self.padded).step_by(S::F64_LANES) {
            let by_x = simd.mul_f64s(thickness, load::<S>(&self.sides[1], first));
            let by_y = simd.mul_f64s(thickness, load::<S>(&self.sides[0], first));
            for (axis, [p_x, p_y]) in [[p11, p12], [p21, p22]].into_iter().enumerate() {
                for node in 0..NODES {
                    let (mut x, mut y) = ([zero; NODES], [zero; NODES]);
                    for across in 0..NODES {
                        let (mut along_x, mut along_y) = ([zero; NODES], [zero; NODES]);
                        for along in 0..NODES {
                            let position = (across * NODES + along) * self.padded + first;
                            along_x[along] = load::<S>(p_x, position);
                            along_y[along] = load::<S>(p_y, position);
                        }
                        x[across] = simd.mul_f64s(by_x, combine(simd, &values[node], along_x));
                        y[across] = simd.mul_f64s(by_y, combine(simd, &derivatives[node], along_y));
                    }
                    for line in 0..NODES {
                        let sum = simd.add_f64s(
                            combine(simd, &derivatives[line], x),
                            combine(simd, &values[line], y),
                        );
                        let kind = (axis * NODES + line) * NODES + node;
                        store::<S>(self.forces, kind * block(NODES) + first, sum);
                    }
                }
            }
        }
    }
}

/// The contribution of each point to each node, from that of each node to each point: the transpose, weighted.
#[inline(always)]
fn weighted<const NODES: usize>(
    weights: &[f64; NODES],
    of_point: &[[f64; NODES]; NODES],
) -> [[f64; NODES]; NODES] {
    let mut of_node = [[0.0; NODES]; NODES];
    for (point, weight) in weights.iter().enumerate() {
        for (node, of_node) in of_node.iter_mut().enumerate() {
            of_node[point] = weight * of_point[point][node];
        }
    }
    of_node
}
