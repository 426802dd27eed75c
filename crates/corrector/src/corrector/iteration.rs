//! The repeated projection: steps until the conditions are satisfied.

use super::acceleration::accelerate;
use super::correction::{Correction, CorrectorSettings, Step};
use super::factor::Factor;
use super::system::Corrector;
use crate::error::SolveFault;
use crate::solve::vector::{difference, largest};

impl Corrector<'_> {
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
        let (field, steps) = accelerate(self, data, start, factor)?;
        self.finish(data, field, steps)
    }

    /// Takes steps with a fresh factor each, until the tolerance is met.
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
            // Near enough to the data, only the conditions have to be met.
            let (target, projection) = if moved <= movement {
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
}
