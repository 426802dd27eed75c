//! Nodes, cells and named groups of a flat specimen, and fields on them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

mod bisect;
mod blocks;
mod cell_shape;
mod faults;
mod grid;
mod import;
mod locate;
mod outline;
mod refine;
mod rounding;
mod shapes;
mod triangulate;

pub use blocks::{Block, mesh_of_blocks};
pub use cell_shape::{CellShape, GAUSS_3, GAUSS_5, QuadraturePoint};
pub use faults::Allowed;
pub use grid::{Grid, Side};
pub use import::{
    ImportedField, ImportedSeries, ImportedStep, MeshReading, import, import_field, import_series,
};
use locate::Buckets;
pub use outline::{Found, Outline};
pub use rounding::Polygon;
pub use shapes::Shape;

/// A named part of the boundary, or a set of nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Its nodes, ascending.
    pub nodes: Vec<usize>,
    /// Its edges, if it is a part of the boundary: both ends, then the middle where there is one, with the
    /// specimen to the left.
    pub edges: Vec<Vec<usize>>,
}

/// A flat mesh of triangles and quadrilaterals.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Reference coordinates in mm.
    pub nodes: Vec<[f64; 2]>,
    shapes: Vec<CellShape>,
    starts: Vec<usize>,
    connectivity: Vec<usize>,
    groups: BTreeMap<String, Group>,
    grid: Option<Grid>,
    buckets: OnceLock<Buckets>,
    boundary: OnceLock<Vec<Vec<usize>>>,
}

/// The distance that counts as none beside the size of a cell.
const ROUNDING: f64 = 2e-15;

impl Mesh {
    /// A mesh of cells with their nodes in the order of [`CellShape::reference_nodes`].
    ///
    /// # Panics
    /// When a cell has another number of nodes than its kind.
    pub fn new(
        nodes: Vec<[f64; 2]>,
        cells: impl IntoIterator<Item = (CellShape, Vec<usize>)>,
    ) -> Self {
        let (mut shapes, mut starts, mut connectivity) = (Vec::new(), vec![0], Vec::new());
        for (shape, nodes) in cells {
            assert_eq!(nodes.len(), shape.nodes(), "nodes of a {shape:?}");
            shapes.push(shape);
            connectivity.extend(nodes);
            starts.push(connectivity.len());
        }
        Self {
            nodes,
            shapes,
            starts,
            connectivity,
            groups: BTreeMap::new(),
            grid: None,
            buckets: OnceLock::new(),
            boundary: OnceLock::new(),
        }
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.shapes.len()
    }

    /// The kind of a cell.
    pub fn shape(&self, cell: usize) -> CellShape {
        self.shapes[cell]
    }

    /// The names of the finite elements that the cells are: `Q2`, or `T2 and Q2`.
    pub fn element_names(&self) -> String {
        let kinds = CellShape::NAMES.iter();
        let used = kinds.filter(|(_, kind)| self.shapes.contains(kind));
        let names: Vec<_> = used.map(|(name, _)| *name).collect();
        names.join(" and ")
    }

    /// The degree of its cells, the higher one where there are several.
    pub fn degree(&self) -> usize {
        let degrees = self.shapes.iter().map(|shape| shape.degree());
        degrees.max().unwrap_or(1)
    }

    /// The nodes of a cell, in the order of [`CellShape::reference_nodes`].
    pub fn cell(&self, cell: usize) -> &[usize] {
        &self.connectivity[self.starts[cell]..self.starts[cell + 1]]
    }

    /// The groups by name.
    pub fn groups(&self) -> &BTreeMap<String, Group> {
        &self.groups
    }

    /// Names a group of nodes; the boundary edges that lie within it belong to it.
    pub fn name_nodes(&mut self, name: &str, nodes: &BTreeSet<usize>) {
        let within = |edge: &&Vec<usize>| edge.iter().all(|node| nodes.contains(node));
        let edges = self.boundary().iter().filter(within).cloned().collect();
        self.put_group(name, nodes.iter().copied().collect(), edges);
    }

    /// Names the part of the boundary whose edges have all nodes where `inside` holds.
    pub fn name_boundary(&mut self, name: &str, inside: impl Fn([f64; 2]) -> bool) {
        let within = |edge: &&Vec<usize>| edge.iter().all(|node| inside(self.nodes[*node]));
        let edges = self.boundary().iter().filter(within).cloned().collect();
        self.name_edges(name, edges);
    }

    /// Names a group of boundary edges.
    pub fn name_edges(&mut self, name: &str, edges: Vec<Vec<usize>>) {
        self.put_group(name, edges.iter().flatten().copied().collect(), edges);
    }

    /// Names a group of nodes and edges as they are.
    fn put_group(&mut self, name: &str, mut nodes: Vec<usize>, edges: Vec<Vec<usize>>) {
        nodes.sort_unstable();
        nodes.dedup();
        self.groups.insert(name.to_owned(), Group { nodes, edges });
    }

    /// The edges that belong to one cell alone, each with the specimen to its left.
    pub fn boundary(&self) -> &[Vec<usize>] {
        self.boundary.get_or_init(|| self.lonely_edges())
    }

    fn lonely_edges(&self) -> Vec<Vec<usize>> {
        let mut edges: BTreeMap<[usize; 2], (usize, Vec<usize>)> = BTreeMap::new();
        for cell in 0..self.cell_count() {
            let nodes = self.cell(cell);
            for local in self.shape(cell).edges() {
                let edge: Vec<usize> = local.iter().map(|node| nodes[*node]).collect();
                let key = [edge[0].min(edge[1]), edge[0].max(edge[1])];
                edges.entry(key).or_insert((0, edge)).0 += 1;
            }
        }
        let lonely = edges.into_values().filter(|(cells, _)| *cells == 1);
        lonely.map(|(_, edge)| edge).collect()
    }

    /// Centre of a cell in mm: the mean of its corners.
    pub fn centre(&self, cell: usize) -> [f64; 2] {
        let corners = &self.cell(cell)[..self.shape(cell).corners()];
        [0, 1].map(|axis| {
            let sum: f64 = corners.iter().map(|node| self.nodes[*node][axis]).sum();
            sum / corners.len() as f64
        })
    }

    /// The cell that holds a point, and the point's reference coordinates in it; for a point outside of the mesh
    /// the nearest cell.
    pub fn locate(&self, point: [f64; 2]) -> (usize, [f64; 2]) {
        match self.grid {
            Some(grid) => grid.locate(point),
            None => {
                let buckets = self.buckets.get_or_init(|| Buckets::new(self));
                buckets.locate(self, point)
            }
        }
    }

    /// How far a point lies outside of the mesh, in sizes of its nearest cell; zero inside.
    pub fn outside(&self, point: [f64; 2]) -> f64 {
        let (cell, local) = self.locate(point);
        let shape = self.shape(cell);
        let size = if shape.is_triangle() { 1.0 } else { 2.0 };
        shape.outside(local) / size
    }

    /// Lower left and upper right corner of the box around all nodes, in mm.
    pub fn bounding_box(&self) -> [[f64; 2]; 2] {
        let limit = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
            self.nodes.iter().map(|node| node[axis]).fold(start, pick)
        };
        [
            [0, 1].map(|axis| limit(axis, f64::min, f64::INFINITY)),
            [0, 1].map(|axis| limit(axis, f64::max, f64::NEG_INFINITY)),
        ]
    }

    /// Middle of the box around all nodes, in mm.
    pub fn middle(&self) -> [f64; 2] {
        let [low, high] = self.bounding_box();
        [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))
    }

    /// The reference coordinates of a point in a cell, by Newton's method; nothing where it finds none.
    fn local_coordinates(&self, cell: usize, point: [f64; 2]) -> Option<[f64; 2]> {
        let shape = self.shape(cell);
        // Relative to a node of the cell, so that a mesh far from the origin loses no digits.
        let origin = self.nodes[self.cell(cell)[0]];
        let from_origin = |place: [f64; 2]| [place[0] - origin[0], place[1] - origin[1]];
        let nodes = self.cell(cell).iter();
        let places: Vec<[f64; 2]> = nodes.map(|node| from_origin(self.nodes[*node])).collect();
        let size = places
            .iter()
            .flatten()
            .fold(0.0, |size: f64, x| size.max(x.abs()));
        let far = origin[0].abs().max(origin[1].abs());
        let negligible = ROUNDING * size + 2.0 * f64::EPSILON * far;
        let mut local = shape.centre();
        for _ in 0..60 {
            let values = shape.values(local);
            let mut miss = from_origin(point);
            for (place, value) in places.iter().zip(&values) {
                miss = [miss[0] - value * place[0], miss[1] - value * place[1]];
            }
            // Where the Jacobian vanishes, as at the outer sides of cells graded by two, steps do not become short.
            if miss[0].abs().max(miss[1].abs()) <= negligible {
                return Some(local);
            }
            let map = self.map(cell, &shape.derivatives(local));
            let jacobian = determinant(&map);
            if jacobian == 0.0 || local.iter().any(|x| x.abs() > 50.0) {
                return None;
            }
            let step = [
                (map[1][1] * miss[0] - map[0][1] * miss[1]) / jacobian,
                (map[0][0] * miss[1] - map[1][0] * miss[0]) / jacobian,
            ];
            local = [local[0] + step[0], local[1] + step[1]];
            if step[0].abs().max(step[1].abs()) < 1e-13 {
                return Some(local);
            }
        }
        None
    }

    /// The area of all cells in mm².
    pub fn area(&self) -> f64 {
        let of_cell = |cell: usize| {
            let points = self.shape(cell).product_quadrature(&GAUSS_3);
            let parts = points
                .into_iter()
                .map(|(point, weight)| weight * self.gradients(cell, point).1);
            parts.sum::<f64>()
        };
        (0..self.cell_count()).map(of_cell).sum()
    }

    /// The place in mm of a reference point of a cell.
    pub fn place(&self, cell: usize, local: [f64; 2]) -> [f64; 2] {
        let values = self.shape(cell).values(local);
        [0, 1].map(|axis| {
            let nodes = self.cell(cell).iter().zip(&values);
            nodes
                .map(|(node, value)| value * self.nodes[*node][axis])
                .sum()
        })
    }

    /// Displacement interpolated at a point; `displacement` holds ux, uy of node after node.
    pub fn displacement_at(&self, displacement: &[f64], point: [f64; 2]) -> [f64; 2] {
        let (cell, local) = self.locate(point);
        let values = self.shape(cell).values(local);
        let component = |axis: usize| {
            let nodes = self.cell(cell).iter().zip(&values);
            nodes
                .map(|(node, value)| value * displacement[2 * node + axis])
                .sum()
        };
        [component(0), component(1)]
    }

    /// Displacement interpolated at all nodes of another mesh of the specimen.
    pub fn displacement_on(&self, displacement: &[f64], other: &Self) -> Vec<f64> {
        let nodes = other.nodes.iter();
        nodes
            .flat_map(|node| self.displacement_at(displacement, *node))
            .collect()
    }

    /// Gradients ∂Nₐ/∂X of a cell's shape functions in 1/mm, and the Jacobian of its map in mm², at a reference
    /// point.
    pub fn gradients(&self, cell: usize, local: [f64; 2]) -> (Vec<[f64; 2]>, f64) {
        let derivatives = self.shape(cell).derivatives(local);
        let map = self.map(cell, &derivatives);
        let jacobian = determinant(&map);
        let transform = |d: &[f64; 2]| {
            [
                (d[0] * map[1][1] - d[1] * map[1][0]) / jacobian,
                (d[1] * map[0][0] - d[0] * map[0][1]) / jacobian,
            ]
        };
        (derivatives.iter().map(transform).collect(), jacobian)
    }

    /// ∂Xᵢ/∂ξⱼ of a cell.
    fn map(&self, cell: usize, derivatives: &[[f64; 2]]) -> [[f64; 2]; 2] {
        let mut map = [[0.0; 2]; 2];
        for (node, derivative) in self.cell(cell).iter().zip(derivatives) {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                map[i][j] += self.nodes[*node][i] * derivative[j];
            }
        }
        map
    }

    /// Displacement gradient H₁₁, H₁₂, H₂₁, H₂₂ at a reference point of a cell.
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

    /// `node 12 (35.0, 7.3) mm along x`, for messages.
    pub fn describe_unknown(&self, unknown: usize) -> String {
        let [x, y] = self.nodes[unknown / 2];
        let axis = ["x", "y"][unknown % 2];
        format!("node {} ({x:.1}, {y:.1}) mm along {axis}", unknown / 2)
    }

    /// `cell 80 near (150.0, 0.0) mm`, for messages.
    pub fn describe_cell(&self, cell: usize) -> String {
        let [x, y] = self.centre(cell);
        format!("cell {cell} near ({x:.1}, {y:.1}) mm")
    }
}

fn determinant(map: &[[f64; 2]; 2]) -> f64 {
    map[0][0] * map[1][1] - map[0][1] * map[1][0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes of a graded plate's mesh are found in it, wherever it lies, when it is a mesh of any cells.
    #[test]
    fn nodes_of_graded_cells_are_found_far_from_the_origin() {
        for (grading, far) in [(1.0, 0.0), (2.0, 0.0), (2.0, 1e3), (3.0, 1e3), (1.0, 1e5)] {
            let grid = Grid {
                size: [50.0, 150.0],
                cells: [8, 20],
                grading,
            };
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
            for place in mesh.nodes.iter().copied().chain(on_top) {
                let outside = mesh.outside(place);
                assert!(outside < 1e-5, "{grading} {far} {place:?}: {outside}");
            }
        }
    }

    #[test]
    fn quadratic_fields_are_interpolated_exactly_by_nine_nodes() {
        let mesh = Mesh::plate([3.0, 2.0], [3, 2], CellShape::Quad9);
        let field = |[x, y]: [f64; 2]| [x * x - 2.0 * x * y, 0.5 * y * y + x];
        let u: Vec<f64> = mesh.nodes.iter().flat_map(|node| field(*node)).collect();
        let point = [1.3, 0.7];
        let (found, exact) = (mesh.displacement_at(&u, point), field(point));
        assert!((found[0] - exact[0]).abs() < 1e-14 && (found[1] - exact[1]).abs() < 1e-14);
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
