//! From one field to the next: the steps of the non-linear correction.

use super::{Corrector, Projection, System, difference, factor};
use crate::error::SolveFault;
use crate::solve::SparseRows;
use crate::solve::sparse::largest;

/// The shortest share of a step that is tried.
pub const SHORTEST_STEP: f64 = 1e-4;

/// The exact penalty ½ ‖u − ū‖²_W + ρ Σ |cᵢ|/√(B W⁻¹ Bᵀ)ᵢᵢ, compared with that of the field before.
///
/// With ρ above every scaled multiplier, every step of the linearised problem points downhill in it.
struct Merit<'a> {
    system: &'a System,
    data: &'a [f64],
    weights: &'a [f64],
    penalty: f64,
    defect: f64,
    distance: f64,
}

impl<'a> Merit<'a> {
    fn new(
        system: &'a System,
        data: &'a [f64],
        weights: &'a [f64],
        field: &[f64],
        multipliers: &[f64],
    ) -> Self {
        let scaled = multipliers.iter().zip(&system.scales);
        let mut merit = Self {
            system,
            data,
            weights,
            penalty: 2.0 * scaled.fold(0.0, |most: f64, (psi, s)| most.max((psi / s).abs())),
            defect: 0.0,
            distance: 0.0,
        };
        merit.defect = merit.defect_of(&system.values);
        merit.distance = merit.distance_of(field);
        merit
    }

    fn defect_of(&self, values: &[f64]) -> f64 {
        self.system.scaled(values).iter().map(|c| c.abs()).sum()
    }

    fn distance_of(&self, field: &[f64]) -> f64 {
        let squares = difference(field, self.data).into_iter().zip(self.weights);
        0.5 * squares.map(|(d, weight)| weight * d * d).sum::<f64>()
    }

    /// Whether a field is better than the one before, or its defect is half as large.
    fn accepts(&self, field: &[f64], values: &[f64]) -> bool {
        let defect = self.defect_of(values);
        let rounding = 1e-13 * self.distance;
        let change = self.distance_of(field) - self.distance;
        defect <= 0.5 * self.defect || self.penalty * (defect - self.defect) + change <= rounding
    }
}

impl Corrector<'_> {
    /// The next field, and the share of the linearised step that led there.
    pub(super) fn next(
        &self,
        system: &System,
        data: &[f64],
        before: &[f64],
        projection: &Projection,
    ) -> Result<(Vec<f64>, f64), SolveFault> {
        if let Some(field) = self.advance_curved(system, data, before, projection) {
            return Ok((field, 1.0));
        }
        let merit = Merit::new(system, data, &self.weights, before, &projection.multipliers);
        self.advance(&merit, before, &projection.step)
    }

    /// Takes the longest share 1, ½, ¼ … of a step that inverts no cell and that the merit accepts.
    fn advance(
        &self,
        merit: &Merit,
        before: &[f64],
        step: &[f64],
    ) -> Result<(Vec<f64>, f64), SolveFault> {
        let mut length = 1.0;
        loop {
            let steps = before.iter().zip(step);
            let field: Vec<f64> = steps.map(|(u, step)| u + length * step).collect();
            let last = length < SHORTEST_STEP;
            match self.values(&field) {
                Err(fault) if last => return Err(self.inverted(fault)),
                Ok(values) if last || merit.accepts(&field, &values) => {
                    return Ok((field, length));
                }
                _ => length *= 0.5,
            }
        }
    }

    /// A step that counts the curvature of the conditions, where it lessens the defect of the whole system;
    /// with as many conditions as unknowns the plain step is that already.
    fn advance_curved(
        &self,
        system: &System,
        data: &[f64],
        before: &[f64],
        plain: &Projection,
    ) -> Option<Vec<f64>> {
        if system.values.len() == self.weights.len() {
            return None;
        }
        let curvature = self.curvature(before, &plain.multipliers)?;
        let (jacobian, pull) = (&system.jacobian, difference(data, before));
        let curved =
            factor::project_curved(jacobian, &self.weights, &curvature, &system.values, &pull);
        let curved = curved.ok()?;
        let field: Vec<f64> = before
            .iter()
            .zip(&curved.step)
            .map(|(u, step)| u + step)
            .collect();
        let next = self.linearise(&field).ok()?;
        let after = self.imbalance(&next, data, &field, &curved.multipliers);
        let now = self.imbalance(system, data, before, &plain.multipliers);
        (after < 0.5 * now).then_some(field)
    }

    fn curvature(&self, field: &[f64], multipliers: &[f64]) -> Option<SparseRows> {
        let mut rows = vec![Vec::new(); field.len()];
        let (mut first, mut any) = (0, false);
        for condition in &self.conditions {
            let own = &multipliers[first..first + condition.rows()];
            first += condition.rows();
            if let Some(curvature) = condition.curvature(field, own).ok()? {
                any = true;
                for (row, entries) in rows.iter_mut().enumerate() {
                    entries.extend_from_slice(curvature.row(row));
                }
            }
        }
        let mut sum = SparseRows::new(field.len());
        rows.into_iter().for_each(|row| sum.push(row));
        any.then_some(sum)
    }

    /// How far a field and multipliers are from the solution, as a distance: the larger one of the scaled
    /// conditions and of W (u − ū) + Bᵀ ψ.
    fn imbalance(&self, system: &System, data: &[f64], field: &[f64], multipliers: &[f64]) -> f64 {
        let pull = system.jacobian.multiply_transposed(multipliers);
        let changes = difference(field, data);
        let forces: Vec<f64> = (0..pull.len())
            .map(|i| self.weights[i] * changes[i] + pull[i])
            .collect();
        largest(&system.scaled(&system.values)).max(largest(&forces))
    }
}
