//! Gent's law of limited chain extensibility.

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::logarithm::logarithm_of_one_plus;
use super::parameters::Parameters;
use crate::document::Bound;

/// Gent's law: the stress grows without bound as I₁ − 3 approaches Jₘ.
///
/// ```text
/// Ψ = −½ μ Jₘ ln(1 − (I₁ − 3)/Jₘ)                              [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | initial shear modulus |
/// | Jₘ | `jm` | – | > 0 | largest I₁ − 3 |
///
/// **Limits.** Jₘ → ∞: neo-Hooke with C₁₀ = μ/2. Small strain: μ₀ = μ.
/// **Not covered.** States with I₁ − 3 ≥ Jₘ have no energy: models refuse them like inverted cells.
///
/// # References
/// A. N. Gent, Rubber Chem. Technol. 69, 59 (1996), doi:10.5254/1.3538357
#[derive(Clone, Copy, Debug)]
pub struct Gent {
    /// μ in MPa.
    pub mu: f64,
    /// Jₘ.
    pub jm: f64,
}

impl Gent {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            mu: parameters.stress("mu", Bound::Positive),
            jm: parameters.number("jm", Bound::Positive, [1.0, 300.0]),
        })
    }
}

impl InvariantLaw for Gent {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let share = invariants.i1_minus_3 / self.jm;
        // Beyond the limit there is no stress, though the formula gives one.
        let remaining = if share < 1.0 { 1.0 - share } else { f64::NAN };
        EnergyDerivatives {
            energy: -0.5 * self.mu * self.jm * logarithm_of_one_plus(-share),
            d1: 0.5 * self.mu / remaining,
            d11: 0.5 * self.mu / (self.jm * remaining * remaining),
            ..EnergyDerivatives::default()
        }
    }

    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        match code {
            Code::FeBio => CodeLaw::named("Gent", [("G", self.mu), ("Jm", self.jm), ("k", bulk)]),
            _ => CodeLaw::of_first_invariant(code),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::sheet::{Kinematics, PlaneTensor};

    #[test]
    fn beyond_the_limit_there_is_neither_energy_nor_stress() {
        let law = Gent { mu: 0.1, jm: 20.0 };
        let stress = |stretch: f64| {
            let across = 1.0 / stretch.sqrt();
            let gradient = PlaneTensor::new(stretch - 1.0, 0.0, 0.0, across - 1.0);
            let (energy, stress) = law.stress(&Kinematics::new(&gradient).unwrap());
            [energy, stress[0]]
        };
        assert!(stress(4.7).iter().all(|value| *value > 0.0));
        assert!(stress(4.9).iter().all(|value| value.is_nan()));
    }
}
