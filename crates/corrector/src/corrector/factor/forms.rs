//! The four forms of the projection.

use nalgebra::{DMatrix, DVector};

use crate::solve::{Cholesky, FactorFault, SparseLu, SparseRows};

/// Step and multipliers of one projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// δ.
    pub step: Vec<f64>,
    /// ψ, one number per row of B.
    pub multipliers: Vec<f64>,
}

/// A factorised system in one of the forms.
pub(in crate::corrector) enum Form {
    Dense {
        q: DMatrix<f64>,
        r: DMatrix<f64>,
    },
    Cholesky {
        scaled: SparseRows,
        scales: Vec<f64>,
        cholesky: Cholesky,
    },
    Kkt(SparseLu),
    Symmetric(Symmetric),
}

/// δ and ψ of the system with the curvature C of the conditions: [W + C, Bᵀ; B, 0] [δ; ψ] = [W (ū − u); −c].
pub(in crate::corrector) fn project_curved(
    jacobian: &SparseRows,
    weights: &[f64],
    curvature: &SparseRows,
    values: &[f64],
    pull: &[f64],
) -> Result<Projection, FactorFault> {
    let lu = SparseLu::new(kkt(jacobian, weights, Some(curvature)))?;
    project_kkt(&lu, weights, values, pull)
}

pub(super) fn project_kkt(
    lu: &SparseLu,
    weights: &[f64],
    values: &[f64],
    pull: &[f64],
) -> Result<Projection, FactorFault> {
    let weighted = pull.iter().zip(weights).map(|(pull, weight)| pull * weight);
    let right: Vec<f64> = weighted.chain(values.iter().map(|c| -c)).collect();
    let mut step = lu.solve(&right)?;
    let multipliers = step.split_off(pull.len());
    Ok(Projection { step, multipliers })
}

/// [W + C, Bᵀ; B, 0].
pub(super) fn kkt(
    jacobian: &SparseRows,
    weights: &[f64],
    curvature: Option<&SparseRows>,
) -> SparseRows {
    let (n, m) = (weights.len(), jacobian.len());
    let mut by_column = vec![Vec::new(); n];
    for row in 0..m {
        for (column, value) in jacobian.row(row) {
            by_column[*column].push((n + row, *value));
        }
    }
    let mut system = SparseRows::new(n + m);
    for (unknown, column) in by_column.into_iter().enumerate() {
        let curved = curvature.map_or(&[][..], |curvature| curvature.row(unknown));
        let diagonal = std::iter::once((unknown, weights[unknown]));
        system.push(diagonal.chain(curved.iter().copied()).chain(column));
    }
    for row in 0..m {
        system.push(jacobian.row(row).iter().copied());
    }
    system
}

/// Q (n × m, orthonormal columns) and R (m × m) of W^(−½) Bᵀ = Q R.
pub(in crate::corrector) fn weighted_qr(
    jacobian: &SparseRows,
    weights: &[f64],
) -> Result<(DMatrix<f64>, DMatrix<f64>), FactorFault> {
    let (n, m) = (weights.len(), jacobian.len());
    let mut transposed = jacobian.to_dense().transpose();
    for (mut row, weight) in transposed.row_iter_mut().zip(weights) {
        row /= weight.sqrt();
    }
    if m > n || transposed.iter().any(|value: &f64| !value.is_finite()) {
        return Err(FactorFault::NotPositiveDefinite);
    }
    let columns = transposed.column_iter();
    let norms: Vec<f64> = columns.map(|column| column.norm()).collect();
    let (q, r) = transposed.qr().unpack();
    let mut rows = norms.iter().enumerate();
    let independent = rows.all(|(row, norm)| r[(row, row)].abs() > 1e-10 * norm);
    independent
        .then_some((q, r))
        .ok_or(FactorFault::NotPositiveDefinite)
}

/// With W^(−½) Bᵀ = Q R and δ = W^(−½) δ̂: δ̂ = p − Q (Qᵀ p + R⁻ᵀ c), p = W^½ (ū − u).
pub(super) fn project_dense(
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
    weights: &[f64],
    values: &[f64],
    pull: &[f64],
) -> Projection {
    let roots = DVector::from_iterator(weights.len(), weights.iter().map(|weight| weight.sqrt()));
    let pull = DVector::from_column_slice(pull).component_mul(&roots);
    let values = DVector::from_column_slice(values);
    let moved = r
        .tr_solve_upper_triangular(&values)
        .unwrap_or_else(|| values.map(|_| f64::NAN));
    let share = q.tr_mul(&pull) + moved;
    let multipliers = r
        .solve_upper_triangular(&share)
        .unwrap_or_else(|| values.map(|_| f64::NAN));
    let step = (pull - q * share).component_div(&roots);
    Projection {
        step: step.as_slice().to_vec(),
        multipliers: multipliers.as_slice().to_vec(),
    }
}

/// The factor of B W⁻¹ Bᵀ, for rows of B of unit length.
pub(super) fn cholesky(jacobian: &SparseRows, weights: &[f64]) -> Result<Form, FactorFault> {
    let scales = row_scales(jacobian, weights);
    let scaled = jacobian.scaled(&scales);
    let (pattern, values) = scaled.normal_matrix(weights);
    let mut cholesky = Cholesky::analyse(pattern)?;
    cholesky.factorise(&values)?;
    Ok(Form::Cholesky {
        scaled,
        scales,
        cholesky,
    })
}

/// The projection is repeated on its own defect, because S has the squared condition number of B.
pub(super) fn project_cholesky(
    scaled: &SparseRows,
    scales: &[f64],
    cholesky: &mut Cholesky,
    weights: &[f64],
    values: &[f64],
    pull: &[f64],
) -> Result<Projection, FactorFault> {
    let mut step = pull.to_vec();
    let mut multipliers = vec![0.0; values.len()];
    for _ in 0..2 {
        let mut defect = scaled.multiply(&step);
        for ((defect, value), scale) in defect.iter_mut().zip(values).zip(scales) {
            *defect += value * scale;
        }
        let psi = cholesky.solve(&defect)?;
        let back = scaled.multiply_transposed(&psi);
        for ((step, back), weight) in step.iter_mut().zip(&back).zip(weights) {
            *step -= back / weight;
        }
        for ((sum, psi), scale) in multipliers.iter_mut().zip(&psi).zip(scales) {
            *sum += psi * scale;
        }
    }
    Ok(Projection { step, multipliers })
}

/// The stiffness form.
pub(super) struct Symmetric {
    /// The unknown of each row.
    unknowns: Vec<usize>,
    /// Rows that are balances of forces, and the others.
    free: Vec<usize>,
    prescribed: Vec<usize>,
    cholesky: Cholesky,
}

impl Symmetric {
    pub(super) fn new(jacobian: &SparseRows, unknowns: Vec<usize>) -> Result<Self, FactorFault> {
        let is_free = |row: &usize| jacobian.row(*row) != [(unknowns[*row], 1.0)];
        let (free, prescribed): (Vec<usize>, Vec<usize>) = (0..unknowns.len()).partition(is_free);
        let mut free_index = vec![None; unknowns.len()];
        for (index, row) in free.iter().enumerate() {
            free_index[unknowns[*row]] = Some(index);
        }
        let column = |(index, row): (usize, &usize)| -> Vec<(usize, f64)> {
            let entries = jacobian.row(*row).iter();
            let lower = entries
                .filter_map(|(unknown, value)| free_index[*unknown].map(|other| (other, *value)))
                .filter(|(other, _)| *other >= index);
            let mut lower: Vec<_> = lower.chain([(index, 0.0)]).collect();
            lower.sort_by_key(|(other, _)| *other);
            lower.dedup_by(|next, kept| {
                let same = next.0 == kept.0;
                if same {
                    kept.1 += next.1;
                }
                same
            });
            lower
        };
        let columns: Vec<_> = free.iter().enumerate().map(column).collect();
        Ok(Self {
            unknowns,
            free,
            prescribed,
            cholesky: Cholesky::of_columns(&columns)?,
        })
    }

    pub(super) fn project(
        &mut self,
        jacobian: &SparseRows,
        weights: &[f64],
        values: &[f64],
        pull: &[f64],
    ) -> Result<Projection, FactorFault> {
        let unknowns = &self.unknowns;
        let mut step = vec![0.0; unknowns.len()];
        for row in &self.prescribed {
            step[unknowns[*row]] = -values[*row];
        }
        let moved = jacobian.multiply(&step);
        let load: Vec<f64> = self
            .free
            .iter()
            .map(|row| -values[*row] - moved[*row])
            .collect();
        for (row, value) in self.free.iter().zip(self.cholesky.solve(&load)?) {
            step[unknowns[*row]] = value;
        }

        let unbalanced = |unknown: usize| weights[unknown] * (pull[unknown] - step[unknown]);
        let free_unbalanced: Vec<f64> = self
            .free
            .iter()
            .map(|row| unbalanced(unknowns[*row]))
            .collect();
        let mut multipliers = vec![0.0; unknowns.len()];
        for (row, value) in self.free.iter().zip(self.cholesky.solve(&free_unbalanced)?) {
            multipliers[*row] = value;
        }
        let balanced = jacobian.multiply_transposed(&multipliers);
        for row in &self.prescribed {
            multipliers[*row] = unbalanced(unknowns[*row]) - balanced[unknowns[*row]];
        }
        Ok(Projection { step, multipliers })
    }
}

/// 1/√(B W⁻¹ Bᵀ)ᵢᵢ of each row; unknowns without data do not count, unless there are no others.
pub fn row_scales(jacobian: &SparseRows, weights: &[f64]) -> Vec<f64> {
    let scale = |row: usize| {
        let entries = || jacobian.row(row).iter();
        let with_data = entries().filter(|(column, _)| weights[*column] > 0.0);
        let square: f64 = with_data
            .map(|(column, value)| value * value / weights[*column])
            .sum();
        let plain: f64 = entries().map(|(_, value)| value * value).sum();
        let square = if square > 0.0 { square } else { plain };
        if square > 0.0 {
            1.0 / square.sqrt()
        } else {
            1.0
        }
    };
    (0..jacobian.len()).map(scale).collect()
}
