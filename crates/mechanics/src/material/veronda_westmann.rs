//! The law of Veronda and Westmann.

use super::code::{Code, CodeLaw};
use super::exponential::{exponential, exponential_less_one};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// Veronda–Westmann law: exponential in I₁, with a negative term in I₂.
///
/// ```text
/// Ψ = C (e^{β (I₁ − 3)} − 1) − ½ C β (I₂ − 3)                   [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | C | `c` | MPa | > 0 | amplitude |
/// | β | `beta` | – | > 0 | rate of stiffening |
///
/// **Limits.** Small strain: μ₀ = C β.
/// **Not covered.** Stability: Ψ₂ < 0, and a positive slope of the tension curve does not mean that the sheet is
/// stable. C = 0.147 MPa and β = 0.31 nearly follow the PVA hydrogel's curve read as Cauchy stress and lose
/// stability at 61 % of uniaxial stretch.
///
/// # References
/// D. R. Veronda, R. A. Westmann, J. Biomech. 3, 111 (1970), doi:10.1016/0021-9290(70)90055-2
#[derive(Clone, Copy, Debug)]
pub struct VerondaWestmann {
    /// C in MPa.
    pub c: f64,
    /// β.
    pub beta: f64,
}

impl VerondaWestmann {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            c: parameters.stress("c", Bound::Positive),
            beta: parameters.number("beta", Bound::Positive, [1e-3, 10.0]),
        })
    }
}

impl InvariantLaw for VerondaWestmann {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let exponent = self.beta * invariants.i1_minus_3;
        let (growth, slope) = (exponential(exponent), self.c * self.beta);
        EnergyDerivatives {
            energy: self.c * exponential_less_one(exponent) - 0.5 * slope * invariants.i2_minus_3,
            d1: slope * growth,
            d2: -0.5 * slope,
            d11: slope * self.beta * growth,
            ..EnergyDerivatives::default()
        }
    }

    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let (c, beta) = (("c1", self.c), ("c2", self.beta));
        match code {
            Code::FeBio => CodeLaw::named("Veronda-Westmann", [c, beta, ("k", bulk)]),
            _ => None,
        }
    }
}
