//! The mesh of a plate: a rectangle of equal cells, or of cells that become smaller towards its corners.

use super::cell_shape::CellShape;
use super::cells::Mesh;
use super::grid::{Grid, Side};

impl Mesh {
    /// A plate of `size` mm with `cells` equal cells; its groups are the sides `left`, `right`, `bottom`, `top`.
    ///
    /// # Panics
    /// When a size or a number of cells is not positive.
    pub fn plate(size: [f64; 2], cells: [usize; 2], shape: CellShape) -> Self {
        Self::of_grid(Grid::new(size, cells, 1.0), shape)
    }

    /// The plate of a grid; its groups are the sides `left`, `right`, `bottom`, `top`.
    ///
    /// # Panics
    /// When a size or a number of cells is not positive, the grading is below 1, or cells remain that cannot be taken together.
    pub fn of_grid(grid: Grid, shape: CellShape) -> Self {
        let Grid {
            size,
            cells,
            grading,
            together,
        } = grid;
        assert!(size.iter().all(|size| *size > 0.0) && cells.iter().all(|cells| *cells > 0));
        assert!(grading >= 1.0, "a grading of {grading}");
        assert!(cells.iter().all(|cells| cells.is_multiple_of(together)));
        assert!(
            matches!(shape, CellShape::Quad4 | CellShape::Quad9),
            "a grid of nodes"
        );
        let degree = shape.degree();
        let lines = |axis: usize| -> Vec<f64> {
            let nodes = 0..=cells[axis] * degree;
            nodes.map(|i| grid.node_line(axis, i, degree)).collect()
        };
        let mut mesh = Self::of_lines(&[lines(0), lines(1)], shape);
        mesh.grid = Some(grid);
        mesh
    }

    /// A plate between the lines of its nodes, whose positions along X and Y in mm begin at zero; its groups are the sides `left`, `right`,
    /// `bottom`, `top`.
    pub fn of_lines([x, y]: &[Vec<f64>; 2], shape: CellShape) -> Self {
        let degree = shape.degree();
        let nodes = x.iter().flat_map(|x| y.iter().map(|y| [*x, *y])).collect();
        let steps = |lines: &[f64]| (0..lines.len() - 1).step_by(degree);
        let all = steps(x).flat_map(|i| steps(y).map(move |j| [i, j]));
        let cell = |[i, j]: [usize; 2]| {
            let node = |[a, b]: &[f64; 2]| {
                let step = |natural: f64| ((natural + 1.0) * degree as f64 / 2.0) as usize;
                (i + step(*a)) * y.len() + j + step(*b)
            };
            (shape, shape.natural_nodes().iter().map(node).collect())
        };
        let mut mesh = Self::new(nodes, all.map(cell));
        let size = [x, y].map(|lines| lines[lines.len() - 1]);
        for side in Side::ALL {
            mesh.name_boundary(side.name(), |position| side.holds(size, position));
        }
        mesh
    }

    /// The rectangle of the mesh.
    ///
    /// # Panics
    /// When the mesh is not such a rectangle.
    pub fn grid(&self) -> Grid {
        self.grid.expect("the mesh of a plate")
    }

    /// `120 × 40 cells`, or the number of cells of a mesh that is not a rectangle.
    pub fn describe(&self) -> String {
        match self.grid {
            Some(Grid {
                cells: [nx, ny],
                grading,
                ..
            }) if grading > 1.0 => format!("{nx} × {ny} cells, graded by {grading}"),
            Some(Grid {
                cells: [nx, ny], ..
            }) => format!("{nx} × {ny} cells"),
            None => format!("{} cells", self.cell_count()),
        }
    }

    /// Length and width of a cell of a plate in mm.
    ///
    /// # Panics
    /// As [`Self::grid`].
    pub fn cell_size(&self, cell: usize) -> [f64; 2] {
        self.grid().cell_size(cell)
    }

    /// The area in mm² that belongs to each node of a plate: from half way to its neighbours to half way to them.
    ///
    /// # Panics
    /// As [`Self::grid`].
    pub fn nodal_areas(&self) -> Vec<f64> {
        let grid = self.grid();
        let degree = self.shape(0).degree();
        let widths = [0, 1].map(|axis| {
            let steps = grid.cells[axis] * degree;
            let line = |node: usize| grid.node_line(axis, node, degree);
            let width = |node: usize| {
                let (from, to) = (line(node.saturating_sub(1)), line((node + 1).min(steps)));
                0.5 * (to - from)
            };
            (0..=steps).map(width).collect::<Vec<f64>>()
        });
        let [along, across] = &widths;
        let areas = along.iter();
        areas
            .flat_map(|x| across.iter().map(move |y| x * y))
            .collect()
    }

    /// Whether a node lies on a side of the plate.
    ///
    /// # Panics
    /// As [`Self::grid`].
    pub fn on(&self, side: Side, node: usize) -> bool {
        side.holds(self.grid().size, self.nodes[node])
    }

    /// Whether a node lies on a grip of the plate: the left or the right side.
    ///
    /// # Panics
    /// As [`Self::grid`].
    pub fn on_grip(&self, node: usize) -> bool {
        self.on(Side::Left, node) || self.on(Side::Right, node)
    }

    /// Width of the deformed plate at mid length in mm.
    ///
    /// # Panics
    /// As [`Self::grid`].
    pub fn mid_width(&self, displacement: &[f64]) -> f64 {
        let [length, width] = self.grid().size;
        let lateral = |y: f64| self.displacement_at(displacement, [length / 2.0, y])[1];
        width + lateral(width) - lateral(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::lobatto;

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

    #[test]
    fn graded_cells_are_symmetric_smaller_at_the_corners_and_found() {
        let shapes = [CellShape::Quad4, CellShape::Quad9];
        for (shape, together) in shapes
            .into_iter()
            .flat_map(|shape| [(shape, 1), (shape, 2), (shape, 3)])
        {
            let single = Grid::new([150.0, 50.0], [12, [5, 4, 3][together - 1]], 2.0);
            let grid = Grid { together, ..single };
            let mesh = Mesh::of_grid(grid, shape);
            let column = |cell: usize| mesh.centre(grid.cells[1] * cell)[0];
            assert!((column(0) + column(11) - 150.0).abs() < 1e-12);
            // The first line lies at ½ (2/12)² of the length; that of the first pair at ½ (2/6)², that of the first three at ½ (2/4)².
            let first = [75.0 / 72.0, 75.0 / 36.0, 75.0 / 8.0 * lobatto(3)[1]][together - 1];
            assert!((column(0) - first).abs() < 1e-12);
            assert!((mesh.cell_size(0)[0] - 2.0 * first).abs() < 1e-12);
            for cell in 0..mesh.cell_count() {
                for local in [[-0.9, 0.3], [0.0, 0.0], [0.99, -0.99]] {
                    let (located, there) = mesh.locate(mesh.position(cell, local));
                    assert_eq!(located, cell);
                    assert!((0..2).all(|axis| (there[axis] - local[axis]).abs() < 1e-9));
                }
            }
            let area: f64 = mesh.nodal_areas().iter().sum();
            assert!((area - 7500.0).abs() < 1e-9);
            let described = format!("12 × {} cells, graded by 2", grid.cells[1]);
            assert!(mesh.describe().contains(&described));
        }
    }
}
