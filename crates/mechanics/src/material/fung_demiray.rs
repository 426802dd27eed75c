//! The exponential law of Fung and Demiray.

use super::code::{Code, CodeLaw};
use super::exponential::{exponential, exponential_less_one};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// Fung–Demiray law: the isotropic exponential law of soft tissue.
///
/// ```text
/// Ψ = μ/(2 b) (e^{b (I₁ − 3)} − 1)                             [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | initial shear modulus |
/// | b | `b` | – | > 0 | rate of stiffening |
///
/// **Limits.** b → 0: neo-Hooke with C₁₀ = μ/2. Small strain: μ₀ = μ.
/// **Not covered.** Dependence on I₂; fibres.
///
/// # References
/// H. Demiray, J. Biomech. 5, 309 (1972), doi:10.1016/0021-9290(72)90047-4
#[derive(Clone, Copy, Debug)]
pub struct FungDemiray {
    /// μ in MPa.
    pub mu: f64,
    /// b.
    pub b: f64,
}

impl FungDemiray {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            mu: parameters.stress("mu", Bound::Positive),
            b: parameters.number("b", Bound::Positive, [1e-3, 10.0]),
        })
    }
}

impl InvariantLaw for FungDemiray {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let exponent = self.b * invariants.i1_minus_3;
        let growth = exponential(exponent);
        EnergyDerivatives {
            energy: 0.5 * self.mu / self.b * exponential_less_one(exponent),
            d1: 0.5 * self.mu * growth,
            d11: 0.5 * self.mu * self.b * growth,
            ..EnergyDerivatives::default()
        }
    }

    fn in_code(&self, code: Code, _: f64) -> Option<CodeLaw> {
        CodeLaw::of_first_invariant(code)
    }
}
