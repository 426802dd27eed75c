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
        let w = self.law.at((a - 2.0 * b) / 3.0, z);
        let kappa = self.volume.bulk_modulus;
        let [u, du, ddu] = self.volume.energy.derivatives(a + b).map(|u| kappa * u);
        BodyDerivatives {
            energy: w.energy + u,
            a: w.m / 3.0 + du,
            z: w.z,
            b: du - w.m / 1.5,
            aa: w.mm / 9.0 + ddu,
            az: w.mz / 3.0,
            ab: ddu - w.mm / 4.5,
            zz: w.zz,
            zb: -w.mz / 1.5,
            bb: w.mm / 2.25 + ddu,
        }
    }
}
