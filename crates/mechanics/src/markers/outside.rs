//! Points without a displacement that lie outside of the specimen: exports as whole matrices have an entry for every
//! point of the picture, without a value where there is no specimen.

/// Gaps at the rim of a matrix up to this share of it count as lost markers.
const LOST: f64 = 0.1;

/// Share of the points of a matrix that must be present.
const FULL: f64 = 0.99;

/// The lost points within the specimen, as far as the points show it. Of a complete matrix, rows and columns at the rim that have no marker at all
/// are outside, and gaps at the rim if they are more than a tenth of the rest. Points that are not a matrix all count.
pub fn within(tracked: &[[f64; 2]], lost: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    match Matrix::of(tracked, &lost) {
        Some(matrix) => {
            let outside = matrix.outside();
            let kept = lost.into_iter().filter(|position| {
                let [x, y] = matrix.index(*position);
                !outside[y][x]
            });
            kept.collect()
        }
        None => lost,
    }
}

/// Points in rows and columns.
struct Matrix {
    lines: [Vec<f64>; 2],
    /// Whether a marker was found, by row and column.
    tracked: Vec<Vec<bool>>,
}

impl Matrix {
    /// The matrix of all points; `None` where they are not a matrix, or nothing is lost.
    fn of(tracked: &[[f64; 2]], lost: &[[f64; 2]]) -> Option<Self> {
        if lost.is_empty() || tracked.is_empty() {
            return None;
        }
        let all = || tracked.iter().chain(lost);
        let lines = [0, 1].map(|axis| lines(all().map(|position| position[axis]).collect()));
        let [columns, rows] = lines.each_ref().map(Vec::len);
        let count = (tracked.len() + lost.len()) as f64;
        let full = (rows * columns) as f64;
        if columns.min(rows) < 3 || count < FULL * full || count > full / FULL {
            return None;
        }
        let mut matrix = Self {
            lines,
            tracked: vec![vec![false; columns]; rows],
        };
        for position in tracked {
            let [x, y] = matrix.index(*position);
            matrix.tracked[y][x] = true;
        }
        Some(matrix)
    }

    /// The column and the row of a point.
    fn index(&self, position: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let lines = &self.lines[axis];
            let next = lines.partition_point(|line| *line < position[axis]);
            let nearer = |at: usize| (lines[at] - position[axis]).abs();
            match next {
                0 => 0,
                end if end == lines.len() || nearer(end - 1) < nearer(end) => end - 1,
                upper => upper,
            }
        })
    }

    /// The points outside, by row and column.
    fn outside(&self) -> Vec<Vec<bool>> {
        let [columns, rows] = self.lines.each_ref().map(Vec::len);
        let row = |y: &usize| self.tracked[*y].iter().any(|tracked| *tracked);
        let column = |x: &usize| self.tracked.iter().any(|row| row[*x]);
        let span = |some: &dyn Fn(&usize) -> bool, count: usize| {
            let first = (0..count).find(some).unwrap_or(0);
            first..(0..count).rfind(some).map_or(count, |last| last + 1)
        };
        let (inner_rows, inner_columns) = (span(&row, rows), span(&column, columns));
        let is_inner = |x: usize, y: usize| inner_columns.contains(&x) && inner_rows.contains(&y);
        let rim = self.connected_to_rim(&inner_columns, &inner_rows);
        let gaps = rim.iter().flatten().filter(|gap| **gap).count() as f64;
        let large = gaps > LOST * (inner_columns.len() * inner_rows.len()) as f64;
        let outside = |y: usize| {
            (0..columns)
                .map(|x| !is_inner(x, y) || (large && rim[y][x]))
                .collect()
        };
        (0..rows).map(outside).collect()
    }

    /// The gaps at the rim, within some rows and columns: points without a marker whose neighbours have none either, if they are connected to the
    /// rim by such points, and the neighbours. Smaller gaps are lost markers.
    fn connected_to_rim(
        &self,
        columns: &std::ops::Range<usize>,
        rows: &std::ops::Range<usize>,
    ) -> Vec<Vec<bool>> {
        let around = |x: usize, y: usize| {
            let near = |at: usize, range: &std::ops::Range<usize>| {
                at.saturating_sub(1).max(range.start)..(at + 2).min(range.end)
            };
            let columns = near(x, columns);
            near(y, rows).flat_map(move |y| columns.clone().map(move |x| (x, y)))
        };
        let is_empty = |x: usize, y: usize| around(x, y).all(|(x, y)| !self.tracked[y][x]);
        let mut empty = vec![vec![false; self.lines[0].len()]; self.lines[1].len()];
        let at_rim = |x: usize, y: usize| {
            [columns.start, columns.end - 1].contains(&x) || [rows.start, rows.end - 1].contains(&y)
        };
        let all = rows
            .clone()
            .flat_map(|y| columns.clone().map(move |x| (x, y)));
        let mut open: Vec<(usize, usize)> = all.filter(|(x, y)| at_rim(*x, *y)).collect();
        let mut reached = empty.clone();
        while let Some((x, y)) = open.pop() {
            if empty[y][x] || !is_empty(x, y) {
                continue;
            }
            empty[y][x] = true;
            around(x, y).for_each(|(x, y)| reached[y][x] = true);
            open.extend(around(x, y));
        }
        reached
    }
}

/// The distinct values among some, which differ by more than rounding.
fn lines(mut values: Vec<f64>) -> Vec<f64> {
    const ROUNDING: f64 = 1e-6;
    values.sort_by(f64::total_cmp);
    let range = values
        .last()
        .zip(values.first())
        .map_or(0.0, |(last, first)| last - first);
    values.dedup_by(|next, previous| *next - *previous <= ROUNDING * range);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The points of a matrix of 12 × 8 that a specimen has, and the others.
    fn matrix(is_tracked: impl Fn(usize, usize) -> bool) -> [Vec<[f64; 2]>; 2] {
        let all: Vec<(usize, usize)> = (0..8).flat_map(|y| (0..12).map(move |x| (x, y))).collect();
        let position = |(x, y): &(usize, usize)| [0.3 * *x as f64, 0.3 * *y as f64];
        [true, false].map(|wanted| {
            let some = all.iter().filter(|(x, y)| is_tracked(*x, *y) == wanted);
            some.map(position).collect()
        })
    }

    #[test]
    fn rows_and_columns_without_a_marker_and_large_gaps_at_the_rim_are_outside() {
        let padded = |x: usize, y: usize| (2..11).contains(&x) && (1..7).contains(&y);
        let [tracked, lost] = matrix(padded);
        assert_eq!(within(&tracked, lost), Vec::<[f64; 2]>::new());
        // What is lost within stays, as do a few at the rim of the specimen.
        let blind = |x: usize, y: usize| padded(x, y) && (x, y) != (5, 3) && (x, y) != (5, 1);
        let [tracked, lost] = matrix(blind);
        let kept = within(&tracked, lost);
        assert_eq!(kept.len(), 2, "{kept:?}");
        // A waist.
        let waist = |x: usize, y: usize| !(3..=8).contains(&x) || (2..6).contains(&y);
        let [tracked, lost] = matrix(waist);
        assert!(within(&tracked, lost).is_empty());
    }

    #[test]
    fn markers_that_are_lost_here_and_there_count() {
        let scattered = |x: usize, y: usize| (7 * x + 5 * y).is_multiple_of(3);
        let [tracked, lost] = matrix(scattered);
        assert_eq!(within(&tracked, lost.clone()), lost);
    }

    #[test]
    fn points_that_are_no_matrix_stay() {
        let [tracked, mut lost] = matrix(|_, y| y > 1);
        lost.truncate(5);
        assert_eq!(within(&tracked, lost.clone()), lost);
    }
}
