//! The eight-chain law of Arruda and Boyce.

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// Arruda–Boyce law: the first five terms of the eight-chain network's energy.
///
/// ```text
/// Ψ = μ Σ Cᵢ λₘ^(2 − 2i) (I₁ⁱ − 3ⁱ),   i = 1 … 5               [MPa = N·mm/mm³]
/// C = ½, 1/20, 11/1050, 19/7000, 519/673750
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | modulus of the network |
/// | λₘ | `lambda_m` | – | > 1 | locking stretch of a chain |
///
/// I₁ⁱ − 3ⁱ = (I₁ − 3) Σ I₁ʲ 3^(i−1−j), a sum of positive terms, so that no digit is lost near rest.
///
/// **Limits.** λₘ → ∞: neo-Hooke with C₁₀ = μ/2.
/// Small strain: μ₀ = μ (1 + 3/(5 λₘ²) + 99/(175 λₘ⁴) + 513/(875 λₘ⁶) + 42039/(67375 λₘ⁸)).
/// **Not covered.** Dependence on I₂; the series does not lock as the network does.
///
/// # References
/// E. M. Arruda, M. C. Boyce, J. Mech. Phys. Solids 41, 389 (1993), doi:10.1016/0022-5096(93)90013-6
#[derive(Clone, Copy, Debug)]
pub struct ArrudaBoyce {
    /// μ in MPa.
    pub mu: f64,
    /// λₘ.
    pub lambda_m: f64,
}

const COEFFICIENTS: [f64; 5] = [
    1.0 / 2.0,
    1.0 / 20.0,
    11.0 / 1050.0,
    19.0 / 7000.0,
    519.0 / 673_750.0,
];

impl ArrudaBoyce {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        Box::new(Self {
            mu: parameters.stress("mu", Bound::Positive),
            lambda_m: parameters.number("lambda_m", Bound::Within(1.0, 1e6), [1.05, 20.0]),
        })
    }
}

impl InvariantLaw for ArrudaBoyce {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let (y, i1) = (invariants.i1_minus_3, 3.0 + invariants.i1_minus_3);
        let mut sum = EnergyDerivatives::default();
        // Σ I₁ʲ 3^(i−1−j), I₁^(i−1), I₁^(i−2), λₘ^(2−2i) of the term i.
        let (mut quotient, mut power, mut lower, mut shrink) = (1.0, 1.0, 0.0, self.mu);
        for (index, coefficient) in COEFFICIENTS.into_iter().enumerate() {
            let i = index as f64 + 1.0;
            let scale = shrink * coefficient;
            sum.energy += scale * y * quotient;
            sum.d1 += scale * i * power;
            sum.d11 += scale * i * (i - 1.0) * lower;
            quotient = 3.0 * quotient + power * i1;
            (lower, power) = (power, power * i1);
            shrink /= self.lambda_m * self.lambda_m;
        }
        sum
    }

    /// In FEBio's law of this name the coefficients are i times those of the publication.
    fn in_code(&self, code: Code, bulk: f64) -> Option<CodeLaw> {
        let (mu, lambda) = (("mu", self.mu), ("lambda_m", self.lambda_m));
        match code {
            Code::FeBio => None,
            _ => CodeLaw::named("ARRUDA-BOYCE", [mu, lambda, ("D", 2.0 / bulk)]),
        }
    }
}
