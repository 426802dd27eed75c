//! How materials resist a change of their volume.
//!
//! ```text
//! W = Ψ(λ̄₁, λ̄₂, λ̄₃) + U(J₃),   λ̄ᵢ = J₃^(−⅓) λᵢ,   J₃ = J λ₃                       [MPa = mJ/mm³]
//! quadratic     U = ½ κ (J₃ − 1)²
//! logarithmic   U = ½ κ ln² J₃
//! simo-taylor   U = ¼ κ (J₃² − 1 − 2 ln J₃)
//! ```
//!
//! Ψ is the law of a body that keeps its volume. At small strain all three energies are the same: E = 9 κ μ/(3 κ + μ) and
//! ν = (3 κ − 2 μ)/(2 (3 κ + μ)); the law without volume change is the limit κ → ∞ of the sheet in plane stress. Above J₃ = e the
//! pressure of the logarithmic energy falls again.
//!
//! # References
//! P. J. Flory, Trans. Faraday Soc. 57, 829 (1961), doi:10.1039/TF9615700829;
//! S. Doll, K. Schweizerhof, J. Appl. Mech. 67, 17 (2000), doi:10.1115/1.321146;
//! J. C. Simo, R. L. Taylor, Comput. Methods Appl. Mech. Eng. 85, 273 (1991), doi:10.1016/0045-7825(91)90100-K

use super::logarithm::logarithm_remainder;
use super::sheet::PlaneState;
use crate::document::{Bound, name_of};

/// The largest Poisson's ratio of a material that changes its volume.
pub const LARGEST_POISSON_RATIO: f64 = 0.4999;

/// The Poisson's ratios of a material that changes its volume.
pub const POISSON_RATIO: Bound = Bound::Range(
    -0.9,
    LARGEST_POISSON_RATIO,
    "between -0.9 and 0.4999; incompressible laws have none",
);

/// How a material resists a change of its volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// κ in MPa.
    pub bulk_modulus: f64,
    /// U.
    pub energy: VolumeEnergy,
    /// The state of the third direction.
    pub plane: PlaneState,
}

/// The energy of a change of volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VolumeEnergy {
    /// ½ κ (J₃ − 1)²
    #[default]
    Quadratic,
    /// ½ κ ln² J₃
    Logarithmic,
    /// ¼ κ (J₃² − 1 − 2 ln J₃)
    SimoTaylor,
}

impl VolumeEnergy {
    /// The names that cards use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("quadratic", Self::Quadratic),
        ("logarithmic", Self::Logarithmic),
        ("simo-taylor", Self::SimoTaylor),
    ];

    /// The name that cards use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }

    /// U/κ and its first two derivatives with respect to ln J₃, from J₃ − 1 and ln J₃. All energies are evaluated and weighted, because a branch
    /// would keep loops over many points from being vectorised. `LOGARITHM` states in advance whether the energy is the logarithmic one, because a
    /// logarithm is costly.
    #[inline(always)]
    pub(super) fn derivatives<const LOGARITHM: bool>(
        self,
        change: f64,
        logarithm: f64,
    ) -> [f64; 3] {
        debug_assert_eq!(LOGARITHM, self == Self::Logarithmic);
        let weight = |energy: Self| if self as u8 == energy as u8 { 1.0 } else { 0.0 };
        let [quadratic, plain, simo_taylor] =
            [Self::Quadratic, Self::Logarithmic, Self::SimoTaylor].map(weight);
        let slope_of_logarithm = if LOGARITHM { logarithm } else { 0.0 };
        // J₃ − 1 − ln J₃, and ½ (J₃ − 1)²
        let remainder = -logarithm_remainder(change);
        let ratio = 1.0 + change;
        let half = 0.5 * change * change;
        [
            quadratic * half
                + plain * 0.5 * logarithm * logarithm
                + simo_taylor * 0.5 * (remainder + half),
            quadratic * change * ratio + plain * slope_of_logarithm + simo_taylor * (change + half),
            quadratic * ratio * (ratio + change) + plain + simo_taylor * ratio * ratio,
        ]
    }
}

impl Volume {
    /// The same resistance in plane strain.
    #[must_use]
    pub fn in_plane_strain(self) -> Self {
        Self {
            plane: PlaneState::Strain,
            ..self
        }
    }
}

/// The moduli of a material at small strain; of one with fibres, in the axes of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmallStrain {
    /// E in MPa.
    pub youngs_modulus: f64,
    /// ν; ½ where the volume is constant.
    pub poisson_ratio: f64,
    /// μ in MPa.
    pub shear_modulus: f64,
    /// K in MPa; infinite where the volume is constant.
    pub bulk_modulus: f64,
}

/// κ in MPa from a shear modulus in MPa and Poisson's ratio ν < ½.
///
/// ```text
/// κ = 2 μ (1 + ν)/(3 (1 − 2 ν))
/// ```
pub fn bulk_modulus(shear_modulus: f64, poisson_ratio: f64) -> f64 {
    2.0 * shear_modulus * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))
}

/// Lamé's first modulus in MPa from a shear modulus in MPa and Poisson's ratio.
///
/// ```text
/// Λ = 2 μ ν/(1 − 2 ν)
/// ```
pub fn lame_modulus(shear_modulus: f64, poisson_ratio: f64) -> f64 {
    2.0 * shear_modulus * poisson_ratio / (1.0 - 2.0 * poisson_ratio)
}
