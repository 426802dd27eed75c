//! The governing equation F(u) = ∂Π/∂u on a grid, evaluated for many elements at a time.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::grid::{Field, Grid, Rule};
use crate::material::HyperelasticLaw;

/// Elements of a column that are evaluated together: their numbers stay in the nearest cache.
const BLOCK: usize = 32;

/// Numbers of double precision in the widest vector of today's machines.
const VECTOR: usize = 8;

/// Elements that one thread does in one go at least, times their nodes.
const COLUMNS_AT_ONCE: usize = 8;

/// F(u) in N at all nodes, of elements with `NODES` nodes along each axis; at the grips these are the reactions.
/// Whether all points are admissible, J > 0.
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
    f_x.fill(0.0);
    f_y.fill(0.0);
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
            let mut workspace = Workspace::<NODES>::new();
            let mut admissible = true;
            let columns =
                (chunk * at_once..pairs.min((chunk + 1) * at_once)).map(|pair| 2 * pair + colour);
            for (place, column) in columns.enumerate() {
                let here = place * pair;
                let end = (here + (order + 1) * u.width).min(f_x.len());
                admissible &= workspace.column(
                    (law, thickness, grid, rule),
                    u,
                    column,
                    [&mut f_x[here..end], &mut f_y[here..end]],
                );
            }
            admissible
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

/// Points of an element at most, and nodes.
const POINTS: usize = 9;

/// A block of elements: numbers of one kind lie side by side, one for each element. On the stack: an evaluation
/// allocates nothing.
struct Workspace<const NODES: usize> {
    /// Displacements of axis, line and node along Y.
    displacements: [f64; 2 * POINTS * BLOCK],
    /// Forces of axis, line and node along Y.
    forces: [f64; 2 * POINTS * BLOCK],
    gradients: [[f64; POINTS * BLOCK]; 4],
    stresses: [[f64; POINTS * BLOCK]; 4],
    lengths: [f64; BLOCK],
}

/// The numbers of a vector that begin at a place.
#[inline(always)]
fn load<S: Simd>(numbers: &[f64], place: usize) -> S::f64s {
    S::as_simd_f64s(&numbers[place..place + S::F64_LANES]).0[0]
}

#[inline(always)]
fn store<S: Simd>(numbers: &mut [f64], place: usize, vector: S::f64s) {
    S::as_mut_simd_f64s(&mut numbers[place..place + S::F64_LANES]).0[0] = vector;
}

/// sum + factor · vector.
#[inline(always)]
fn add_product<S: Simd>(simd: S, sum: S::f64s, factor: f64, vector: S::f64s) -> S::f64s {
    simd.add_f64s(sum, simd.mul_f64s(simd.splat_f64s(factor), vector))
}

impl<const NODES: usize> Workspace<NODES> {
    fn new() -> Self {
        const { assert!(NODES * NODES <= POINTS) };
        Self {
            displacements: [0.0; 2 * POINTS * BLOCK],
            forces: [0.0; 2 * POINTS * BLOCK],
            gradients: [[0.0; POINTS * BLOCK]; 4],
            stresses: [[0.0; POINTS * BLOCK]; 4],
            lengths: [1.0; BLOCK],
        }
    }

    /// Adds the forces of one column of elements to those of its lines.
    fn column(
        &mut self,
        (law, thickness, grid, rule): Plate<'_, NODES>,
        u: &Field,
        column: usize,
        mut forces: [&mut [f64]; 2],
    ) -> bool {
        let order = NODES - 1;
        let width = grid.span(0, column * order, (column + 1) * order);
        let elements = (u.width - 1) / order;
        let mut admissible = true;
        for first in (0..elements).step_by(BLOCK) {
            let count = BLOCK.min(elements - first);
            let padded = count.next_multiple_of(VECTOR);
            self.gather(grid, u, [column, first], [count, padded]);
            let points = padded * NODES * NODES;
            Arch::new().dispatch(Gradients {
                rule,
                width,
                padded,
                lengths: &self.lengths,
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
                width,
                padded,
                lengths: &self.lengths,
                stresses: self.stresses.each_ref().map(|p| &p[..points]),
                forces: &mut self.forces,
            });
            self.add(u.width, first * order, count, &mut forces);
        }
        admissible
    }

    /// Takes the displacements of a block over; the last element is repeated up to a whole vector.
    fn gather(
        &mut self,
        grid: &Grid,
        u: &Field,
        [column, first]: [usize; 2],
        [count, padded]: [usize; 2],
    ) {
        let order = NODES - 1;
        for element in 0..count {
            let node = (first + element) * order;
            self.lengths[element] = grid.span(1, node, node + order);
        }
        let last = self.lengths[count - 1];
        self.lengths[count..padded].fill(last);
        let mut kinds = self.displacements.chunks_exact_mut(BLOCK);
        for component in &u.components {
            for line in 0..NODES {
                let line = &component[(column * order + line) * u.width..][..u.width];
                for node in 0..NODES {
                    let kind = kinds.next().expect("a place for each node");
                    let from = line[first * order + node..].iter().step_by(order);
                    kind[..count]
                        .iter_mut()
                        .zip(from)
                        .for_each(|(to, u)| *to = *u);
                    let last = kind[count - 1];
                    kind[count..padded].fill(last);
                }
            }
        }
    }

    /// Adds the nodal forces of a block to the lines.
    fn add(&self, width: usize, first: usize, count: usize, forces: &mut [&mut [f64]; 2]) {
        let order = NODES - 1;
        let mut kinds = self.forces.chunks_exact(BLOCK);
        for forces in forces {
            for line in 0..NODES {
                let target = &mut forces[line * width + first..][..count * order + 1];
                for node in 0..NODES {
                    let kind = kinds.next().expect("a place for each node");
                    let target = target[node..].iter_mut().step_by(order);
                    target
                        .zip(&kind[..count])
                        .for_each(|(sum, force)| *sum += force);
                }
            }
        }
    }
}

struct Gradients<'a, const NODES: usize> {
    rule: &'a Rule<NODES>,
    width: f64,
    padded: usize,
    lengths: &'a [f64],
    displacements: &'a [f64],
    gradients: [&'a mut [f64]; 4],
}

impl<const NODES: usize> WithSimd for Gradients<'_, NODES> {
    type Output = ();

    /// ∂u/∂X = Σ φ′ φ u / hx, ∂u/∂Y = Σ φ φ′ u / hy.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Rule {
            values,
            derivatives,
            ..
        } = self.rule;
        let inverse_width = 1.0 / self.width;
        let zero = simd.splat_f64s(0.0);
        let [h11, h12, h21, h22] = self.gradients;
        for (axis, [h_x, h_y]) in [[h11, h12], [h21, h22]].into_iter().enumerate() {
            for first in (0..self.padded).step_by(S::F64_LANES) {
                let lengths = load::<S>(self.lengths, first);
                for across in 0..NODES {
                    for along in 0..NODES {
                        let (mut sum_x, mut sum_y) = (zero, zero);
                        for line in 0..NODES {
                            for node in 0..NODES {
                                let kind = (axis * NODES + line) * NODES + node;
                                let u = load::<S>(self.displacements, kind * BLOCK + first);
                                let x = derivatives[across][line] * values[along][node];
                                let y = values[across][line] * derivatives[along][node];
                                sum_x = add_product(simd, sum_x, x * inverse_width, u);
                                sum_y = add_product(simd, sum_y, y, u);
                            }
                        }
                        let place = (across * NODES + along) * self.padded + first;
                        store::<S>(h_x, place, sum_x);
                        store::<S>(h_y, place, simd.div_f64s(sum_y, lengths));
                    }
                }
            }
        }
    }
}

struct NodalForces<'a, const NODES: usize> {
    rule: &'a Rule<NODES>,
    thickness: f64,
    width: f64,
    padded: usize,
    lengths: &'a [f64],
    stresses: [&'a [f64]; 4],
    forces: &'a mut [f64],
}

impl<const NODES: usize> WithSimd for NodalForces<'_, NODES> {
    type Output = ();

    /// The transpose of [`Gradients`], weighted with the volume V = t hx hy of each point.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Rule {
            values,
            derivatives,
            weights,
        } = self.rule;
        let zero = simd.splat_f64s(0.0);
        let [p11, p12, p21, p22] = self.stresses;
        for (axis, [p_x, p_y]) in [[p11, p12], [p21, p22]].into_iter().enumerate() {
            for first in (0..self.padded).step_by(S::F64_LANES) {
                let lengths = load::<S>(self.lengths, first);
                for line in 0..NODES {
                    for node in 0..NODES {
                        let (mut sum_x, mut sum_y) = (zero, zero);
                        for across in 0..NODES {
                            for along in 0..NODES {
                                let place = (across * NODES + along) * self.padded + first;
                                let weight = weights[across] * weights[along] * self.thickness;
                                let x = weight * derivatives[across][line] * values[along][node];
                                let y = weight * values[across][line] * derivatives[along][node];
                                sum_x = add_product(simd, sum_x, x, load::<S>(p_x, place));
                                sum_y = add_product(simd, sum_y, y, load::<S>(p_y, place));
                            }
                        }
                        let sum = simd.mul_f64s(lengths, sum_x);
                        let place = ((axis * NODES + line) * NODES + node) * BLOCK + first;
                        store::<S>(
                            self.forces,
                            place,
                            add_product(simd, sum, self.width, sum_y),
                        );
                    }
                }
            }
        }
    }
}
