//! Conditions c(u) = 0 that a corrected field has to satisfy.

use crate::solve::{Assembly, Inadmissible, Potential, SparseRows};

/// The rows of a condition, linearised: c(u + δ) ≈ c(u) + B δ.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// c(u).
    pub values: Vec<f64>,
    /// B = ∂c/∂u.
    pub jacobian: SparseRows,
}

/// A group of conditions on the field, with one Lagrange multiplier a row.
pub trait Condition {
    /// The group's name, such as `grips`.
    fn name(&self) -> &str;

    /// Number of rows.
    fn rows(&self) -> usize;

    /// Values and Jacobian at `u`.
    ///
    /// # Errors
    /// [`Inadmissible`] when a cell is inverted.
    fn linearise(&self, u: &[f64]) -> Result<Linearised, Inadmissible>;

    /// Values at `u`.
    ///
    /// # Errors
    /// [`Inadmissible`] when a cell is inverted.
    fn values(&self, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        Ok(self.linearise(u)?.values)
    }

    /// The unknown that each row belongs to, where there is one for each.
    fn unknowns(&self) -> &[usize];

    /// How the rows can be written: see [`Kind`].
    fn kind(&self) -> Kind;
}

/// What kind of rows a condition has; the solver takes a shorter way for the first two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// uᵢ − gᵢ = 0.
    Prescribed,
    /// ∂Π/∂uᵢ = 0 of one potential, so that B is a part of a symmetric matrix.
    Equilibrium,
}

/// Known displacements: uᵢ = gᵢ.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    name: String,
    unknowns: Vec<usize>,
    values: Vec<f64>,
    size: usize,
}

impl Prescribed {
    /// Prescribes (unknown, value) pairs of a field with `size` unknowns.
    pub fn new(name: &str, size: usize, known: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let (unknowns, values) = known.into_iter().unzip();
        Self { name: name.to_owned(), unknowns, values, size }
    }
}

impl Condition for Prescribed {
    fn name(&self) -> &str {
        &self.name
    }

    fn rows(&self) -> usize {
        self.unknowns.len()
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearised, Inadmissible> {
        let mut jacobian = SparseRows::new(self.size);
        self.unknowns.iter().for_each(|unknown| jacobian.push([(*unknown, 1.0)]));
        let values = self.unknowns.iter().zip(&self.values).map(|(i, g)| u[*i] - g).collect();
        Ok(Linearised { values, jacobian })
    }

    fn unknowns(&self) -> &[usize] {
        &self.unknowns
    }

    fn kind(&self) -> Kind {
        Kind::Prescribed
    }
}

/// Equilibrium without external force: ∂Π/∂uᵢ = 0 at the chosen unknowns.
///
/// At inner nodes this is the governing equation F(u) = 0; at the nodes of an edge, the half cells on the
/// inner side alone contribute, which is the edge's condition that no traction acts on it.
pub struct Equilibrium<'a> {
    name: String,
    potential: &'a dyn Potential,
    unknowns: Vec<usize>,
    assembly: &'a Assembly,
}

impl<'a> Equilibrium<'a> {
    /// Equilibrium of `potential` at `unknowns`; `assembly` must hold no unknown fixed.
    pub fn new(
        name: &str,
        potential: &'a dyn Potential,
        assembly: &'a Assembly,
        unknowns: Vec<usize>,
    ) -> Self {
        Self { name: name.to_owned(), potential, unknowns, assembly }
    }
}

impl Condition for Equilibrium<'_> {
    fn name(&self) -> &str {
        &self.name
    }

    fn rows(&self) -> usize {
        self.unknowns.len()
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearised, Inadmissible> {
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        self.assembly.linearise(self.potential, u, &mut residual, &mut stiffness)?;
        let full = self.assembly.pattern().full_rows(&stiffness);
        let mut jacobian = SparseRows::new(u.len());
        self.unknowns.iter().for_each(|unknown| jacobian.push(full[*unknown].iter().copied()));
        let values = self.unknowns.iter().map(|unknown| residual[*unknown]).collect();
        Ok(Linearised { values, jacobian })
    }

    fn values(&self, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        let mut residual = vec![0.0; u.len()];
        Assembly::residual(self.potential, u, &mut residual)?;
        Ok(self.unknowns.iter().map(|unknown| residual[*unknown]).collect())
    }

    fn unknowns(&self) -> &[usize] {
        &self.unknowns
    }

    fn kind(&self) -> Kind {
        Kind::Equilibrium
    }
}
