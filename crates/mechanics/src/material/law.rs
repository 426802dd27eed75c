//! The interface of hyperelastic laws: energy, stress and tangent of a sheet.

use std::sync::Arc;

use super::code::{Code, CodeLaw};
use super::sheet::{COMPONENTS, Kinematics, PlaneState, PlaneTensor, SheetResponse, cofactor};
use super::softening::Softening;
use super::volume::Volume;

/// A hyperelastic law as the response of a sheet in its plane: incompressible and in plane stress unless the law states otherwise.
///
/// A law of the first two invariants is an [`InvariantLaw`](super::InvariantLaw), which needs scalars only and is a
/// `HyperelasticLaw` automatically. Laws of the principal stretches and laws with fibres implement the sheet's
/// response themselves. The curves of the usual tests and the stable range are derived from it once for all laws, in
/// [`super::curve`] and [`super::stability`].
pub trait HyperelasticLaw: Send + Sync + std::fmt::Debug {
    /// Energy per reference volume in mJ/mm³ and first Piola–Kirchhoff stress P = ∂Ψ/∂F in MPa.
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor);

    /// Energy, stress and consistent tangent.
    fn response(&self, kinematics: &Kinematics) -> SheetResponse;

    /// A strip cut along the unit vector `direction` of the reference sheet, stretched by
    /// λ = 1 + `strain` while its edges are free; `strain` > −1.
    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse;

    /// Nominal stresses along both axes of a sheet stretched by 1 + ε₁ and 1 + ε₂ along them, in MPa; NaN where a stretch is not positive.
    fn biaxial(&self, [first, second]: [f64; 2]) -> [f64; 2] {
        match Kinematics::new(&PlaneTensor::new(first, 0.0, 0.0, second)) {
            Ok(kinematics) => {
                let (_, stress) = self.stress(&kinematics);
                [stress[0], stress[3]]
            }
            Err(_) => [f64::NAN; 2],
        }
    }

    /// P at many points at once; returns whether J is positive at all of them.
    ///
    /// All slices have the same length.
    fn stresses(&self, gradients: [&[f64]; 4], stresses: [&mut [f64]; 4]) -> bool {
        let [p11, p12, p21, p22] = stresses;
        for point in 0..p11.len() {
            let h = gradients.map(|component| component[point]);
            let Ok(kinematics) = Kinematics::new(&h.into()) else {
                return false;
            };
            let (_, p) = self.stress(&kinematics);
            (p11[point], p12[point]) = (p[0], p[1]);
            (p21[point], p22[point]) = (p[2], p[3]);
        }
        true
    }

    /// Energy, P and the components of ∂P/∂F on and below the diagonal, column by column, at many points at once;
    /// returns whether J is positive at all of them. Where no tangents are asked for, they may be left as they are.
    ///
    /// All slices have the same length.
    fn responses(
        &self,
        gradients: [&[f64]; 4],
        mut responses: [&mut [f64]; COMPONENTS],
        tangents: bool,
    ) -> bool {
        for point in 0..gradients[0].len() {
            let h = gradients.map(|component| component[point]);
            let Ok(kinematics) = Kinematics::new(&h.into()) else {
                return false;
            };
            let mut set = |values: &[f64]| {
                for (component, value) in responses.iter_mut().zip(values) {
                    component[point] = *value;
                }
            };
            if tangents {
                set(&self.response(&kinematics).components());
            } else {
                let (energy, p) = self.stress(&kinematics);
                set(&[energy, p[0], p[1], p[2], p[3]]);
            }
        }
        true
    }

    /// The law in the form of another code; `None` where that code has no equal law.
    ///
    /// `bulk_modulus` in MPa represents incompressibility; it is infinite for a code that has incompressible sheets, so that D = 2/K vanishes.
    fn in_code(&self, _code: Code, _bulk_modulus: f64) -> Option<CodeLaw> {
        None
    }

    /// J₃ = J λ₃, the volume relative to that at rest: 1 unless the law states otherwise.
    fn volume_ratio(&self, _kinematics: &Kinematics) -> f64 {
        1.0
    }

    /// λ₃ = J₃/J, the thickness relative to that at rest.
    fn thickness_stretch(&self, kinematics: &Kinematics) -> f64 {
        self.volume_ratio(kinematics) / kinematics.area_ratio()
    }

    /// ∂λ₃/∂F: −cof F/J² where the volume is constant.
    fn thickness_gradient(&self, kinematics: &Kinematics) -> PlaneTensor {
        -cofactor(&kinematics.deformation_gradient) / kinematics.area_ratio().powi(2)
    }

    /// Cauchy stress σ₃₃ across the sheet in MPa; zero in plane stress.
    fn thickness_stress(&self, _kinematics: &Kinematics) -> f64 {
        0.0
    }

    /// Cauchy stress σ = P Fᵀ/J₃ in the plane, in MPa, of the first Piola–Kirchhoff stress `stress`: components 11, 12, 22.
    fn cauchy_stress(&self, kinematics: &Kinematics, stress: &PlaneTensor) -> [f64; 3] {
        let volume = self.volume_ratio(kinematics);
        kinematics.kirchhoff_stress(stress).map(|tau| tau / volume)
    }

    /// The state of the third direction.
    fn plane_state(&self) -> PlaneState {
        PlaneState::Stress
    }

    /// Whether the law is valid only for strains and rotations that are small against 1.
    fn is_for_small_strains(&self) -> bool {
        false
    }

    /// The same law in plane strain; `None` for a law without a change of volume, whose stress there does not follow from the strain.
    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        None
    }

    /// The initial bulk modulus κ in MPa; `None` for a law whose volume is constant.
    fn bulk_modulus(&self) -> Option<f64> {
        None
    }

    /// A law that keeps its volume, extended by a resistance to a change of volume; `None` where there is no such law.
    fn with_volume(self: Arc<Self>, _volume: Volume) -> Option<Arc<dyn HyperelasticLaw>>
    where
        Self: 'static,
    {
        None
    }

    /// Softening by the largest load so far; `None` for a material without memory. Energy, stress and tangent of a
    /// card's law are those of the first loading, from which the softened ones follow.
    fn softening(&self) -> Option<Softening> {
        None
    }

    /// Whether a rotation of the deformed sheet rotates its stress and has no other effect.
    fn is_objective(&self) -> bool {
        true
    }

    /// Consequences of the parameters that are reported beside them: names and sentences.
    fn statements(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// The length of the freely swollen gel, at rest here, over that as prepared; 1 where nothing swells.
    fn swelling_stretch(&self) -> f64 {
        1.0
    }

    /// Whether all directions of the sheet are equivalent.
    fn is_isotropic(&self) -> bool {
        true
    }

    /// The initial shear modulus μ₀ in the axes of the sheet, in MPa.
    fn shear_modulus(&self) -> f64 {
        self.response(&Kinematics::rest()).tangent[(1, 1)]
    }

    /// The initial Young's modulus E₀ along the first axis, in MPa; 3 μ₀ where the law is isotropic.
    fn youngs_modulus(&self) -> f64 {
        self.tension([1.0, 0.0], 0.0).slope
    }
}

/// Methods of a law that are those of the law in a field of it: `forwarded! { virgin: fn bulk_modulus() -> Option<f64>; }`.
#[macro_export]
macro_rules! forwarded {
    ($within:ident: $(fn $method:ident($($given:ident: $kind:ty),*) -> $result:ty;)*) => {
        $(fn $method(&self, $($given: $kind),*) -> $result {
            self.$within.$method($($given),*)
        })*
    };
}

/// Energy, stress and slope of a tension curve at one stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensionResponse {
    /// Ψ in mJ/mm³.
    pub energy: f64,
    /// Nominal stress P in MPa.
    pub nominal_stress: f64,
    /// dP/dλ in MPa.
    pub slope: f64,
}

/// Points that are evaluated side by side.
pub(super) const LANES: usize = 16;

/// Copies the results at `count` points to the positions from `first` on.
#[inline(always)]
pub(super) fn store<const N: usize>(
    all: &mut [&mut [f64]; N],
    computed: &[[f64; LANES]; N],
    first: usize,
    count: usize,
) {
    for (all, computed) in all.iter_mut().zip(computed) {
        all[first..first + count].copy_from_slice(&computed[..count]);
    }
}
