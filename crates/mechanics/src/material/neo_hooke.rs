//! The neo-Hooke law.

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use super::polynomial::Polynomial;
use crate::document::Bound;

/// Neo-Hooke law: energy linear in the first invariant, the entropy elasticity of an ideal network.
///
/// ```text
/// Ψ = C₁₀ (I₁ − 3)                                    [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | C₁₀ | `c10` | MPa | > 0 | half the shear modulus |
///
/// **Limits.** Small strain: μ₀ = 2 C₁₀, E₀ = 6 C₁₀.
/// **Not covered.** Strain hardening: the nominal stress grows at most linearly with the stretch.
///
/// # References
/// L. R. G. Treloar, Trans. Faraday Soc. 39, 241 (1943), doi:10.1039/TF9433900241
#[derive(Clone, Copy, Debug)]
pub struct NeoHooke {
    /// C₁₀ in MPa.
    pub c10: f64,
}

impl NeoHooke {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            c10: parameters.stress("c10", Bound::Positive),
        })
    }
}

impl InvariantLaw for NeoHooke {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        EnergyDerivatives {
            energy: self.c10 * invariants.i1_minus_3,
            d1: self.c10,
            ..EnergyDerivatives::default()
        }
    }

    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let equal = Polynomial {
            c10: self.c10,
            ..Polynomial::default()
        };
        InvariantLaw::in_code(&equal, code, bulk)
    }
}
