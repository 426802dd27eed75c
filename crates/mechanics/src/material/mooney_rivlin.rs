//! The two-parameter Mooney–Rivlin law.

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use super::polynomial::Polynomial;
use crate::document::Bound;

/// Mooney–Rivlin law: energy linear in both invariants.
///
/// ```text
/// Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3)                    [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | C₁₀ | `c10` | MPa | any | first-invariant modulus |
/// | C₀₁ | `c01` | MPa | any | second-invariant modulus; the law is unstable from rest where C₁₀ + C₀₁ ≤ 0 |
///
/// **Limits.** C₀₁ → 0: neo-Hooke. Small strain: μ₀ = 2 (C₁₀ + C₀₁).
/// **Not covered.** Strain hardening: no admissible pair follows an exponential curve such as that of
/// PVA hydrogel. Free least squares to the paper's Eq. 24 gives C₀₁ < 0, unstable from zero strain.
///
/// # References
/// M. Mooney, J. Appl. Phys. 11, 582 (1940), doi:10.1063/1.1712836
#[derive(Clone, Copy, Debug)]
pub struct MooneyRivlin {
    /// C₁₀ in MPa.
    pub c10: f64,
    /// C₀₁ in MPa.
    pub c01: f64,
}

impl MooneyRivlin {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            c10: parameters.stress("c10", Bound::Any),
            c01: parameters.stress("c01", Bound::Any),
        })
    }
}

impl InvariantLaw for MooneyRivlin {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        EnergyDerivatives {
            energy: self.c10 * invariants.i1_minus_3 + self.c01 * invariants.i2_minus_3,
            d1: self.c10,
            d2: self.c01,
            ..EnergyDerivatives::default()
        }
    }

    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let equal = Polynomial {
            c10: self.c10,
            c01: self.c01,
            ..Polynomial::default()
        };
        InvariantLaw::in_code(&equal, code, bulk)
    }
}
