//! One linear projection: the nearest field that satisfies linearised conditions.
//!
//! ```text
//! minimise ½ (u + δ − ū)ᵀ W (u + δ − ū)   subject to   c + B δ = 0
//! ⇔  [W Bᵀ; B 0] [δ; ψ] = [W (ū − u); −c]
//! ⇔  ψ = S (B (ū − u) + c),   S = (B W⁻¹ Bᵀ)⁻¹,   δ = (ū − u) − W⁻¹ Bᵀ ψ
//! ```
//!
//! With n unknowns and m rows: B is m × n, W diagonal and positive, ψ has m entries.
//!
//! Where every unknown is either prescribed (set p) or has its own balance of forces (set f), B is square
//! and its part B_ff is a symmetric stiffness. The same δ and ψ then follow from one factorisation of
//! that stiffness, whose condition number is the square root of that of S:
//!
//! ```text
//! δ_p = −c_p,   B_ff δ_f = −c_f − B_fp δ_p
//! B_ff ψ_f = W (ū − u − δ)_f,   ψ_p = W (ū − u − δ)_p − B_pf ψ_f
//! ```

use crate::solve::{Cholesky, NotPositiveDefinite, SparseRows, SymmetricPattern};

/// Step and multipliers of one projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// δ.
    pub step: Vec<f64>,
    /// ψ, one number a row of B.
    pub multipliers: Vec<f64>,
}

/// Projects through S: any number of independent rows.
///
/// Rows are scaled to unit length first, and the projection is repeated on its own defect, because S has
/// the squared condition number of B.
///
/// # Errors
/// [`NotPositiveDefinite`] when rows depend on each other.
pub fn general(
    jacobian: &SparseRows,
    values: &[f64],
    data_minus_field: &[f64],
    weights: &[f64],
) -> Result<Projection, NotPositiveDefinite> {
    let scales: Vec<f64> = row_scales(jacobian, weights);
    let scaled = jacobian.scaled(&scales);
    let (pattern, normal) = scaled.normal_matrix(weights);
    let mut cholesky = Cholesky::analyse(pattern)?;
    cholesky.factorise(&normal)?;
    let mut step = data_minus_field.to_vec();
    let mut multipliers = vec![0.0; values.len()];
    for _ in 0..2 {
        let mut defect = scaled.multiply(&step);
        for ((defect, value), scale) in defect.iter_mut().zip(values).zip(&scales) {
            *defect += value * scale;
        }
        let psi = cholesky.solve(&defect)?;
        let pull = scaled.multiply_transposed(&psi);
        for ((step, pull), weight) in step.iter_mut().zip(&pull).zip(weights) {
            *step -= pull / weight;
        }
        for ((sum, psi), scale) in multipliers.iter_mut().zip(&psi).zip(&scales) {
            *sum += psi * scale;
        }
    }
    Ok(Projection { step, multipliers })
}

/// 1/√(B W⁻¹ Bᵀ)ᵢᵢ of each row.
pub fn row_scales(jacobian: &SparseRows, weights: &[f64]) -> Vec<f64> {
    let square = |row: usize| -> f64 {
        let entries = jacobian.row(row).iter();
        entries
            .map(|(column, value)| value * value / weights[*column])
            .sum()
    };
    (0..jacobian.len())
        .map(|row| 1.0 / square(row).sqrt())
        .collect()
}

/// Projects through the symmetric stiffness: for conditions that name every unknown once.
///
/// `unknowns` gives the unknown of each row of `jacobian`.
///
/// # Errors
/// [`NotPositiveDefinite`] when the stiffness of the unknowns that are not prescribed is not.
pub fn symmetric(
    jacobian: &SparseRows,
    values: &[f64],
    data_minus_field: &[f64],
    weights: &[f64],
    unknowns: &[usize],
) -> Result<Projection, NotPositiveDefinite> {
    let mut free_index = vec![None; unknowns.len()];
    let is_free = |row: &usize| jacobian.row(*row) != [(unknowns[*row], 1.0)];
    let free: Vec<usize> = (0..unknowns.len()).filter(is_free).collect();
    for (index, row) in free.iter().enumerate() {
        free_index[unknowns[*row]] = Some(index);
    }
    let mut step = vec![0.0; unknowns.len()];
    for row in (0..unknowns.len()).filter(|row| !is_free(row)) {
        step[unknowns[row]] = -values[row];
    }
    let mut cholesky = factorise_free(jacobian, &free, &free_index)?;
    let moved = jacobian.multiply(&step);
    let load: Vec<f64> = free.iter().map(|row| -values[*row] - moved[*row]).collect();
    for (row, value) in free.iter().zip(cholesky.solve(&load)?) {
        step[unknowns[*row]] = value;
    }

    let pull: Vec<f64> = (0..step.len())
        .map(|i| weights[i] * (data_minus_field[i] - step[i]))
        .collect();
    let free_pull: Vec<f64> = free.iter().map(|row| pull[unknowns[*row]]).collect();
    let mut multipliers = vec![0.0; unknowns.len()];
    for (row, value) in free.iter().zip(cholesky.solve(&free_pull)?) {
        multipliers[*row] = value;
    }
    let balanced = jacobian.multiply_transposed(&multipliers);
    for row in (0..unknowns.len()).filter(|row| !is_free(row)) {
        multipliers[row] = pull[unknowns[row]] - balanced[unknowns[row]];
    }
    Ok(Projection { step, multipliers })
}

/// The Cholesky factor of the rows and columns of the unknowns that are not prescribed.
fn factorise_free(
    jacobian: &SparseRows,
    free: &[usize],
    free_index: &[Option<usize>],
) -> Result<Cholesky, NotPositiveDefinite> {
    let column = |(index, row): (usize, &usize)| -> Vec<(usize, f64)> {
        let entries = jacobian.row(*row).iter();
        let mut lower: Vec<_> = entries
            .filter_map(|(unknown, value)| free_index[*unknown].map(|other| (other, *value)))
            .filter(|(other, _)| *other >= index)
            .collect();
        lower.sort_unstable_by_key(|(other, _)| *other);
        if lower.first().is_none_or(|(other, _)| *other != index) {
            lower.insert(0, (index, 0.0));
        }
        lower
    };
    let columns: Vec<_> = free.iter().enumerate().map(column).collect();
    let rows = columns
        .iter()
        .map(|column| column.iter().map(|(row, _)| *row).collect());
    let mut cholesky = Cholesky::analyse(SymmetricPattern::new(rows))?;
    let values: Vec<f64> = columns.iter().flatten().map(|(_, value)| *value).collect();
    cholesky.factorise(&values)?;
    Ok(cholesky)
}
