//! Which cell of a mesh holds a point.

use super::Mesh;

/// The cells of a mesh by the squares of a coarse grid that their boxes touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Buckets {
    low: [f64; 2],
    step: f64,
    counts: [usize; 2],
    cells: Vec<Vec<usize>>,
}

impl Buckets {
    /// Sorts the cells of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let [low, high] = mesh.bounding_box();
        let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(f64::MIN_POSITIVE));
        let step = (size[0] * size[1] / mesh.cell_count().max(1) as f64).sqrt();
        let step = step.max(size[0].max(size[1]) / 2000.0);
        let counts = size.map(|size| (size / step) as usize + 1);
        let mut buckets = Self {
            low,
            step,
            counts,
            cells: vec![Vec::new(); counts[0] * counts[1]],
        };
        for cell in 0..mesh.cell_count() {
            let [from, to] = mesh.cell_box(cell).map(|corner| buckets.place(corner));
            for i in from[0]..=to[0] {
                for j in from[1]..=to[1] {
                    buckets.cells[i * counts[1] + j].push(cell);
                }
            }
        }
        buckets
    }

    fn place(&self, point: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let step = (point[axis] - self.low[axis]) / self.step;
            (step.max(0.0) as usize).min(self.counts[axis] - 1)
        })
    }

    /// The cell that holds a point and the point's reference coordinates; for a point outside of the mesh the
    /// nearest cell, with coordinates outside of it.
    pub fn locate(&self, mesh: &Mesh, point: [f64; 2]) -> (usize, [f64; 2]) {
        let [i, j] = self.place(point);
        let mut best: Option<(f64, usize, [f64; 2])> = None;
        for reach in 0..self.counts[0].max(self.counts[1]) {
            for cell in self.ring([i, j], reach) {
                let Some(local) = mesh.local_coordinates(cell, point) else {
                    continue;
                };
                let outside = mesh.shape(cell).outside(local);
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
            None => far_away(mesh, point),
        }
    }

    /// The cells whose boxes touch the square of a point.
    fn around(&self, point: [f64; 2]) -> &[usize] {
        let [i, j] = self.place(point);
        &self.cells[i * self.counts[1] + j]
    }

    /// The cells of all squares at a distance of `reach` squares.
    fn ring(&self, [i, j]: [usize; 2], reach: usize) -> Vec<usize> {
        let range = |middle: usize, count: usize| {
            middle.saturating_sub(reach)..=(middle + reach).min(count - 1)
        };
        let mut found = Vec::new();
        for a in range(i, self.counts[0]) {
            for b in range(j, self.counts[1]) {
                if a.abs_diff(i).max(b.abs_diff(j)) == reach {
                    found.extend(&self.cells[a * self.counts[1] + b]);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

impl Mesh {
    /// Whether a point lies inside of a cell, farther from its sides than `margin` in reference coordinates; cells are
    /// left out where `own` holds.
    pub(super) fn holds_inside(
        &self,
        point: [f64; 2],
        margin: f64,
        own: impl Fn(usize) -> bool,
    ) -> bool {
        let buckets = self.buckets.get_or_init(|| Buckets::new(self));
        let around = buckets.around(point).iter();
        let mut others = around.filter(|cell| !own(**cell) && self.is_in_box(**cell, point));
        others.any(|cell| {
            let local = self.local_coordinates(*cell, point);
            local.is_some_and(|local| self.shape(*cell).depth(local) > margin)
        })
    }

    fn is_in_box(&self, cell: usize, point: [f64; 2]) -> bool {
        let [low, high] = self.cell_box(cell);
        (0..2).all(|axis| (low[axis]..=high[axis]).contains(&point[axis]))
    }

    /// Lower left and upper right corner of a box around a cell, in mm. A curved edge lies within the triangle of its
    /// ends a, b and the point 2 m − ½ (a + b) beyond its middle m.
    pub(super) fn cell_box(&self, cell: usize) -> [[f64; 2]; 2] {
        let own = self.cell(cell);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut take = |place: [f64; 2]| {
            for axis in 0..2 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        };
        own.iter().for_each(|node| take(self.nodes[*node]));
        for edge in self.shape(cell).edges() {
            if let [a, b, m] = edge[..] {
                let [a, b, m] = [a, b, m].map(|node| self.nodes[own[node]]);
                take([0, 1].map(|axis| 2.0 * m[axis] - 0.5 * (a[axis] + b[axis])));
            }
        }
        [low, high]
    }
}

/// The cell whose centre is nearest to a point far away from all cells, and the point's coordinates by the map at the
/// centre.
fn far_away(mesh: &Mesh, point: [f64; 2]) -> (usize, [f64; 2]) {
    let distance = |cell: &usize| {
        let centre = mesh.centre(*cell);
        (point[0] - centre[0]).hypot(point[1] - centre[1])
    };
    let cell = (0..mesh.cell_count()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let cell = cell.expect("a mesh has a cell");
    let shape = mesh.shape(cell);
    let start = shape.centre();
    let from = mesh.place(cell, start);
    let (gradients, _) = mesh.gradients(cell, start);
    // ∂ξ/∂X = Σ ξₐ ∂Nₐ/∂X over the nodes of the cell.
    let nodes = || shape.reference_nodes().iter().zip(&gradients);
    let local = [0, 1].map(|axis| {
        let slope = |along: usize| {
            nodes()
                .map(|(place, g)| place[axis] * g[along])
                .sum::<f64>()
        };
        start[axis] + slope(0) * (point[0] - from[0]) + slope(1) * (point[1] - from[1])
    });
    (cell, local)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellShape;

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
        let there = mesh.place(cell, local);
        assert!(
            (there[0] - 9.0).abs() < 1e-9 && (there[1] - 1.0).abs() < 1e-9,
            "{there:?}"
        );
        assert!(mesh.outside([9.0, 1.0]) > 100.0);
    }
}
