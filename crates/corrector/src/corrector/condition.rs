//! Conditions c(u) = 0 that a corrected field has to satisfy.

use crate::solve::{Inadmissible, SparseRows};

mod forces;

pub use forces::Equilibrium;

/// The rows of a condition, linearised: c(u + δ) ≈ c(u) + B δ.
#[derive(Clone, Debug)]
pub struct Linearisation {
    /// c(u).
    pub values: Vec<f64>,
    /// B = ∂c/∂u.
    pub jacobian: SparseRows,
}

/// A group of conditions on the field, with one Lagrange multiplier per row.
pub trait Condition {
    /// The group's name, such as `grips`.
    fn name(&self) -> &str;

    /// Number of rows.
    fn rows(&self) -> usize;

    /// Values and Jacobian at `u`.
    ///
    /// # Errors
    /// [`Inadmissible`] when a cell is inverted.
    fn linearise(&self, u: &[f64]) -> Result<Linearisation, Inadmissible>;

    /// Values at `u`.
    ///
    /// # Errors
    /// [`Inadmissible`] when a cell is inverted.
    fn values(&self, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        Ok(self.linearise(u)?.values)
    }

    /// Σ ψᵢ ∂²cᵢ/∂u∂u at `u`: symmetric, one row per unknown; `None` for linear conditions.
    ///
    /// # Errors
    /// [`Inadmissible`] when a cell is inverted.
    fn curvature(
        &self,
        _u: &[f64],
        _multipliers: &[f64],
    ) -> Result<Option<SparseRows>, Inadmissible> {
        Ok(None)
    }

    /// The unknown that each row belongs to, where each belongs to one: the unknown it prescribes, or the
    /// one in whose direction it is a balance of forces. Where all conditions together name every unknown
    /// of the field exactly once, the system is square.
    fn unknowns(&self) -> Option<&[usize]> {
        None
    }
}

/// Linear conditions B u − b = 0 with any number of entries per row.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    name: String,
    rows: SparseRows,
    right_hand_side: Vec<f64>,
    unknowns: Option<Vec<usize>>,
}

impl Linear {
    /// The conditions `rows` · u = `right_hand_side`.
    pub fn new(name: &str, rows: SparseRows, right_hand_side: Vec<f64>) -> Self {
        assert_eq!(
            rows.len(),
            right_hand_side.len(),
            "one right-hand side a row"
        );
        Self {
            name: name.to_owned(),
            rows,
            right_hand_side,
            unknowns: None,
        }
    }

    /// Known values: uᵢ = gᵢ for (i, gᵢ) in `known`, of a field with `size` unknowns. Supports, grips,
    /// symmetry and initial values are of this kind.
    pub fn prescribed(
        name: &str,
        size: usize,
        known: impl IntoIterator<Item = (usize, f64)>,
    ) -> Self {
        let (unknowns, values): (Vec<usize>, Vec<f64>) = known.into_iter().unzip();
        let mut rows = SparseRows::new(size);
        for unknown in &unknowns {
            rows.push([(*unknown, 1.0)]);
        }
        Self {
            unknowns: Some(unknowns),
            ..Self::new(name, rows, values)
        }
    }

    /// Unknowns that move together by an unknown amount: uᵢ − u₀ = 0, for each group of unknowns. A rigid
    /// grip that does not turn is one group for each direction.
    pub fn together(name: &str, size: usize, groups: &[Vec<usize>]) -> Self {
        let mut rows = SparseRows::new(size);
        for (first, unknown) in groups
            .iter()
            .flat_map(|group| group.iter().skip(1).map(|i| (group[0], *i)))
        {
            rows.push([(unknown, 1.0), (first, -1.0)]);
        }
        let zeros = vec![0.0; rows.len()];
        Self::new(name, rows, zeros)
    }
}

impl Condition for Linear {
    fn name(&self) -> &str {
        &self.name
    }

    fn rows(&self) -> usize {
        self.right_hand_side.len()
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearisation, Inadmissible> {
        Ok(Linearisation {
            values: self.values(u)?,
            jacobian: self.rows.clone(),
        })
    }

    fn values(&self, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        let products = self.rows.multiply(u).into_iter();
        Ok(products
            .zip(&self.right_hand_side)
            .map(|(product, b)| product - b)
            .collect())
    }

    fn unknowns(&self) -> Option<&[usize]> {
        self.unknowns.as_deref()
    }
}

/// Σ ψᵢ ∂²cᵢ/∂u∂u from a field and multipliers.
type Curvature = dyn Fn(&[f64], &[f64]) -> SparseRows;

/// Conditions given as a function of the field.
pub struct Function<F> {
    name: String,
    rows: usize,
    function: F,
    curvature: Option<Box<Curvature>>,
}

impl<F: Fn(&[f64]) -> Linearisation> Function<F> {
    /// The conditions that `function` returns, always as many `rows`, linearised at any field.
    pub fn new(name: &str, rows: usize, function: F) -> Self {
        Self {
            name: name.to_owned(),
            rows,
            function,
            curvature: None,
        }
    }

    /// Sets the curvature Σ ψᵢ ∂²cᵢ/∂u∂u as a function of a field and multipliers; without it the conditions are
    /// taken as linear near the solution, which costs steps.
    #[must_use]
    pub fn with_curvature(
        self,
        curvature: impl Fn(&[f64], &[f64]) -> SparseRows + 'static,
    ) -> Self {
        Self {
            curvature: Some(Box::new(curvature)),
            ..self
        }
    }
}

impl<F: Fn(&[f64]) -> Linearisation> Condition for Function<F> {
    fn name(&self) -> &str {
        &self.name
    }

    fn rows(&self) -> usize {
        self.rows
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearisation, Inadmissible> {
        Ok((self.function)(u))
    }

    fn curvature(
        &self,
        u: &[f64],
        multipliers: &[f64],
    ) -> Result<Option<SparseRows>, Inadmissible> {
        let curvature = self.curvature.as_ref();
        Ok(curvature.map(|curvature| curvature(u, multipliers)))
    }
}
