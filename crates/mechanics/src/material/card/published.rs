//! The published curve behind a card.

use super::Card;
use crate::material::curve::Mode;
use crate::material::parameters::{StrainMeasure, StressMeasure};
use crate::material::sheet::PlaneState;

impl Card {
    /// The published tension curve σ₀ + A e^{b ε} behind the card as nominal stress in MPa, with its
    /// stress at rest; `None` for cards that are not made from such a curve.
    pub fn published_nominal_stress(&self, stretch: f64) -> Option<f64> {
        let [amplitude, exponent, offset] =
            ["amplitude", "exponent", "offset"].map(|key| self.parameter(key));
        let strain = match self.strain_measure {
            StrainMeasure::Nominal => stretch - 1.0,
            StrainMeasure::Logarithmic => stretch.ln(),
        };
        let stress = offset? + amplitude? * (exponent? * strain).exp();
        Some(match self.stress_measure {
            StressMeasure::Nominal => stress,
            StressMeasure::Cauchy => stress / stretch,
        })
    }

    /// Distance of the law's tension curve from the published one without its stress at rest, over the range of the
    /// card: largest difference in % of the largest stress. `None` in plane strain, where no strip is pulled.
    pub fn fit_error_percent(&self) -> Option<f64> {
        if self.law.plane_state() == PlaneState::Strain {
            return None;
        }
        let at_rest = self.published_nominal_stress(1.0)?;
        let [low, high] = self.stretch_range;
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for i in 0..=200 {
            let stretch = low + (high - low) * f64::from(i) / 200.0;
            let offset = match self.stress_measure {
                StressMeasure::Nominal => at_rest,
                StressMeasure::Cauchy => at_rest / stretch,
            };
            let published = self.published_nominal_stress(stretch)? - offset;
            let law = Mode::Uniaxial.nominal_stress(&*self.law, stretch - 1.0);
            worst = worst.max((law - published).abs());
            largest = largest.max(published.abs());
        }
        Some(100.0 * worst / largest)
    }
}
