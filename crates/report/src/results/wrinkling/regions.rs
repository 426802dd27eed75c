//! The connected parts of a sheet that are under compression, with their lengths.

use std::collections::BTreeMap;

use super::critical::Part;
use crate::mesh::{Mesh, Parts};
use crate::results::state::LocalState;

/// A side on which the sheet's stress across the compression is less than this share of the compression is free.
const FREE: f64 = 0.5;

/// A sheet in a deformed state.
pub struct Deformed<'a> {
    mesh: &'a Mesh,
    states: &'a [LocalState],
    /// The deformed nodes in mm.
    nodes: Vec<[f64; 2]>,
    /// The deformed areas of the cells in mm².
    areas: Vec<f64>,
}

/// The moments of the compression in a connected part, about the origin.
#[derive(Clone, Copy, Default)]
struct Moments {
    /// ∫ c dA, with the compression c = −σ₂.
    weight: f64,
    /// ∫ c r dA.
    first: [f64; 2],
    /// ∫ c r rᵀ dA: components 11, 12, 22.
    second: [f64; 3],
    /// ∫ c (cos 2φ, sin 2φ) dA, with the angle φ of the compression.
    direction: [f64; 2],
    /// ∫ c σ₁ dA.
    tension: f64,
    /// Whether the sheet ends freely on either side across the compression.
    free: [bool; 2],
}

impl<'a> Deformed<'a> {
    pub fn new(mesh: &'a Mesh, displacement: &[f64], states: &'a [LocalState]) -> Self {
        let moved = mesh.nodes.iter().zip(displacement.chunks_exact(2));
        let area = |(cell, state): (usize, &LocalState)| {
            mesh.cell_area(cell) * state.stretches[0] * state.stretches[1]
        };
        Self {
            mesh,
            states,
            nodes: moved.map(|(at, u)| [at[0] + u[0], at[1] + u[1]]).collect(),
            areas: states.iter().enumerate().map(area).collect(),
        }
    }

    /// The connected part of each cell under compression; `None` of the others.
    ///
    /// The lengths are those of the rectangle under uniform compression with the same second moments: of the moments M of the compression
    /// about its centre along a direction e, √(12 e·M·e).
    pub fn parts(&self, compressed: &[bool]) -> Vec<Option<Part>> {
        let edges = self.mesh.edges();
        let mut parts = Parts::new(compressed.len());
        let sides = || edges.chunk_by(|one, other| one.ends == other.ends);
        for pair in sides().flat_map(|side| side.windows(2)) {
            let [one, other] = [pair[0].cell, pair[1].cell];
            if compressed[one] && compressed[other] {
                parts.join(one, other);
            }
        }
        let mut moments = BTreeMap::<usize, Moments>::new();
        let cells = (0..compressed.len()).filter(|cell| compressed[*cell]);
        let of_cell: Vec<usize> = (0..compressed.len())
            .map(|cell| parts.first(cell))
            .collect();
        for cell in cells {
            moments.entry(of_cell[cell]).or_default().add(self, cell);
        }
        for edge in sides().filter(|side| side.len() == 1).map(|side| side[0]) {
            if let Some(entry) = moments.get_mut(&of_cell[edge.cell]) {
                entry.end(self, edge.cell, edge.ends);
            }
        }
        let shapes: BTreeMap<usize, Part> = moments
            .into_iter()
            .map(|(part, entry)| (part, entry.part()))
            .collect();
        let of_cell = of_cell.iter().zip(compressed);
        of_cell
            .map(|(part, is)| shapes.get(part).filter(|_| *is).copied())
            .collect()
    }

    /// The mean of some deformed nodes.
    fn middle(&self, nodes: &[usize]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let sum: f64 = nodes.iter().map(|node| self.nodes[*node][axis]).sum();
            sum / nodes.len() as f64
        })
    }
}

impl Moments {
    /// Adds a cell, as a square.
    fn add(&mut self, sheet: &Deformed, cell: usize) {
        let state = &sheet.states[cell];
        let area = sheet.areas[cell];
        let [x, y] = sheet.middle(sheet.mesh.corners(cell));
        let weight = -state.principal_cauchy()[1] * area;
        let [s11, s22, _, s12] = state.cauchy;
        let radius = (0.5 * (s11 - s22)).hypot(s12).max(f64::MIN_POSITIVE);
        self.weight += weight;
        self.tension += weight * state.principal_cauchy()[0];
        self.first[0] += weight * x;
        self.first[1] += weight * y;
        for (sum, value) in
            self.second
                .iter_mut()
                .zip([x * x + area / 12.0, x * y, y * y + area / 12.0])
        {
            *sum += weight * value;
        }
        // The compression lies across the larger principal stress.
        self.direction[0] -= weight * 0.5 * (s11 - s22) / radius;
        self.direction[1] -= weight * s12 / radius;
    }

    /// Takes an edge of the sheet at a cell into account: one along the compression without stress across it is free.
    fn end(&mut self, sheet: &Deformed, cell: usize, ends: [usize; 2]) {
        let [one, other] = ends.map(|node| sheet.nodes[node]);
        let along = [other[0] - one[0], other[1] - one[1]];
        let length = along[0].hypot(along[1]);
        let normal = [along[1] / length, -along[0] / length];
        let state = &sheet.states[cell];
        let [s11, s22, _, s12] = state.cauchy;
        let across =
            normal[0] * (s11 * normal[0] + 2.0 * s12 * normal[1]) + s22 * normal[1].powi(2);
        let tension = self.axes()[0];
        let faces = (normal[0] * tension[0] + normal[1] * tension[1]).abs() > 0.5_f64.sqrt();
        if faces && across.abs() < -FREE * state.principal_cauchy()[1] {
            let middle = sheet.middle(&ends);
            let arm = [0, 1].map(|axis| middle[axis] - self.first[axis] / self.weight);
            let side = arm[0] * tension[0] + arm[1] * tension[1] > 0.0;
            self.free[usize::from(side)] = true;
        }
    }

    /// The mean directions across and along the compression.
    fn axes(&self) -> [[f64; 2]; 2] {
        let (sine, cosine) = (0.5 * self.direction[1].atan2(self.direction[0])).sin_cos();
        [[-sine, cosine], [cosine, sine]]
    }

    fn part(self) -> Part {
        let centre = self.first.map(|sum| sum / self.weight);
        let [m11, m12, m22] = self.second.map(|sum| sum / self.weight);
        let [m11, m12, m22] = [
            m11 - centre[0] * centre[0],
            m12 - centre[0] * centre[1],
            m22 - centre[1] * centre[1],
        ];
        let [along, across] = self
            .axes()
            .map(|[x, y]| (12.0 * (x * x * m11 + 2.0 * x * y * m12 + y * y * m22)).sqrt());
        Part {
            along,
            across,
            free_ends: self.free.into_iter().filter(|is| *is).count(),
            tension: self.tension / self.weight,
        }
    }
}
