//! A better gradient of a finite-element field: polynomial-preserving recovery.
//!
//! Around every corner a polynomial one degree above the elements' is fitted to the nodal displacements by least
//! squares; its gradient is exact for every field of that degree, on any mesh, whatever the cells. Within a cell the
//! gradients of its corners' polynomials are blended by the linear shape functions N of the corners:
//!
//! ```text
//! G*(X) = Σ N_c(X) ∇p_c(X),   p_c = arg min Σ w_a² |p(X_a) − u_a|² over the nodes a around corner c   [–]
//! ```
//!
//! The nodes are those of the cells around the corner with w = 1, and with w = 0.1 those of the cells around these for
//! corners of the boundary and wherever the first ones do not determine the polynomial.
//!
//! # References
//! - Z. Zhang, A. Naga, SIAM J. Sci. Comput. 26, 1192 (2005), doi:10.1137/S1064827503402837
//! - T. Blacker, T. Belytschko, Int. J. Numer. Methods Eng. 37, 517 (1994), doi:10.1002/nme.1620370309 (blending)

use std::collections::BTreeSet;

use nalgebra::DMatrix;

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

/// Layers of cells around a corner that are looked for nodes.
const MOST_LAYERS: usize = 4;

/// Smallest pivot over the largest one at which nodes determine a polynomial.
const DETERMINED: f64 = 1e-4;

/// Weight of the misfit of nodes beyond the cells around a corner: enough to determine the polynomial. Larger ones would
/// make a one-sided fit as wide as its patch.
const FAR: f64 = 0.1;

impl RecoveredGradient {
    /// Recovers the gradients of several fields on one mesh; each holds ux, uy of node after node.
    pub fn of<const N: usize>(mesh: &Mesh, fields: [&[f64]; N]) -> [Self; N] {
        let patches = Patches::new(mesh);
        let mut all = fields.map(|_| Self {
            polynomials: vec![None; mesh.nodes.len()],
        });
        for corner in 0..mesh.nodes.len() {
            if patches.cells_at[corner].is_empty() {
                continue;
            }
            let polynomials = patches.fit(corner, &fields);
            for (recovered, polynomial) in all.iter_mut().zip(polynomials) {
                recovered.polynomials[corner] = Some(polynomial);
            }
        }
        all
    }

    /// G*₁₁, G*₁₂, G*₂₁, G*₂₂ at a reference point of a cell.
    pub fn at(&self, mesh: &Mesh, cell: usize, local: [f64; 2]) -> [f64; 4] {
        let shape = mesh.shape(cell);
        let place = mesh.place(cell, local);
        let values = shape.linear().values(local);
        let mut gradient = [0.0; 4];
        for (corner, value) in mesh.cell(cell)[..shape.corners()].iter().zip(values) {
            let polynomial = self.polynomials[*corner].as_ref();
            let part = polynomial.map_or([0.0; 4], |polynomial| polynomial.gradient(place));
            for (sum, part) in gradient.iter_mut().zip(part) {
                *sum += value * part;
            }
        }
        gradient
    }
}

impl Polynomial {
    fn gradient(&self, place: [f64; 2]) -> [f64; 4] {
        let [x, y] = [0, 1].map(|axis| (place[axis] - self.origin[axis]) / self.scale[axis]);
        let mut gradient = [0.0; 4];
        for ([i, j], c) in monomials(self.degree).zip(&self.coefficients) {
            let slope = |x: f64, n: i32| {
                if n == 0 {
                    0.0
                } else {
                    f64::from(n) * x.powi(n - 1)
                }
            };
            let dx = slope(x, i) * y.powi(j) / self.scale[0];
            let dy = x.powi(i) * slope(y, j) / self.scale[1];
            for (component, c) in c.iter().enumerate() {
                gradient[2 * component] += c * dx;
                gradient[2 * component + 1] += c * dy;
            }
        }
        gradient
    }
}

/// Exponents of xⁱ yʲ with i + j ≤ degree.
fn monomials(degree: usize) -> impl Iterator<Item = [i32; 2]> {
    let degree = degree as i32;
    (0..=degree).flat_map(move |sum| (0..=sum).map(move |j| [sum - j, j]))
}

/// Which nodes are around each corner.
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
            let shape = mesh.shape(cell);
            degree = degree.max(shape.degree());
            for corner in &mesh.cell(cell)[..shape.corners()] {
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

    /// The polynomials of several fields around a corner.
    fn fit(&self, corner: usize, fields: &[&[f64]]) -> Vec<Polynomial> {
        let mut cells: BTreeSet<usize> = self.cells_at[corner].iter().copied().collect();
        let least = 1 + usize::from(self.on_boundary[corner]);
        for layers in 1..MOST_LAYERS {
            if layers >= least
                && let Some(found) = self.fit_on(corner, &cells, self.degree, fields)
            {
                return found;
            }
            self.grow(&mut cells);
        }
        // A mesh of very few cells: what they determine.
        let lower = (1..=self.degree).rev();
        let mut found = lower.filter_map(|degree| self.fit_on(corner, &cells, degree, fields));
        found.next().unwrap_or_else(|| {
            let nothing = || Polynomial {
                origin: self.mesh.nodes[corner],
                scale: [1.0; 2],
                degree: 0,
                coefficients: vec![[0.0; 2]],
            };
            fields.iter().map(|_| nothing()).collect()
        })
    }

    /// Adds the cells that share a corner with those of a patch.
    fn grow(&self, cells: &mut BTreeSet<usize>) {
        let corners = |cell: usize| &self.mesh.cell(cell)[..self.mesh.shape(cell).corners()];
        let around: Vec<usize> = cells
            .iter()
            .flat_map(|cell| corners(*cell))
            .flat_map(|corner| self.cells_at[*corner].iter().copied())
            .collect();
        cells.extend(around);
    }

    /// Least squares on the nodes of some cells; nothing where they do not determine the polynomial.
    fn fit_on(
        &self,
        corner: usize,
        cells: &BTreeSet<usize>,
        degree: usize,
        fields: &[&[f64]],
    ) -> Option<Vec<Polynomial>> {
        let mesh = self.mesh;
        let nodes: BTreeSet<usize> = cells
            .iter()
            .flat_map(|cell| mesh.cell(*cell).iter().copied())
            .collect();
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
        let nodes: Vec<usize> = nodes.into_iter().collect();
        let near = self.cells_at[corner].iter();
        let near: BTreeSet<usize> = near.flat_map(|cell| mesh.cell(*cell)).copied().collect();
        let mut matrix = DMatrix::zeros(nodes.len(), count);
        let mut values = DMatrix::zeros(nodes.len(), 2 * fields.len());
        for (row, node) in nodes.iter().enumerate() {
            let [x, y] = [0, 1].map(|axis| away(*node, axis) / scale[axis]);
            let weight = if near.contains(node) { 1.0 } else { FAR };
            for (column, [i, j]) in monomials(degree).enumerate() {
                matrix[(row, column)] = weight * x.powi(i) * y.powi(j);
            }
            for (field, u) in fields.iter().enumerate() {
                values[(row, 2 * field)] = weight * u[2 * node];
                values[(row, 2 * field + 1)] = weight * u[2 * node + 1];
            }
        }
        let found = least_squares(matrix, values)?;
        let polynomial = |field: usize| Polynomial {
            origin,
            scale,
            degree,
            coefficients: (0..count)
                .map(|row| [found[(row, 2 * field)], found[(row, 2 * field + 1)]])
                .collect(),
        };
        Some((0..fields.len()).map(polynomial).collect())
    }
}

/// arg min |A x − b| for every column of b; nothing where A is nearly deficient.
fn least_squares(matrix: DMatrix<f64>, mut values: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let count = matrix.ncols();
    let decomposition = matrix.qr();
    decomposition.q_tr_mul(&mut values);
    let upper = decomposition.unpack_r();
    let pivots = (0..count).map(|i| upper[(i, i)].abs());
    let [least, most] = pivots.fold([f64::INFINITY, 0.0], |[least, most], pivot| {
        [pivot.min(least), pivot.max(most)]
    });
    if least < DETERMINED * most || least.is_nan() {
        return None;
    }
    upper.solve_upper_triangular(&values.rows(0, count).into_owned())
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
            let [recovered] = RecoveredGradient::of(&mesh, [&u]);
            for cell in 0..mesh.cell_count() {
                for (local, _) in kind.quadrature() {
                    let [x, y] = mesh.place(cell, local);
                    let exact = [
                        0.2 * x - 0.3 * y + cubic * 0.02 * x * y,
                        -0.3 * x + cubic * 0.01 * x * x,
                        1.0,
                        0.4 * y - cubic * 0.06 * y * y,
                    ];
                    let found = recovered.at(&mesh, cell, local);
                    for (found, exact) in found.iter().zip(exact) {
                        assert!(
                            (found - exact).abs() < 1e-9,
                            "{name} {cell}: {found} {exact}"
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
            let [recovered] = RecoveredGradient::of(&mesh, [&u]);
            let found = recovered.at(&mesh, 0, kind.centre());
            for (found, exact) in found.iter().zip([0.1, 0.0, 0.0, 0.2]) {
                assert!((found - exact).abs() < 1e-12, "{name}: {found}");
            }
        }
    }
}
