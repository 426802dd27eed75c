//! Laws of bodies that keep their volume, with a resistance to a change of it.
//!
//! ```text
//! W = Ψ(λ̄₁, λ̄₂, λ̄₃) + U(J₃),   λ̄ᵢ = J₃^(−⅓) λᵢ,   J₃ = J λ₃                       [MPa = mJ/mm³]
//! ```
//!
//! **Derivation.** λ̄₁ and λ̄₂ are the stretches of a sheet that keeps its volume, of the same shape z and the area ratio e^s with
//! s = (a − 2 b)/3; so any law Ψ(s, z) of such a sheet becomes one of the body.
//!
//! # References
//! P. J. Flory, Trans. Faraday Soc. 57, 829 (1961), doi:10.1039/TF9615700829

use std::fmt::Debug;
use std::sync::Arc;

use super::body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
use super::law::HyperelasticLaw;
use super::measures::Derivatives;
use super::volume::Volume;

/// The sheet of a law with a resistance to a change of volume.
pub fn sheet<L: IsochoricLaw + 'static>(law: Arc<L>, volume: Volume) -> Arc<dyn HyperelasticLaw> {
    Arc::new(BodySheet::new(FlorySplit { law, volume }, volume.plane))
}

/// An isotropic law of a sheet that keeps its volume, by s = ln J and z.
pub trait IsochoricLaw: Send + Sync + Debug {
    /// Ψ and its derivatives by s and z.
    fn at(&self, s: f64, z: f64) -> Derivatives;
}

/// W = Ψ(s, z) + U(J₃).
#[derive(Debug)]
struct FlorySplit<L> {
    law: Arc<L>,
    volume: Volume,
}

impl<L> Clone for FlorySplit<L> {
    fn clone(&self) -> Self {
        Self {
            law: Arc::clone(&self.law),
            volume: self.volume,
        }
    }
}

impl<L: IsochoricLaw> BodyLaw for FlorySplit<L> {
    #[inline(always)]
    fn evaluate(&self, at: BodyStretches) -> BodyDerivatives {
        let (a, z, b) = (at.area, at.shape, at.thickness);
        const THIRD: f64 = 1.0 / 3.0;
        let w = self.law.at(THIRD * (a - 2.0 * b), z);
        let kappa = self.volume.bulk_modulus;
        let [u, du, ddu] = self.volume.energy.derivatives(a + b).map(|u| kappa * u);
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
