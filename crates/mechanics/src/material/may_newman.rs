//! The law of May-Newman and Yin.

use std::f64::consts::FRAC_PI_2;

use super::anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
use super::jet::Jet;
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// The law of May-Newman and Yin for leaflets of the mitral valve: one family of fibres in the plane, with a neo-Hookean
/// matrix that may be left out.
///
/// ```text
/// Ψ = μ/2 (I₁ − 3) + c₀ (e^{c₁ (I₁ − 3)² + c₂ (√I₄ − 1)⁴} − 1),   I₄ = |F a|²   [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | ≥ 0 | initial shear modulus; zero is the published law |
/// | c₀ | `c0` | MPa | > 0 | scale of the stress |
/// | c₁ | `c1` | – | ≥ 0 | stiffening of the matrix |
/// | c₂ | `c2` | – | ≥ 0 | stiffening of the fibres, stretched or pressed |
/// | θ | `angle` | angle | any | between the fibres and the first axis |
///
/// The published energy begins with the fourth power of the strain: without μ nothing resists the first strain. Such a
/// law is fitted, compared and drawn, but no study can begin with it.
///
/// **Limits.** c₂ = 0: isotropic. Small strain: μ₀ = μ.
/// **Not covered.** Two families, dispersion. No code has this law.
///
/// # References
/// K. May-Newman, F. C. P. Yin, J. Biomech. Eng. 120, 38 (1998), doi:10.1115/1.2834305
#[derive(Clone, Copy, Debug)]
pub struct MayNewman {
    /// μ in MPa.
    pub mu: f64,
    /// c₀ in MPa.
    pub c0: f64,
    /// c₁.
    pub c1: f64,
    /// c₂.
    pub c2: f64,
}

impl MayNewman {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let law = Self {
            mu: parameters.stress("mu", Bound::NonNegative),
            c0: parameters.stress("c0", Bound::Positive),
            c1: parameters.number("c1", Bound::NonNegative, [0.1, 100.0]),
            c2: parameters.number("c2", Bound::NonNegative, [1.0, 1e5]),
        };
        let angle = parameters.angle("angle", [-FRAC_PI_2, FRAC_PI_2]);
        AnisotropicSheet::boxed(law, angle)
    }
}

impl AnisotropicLaw for MayNewman {
    #[inline(always)]
    fn energy(&self, [i1, c11, ..]: [Jet; 4]) -> Jet {
        let stretch = (1.0 + c11.value).sqrt();
        let slope = 0.5 / stretch;
        let extension = c11.composed([
            c11.value / (1.0 + stretch), // √I₄ − 1
            slope,
            -0.5 * slope / (stretch * stretch),
        ]);
        let exponent = self.c1 * i1.squared() + self.c2 * extension.squared().squared();
        0.5 * self.mu * i1 + self.c0 * exponent.exponential_less_one()
    }

    fn is_isotropic(&self) -> bool {
        self.c2 == 0.0
    }
}
