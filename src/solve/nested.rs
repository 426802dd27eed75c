//! Multigrid over systems of one body, coarse to fine: each with its own tangent, taken where its own equilibrium was found.
//!
//! The systems need only a transfer of fields from each to the next finer one: meshes need not be nested, nor end at
//! the same curved outline. A climb from mesh to mesh already has all tangents but the finest.
//!
//! | step | how |
//! |---|---|
//! | smoother | block Gauss–Seidel, forward before and backward after the coarser levels: symmetric |
//! | to a finer level | the interpolation by the elements, P; held unknowns do not take part, tied ones follow their master |
//! | from a finer level | Pᵀ |
//! | coarsest level | sparse Cholesky factor |
//!
//! # References
//! A. Brandt, Math. Comp. 31, 333 (1977), doi:10.1090/S0025-5718-1977-0431719-X

use std::collections::BTreeMap;

use super::aggregation::blocks::Blocks;
use super::aggregation::level::{Level, Operator, Prolongation};
use super::aggregation::single_precision;
use super::assembly::{Assembly, FreeIndex};
use super::nodal::Nodes;
use super::potential::Potential;
use super::sparse::{Cholesky, FactorFault};

/// Writes the unknowns of the coarser system, with their shares, that make up an unknown of the finer one, of the same component.
pub type Carry<'a> = &'a dyn Fn(usize, &mut Vec<(usize, f64)>);

/// The systems from coarse to fine.
pub struct Nested {
    /// The levels above the coarsest one.
    levels: Vec<Level<2, 2, Shares>>,
    coarsest: Cholesky,
    /// The nodes of the coarsest system, and right-hand side and solution there.
    coarsest_nodes: Nodes,
    last: Vec<[f32; 2]>,
}

/// Systems from coarse to fine, on which a finer one can be put.
pub struct Ladder {
    cycle: Nested,
    nodes: Nodes,
    /// Position of each unknown of the finest one among the free ones.
    free_index: FreeIndex,
}

impl Ladder {
    /// Begins with the tangent of a potential at `u`; `None` where it is not positive definite, or where the places of its nodes
    /// are not known.
    pub fn begin(potential: &dyn Potential, fixed: &[bool], u: &[f64]) -> Option<Self> {
        let assembly = Assembly::new(potential, fixed);
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        let linearised = assembly.linearise(potential, u, &mut residual, &mut stiffness);
        linearised.ok()?;
        let mut coarsest = assembly.analyse().ok()?;
        coarsest.factorise(&stiffness).ok()?;
        let nodes = Nodes::new(assembly.free(), assembly.places()?);
        let cycle = Nested {
            levels: Vec::new(),
            coarsest,
            last: vec![[0.0; 2]; nodes.count()],
            coarsest_nodes: nodes.clone(),
        };
        Some(Self::new(cycle, nodes, &assembly))
    }

    /// The systems of a cycle, of which the finest one has these nodes.
    pub fn new(cycle: Nested, nodes: Nodes, assembly: &Assembly) -> Self {
        Self {
            cycle,
            nodes,
            free_index: assembly.free_indices().clone(),
        }
    }

    /// Adds unknowns that follow others, with their masters.
    #[must_use]
    pub fn tied(mut self, ties: &BTreeMap<usize, usize>) -> Self {
        for (unknown, master) in ties {
            self.free_index.tie(*unknown, *master);
        }
        self
    }

    /// Adds a finer system on top, whose matrix is taken later.
    pub fn above(self, unknowns: &[usize], nodes: &Nodes, carry: Carry) -> Nested {
        let shares = self.shares(unknowns, nodes, carry);
        let mut cycle = self.cycle;
        let operator = Operator::none(nodes.count());
        cycle.levels.push(Level::new(operator, shares));
        cycle
    }

    /// P, from the free unknowns of the finest system to those of a finer one.
    fn shares(&self, unknowns: &[usize], nodes: &Nodes, carry: Carry) -> Shares {
        let mut shares = Shares {
            starts: vec![0; nodes.count() + 1],
            ..Shares::default()
        };
        let mut terms = Vec::new();
        for (own, unknown) in unknowns.iter().enumerate() {
            let (node, axis) = nodes.of_unknown(own);
            let begin = shares.starts[node] as usize;
            terms.clear();
            carry(*unknown, &mut terms);
            for (coarse, share) in &terms {
                let Some(index) = self.free_index.of(*coarse) else {
                    continue;
                };
                if share.abs() < LEAST {
                    continue;
                }
                let (column, k) = self.nodes.of_unknown(index);
                debug_assert_eq!(axis, k, "components are carried to themselves");
                let known = shares.columns[begin..].iter();
                let known = known.clone().position(|known| *known as usize == column);
                let place = known.map_or(shares.columns.len(), |known| begin + known);
                if known.is_none() {
                    shares.columns.push(column as u32);
                    shares.values.push([0.0; 2]);
                }
                shares.values[place][axis] += *share as f32;
            }
            shares.starts[node + 1] = shares.columns.len() as u32;
        }
        shares
    }
}

/// Shares below this are rounding.
const LEAST: f64 = 1e-7;

/// The shares of the components of coarser nodes in those of finer ones.
#[derive(Default)]
struct Shares {
    /// Where the shares of each finer node begin.
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<[f32; 2]>,
}

impl Shares {
    fn of(&self, node: usize) -> impl Iterator<Item = (usize, &[f32; 2])> {
        let places = self.starts[node] as usize..self.starts[node + 1] as usize;
        let columns = self.columns[places.clone()].iter();
        let columns = columns.map(|column| *column as usize);
        columns.zip(&self.values[places])
    }
}

impl Prolongation<2, 2> for Shares {
    fn prolong(&self, y: &[[f32; 2]], x: &mut [[f32; 2]]) {
        for (node, x) in x.iter_mut().enumerate() {
            for (column, share) in self.of(node) {
                x[0] += share[0] * y[column][0];
                x[1] += share[1] * y[column][1];
            }
        }
    }

    fn restrict(&self, x: &[[f32; 2]], y: &mut [[f32; 2]]) {
        y.fill([0.0; 2]);
        for (node, x) in x.iter().enumerate() {
            for (column, share) in self.of(node) {
                y[column][0] += share[0] * x[0];
                y[column][1] += share[1] * x[1];
            }
        }
    }
}

impl Nested {
    /// Takes another matrix of the finest system.
    ///
    /// # Errors
    /// [`FactorFault::NotPositiveDefinite`] where a block on its diagonal is not.
    pub fn take(&mut self, matrix: &Blocks<2, 2>) -> Result<(), FactorFault> {
        let taken = self.finest().take(matrix);
        taken.ok_or(FactorFault::NotPositiveDefinite)
    }

    /// z = M r by one V-cycle.
    pub fn apply(&mut self, r: &[[f64; 2]], z: &mut [[f64; 2]]) {
        let most = single_precision(r, &mut self.finest().b);
        if most == 0.0 || !most.is_finite() {
            z.fill([most; 2]);
            return;
        }
        for index in (0..self.levels.len()).rev() {
            let (lower, upper) = self.levels.split_at_mut(index);
            let below = lower.last_mut().map(|level| &mut level.b[..]);
            upper[0].descend(below.unwrap_or(&mut self.last));
        }
        self.solve_coarsest();
        for index in 0..self.levels.len() {
            let (lower, upper) = self.levels.split_at_mut(index);
            upper[0].ascend(lower.last().map_or(&self.last[..], |level| &level.x));
        }
        for (z, x) in z.iter_mut().zip(&self.finest().x) {
            *z = x.map(|x| most * f64::from(x));
        }
    }

    fn finest(&mut self) -> &mut Level<2, 2, Shares> {
        self.levels
            .last_mut()
            .expect("a system on the coarsest one")
    }

    fn solve_coarsest(&mut self) {
        let right: Vec<[f64; 2]> = self.last.iter().map(|b| b.map(f64::from)).collect();
        let mut entries = self.coarsest_nodes.gather(&right);
        self.coarsest.substitute(&mut entries);
        let solution = self.coarsest_nodes.spread(&entries);
        for (last, own) in self.last.iter_mut().zip(solution) {
            *last = own.map(|x| x as f32);
        }
    }
}
