//! The repeated projection: steps until the conditions are satisfied.

use super::correction::{Correction, Step};
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
}
