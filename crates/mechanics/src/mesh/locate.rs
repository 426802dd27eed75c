//! Finds the cell of a mesh that contains a point, and the position of the point in the cell.

use super::buckets::Buckets;
use super::cells::Mesh;
use super::geometry::{bounding_box, determinant, distance};

/// Distance that counts as zero, relative to the size of a cell.
const ROUNDING: f64 = 2e-15;

impl Mesh {
    /// The cell that contains a point, and the point's natural coordinates in it; for a point outside of the mesh the nearest cell.
    pub fn locate(&self, point: [f64; 2]) -> (usize, [f64; 2]) {
        match self.grid {
            Some(grid) => grid.locate(point),
            None => self.search(point),
        }
    }

    /// [`Self::locate`] for a point that is likely to be in some cell, which is tried first.
    pub(super) fn locate_near(&self, likely: usize, point: [f64; 2]) -> (usize, [f64; 2]) {
        let there = self.grid.is_none().then(|| self.within(likely, point));
        match there.flatten() {
            Some(local) => (likely, local),
            None => self.locate(point),
        }
    }

    /// The natural coordinates of a point in a cell that contains it; `None` where the cell does not.
    fn within(&self, cell: usize, point: [f64; 2]) -> Option<[f64; 2]> {
        let in_box = self.buckets().is_in_box(cell, point);
        let local = in_box.then(|| self.natural_coordinates(cell, point))??;
        (self.shape(cell).outside(local) < 1e-12).then_some(local)
    }

    /// How far a point lies outside of the mesh, in sizes of its nearest cell; zero inside.
    pub fn outside(&self, point: [f64; 2]) -> f64 {
        self.outside_of_cell(self.locate(point))
    }

    /// [`Self::locate`], or `None` where the point lies farther outside than so many sizes of its nearest cell.
    pub fn locate_within(&self, point: [f64; 2], most: f64) -> Option<(usize, [f64; 2])> {
        let nearest = self.locate(point);
        (self.outside_of_cell(nearest) <= most).then_some(nearest)
    }

    /// The cell of [`Self::locate_within`], and behind it the others that contain the point, where it lies on their common edge.
    pub fn cells_at(&self, point: [f64; 2], most: f64) -> Vec<(usize, [f64; 2])> {
        let Some(first) = self.locate_within(point, most) else {
            return Vec::new();
        };
        let near = self.buckets().around(point).iter();
        let others = near.filter(|cell| **cell != first.0);
        let others = others.filter_map(|cell| Some((*cell, self.within(*cell, point)?)));
        std::iter::once(first).chain(others).collect()
    }

    fn outside_of_cell(&self, (cell, local): (usize, [f64; 2])) -> f64 {
        let shape = self.shape(cell);
        let size = if shape.is_triangle() { 1.0 } else { 2.0 };
        shape.outside(local) / size
    }

    fn buckets(&self) -> &Buckets {
        self.buckets.get_or_init(|| {
            let boxes = (0..self.cell_count()).map(|cell| self.cell_box(cell));
            Buckets::new(self.bounding_box(), boxes.collect())
        })
    }

    fn search(&self, point: [f64; 2]) -> (usize, [f64; 2]) {
        let mut near = self.buckets().around(point).iter();
        let inside = near.find_map(|cell| Some((*cell, self.within(*cell, point)?)));
        inside.unwrap_or_else(|| self.nearest(point))
    }

    /// The cell nearest to a point that is in none, or on the edge of one up to rounding.
    fn nearest(&self, point: [f64; 2]) -> (usize, [f64; 2]) {
        let mut best: Option<(f64, usize, [f64; 2])> = None;
        for (reach, cells) in self.buckets().rings(point).enumerate() {
            for cell in cells {
                let Some(local) = self.natural_coordinates(cell, point) else {
                    continue;
                };
                let outside = self.shape(cell).outside(local);
                if best.is_none_or(|(least, ..)| outside < least) {
                    best = Some((outside, cell, local));
                }
                if outside < 1e-12 {
                    return (cell, local);
                }
            }
            // One more ring around the first hit: the nearest cell may touch a neighbouring square.
            if reach > 0 && best.is_some_and(|(outside, ..)| outside < 1.0) {
                break;
            }
        }
        match best {
            Some((_, cell, local)) => (cell, local),
            None => far_away(self, point),
        }
    }

    /// The natural coordinates of a point in a cell, by Newton's method; `None` where it does not converge.
    pub(super) fn natural_coordinates(&self, cell: usize, point: [f64; 2]) -> Option<[f64; 2]> {
        let shape = self.shape(cell);
        // Relative to a node of the cell, so that a mesh far from the origin loses no digits.
        let origin = self.nodes[self.cell(cell)[0]];
        let from_origin = |position: [f64; 2]| [position[0] - origin[0], position[1] - origin[1]];
        let nodes = self.cell(cell).iter();
        let positions: Vec<[f64; 2]> = nodes.map(|node| from_origin(self.nodes[*node])).collect();
        let size = positions
            .iter()
            .flatten()
            .fold(0.0, |size: f64, x| size.max(x.abs()));
        let far = origin[0].abs().max(origin[1].abs());
        let negligible = ROUNDING * size + 2.0 * f64::EPSILON * far;
        let mut local = shape.centre();
        for _ in 0..60 {
            let values = shape.values(local);
            let mut miss = from_origin(point);
            for (position, value) in positions.iter().zip(&values) {
                miss = [miss[0] - value * position[0], miss[1] - value * position[1]];
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

    /// Whether a point lies inside of a cell, farther from its sides than `margin` in natural coordinates; cells for
    /// which `is_excluded` is true are skipped.
    pub(super) fn holds_inside(
        &self,
        point: [f64; 2],
        margin: f64,
        is_excluded: impl Fn(usize) -> bool,
    ) -> bool {
        let buckets = self.buckets();
        let around = buckets.around(point).iter();
        let mut others =
            around.filter(|cell| !is_excluded(**cell) && buckets.is_in_box(**cell, point));
        others.any(|cell| {
            let local = self.natural_coordinates(*cell, point);
            local.is_some_and(|local| self.shape(*cell).depth(local) > margin)
        })
    }

    /// Lower left and upper right corner of a box around a cell, in mm. A curved edge lies within the triangle of its
    /// ends a, b and the point 2 m − ½ (a + b) beyond its middle m.
    pub(super) fn cell_box(&self, cell: usize) -> [[f64; 2]; 2] {
        let nodes = self.cell(cell);
        let edges = self.shape(cell).edges();
        let control_points = edges.iter().filter_map(|edge| match edge[..] {
            [a, b, m] => {
                let [a, b, m] = [a, b, m].map(|node| self.nodes[nodes[node]]);
                Some([0, 1].map(|axis| 2.0 * m[axis] - 0.5 * (a[axis] + b[axis])))
            }
            _ => None,
        });
        bounding_box(
            nodes
                .iter()
                .map(|node| self.nodes[*node])
                .chain(control_points),
        )
    }
}

/// The cell whose centre is nearest to a point far away from all cells, and the point's coordinates by the map at the
/// centre.
fn far_away(mesh: &Mesh, point: [f64; 2]) -> (usize, [f64; 2]) {
    let from = |cell: &usize| distance(mesh.centre(*cell), point);
    let cell = (0..mesh.cell_count()).min_by(|a, b| from(a).total_cmp(&from(b)));
    let cell = cell.expect("a mesh has a cell");
    let shape = mesh.shape(cell);
    let start = shape.centre();
    let from = mesh.position(cell, start);
    let (slopes, _) = mesh.inverse_map(cell, &shape.derivatives(start));
    let local = [0, 1].map(|axis| {
        let [x, y] = slopes[axis];
        start[axis] + x * (point[0] - from[0]) + y * (point[1] - from[1])
    });
    (cell, local)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cell_shape::CellShape;

    #[test]
    fn points_far_away_are_outside_of_the_nearest_cell() {
        let mesh = Mesh::new(
            vec![[0.0, 0.0], [0.02, 0.0], [0.02, 0.01], [0.0, 0.01]],
            [
                (CellShape::Triangle3, vec![0, 1, 2]),
                (CellShape::Triangle3, vec![0, 2, 3]),
            ],
        );
        let (cell, local) = mesh.locate([9.0, 1.0]);
        let there = mesh.position(cell, local);
        assert!(
            (there[0] - 9.0).abs() < 1e-9 && (there[1] - 1.0).abs() < 1e-9,
            "{there:?}"
        );
        assert!(mesh.outside([9.0, 1.0]) > 100.0);
    }
}
