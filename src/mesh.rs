//! Nodes, cells and named groups of a flat specimen, and fields on them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

mod blocks;
mod cell_shape;
mod import;
mod locate;
mod refine;
mod shapes;

pub use blocks::{Block, mesh_of_blocks};
pub use cell_shape::{CellShape, QuadraturePoint};
pub use import::{ImportedField, import, import_field};
use locate::Buckets;
pub use shapes::Shape;

/// Named sides of the plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// X = 0.
    Left,
    /// X = length.
    Right,
    /// Y = 0.
    Bottom,
    /// Y = width.
    Top,
}

impl Side {
    /// All sides.
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Bottom, Self::Top];

    /// The name of the group of nodes on it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Bottom => "bottom",
            Self::Top => "top",
        }
    }
}

/// A named part of the boundary, or a set of nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Its nodes, ascending.
    pub nodes: Vec<usize>,
    /// Its edges, if it is a part of the boundary: both ends, then the middle where there is one, with the
    /// specimen to the left.
    pub edges: Vec<Vec<usize>>,
}

/// A rectangle of equal cells; nodes are numbered along Y first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Length along X and width along Y in mm.
    pub size: [f64; 2],
    /// Cells along X and Y.
    pub cells: [usize; 2],
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

    /// A plate of `size` mm with `cells` equal cells; its groups are the sides `left`, `right`, `bottom`, `top`.
    ///
    /// # Panics
    /// When a size or a number of cells is not positive.
    pub fn plate(size: [f64; 2], cells: [usize; 2], shape: CellShape) -> Self {
        assert!(size.iter().all(|size| *size > 0.0) && cells.iter().all(|cells| *cells > 0));
        assert!(
            matches!(shape, CellShape::Quad4 | CellShape::Quad9),
            "a grid of nodes"
        );
        let degree = shape.degree();
        let steps = cells.map(|cells| cells * degree);
        // The last line of nodes lies on the side to the last digit.
        let coordinate = |axis: usize, i: usize| match i == steps[axis] {
            true => size[axis],
            false => size[axis] * i as f64 / steps[axis] as f64,
        };
        let nodes = (0..=steps[0])
            .flat_map(|i| (0..=steps[1]).map(move |j| [coordinate(0, i), coordinate(1, j)]))
            .collect();
        let all = (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| (i, j)));
        let cell = |(i, j): (usize, usize)| {
            let node = |[x, y]: &[f64; 2]| {
                let step = |x: f64| ((x + 1.0) * degree as f64 / 2.0) as usize;
                let (column, row) = (i * degree + step(*x), j * degree + step(*y));
                column * (steps[1] + 1) + row
            };
            (shape, shape.reference_nodes().iter().map(node).collect())
        };
        let mut mesh = Self::new(nodes, all.map(cell));
        mesh.grid = Some(Grid { size, cells });
        for side in Side::ALL {
            mesh.name_boundary(side.name(), |node| mesh_side(size, side, node));
        }
        mesh
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.shapes.len()
    }

    /// The kind of a cell.
    pub fn shape(&self, cell: usize) -> CellShape {
        self.shapes[cell]
    }

    /// The nodes of a cell, in the order of [`CellShape::reference_nodes`].
    pub fn cell(&self, cell: usize) -> &[usize] {
        &self.connectivity[self.starts[cell]..self.starts[cell + 1]]
    }

    /// The rectangle that the mesh is, if it is one of equal cells.
    ///
    /// # Panics
    /// When the mesh is no such rectangle.
    pub fn grid(&self) -> Grid {
        self.grid.expect("the mesh of a plate")
    }

    /// `120 × 40 cells`, or the number of cells of a mesh that is no rectangle.
    pub fn describe(&self) -> String {
        match self.grid {
            Some(Grid {
                cells: [nx, ny], ..
            }) => format!("{nx} × {ny} cells"),
            None => format!("{} cells", self.cell_count()),
        }
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

    /// Length and width of a cell of a plate in mm.
    pub fn cell_size(&self) -> [f64; 2] {
        let Grid { size, cells } = self.grid();
        [0, 1].map(|axis| size[axis] / cells[axis] as f64)
    }

    /// Whether a node lies on a side of the plate.
    pub fn on(&self, side: Side, node: usize) -> bool {
        mesh_side(self.grid().size, side, self.nodes[node])
    }

    /// Whether a node lies on a grip of the plate: the left or the right side.
    pub fn on_grip(&self, node: usize) -> bool {
        self.on(Side::Left, node) || self.on(Side::Right, node)
    }

    /// The cell that holds a point, and the point's reference coordinates in it; for a point outside of the mesh
    /// the nearest cell.
    pub fn locate(&self, point: [f64; 2]) -> (usize, [f64; 2]) {
        let Some(Grid { cells, .. }) = self.grid else {
            let buckets = self.buckets.get_or_init(|| Buckets::new(self));
            return buckets.locate(self, point);
        };
        let step = self.cell_size();
        let index = [0, 1].map(|axis| ((point[axis] / step[axis]) as usize).min(cells[axis] - 1));
        let local = [0, 1].map(|axis| 2.0 * (point[axis] / step[axis] - index[axis] as f64) - 1.0);
        (index[0] * cells[1] + index[1], local)
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

    /// The reference coordinates of a point in a cell, by Newton's method; nothing where it finds none.
    fn local_coordinates(&self, cell: usize, point: [f64; 2]) -> Option<[f64; 2]> {
        let shape = self.shape(cell);
        let mut local = shape.centre();
        for _ in 0..30 {
            let values = shape.values(local);
            let mut miss = point;
            for (node, value) in self.cell(cell).iter().zip(&values) {
                for (axis, miss) in miss.iter_mut().enumerate() {
                    *miss -= value * self.nodes[*node][axis];
                }
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

    /// Width of the deformed plate at mid length in mm.
    pub fn mid_width(&self, displacement: &[f64]) -> f64 {
        let [length, width] = self.grid().size;
        let lateral = |y: f64| self.displacement_at(displacement, [length / 2.0, y])[1];
        width + lateral(width) - lateral(0.0)
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

/// Whether a point lies on a side of a plate.
fn mesh_side([length, width]: [f64; 2], side: Side, [x, y]: [f64; 2]) -> bool {
    match side {
        Side::Left => x == 0.0,
        Side::Right => x == length,
        Side::Bottom => y == 0.0,
        Side::Top => y == width,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn sides_are_found_whatever_the_size() {
        for size in [0.015, 0.1, 0.7, 150.0] {
            let mesh = Mesh::plate([size, size / 3.0], [60, 20], CellShape::Quad9);
            let on = |side| {
                (0..mesh.nodes.len())
                    .filter(|node| mesh.on(side, *node))
                    .count()
            };
            assert_eq!((on(Side::Right), on(Side::Top)), (41, 121), "{size}");
        }
    }

    #[test]
    fn cells_run_counter_clockwise_and_sides_are_found() {
        let mesh = Mesh::plate([2.0, 1.0], [2, 1], CellShape::Quad4);
        assert_eq!(mesh.cell(1), [2, 4, 5, 3]);
        assert_eq!(mesh.locate([2.0, 1.0]), (1, [1.0, 1.0]));
        assert_eq!((0..6).filter(|node| mesh.on_grip(*node)).count(), 4);
        assert!(mesh.on(Side::Top, 3) && mesh.on(Side::Bottom, 2));
    }
}
