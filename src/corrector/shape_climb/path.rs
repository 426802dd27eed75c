//! Many load factors, each near the one before.

use super::Climb;
use super::field::ShapeClimb;
use super::systems::Aim;
use crate::corrector::extrapolation::{Known, value_shares};
use crate::error::Error;
use crate::solve::Loading;
use crate::solve::vector::add_scaled;

/// The expected field at a load factor; `None` where nothing is known.
fn expected(known: &Known<Vec<f64>>, factor: f64) -> Option<Vec<f64>> {
    let mut field = vec![0.0; known.fields.first()?.len()];
    for (share, own) in value_shares(&known.parameters, factor)
        .iter()
        .zip(&known.fields)
    {
        add_scaled(&mut field, *share, own);
    }
    Some(field)
}

impl Climb<'_> {
    /// Corrects at many load factors, one after the other: the first and the last by a climb, which also gives the
    /// discretisation error, the others from the states before them, extrapolated, with the tangents of earlier
    /// states as long as they serve.
    ///
    /// # Errors
    /// [`Error::Solve`] with the load factor at which no field was found, after the states before it were reported;
    /// [`Error::Input`] where a mesh does not suit the problem.
    pub fn follow(
        &mut self,
        factors: &[f64],
        told: &mut dyn FnMut(&ShapeClimb),
    ) -> Result<(), Error> {
        let [first, others @ ..] = factors else {
            return Ok(());
        };
        // Where the last state cannot be reached, this is reported in its turn.
        let mut last = others.last().and_then(|last| {
            let climbed = self.correct(*last).ok()?;
            Some((climbed, self.systems.as_ref()?.scale))
        });
        let begun = self.correct(*first)?;
        let mut errors = [f64::NAN; 2];
        if let Some(systems) = &mut self.systems {
            let scale = last.as_ref().map_or(systems.scale, |(_, scale)| *scale);
            errors = [systems.scale.discretisation, scale.discretisation];
            // A state at rest gives no ratio.
            for own in 0..2 {
                if errors[own].is_nan() {
                    errors[own] = errors[1 - own];
                }
            }
            systems.scale = systems.scale.and(scale);
        }
        let whole = others.last().map_or(0.0, |last| last - first);
        let error_at = |factor: f64| match (factor - first) / whole {
            share if share.is_finite() => {
                errors[0] + share.clamp(0.0, 1.0) * (errors[1] - errors[0])
            }
            _ => errors[0],
        };
        let mut known = Known::none();
        known.take(*first, begun.state.displacement.clone());
        told(&begun);
        for (place, factor) in others.iter().enumerate() {
            let climbed = match last.take_if(|_| place + 1 == others.len()) {
                Some((climbed, _)) => climbed,
                None => self.after(&known, *factor, error_at(*factor))?,
            };
            known.take(*factor, climbed.state.displacement.clone());
            told(&climbed);
        }
        Ok(())
    }

    /// The state at a load factor from those before, with a discretisation error relative to the size of the field; where they do not lead there, by
    /// a climb of its own.
    fn after(
        &mut self,
        known: &Known<Vec<f64>>,
        factor: f64,
        error: f64,
    ) -> Result<ShapeClimb, Error> {
        let (levels, systems) = (&self.levels, &mut self.systems);
        if let (Some(systems), Some(mut start)) = (systems, expected(known, factor)) {
            systems.scale.discretisation = error;
            let model = levels.model(levels.finest())?;
            model.impose(factor, &mut start);
            let aim = Aim {
                factor,
                start,
                load_factor: factor,
            };
            if let Some(climbed) = systems.reach(levels, &model, aim) {
                return Ok(climbed);
            }
        }
        let scale = self.systems.as_ref().map(|own| own.scale);
        let climbed = self.correct(factor)?;
        if let (Some(systems), Some(scale)) = (&mut self.systems, scale) {
            systems.scale = systems.scale.and(scale);
        }
        Ok(climbed)
    }
}
