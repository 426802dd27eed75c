//! The potential of loads.
//!
//! ```text
//! dead forces        Π = −s Σ fᵢ uᵢ                                                   [mJ]
//! pressure p         Π = s p t A,   A = ½ ∫ (x dy − y dx) over the loaded edges         [mJ]
//! ```
//!
//! The edges have the specimen to their left, so that A is the specimen's area as far as they bound it. A
//! pressure has a potential where they are closed, where their ends are held, or where an end slides along an
//! axis of symmetry that passes through the point about which A is measured.

use super::Load;
use super::supports::Supported;
use crate::mesh::{Group, Mesh};
use crate::solve::{Inadmissible, Local, Potential};

/// All loads of a problem at load factor 1.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// Dead force in N on each unknown.
    forces: Vec<f64>,
    /// Edges under pressure: their nodes' unknowns, and p t in N/mm.
    edges: Vec<(Vec<usize>, f64)>,
    /// The unknowns that have dead forces.
    pushed: Vec<usize>,
}

impl Loaded {
    /// No loads on so many unknowns.
    pub fn new(unknowns: usize) -> Self {
        Self {
            forces: vec![0.0; unknowns],
            ..Self::default()
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty() && self.pushed.is_empty()
    }

    /// Adds dead forces in N.
    pub fn add_forces(&mut self, forces: &[f64]) {
        for (sum, force) in self.forces.iter_mut().zip(forces) {
            *sum += force;
        }
        let unknowns = 0..self.forces.len();
        self.pushed = unknowns
            .filter(|unknown| self.forces[*unknown] != 0.0)
            .collect();
    }

    /// Adds a load on a group; `is_held` says along which axes a node is held.
    ///
    /// # Errors
    /// Says why the group cannot carry it.
    pub fn add(
        &mut self,
        mesh: &Mesh,
        group: &Group,
        load: &Load,
        thickness: f64,
        is_held: &dyn Fn(usize) -> [bool; 2],
    ) -> Result<(), String> {
        let forces = dead_forces(mesh, group, load, thickness)?;
        if let Load::Pressure(pressure) = load {
            need_edges(group, "a pressure")?;
            let centre = centre(mesh, group, is_held)?;
            for edge in &group.edges {
                let unknowns = edge.iter().flat_map(|node| [2 * node, 2 * node + 1]);
                self.edges.push((unknowns.collect(), pressure * thickness));
            }
            self.reference(mesh, group, centre, *pressure * thickness);
        }
        self.add_forces(&forces);
        Ok(())
    }

    /// Adds the forces on rigid grips.
    pub fn pull(&mut self, supported: &Supported) {
        let mut forces = vec![0.0; self.forces.len()];
        for (unknown, force) in &supported.forces {
            forces[*unknown] += force;
        }
        self.add_forces(&forces);
    }

    /// Edges know displacements only: the area's part that is linear in them acts as a dead force.
    fn reference(&mut self, mesh: &Mesh, group: &Group, centre: [f64; 2], line_load: f64) {
        let mut forces = vec![0.0; self.forces.len()];
        for edge in &group.edges {
            let place = |node: &usize| [0, 1].map(|axis| mesh.nodes[*node][axis] - centre[axis]);
            let place: Vec<f64> = edge.iter().flat_map(place).collect();
            let mut slope = vec![0.0; place.len()];
            enclosed(&place, Some(&mut slope));
            for (node, slope) in edge.iter().zip(slope.chunks_exact(2)) {
                forces[2 * node] -= line_load * slope[0];
                forces[2 * node + 1] -= line_load * slope[1];
            }
        }
        self.add_forces(&forces);
    }

    /// The potential of an energy with these loads at a load factor.
    pub fn at<'a>(&'a self, energy: &'a dyn Potential, factor: f64) -> LoadedPotential<'a> {
        LoadedPotential {
            energy,
            loads: self,
            factor,
        }
    }
}

/// The forces in N of a dead load on the unknowns of a mesh; a pressure has none.
///
/// # Errors
/// Says why the group cannot carry the load.
pub fn dead_forces(
    mesh: &Mesh,
    group: &Group,
    load: &Load,
    thickness: f64,
) -> Result<Vec<f64>, String> {
    let mut forces = vec![0.0; 2 * mesh.nodes.len()];
    match load {
        Load::Force(force) => {
            let share = 1.0 / group.nodes.len() as f64;
            for node in &group.nodes {
                forces[2 * node] += share * force[0];
                forces[2 * node + 1] += share * force[1];
            }
        }
        Load::Traction(traction) => {
            need_edges(group, "a traction")?;
            for edge in &group.edges {
                for (node, length) in edge_lengths(mesh, edge) {
                    forces[2 * node] += traction[0] * thickness * length;
                    forces[2 * node + 1] += traction[1] * thickness * length;
                }
            }
        }
        Load::Pressure(_) => {}
    }
    Ok(forces)
}

/// A point that lies on the axes along which the ends of loaded edges slide.
fn centre(
    mesh: &Mesh,
    group: &Group,
    is_held: &dyn Fn(usize) -> [bool; 2],
) -> Result<[f64; 2], String> {
    let mut centre = [None; 2];
    for node in open_end(group) {
        let place = mesh.nodes[node];
        let held = is_held(node);
        let slides = match held {
            [true, true] => continue,
            [true, false] => 0,
            [false, true] => 1,
            [false, false] => 2,
        };
        // An end that slides along Y keeps its X, and the other way round.
        let fits = slides < 2 && centre[slides].is_none_or(|known: f64| known == place[slides]);
        if !fits {
            let [x, y] = place;
            return Err(format!(
                "is under pressure and ends freely at ({x}, {y}) mm; its ends must be held or slide along axes of symmetry, or it must be closed"
            ));
        }
        centre[slides] = Some(place[slides]);
    }
    Ok(centre.map(|x| x.unwrap_or(0.0)))
}

fn need_edges(group: &Group, what: &str) -> Result<(), String> {
    if group.edges.is_empty() {
        return Err(format!("has no edges of the boundary, which {what} needs"));
    }
    Ok(())
}

/// The nodes at which a chain of edges begins or ends.
fn open_end(group: &Group) -> Vec<usize> {
    let mut ends = std::collections::BTreeMap::new();
    for edge in &group.edges {
        *ends.entry(edge[0]).or_insert(0) += 1;
        *ends.entry(edge[1]).or_insert(0) -= 1;
    }
    ends.into_iter()
        .filter(|(_, sum)| *sum != 0)
        .map(|(node, _)| node)
        .collect()
}

/// The share of an edge's length that belongs to each of its nodes, in mm.
fn edge_lengths(mesh: &Mesh, edge: &[usize]) -> Vec<(usize, f64)> {
    const GAUSS: [(f64, f64); 3] = [
        (-0.774_596_669_241_483_4, 5.0 / 9.0),
        (0.0, 8.0 / 9.0),
        (0.774_596_669_241_483_4, 5.0 / 9.0),
    ];
    let mut shares: Vec<(usize, f64)> = edge.iter().map(|node| (*node, 0.0)).collect();
    for (x, weight) in GAUSS {
        let (values, slopes) = edge_functions(edge.len(), x);
        let tangent = [0, 1].map(|axis| {
            let nodes = edge.iter().zip(&slopes);
            nodes
                .map(|(node, slope)| slope * mesh.nodes[*node][axis])
                .sum::<f64>()
        });
        let length = tangent[0].hypot(tangent[1]);
        for (share, value) in shares.iter_mut().zip(values) {
            share.1 += weight * value * length;
        }
    }
    shares
}

/// Values and derivatives of an edge's functions at −1 ≤ x ≤ 1: both ends, then the middle.
fn edge_functions(nodes: usize, x: f64) -> (Vec<f64>, Vec<f64>) {
    if nodes == 2 {
        return (vec![0.5 * (1.0 - x), 0.5 * (1.0 + x)], vec![-0.5, 0.5]);
    }
    (
        vec![0.5 * x * (x - 1.0), 0.5 * x * (x + 1.0), 1.0 - x * x],
        vec![x - 0.5, x + 0.5, -2.0 * x],
    )
}

/// ½ ∫ (x dy − y dx) along an edge with the coordinates x, y of node after node; its derivatives into `slope`.
///
/// ```text
/// two nodes     ½ (a × b)
/// three nodes   ½ (⅔ (2 a × m + 2 m × b) − ⅓ a × b),   m the middle
/// ```
fn enclosed(place: &[f64], slope: Option<&mut [f64]>) -> f64 {
    let mut area = 0.0;
    let mut add = |i: usize, j: usize, factor: f64, slope: &mut [f64]| {
        let (a, b) = (
            [place[2 * i], place[2 * i + 1]],
            [place[2 * j], place[2 * j + 1]],
        );
        area += factor * (a[0] * b[1] - a[1] * b[0]);
        slope[2 * i] += factor * b[1];
        slope[2 * i + 1] -= factor * b[0];
        slope[2 * j] -= factor * a[1];
        slope[2 * j + 1] += factor * a[0];
    };
    let mut unwanted = vec![0.0; place.len()];
    let slope = slope.unwrap_or(&mut unwanted);
    for (i, j, factor) in pairs(place.len() / 2) {
        add(*i, *j, *factor, slope);
    }
    area
}

/// The pairs of nodes whose cross products make up the area beside an edge, with their factors.
fn pairs(nodes: usize) -> &'static [(usize, usize, f64)] {
    const LINEAR: [(usize, usize, f64); 1] = [(0, 1, 0.5)];
    const QUADRATIC: [(usize, usize, f64); 3] =
        [(0, 2, 2.0 / 3.0), (2, 1, 2.0 / 3.0), (0, 1, -1.0 / 6.0)];
    if nodes == 2 { &LINEAR } else { &QUADRATIC }
}

/// An energy with loads at one load factor.
pub struct LoadedPotential<'a> {
    energy: &'a dyn Potential,
    loads: &'a Loaded,
    factor: f64,
}

impl Potential for LoadedPotential<'_> {
    fn unknowns(&self) -> usize {
        self.energy.unknowns()
    }

    fn elements(&self) -> usize {
        self.energy.elements() + self.loads.edges.len() + self.loads.pushed.len()
    }

    fn element_unknowns(&self, element: usize) -> &[usize] {
        let own = self.energy.elements();
        if element < own {
            return self.energy.element_unknowns(element);
        }
        let edges = &self.loads.edges;
        match edges.get(element - own) {
            Some((unknowns, _)) => unknowns,
            None => {
                let pushed = element - own - edges.len();
                &self.loads.pushed[pushed..=pushed]
            }
        }
    }

    fn place(&self, unknown: usize) -> Option<[f64; 2]> {
        self.energy.place(unknown)
    }

    fn evaluate_element(
        &self,
        element: usize,
        u: &[f64],
        local: Local<'_>,
    ) -> Result<f64, Inadmissible> {
        let own = self.energy.elements();
        if element < own {
            return self.energy.evaluate_element(element, u, local);
        }
        let edges = &self.loads.edges;
        let Some((_, line_load)) = edges.get(element - own) else {
            let unknown = self.loads.pushed[element - own - edges.len()];
            let force = self.factor * self.loads.forces[unknown];
            local.residual[0] = -force;
            return Ok(-force * u[0]);
        };
        let factor = self.factor * line_load;
        let energy = factor * enclosed(u, Some(local.residual));
        local.residual.iter_mut().for_each(|r| *r *= factor);
        if let Some(stiffness) = local.stiffness {
            let size = u.len();
            for (i, j, share) in pairs(size / 2) {
                let value = factor * share;
                for (row, column, sign) in [(2 * i, 2 * j + 1, 1.0), (2 * i + 1, 2 * j, -1.0)] {
                    stiffness[row * size + column] += sign * value;
                    stiffness[column * size + row] += sign * value;
                }
            }
        }
        Ok(energy)
    }

    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        let own = element < self.energy.elements();
        own.then(|| self.energy.instability(element, u)).flatten()
    }
}
