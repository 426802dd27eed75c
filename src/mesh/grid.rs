//! The mesh of a plate: a rectangle of equal cells, or of cells that become smaller towards its corners.

use super::{CellShape, Mesh};

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

/// A rectangle of cells between lines; nodes are numbered along Y first.
///
/// ```text
/// X_i/L = ½ (2 i/n)ᵍ  for i ≤ n/2, and the mirror image of it beyond; the same along Y         [–]
/// ```
///
/// The exponent g is the grading: with 1 all cells are equal. Where the solution goes like rᵅ beside a corner, elements
/// of degree p keep their full order with g > p/α (α ≈ 0.75 where an incompressible sheet's clamp meets a free edge).
///
/// # References
/// I. Babuška, R. B. Kellogg, J. Pitkäranta, Numer. Math. 33, 447 (1979), doi:10.1007/BF01399326
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Length along X and width along Y in mm.
    pub size: [f64; 2],
    /// Cells along X and Y.
    pub cells: [usize; 2],
    /// The exponent g.
    pub grading: f64,
}

impl Grid {
    /// The place of a line in mm, `step` of `steps` along an axis; the last one lies on the side to the last digit.
    fn line(self, axis: usize, step: usize, steps: usize) -> f64 {
        let size = self.size[axis];
        if self.grading == 1.0 || step == steps {
            return match step == steps {
                true => size,
                false => size * step as f64 / steps as f64,
            };
        }
        let from_near = |step: usize| {
            let share = 2.0 * step as f64 / steps as f64;
            0.5 * size * share.powf(self.grading)
        };
        match 2 * step <= steps {
            true => from_near(step),
            false => size - from_near(steps - step),
        }
    }

    /// The place of a line of nodes, `degree` of them a cell.
    fn node_line(self, axis: usize, node: usize, degree: usize) -> f64 {
        let cells = self.cells[axis];
        if self.grading == 1.0 {
            return self.line(axis, node, cells * degree);
        }
        let (cell, part) = (node / degree, node % degree);
        let from = self.line(axis, cell, cells);
        if part == 0 {
            return from;
        }
        from + (self.line(axis, cell + 1, cells) - from) * part as f64 / degree as f64
    }

    /// The cell that holds a point, and the point's reference coordinates in it.
    pub(super) fn locate(self, point: [f64; 2]) -> (usize, [f64; 2]) {
        let place = |axis: usize| {
            let cells = self.cells[axis];
            if self.grading == 1.0 {
                let step = self.size[axis] / cells as f64;
                let index = ((point[axis] / step) as usize).min(cells - 1);
                return (index, 2.0 * (point[axis] / step - index as f64) - 1.0);
            }
            let share = point[axis] / self.size[axis];
            let near = share.min(1.0 - share).max(0.0);
            let steps = 0.5 * (2.0 * near).powf(1.0 / self.grading) * cells as f64;
            let steps = if share > 0.5 {
                cells as f64 - steps
            } else {
                steps
            };
            let index = (steps as usize).min(cells - 1);
            let [from, to] = [index, index + 1].map(|step| self.line(axis, step, cells));
            (index, 2.0 * (point[axis] - from) / (to - from) - 1.0)
        };
        let ((i, x), (j, y)) = (place(0), place(1));
        (i * self.cells[1] + j, [x, y])
    }

    fn is_on(self, side: Side, [x, y]: [f64; 2]) -> bool {
        match side {
            Side::Left => x == 0.0,
            Side::Right => x == self.size[0],
            Side::Bottom => y == 0.0,
            Side::Top => y == self.size[1],
        }
    }
}

impl Mesh {
    /// A plate of `size` mm with `cells` equal cells; its groups are the sides `left`, `right`, `bottom`, `top`.
    ///
    /// # Panics
    /// When a size or a number of cells is not positive.
    pub fn plate(size: [f64; 2], cells: [usize; 2], shape: CellShape) -> Self {
        let grading = 1.0;
        let grid = Grid {
            size,
            cells,
            grading,
        };
        Self::of_grid(grid, shape)
    }

    /// The plate of a grid; its groups are the sides `left`, `right`, `bottom`, `top`.
    ///
    /// # Panics
    /// When a size or a number of cells is not positive, or the grading is below 1.
    pub fn of_grid(grid: Grid, shape: CellShape) -> Self {
        let Grid {
            size,
            cells,
            grading,
        } = grid;
        assert!(size.iter().all(|size| *size > 0.0) && cells.iter().all(|cells| *cells > 0));
        assert!(grading >= 1.0, "a grading of {grading}");
        assert!(
            matches!(shape, CellShape::Quad4 | CellShape::Quad9),
            "a grid of nodes"
        );
        let degree = shape.degree();
        let steps = cells.map(|cells| cells * degree);
        let coordinate = |axis: usize, i: usize| grid.node_line(axis, i, degree);
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
        mesh.grid = Some(grid);
        for side in Side::ALL {
            mesh.name_boundary(side.name(), |node| grid.is_on(side, node));
        }
        mesh
    }

    /// The rectangle that the mesh is.
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

    /// Length and width of a cell of a plate of equal cells in mm.
    pub fn cell_size(&self) -> [f64; 2] {
        let Grid { size, cells, .. } = self.grid();
        [0, 1].map(|axis| size[axis] / cells[axis] as f64)
    }

    /// The area in mm² that belongs to each node of a plate: from half way to its neighbours to half way to them.
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
    pub fn on(&self, side: Side, node: usize) -> bool {
        self.grid().is_on(side, self.nodes[node])
    }

    /// Whether a node lies on a grip of the plate: the left or the right side.
    pub fn on_grip(&self, node: usize) -> bool {
        self.on(Side::Left, node) || self.on(Side::Right, node)
    }

    /// Width of the deformed plate at mid length in mm.
    pub fn mid_width(&self, displacement: &[f64]) -> f64 {
        let [length, width] = self.grid().size;
        let lateral = |y: f64| self.displacement_at(displacement, [length / 2.0, y])[1];
        width + lateral(width) - lateral(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for shape in [CellShape::Quad4, CellShape::Quad9] {
            let grid = Grid {
                size: [150.0, 50.0],
                cells: [12, 5],
                grading: 2.0,
            };
            let mesh = Mesh::of_grid(grid, shape);
            let column = |cell: usize| mesh.centre(5 * cell)[0];
            assert!((column(0) + column(11) - 150.0).abs() < 1e-12);
            // The first line lies at ½ (2/12)² of the length.
            assert!((column(0) - 75.0 / 72.0).abs() < 1e-12);
            for cell in 0..mesh.cell_count() {
                for local in [[-0.9, 0.3], [0.0, 0.0], [0.99, -0.99]] {
                    let (found, there) = mesh.locate(mesh.place(cell, local));
                    assert_eq!(found, cell);
                    assert!((0..2).all(|axis| (there[axis] - local[axis]).abs() < 1e-9));
                }
            }
            let area: f64 = mesh.nodal_areas().iter().sum();
            assert!((area - 7500.0).abs() < 1e-9);
            assert!(mesh.describe().contains("12 × 5 cells, graded by 2"));
        }
    }
}
