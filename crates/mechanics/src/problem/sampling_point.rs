//! The sampling points of a sheet's cells: gradients, nodal forces and stiffnesses there.

use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::mesh::CellShape;

/// A point at which the energy is sampled: the displacement gradient there is ∂u/∂X = Σ uₐ ⊗ dₐ ∂ξ/∂X.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplingPoint<'a> {
    /// The derivatives dₐ of the function of each node of the cell with respect to its natural coordinates ξ.
    derivatives: &'a [[f64; 2]],
    map: PointMap,
}

/// A sampling point on the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMap {
    /// ∂ξⱼ/∂Xₖ of the cell's natural coordinates in 1/mm.
    pub inverse: [[f64; 2]; 2],
    /// Share of the sheet's reference volume in mm³.
    pub volume: f64,
}

/// The derivatives of the functions of a cell's nodes with respect to its natural coordinates, at all of its sampling points.
#[derive(Clone, Debug)]
pub struct DerivativeTable {
    nodes: usize,
    /// Point by point.
    derivatives: Vec<[f64; 2]>,
}

impl DerivativeTable {
    /// The derivatives of so many nodes' functions, point by point.
    pub fn new(nodes: usize, derivatives: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let derivatives = derivatives.into_iter().collect();
        Self { nodes, derivatives }
    }

    /// Those of a shape at the points of its quadrature.
    pub fn of_shape(shape: CellShape) -> Self {
        let points = shape.quadrature().into_iter();
        let derivatives = points.flat_map(|(point, _)| shape.derivatives(point));
        Self::new(shape.nodes(), derivatives)
    }

    /// Number of nodes of a cell.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// The derivatives at one point after the other.
    pub fn points(&self) -> std::slice::ChunksExact<'_, [f64; 2]> {
        self.derivatives.chunks_exact(self.nodes)
    }
}

impl<'a> SamplingPoint<'a> {
    /// A point of a cell with the derivatives of its nodes' functions.
    pub fn new(derivatives: &'a [[f64; 2]], map: PointMap) -> Self {
        Self { derivatives, map }
    }

    /// Share of the sheet's reference volume in mm³.
    pub fn volume(&self) -> f64 {
        self.map.volume
    }

    /// ∂u/∂X, or ∂u̇/∂X, from nodal values: components 11, 12, 21, 22.
    #[inline]
    pub fn gradient(&self, u: &[f64]) -> PlaneTensor {
        let mut natural = [0.0; 4];
        for (d, u) in self.derivatives.iter().zip(u.chunks_exact(2)) {
            natural[0] += u[0] * d[0];
            natural[1] += u[0] * d[1];
            natural[2] += u[1] * d[0];
            natural[3] += u[1] * d[1];
        }
        let [n, m] = [
            natural,
            self.map.inverse.as_flattened()[..]
                .try_into()
                .expect("four"),
        ];
        PlaneTensor::new(
            n[0] * m[0] + n[1] * m[2],
            n[0] * m[1] + n[1] * m[3],
            n[2] * m[0] + n[3] * m[2],
            n[2] * m[1] + n[3] * m[3],
        )
    }

    /// Adds the nodal forces of a first Piola–Kirchhoff stress in MPa.
    #[inline]
    pub fn add_force(&self, stress: &PlaneTensor, force: &mut [f64]) {
        let p = stress * self.map.volume;
        let [m, n] = self.map.inverse;
        let by_natural = [
            p[0] * m[0] + p[1] * m[1],
            p[0] * n[0] + p[1] * n[1],
            p[2] * m[0] + p[3] * m[1],
            p[2] * n[0] + p[3] * n[1],
        ];
        for (r, d) in force.chunks_exact_mut(2).zip(self.derivatives) {
            r[0] += by_natural[0] * d[0] + by_natural[1] * d[1];
            r[1] += by_natural[2] * d[0] + by_natural[3] * d[1];
        }
    }

    /// K_(a i)(b k) += V gₐ_J A_(i J)(k L) g_b_L over the lower triangle, with gₐ = ∂Nₐ/∂X; `tangent` A is symmetric, 4 × 4.
    #[inline]
    pub fn add_stiffness(&self, tangent: &[f64], stiffness: &mut [f64]) {
        let tangent = self.by_natural(tangent);
        let size = 2 * self.derivatives.len();
        for (node, rows) in stiffness.chunks_exact_mut(2 * size).enumerate() {
            let row_derivative = self.derivatives[node];
            let x =
                tangent.map(|column| row_derivative[0] * column[0] + row_derivative[1] * column[1]);
            let y =
                tangent.map(|column| row_derivative[0] * column[2] + row_derivative[1] * column[3]);
            let (along_x, along_y) = rows.split_at_mut(size);
            let pairs = along_x
                .as_chunks_mut()
                .0
                .iter_mut()
                .zip(along_y.as_chunks_mut().0);
            for (d, ([xx, xy], [yx, yy])) in self.derivatives[..=node].iter().zip(pairs) {
                *xx += d[0] * x[0] + d[1] * x[1];
                *xy += d[0] * x[2] + d[1] * x[3];
                *yx += d[0] * y[0] + d[1] * y[1];
                *yy += d[0] * y[2] + d[1] * y[3];
            }
        }
    }

    /// V ∂ξⱼ/∂X_J A_(i J)(k L) ∂ξₗ/∂X_L, column by column: the tangent for derivatives by natural coordinates.
    #[inline]
    fn by_natural(&self, tangent: &[f64]) -> [[f64; 4]; 4] {
        let PointMap { inverse, volume } = self.map;
        // Rows first.
        let half: [[f64; 4]; 4] = std::array::from_fn(|column| {
            std::array::from_fn(|row| {
                let (i, j) = (2 * (row / 2), row % 2);
                let a = &tangent[4 * column + i..4 * column + i + 2];
                volume * (inverse[j][0] * a[0] + inverse[j][1] * a[1])
            })
        });
        std::array::from_fn(|column| {
            let (k, l) = (2 * (column / 2), column % 2);
            std::array::from_fn(|row| {
                inverse[l][0] * half[k][row] + inverse[l][1] * half[k + 1][row]
            })
        })
    }

    /// Kinematics with the nodal displacements `u`.
    pub(super) fn kinematics(&self, u: &[f64]) -> Result<Kinematics, ()> {
        Kinematics::new(&self.gradient(u)).map_err(|_| ())
    }
}
