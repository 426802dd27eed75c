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

    /// The unknown that each row belongs to: the one it prescribes, or the one in whose direction it is
    /// a balance of forces. Where all conditions together name every unknown exactly once, the system
    /// is square.
    fn unknowns(&self) -> &[usize];
}

/// Known displacements: uᵢ − gᵢ = 0, in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    name: String,
    unknowns: Vec<usize>,
    values: Vec<f64>,
}

impl Prescribed {
    /// Prescribes (unknown, value) pairs.
    pub fn new(name: &str, known: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let (unknowns, values) = known.into_iter().unzip();
        Self {
            name: name.to_owned(),
            unknowns,
            values,
        }
    }
}

impl Condition for Prescribed {
    fn name(&self) -> &str {
        &self.name
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearised, Inadmissible> {
        let mut jacobian = SparseRows::new(u.len());
        for unknown in &self.unknowns {
            jacobian.push([(*unknown, 1.0)]);
        }
        let known = self.unknowns.iter().zip(&self.values);
        let values = known.map(|(unknown, value)| u[*unknown] - value).collect();
        Ok(Linearised { values, jacobian })
    }

    fn unknowns(&self) -> &[usize] {
        &self.unknowns
    }
}

/// Equilibrium without external force: ∂Π/∂uᵢ = 0 at the chosen unknowns, in N.
///
/// At inner nodes this is the governing equation F(u) = 0; at the nodes of an edge, the half cells on the
/// inner side alone contribute, which is the edge's condition that no traction acts on it.
pub struct Equilibrium<'a> {
    name: String,
    potential: &'a dyn Potential,
    assembly: &'a Assembly,
    unknowns: Vec<usize>,
}

impl<'a> Equilibrium<'a> {
    /// Equilibrium of `potential` at `unknowns`; `assembly` must hold no unknown fixed.
    pub fn new(
        name: &str,
        potential: &'a dyn Potential,
        assembly: &'a Assembly,
        unknowns: Vec<usize>,
    ) -> Self {
        Self {
            name: name.to_owned(),
            potential,
            assembly,
            unknowns,
        }
    }
}

impl Condition for Equilibrium<'_> {
    fn name(&self) -> &str {
        &self.name
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearised, Inadmissible> {
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        self.assembly
            .linearise(self.potential, u, &mut residual, &mut stiffness)?;
        let full = self.assembly.pattern().full_rows(&stiffness);
        let mut jacobian = SparseRows::new(u.len());
        for unknown in &self.unknowns {
            jacobian.push(full[*unknown].iter().copied());
        }
        let values = self.unknowns.iter().map(|i| residual[*i]).collect();
        Ok(Linearised { values, jacobian })
    }

    fn values(&self, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        let mut residual = vec![0.0; u.len()];
        Assembly::residual(self.potential, u, &mut residual)?;
        Ok(self.unknowns.iter().map(|i| residual[*i]).collect())
    }

    fn unknowns(&self) -> &[usize] {
        &self.unknowns
    }
}
