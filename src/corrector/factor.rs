//! The factorisation behind a linear projection: the nearest field that satisfies linearised conditions.
//!
//! ```text
//! minimise ½ (u + δ − ū)ᵀ W (u + δ − ū)   subject to   c + B δ = 0
//! ⇔  [W Bᵀ; B 0] [δ; ψ] = [W (ū − u); −c]
//! ⇔  ψ = S (B (ū − u) + c),   S = (B W⁻¹ Bᵀ)⁻¹,   δ = (ū − u) − W⁻¹ Bᵀ ψ
//! ```
//!
//! With n unknowns and m rows: B is m × n, W diagonal, ψ has m entries. Four forms give the same result:
//!
//! | form | factorises | for |
//! |---|---|---|
//! | [`Solver::Dense`] | W^(−½) Bᵀ = Q R | small systems |
//! | [`Solver::Cholesky`] | B W⁻¹ Bᵀ, sparse | many rows, fewer than unknowns |
//! | [`Solver::Kkt`] | [W Bᵀ; B 0], sparse LU | B W⁻¹ Bᵀ badly conditioned, or unknowns without data (W = 0) |
//! | [`Solver::Symmetric`] | the part B_ff of a square B, sparse | equilibrium at every unknown that is not prescribed |
//!
//! **Symmetric form.** Where every unknown is either prescribed (set p) or has its own balance of forces
//! (set f), B_ff is a stiffness, and
//!
//! ```text
//! δ_p = −c_p,   B_ff δ_f = −c_f − B_fp δ_p
//! B_ff ψ_f = W (ū − u − δ)_f,   ψ_p = W (ū − u − δ)_p − B_pf ψ_f
//! ```
//!
//! **Unknowns without data** have weight zero: parameters of the conditions that are found with the field.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::solve::{Cholesky, NotPositiveDefinite, SparseLu, SparseRows, SymmetricPattern};

/// Step and multipliers of one projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// δ.
    pub step: Vec<f64>,
    /// ψ, one number a row of B.
    pub multipliers: Vec<f64>,
}

/// Which form of the projection is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Solver {
    /// By size and kind.
    Automatic,
    /// Dense QR factorisation of W^(−½) Bᵀ.
    Dense,
    /// Sparse Cholesky factorisation of B W⁻¹ Bᵀ.
    Cholesky,
    /// Sparse LU factorisation of the whole system.
    Kkt,
    /// Sparse Cholesky factorisation of the stiffness in a square B.
    Symmetric,
}

/// Up to this many unknowns, [`Solver::Automatic`] takes the dense form.
const LARGEST_DENSE: usize = 200;

/// A linearised system, factorised: it projects any data with any right-hand side.
pub struct Factor {
    jacobian: SparseRows,
    weights: Vec<f64>,
    form: Form,
}

impl std::fmt::Debug for Factor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (rows, unknowns) = (self.jacobian.len(), self.weights.len());
        write!(
            f,
            "{:?} factor of {rows} rows over {unknowns} unknowns",
            self.solver()
        )
    }
}

enum Form {
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

struct Symmetric {
    /// The unknown of each row.
    unknowns: Vec<usize>,
    /// Rows that are balances of forces, and the others.
    free: Vec<usize>,
    prescribed: Vec<usize>,
    cholesky: Cholesky,
}

impl Factor {
    /// Factorises B with the diagonal of W.
    ///
    /// `unknowns` gives the unknown of each row where the rows name every unknown once.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] when rows depend on each other, or a form was asked for that does not apply.
    pub fn new(
        jacobian: SparseRows,
        weights: Vec<f64>,
        unknowns: Option<Vec<usize>>,
        solver: Solver,
    ) -> Result<Self, NotPositiveDefinite> {
        let form = match solver {
            Solver::Automatic => return Self::automatic(jacobian, weights, unknowns),
            Solver::Dense => dense(&jacobian, &weights)?,
            Solver::Cholesky => cholesky(&jacobian, &weights)?,
            Solver::Kkt => Form::Kkt(SparseLu::new(kkt(&jacobian, &weights, None))?),
            Solver::Symmetric => {
                let unknowns = unknowns.ok_or(NotPositiveDefinite)?;
                Form::Symmetric(Symmetric::new(&jacobian, unknowns)?)
            }
        };
        Ok(Self {
            jacobian,
            weights,
            form,
        })
    }

    fn automatic(
        jacobian: SparseRows,
        weights: Vec<f64>,
        unknowns: Option<Vec<usize>>,
    ) -> Result<Self, NotPositiveDefinite> {
        let with =
            |solver, unknowns| Self::new(jacobian.clone(), weights.clone(), unknowns, solver);
        if weights.contains(&0.0) {
            return with(Solver::Kkt, None);
        }
        if unknowns.is_some()
            && let Ok(factor) = with(Solver::Symmetric, unknowns)
        {
            return Ok(factor);
        }
        if weights.len() <= LARGEST_DENSE {
            return with(Solver::Dense, None);
        }
        // A factor that does not reproduce a solution is worth nothing: the whole system is better conditioned.
        if let Ok(mut factor) = with(Solver::Cholesky, None)
            && factor.is_sound()
        {
            return Ok(factor);
        }
        with(Solver::Kkt, None)
    }

    /// Which form was taken.
    pub fn solver(&self) -> Solver {
        match self.form {
            Form::Dense { .. } => Solver::Dense,
            Form::Cholesky { .. } => Solver::Cholesky,
            Form::Kkt(_) => Solver::Kkt,
            Form::Symmetric(_) => Solver::Symmetric,
        }
    }

    /// B.
    pub fn jacobian(&self) -> &SparseRows {
        &self.jacobian
    }

    /// The diagonal of W.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// δ and ψ for c = `values` and ū − u = `pull`.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] when the system turns out to be singular to working precision.
    pub fn project(
        &mut self,
        values: &[f64],
        pull: &[f64],
    ) -> Result<Projection, NotPositiveDefinite> {
        let (b, w) = (&self.jacobian, &self.weights);
        match &mut self.form {
            Form::Dense { q, r } => Ok(project_dense(q, r, w, values, pull)),
            Form::Cholesky {
                scaled,
                scales,
                cholesky,
            } => project_cholesky(scaled, scales, cholesky, w, values, pull),
            Form::Kkt(lu) => project_kkt(lu, w, values, pull),
            Form::Symmetric(symmetric) => symmetric.project(b, w, values, pull),
        }
    }

    /// Whether a projection of some numbers meets its conditions to nine digits.
    fn is_sound(&mut self) -> bool {
        let values: Vec<f64> = (0..self.jacobian.len())
            .map(|i| 1.0 + (i as f64).sin())
            .collect();
        let pull = vec![0.0; self.weights.len()];
        let scales = row_scales(&self.jacobian, &self.weights);
        let Ok(projection) = self.project(&values, &pull) else {
            return false;
        };
        let moved = self.jacobian.multiply(&projection.step);
        let largest = |x: &dyn Fn(usize) -> f64| {
            (0..values.len()).fold(0.0, |most: f64, i| most.max((x(i) * scales[i]).abs()))
        };
        largest(&|i| moved[i] + values[i]) < 1e-9 * largest(&|i| values[i])
    }

    /// The covariance of the projected field for data with the covariance W⁻¹: one column,
    /// Z (Zᵀ W Z)⁻¹ Zᵀ e, where the columns of Z span what the conditions allow.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] when the system is singular to working precision.
    pub fn covariance_column(&self, unknown: usize) -> Result<Vec<f64>, NotPositiveDefinite> {
        let lu = SparseLu::new(kkt(&self.jacobian, &self.weights, None))?;
        let mut right = vec![0.0; self.weights.len() + self.jacobian.len()];
        right[unknown] = 1.0;
        let mut column = lu.solve(&right)?;
        column.truncate(self.weights.len());
        Ok(column)
    }

    /// What is needed to keep the factor: B, W, the unknowns of the rows, and the values of a Cholesky form.
    pub(super) fn parts(&self) -> FactorParts {
        let (unknowns, cholesky) = match &self.form {
            Form::Symmetric(symmetric) => {
                (Some(symmetric.unknowns.clone()), Some(&symmetric.cholesky))
            }
            Form::Cholesky { cholesky, .. } => (None, Some(cholesky)),
            _ => (None, None),
        };
        FactorParts {
            jacobian: self.jacobian.clone(),
            weights: self.weights.clone(),
            unknowns,
            solver: self.solver(),
            cholesky: cholesky.map(|cholesky| {
                let (values, factor) = cholesky.parts();
                (values.to_vec(), factor.to_vec())
            }),
        }
    }

    /// Puts a factor together again, without factorising where its values were kept.
    pub(super) fn from_parts(parts: FactorParts) -> Result<Self, NotPositiveDefinite> {
        let FactorParts {
            jacobian,
            weights,
            unknowns,
            solver,
            cholesky,
        } = parts;
        let form = match (solver, cholesky) {
            (Solver::Symmetric, Some((values, factor))) => {
                let mut symmetric =
                    Symmetric::analyse(&jacobian, unknowns.ok_or(NotPositiveDefinite)?)?.0;
                symmetric.cholesky.restore(values, factor)?;
                Form::Symmetric(symmetric)
            }
            (Solver::Cholesky, Some((values, factor))) => {
                let (scaled, scales, pattern, _) = normal(&jacobian, &weights);
                let mut cholesky = Cholesky::analyse(pattern)?;
                cholesky.restore(values, factor)?;
                Form::Cholesky {
                    scaled,
                    scales,
                    cholesky,
                }
            }
            _ => return Self::new(jacobian, weights, unknowns, solver),
        };
        Ok(Self {
            jacobian,
            weights,
            form,
        })
    }
}

/// A factor as it is kept in a file.
#[derive(Serialize, Deserialize)]
pub(super) struct FactorParts {
    pub jacobian: SparseRows,
    pub weights: Vec<f64>,
    pub unknowns: Option<Vec<usize>>,
    pub solver: Solver,
    pub cholesky: Option<(Vec<f64>, Vec<f64>)>,
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

/// δ and ψ of the system with the curvature C of the conditions: [W + C, Bᵀ; B, 0] [δ; ψ] = [W (ū − u); −c].
///
/// # Errors
/// [`NotPositiveDefinite`] when the system is singular to working precision.
pub(super) fn project_curved(
    jacobian: &SparseRows,
    weights: &[f64],
    curvature: &SparseRows,
    values: &[f64],
    pull: &[f64],
) -> Result<Projection, NotPositiveDefinite> {
    let lu = SparseLu::new(kkt(jacobian, weights, Some(curvature)))?;
    project_kkt(&lu, weights, values, pull)
}

fn project_kkt(
    lu: &SparseLu,
    weights: &[f64],
    values: &[f64],
    pull: &[f64],
) -> Result<Projection, NotPositiveDefinite> {
    let weighted = pull.iter().zip(weights).map(|(pull, weight)| pull * weight);
    let right: Vec<f64> = weighted.chain(values.iter().map(|c| -c)).collect();
    let mut step = lu.solve(&right)?;
    let multipliers = step.split_off(pull.len());
    Ok(Projection { step, multipliers })
}

/// [W + C, Bᵀ; B, 0].
fn kkt(jacobian: &SparseRows, weights: &[f64], curvature: Option<&SparseRows>) -> SparseRows {
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
        let own = std::iter::once((unknown, weights[unknown]));
        system.push(own.chain(curved.iter().copied()).chain(column));
    }
    for row in 0..m {
        system.push(jacobian.row(row).iter().copied());
    }
    system
}

fn dense(jacobian: &SparseRows, weights: &[f64]) -> Result<Form, NotPositiveDefinite> {
    let (n, m) = (weights.len(), jacobian.len());
    let mut transposed = jacobian.to_dense().transpose();
    for (mut row, weight) in transposed.row_iter_mut().zip(weights) {
        row /= weight.sqrt();
    }
    if m > n || transposed.iter().any(|value: &f64| !value.is_finite()) {
        return Err(NotPositiveDefinite);
    }
    let norms: Vec<f64> = transposed
        .column_iter()
        .map(|column| column.norm())
        .collect();
    let (q, r) = transposed.qr().unpack();
    let independent = norms
        .iter()
        .enumerate()
        .all(|(row, norm)| r[(row, row)].abs() > 1e-10 * norm);
    if independent {
        Ok(Form::Dense { q, r })
    } else {
        Err(NotPositiveDefinite)
    }
}

/// With W^(−½) Bᵀ = Q R and δ = W^(−½) δ̂: δ̂ = p − Q (Qᵀ p + R⁻ᵀ c), p = W^½ (ū − u).
fn project_dense(
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

type Normal = (SparseRows, Vec<f64>, SymmetricPattern, Vec<f64>);

/// B with rows of unit length, their scales, and B W⁻¹ Bᵀ.
fn normal(jacobian: &SparseRows, weights: &[f64]) -> Normal {
    let scales = row_scales(jacobian, weights);
    let scaled = jacobian.scaled(&scales);
    let (pattern, values) = scaled.normal_matrix(weights);
    (scaled, scales, pattern, values)
}

fn cholesky(jacobian: &SparseRows, weights: &[f64]) -> Result<Form, NotPositiveDefinite> {
    let (scaled, scales, pattern, values) = normal(jacobian, weights);
    let mut cholesky = Cholesky::analyse(pattern)?;
    cholesky.factorise(&values)?;
    Ok(Form::Cholesky {
        scaled,
        scales,
        cholesky,
    })
}

/// The projection is repeated on its own defect, because S has the squared condition number of B.
fn project_cholesky(
    scaled: &SparseRows,
    scales: &[f64],
    cholesky: &mut Cholesky,
    weights: &[f64],
    values: &[f64],
    pull: &[f64],
) -> Result<Projection, NotPositiveDefinite> {
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

impl Symmetric {
    /// Prepares the form and gives the values of B_ff.
    fn analyse(
        jacobian: &SparseRows,
        unknowns: Vec<usize>,
    ) -> Result<(Self, Vec<f64>), NotPositiveDefinite> {
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
        let rows = columns
            .iter()
            .map(|column| column.iter().map(|(row, _)| *row).collect());
        let cholesky = Cholesky::analyse(SymmetricPattern::new(rows))?;
        let values = columns.iter().flatten().map(|(_, value)| *value).collect();
        Ok((
            Self {
                unknowns,
                free,
                prescribed,
                cholesky,
            },
            values,
        ))
    }

    fn new(jacobian: &SparseRows, unknowns: Vec<usize>) -> Result<Self, NotPositiveDefinite> {
        let (mut symmetric, values) = Self::analyse(jacobian, unknowns)?;
        symmetric.cholesky.factorise(&values)?;
        Ok(symmetric)
    }

    fn project(
        &mut self,
        jacobian: &SparseRows,
        weights: &[f64],
        values: &[f64],
        pull: &[f64],
    ) -> Result<Projection, NotPositiveDefinite> {
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

        let left = |unknown: usize| weights[unknown] * (pull[unknown] - step[unknown]);
        let free_left: Vec<f64> = self.free.iter().map(|row| left(unknowns[*row])).collect();
        let mut multipliers = vec![0.0; unknowns.len()];
        for (row, value) in self.free.iter().zip(self.cholesky.solve(&free_left)?) {
            multipliers[*row] = value;
        }
        let balanced = jacobian.multiply_transposed(&multipliers);
        for row in &self.prescribed {
            multipliers[*row] = left(unknowns[*row]) - balanced[unknowns[*row]];
        }
        Ok(Projection { step, multipliers })
    }
}
