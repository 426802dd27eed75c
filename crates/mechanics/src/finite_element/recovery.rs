//! A better gradient of a finite-element field, by polynomial-preserving recovery.
//!
//! Around every corner a polynomial one degree above the elements' is fitted to the nodal displacements by least
//! squares; its gradient is exact for every field of that degree, on any mesh, whatever the cells. Within a cell the
//! gradients of its corners' polynomials are blended by the linear shape functions N of the corners:
//!
//! ```text
//! G*(X) = Σ N_c(X) ∇p_c(X),   p_c = arg min Σ w_a² |p(X_a) − u_a|² over the nodes a around corner c   [–]
//! ```
//!
//! The nodes are those of the cells around the corner, with w = 1. For corners of the boundary, and wherever these
//! nodes do not determine the polynomial, the nodes of the cells around those cells are added with w = 0.1.
//!
//! # References
//! - Z. Zhang, A. Naga, SIAM J. Sci. Comput. 26, 1192 (2005), doi:10.1137/S1064827503402837
//! - T. Blacker, T. Belytschko, Int. J. Numer. Methods Eng. 37, 517 (1994), doi:10.1002/nme.1620370309 (blending)

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::mesh::Mesh;

/// The recovered gradient of one field on a mesh.
#[derive(Clone, Debug)]
pub struct RecoveredGradient {
    /// One at each corner of a cell.
    polynomials: Vec<Option<Polynomial>>,
}

/// A vector-valued polynomial in (X − origin)/scale.
#[derive(Clone, Debug)]
struct Polynomial {
    origin: [f64; 2],
    scale: [f64; 2],
    degree: usize,
    /// For each monomial, in the order of [`monomials`], the coefficients of both components.
    coefficients: Vec<[f64; 2]>,
}

/// Layers of cells around a corner that are searched for nodes.
const MOST_LAYERS: usize = 4;

/// Smallest pivot over the largest one at which nodes determine a polynomial.
const SMALLEST_PIVOT: f64 = 1e-4;

/// Weight of the misfit of nodes beyond the cells around a corner: enough to determine the polynomial. Larger ones would
/// make a one-sided fit as wide as its patch.
const FAR_WEIGHT: f64 = 0.1;

/// The recovery on one mesh: the least-squares fit to any field.
#[derive(Clone, Debug)]
pub struct Recovery {
    /// One at each corner of a cell.
    fits: Vec<Option<Fit>>,
}

/// The polynomial around a corner as a linear function of the displacements of nodes.
#[derive(Clone, Debug)]
struct Fit {
    nodes: Vec<usize>,
    origin: [f64; 2],
    scale: [f64; 2],
    degree: usize,
    /// Coefficients by monomial (rows) for a unit displacement of each node (columns).
    coefficients: DMatrix<f64>,
}

impl Recovery {
    /// Fits around every corner of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let patches = Patches::new(mesh);
        let corners = (0..mesh.nodes.len()).into_par_iter();
        let fit = |corner: usize| {
            let is_corner = !patches.cells_at[corner].is_empty();
            is_corner.then(|| patches.fit(corner))
        };
        Self {
            fits: corners.map(fit).collect(),
        }
    }

    /// The gradient of a field given as ux, uy of node after node.
    pub fn gradient(&self, displacement: &[f64]) -> RecoveredGradient {
        let fits = self.fits.iter();
        let polynomial = |fit: &Option<Fit>| fit.as_ref().map(|fit| fit.polynomial(displacement));
        RecoveredGradient {
            polynomials: fits.map(polynomial).collect(),
        }
    }
}

impl Fit {
    fn polynomial(&self, displacement: &[f64]) -> Polynomial {
        let mut coefficients = vec![[0.0; 2]; self.coefficients.nrows()];
        for (node, column) in self.nodes.iter().zip(self.coefficients.column_iter()) {
            for (sums, value) in coefficients.iter_mut().zip(&column) {
                sums[0] += value * displacement[2 * node];
                sums[1] += value * displacement[2 * node + 1];
            }
        }
        Polynomial {
            origin: self.origin,
            scale: self.scale,
            degree: self.degree,
            coefficients,
        }
    }
}

impl RecoveredGradient {
    /// G*₁₁, G*₁₂, G*₂₁, G*₂₂ at a point of a cell in natural coordinates.
    pub fn at(&self, mesh: &Mesh, cell: usize, local: [f64; 2]) -> [f64; 4] {
        let shape = mesh.shape(cell);
        let position = mesh.position(cell, local);
        let values = shape.linear().values(local);
        let mut gradient = [0.0; 4];
        for (corner, value) in mesh.corners(cell).iter().zip(values) {
            let polynomial = self.polynomials[*corner].as_ref();
            let part = polynomial.map_or([0.0; 4], |polynomial| polynomial.gradient(position));
            for (sum, part) in gradient.iter_mut().zip(part) {
                *sum += value * part;
            }
        }
        gradient
    }
}

impl Polynomial {
    fn gradient(&self, position: [f64; 2]) -> [f64; 4] {
        let [x, y] = [0, 1].map(|axis| {
            let x = (position[axis] - self.origin[axis]) / self.scale[axis];
            powers_and_slopes(x, self.scale[axis])
        });
        let mut gradient = [0.0; 4];
        for ([i, j], c) in monomials(self.degree).zip(&self.coefficients) {
            let ([x, along], [y, across]) = (x[i], y[j]);
            let (dx, dy) = (along * y, x * across);
            for (component, c) in c.iter().enumerate() {
                gradient[2 * component] += c * dx;
                gradient[2 * component + 1] += c * dy;
            }
        }
        gradient
    }
}

/// The highest degree of a fit, one above that of the elements.
const HIGHEST: usize = 3;

/// xⁿ and n xⁿ⁻¹/s for n = 0, 1, 2 …
fn powers_and_slopes(x: f64, s: f64) -> [[f64; 2]; HIGHEST + 1] {
    let mut all = [[1.0, 0.0]; HIGHEST + 1];
    for n in 1..=HIGHEST {
        let [before, _] = all[n - 1];
        all[n] = [before * x, n as f64 * before / s];
    }
    all
}

/// Exponents of xⁱ yʲ with i + j ≤ degree.
fn monomials(degree: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..=degree).flat_map(move |sum| (0..=sum).map(move |j| [sum - j, j]))
}

/// The nodes around each corner.
struct Patches<'a> {
    mesh: &'a Mesh,
    degree: usize,
    /// The cells at each corner.
    cells_at: Vec<Vec<usize>>,
    on_boundary: Vec<bool>,
}

impl<'a> Patches<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let mut cells_at = vec![Vec::new(); mesh.nodes.len()];
        let mut degree = 1;
        for cell in 0..mesh.cell_count() {
            degree = degree.max(mesh.shape(cell).degree());
            for corner in mesh.corners(cell) {
                cells_at[*corner].push(cell);
            }
        }
        let mut on_boundary = vec![false; mesh.nodes.len()];
        for node in mesh.boundary().iter().flatten() {
            on_boundary[*node] = true;
        }
        Self {
            mesh,
            degree: degree + 1,
            cells_at,
            on_boundary,
        }
    }

    /// The fit around a corner.
    fn fit(&self, corner: usize) -> Fit {
        let mut cells: BTreeSet<usize> = self.cells_at[corner].iter().copied().collect();
        let least = 1 + usize::from(self.on_boundary[corner]);
        for layers in 1..MOST_LAYERS {
            if layers >= least
                && let Some(fit) = self.fit_on(corner, &cells, self.degree)
            {
                return fit;
            }
            self.grow(&mut cells);
        }
        // On a mesh of very few cells: the highest degree that they determine.
        let lower = (1..=self.degree).rev();
        let mut fits = lower.filter_map(|degree| self.fit_on(corner, &cells, degree));
        fits.next().unwrap_or_else(|| Fit {
            nodes: Vec::new(),
            origin: self.mesh.nodes[corner],
            scale: [1.0; 2],
            degree: 0,
            coefficients: DMatrix::zeros(1, 0),
        })
    }

    /// Adds the cells that share a corner with those of a patch.
    fn grow(&self, cells: &mut BTreeSet<usize>) {
        let around: Vec<usize> = cells
            .iter()
            .flat_map(|cell| self.mesh.corners(*cell))
            .flat_map(|corner| self.cells_at[*corner].iter().copied())
            .collect();
        cells.extend(around);
    }

    /// Least squares on the nodes of some cells; `None` where they do not determine the polynomial.
    fn fit_on(&self, corner: usize, cells: &BTreeSet<usize>, degree: usize) -> Option<Fit> {
        let mesh = self.mesh;
        let of_cells = |cells: &mut dyn Iterator<Item = &usize>| -> BTreeSet<usize> {
            cells.flat_map(|cell| mesh.cell(*cell)).copied().collect()
        };
        let nodes = of_cells(&mut cells.iter());
        let count = monomials(degree).count();
        if nodes.len() < count {
            return None;
        }
        let origin = mesh.nodes[corner];
        let away = |node: usize, axis: usize| mesh.nodes[node][axis] - origin[axis];
        let scale = [0, 1].map(|axis| {
            let far = nodes.iter().map(|node| away(*node, axis).abs());
            far.fold(f64::MIN_POSITIVE, f64::max)
        });
        let near = of_cells(&mut self.cells_at[corner].iter());
        let nodes: Vec<usize> = nodes.into_iter().collect();
        let mut weights = DVector::zeros(nodes.len());
        let mut matrix = DMatrix::zeros(nodes.len(), count);
        for (row, node) in nodes.iter().enumerate() {
            let [x, y] = [0, 1].map(|axis| away(*node, axis) / scale[axis]);
            weights[row] = if near.contains(node) { 1.0 } else { FAR_WEIGHT };
            let [x, y] = [x, y].map(|x| powers_and_slopes(x, 1.0));
            for (column, [i, j]) in monomials(degree).enumerate() {
                matrix[(row, column)] = weights[row] * x[i][0] * y[j][0];
            }
        }
        Some(Fit {
            coefficients: least_squares(matrix, &weights)?,
            nodes,
            origin,
            scale,
            degree,
        })
    }
}

/// A⁺ diag(w), which maps b to arg min |A x − diag(w) b|; `None` where A is nearly deficient.
fn least_squares(matrix: DMatrix<f64>, weights: &DVector<f64>) -> Option<DMatrix<f64>> {
    let decomposition = matrix.qr();
    let (mut values, upper) = (decomposition.q().transpose(), decomposition.unpack_r());
    let pivots = upper.diagonal();
    let [least, most] = [pivots.amin(), pivots.amax()];
    if least < SMALLEST_PIVOT * most || least.is_nan() {
        return None;
    }
    for (mut column, weight) in values.column_iter_mut().zip(weights) {
        column *= *weight;
    }
    upper.solve_upper_triangular(&values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellShape, Shape};

    #[test]
    fn polynomials_one_degree_above_the_elements_are_recovered_exactly() {
        let shape = Shape::StripWithHole {
            size: [30.0, 10.0],
            radius: 2.5,
        };
        for (name, kind) in CellShape::NAMES {
            let mesh = shape.mesh(6, kind);
            let cubic = (kind.degree() - 1) as f64;
            let field = |[x, y]: &[f64; 2]| {
                [
                    0.1 * x * x - 0.3 * x * y + cubic * 0.01 * x * x * y,
                    0.2 * y * y + x - cubic * 0.02 * y * y * y,
                ]
            };
            let u: Vec<f64> = mesh.nodes.iter().flat_map(field).collect();
            let recovered = Recovery::new(&mesh).gradient(&u);
            for cell in 0..mesh.cell_count() {
                for (local, _) in kind.quadrature() {
                    let [x, y] = mesh.position(cell, local);
                    let exact = [
                        0.2 * x - 0.3 * y + cubic * 0.02 * x * y,
                        -0.3 * x + cubic * 0.01 * x * x,
                        1.0,
                        0.4 * y - cubic * 0.06 * y * y,
                    ];
                    let gradient = recovered.at(&mesh, cell, local);
                    for (gradient, exact) in gradient.iter().zip(exact) {
                        assert!(
                            (gradient - exact).abs() < 1e-9,
                            "{name} {cell}: {gradient} {exact}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn few_cells_give_what_they_determine() {
        for (name, kind) in CellShape::NAMES {
            let mesh = Shape::Strip { size: [2.0, 1.0] }.mesh(1, kind);
            let u: Vec<f64> = mesh
                .nodes
                .iter()
                .flat_map(|[x, y]| [0.1 * x, 0.2 * y])
                .collect();
            let recovered = Recovery::new(&mesh).gradient(&u);
            let gradient = recovered.at(&mesh, 0, kind.centre());
            for (gradient, exact) in gradient.iter().zip([0.1, 0.0, 0.0, 0.2]) {
                assert!((gradient - exact).abs() < 1e-12, "{name}: {gradient}");
            }
        }
    }
}
