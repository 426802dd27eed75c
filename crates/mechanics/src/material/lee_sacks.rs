//! The law of Lee, Sacks and others.

use std::f64::consts::FRAC_PI_2;

use super::anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
use super::jet::Jet;
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use crate::document::Bound;

/// The law of Lee, Sacks and others for leaflets of heart valves: a matrix and one family of fibres that stiffen
/// exponentially, shared by δ.
///
/// ```text
/// Ψ = c₁₀/2 (I₁ − 3) + c₀/2 (δ e^{c₁ (I₁ − 3)²} + (1 − δ) e^{c₂ ⟨I₄ − 1⟩²} − 1)    [MPa = N·mm/mm³]
/// I₄ = |F a|²,   ⟨x⟩ = max(x, 0)
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | c₁₀ | `c10` | MPa | > 0 | initial shear modulus of the matrix |
/// | c₀ | `c0` | MPa | ≥ 0 | scale of the exponential terms |
/// | c₁ | `c1` | – | > 0 | stiffening of the matrix |
/// | c₂ | `c2` | – | > 0 | stiffening of the fibres |
/// | δ | `delta` | – | 0 … 1 | share of the matrix in the exponential terms |
/// | θ | `angle` | angle | any | between the fibres and the first axis |
///
/// Fibres carry in tension only; at rest the tangent is that of stretched fibres.
///
/// **Limits.** δ = 1: isotropic. c₀ = 0: neo-Hooke with C₁₀ = c₁₀/2.
/// **Not covered.** Two families, dispersion. FEBio has the isotropic limit alone.
///
/// # References
/// C.-H. Lee, R. Amini, R. C. Gorman, J. H. Gorman, M. S. Sacks, J. Biomech. 47, 2055 (2014),
/// doi:10.1016/j.jbiomech.2013.10.058; with the neo-Hookean term and these factors ½: M. C. H. Wu et al., J. Biomech.
/// 74, 23 (2018), doi:10.1016/j.jbiomech.2018.04.012
#[derive(Clone, Copy, Debug)]
pub struct LeeSacks {
    /// c₁₀ in MPa.
    pub c10: f64,
    /// c₀ in MPa.
    pub c0: f64,
    /// c₁.
    pub c1: f64,
    /// c₂.
    pub c2: f64,
    /// δ.
    pub delta: f64,
}

impl LeeSacks {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let law = Self {
            c10: parameters.stress("c10", Bound::Positive),
            c0: parameters.stress("c0", Bound::NonNegative),
            c1: parameters.number("c1", Bound::Positive, [0.1, 100.0]),
            c2: parameters.number("c2", Bound::Positive, [0.1, 100.0]),
            delta: parameters.number("delta", Bound::Within(0.0, 1.0), [0.0, 1.0]),
        };
        let angle = parameters.angle("angle", [-FRAC_PI_2, FRAC_PI_2]);
        AnisotropicSheet::boxed(law, angle)
    }
}

impl AnisotropicLaw for LeeSacks {
    #[inline(always)]
    fn energy(&self, [i1, c11, ..]: [Jet; 4]) -> Jet {
        let matrix = (self.c1 * i1.squared()).exponential_less_one();
        let fibres = (self.c2 * c11.positive().squared()).exponential_less_one();
        let stiffening = self.delta * matrix + (1.0 - self.delta) * fibres;
        0.5 * self.c10 * i1 + 0.5 * self.c0 * stiffening
    }

    fn is_isotropic(&self) -> bool {
        self.c0 == 0.0 || self.delta == 1.0
    }
}
