//! The law of Saint Venant and Kirchhoff.

use super::body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use super::sheet::PlaneState;
use super::volume::lame_modulus;

/// The law of Saint Venant and Kirchhoff: Hooke's law in Green's strain.
///
/// ```text
/// W = ½ Λ (tr E)² + μ E : E,   E = ½ (FᵀF − 1)                                  [MPa = N·mm/mm³]
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | shear modulus |
/// | ν | `poisson_ratio` | – | −0.9 … 0.4999 | initial Poisson's ratio; Λ = 2 μ ν/(1 − 2 ν) |
///
/// **Limits.** Small strain with large rotations: linear elasticity.
/// **Not covered.** Compression: the stress of a strip falls again below λ = √⅓ = 0.577, a body pressed flat has no stress, and
/// in plane stress a sheet whose Green strains add up to more than ½ (1 − ν)/ν has no thickness that keeps its surfaces free.
/// The law is one for small strains; its stable range is reported.
///
/// # References
/// G. Kirchhoff, Sitzungsber. Akad. Wiss. Wien 9, 762 (1852);
/// A. Raoult, Aplikace Matematiky 31, 417 (1986), doi:10.21136/AM.1986.104220
#[derive(Clone, Copy, Debug)]
pub struct SaintVenantKirchhoff {
    /// μ in MPa.
    pub shear_modulus: f64,
    /// Λ in MPa.
    pub lame_modulus: f64,
}

impl SaintVenantKirchhoff {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let [shear_modulus, poisson_ratio] = parameters.shear_modulus_and_ratio();
        let law = Self {
            shear_modulus,
            lame_modulus: lame_modulus(shear_modulus, poisson_ratio),
        };
        Box::new(BodySheet::new(law, PlaneState::Stress))
    }
}

impl BodyLaw for SaintVenantKirchhoff {
    type Shape = f64;

    #[inline(always)]
    fn shape(&self, _: f64, z: f64) -> f64 {
        z
    }

    /// With g = tr C − 2 in the plane and h = λ₃² − 1:
    ///
    /// ```text
    /// 2 tr E = g + h,   4 E : E = g² − 2 (J − 1)² + 4 J z + h²,   g = 2 J z + 2 (J − 1)
    /// ```
    #[inline(always)]
    fn evaluate(&self, at: BodyStretches) -> BodyDerivatives {
        let (z, mu, lame) = (at.shape, self.shear_modulus, self.lame_modulus);
        let (change, thickness) = (at.area_change, at.thickness_change());
        let h = thickness * (2.0 + thickness);
        let ratio = 1.0 + change;
        let g = 2.0 * (ratio * z + change);
        let (trace, square) = (2.0 + g, 1.0 + h);
        let sum = g + h;
        BodyDerivatives {
            energy: lame / 8.0 * sum * sum
                + mu / 4.0 * (g * g - 2.0 * change * change + 4.0 * ratio * z + h * h),
            a: lame / 4.0 * sum * trace + mu * (0.5 * g * trace - ratio * (change - z)),
            z: ratio * (0.5 * lame * sum + mu * (g + 1.0)),
            b: square * (0.5 * lame * sum + mu * h),
            aa: lame / 4.0 * trace * (trace + sum)
                + mu * (0.5 * trace * (trace + g) - ratio * (ratio + change - z)),
            az: ratio * (0.5 * lame * (trace + sum) + mu * (trace + g + 1.0)),
            ab: 0.5 * lame * trace * square,
            zz: ratio * ratio * (lame + 2.0 * mu),
            zb: lame * ratio * square,
            bb: square * (lame * (square + sum) + 2.0 * mu * (square + h)),
        }
    }
}
