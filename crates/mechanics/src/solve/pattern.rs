//! Where the entries of a symmetric sparse matrix are stored.

/// The positions of the entries of a symmetric matrix: lower triangle by columns, rows ascending.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SymmetricPattern {
    column_starts: Vec<usize>,
    rows: Vec<usize>,
}

impl SymmetricPattern {
    /// Pattern from the rows of each column; rows above the diagonal are ignored, the diagonal is
    /// always present.
    pub fn new(columns: impl Iterator<Item = Vec<usize>>) -> Self {
        let (mut column_starts, mut rows) = (vec![0], Vec::new());
        for (column, mut entries) in columns.enumerate() {
            entries.retain(|row| *row >= column);
            entries.push(column);
            entries.sort_unstable();
            entries.dedup();
            rows.extend_from_slice(&entries);
            column_starts.push(rows.len());
        }
        Self {
            column_starts,
            rows,
        }
    }

    /// Pattern of columns that begin at some positions, each with its diagonal and rows below, ascending.
    pub(super) fn of_columns(column_starts: Vec<usize>, rows: Vec<usize>) -> Self {
        Self {
            column_starts,
            rows,
        }
    }

    /// Number of rows, which is the number of columns.
    pub fn size(&self) -> usize {
        self.column_starts.len() - 1
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// Where each column begins, and the rows of all columns.
    pub(super) fn columns(&self) -> [&[usize]; 2] {
        [&self.column_starts, &self.rows]
    }

    /// The rows of a column from the diagonal on.
    pub fn column(&self, column: usize) -> &[usize] {
        &self.rows[self.column_starts[column]..self.column_starts[column + 1]]
    }

    /// Where the entry (row, column) of either triangle is stored.
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        let (row, column) = (row.max(column), row.min(column));
        let start = self.column_starts[column];
        let column_rows = &self.rows[start..self.column_starts[column + 1]];
        column_rows
            .binary_search(&row)
            .ok()
            .map(|position| start + position)
    }

    /// Where the diagonal entries are stored.
    pub fn diagonal(&self) -> &[usize] {
        &self.column_starts[..self.size()]
    }

    /// The rows that have entries in some columns, ascending, these columns among them.
    pub fn around(&self, columns: &[usize]) -> Vec<usize> {
        let mut is_given = vec![false; self.size()];
        columns.iter().for_each(|column| is_given[*column] = true);
        let mut reached = is_given.clone();
        for column in 0..self.size() {
            for row in self.column(column) {
                reached[*row] |= is_given[column];
                reached[column] |= is_given[*row];
            }
        }
        (0..self.size()).filter(|row| reached[*row]).collect()
    }

    /// The mean size of the diagonal entries of the matrix with these `values`.
    pub fn mean_diagonal(&self, values: &[f64]) -> f64 {
        let sum: f64 = self
            .diagonal()
            .iter()
            .map(|position| values[*position].abs())
            .sum();
        sum / self.size().max(1) as f64
    }

    /// The stored entries with their values: (row, column, value), row ≥ column.
    fn triplets<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
        (0..self.size()).flat_map(move |column| {
            let positions = self.column_starts[column]..self.column_starts[column + 1];
            let entries = self.rows[positions.clone()].iter().zip(&values[positions]);
            entries.map(move |(row, value)| (*row, column, *value))
        })
    }

    /// y = A x for the matrix with these `values`.
    pub fn multiply(&self, values: &[f64], x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (row, column, value) in self.triplets(values) {
            y[row] += value * x[column];
            if row != column {
                y[column] += value * x[row];
            }
        }
        y
    }

    /// Both triangles by rows: for each row its (column, value), columns ascending.
    pub fn full_rows(&self, values: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let mut rows = vec![Vec::new(); self.size()];
        for (row, column, value) in self.triplets(values) {
            rows[row].push((column, value));
        }
        let above = self
            .triplets(values)
            .filter(|(row, column, _)| row != column);
        for (row, column, value) in above {
            rows[column].push((row, value));
        }
        rows
    }
}
