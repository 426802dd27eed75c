//! Sheets made of an isotropic body that changes its volume.
//!
//! A law of such a body is a function of three numbers of a sheet's deformation, which are all zero at rest:
//!
//! ```text
//! W(a, z, b),   a = ln J,   z = (tr C − 2J)/(2J) = cosh(ln λ₁/λ₂) − 1,   b = ln λ₃           [MPa = mJ/mm³]
//! ```
//!
//! C = FᵀF and J = det F are in-plane quantities; J₃ = e^(a + b). In plane stress the thickness follows from the free
//! surface, and is condensed; the result is a law of a and z:
//!
//! ```text
//! λ₃ P₃₃ = W_b = 0,   W̄_i = W_i − W_ib W_b/W_bb,   W̄_ij = W_ij − W_ib W_jb/W_bb              [MPa]
//! ```
//!
//! In plane strain b = 0. `measures` computes stress and tangent of a law of a and z.
//!
//! Derivatives with respect to a and b are sums of terms that vanish at rest, so no digit is lost at strains of 1e-8. At small strain, W_bb =
//! κ + 4/3 μ and W_z = μ.
//!
//! # References
//! J. C. Simo, R. L. Taylor, Comput. Methods Appl. Mech. Eng. 85, 273 (1991), doi:10.1016/0045-7825(91)90100-K

use std::fmt::Debug;
use std::sync::Arc;

use super::curve;
use super::exponential::exponential_less_one;
use super::law::{HyperelasticLaw, TensionResponse};
use super::logarithm::logarithm_of_one_plus;
use super::measures::{Derivatives, Measures};
use super::sheet::{COMPONENTS, Kinematics, PlaneState, PlaneTensor, SheetResponse};

mod points;
mod thickness;

/// The stretches of a body. Of a, z and b only z is stored as such: a law that is rational in J and λ₃ needs no logarithm.
///
/// ```text
/// J₃ = (1 + q)³,   λ₃ = J₃/J,   a = ln J,   b = 3 ln(1 + q) − a                                     [–]
/// ```
///
/// `S` is the value that a law computes from J and z once for all thicknesses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyStretches<S = f64> {
    /// J − 1.
    pub area_change: f64,
    /// The value of [`BodyLaw::shape`] for J and z = (tr C − 2J)/(2J).
    pub shape: S,
    /// q = J₃^⅓ − 1.
    pub volume_root_change: f64,
}

impl<S> BodyStretches<S> {
    /// J₃ − 1.
    #[inline(always)]
    pub fn volume_change(&self) -> f64 {
        let q = self.volume_root_change;
        q * (3.0 + q * (3.0 + q))
    }

    /// ln J₃ = a + b.
    #[inline(always)]
    pub fn volume(&self) -> f64 {
        3.0 * logarithm_of_one_plus(self.volume_root_change)
    }

    /// λ₃ − 1.
    #[inline(always)]
    pub fn thickness_change(&self) -> f64 {
        (self.volume_change() - self.area_change) / (1.0 + self.area_change)
    }
}

/// The energy per reference volume of a body and its derivatives with respect to a, z and b, in MPa.
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyDerivatives {
    /// W.
    pub energy: f64,
    /// W_a.
    pub a: f64,
    /// W_z.
    pub z: f64,
    /// W_b.
    pub b: f64,
    /// W_aa.
    pub aa: f64,
    /// W_az.
    pub az: f64,
    /// W_ab.
    pub ab: f64,
    /// W_zz.
    pub zz: f64,
    /// W_zb.
    pub zb: f64,
    /// W_bb.
    pub bb: f64,
}

/// An isotropic law of a body that changes its volume. [`BodySheet`] is the sheet made of it.
pub trait BodyLaw: Clone + Send + Sync + Debug {
    /// The value computed once from J and z before the search for the thickness: z itself, unless other costly terms depend on it.
    type Shape: Copy + Send + Sync + Debug;

    /// Computes that value from J − 1 and z.
    fn shape(&self, area_change: f64, z: f64) -> Self::Shape;

    /// W and its derivatives.
    fn evaluate(&self, at: BodyStretches<Self::Shape>) -> BodyDerivatives;

    /// W_b alone, for the search for a thickness; NaN where W has no value.
    fn thickness_slope(&self, at: BodyStretches<Self::Shape>) -> f64 {
        let w = self.evaluate(at);
        if w.energy.is_finite() { w.b } else { f64::NAN }
    }

    /// As [`HyperelasticLaw::statements`].
    fn statements(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// As [`HyperelasticLaw::swelling_stretch`].
    fn swelling_stretch(&self) -> f64 {
        1.0
    }
}

/// A sheet of a body that changes its volume, in plane stress or in plane strain.
#[derive(Clone, Debug)]
pub struct BodySheet<L> {
    law: L,
    plane: PlaneState,
    /// ln J₃ = 3 (c₁ a + c₂ a² + c₃ a³ + c₄ z + c₅ a z) where W_b = 0, to the third order of the strain, with 2 (J −
    /// 1)/(J + 1) for a: the search for q begins there.
    series: [f64; 5],
}

impl<L: BodyLaw> BodySheet<L> {
    /// A sheet of a law.
    pub fn new(law: L, plane: PlaneState) -> Self {
        let rest = law.evaluate(BodyStretches {
            area_change: 0.0,
            shape: law.shape(0.0, 0.0),
            volume_root_change: 0.0,
        });
        let first = (1.0 - rest.ab / rest.bb) / 3.0;
        let sheet = Self {
            law,
            plane,
            series: [first, 0.0, 0.0, 0.0, 0.0],
        };
        if plane == PlaneState::Stress && first.is_finite() {
            sheet.with_series()
        } else {
            sheet
        }
    }

    /// q with which the sheet's surfaces satisfy its plane state.
    #[inline(always)]
    fn at<const N: usize>(
        &self,
        area_change: &[f64; N],
        z: &[f64; N],
        shapes: &[L::Shape; N],
    ) -> [f64; N] {
        match self.plane {
            PlaneState::Stress => self.free_surface(area_change, z, shapes),
            PlaneState::Strain => {
                area_change.map(|change| exponential_less_one(logarithm_of_one_plus(change) / 3.0))
            }
        }
    }

    fn state(
        &self,
        kinematics: &Kinematics,
    ) -> (Measures, BodyStretches<L::Shape>, BodyDerivatives) {
        let measures = Measures::new(kinematics);
        let (area_change, shape) = (
            kinematics.area_change,
            self.law.shape(kinematics.area_change, measures.z),
        );
        let [volume_root_change] = self.at(&[area_change], &[measures.z], &[shape]);
        let mut stretches = BodyStretches {
            area_change,
            shape,
            volume_root_change,
        };
        let w = self.law.evaluate(stretches);
        if self.plane == PlaneState::Stress {
            // The residual of the search for b.
            stretches.volume_root_change -= (1.0 + volume_root_change) * w.b / (3.0 * w.bb);
        }
        (measures, stretches, w)
    }

    #[inline(always)]
    fn shapes<const N: usize>(&self, area_change: &[f64; N], z: &[f64; N]) -> [L::Shape; N] {
        std::array::from_fn(|lane| self.law.shape(area_change[lane], z[lane]))
    }

    /// The tension of a strip with free edges in plane stress, where λ₂ = λ₃ leave W_b = 0 alone: Newton's method for ln λ₂. `None` where it
    /// ends elsewhere.
    fn strip(&self, strain: f64) -> Option<TensionResponse> {
        const STEPS: usize = 30;
        const LAST_STEP: f64 = 1e-9;
        if self.plane == PlaneState::Strain {
            return None;
        }
        let along = strain.ln_1p();
        let mut across = -0.5 * along;
        for _ in 0..STEPS {
            let gradient = PlaneTensor::new(strain, 0.0, 0.0, across.exp_m1());
            let kinematics = Kinematics::new(&gradient).ok()?;
            let measures = Measures::new(&kinematics);
            let w = self.law.evaluate(BodyStretches {
                area_change: kinematics.area_change,
                shape: self.law.shape(kinematics.area_change, measures.z),
                volume_root_change: ((along + 2.0 * across) / 3.0).exp_m1(),
            });
            let slope = w.ab + w.bb - w.zb * (along - across).sinh();
            let step = w.b / slope;
            if !step.is_finite() || slope <= 0.0 || w.bb <= 0.0 {
                return None;
            }
            if step.abs() <= LAST_STEP * across.abs() {
                let response = measures.response(&self.condensed(&w));
                return curve::free_of_lateral_stress(&response);
            }
            across -= step.clamp(-0.5, 0.5);
        }
        None
    }

    fn rest(&self) -> BodyDerivatives {
        self.state(&Kinematics::rest()).2
    }

    /// The condensed law of a and z.
    #[inline(always)]
    fn condensed(&self, w: &BodyDerivatives) -> Derivatives {
        // No branch, so that loops are vectorised.
        let free = if self.plane == PlaneState::Stress {
            1.0 / w.bb
        } else {
            0.0
        };
        // The residual of the search for b.
        let relaxed = w.b * free;
        Derivatives {
            energy: w.energy - 0.5 * w.b * relaxed,
            m: w.a - w.ab * relaxed,
            z: w.z - w.zb * relaxed,
            mm: w.aa - w.ab * w.ab * free,
            mz: w.az - w.ab * w.zb * free,
            zz: w.zz - w.zb * w.zb * free,
        }
    }
}

impl<L: BodyLaw + 'static> HyperelasticLaw for BodySheet<L> {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let (measures, _, w) = self.state(kinematics);
        let w = self.condensed(&w);
        (w.energy, measures.stress(&w))
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let (measures, _, w) = self.state(kinematics);
        measures.response(&self.condensed(&w))
    }

    fn stresses(&self, gradients: [&[f64]; 4], stresses: [&mut [f64]; 4]) -> bool {
        self.stresses_at(gradients, stresses)
    }

    fn responses(
        &self,
        gradients: [&[f64]; 4],
        responses: [&mut [f64]; COMPONENTS],
        _tangents: bool,
    ) -> bool {
        self.responses_at(gradients, responses)
    }

    fn tension(&self, _: [f64; 2], strain: f64) -> TensionResponse {
        let asymmetric = || curve::tension(&|kinematics| self.response(kinematics), strain);
        self.strip(strain).unwrap_or_else(asymmetric)
    }

    fn volume_ratio(&self, kinematics: &Kinematics) -> f64 {
        kinematics.area_ratio() * self.thickness_stretch(kinematics)
    }

    fn thickness_stretch(&self, kinematics: &Kinematics) -> f64 {
        1.0 + self.state(kinematics).1.thickness_change()
    }

    fn thickness_gradient(&self, kinematics: &Kinematics) -> PlaneTensor {
        match self.plane {
            PlaneState::Stress => {
                let (measures, stretches, w) = self.state(kinematics);
                let thickness = 1.0 + stretches.thickness_change();
                -thickness / w.bb * (w.ab * measures.dm + w.zb * measures.dz)
            }
            PlaneState::Strain => PlaneTensor::zeros(),
        }
    }

    fn thickness_stress(&self, kinematics: &Kinematics) -> f64 {
        match self.plane {
            PlaneState::Stress => 0.0,
            PlaneState::Strain => self.state(kinematics).2.b / kinematics.area_ratio(),
        }
    }

    fn plane_state(&self) -> PlaneState {
        self.plane
    }

    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        Some(Arc::new(Self {
            plane: PlaneState::Strain,
            ..self.clone()
        }))
    }

    fn statements(&self) -> Vec<(&'static str, String)> {
        self.law.statements()
    }

    fn swelling_stretch(&self) -> f64 {
        self.law.swelling_stretch()
    }

    /// κ = W_bb − 4/3 μ at rest.
    fn bulk_modulus(&self) -> Option<f64> {
        let rest = self.rest();
        Some(rest.bb - 4.0 / 3.0 * rest.z)
    }

    /// μ₀ = W_z at rest.
    fn shear_modulus(&self) -> f64 {
        self.rest().z
    }
}
