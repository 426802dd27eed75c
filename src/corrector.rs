//! The corrective technique: the field nearest to a given one that satisfies the governing equation and
//! what is known at the boundary.
//!
//! ```text
//! minimise ½ ‖u − ū‖²_W   subject to   F(u) = 0,  T(u) = 0
//! L(u, ζ, η) = ½ (u − ū)ᵀ W (u − ū) + ζᵀ F(u) + ηᵀ T(u)
//! ```
//!
//! The conditions are linearised about the current field and the [projection](factor) of ū onto the
//! linearised conditions is repeated until they hold. ζ and η are the derivatives of the smallest ½ ‖u − ū‖²_W by
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
use crate::solve::vector::largest;
use crate::solve::{Convergence, Inadmissible, NotPositiveDefinite, SparseRows};

mod acceleration;
pub mod climb;
pub mod condition;
mod dependence;
mod difference_scheme;
pub mod estimate;
pub mod estimation;
pub mod factor;
pub mod matrix;
pub mod motion;
pub mod plate;
pub mod retained;
pub mod specimen;
mod step;

pub use condition::{
    Condition, EnclosedArea, Equilibrium, Function, Linear, Linearised, TotalForce,
};
pub use difference_scheme::DifferenceScheme;
pub use factor::{Factor, Projection, Solver};
pub use matrix::CorrectionMatrix;
pub use plate::PlateCorrector;

/// How a correction is computed, and when it is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorrectorSettings {
    /// Largest scaled residual relative to the largest displacement; see [`Step::residual`]. Default: 1e-10.
    pub tolerance: f64,
    /// Largest further move of the field that is left undone, relative to the largest displacement, where
    /// the data have a say in the result: a small part of their noise is enough. Default: 1e-9.
    pub movement: f64,
    /// Steps allowed. Default: 40.
    pub max_steps: usize,
    /// The form of the projection. Default: [`Solver::Automatic`].
    pub solver: Solver,
}

impl Default for CorrectorSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            movement: 1e-9,
            max_steps: 40,
            solver: Solver::Automatic,
        }
    }
}

/// Names elements and unknowns in messages.
pub trait Describe {
    /// An element of a potential.
    fn element(&self, element: usize) -> String {
        format!("element {element}")
    }

    /// An entry of the field.
    fn unknown(&self, unknown: usize) -> String {
        format!("unknown {unknown}")
    }
}

/// Names by number.
#[derive(Clone, Copy, Debug)]
pub struct ByNumber;

impl Describe for ByNumber {}

/// The conditions on a field, the weights of its entries, and the way to correct it.
pub struct Corrector<'a> {
    conditions: Vec<Box<dyn Condition + 'a>>,
    weights: Vec<f64>,
    settings: CorrectorSettings,
    names: &'a dyn Describe,
}

/// The Lagrange multipliers of one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers {
    /// The condition's name.
    pub name: String,
    /// The unknown of each row, where each row belongs to one.
    pub unknowns: Option<Vec<usize>>,
    /// One number a row, in the unit of ½ ‖u − ū‖²_W over the unit of the row.
    pub values: Vec<f64>,
}

/// A field on the way from ū to u.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The field.
    pub field: Vec<f64>,
    /// Largest residual: each row c divided by √(B W⁻¹ Bᵀ) of its gradient B, which makes it a distance
    /// in the unit of the field, over the largest entry of the field.
    pub residual: f64,
    /// Share of the linearised step that was taken to get here; 1 for the start.
    pub length: f64,
    /// Whether the step came from a factor of another field.
    pub retained: bool,
}

/// The result of a correction.
#[derive(Debug)]
pub struct Correction {
    /// The start and the field after each step; the last one is the result.
    pub steps: Vec<Step>,
    /// The multipliers, condition after condition.
    pub multipliers: Vec<Multipliers>,
    /// The conditions at the result, factorised.
    pub factor: Factor,
}

impl Correction {
    /// The corrected field.
    pub fn field(&self) -> &[f64] {
        &self.steps[self.steps.len() - 1].field
    }

    /// How the field was reached, with the energy there in mJ.
    pub fn convergence(&self, energy: f64) -> Convergence {
        let steps = self.steps.iter();
        Convergence {
            residuals: steps.clone().map(|step| step.residual).collect(),
            energy,
            cut_steps: steps.filter(|step| step.length < 1.0).count(),
            shifted_steps: 0,
        }
    }
}

/// All conditions linearised about one field, and 1/√(B W⁻¹ Bᵀ)ᵢᵢ of each row.
struct System {
    /// Largest entry of the field.
    size: f64,
    values: Vec<f64>,
    jacobian: SparseRows,
    scales: Vec<f64>,
}

impl System {
    /// Rows as distances.
    fn scaled(&self, values: &[f64]) -> Vec<f64> {
        values
            .iter()
            .zip(&self.scales)
            .map(|(c, s)| c * s)
            .collect()
    }
}

impl<'a> Corrector<'a> {
    /// A corrector for fields with one of `weights` (the diagonal of W) an entry. An entry with the weight
    /// zero has no data: it is a parameter of the conditions that is found with the field.
    pub fn new(
        conditions: Vec<Box<dyn Condition + 'a>>,
        weights: Vec<f64>,
        settings: CorrectorSettings,
    ) -> Self {
        Self {
            conditions,
            weights,
            settings,
            names: &ByNumber,
        }
    }

    /// Names elements and unknowns in messages.
    #[must_use]
    pub fn named(self, names: &'a dyn Describe) -> Self {
        Self { names, ..self }
    }

    /// Corrects the field `data` (ū), beginning at `start`.
    ///
    /// Never start at noisy data: the conditions are linearised about the start.
    ///
    /// # Errors
    /// A [`SolveFault`] when the start is inverted, conditions depend on each other, or the steps end
    /// without meeting the tolerance.
    pub fn correct(&self, data: &[f64], start: &[f64]) -> Result<Correction, SolveFault> {
        self.finish(data, start.to_vec(), Vec::new())
    }

    /// Corrects with a factor of these conditions taken at another field, such as the plate at rest, by
    /// accelerated steps; takes fresh factors where these stall, and for the exact multipliers at the end.
    ///
    /// # Errors
    /// As [`Self::correct`].
    pub fn correct_retained(
        &self,
        data: &[f64],
        start: &[f64],
        factor: &mut Factor,
    ) -> Result<Correction, SolveFault> {
        let (field, steps) = acceleration::accelerate(self, data, start, factor)?;
        self.finish(data, field, steps)
    }

    /// Factorises the conditions linearised about `field`.
    ///
    /// # Errors
    /// [`SolveFault::Inverted`], or [`SolveFault::Dependent`] with the rows that depend on each other.
    pub fn factor(&self, field: &[f64]) -> Result<Factor, SolveFault> {
        let system = self.linearise(field)?;
        self.factorise(&system)
    }

    /// Steps with a fresh factor each, until the tolerance is met.
    fn finish(
        &self,
        data: &[f64],
        mut field: Vec<f64>,
        mut steps: Vec<Step>,
    ) -> Result<Correction, SolveFault> {
        let CorrectorSettings {
            tolerance,
            movement,
            max_steps,
            ..
        } = self.settings;
        let (mut length, first) = (1.0, steps.len());
        loop {
            let system = self.linearise(&field)?;
            let mut factor = self.factorise(&system)?;
            let projection = factor
                .project(&system.values, &difference(data, &field))
                .map_err(|NotPositiveDefinite| self.dependent(&system))?;
            let residual = largest(&system.scaled(&system.values)) / system.size;
            let moved = largest(&projection.step) / system.size;
            if !(residual.is_finite() && moved.is_finite()) {
                return Err(SolveFault::NotFinite("the corrected field".into()));
            }
            let before = field.clone();
            steps.push(Step {
                field,
                residual,
                length,
                retained: false,
            });
            if residual <= tolerance && moved <= movement {
                return Ok(Correction {
                    steps,
                    multipliers: self.by_condition(&projection.multipliers),
                    factor,
                });
            }
            if steps.len() > first + max_steps {
                return Err(SolveFault::Stalled {
                    iterations: max_steps,
                    residual,
                    tolerance,
                });
            }
            // Near enough to the data, only the conditions are still to be met.
            let (target, projection) = if moved <= movement {
                let still = vec![0.0; before.len()];
                let back = factor.project(&system.values, &still);
                let back = back.map_err(|NotPositiveDefinite| self.dependent(&system))?;
                (&before[..], back)
            } else {
                (data, projection)
            };
            (field, length) = self.next(&system, &mut factor, target, &before, &projection)?;
        }
    }

    fn inverted(&self, fault: Inadmissible) -> SolveFault {
        SolveFault::Inverted {
            element: self.names.element(fault.element),
        }
    }

    fn linearise(&self, field: &[f64]) -> Result<System, SolveFault> {
        let mut values = Vec::new();
        let mut jacobian = SparseRows::new(field.len());
        for condition in &self.conditions {
            let linearised = condition
                .linearise(field)
                .map_err(|fault| self.inverted(fault))?;
            values.extend(linearised.values);
            jacobian.append(linearised.jacobian);
        }
        Ok(System {
            size: largest(field).max(f64::MIN_POSITIVE),
            scales: factor::row_scales(&jacobian, &self.weights),
            values,
            jacobian,
        })
    }

    fn factorise(&self, system: &System) -> Result<Factor, SolveFault> {
        let (jacobian, weights) = (system.jacobian.clone(), self.weights.clone());
        let factor = Factor::new(
            jacobian,
            weights,
            self.square_unknowns(),
            self.settings.solver,
        );
        match factor {
            // LU may pass over dependent rows and give huge multipliers.
            Ok(factor) if factor.solver() == Solver::Kkt => {
                match dependence::find(&system.jacobian, &system.values, system.size) {
                    None => Ok(factor),
                    Some(_) => Err(self.dependent(system)),
                }
            }
            Ok(factor) => Ok(factor),
            Err(NotPositiveDefinite) => Err(self.dependent(system)),
        }
    }

    /// The unknown of each row, if every unknown of the field has exactly one.
    fn square_unknowns(&self) -> Option<Vec<usize>> {
        let mut unknowns = Vec::new();
        for condition in &self.conditions {
            unknowns.extend_from_slice(condition.unknowns()?);
        }
        let mut sorted = unknowns.clone();
        sorted.sort_unstable();
        sorted
            .into_iter()
            .eq(0..self.weights.len())
            .then_some(unknowns)
    }

    /// Names the rows that depend on each other.
    fn dependent(&self, system: &System) -> SolveFault {
        const MOST_NAMES: usize = 8;
        let Some(found) = dependence::find(&system.jacobian, &system.values, system.size) else {
            return SolveFault::Singular;
        };
        let mut names = Vec::new();
        for condition in &self.conditions {
            let rows = match condition.unknowns() {
                Some(unknowns) => unknowns.iter().map(|i| Some(*i)).collect(),
                None => vec![None; condition.rows()],
            };
            names.extend(
                rows.into_iter()
                    .enumerate()
                    .map(|(row, unknown)| match unknown {
                        Some(unknown) => {
                            format!("{} at {}", condition.name(), self.names.unknown(unknown))
                        }
                        None => format!("{}, row {row}", condition.name()),
                    }),
            );
        }
        let rows = found.rows.iter().take(MOST_NAMES);
        SolveFault::Dependent {
            rows: rows.filter_map(|row| names.get(*row).cloned()).collect(),
            more: found.rows.len().saturating_sub(MOST_NAMES),
            contradictory: found.contradictory,
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
            all.push(Multipliers {
                name: condition.name().to_owned(),
                unknowns: condition.unknowns().map(<[usize]>::to_vec),
                values: values.by_ref().take(condition.rows()).collect(),
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
