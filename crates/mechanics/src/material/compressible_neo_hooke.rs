//! Neo-Hooke laws of bodies that change their volume.

use super::body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
use super::law::HyperelasticLaw;
use super::logarithm::logarithm_remainder;
use super::parameters::Parameters;
use super::sheet::PlaneState;
use super::volume::{VolumeEnergy, lame_modulus};

/// Neo-Hooke laws whose energy is not split into an isochoric and a volumetric part.
///
/// ```text
/// W = ½ μ (I₁ − 3 − 2 ln J₃) + Λ U(J₃),   I₁ = λ₁² + λ₂² + λ₃²,   J₃ = λ₁ λ₂ λ₃    [MPa = N·mm/mm³]
/// neo-hooke-simo-pister   U = ½ ln² J₃
/// neo-hooke-ciarlet       U = ¼ (J₃² − 1 − 2 ln J₃)
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | μ | `mu` | MPa | > 0 | initial shear modulus |
/// | ν | `poisson_ratio` | – | −0.9 … 0.4999 | initial Poisson's ratio; Λ = 2 μ ν/(1 − 2 ν) |
///
/// `LOGARITHM` is true for the energy of Simo and Pister.
///
/// The third variant in use, ½ μ (Ī₁ − 3) + ½ κ ln² J₃ with the isochoric invariant, is the law `neo-hooke` with the volume
/// energy `logarithmic`.
///
/// **Limits.** ν → ½ in plane stress: neo-Hooke with C₁₀ = ½ μ. Small strain: μ and Λ are Lamé's.
/// **Not covered.** Above J₃ = e the logarithmic energy of Simo and Pister is not convex in J₃: its pressure falls as the body swells further.
///
/// # References
/// J. C. Simo, K. S. Pister, Comput. Methods Appl. Mech. Eng. 46, 201 (1984), doi:10.1016/0045-7825(84)90062-8;
/// P. G. Ciarlet, Mathematical Elasticity I, North-Holland (1988), section 4.10
#[derive(Clone, Copy, Debug)]
pub struct CompressibleNeoHooke<const LOGARITHM: bool> {
    /// μ in MPa.
    pub shear_modulus: f64,
    /// Lamé's first modulus Λ in MPa.
    pub lame_modulus: f64,
}

impl<const LOGARITHM: bool> CompressibleNeoHooke<LOGARITHM> {
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

impl<const LOGARITHM: bool> BodyLaw for CompressibleNeoHooke<LOGARITHM> {
    type Shape = f64;

    #[inline(always)]
    fn shape(&self, _: f64, z: f64) -> f64 {
        z
    }

    #[inline(always)]
    fn evaluate(&self, at: BodyStretches) -> BodyDerivatives {
        let lame = self.lame_modulus;
        let energy = if LOGARITHM {
            VolumeEnergy::Logarithmic
        } else {
            VolumeEnergy::SimoTaylor
        };
        let volume = energy.derivatives::<LOGARITHM>(at.volume_change(), at.volume());
        chains(self.shear_modulus, at, volume.map(|u| lame * u))
    }
}

/// μ (½ (I₁ − 3) − ln J₃) + U(ln J₃), U given with its first two derivatives.
///
/// ```text
/// ½ (I₁ − 3 − 2 ln J₃) = J z + (J − 1 − a) + ½ (λ₃² − 1 − 2 b)
/// ```
#[inline(always)]
pub(super) fn chains(mu: f64, at: BodyStretches, [u, du, ddu]: [f64; 3]) -> BodyDerivatives {
    let (change, z, thickness) = (at.area_change, at.shape, at.thickness_change());
    let area = -logarithm_remainder(change);
    let across = 0.5 * thickness * thickness - logarithm_remainder(thickness);
    // λ₃² − 1
    let square_change = thickness * (2.0 + thickness);
    let ratio = 1.0 + change;
    BodyDerivatives {
        energy: mu * (ratio * z + area + across) + u,
        a: mu * (ratio * z + change) + du,
        z: mu * ratio,
        b: mu * square_change + du,
        aa: mu * ratio * (1.0 + z) + ddu,
        az: mu * ratio,
        ab: ddu,
        zz: 0.0,
        zb: 0.0,
        bb: 2.0 * mu * (1.0 + square_change) + ddu,
    }
}
