//! Which conditions depend on each other.
//!
//! Rows depend on each other when a combination yᵀ B of them vanishes. With rows of unit length the
//! combinations y are found by inverse iteration on B Bᵀ + ε I; the rows with large entries take part.

use super::factor::row_scales;
use crate::solve::vector::{largest, norm};
use crate::solve::{Cholesky, FactorFault, SparseRows};

/// Rows whose combination vanishes.
#[derive(Clone, Debug, PartialEq)]
pub struct Dependence {
    /// The rows that take part, the strongest first.
    pub rows: Vec<usize>,
    /// Whether the combination of their right-hand sides does not vanish: no field satisfies all of them.
    pub contradictory: bool,
}

/// ε; a combination counts as vanishing when ‖yᵀ B‖ ≤ [`VANISHING`] ‖y‖.
const SHIFT: f64 = 1e-9;
const VANISHING: f64 = 1e-7;
/// Entries below this share of the largest do not take part.
const SMALLEST_ENTRY: f64 = 0.05;

/// Looks for dependent rows of `jacobian` with the values c = `values` at a field whose entries are of the
/// size `field_size`.
pub fn find(jacobian: &SparseRows, values: &[f64], field_size: f64) -> Option<Dependence> {
    let is_empty = |row: &usize| jacobian.row(*row).iter().all(|(_, value)| *value == 0.0);
    if let Some(empty) = (0..jacobian.len()).find(is_empty) {
        return Some(Dependence {
            rows: vec![empty],
            contradictory: values[empty] != 0.0,
        });
    }
    let scales = row_scales(jacobian, &vec![1.0; jacobian.columns()]);
    let scaled = jacobian.scaled(&scales);
    let combination = vanishing_combination(&scaled).ok()?;
    if norm(&scaled.multiply_transposed(&combination)) > VANISHING * norm(&combination) {
        return None;
    }
    let most = largest(&combination);
    let mut rows: Vec<usize> = (0..combination.len())
        .filter(|row| combination[*row].abs() > SMALLEST_ENTRY * most)
        .collect();
    rows.sort_by(|a, b| combination[*b].abs().total_cmp(&combination[*a].abs()));
    let sum: f64 = rows
        .iter()
        .map(|row| combination[*row] * values[*row] * scales[*row])
        .sum();
    Some(Dependence {
        rows,
        contradictory: sum.abs() > 1e-9 * field_size,
    })
}

fn vanishing_combination(scaled: &SparseRows) -> Result<Vec<f64>, FactorFault> {
    let (pattern, mut values) = scaled.normal_matrix(&vec![1.0; scaled.columns()]);
    for position in pattern.diagonal() {
        values[*position] += SHIFT;
    }
    let mut cholesky = Cholesky::analyse(pattern)?;
    cholesky.factorise(&values)?;
    // Any start that is not orthogonal to what is looked for.
    let mut y: Vec<f64> = (0..scaled.len())
        .map(|row| 1.0 + (1.7 * row as f64).sin())
        .collect();
    for _ in 0..4 {
        y = cholesky.solve(&y)?;
        let size = norm(&y);
        y.iter_mut().for_each(|y| *y /= size);
    }
    Ok(y)
}
