//! The corrective technique: the field nearest to a given one that satisfies the governing equation and
//! what is known at the boundary.
//!
//! ```text
//! minimise ½ ‖u − ū‖²_W   subject to   F(u) = 0,  T(u) = 0
//! L(u, ζ, η) = ½ (u − ū)ᵀ W (u − ū) + ζᵀ F(u) + ηᵀ T(u)
//! ```
//!
//! The conditions are linearised about the current field and the [projection] of ū onto the linearised
//! conditions is repeated until they hold. ζ and η are the derivatives of the smallest ½ ‖u − ū‖²_W by
//! the right-hand sides, with the sign reversed where a condition reads c(u) = b: ∂(minimum)/∂b = −ψ.
//!
//! Where F and T together give as many conditions as there are unknowns, ū has no say in the result: each
//! step is then a Newton step that starts at ū, whatever W is, and the multipliers tell how far ū was
//! from equilibrium. With fewer conditions it is a least-squares problem in earnest.
//!
//! The corrector does not know how ū was made.
//!
//! # References
//! H. Mohammadi, W. Wan: A novel numerical corrective technique to mass spring systems

use crate::error::SolveFault;
use crate::solve::sparse::largest;
use crate::solve::{Inadmissible, NotPositiveDefinite, SparseRows};

pub mod condition;
mod difference_scheme;
pub mod plate;
pub mod projection;

pub use condition::{Condition, Equilibrium, Linearised, Prescribed};
pub use difference_scheme::DifferenceScheme;
pub use plate::PlateCorrector;
use projection::Projection;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorrectorSettings {
    /// Largest scaled residual relative to the largest displacement; see [`Step::residual`].
    pub tolerance: f64,
    /// Steps allowed.
    pub max_steps: usize,
}

/// A field, the weights of its entries and the conditions it has to satisfy.
pub struct Corrector<'a> {
    conditions: Vec<Box<dyn Condition + 'a>>,
    weights: Vec<f64>,
    settings: CorrectorSettings,
}

/// The Lagrange multipliers of one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers {
    /// The condition's name.
    pub name: String,
    /// The unknown of each row.
    pub unknowns: Vec<usize>,
    /// One number a row, in mm² over the unit of the row.
    pub values: Vec<f64>,
}

/// A field on the way from ū to u.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The field in mm.
    pub displacement: Vec<f64>,
    /// Largest residual: each row c divided by √(B W⁻¹ Bᵀ) of its gradient B, which makes it a distance
    /// in mm, over the largest displacement of the field.
    pub residual: f64,
    /// Share of the linearised step that was taken to get here; 1 for the start.
    pub length: f64,
}

/// The result of a correction.
#[derive(Clone, Debug, PartialEq)]
pub struct Correction {
    /// The start and the field after each step; the last one is the result.
    pub steps: Vec<Step>,
    /// The multipliers, condition after condition.
    pub multipliers: Vec<Multipliers>,
}

impl Correction {
    /// The corrected field in mm.
    pub fn displacement(&self) -> &[f64] {
        &self.steps[self.steps.len() - 1].displacement
    }
}

/// All conditions linearised about one field, and 1/√(B W⁻¹ Bᵀ)ᵢᵢ of each row.
struct System {
    values: Vec<f64>,
    jacobian: SparseRows,
    scales: Vec<f64>,
}

impl System {
    /// Rows as distances in mm.
    fn scaled(&self, values: &[f64]) -> Vec<f64> {
        values
            .iter()
            .zip(&self.scales)
            .map(|(c, s)| c * s)
            .collect()
    }
}

/// The shortest share of a step that is tried.
const SHORTEST_STEP: f64 = 1e-4;

impl<'a> Corrector<'a> {
    /// A corrector for fields with one of `weights` (the diagonal of W) an entry.
    pub fn new(
        conditions: Vec<Box<dyn Condition + 'a>>,
        weights: Vec<f64>,
        settings: CorrectorSettings,
    ) -> Self {
        Self {
            conditions,
            weights,
            settings,
        }
    }

    /// Corrects the field `data` (ū), beginning at `start`.
    ///
    /// Never start at noisy data: the conditions are linearised about the start.
    /// `describe` names an element for messages.
    ///
    /// # Errors
    /// A [`SolveFault`] when the start is inverted, conditions depend on each other, or the steps end
    /// without meeting the tolerance.
    pub fn correct(
        &self,
        data: &[f64],
        start: &[f64],
        describe: &dyn Fn(usize) -> String,
    ) -> Result<Correction, SolveFault> {
        let CorrectorSettings {
            tolerance,
            max_steps,
        } = self.settings;
        let inverted = |fault: Inadmissible| SolveFault::Inverted {
            element: describe(fault.element),
        };
        let mut steps = Vec::new();
        let (mut field, mut length) = (start.to_vec(), 1.0);
        loop {
            let system = self.linearise(&field).map_err(inverted)?;
            let size = largest(&field).max(f64::MIN_POSITIVE);
            let residual = largest(&system.scaled(&system.values)) / size;
            let projection = self
                .project(&system, &difference(data, &field))
                .map_err(|NotPositiveDefinite| SolveFault::Singular)?;
            let moved = largest(&projection.step) / size;
            if !(residual.is_finite() && moved.is_finite()) {
                return Err(SolveFault::NotFinite("the corrected field".into()));
            }
            let before = field.clone();
            steps.push(Step {
                displacement: field,
                residual,
                length,
            });
            if residual <= tolerance && moved <= 10.0 * tolerance {
                let multipliers = self.by_condition(&projection.multipliers);
                return Ok(Correction { steps, multipliers });
            }
            if steps.len() > max_steps {
                return Err(SolveFault::Stalled {
                    iterations: max_steps,
                    residual,
                    tolerance,
                });
            }
            (field, length) = self
                .advance(&system, data, before, &projection)
                .map_err(inverted)?;
        }
    }

    fn linearise(&self, field: &[f64]) -> Result<System, Inadmissible> {
        let mut values = Vec::new();
        let mut jacobian = SparseRows::new(field.len());
        for condition in &self.conditions {
            let linearised = condition.linearise(field)?;
            values.extend(linearised.values);
            jacobian.append(linearised.jacobian);
        }
        Ok(System {
            scales: projection::row_scales(&jacobian, &self.weights),
            values,
            jacobian,
        })
    }

    fn unknowns(&self) -> Vec<usize> {
        let all = self.conditions.iter();
        all.flat_map(|condition| condition.unknowns().iter().copied())
            .collect()
    }

    /// Whether every unknown of the field has exactly one row.
    fn is_square(&self) -> bool {
        let mut unknowns = self.unknowns();
        unknowns.sort_unstable();
        unknowns.into_iter().eq(0..self.weights.len())
    }

    /// The symmetric form where it applies and the stiffness is positive definite, else the general one.
    fn project(
        &self,
        system: &System,
        data_minus_field: &[f64],
    ) -> Result<Projection, NotPositiveDefinite> {
        let (jacobian, values) = (&system.jacobian, &system.values);
        if self.is_square() {
            let unknowns = self.unknowns();
            let projection =
                projection::symmetric(jacobian, values, data_minus_field, &self.weights, &unknowns);
            if projection.is_ok() {
                return projection;
            }
        }
        projection::general(jacobian, values, data_minus_field, &self.weights)
    }

    /// Takes the longest share 1, ½, ¼ … of a step that inverts no cell and lessens the exact penalty
    /// ½ ‖u − ū‖²_W + ρ Σ |cᵢ|/√(B W⁻¹ Bᵀ)ᵢᵢ, or halves its second term.
    fn advance(
        &self,
        system: &System,
        data: &[f64],
        before: Vec<f64>,
        projection: &Projection,
    ) -> Result<(Vec<f64>, f64), Inadmissible> {
        let magnitude = |values: &[f64]| system.scaled(values).iter().map(|c| c.abs()).sum::<f64>();
        let distance = |field: &[f64]| -> f64 {
            let squares = difference(field, data).into_iter().zip(&self.weights);
            0.5 * squares.map(|(d, weight)| weight * d * d).sum::<f64>()
        };
        let multipliers = projection.multipliers.iter().zip(&system.scales);
        let penalty = 2.0 * multipliers.fold(0.0, |most: f64, (psi, s)| most.max((psi / s).abs()));
        let (start_defect, start_distance) = (magnitude(&system.values), distance(&before));
        let mut length = 1.0;
        loop {
            let steps = before.iter().zip(&projection.step);
            let field: Vec<f64> = steps.map(|(u, step)| u + length * step).collect();
            let last = length < SHORTEST_STEP;
            match self.values(&field) {
                Err(fault) if last => return Err(fault),
                Ok(values) => {
                    let defect = magnitude(&values);
                    let merit =
                        penalty * (defect - start_defect) + distance(&field) - start_distance;
                    if last || defect <= 0.5 * start_defect || merit <= 0.0 {
                        return Ok((field, length));
                    }
                }
                Err(_) => {}
            }
            length *= 0.5;
        }
    }

    fn values(&self, field: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        let mut all = Vec::new();
        for condition in &self.conditions {
            all.extend(condition.values(field)?);
        }
        Ok(all)
    }

    fn by_condition(&self, values: &[f64]) -> Vec<Multipliers> {
        let mut values = values.iter().copied();
        let mut all = Vec::new();
        for condition in &self.conditions {
            let unknowns = condition.unknowns().to_vec();
            all.push(Multipliers {
                name: condition.name().to_owned(),
                values: values.by_ref().take(unknowns.len()).collect(),
                unknowns,
            });
        }
        all
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

#[cfg(test)]
mod tests;
