//! The lines of a plate's cells, equal or smaller towards its corners.

use super::cell_shape::lobatto;

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

    /// The name of the group of nodes on the side.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Bottom => "bottom",
            Self::Top => "top",
        }
    }

    /// Whether a position in mm lies on the side of a plate of a size.
    pub(super) fn holds(self, size: [f64; 2], [x, y]: [f64; 2]) -> bool {
        match self {
            Self::Left => x == 0.0,
            Self::Right => x == size[0],
            Self::Bottom => y == 0.0,
            Self::Top => y == size[1],
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
    /// Number of cells along both axes that are graded as one, between the nodes of an element of this degree (Lobatto's points): 1, or
    /// 2 equal ones, or 3.
    pub together: usize,
}

impl Grid {
    /// A grid in which each cell is graded by itself.
    pub fn new(size: [f64; 2], cells: [usize; 2], grading: f64) -> Self {
        Self {
            size,
            cells,
            grading,
            together: 1,
        }
    }

    /// The position of a line in mm, `step` of `steps` along an axis; the last one lies on the side to the last digit.
    fn line(self, axis: usize, step: usize, steps: usize) -> f64 {
        let size = self.size[axis];
        if self.grading == 1.0 || step == steps {
            return if step == steps {
                size
            } else {
                size * step as f64 / steps as f64
            };
        }
        let from_near = |step: usize| {
            let share = 2.0 * step as f64 / steps as f64;
            0.5 * size * share.powf(self.grading)
        };
        if 2 * step <= steps {
            from_near(step)
        } else {
            size - from_near(steps - step)
        }
    }

    /// The positions of all lines of cells along an axis in mm, from one side to the other.
    pub fn lines(self, axis: usize) -> Vec<f64> {
        (0..=self.cells[axis])
            .map(|line| self.node_line(axis, line, 1))
            .collect()
    }

    /// Length and width of a cell in mm.
    pub(super) fn cell_size(self, cell: usize) -> [f64; 2] {
        let position = [cell / self.cells[1], cell % self.cells[1]];
        [0, 1].map(|axis| {
            if self.is_equal() {
                self.size[axis] / self.cells[axis] as f64
            } else {
                let line = |line: usize| self.node_line(axis, line, 1);
                line(position[axis] + 1) - line(position[axis])
            }
        })
    }

    /// The position of a line of nodes, with `degree` lines per cell.
    pub(super) fn node_line(self, axis: usize, node: usize, degree: usize) -> f64 {
        let cells = self.cells[axis];
        if self.is_equal() {
            return self.line(axis, node, cells * degree);
        }
        let (blocks, steps) = (cells / self.together, degree * self.together);
        let (block, part) = (node / steps, node % steps);
        let from = self.line(axis, block, blocks);
        if part == 0 {
            return from;
        }
        let (positions, cell) = (lobatto(self.together), part / degree);
        let within = (part % degree) as f64 / degree as f64;
        let share = if within == 0.0 {
            positions[cell]
        } else {
            positions[cell] + (positions[cell + 1] - positions[cell]) * within
        };
        from + (self.line(axis, block + 1, blocks) - from) * share
    }

    /// Whether all cells are equal.
    fn is_equal(self) -> bool {
        self.grading == 1.0 && self.together < 3
    }

    /// The cell that contains a point, and the point's natural coordinates in it.
    pub(super) fn locate(self, point: [f64; 2]) -> (usize, [f64; 2]) {
        let position = |axis: usize| {
            let cells = self.cells[axis];
            if self.is_equal() {
                let step = self.size[axis] / cells as f64;
                let index = ((point[axis] / step) as usize).min(cells - 1);
                return (index, 2.0 * (point[axis] / step - index as f64) - 1.0);
            }
            let share = point[axis] / self.size[axis];
            let near = share.min(1.0 - share).max(0.0);
            let blocks = cells / self.together;
            let steps = 0.5 * (2.0 * near).powf(1.0 / self.grading) * blocks as f64;
            let steps = if share > 0.5 {
                blocks as f64 - steps
            } else {
                steps
            };
            let block = (steps as usize).min(blocks - 1);
            let [from, to] = [block, block + 1].map(|step| self.line(axis, step, blocks));
            let along = (point[axis] - from) / (to - from);
            let positions = lobatto(self.together);
            let part = positions[1..self.together].partition_point(|position| *position <= along);
            let [from, to] = [positions[part], positions[part + 1]];
            let index = block * self.together + part;
            (index, 2.0 * (along - from) / (to - from) - 1.0)
        };
        let ((i, x), (j, y)) = (position(0), position(1));
        (i * self.cells[1] + j, [x, y])
    }
}
