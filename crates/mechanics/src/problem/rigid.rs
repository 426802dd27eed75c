//! Motions without strain that no support prevents.
//!
//! Cells that share an edge form one rigid body; bodies that share a single node are hinged together. With a body's
//! motion q = (a, b, ω L) about the centre of the mesh, L its size, the displacement of a node at (x, y) is (a − ω y,
//! b + ω x). Every held unknown, every tie and every hinge is a linear condition on the motions; motions that satisfy
//! all of them cause no strain. Forces and the stiffness due to them do not count: a body that only its tension would
//! keep in place has such a motion at rest.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::constraints::Constraints;
use crate::error::Diagnostic;
use crate::mesh::{Mesh, Parts, decimals_for};

/// Eigenvalue of the conditions, relative to the largest, below which a motion is free: the square of how far
/// apart two held nodes must be, relative to the mesh.
const FREE: f64 = 1e-14;

/// Most bodies that are analysed together with their hinges and common grips; more are faults of the mesh, and each is analysed alone.
const MOST_BODIES: usize = 100;

/// Most free motions that are reported one by one.
const MOST_MOTIONS: usize = 8;

/// The parts of a mesh that can move without strain, each reported with its motion.
pub fn free_motions(mesh: &Mesh, constraints: &Constraints) -> Vec<Diagnostic> {
    let bodies = Bodies::of(mesh);
    let mut diagnostics = Vec::new();
    for group in bodies.groups(constraints) {
        let motions = bodies.free(&group, constraints);
        for (position, body) in group.iter().enumerate() {
            let body_motions = motions.rows(3 * position, 3).into_owned();
            if let Some(motion) = bodies.describe(&body_motions) {
                diagnostics.push(bodies.diagnostic(*body, &motion));
            }
        }
    }
    let more = diagnostics.len().saturating_sub(MOST_MOTIONS);
    diagnostics.truncate(MOST_MOTIONS);
    if more > 0 {
        diagnostics.push(
            Diagnostic::error(
                "support",
                format!("{more} more parts can move without strain"),
            )
            .hint("look for seams of doubled nodes in the mesh"),
        );
    }
    diagnostics
}

/// The rigid bodies of a mesh.
struct Bodies<'a> {
    mesh: &'a Mesh,
    /// The first cell of each body.
    cells: Vec<usize>,
    /// The bodies of each node: none, one, or those that are hinged there.
    of_node: Vec<Vec<usize>>,
    centre: [f64; 2],
    size: f64,
}

impl<'a> Bodies<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        let mut parts = Parts::new(mesh.cell_count());
        for pair in mesh
            .edges()
            .windows(2)
            .filter(|pair| pair[0].ends == pair[1].ends)
        {
            parts.join(pair[0].cell, pair[1].cell);
        }
        let (mut numbers, mut cells) = (BTreeMap::new(), Vec::new());
        let mut of_node = vec![Vec::new(); mesh.nodes.len()];
        for cell in 0..mesh.cell_count() {
            let body = *numbers.entry(parts.first(cell)).or_insert_with(|| {
                cells.push(cell);
                cells.len() - 1
            });
            for node in mesh.cell(cell) {
                if !of_node[*node].contains(&body) {
                    of_node[*node].push(body);
                }
            }
        }
        Self {
            mesh,
            cells,
            of_node,
            centre: mesh.middle(),
            size: 0.5 * mesh.diagonal(),
        }
    }

    /// Groups of bodies that hinges or ties couple; each body alone where there are too many.
    fn groups(&self, constraints: &Constraints) -> Vec<Vec<usize>> {
        let bodies = self.cells.len();
        if bodies > MOST_BODIES {
            return (0..bodies).map(|body| vec![body]).collect();
        }
        let mut parts = Parts::new(bodies);
        for members in &self.of_node {
            members
                .windows(2)
                .for_each(|pair| parts.join(pair[0], pair[1]));
        }
        for (unknown, tie) in &constraints.ties {
            let [tied, others] =
                [*unknown, tie.master].map(|unknown| self.of_node[unknown / 2].first());
            if let (Some(tied), Some(other)) = (tied, others) {
                parts.join(*tied, *other);
            }
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for body in 0..self.cells.len() {
            groups.entry(parts.first(body)).or_default().push(body);
        }
        groups.into_values().collect()
    }

    /// The motions of some bodies that satisfy all conditions: 3 rows for each body, a column for each motion.
    fn free(&self, group: &[usize], constraints: &Constraints) -> DMatrix<f64> {
        let count = 3 * group.len();
        let position = |body: &usize| group.binary_search(body).ok();
        let row = |unknown: usize, body: usize| {
            let mut row = DVector::zeros(count);
            if let Some(position) = position(&body) {
                let entries = self.displacement(unknown);
                (0..3).for_each(|i| row[3 * position + i] = entries[i]);
            }
            row
        };
        let first = |unknown: usize| self.of_node[unknown / 2].first().copied();
        let mut normal = DMatrix::<f64>::zeros(count, count);
        let mut impose = |row: DVector<f64>| normal.ger(1.0, &row, &row, 1.0);
        for unknown in constraints.held.keys() {
            first(*unknown)
                .into_iter()
                .for_each(|body| impose(row(*unknown, body)));
        }
        for (unknown, tie) in &constraints.ties {
            if let (Some(tied), Some(other)) = (first(*unknown), first(tie.master)) {
                impose(row(*unknown, tied) - tie.share * row(tie.master, other));
            }
        }
        for (node, bodies) in self.of_node.iter().enumerate() {
            for pair in bodies.windows(2).filter(|_| group.len() > 1) {
                for unknown in [2 * node, 2 * node + 1] {
                    impose(row(unknown, pair[0]) - row(unknown, pair[1]));
                }
            }
        }
        let eigen = SymmetricEigen::new(normal);
        let most = eigen.eigenvalues.max();
        let free = (0..count).filter(|i| eigen.eigenvalues[*i] <= FREE * most);
        let columns: Vec<_> = free
            .map(|i| eigen.eigenvectors.column(i).into_owned())
            .collect();
        if columns.is_empty() {
            DMatrix::zeros(count, 0)
        } else {
            DMatrix::from_columns(&columns)
        }
    }

    /// The displacement of an unknown due to each of the three motions of its body.
    fn displacement(&self, unknown: usize) -> [f64; 3] {
        let [x, y] =
            [0, 1].map(|axis| (self.mesh.nodes[unknown / 2][axis] - self.centre[axis]) / self.size);
        if unknown.is_multiple_of(2) {
            [1.0, 0.0, -y]
        } else {
            [0.0, 1.0, x]
        }
    }

    /// Describes motions, given as columns a, b, ω L of one body, in words; `None` where there are none.
    fn describe(&self, motions: &DMatrix<f64>) -> Option<String> {
        const SMALL: f64 = 1e-6;
        if motions.ncols() == 0 {
            return None;
        }
        let svd = motions.clone().svd(true, false);
        let basis = svd.u.expect("asked for");
        let kept = (0..svd.singular_values.len()).filter(|i| svd.singular_values[*i] > SMALL);
        let kept: Vec<_> = kept.map(|i| basis.column(i).into_owned()).collect();
        let turning = kept
            .iter()
            .max_by(|a, b| a[2].abs().total_cmp(&b[2].abs()))?;
        if turning[2].abs() <= SMALL {
            return Some(match &kept[..] {
                [along] => format!("move {}", direction([along[0], along[1]])),
                _ => "move along x and y".to_owned(),
            });
        }
        match &kept[..] {
            [turn] => Some(format!("rotate about {}", self.pole(turn))),
            [one, other] => {
                // The combination of both that does not turn.
                let along = [0, 1].map(|axis| one[axis] * other[2] - other[axis] * one[2]);
                Some(format!("move {} and rotate", direction(along)))
            }
            _ => Some("move along x and y and rotate: nothing holds it".to_owned()),
        }
    }

    /// The point about which a motion turns.
    fn pole(&self, turn: &DVector<f64>) -> String {
        let by = self.size / turn[2];
        let [x, y] = [self.centre[0] - by * turn[1], self.centre[1] + by * turn[0]];
        let decimals = decimals_for(0.1 * self.size);
        // No minus sign before a zero.
        let tidy = |x: f64| {
            if x.abs() < 0.5 * 10_f64.powi(-(decimals as i32)) {
                0.0
            } else {
                x
            }
        };
        format!("({:.decimals$}, {:.decimals$}) mm", tidy(x), tidy(y))
    }

    fn diagnostic(&self, body: usize, motion: &str) -> Diagnostic {
        let part = match self.cells.len() {
            1 => "the specimen".to_owned(),
            _ => format!(
                "the part with {}",
                self.mesh.describe_cell(self.cells[body])
            ),
        };
        let is_on_body =
            |nodes: &[usize]| nodes.iter().any(|node| self.of_node[*node].contains(&body));
        let groups = self.mesh.groups().iter();
        let names: Vec<_> = groups
            .filter(|(_, group)| is_on_body(&group.nodes))
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        let hint = if names.is_empty() {
            "attach it to the rest of the mesh, or leave it out".to_owned()
        } else {
            format!("add a support on one of its groups {}", names.join(", "))
        };
        let message = format!("{part} can {motion} without strain: no support prevents it");
        Diagnostic::error("support", message).hint(hint)
    }
}

fn direction(along: [f64; 2]) -> String {
    let size = along[0].hypot(along[1]);
    let [x, y] = along.map(|x| x / size);
    if y.abs() < 1e-6 {
        "along x".to_owned()
    } else if x.abs() < 1e-6 {
        "along y".to_owned()
    } else {
        let sign = x.signum();
        format!("along ({:.3}, {:.3})", sign * x, sign * y)
    }
}

#[cfg(test)]
mod tests;
