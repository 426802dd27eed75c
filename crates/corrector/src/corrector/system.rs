//! The conditions on a field, and their linearisation.

use super::condition::Condition;
use super::correction::{CorrectorSettings, Describe, Multipliers};
use super::dependence;
use super::factor::{Factor, Solver, row_scales};
use crate::error::SolveFault;
use crate::solve::vector::largest;
use crate::solve::{FactorFault, Inadmissible, SparseRows};

/// The shortest share of a step that is tried.
pub(super) const SHORTEST_STEP: f64 = 1e-4;

/// The conditions on a field, the weights of its entries, and the names for messages.
pub struct Corrector<'a> {
    pub(super) conditions: Vec<Box<dyn Condition + 'a>>,
    pub(super) weights: Vec<f64>,
    pub(super) settings: CorrectorSettings,
    pub(super) names: &'a dyn Describe,
}

/// All conditions linearised about one field, and 1/√(B W⁻¹ Bᵀ)ᵢᵢ of each row.
pub(super) struct System {
    /// Largest entry of the field.
    pub size: f64,
    pub values: Vec<f64>,
    pub jacobian: SparseRows,
    pub scales: Vec<f64>,
}

impl System {
    /// Rows as distances.
    pub fn scaled(&self, values: &[f64]) -> Vec<f64> {
        values
            .iter()
            .zip(&self.scales)
            .map(|(c, s)| c * s)
            .collect()
    }
}

impl<'a> Corrector<'a> {
    /// A corrector for fields with one of `weights` (the diagonal of W) per entry. An entry with the weight zero has
    /// no data: it is a parameter of the conditions that is found with the field.
    pub fn new(
        conditions: Vec<Box<dyn Condition + 'a>>,
        weights: Vec<f64>,
        settings: CorrectorSettings,
    ) -> Self {
        Self {
            conditions,
            weights,
            settings,
            names: &(),
        }
    }

    /// Sets the names of elements and unknowns for messages.
    #[must_use]
    pub fn named(self, names: &'a dyn Describe) -> Self {
        Self { names, ..self }
    }

    /// Factorises the conditions linearised about `field`.
    ///
    /// # Errors
    /// [`SolveFault::Inverted`], or [`SolveFault::Dependent`] with the rows that depend on each other.
    pub fn factor(&self, field: &[f64]) -> Result<Factor, SolveFault> {
        let system = self.linearise(field)?;
        self.factorise(&system)
    }

    pub(super) fn inverted(&self, fault: Inadmissible) -> SolveFault {
        fault.named(|element| self.names.element(element))
    }

    pub(super) fn linearise(&self, field: &[f64]) -> Result<System, SolveFault> {
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
            scales: row_scales(&jacobian, &self.weights),
            values,
            jacobian,
        })
    }

    pub(super) fn factorise(&self, system: &System) -> Result<Factor, SolveFault> {
        let (jacobian, weights) = (system.jacobian.clone(), self.weights.clone());
        let factor = Factor::new(
            jacobian,
            weights,
            self.square_unknowns(),
            self.settings.solver,
        );
        match factor {
            // LU may not detect dependent rows and then gives huge multipliers.
            Ok(factor) if factor.solver() == Solver::Kkt => {
                match dependence::find(&system.jacobian, &system.values, system.size) {
                    None => Ok(factor),
                    Some(_) => Err(self.dependent(system)),
                }
            }
            Ok(factor) => Ok(factor),
            Err(FactorFault::NotPositiveDefinite) => Err(self.dependent(system)),
            Err(fault) => Err(fault.into()),
        }
    }

    /// The unknown of each row, if every unknown of the field has exactly one.
    pub(super) fn square_unknowns(&self) -> Option<Vec<usize>> {
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
    pub(super) fn dependent(&self, system: &System) -> SolveFault {
        const MOST_NAMES: usize = 8;
        let Some(dependent) = dependence::find(&system.jacobian, &system.values, system.size)
        else {
            return SolveFault::Singular;
        };
        let rows = dependent.rows.iter().take(MOST_NAMES);
        SolveFault::Dependent {
            rows: rows.filter_map(|row| self.name_of(*row)).collect(),
            more: dependent.rows.len().saturating_sub(MOST_NAMES),
            contradictory: dependent.contradictory,
        }
    }

    /// The condition of a row of the Jacobian, and where it holds.
    fn name_of(&self, mut row: usize) -> Option<String> {
        for condition in &self.conditions {
            if row < condition.rows() {
                let name = condition.name();
                return Some(match condition.unknowns() {
                    Some(unknowns) => format!("{name} at {}", self.names.unknown(unknowns[row])),
                    None => format!("{name}, row {row}"),
                });
            }
            row -= condition.rows();
        }
        None
    }

    pub(super) fn values(&self, field: &[f64]) -> Result<Vec<f64>, Inadmissible> {
        let mut all = Vec::new();
        for condition in &self.conditions {
            all.extend(condition.values(field)?);
        }
        Ok(all)
    }

    pub(super) fn by_condition(&self, values: &[f64]) -> Vec<Multipliers> {
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
