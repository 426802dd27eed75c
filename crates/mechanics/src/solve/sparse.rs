//! Factorisation of sparse matrices. Only this file names faer.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::solvers::SolveCore;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::solvers::Lu;
use faer::sparse::linalg::{LuError, SupernodalThreshold};
use faer::sparse::{
    CreationError, SparseColMat, SparseColMatRef, SymbolicSparseColMatRef, Triplet,
};
use faer::{Conj, MatMut, Par, Side};

use super::pattern::SymmetricPattern;
use super::rows::SparseRows;
use super::vector::{add_scaled, difference, norm};
use crate::error::SolveFault;

/// Why a matrix has no factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FactorFault {
    /// It is not positive definite, singular, or not finite.
    #[error("the matrix is not positive definite, or not finite")]
    NotPositiveDefinite,
    /// The factor is larger than the memory.
    #[error("not enough memory for the factor")]
    OutOfMemory,
}

impl FactorFault {
    /// The fault of a solver: that of memory, otherwise `singular`.
    pub fn or(self, singular: SolveFault) -> SolveFault {
        match self {
            Self::NotPositiveDefinite => singular,
            Self::OutOfMemory => SolveFault::OutOfMemory,
        }
    }
}

impl From<FactorFault> for SolveFault {
    fn from(fault: FactorFault) -> Self {
        fault.or(Self::Singular)
    }
}

impl From<LuError> for FactorFault {
    fn from(fault: LuError) -> Self {
        match fault {
            LuError::SymbolicSingular { .. } => Self::NotPositiveDefinite,
            LuError::Generic(_) => Self::OutOfMemory,
        }
    }
}

/// A vector of so many zeros.
fn zeros(count: usize) -> Result<Vec<f64>, FactorFault> {
    let mut zeros = Vec::new();
    let reserved = zeros.try_reserve_exact(count);
    reserved.map_err(|_| FactorFault::OutOfMemory)?;
    zeros.resize(count, 0.0);
    Ok(zeros)
}

fn workspace(size: StackReq) -> Result<MemBuffer, FactorFault> {
    MemBuffer::try_new(size).map_err(|_| FactorFault::OutOfMemory)
}

/// A sparse Cholesky factor A = L Lᵀ. The symbolic analysis is done once for a pattern; every new set
/// of values is factorised into the same memory.
pub struct Cholesky {
    pattern: SymmetricPattern,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    values: Vec<f64>,
    workspace: MemBuffer,
}

impl Cholesky {
    /// Analyses a pattern, to be eliminated in an order of approximately minimum degree.
    ///
    /// # Errors
    /// [`FactorFault::OutOfMemory`] when the factor does not fit.
    pub fn analyse(pattern: SymmetricPattern) -> Result<Self, FactorFault> {
        Self::analyse_by(pattern, SymmetricOrdering::Amd)
    }

    /// The factor of a matrix by the columns of its lower triangle: rows and values, rows ascending from the diagonal on.
    ///
    /// # Errors
    /// [`FactorFault`] when a pivot is not positive, or the factor does not fit.
    pub fn of_columns(columns: &[Vec<(usize, f64)>]) -> Result<Self, FactorFault> {
        let rows = columns
            .iter()
            .map(|column| column.iter().map(|(row, _)| *row).collect());
        let mut cholesky = Self::analyse(SymmetricPattern::new(rows))?;
        let values: Vec<f64> = columns.iter().flatten().map(|(_, value)| *value).collect();
        cholesky.factorise(&values)?;
        Ok(cholesky)
    }

    /// Analyses a pattern, to be eliminated in a given order of all unknowns.
    ///
    /// # Errors
    /// [`FactorFault::OutOfMemory`] when the factor does not fit.
    ///
    /// # Panics
    /// When an unknown is missing in the order.
    pub fn analyse_in_order(
        pattern: SymmetricPattern,
        order: &[usize],
    ) -> Result<Self, FactorFault> {
        let mut position = vec![0; order.len()];
        for (rank, unknown) in order.iter().enumerate() {
            position[*unknown] = rank;
        }
        let permutation = PermRef::new_checked(order, &position, pattern.size());
        Self::analyse_by(pattern, SymmetricOrdering::Custom(permutation))
    }

    fn analyse_by(
        pattern: SymmetricPattern,
        ordering: SymmetricOrdering<'_, usize>,
    ) -> Result<Self, FactorFault> {
        let symbolic = factorize_symbolic_cholesky(
            structure(&pattern),
            Side::Lower,
            ordering,
            CholeskySymbolicParams {
                // From a thousand unknowns on two to four times as fast as column by column, and never slower.
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..CholeskySymbolicParams::default()
            },
        )
        .map_err(|_| FactorFault::OutOfMemory)?;
        let scratch =
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, faer::Spec::default());
        Ok(Self {
            factor: zeros(symbolic.len_val())?,
            workspace: workspace(scratch)?,
            values: Vec::new(),
            pattern,
            symbolic,
        })
    }

    /// The pattern that was analysed.
    pub fn pattern(&self) -> &SymmetricPattern {
        &self.pattern
    }

    /// The values of the matrix that was factorised last; none before.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Factorises the matrix with these `values`.
    ///
    /// # Errors
    /// [`FactorFault`] when a pivot is not positive.
    pub fn factorise(&mut self, values: &[f64]) -> Result<(), FactorFault> {
        if values.iter().any(|value| !value.is_finite()) {
            return Err(FactorFault::NotPositiveDefinite);
        }
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                SparseColMatRef::new(structure(&self.pattern), values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.workspace),
                faer::Spec::default(),
            )
            .map_err(|_| FactorFault::NotPositiveDefinite)?;
        self.values.clear();
        self.values.extend_from_slice(values);
        Ok(())
    }

    /// Solves A x = b, with a step of iterative refinement where the residual is more than rounding.
    ///
    /// # Errors
    /// [`FactorFault`] when the residual shows that A is singular to working precision.
    pub fn solve(&self, b: &[f64]) -> Result<Vec<f64>, FactorFault> {
        const ROUNDING: f64 = 1e-11;
        let mut x = b.to_vec();
        self.substitute(&mut x);
        let mut correction = self.defect(b, &x);
        if norm(&correction) <= ROUNDING * norm(b) {
            return Ok(x);
        }
        self.substitute(&mut correction);
        add_scaled(&mut x, 1.0, &correction);
        let defect = self.defect(b, &x);
        solved(x, b, &defect)
    }

    fn defect(&self, b: &[f64], x: &[f64]) -> Vec<f64> {
        difference(b, &self.pattern.multiply(&self.values, x))
    }

    /// x ← A⁻¹ x by substitution alone, without refinement and verification: for iterations that check their own residual.
    pub fn substitute(&self, x: &mut [f64]) {
        self.substitute_columns(x, 1);
    }

    /// X ← A⁻¹ X for columns one after the other, as [`Self::substitute`]: eight together take less than three times as
    /// long as one.
    pub fn substitute_columns(&self, x: &mut [f64], columns: usize) {
        let needed = self
            .symbolic
            .solve_in_place_scratch::<f64>(columns, Par::Seq);
        let mut workspace = MemBuffer::new(needed);
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, self.pattern.size(), columns),
            Par::Seq,
            MemStack::new(&mut workspace),
        );
    }
}

/// A sparse LU factor with row pivoting, for square matrices of any kind.
pub struct SparseLu {
    matrix: SparseRows,
    factor: Lu<usize, f64>,
}

impl SparseLu {
    /// Factorises a square matrix.
    ///
    /// # Errors
    /// [`FactorFault`] when the matrix is singular by its structure.
    pub fn new(matrix: SparseRows) -> Result<Self, FactorFault> {
        let size = matrix.columns();
        let rows = (0..matrix.len()).flat_map(|row| {
            let entries = matrix.row(row).iter();
            entries.map(move |(column, value)| Triplet::new(row, *column, *value))
        });
        let entries: Vec<_> = rows.collect();
        if matrix.len() != size || entries.iter().any(|entry| !entry.val.is_finite()) {
            return Err(FactorFault::NotPositiveDefinite);
        }
        // More threads than free cores are very slow, and one thread gives the same bits every time.
        faer::set_global_parallelism(Par::Seq);
        let sparse = SparseColMat::<usize, f64>::try_new_from_triplets(size, size, &entries);
        let factor = match sparse {
            Ok(sparse) => sparse.sp_lu().map_err(FactorFault::from)?,
            Err(CreationError::Generic(_)) => return Err(FactorFault::OutOfMemory),
            Err(_) => return Err(FactorFault::NotPositiveDefinite),
        };
        Ok(Self { factor, matrix })
    }

    /// Solves A x = b, with two steps of refinement.
    ///
    /// # Errors
    /// [`FactorFault`] when x does not solve the system: the matrix is singular.
    pub fn solve(&self, b: &[f64]) -> Result<Vec<f64>, FactorFault> {
        let mut x = vec![0.0; b.len()];
        let mut defect = b.to_vec();
        for _ in 0..3 {
            let size = defect.len();
            let right = MatMut::from_column_major_slice_mut(&mut defect, size, 1);
            self.factor.solve_in_place_with_conj(Conj::No, right);
            add_scaled(&mut x, 1.0, &defect);
            defect = difference(b, &self.matrix.multiply(&x));
        }
        solved(x, b, &defect)
    }
}

/// A pattern as faer reads it.
fn structure(pattern: &SymmetricPattern) -> SymbolicSparseColMatRef<'_, usize> {
    let (size, [starts, rows]) = (pattern.size(), pattern.columns());
    SymbolicSparseColMatRef::new_checked(size, size, starts, None, rows)
}

/// x where it solves A x = b, for a given b − A x.
fn solved(x: Vec<f64>, b: &[f64], defect: &[f64]) -> Result<Vec<f64>, FactorFault> {
    let scale = norm(b).max(f64::MIN_POSITIVE);
    (norm(defect) / scale < 1e-6)
        .then_some(x)
        .ok_or(FactorFault::NotPositiveDefinite)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laplacian(n: usize) -> (SymmetricPattern, Vec<f64>) {
        let pattern = SymmetricPattern::new(
            (0..n).map(|i| vec![i, i + 1].into_iter().filter(|r| *r < n).collect()),
        );
        let mut values = vec![-1.0; pattern.entries()];
        for entry in pattern.diagonal() {
            values[*entry] = 2.0;
        }
        (pattern, values)
    }

    #[test]
    fn a_system_is_solved_and_refactorised_in_the_same_memory() {
        let (pattern, mut values) = laplacian(50);
        let exact: Vec<f64> = (0..50).map(|i| f64::from(i).sin()).collect();
        let mut cholesky = Cholesky::analyse(pattern.clone()).unwrap();
        for _ in 0..2 {
            let b = pattern.multiply(&values, &exact);
            cholesky.factorise(&values).unwrap();
            let x = cholesky.solve(&b).unwrap();
            assert!(
                x.iter()
                    .zip(&exact)
                    .all(|(x, exact)| (x - exact).abs() < 1e-12)
            );
            values.iter_mut().for_each(|value| *value *= 3.0);
        }
    }

    #[test]
    fn the_order_of_elimination_does_not_change_the_solution() {
        let (pattern, values) = laplacian(50);
        let exact: Vec<f64> = (0..50).map(|i| f64::from(i).cos()).collect();
        let order: Vec<usize> = (0..50).map(|i| 7 * i % 50).collect();
        let mut cholesky = Cholesky::analyse_in_order(pattern.clone(), &order).unwrap();
        cholesky.factorise(&values).unwrap();
        let mut x = pattern.multiply(&values, &exact);
        cholesky.substitute(&mut x);
        let pairs = x.iter().zip(&exact);
        pairs.for_each(|(x, exact)| assert!((x - exact).abs() < 1e-12));
    }

    #[test]
    fn an_indefinite_matrix_is_reported() {
        let (pattern, mut values) = laplacian(20);
        values[pattern.diagonal()[7]] = -1.0;
        let mut cholesky = Cholesky::analyse(pattern).unwrap();
        assert_eq!(
            cholesky.factorise(&values),
            Err(FactorFault::NotPositiveDefinite)
        );
        values[0] = f64::NAN;
        assert_eq!(
            cholesky.factorise(&values),
            Err(FactorFault::NotPositiveDefinite)
        );
    }

    #[test]
    fn too_little_memory_is_no_singular_system() {
        let fault = zeros(usize::MAX / 16).unwrap_err();
        assert_eq!(fault, FactorFault::OutOfMemory);
        assert_eq!(SolveFault::from(fault), SolveFault::OutOfMemory);
        assert_eq!(
            fault.or(SolveFault::NotPositiveDefinite),
            SolveFault::OutOfMemory
        );
        let singular = SolveFault::from(FactorFault::NotPositiveDefinite);
        assert_eq!(singular, SolveFault::Singular);
        assert!(SolveFault::OutOfMemory.advice().contains("memory"));
    }

    #[test]
    fn an_unsymmetric_matrix_is_solved_and_a_singular_one_is_reported() {
        let mut a = SparseRows::new(3);
        a.push([(1, 2.0)]);
        a.push([(0, 1.0), (2, -1.0)]);
        a.push([(0, 1.0), (1, 1.0), (2, 1.0)]);
        let x = SparseLu::new(a.clone())
            .unwrap()
            .solve(&[4.0, 1.0, 5.0])
            .unwrap();
        assert!(
            x.iter()
                .zip([2.0, 2.0, 1.0])
                .all(|(x, exact)| (x - exact).abs() < 1e-14)
        );
        let mut singular = SparseRows::new(2);
        singular.push([(0, 1.0), (1, 2.0)]);
        singular.push([(0, 2.0), (1, 4.0)]);
        let outcome = SparseLu::new(singular).and_then(|lu| lu.solve(&[1.0, 0.0]));
        assert_eq!(outcome, Err(FactorFault::NotPositiveDefinite));
    }
}
