//! Mooney–Rivlin laws of higher order.

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// The Rivlin–Saunders polynomial of second order: Mooney–Rivlin with three or five parameters.
///
/// ```text
/// Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3) + C₂₀ (I₁ − 3)² + C₁₁ (I₁ − 3)(I₂ − 3) + C₀₂ (I₂ − 3)²      [MPa]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | C₁₀, C₀₁ | `c10`, `c01` | MPa | sum > 0 | initial moduli |
/// | C₁₁ | `c11` | MPa | any | mixed term; the third of three parameters |
/// | C₂₀, C₀₂ | `c20`, `c02` | MPa | any | with five parameters |
///
/// **Limits.** Second-order terms → 0: Mooney–Rivlin. Small strain: μ₀ = 2 (C₁₀ + C₀₁).
/// **Not covered.** Negative parameters are not excluded, and fits often give them: check the stable range.
///
/// # References
/// R. S. Rivlin, D. W. Saunders, Phil. Trans. R. Soc. A 243, 251 (1951), doi:10.1098/rsta.1951.0004
#[derive(Clone, Copy, Debug, Default)]
pub struct Polynomial {
    /// C₁₀ in MPa.
    pub c10: f64,
    /// C₀₁ in MPa.
    pub c01: f64,
    /// C₂₀ in MPa.
    pub c20: f64,
    /// C₁₁ in MPa.
    pub c11: f64,
    /// C₀₂ in MPa.
    pub c02: f64,
}

impl Polynomial {
    /// Reads the parameters of a card with three parameters.
    pub fn from_card_3(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            c10: parameters.stress("c10", Bound::Any),
            c01: parameters.stress("c01", Bound::Any),
            c11: parameters.stress("c11", Bound::Any),
            ..Self::default()
        })
    }

    /// Reads the parameters of a card with five parameters.
    pub fn from_card_5(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            c10: parameters.stress("c10", Bound::Any),
            c01: parameters.stress("c01", Bound::Any),
            c20: parameters.stress("c20", Bound::Any),
            c11: parameters.stress("c11", Bound::Any),
            c02: parameters.stress("c02", Bound::Any),
        })
    }
}

impl InvariantLaw for Polynomial {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let (a, b) = (invariants.i1_minus_3, invariants.i2_minus_3);
        EnergyDerivatives {
            energy: a * (self.c10 + self.c20 * a + self.c11 * b) + b * (self.c01 + self.c02 * b),
            d1: self.c10 + 2.0 * self.c20 * a + self.c11 * b,
            d2: self.c01 + self.c11 * a + 2.0 * self.c02 * b,
            d11: 2.0 * self.c20,
            d12: self.c11,
            d22: 2.0 * self.c02,
        }
    }

    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let [a, b] = [("c10", self.c10), ("c01", self.c01)];
        let [x, y, z] = [("c20", self.c20), ("c11", self.c11), ("c02", self.c02)];
        let (febio, d) = (code == Code::FeBio, 2.0 / bulk);
        match [x, y, z].map(|parameter| parameter.1) == [0.0; 3] {
            false if febio => CodeLaw::named("polynomial", [a, b, x, y, z, ("D1", bulk / 2.0)]),
            false => CodeLaw::named("POLYNOMIAL, N=2", [a, b, x, y, z, ("D1", d), ("D2", d)]),
            true if febio => CodeLaw::named(
                "Mooney-Rivlin",
                [("c1", self.c10), ("c2", self.c01), ("k", bulk)],
            ),
            true if self.c01 == 0.0 => CodeLaw::named("NEO HOOKE", [a, ("D1", d)]),
            true => CodeLaw::named("MOONEY-RIVLIN", [a, b, ("D1", d)]),
        }
    }
}
