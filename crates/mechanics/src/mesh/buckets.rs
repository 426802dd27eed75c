//! Boxes sorted by the squares of a coarse grid.

/// The cells of a mesh by the squares of a coarse grid that their boxes touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Buckets {
    low: [f64; 2],
    step: f64,
    counts: [usize; 2],
    cells: Vec<Vec<usize>>,
    /// Lower left and upper right corner of the box around each cell.
    boxes: Vec<[[f64; 2]; 2]>,
}

impl Buckets {
    /// Sorts the boxes of cells within the box around all of them.
    pub fn new([low, high]: [[f64; 2]; 2], boxes: Vec<[[f64; 2]; 2]>) -> Self {
        let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(f64::MIN_POSITIVE));
        let step = (size[0] * size[1] / boxes.len().max(1) as f64).sqrt();
        let step = step.max(size[0].max(size[1]) / 2000.0);
        let counts = size.map(|size| (size / step) as usize + 1);
        let mut buckets = Self {
            low,
            step,
            counts,
            cells: vec![Vec::new(); counts[0] * counts[1]],
            boxes: Vec::new(),
        };
        for (cell, corners) in boxes.iter().enumerate() {
            let [from, to] = corners.map(|corner| buckets.position(corner));
            for i in from[0]..=to[0] {
                for j in from[1]..=to[1] {
                    buckets.cells[i * counts[1] + j].push(cell);
                }
            }
        }
        Self { boxes, ..buckets }
    }

    /// Whether a point lies in the box around a cell.
    pub fn is_in_box(&self, cell: usize, point: [f64; 2]) -> bool {
        let [low, high] = self.boxes[cell];
        (0..2).all(|axis| (low[axis]..=high[axis]).contains(&point[axis]))
    }

    fn position(&self, point: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let step = (point[axis] - self.low[axis]) / self.step;
            (step.max(0.0) as usize).min(self.counts[axis] - 1)
        })
    }

    /// The cells whose boxes touch the square of a point.
    pub fn around(&self, point: [f64; 2]) -> &[usize] {
        let [i, j] = self.position(point);
        &self.cells[i * self.counts[1] + j]
    }

    /// The cells of all squares at a distance of 0, 1, … squares from that of a point.
    pub fn rings(&self, point: [f64; 2]) -> impl Iterator<Item = Vec<usize>> {
        let square = self.position(point);
        (0..self.counts[0].max(self.counts[1])).map(move |reach| self.ring(square, reach))
    }

    fn ring(&self, [i, j]: [usize; 2], reach: usize) -> Vec<usize> {
        let range = |middle: usize, count: usize| {
            middle.saturating_sub(reach)..=(middle + reach).min(count - 1)
        };
        let mut cells = Vec::new();
        for a in range(i, self.counts[0]) {
            for b in range(j, self.counts[1]) {
                if a.abs_diff(i).max(b.abs_diff(j)) == reach {
                    cells.extend(&self.cells[a * self.counts[1] + b]);
                }
            }
        }
        cells.sort_unstable();
        cells.dedup();
        cells
    }
}
