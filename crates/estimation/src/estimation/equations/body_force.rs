//! Smooth forces on the sheet's interior that represent what the physics lacks.
//!
//! ```text
//! F(u) = f,   fᵢ = ∫ Nᵢ b dA,   b = Σ cₖ ψₖ                                     b in N/mm², ψ products of cubic B-splines
//! ```

use nalgebra::DMatrix;

use crate::estimation::regression::Roughness;
use crate::mesh::Mesh;
use crate::solve::vector::add_scaled;
use crate::statistics::{BSpline, Ends};

/// Spans along the longer side of the specimen's box.
const SPANS: f64 = 4.0;

/// The forces of unit coefficients.
#[derive(Clone, Debug)]
pub struct BodyForce {
    /// Forces in N/(N/mm²) on all unknowns, of one coefficient after the other: all along x, then all along y.
    columns: Vec<Vec<f64>>,
    /// √ of the area that belongs to a coefficient in mm.
    scale: f64,
}

impl BodyForce {
    /// Forces on the unknowns of a mesh that are not held.
    pub fn new(mesh: &Mesh, held: &[bool]) -> Self {
        let areas = nodal_areas(mesh);
        let [low, high] = mesh.bounding_box();
        let size = [0, 1].map(|axis| high[axis] - low[axis]);
        let longer = size[0].max(size[1]);
        let splines = [0, 1].map(|axis| {
            let spans = ((SPANS * size[axis] / longer).round() as usize).max(1);
            BSpline::new([low[axis], high[axis]], spans, 3, Ends::Clamped)
        });
        let count = splines[0].count() * splines[1].count();
        let mut columns = vec![vec![0.0; held.len()]; 2 * count];
        for (node, position) in mesh.nodes.iter().enumerate() {
            for (i, x) in splines[0].derivatives(position[0], 0) {
                for (j, y) in splines[1].derivatives(position[1], 0) {
                    let function = i * splines[1].count() + j;
                    for axis in [0, 1].into_iter().filter(|axis| !held[2 * node + axis]) {
                        columns[axis * count + function][2 * node + axis] = areas[node] * x * y;
                    }
                }
            }
        }
        let area: f64 = areas.iter().sum();
        Self {
            columns,
            scale: (area / count as f64).sqrt(),
        }
    }

    /// Forces in N/(N/mm²) of one coefficient after the other.
    pub fn columns(&self) -> &[Vec<f64>] {
        &self.columns
    }

    /// The forces of coefficients in N.
    pub fn forces(&self, coefficients: &[f64], unknowns: usize) -> Vec<f64> {
        let mut sum = vec![0.0; unknowns];
        for (column, factor) in self.columns.iter().zip(coefficients) {
            add_scaled(&mut sum, *factor, column);
        }
        sum
    }

    /// Σ r² ≈ ∫ b² dA along one axis and the other, where the coefficients are the last of all `parameters`.
    pub fn roughness(&self, parameters: &[f64]) -> Vec<Roughness> {
        let count = self.columns.len() / 2;
        let first = parameters.len() - self.columns.len();
        let along = |axis: usize| {
            let positions = first + axis * count..first + (axis + 1) * count;
            let mut slopes = DMatrix::zeros(count, parameters.len());
            for (row, position) in positions.clone().enumerate() {
                slopes[(row, position)] = self.scale;
            }
            Roughness {
                edge: "forces on the interior".into(),
                axis,
                values: parameters[positions]
                    .iter()
                    .map(|c| self.scale * c)
                    .collect(),
                slopes,
                rank: count,
            }
        };
        vec![along(0), along(1)]
    }
}

/// ∫ Nᵢ dA of every node in mm².
pub fn nodal_areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        for (node, part) in mesh.area_parts(cell) {
            areas[node] += part;
        }
    }
    areas
}
