//! Laws of bodies that keep their volume, extended by a resistance to a change of volume.
//!
//! ```text
//! W = Ψ(λ̄₁, λ̄₂, λ̄₃) + U(J₃),   λ̄ᵢ = J₃^(−⅓) λᵢ,   J₃ = J λ₃                       [MPa = mJ/mm³]
//! ```
//!
//! **Derivation.** λ̄₁ and λ̄₂ are the stretches of a sheet that keeps its volume, with the same shape z and the area
//! ratio e^s, s = (a − 2 b)/3; any law Ψ(s, z) of such a sheet therefore becomes a law of the body.
//!
//! # References
//! P. J. Flory, Trans. Faraday Soc. 57, 829 (1961), doi:10.1039/TF9615700829

use std::fmt::Debug;
use std::sync::Arc;

use super::body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
use super::law::HyperelasticLaw;
use super::measures::Derivatives;
use super::volume::{Volume, VolumeEnergy};

/// The sheet of a law with a resistance to a change of volume.
pub fn sheet<L: IsochoricLaw + 'static>(law: Arc<L>, volume: Volume) -> Arc<dyn HyperelasticLaw> {
    match volume.energy {
        VolumeEnergy::Logarithmic => Arc::new(BodySheet::new(
            FlorySplit::<_, true> { law, volume },
            volume.plane,
        )),
        VolumeEnergy::Quadratic | VolumeEnergy::SimoTaylor => Arc::new(BodySheet::new(
            FlorySplit::<_, false> { law, volume },
            volume.plane,
        )),
    }
}

/// An isotropic law of a sheet that keeps its volume, as a function of s = ln J and z.
pub trait IsochoricLaw: Send + Sync + Debug {
    /// As [`BodyLaw::Shape`].
    type Shape: Copy + Send + Sync + Debug;

    /// As [`BodyLaw::shape`], from z alone.
    fn shape(&self, z: f64) -> Self::Shape;

    /// Ψ and its derivatives with respect to s and z, where e^s − 1 is `area_change`.
    fn at(&self, area_change: f64, shape: Self::Shape) -> Derivatives;
}

/// W = Ψ(s, z) + U(J₃). Whether U' has a logarithm is known in advance, which saves time where it has none.
#[derive(Debug)]
struct FlorySplit<L, const LOGARITHM: bool> {
    law: Arc<L>,
    volume: Volume,
}

impl<L, const LOGARITHM: bool> Clone for FlorySplit<L, LOGARITHM> {
    fn clone(&self) -> Self {
        Self {
            law: Arc::clone(&self.law),
            volume: self.volume,
        }
    }
}

impl<L: IsochoricLaw, const LOGARITHM: bool> BodyLaw for FlorySplit<L, LOGARITHM> {
    type Shape = L::Shape;

    #[inline(always)]
    fn shape(&self, _: f64, z: f64) -> L::Shape {
        self.law.shape(z)
    }

    /// e^s = J/J₃^⅔.
    #[inline(always)]
    fn evaluate(&self, at: BodyStretches<L::Shape>) -> BodyDerivatives {
        const THIRD: f64 = 1.0 / 3.0;
        let q = at.volume_root_change;
        let area_change = (at.area_change - q * (2.0 + q)) / ((1.0 + q) * (1.0 + q));
        let w = self.law.at(area_change, at.shape);
        let kappa = self.volume.bulk_modulus;
        let derivatives = self
            .volume
            .energy
            .derivatives::<LOGARITHM>(at.volume_change(), at.volume());
        let [u, du, ddu] = derivatives.map(|u| kappa * u);
        let (m, mz, mm) = (THIRD * w.m, THIRD * w.mz, THIRD * THIRD * w.mm);
        BodyDerivatives {
            energy: w.energy + u,
            a: m + du,
            z: w.z,
            b: du - 2.0 * m,
            aa: mm + ddu,
            az: mz,
            ab: ddu - 2.0 * mm,
            zz: w.zz,
            zb: -2.0 * mz,
            bb: 4.0 * mm + ddu,
        }
    }
}
