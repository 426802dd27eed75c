//! What a hyperelastic law is: energy, stress and tangent of a sheet.

use std::sync::Arc;

use nalgebra::Matrix4;
use pulp::{Arch, NullaryFnOnce};

use super::code::{Code, CodeLaw};
use super::invariants::{EnergyDerivatives, Invariants};
use super::sheet::{Gradient, Kinematics, PlaneState, SheetResponse, cofactor};

/// A hyperelastic law, as a sheet in its plane sees it: incompressible and in plane stress unless it says otherwise.
///
/// A law of the first two invariants is an [`InvariantLaw`], which needs scalars only and becomes a
/// `HyperelasticLaw` by itself. Laws of the principal stretches and laws with fibres give the sheet's
/// response themselves. The curves of the usual tests and the stable range are derived from it once for
/// all laws, in [`super::curve`] and [`super::stability`].
pub trait HyperelasticLaw: Send + Sync + std::fmt::Debug {
    /// Energy per reference volume in mJ/mm³ and first Piola–Kirchhoff stress P = ∂Ψ/∂F in MPa.
    fn stress(&self, kinematics: &Kinematics) -> (f64, Gradient);

    /// Energy, stress and consistent tangent.
    fn response(&self, kinematics: &Kinematics) -> SheetResponse;

    /// A strip cut along the unit vector `direction` of the reference sheet, stretched by
    /// λ = 1 + `strain` while its edges are free; `strain` > −1.
    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse;

    /// Nominal stresses along both axes of a sheet stretched by 1 + ε₁ and 1 + ε₂ along them, in MPa; not
    /// numbers where a stretch is not positive.
    fn biaxial(&self, [first, second]: [f64; 2]) -> [f64; 2] {
        match Kinematics::new(&Gradient::new(first, 0.0, 0.0, second)) {
            Ok(kinematics) => {
                let (_, stress) = self.stress(&kinematics);
                [stress[0], stress[3]]
            }
            Err(_) => [f64::NAN; 2],
        }
    }

    /// P at many points at once; whether J is positive at all of them.
    ///
    /// All slices have one length.
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

    /// The components of ∂P/∂F on and below the diagonal, column by column, at many points at once; whether
    /// J is positive at all of them.
    ///
    /// All slices have one length.
    fn tangents(&self, gradients: [&[f64]; 4], mut tangents: [&mut [f64]; 10]) -> bool {
        for point in 0..gradients[0].len() {
            let h = gradients.map(|component| component[point]);
            let Ok(kinematics) = Kinematics::new(&h.into()) else {
                return false;
            };
            let lower = lower_triangle(&self.response(&kinematics).tangent);
            for (component, value) in tangents.iter_mut().zip(lower) {
                component[point] = value;
            }
        }
        true
    }

    /// The law in the words of another code; `None` where that code has no law that equals it.
    ///
    /// `bulk_modulus` in MPa stands for incompressibility; it is infinite for a code that has incompressible sheets, so
    /// that D = 2/K vanishes.
    fn in_code(&self, _code: Code, _bulk_modulus: f64) -> Option<CodeLaw> {
        None
    }

    /// J₃ = J λ₃, the volume over that at rest: 1 unless the law says otherwise.
    fn volume_ratio(&self, _kinematics: &Kinematics) -> f64 {
        1.0
    }

    /// λ₃ = J₃/J, the thickness over that at rest.
    fn thickness_stretch(&self, kinematics: &Kinematics) -> f64 {
        self.volume_ratio(kinematics) / kinematics.area_ratio()
    }

    /// ∂λ₃/∂F: −cof F/J² where the volume stays as it is.
    fn thickness_gradient(&self, kinematics: &Kinematics) -> Gradient {
        -cofactor(&kinematics.deformation_gradient) / kinematics.area_ratio().powi(2)
    }

    /// Cauchy stress σ₃₃ across the sheet in MPa; zero in plane stress.
    fn thickness_stress(&self, _kinematics: &Kinematics) -> f64 {
        0.0
    }

    /// Cauchy stress σ = P Fᵀ/J₃ in the plane, in MPa, of the first Piola–Kirchhoff stress `stress`: components 11, 12, 22.
    fn cauchy_stress(&self, kinematics: &Kinematics, stress: &Gradient) -> [f64; 3] {
        let volume = self.volume_ratio(kinematics);
        kinematics.kirchhoff_stress(stress).map(|tau| tau / volume)
    }

    /// What is known of the third direction.
    fn plane_state(&self) -> PlaneState {
        PlaneState::Stress
    }

    /// The same law in plane strain; `None` for a law without a change of volume, which has no stress there that follows from
    /// the strain.
    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        None
    }

    /// The law as one of the invariants I₁ and I₂ of a body that keeps its volume; `None` where it is none.
    fn of_invariants(self: Arc<Self>) -> Option<Arc<dyn InvariantLaw>>
    where
        Self: 'static,
    {
        None
    }

    /// Whether all directions of the sheet are alike.
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

/// An isotropic law Ψ(I₁, I₂).
///
/// A law whose Ψ₁₁ is unbounded at rest (as Marlow's) returns zero for it there: every use multiplies it
/// by a factor that vanishes faster.
pub trait InvariantLaw: Send + Sync + std::fmt::Debug {
    /// Ψ and its derivatives at the given invariants.
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives;

    /// As [`HyperelasticLaw::in_code`].
    fn in_code(&self, _code: Code, _bulk_modulus: f64) -> Option<CodeLaw> {
        None
    }
}

/// The components on and below the diagonal, column by column.
#[inline(always)]
fn lower_triangle(a: &Matrix4<f64>) -> [f64; 10] {
    [
        a[0], a[1], a[2], a[3], a[5], a[6], a[7], a[10], a[11], a[15],
    ]
}

impl<L: InvariantLaw> HyperelasticLaw for L {
    fn stresses(&self, gradients: [&[f64]; 4], stresses: [&mut [f64]; 4]) -> bool {
        Arch::new().dispatch(StressLoop {
            law: self,
            gradients,
            stresses,
        })
    }

    fn tangents(&self, gradients: [&[f64]; 4], tangents: [&mut [f64]; 10]) -> bool {
        Arch::new().dispatch(TangentLoop {
            law: self,
            gradients,
            tangents,
        })
    }

    fn of_invariants(self: Arc<Self>) -> Option<Arc<dyn InvariantLaw>>
    where
        Self: 'static,
    {
        Some(self)
    }

    fn stress(&self, kinematics: &Kinematics) -> (f64, Gradient) {
        kinematics.stress(&self.evaluate(kinematics.invariants))
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        kinematics.response(&self.evaluate(kinematics.invariants))
    }

    /// ```text
    /// P = 2 (Ψ₁ + Ψ₂/λ) (λ − λ⁻²),   I₁ = λ² + 2/λ,   I₂ = 2λ + λ⁻²
    /// ```
    fn tension(&self, _: [f64; 2], strain: f64) -> TensionResponse {
        let x = strain;
        let lambda = 1.0 + x;
        let cubic = 3.0 + 3.0 * x + x * x;
        let i1_minus_3 = x * x * (3.0 + x) / lambda;
        let i2_minus_3 = x * x * (3.0 + 2.0 * x) / (lambda * lambda);
        let w = self.evaluate(Invariants {
            i1_minus_3,
            i2_minus_3,
        });
        // λ − λ⁻² and its derivative; dI₁/dλ = 2 h, dI₂/dλ = 2 h/λ.
        let h = x * cubic / (lambda * lambda);
        let dh = 1.0 + 2.0 / lambda.powi(3);
        let secant = w.d1 + w.d2 / lambda;
        let secant_slope = 2.0 * h * (w.d11 + 2.0 * w.d12 / lambda + w.d22 / (lambda * lambda))
            - w.d2 / (lambda * lambda);
        TensionResponse {
            energy: w.energy,
            nominal_stress: 2.0 * secant * h,
            slope: 2.0 * (secant * dh + secant_slope * h),
        }
    }

    fn in_code(&self, code: Code, bulk_modulus: f64) -> Option<CodeLaw> {
        InvariantLaw::in_code(self, code, bulk_modulus)
    }

    /// μ₀ = 2 (Ψ₁ + Ψ₂) at rest.
    fn shear_modulus(&self) -> f64 {
        let rest = self.evaluate(Invariants {
            i1_minus_3: 0.0,
            i2_minus_3: 0.0,
        });
        2.0 * (rest.d1 + rest.d2)
    }

    fn youngs_modulus(&self) -> f64 {
        3.0 * self.shear_modulus()
    }
}

/// Straight-line code for each point: the compiler makes one instruction of several points, with the widest
/// vectors that the machine has. No operation is fused with another, so that all machines give the same bits.
struct StressLoop<'a, L> {
    law: &'a L,
    gradients: [&'a [f64]; 4],
    stresses: [&'a mut [f64]; 4],
}

impl<L: InvariantLaw> NullaryFnOnce for StressLoop<'_, L> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let points = self.gradients[0].len();
        let [h11, h12, h21, h22] = self.gradients.map(|component| &component[..points]);
        let [p11, p12, p21, p22] = self.stresses.map(|component| &mut component[..points]);
        let mut inverted = 0_u64;
        for point in 0..points {
            let h = Gradient::new(h11[point], h12[point], h21[point], h22[point]);
            let kinematics = Kinematics::unchecked(&h);
            let (_, p) = kinematics.stress(&self.law.evaluate(kinematics.invariants));
            (p11[point], p12[point]) = (p[0], p[1]);
            (p21[point], p22[point]) = (p[2], p[3]);
            inverted |= u64::from(!kinematics.is_admissible());
        }
        inverted == 0
    }
}

/// As [`StressLoop`].
struct TangentLoop<'a, L> {
    law: &'a L,
    gradients: [&'a [f64]; 4],
    tangents: [&'a mut [f64]; 10],
}

impl<L: InvariantLaw> NullaryFnOnce for TangentLoop<'_, L> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let points = self.gradients[0].len();
        let [h11, h12, h21, h22] = self.gradients.map(|component| &component[..points]);
        let [a0, a1, a2, a3, a4, a5, a6, a7, a8, a9] =
            self.tangents.map(|component| &mut component[..points]);
        let mut inverted = 0_u64;
        for point in 0..points {
            let h = Gradient::new(h11[point], h12[point], h21[point], h22[point]);
            let kinematics = Kinematics::unchecked(&h);
            let response = kinematics.response(&self.law.evaluate(kinematics.invariants));
            let lower = lower_triangle(&response.tangent);
            (a0[point], a1[point], a2[point]) = (lower[0], lower[1], lower[2]);
            (a3[point], a4[point], a5[point]) = (lower[3], lower[4], lower[5]);
            (a6[point], a7[point]) = (lower[6], lower[7]);
            (a8[point], a9[point]) = (lower[8], lower[9]);
            inverted |= u64::from(!kinematics.is_admissible());
        }
        inverted == 0
    }
}
