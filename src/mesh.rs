//! Nodes, cells and named sets of a flat specimen, and fields on them.

/// The kind of all cells of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellShape {
    /// Four nodes, bilinear.
    Quad4,
    /// Nine nodes, biquadratic: corners, mid-sides, centre.
    Quad9,
}

impl CellShape {
    /// Nodes of a cell.
    pub fn nodes(self) -> usize {
        match self {
            Self::Quad4 => 4,
            Self::Quad9 => 9,
        }
    }

    /// Steps of the node grid a cell spans in each direction.
    fn degree(self) -> usize {
        match self {
            Self::Quad4 => 1,
            Self::Quad9 => 2,
        }
    }

    /// Reference coordinates (ξ, η) of the nodes in −1…1: corners counter-clockwise from (−1, −1),
    /// then mid-sides, then the centre. This is VTK's order.
    pub fn reference_nodes(self) -> &'static [[f64; 2]] {
        const NODES: [[f64; 2]; 9] = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [0.0, -1.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [-1.0, 0.0],
            [0.0, 0.0],
        ];
        &NODES[..self.nodes()]
    }

    /// Values Nₐ of the shape functions at a reference point.
    pub fn values(self, point: [f64; 2]) -> Vec<f64> {
        let value = |axis: usize, node: f64| self.factor(node, point[axis])[0];
        self.reference_nodes()
            .iter()
            .map(|node| value(0, node[0]) * value(1, node[1]))
            .collect()
    }

    /// Derivatives [∂Nₐ/∂ξ, ∂Nₐ/∂η] of the shape functions at a reference point.
    pub fn derivatives(self, point: [f64; 2]) -> Vec<[f64; 2]> {
        let derivative = |node: &[f64; 2]| {
            let [x, dx] = self.factor(node[0], point[0]);
            let [y, dy] = self.factor(node[1], point[1]);
            [dx * y, x * dy]
        };
        self.reference_nodes().iter().map(derivative).collect()
    }

    /// The one-dimensional Lagrange polynomial of the node at `node`, and its derivative.
    fn factor(self, node: f64, x: f64) -> [f64; 2] {
        match self {
            Self::Quad4 => [0.5 * (1.0 + node * x), 0.5 * node],
            Self::Quad9 if node == 0.0 => [1.0 - x * x, -2.0 * x],
            Self::Quad9 => [0.5 * x * (x + node), x + 0.5 * node],
        }
    }
}

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

/// A rectangular plate meshed by nx × ny equal cells; nodes are numbered along Y first.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Length along X and width along Y in mm.
    pub size: [f64; 2],
    /// Cells along X and Y.
    pub cells: [usize; 2],
    /// Kind of the cells.
    pub shape: CellShape,
    /// Reference coordinates in mm.
    pub nodes: Vec<[f64; 2]>,
    connectivity: Vec<usize>,
}

impl Mesh {
    /// A plate of `size` mm with `cells` cells.
    ///
    /// # Panics
    /// When a size or a number of cells is not positive.
    pub fn plate(size: [f64; 2], cells: [usize; 2], shape: CellShape) -> Self {
        assert!(size.iter().all(|size| *size > 0.0) && cells.iter().all(|cells| *cells > 0));
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
        let mut connectivity = Vec::with_capacity(cells[0] * cells[1] * shape.nodes());
        for (i, j) in (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| (i, j))) {
            for [x, y] in shape.reference_nodes() {
                let step = |x: f64| ((x + 1.0) * degree as f64 / 2.0) as usize;
                let (column, row) = (i * degree + step(*x), j * degree + step(*y));
                connectivity.push(column * (steps[1] + 1) + row);
            }
        }
        Self {
            size,
            cells,
            shape,
            nodes,
            connectivity,
        }
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// The nodes of a cell, in the order of [`CellShape::reference_nodes`].
    pub fn cell(&self, cell: usize) -> &[usize] {
        let size = self.shape.nodes();
        &self.connectivity[cell * size..(cell + 1) * size]
    }

    /// Length and width of a cell in mm.
    pub fn cell_size(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.size[axis] / self.cells[axis] as f64)
    }

    /// Centre of a cell in mm.
    pub fn centre(&self, cell: usize) -> [f64; 2] {
        let corners = &self.cell(cell)[..4];
        [0, 1].map(|axis| {
            corners
                .iter()
                .map(|node| self.nodes[*node][axis])
                .sum::<f64>()
                / 4.0
        })
    }

    /// Whether a node lies on a side.
    pub fn on(&self, side: Side, node: usize) -> bool {
        let [x, y] = self.nodes[node];
        match side {
            Side::Left => x == 0.0,
            Side::Right => x == self.size[0],
            Side::Bottom => y == 0.0,
            Side::Top => y == self.size[1],
        }
    }

    /// Whether a node lies on a grip: the left or the right side.
    pub fn on_grip(&self, node: usize) -> bool {
        self.on(Side::Left, node) || self.on(Side::Right, node)
    }

    /// The cell that holds a point of the plate, and the point's reference coordinates in it.
    pub fn locate(&self, point: [f64; 2]) -> (usize, [f64; 2]) {
        let step = self.cell_size();
        let index =
            [0, 1].map(|axis| ((point[axis] / step[axis]) as usize).min(self.cells[axis] - 1));
        let local = [0, 1].map(|axis| 2.0 * (point[axis] / step[axis] - index[axis] as f64) - 1.0);
        (index[0] * self.cells[1] + index[1], local)
    }

    /// Displacement interpolated at a point; `displacement` holds ux, uy of node after node.
    pub fn displacement_at(&self, displacement: &[f64], point: [f64; 2]) -> [f64; 2] {
        let (cell, local) = self.locate(point);
        let values = self.shape.values(local);
        let component = |axis: usize| {
            let nodes = self.cell(cell).iter().zip(&values);
            nodes
                .map(|(node, value)| value * displacement[2 * node + axis])
                .sum()
        };
        [component(0), component(1)]
    }

    /// Displacement interpolated at all nodes of another mesh of the plate.
    pub fn displacement_on(&self, displacement: &[f64], other: &Self) -> Vec<f64> {
        let nodes = other.nodes.iter();
        nodes
            .flat_map(|node| self.displacement_at(displacement, *node))
            .collect()
    }

    /// Displacement gradient H₁₁, H₁₂, H₂₁, H₂₂ at a reference point of a cell.
    pub fn gradient_at(&self, displacement: &[f64], cell: usize, local: [f64; 2]) -> [f64; 4] {
        let step = self.cell_size();
        let mut gradient = [0.0; 4];
        for (node, derivative) in self.cell(cell).iter().zip(self.shape.derivatives(local)) {
            for (axis, direction) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                gradient[2 * axis + direction] +=
                    displacement[2 * node + axis] * derivative[direction] * 2.0 / step[direction];
            }
        }
        gradient
    }

    /// Width of the deformed plate at mid length in mm.
    pub fn mid_width(&self, displacement: &[f64]) -> f64 {
        let [length, width] = self.size;
        let lateral = |y: f64| self.displacement_at(displacement, [length / 2.0, y])[1];
        width + lateral(width) - lateral(0.0)
    }

    /// `cell 80 near (150.0, 0.0) mm`, for messages.
    pub fn describe_cell(&self, cell: usize) -> String {
        let [x, y] = self.centre(cell);
        format!("cell {cell} near ({x:.1}, {y:.1}) mm")
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
