//! Pressure that follows the edges it acts on.
//!
//! ```text
//! fₐ = −s p t ∫ Nₐ n ds = −s p t ∫ Nₐ (dy, −dx)     over the deformed edges                  [N]
//! ```
//!
//! with the load factor s, the thickness at rest t, and the specimen to the left of the edges, so that n points outward.
//! These are the forces at every node, held or not. Along closed edges they follow from a potential,
//!
//! ```text
//! Π = s p t A,   A = ½ ∫ (x dy − y dx)                                                        [mJ]
//! δΠ + Σ fₐ δuₐ = ½ s p t [x δy − y δx] at the ends of the edges
//! ```
//!
//! A is the specimen's area as far as the edges bound it. The term at an end vanishes where the end is held; where
//! the end slides along an axis the term has a potential of its own; where the end is free there is no potential, and
//! the tangent is not symmetric: its skew part couples the end's two displacements by ½ s p t.
//!
//! # References
//! P. Wriggers, Nonlinear Finite Element Methods, Springer (2008), § 4.2.5, doi:10.1007/978-3-540-71001-1

use std::collections::BTreeMap;

use super::balance::Resultant;
use crate::mesh::{Group, Mesh};
use crate::solve::{Connectivity, Evaluated, Local, Potential, SkewCoupling};

/// Share of the line load at an end below which it counts as rounding of a zero sum.
const ROUNDING_ERROR: f64 = 1e-12;

/// All pressures of a problem at load factor 1.
#[derive(Clone, Debug, Default)]
pub struct Pressures {
    /// Edges under pressure.
    pub edges: Vec<Edge>,
    /// Nodes at which the line loads begin or end, or change.
    pub ends: Vec<End>,
}

/// An edge under pressure.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Unknowns of its nodes: both ends, then the middle where there is one.
    pub unknowns: Vec<usize>,
    /// Reference coordinates of its nodes in mm, relative to the centre of the mesh.
    rest: Vec<f64>,
    /// p t in N/mm.
    line_load: f64,
}

/// A node at which a line load ends.
#[derive(Clone, Debug)]
pub struct End {
    /// Its unknowns.
    pub unknowns: [usize; 2],
    /// Reference coordinates in mm, relative to the centre of the mesh.
    rest: [f64; 2],
    /// The line load in N/mm that ends there, less the one that begins there.
    line_load: f64,
    /// The axis along which it is held, where it is held along exactly one.
    held: Option<usize>,
}

impl Pressures {
    /// Adds a pressure times thickness in N/mm on the edges of a group.
    pub fn add(&mut self, mesh: &Mesh, group: &Group, line_load: f64) {
        let centre = mesh.middle();
        for nodes in &group.edges {
            let position = |node: &usize| [0, 1].map(|axis| mesh.nodes[*node][axis] - centre[axis]);
            self.edges.push(Edge {
                unknowns: nodes
                    .iter()
                    .flat_map(|node| [2 * node, 2 * node + 1])
                    .collect(),
                rest: nodes.iter().flat_map(position).collect(),
                line_load,
            });
        }
    }

    /// Finds the ends, once all edges are known; `is_held` tells whether an unknown is held.
    pub fn close(&mut self, is_held: &dyn Fn(usize) -> bool) {
        let mut sums: BTreeMap<usize, (f64, [f64; 2])> = BTreeMap::new();
        let most = self.edges.iter().map(|edge| edge.line_load.abs());
        let most = most.fold(0.0, f64::max);
        for edge in &self.edges {
            for (corner, sign) in [(0, -1.0), (1, 1.0)] {
                let rest = [edge.rest[2 * corner], edge.rest[2 * corner + 1]];
                let (sum, _) = sums.entry(edge.unknowns[2 * corner]).or_insert((0.0, rest));
                *sum += sign * edge.line_load;
            }
        }
        let ends = sums
            .into_iter()
            .filter(|(_, (sum, _))| sum.abs() > ROUNDING_ERROR * most);
        self.ends = ends
            .map(|(x, (line_load, rest))| End {
                unknowns: [x, x + 1],
                rest,
                line_load,
                held: match [x, x + 1].map(is_held) {
                    [true, false] => Some(0),
                    [false, true] => Some(1),
                    _ => None,
                },
            })
            .collect();
    }

    /// The potential of the pressures at a load factor; its elements are the edges, then the ends.
    pub fn at(&self, factor: f64, unknowns: usize) -> PressurePotential<'_> {
        let mut connectivity = Connectivity::new(unknowns);
        for edge in &self.edges {
            connectivity.push(edge.unknowns.iter().copied());
        }
        for end in &self.ends {
            connectivity.push(end.unknowns);
        }
        PressurePotential {
            pressures: self,
            factor,
            connectivity,
        }
    }

    /// The resultant of the pressures about a point, on the edges displaced by `u`, by its exact integral and not by the nodal forces:
    ///
    /// ```text
    /// F = −p t ∫ (dy, −dx) = −p t (Δy, −Δx),   M = p t ∫ (x dx + y dy) = ½ p t Δ(x² + y²)
    /// ```
    pub fn resultant(&self, factor: f64, u: &[f64], [x, y]: [f64; 2]) -> Resultant {
        let mut sum = Resultant::default();
        for edge in &self.edges {
            let [from, to] = [0, 1].map(|corner| {
                let at = |axis: usize| {
                    edge.rest[2 * corner + axis] + u[edge.unknowns[2 * corner + axis]]
                };
                [at(0) - x, at(1) - y]
            });
            let by = factor * edge.line_load;
            let force = [-by * (to[1] - from[1]), by * (to[0] - from[0])];
            sum.force[0] += force[0];
            sum.force[1] += force[1];
            sum.size += force[0].hypot(force[1]);
            let squares =
                |position: [f64; 2]| position[0] * position[0] + position[1] * position[1];
            sum.moment += 0.5 * by * (squares(to) - squares(from));
        }
        sum
    }
}

/// Pressures at one load factor.
pub struct PressurePotential<'a> {
    pressures: &'a Pressures,
    factor: f64,
    connectivity: Connectivity,
}

impl Potential for PressurePotential<'_> {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        let Pressures { edges, ends } = self.pressures;
        Ok(match edges.get(element) {
            Some(edge) => edge.evaluate(self.factor, u, local),
            None => ends[element - edges.len()].energy(self.factor, u),
        })
    }

    fn skew_couplings(&self) -> Vec<SkewCoupling> {
        let coupling = |end: &End| SkewCoupling {
            row: end.unknowns[0],
            column: end.unknowns[1],
            stiffness: 0.5 * self.factor * end.line_load,
        };
        self.pressures.ends.iter().map(coupling).collect()
    }
}

impl Edge {
    /// The edge's part of s p t A, less that at rest; the true nodal forces, and the stiffness of A alone.
    fn evaluate(&self, factor: f64, u: &[f64], local: Local<'_>) -> f64 {
        let by = factor * self.line_load;
        let position: Vec<f64> = self.rest.iter().zip(u).map(|(rest, u)| rest + u).collect();
        let count = position.len() / 2;
        // Forces depend only on differences of positions, which keep all digits relative to the edge's first node.
        let relative: Vec<f64> = (0..position.len())
            .map(|i| position[i] - position[i % 2])
            .collect();
        for (i, j, share) in pairs(count) {
            let (a, b) = (&relative[2 * i..2 * i + 2], &relative[2 * j..2 * j + 2]);
            local.residual[2 * i] += by * share * b[1];
            local.residual[2 * i + 1] -= by * share * b[0];
            local.residual[2 * j] -= by * share * a[1];
            local.residual[2 * j + 1] += by * share * a[0];
        }
        for (corner, sign) in [(0, -0.5), (1, 0.5)] {
            local.residual[2 * corner] += by * sign * relative[2 * corner + 1];
            local.residual[2 * corner + 1] -= by * sign * relative[2 * corner];
        }
        if let Some(stiffness) = local.stiffness {
            let size = u.len();
            for (i, j, share) in pairs(count) {
                let value = by * share;
                for (row, column, sign) in [(2 * i, 2 * j + 1, 1.0), (2 * i + 1, 2 * j, -1.0)] {
                    stiffness[row * size + column] += sign * value;
                    stiffness[column * size + row] += sign * value;
                }
            }
        }
        by * (enclosed(&position) - enclosed(&self.rest))
    }
}

impl End {
    /// The potential of the term at an end that slides along an axis, less that at rest; its forces are those on the edges.
    fn energy(&self, factor: f64, u: &[f64]) -> f64 {
        let sign = match self.held {
            Some(0) => -0.5,
            Some(_) => 0.5,
            None => return 0.0,
        };
        let [x, y] = self.rest;
        sign * factor * self.line_load * ((x + u[0]) * (y + u[1]) - x * y)
    }
}

/// ½ ∫ (x dy − y dx) along an edge with the coordinates x, y of node after node.
///
/// ```text
/// two nodes     ½ (a × b)
/// three nodes   ½ (⅔ (2 a × m + 2 m × b) − ⅓ a × b),   m the middle
/// ```
fn enclosed(position: &[f64]) -> f64 {
    let pairs = pairs(position.len() / 2).iter();
    let crosses = pairs.map(|(i, j, share)| {
        share * (position[2 * i] * position[2 * j + 1] - position[2 * i + 1] * position[2 * j])
    });
    crosses.sum()
}

/// The pairs of nodes whose cross products make up the area beside an edge, with their shares.
fn pairs(nodes: usize) -> &'static [(usize, usize, f64)] {
    const LINEAR: [(usize, usize, f64); 1] = [(0, 1, 0.5)];
    const QUADRATIC: [(usize, usize, f64); 3] =
        [(0, 2, 2.0 / 3.0), (2, 1, 2.0 / 3.0), (0, 1, -1.0 / 6.0)];
    if nodes == 2 { &LINEAR } else { &QUADRATIC }
}

#[cfg(test)]
mod tests;
