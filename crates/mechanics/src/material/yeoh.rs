//! Yeoh's law.

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// Yeoh's law: a cubic in the first invariant.
///
/// ```text
/// Ψ = C₁₀ (I₁ − 3) + C₂₀ (I₁ − 3)² + C₃₀ (I₁ − 3)³              [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | C₁₀ | `c10` | MPa | > 0 | initial modulus |
/// | C₂₀ | `c20` | MPa | any | softening where negative |
/// | C₃₀ | `c30` | MPa | any | stiffening at large stretch where positive |
///
/// **Limits.** C₂₀, C₃₀ → 0: neo-Hooke. Small strain: μ₀ = 2 C₁₀.
/// **Not covered.** Dependence on I₂.
///
/// # References
/// O. H. Yeoh, Rubber Chem. Technol. 66, 754 (1993), doi:10.5254/1.3538343
#[derive(Clone, Copy, Debug)]
pub struct Yeoh {
    /// C₁₀, C₂₀, C₃₀ in MPa.
    pub coefficients: [f64; 3],
}

impl Yeoh {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            coefficients: [
                parameters.stress("c10", Bound::Positive),
                parameters.stress("c20", Bound::Any),
                parameters.stress("c30", Bound::Any),
            ],
        })
    }
}

impl InvariantLaw for Yeoh {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let ([c1, c2, c3], y) = (self.coefficients, invariants.i1_minus_3);
        EnergyDerivatives {
            energy: y * (c1 + y * (c2 + y * c3)),
            d1: c1 + y * (2.0 * c2 + 3.0 * y * c3),
            d11: 2.0 * c2 + 6.0 * y * c3,
            ..EnergyDerivatives::default()
        }
    }

    /// FEBio's law of this name is left out: in some versions its stress is not that of its energy.
    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let ([c1, c2, c3], d) = (self.coefficients, 2.0 / bulk);
        let [d1, d2, d3] = [("D1", d), ("D2", d), ("D3", d)];
        match code {
            Code::FeBio => None,
            _ => CodeLaw::named("YEOH", [("C10", c1), ("C20", c2), ("C30", c3), d1, d2, d3]),
        }
    }
}
