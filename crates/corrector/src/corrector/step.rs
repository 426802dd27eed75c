//! The repeated projection: steps from one field to the next until the conditions are satisfied.

use super::correction::{Correction, Step};
use super::factor::{Factor, Projection, project_curved};
use super::system::{Corrector, SHORTEST_STEP, System};
use crate::error::SolveFault;
use crate::solve::SparseRows;
use crate::solve::vector::{difference, largest, moved};

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

/// How often a long step is moved back onto the conditions before it is shortened.
const MOST_RETURNS: usize = 4;

impl Corrector<'_> {
    /// Corrects the field `data` (ū), beginning at `start`.
    ///
    /// Never start at noisy data: the conditions are linearised about the start.
    ///
    /// # Errors
    /// A [`SolveFault`] when the start is inverted, conditions depend on each other, or the steps end
    /// without meeting the tolerance.
    pub fn correct(&self, data: &[f64], start: &[f64]) -> Result<Correction, SolveFault> {
        let (mut field, mut steps) = (start.to_vec(), Vec::new());
        let (settings, mut length) = (self.settings, 1.0);
        loop {
            let system = self.linearise(&field)?;
            let mut factor = self.factorise(&system)?;
            let projection = factor
                .project(&system.values, &difference(data, &field))
                .map_err(|fault| fault.or(self.dependent(&system)))?;
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
            });
            if residual <= settings.tolerance && moved <= settings.movement {
                return Ok(Correction {
                    steps,
                    multipliers: self.by_condition(&projection.multipliers),
                    factor,
                });
            }
            if steps.len() > settings.max_steps {
                return Err(SolveFault::Stalled {
                    iterations: settings.max_steps,
                    residual,
                    tolerance: settings.tolerance,
                });
            }
            // Near enough to the data, only the conditions have to be met.
            let (target, projection) = if moved <= settings.movement {
                let still = vec![0.0; before.len()];
                let back = factor.project(&system.values, &still);
                let back = back.map_err(|fault| fault.or(self.dependent(&system)))?;
                (&before[..], back)
            } else {
                (data, projection)
            };
            (field, length) = self.next(&system, &mut factor, target, &before, &projection)?;
        }
    }

    /// The next field, and the share of the linearised step that led there.
    fn next(
        &self,
        system: &System,
        factor: &mut Factor,
        data: &[f64],
        before: &[f64],
        projection: &Projection,
    ) -> Result<(Vec<f64>, f64), SolveFault> {
        let merit = Merit::new(system, data, &self.weights, before, &projection.multipliers);
        match self.advance_curved(&merit, factor, before, projection) {
            Some(next) => Ok(next),
            None => self.advance(&merit, factor, before, &projection.step),
        }
    }

    /// Takes the longest share 1, ½, ¼ … of a step that inverts no cell and that the merit accepts.
    fn advance(
        &self,
        merit: &Merit,
        factor: &mut Factor,
        before: &[f64],
        step: &[f64],
    ) -> Result<(Vec<f64>, f64), SolveFault> {
        let mut length = 1.0;
        while length > SHORTEST_STEP {
            if let Some(field) = self.try_step(merit, factor, before, step, length) {
                return Ok((field, length));
            }
            length *= 0.5;
        }
        let field = moved(before, length, step);
        let inverted = self.values(&field).map_err(|fault| self.inverted(fault));
        inverted.map(|_| (field, length))
    }

    /// The field at a share of a step, if the merit accepts it as it is, or moved back onto the conditions:
    /// along a curved set of admissible fields, a long step leaves the set by the square of its length.
    fn try_step(
        &self,
        merit: &Merit,
        factor: &mut Factor,
        before: &[f64],
        step: &[f64],
        length: f64,
    ) -> Option<Vec<f64>> {
        let mut field = moved(before, length, step);
        let mut values = self.values(&field).ok()?;
        for _ in 0..MOST_RETURNS {
            if merit.accepts(&field, &values) {
                return Some(field);
            }
            // The linearised conditions ask for a part of the step in proportion to its length only.
            let asked = merit.system.values.iter().map(|c| (1.0 - length) * c);
            let excess: Vec<f64> = values
                .iter()
                .zip(asked)
                .map(|(c, required)| c - required)
                .collect();
            let back = factor.project(&excess, &vec![0.0; field.len()]).ok()?;
            let returned = moved(&field, 1.0, &back.step);
            let next = self.values(&returned).ok()?;
            if merit.defect_of(&next) > 0.5 * merit.defect_of(&values) {
                return None;
            }
            (field, values) = (returned, next);
        }
        merit.accepts(&field, &values).then_some(field)
    }

    /// A step that takes account of the curvature of the conditions, or a part of it where all of it leads uphill.
    /// With as many conditions as unknowns the plain step already does.
    fn advance_curved(
        &self,
        merit: &Merit,
        factor: &mut Factor,
        before: &[f64],
        plain: &Projection,
    ) -> Option<(Vec<f64>, f64)> {
        const PARTS: [f64; 4] = [1.0, 0.5, 0.25, 0.125];
        const LENGTHS: [f64; 3] = [1.0, 0.5, 0.25];
        let (system, data) = (merit.system, merit.data);
        if system.values.len() == self.weights.len() {
            return None;
        }
        let curvature = self.curvature(before, &plain.multipliers)?;
        let pull = difference(data, before);
        let (jacobian, values) = (&system.jacobian, &system.values);
        let imbalance = self.imbalance(system, data, before, &plain.multipliers);
        for part in PARTS {
            let scaled = curvature.scaled(&vec![part; before.len()]);
            let curved = project_curved(jacobian, &self.weights, &scaled, values, &pull);
            let Ok(curved) = curved else { continue };
            // Near the solution the merit no longer resolves a good step; the imbalance does.
            let field = moved(before, 1.0, &curved.step);
            if let Ok(next) = self.linearise(&field)
                && self.imbalance(&next, data, &field, &curved.multipliers) < 0.5 * imbalance
            {
                return Some((field, 1.0));
            }
            for length in LENGTHS {
                if let Some(field) = self.try_step(merit, factor, before, &curved.step, length) {
                    return Some((field, length));
                }
            }
        }
        None
    }

    fn curvature(&self, field: &[f64], multipliers: &[f64]) -> Option<SparseRows> {
        let mut rows = vec![Vec::new(); field.len()];
        let (mut first, mut any) = (0, false);
        for condition in &self.conditions {
            let multipliers_of_condition = &multipliers[first..first + condition.rows()];
            first += condition.rows();
            if let Some(curvature) = condition.curvature(field, multipliers_of_condition).ok()? {
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
