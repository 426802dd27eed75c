//! Conditions on the internal forces of a potential.

use super::{Condition, Linearisation};
use crate::mesh::geometry::sides;
use crate::solve::vector::{gather, largest, moved};
use crate::solve::{Assembly, Inadmissible, Potential, SkewCoupling, SparseRows};

/// Balance of forces ∂Π/∂uᵢ = 0 at the chosen unknowns, in N.
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

    fn rows(&self) -> usize {
        self.unknowns.len()
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearisation, Inadmissible> {
        let (residual, full) = internal_forces(self.potential, self.assembly, u)?;
        let mut jacobian = SparseRows::new(u.len());
        for unknown in &self.unknowns {
            jacobian.push(full[*unknown].iter().copied());
        }
        Ok(Linearisation {
            values: gather(&self.unknowns, &residual),
            jacobian,
        })
    }

    fn values(&self, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        residual(self.potential, u).map(|residual| gather(&self.unknowns, &residual))
    }

    fn curvature(
        &self,
        u: &[f64],
        multipliers: &[f64],
    ) -> Result<Option<SparseRows>, Inadmissible> {
        let rows = self.unknowns.iter().zip(multipliers);
        stiffness_change(self.potential, self.assembly, u, rows).map(Some)
    }

    fn unknowns(&self) -> Option<&[usize]> {
        Some(&self.unknowns)
    }
}

fn residual(potential: &dyn Potential, u: &[f64]) -> Result<Vec<f64>, Inadmissible> {
    let mut residual = vec![0.0; u.len()];
    Assembly::residual(potential, u, &mut residual)?;
    Ok(residual)
}

/// The rows of a full tangent: (column, value).
type Rows = Vec<Vec<(usize, f64)>>;

/// Residual and full tangent, row by row.
fn internal_forces(
    potential: &dyn Potential,
    assembly: &Assembly,
    u: &[f64],
) -> Result<(Vec<f64>, Rows), Inadmissible> {
    let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
    assembly.linearise(potential, u, &mut residual, &mut stiffness)?;
    let mut rows = assembly.pattern().full_rows(&stiffness);
    for SkewCoupling {
        row,
        column,
        stiffness,
    } in potential.skew_couplings()
    {
        for (row, column, value) in [(row, column, stiffness), (column, row, -stiffness)] {
            let entry = rows[row].iter_mut().find(|(entry, _)| *entry == column);
            entry.expect("two unknowns of one node").1 += value;
        }
    }
    Ok((residual, rows))
}

/// The longer side of a box around the free unknowns in mm; 1 where their positions are not known.
fn extent(assembly: &Assembly) -> f64 {
    assembly.positions().map_or(1.0, |positions| {
        let [x, y] = sides(positions);
        x.max(y)
    })
}

/// ∂K/∂u · d by central differences: the curvature of the residual, weighted by d, which is given as
/// (unknown, weight).
fn stiffness_change<'a>(
    potential: &dyn Potential,
    assembly: &Assembly,
    u: &[f64],
    weights: impl Iterator<Item = (&'a usize, &'a f64)>,
) -> Result<SparseRows, Inadmissible> {
    const SHARE: f64 = 1e-5;
    /// Least size of u that determines the step, near rest, as a share of the body's length.
    const LEAST: f64 = 1e-3;
    let mut direction = vec![0.0; u.len()];
    for (unknown, weight) in weights {
        direction[*unknown] += weight;
    }
    let most = largest(&direction);
    let step = if most > 0.0 {
        SHARE * largest(u).max(LEAST * extent(assembly)) / most
    } else {
        1.0
    };
    let at = |step: f64| internal_forces(potential, assembly, &moved(u, step, &direction));
    let ((_, up), (_, down)) = (at(step)?, at(-step)?);
    let mut change = SparseRows::new(u.len());
    for (up, down) in up.iter().zip(&down) {
        let entries = up.iter().zip(down);
        change.push(entries.map(|((column, up), (_, down))| (*column, (up - down) / (2.0 * step))));
    }
    Ok(change)
}
