//! The maps of cells, and fields between the nodes.

use super::cell_shape::{CellShape, GAUSS_3};
use super::cells::Mesh;
use super::geometry::determinant;

/// A cell, and natural coordinates in it.
pub type CellPoint = (usize, [f64; 2]);

/// The nodes of a mesh as combinations of those of another one.
#[derive(Clone, Debug)]
pub struct Interpolation {
    /// Where the terms of each node begin.
    starts: Vec<u32>,
    /// Nodes of the other mesh, and their shares.
    nodes: Vec<u32>,
    shares: Vec<f64>,
}

impl Interpolation {
    /// Nodes of the other mesh with their shares in a node.
    pub fn of(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let terms = self.starts[node] as usize..self.starts[node + 1] as usize;
        let nodes = self.nodes[terms.clone()].iter().map(|node| *node as usize);
        nodes.zip(self.shares[terms].iter().copied())
    }

    /// ux, uy of node after node, from those of the other mesh.
    pub fn apply(&self, displacement: &[f64]) -> Vec<f64> {
        let at = |node: usize| {
            self.of(node).fold([0.0; 2], |[x, y], (node, share)| {
                [
                    x + share * displacement[2 * node],
                    y + share * displacement[2 * node + 1],
                ]
            })
        };
        (0..self.starts.len() - 1).flat_map(at).collect()
    }
}

impl Mesh {
    /// The area of all cells in mm².
    pub fn area(&self) -> f64 {
        (0..self.cell_count())
            .map(|cell| self.cell_area(cell))
            .sum()
    }

    /// The area of a cell in mm².
    pub fn cell_area(&self, cell: usize) -> f64 {
        let points = self.shape(cell).product_quadrature(&GAUSS_3).into_iter();
        let parts = points.map(|(point, weight)| weight * self.gradients(cell, point).1);
        parts.sum()
    }

    /// The parts of a cell's area in mm² that belong to its nodes, ∫ Nᵢ dA, point by point of its quadrature.
    pub fn area_parts(&self, cell: usize) -> Vec<(usize, f64)> {
        let (shape, mut parts) = (self.shape(cell), Vec::new());
        for (point, weight) in shape.quadrature() {
            let area = weight * self.gradients(cell, point).1;
            let nodes = self.cell(cell).iter().zip(shape.values(point));
            parts.extend(nodes.map(|(node, value)| (*node, area * value)));
        }
        parts
    }

    /// The area in mm² that belongs to each node: the area of a cell is divided equally among its corners.
    pub fn corner_areas(&self) -> Vec<f64> {
        self.areas_shared_by(CellShape::corners)
    }

    /// The area in mm² that belongs to each node: the area of a cell is divided equally among all its nodes.
    pub fn areas_of_all_nodes(&self) -> Vec<f64> {
        self.areas_shared_by(CellShape::nodes)
    }

    /// Divides the area of each cell equally among its first nodes, so many for each kind.
    fn areas_shared_by(&self, first: impl Fn(CellShape) -> usize) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        for cell in 0..self.cell_count() {
            let shape = self.shape(cell);
            let rule = shape.quadrature().into_iter();
            let area: f64 = rule
                .map(|(point, weight)| weight * self.gradients(cell, point).1)
                .sum();
            let nodes = &self.cell(cell)[..first(shape)];
            for node in nodes {
                areas[*node] += area / nodes.len() as f64;
            }
        }
        areas
    }

    /// The position in mm of a point of a cell in natural coordinates.
    pub fn position(&self, cell: usize, local: [f64; 2]) -> [f64; 2] {
        self.interpolated((cell, local), |node, axis| self.nodes[node][axis])
    }

    /// A vector at a position, from its components at the nodes.
    fn interpolated(&self, (cell, local): CellPoint, at: impl Fn(usize, usize) -> f64) -> [f64; 2] {
        let values = self.shape(cell).values(local);
        [0, 1].map(|axis| {
            let nodes = self.cell(cell).iter().zip(&values);
            nodes.map(|(node, value)| value * at(*node, axis)).sum()
        })
    }

    /// Displacement interpolated at a point; `displacement` is ux, uy of node after node.
    pub fn displacement_at(&self, displacement: &[f64], point: [f64; 2]) -> [f64; 2] {
        self.displacement_in(displacement, self.locate(point))
    }

    fn displacement_in(&self, displacement: &[f64], point: CellPoint) -> [f64; 2] {
        self.interpolated(point, |node, axis| displacement[2 * node + axis])
    }

    /// Displacement interpolated at all nodes of another mesh of the specimen; on a seam, that of the side to which a node belongs.
    pub fn displacement_on(&self, displacement: &[f64], other: &Self) -> Vec<f64> {
        let positions = self.positions_by_side_of_seam(other);
        let position = |node: usize| match &positions {
            Some(positions) => positions[node],
            None => self.locate(other.nodes[node]),
        };
        let nodes = 0..other.nodes.len();
        nodes
            .flat_map(|node| self.displacement_in(displacement, position(node)))
            .collect()
    }

    /// The positions of another mesh's nodes in this one, both of the same specimen, to interpolate many fields; as [`Self::displacement_on`].
    pub fn interpolation_on(&self, other: &Self) -> Interpolation {
        let mut starts = Vec::with_capacity(other.nodes.len() + 1);
        starts.push(0);
        let (mut nodes, mut shares) = (Vec::new(), Vec::new());
        let positions = self.positions_by_side_of_seam(other);
        let mut cell = 0;
        for (node, position) in other.nodes.iter().enumerate() {
            let local;
            (cell, local) = match &positions {
                Some(positions) => positions[node],
                None => self.locate_near(cell, *position),
            };
            shares.extend(self.shape(cell).values(local));
            nodes.extend(self.cell(cell).iter().map(|node| *node as u32));
            starts.push(u32::try_from(nodes.len()).expect("fewer than 2³² terms"));
        }
        nodes.shrink_to_fit();
        shares.shrink_to_fit();
        Interpolation {
            starts,
            nodes,
            shares,
        }
    }

    /// Gradients ∂Nₐ/∂X of a cell's shape functions in 1/mm, and the Jacobian of its map in mm², at a reference
    /// point.
    pub fn gradients(&self, cell: usize, local: [f64; 2]) -> (Vec<[f64; 2]>, f64) {
        let derivatives = self.shape(cell).derivatives(local);
        let (inverse, jacobian) = self.inverse_map(cell, &derivatives);
        let transform = |d: &[f64; 2]| [0, 1].map(|k| d[0] * inverse[0][k] + d[1] * inverse[1][k]);
        (derivatives.iter().map(transform).collect(), jacobian)
    }

    /// ∂ξⱼ/∂Xₖ of a cell in 1/mm, and the Jacobian of its map in mm², where the derivatives of its shape functions with respect to
    /// natural coordinates are these.
    pub fn inverse_map(&self, cell: usize, derivatives: &[[f64; 2]]) -> ([[f64; 2]; 2], f64) {
        let map = self.map(cell, derivatives);
        let jacobian = determinant(&map);
        let inverse = [[map[1][1], -map[0][1]], [-map[1][0], map[0][0]]];
        (
            inverse.map(|row| row.map(|entry| entry / jacobian)),
            jacobian,
        )
    }

    /// ∂Xᵢ/∂ξⱼ of a cell.
    pub(super) fn map(&self, cell: usize, derivatives: &[[f64; 2]]) -> [[f64; 2]; 2] {
        let mut map = [[0.0; 2]; 2];
        for (node, derivative) in self.cell(cell).iter().zip(derivatives) {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                map[i][j] += self.nodes[*node][i] * derivative[j];
            }
        }
        map
    }

    /// Displacement gradient H₁₁, H₁₂, H₂₁, H₂₂ at a point of a cell in natural coordinates.
    pub fn gradient_at(&self, displacement: &[f64], cell: usize, local: [f64; 2]) -> [f64; 4] {
        let (gradients, _) = self.gradients(cell, local);
        let mut gradient = [0.0; 4];
        for (node, derivative) in self.cell(cell).iter().zip(gradients) {
            for (axis, direction) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                gradient[2 * axis + direction] +=
                    displacement[2 * node + axis] * derivative[direction];
            }
        }
        gradient
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cell_shape::CellShape;
    use crate::mesh::grid::Grid;

    /// Nodes of a graded plate's mesh are found in it, wherever it lies, when it is a mesh of any cells.
    #[test]
    fn nodes_of_graded_cells_are_found_far_from_the_origin() {
        for (grading, far) in [(1.0, 0.0), (2.0, 0.0), (2.0, 1e3), (3.0, 1e3), (1.0, 1e5)] {
            let grid = Grid::new([50.0, 150.0], [8, 20], grading);
            let plate = Mesh::of_grid(grid, CellShape::Quad9);
            let nodes = plate
                .nodes
                .iter()
                .map(|[x, y]| [x + far, y - far])
                .collect();
            let cells =
                (0..plate.cell_count()).map(|cell| (CellShape::Quad9, plate.cell(cell).to_vec()));
            let mesh = Mesh::new(nodes, cells);
            // The map of the cells at the sides is singular there where they are graded by two.
            let on_top = (0..=37).map(|k| [50.0 * f64::from(k) / 37.0 + far, 150.0 - far]);
            for position in mesh.nodes.iter().copied().chain(on_top) {
                let outside = mesh.outside(position);
                assert!(outside < 1e-5, "{grading} {far} {position:?}: {outside}");
            }
        }
    }

    #[test]
    fn quadratic_fields_are_interpolated_exactly_by_nine_nodes() {
        let mesh = Mesh::plate([3.0, 2.0], [3, 2], CellShape::Quad9);
        let field = |[x, y]: [f64; 2]| [x * x - 2.0 * x * y, 0.5 * y * y + x];
        let u: Vec<f64> = mesh.nodes.iter().flat_map(|node| field(*node)).collect();
        let point = [1.3, 0.7];
        let (interpolated, exact) = (mesh.displacement_at(&u, point), field(point));
        assert!(
            (interpolated[0] - exact[0]).abs() < 1e-14
                && (interpolated[1] - exact[1]).abs() < 1e-14
        );
        let (cell, local) = mesh.locate(point);
        let gradient = mesh.gradient_at(&u, cell, local);
        let expected = [2.0 * 1.3 - 2.0 * 0.7, -2.6, 1.0, 0.7];
        assert!(
            gradient
                .iter()
                .zip(expected)
                .all(|(g, e)| (g - e).abs() < 1e-13),
            "{gradient:?}"
        );
    }
}
