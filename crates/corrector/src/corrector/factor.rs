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

use crate::solve::{FactorFault, SparseLu, SparseRows};

mod forms;

use forms::{Form, Symmetric, cholesky, kkt, project_cholesky, project_dense, project_kkt};
pub use forms::{Projection, row_scales};
pub(super) use forms::{project_curved, weighted_qr};

/// Which form of the projection is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// The form that suits the size and the kind of the system.
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

impl Factor {
    /// Factorises B with the diagonal of W.
    ///
    /// `unknowns` gives the unknown of each row where the rows name every unknown once.
    ///
    /// # Errors
    /// [`FactorFault`] when rows depend on each other, or a form was asked for that does not apply.
    pub fn new(
        jacobian: SparseRows,
        weights: Vec<f64>,
        unknowns: Option<Vec<usize>>,
        solver: Solver,
    ) -> Result<Self, FactorFault> {
        let form = match solver {
            Solver::Automatic => return Self::automatic(jacobian, weights, unknowns),
            Solver::Dense => {
                let (q, r) = weighted_qr(&jacobian, &weights)?;
                Form::Dense { q, r }
            }
            Solver::Cholesky => cholesky(&jacobian, &weights)?,
            Solver::Kkt => Form::Kkt(SparseLu::new(kkt(&jacobian, &weights, None))?),
            Solver::Symmetric => {
                let unknowns = unknowns.ok_or(FactorFault::NotPositiveDefinite)?;
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
    ) -> Result<Self, FactorFault> {
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
        // A factor that does not reproduce a solution is useless: the whole system is better conditioned.
        if let Ok(mut factor) = with(Solver::Cholesky, None)
            && factor.is_sound()
        {
            return Ok(factor);
        }
        with(Solver::Kkt, None)
    }

    /// The form that is used.
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

    /// δ and ψ for c = `values` and ū − u = `pull`.
    ///
    /// # Errors
    /// [`FactorFault`] when the system turns out to be singular to working precision.
    pub fn project(&mut self, values: &[f64], pull: &[f64]) -> Result<Projection, FactorFault> {
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
    /// [`FactorFault`] when the system is singular to working precision.
    pub fn covariance_column(&self, unknown: usize) -> Result<Vec<f64>, FactorFault> {
        let lu = SparseLu::new(kkt(&self.jacobian, &self.weights, None))?;
        let mut right = vec![0.0; self.weights.len() + self.jacobian.len()];
        right[unknown] = 1.0;
        let mut column = lu.solve(&right)?;
        column.truncate(self.weights.len());
        Ok(column)
    }
}
