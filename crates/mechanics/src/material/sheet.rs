//! The kinematics of an incompressible thin sheet in plane stress, and the response of a law Ψ(I₁, I₂).
//!
//! ```text
//! F = I + H  (2×2),   C = FᵀF,   J = det F > 0,   λ₃ = 1/J                        [–]
//! I₁ = tr C + 1/J²,   I₂ = J² + tr C/J²
//! P = ∂Ψ/∂F = Ψ₁ ∂I₁/∂F + Ψ₂ ∂I₂/∂F                                             [MPa]
//! ∂I₁/∂F = 2 (F − J⁻³ cof F),   ∂I₂/∂F = 2 (J⁻² F + (J − tr C/J³) cof F)
//! ```
//!
//! The pressure is eliminated by the free surface, σ₃₃ = 0, so the sheet behaves in its plane as an ordinary
//! compressible 2-D body, which does not lock. Ψ is even in J, so a state with J ≤ 0 may have a zero residual and yet
//! be turned inside out: it is refused here.
//!
//! Everything is computed from the displacement gradient H, in a form in which no term cancels at
//! first order, so that stress and tangent keep their digits at strains of 1e-8.
//!
//! Components are ordered 11, 12, 21, 22 in all vectors and matrices.

use nalgebra::{Matrix4, Vector4};

use super::invariants::{EnergyDerivatives, Invariants};
use crate::document::name_of;

/// Components 11, 12, 21, 22 of a tensor in the plane: a displacement gradient Hᵢⱼ = ∂uᵢ/∂Xⱼ, F = 1 + H, or a stress P.
pub type PlaneTensor = Vector4<f64>;

/// The state of the third direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlaneState {
    /// A thin sheet with free surfaces: σ₃₃ = 0.
    #[default]
    Stress,
    /// A thick body between walls: λ₃ = 1.
    Strain,
}

impl PlaneState {
    /// The names that studies use.
    pub const NAMES: [(&'static str, Self); 2] = [
        ("plane-stress", Self::Stress),
        ("plane-strain", Self::Strain),
    ];

    /// The name that studies use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }
}

/// A sheet whose in-plane area ratio J is not positive, or not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the in-plane area ratio J is not a positive number: the sheet is turned inside out or has collapsed"
)]
pub struct Inadmissible;

/// Strain measures of the sheet that follow from the displacement gradient alone.
#[derive(Clone, Copy, Debug)]
pub struct Kinematics {
    /// I₁ − 3 and I₂ − 3.
    pub invariants: Invariants,
    /// F.
    pub deformation_gradient: PlaneTensor,
    /// J − 1.
    pub area_change: f64,
    /// 2 E = C − I with the Green–Lagrange strain E: components 11, 12, 22.
    pub twice_green_lagrange: [f64; 3],
    /// F − cof F, which is zero at rest.
    pub distortion: PlaneTensor,
    /// ½ ∂I₁/∂F.
    pub half_d1: PlaneTensor,
    /// ½ ∂I₂/∂F.
    half_d2: PlaneTensor,
}

/// Energy, stress and tangent of the sheet.
#[derive(Clone, Copy, Debug)]
pub struct SheetResponse {
    /// Ψ per reference volume in mJ/mm³.
    pub energy: f64,
    /// First Piola–Kirchhoff stress P = ∂Ψ/∂F in MPa; the nominal stress is its transpose.
    pub first_piola_kirchhoff_stress: PlaneTensor,
    /// ∂P/∂F in MPa, symmetric.
    pub tangent: Matrix4<f64>,
}

/// Components of a [`SheetResponse`]: Ψ, P, and ∂P/∂F on and below the diagonal, column by column.
pub const COMPONENTS: usize = 15;

impl SheetResponse {
    /// All components.
    #[inline(always)]
    pub fn components(&self) -> [f64; COMPONENTS] {
        let (p, a) = (&self.first_piola_kirchhoff_stress, &self.tangent);
        [
            self.energy,
            p[0],
            p[1],
            p[2],
            p[3],
            a[0],
            a[1],
            a[2],
            a[3],
            a[5],
            a[6],
            a[7],
            a[10],
            a[11],
            a[15],
        ]
    }
}

impl Kinematics {
    /// The sheet at rest.
    pub fn rest() -> Self {
        Self::new(&PlaneTensor::zeros()).expect("J = 1 at rest")
    }

    /// Kinematics of the displacement gradient `h`.
    ///
    /// # Errors
    /// [`Inadmissible`] when J is not positive.
    #[inline]
    pub fn new(h: &PlaneTensor) -> Result<Self, Inadmissible> {
        let kinematics = Self::unchecked(h);
        if kinematics.is_admissible() {
            Ok(kinematics)
        } else {
            Err(Inadmissible)
        }
    }

    /// Kinematics of a displacement gradient, meaningless where J is not positive.
    #[inline(always)]
    pub fn unchecked(h: &PlaneTensor) -> Self {
        let [h11, h12, h21, h22] = [h[0], h[1], h[2], h[3]];
        let j = h11 + h22 + (h11 * h22 - h12 * h21); // J − 1
        let jacobian = 1.0 + j;
        let cofactor_h = Vector4::new(h22, -h21, -h12, h11);
        let f = identity() + h;
        let cofactor = identity() + cofactor_h;
        // C − I
        let e11 = 2.0 * h11 + h11 * h11 + h21 * h21;
        let e22 = 2.0 * h22 + h12 * h12 + h22 * h22;
        let e12 = h12 + h21 + h11 * h12 + h21 * h22;
        let a = e11 + e22; // tr C − 2
        let determinant = e11 * e22 - e12 * e12;
        let d = j * (2.0 + j); // det C − 1
        let cube = jacobian * jacobian * jacobian;
        let s = j * (3.0 + j * (3.0 + j)) / cube; // 1 − J⁻³
        let q = d / (1.0 + d); // 1 − J⁻²
        let m = j - a + s * (2.0 + a); // 1 + J − tr C/J³
        let distortion = h - cofactor_h;
        Self {
            invariants: Invariants {
                i1_minus_3: (a * d - determinant) / (1.0 + d),
                i2_minus_3: (d * d - determinant) / (1.0 + d),
            },
            deformation_gradient: f,
            area_change: j,
            twice_green_lagrange: [e11, e12, e22],
            distortion,
            half_d1: distortion + s * cofactor,
            half_d2: distortion - q * f + m * cofactor,
        }
    }

    /// Whether J is a positive number.
    #[inline(always)]
    pub fn is_admissible(&self) -> bool {
        (self.area_ratio() > 0.0) & (self.area_ratio() < f64::INFINITY)
    }

    /// J = det F, the in-plane area ratio.
    #[inline(always)]
    pub fn area_ratio(&self) -> f64 {
        1.0 + self.area_change
    }

    /// In-plane principal stretches, the larger first.
    pub fn principal_stretches(&self) -> [f64; 2] {
        let f = &self.deformation_gradient;
        // Singular values of a 2×2 matrix by its rotation-invariant halves.
        let sum = (f[0] + f[3]).hypot(f[2] - f[1]) / 2.0;
        let difference = (f[0] - f[3]).hypot(f[1] + f[2]) / 2.0;
        [sum + difference, sum - difference]
    }

    /// Kirchhoff stress τ = P Fᵀ in the plane, in MPa: components 11, 12, 22; equal to the Cauchy stress where the volume is constant.
    pub fn kirchhoff_stress(&self, first_piola_kirchhoff: &PlaneTensor) -> [f64; 3] {
        let (p, f) = (first_piola_kirchhoff, &self.deformation_gradient);
        [
            p[0] * f[0] + p[1] * f[1],
            p[0] * f[2] + p[1] * f[3],
            p[2] * f[2] + p[3] * f[3],
        ]
    }

    /// Energy and stress of a law Ψ(I₁, I₂) with the derivatives `w`.
    #[inline(always)]
    pub fn stress(&self, w: &EnergyDerivatives) -> (f64, PlaneTensor) {
        (w.energy, 2.0 * (w.d1 * self.half_d1 + w.d2 * self.half_d2))
    }

    /// Energy, stress and consistent tangent of a law Ψ(I₁, I₂) with the derivatives `w`.
    #[inline(always)]
    pub fn response(&self, w: &EnergyDerivatives) -> SheetResponse {
        let (g1, g2) = (&self.half_d1, &self.half_d2);
        let mixed = g1 * g2.transpose();
        let mut tangent = 4.0
            * (w.d11 * g1 * g1.transpose()
                + w.d12 * (mixed + mixed.transpose())
                + w.d22 * g2 * g2.transpose());
        tangent += 2.0 * (w.d1 * self.second_derivative_1());
        if w.d2 != 0.0 {
            tangent += 2.0 * (w.d2 * self.second_derivative_2());
        }
        SheetResponse {
            energy: w.energy,
            first_piola_kirchhoff_stress: 2.0 * (w.d1 * g1 + w.d2 * g2),
            tangent,
        }
    }

    /// ½ ∂²I₁/∂F² = 𝟙 + 3 J⁻⁴ cof F ⊗ cof F − J⁻³ 𝔼, where 𝔼 = ∂ cof F/∂F.
    #[inline(always)]
    pub fn second_derivative_1(&self) -> Matrix4<f64> {
        let jacobian = self.area_ratio();
        let cofactor = cofactor(&self.deformation_gradient);
        let outer = cofactor * cofactor.transpose();
        Matrix4::identity() + outer * (3.0 / jacobian.powi(4))
            - cofactor_derivative() / jacobian.powi(3)
    }

    /// ½ ∂²I₂/∂F² from ½ ∂I₂/∂F = J⁻² F + k cof F with k = J − tr C/J³.
    #[inline(always)]
    fn second_derivative_2(&self) -> Matrix4<f64> {
        let f = &self.deformation_gradient;
        let jacobian = self.area_ratio();
        let cofactor = cofactor(f);
        let trace = f.norm_squared();
        let k = jacobian - trace / jacobian.powi(3);
        let mixed = f * cofactor.transpose();
        Matrix4::identity() / jacobian.powi(2)
            - (mixed + mixed.transpose()) * (2.0 / jacobian.powi(3))
            + cofactor * cofactor.transpose() * (1.0 + 3.0 * trace / jacobian.powi(4))
            + cofactor_derivative() * k
    }
}

#[inline(always)]
fn identity() -> PlaneTensor {
    Vector4::new(1.0, 0.0, 0.0, 1.0)
}

/// cof F = ∂J/∂F.
#[inline(always)]
pub fn cofactor(f: &PlaneTensor) -> PlaneTensor {
    Vector4::new(f[3], -f[2], -f[1], f[0])
}

/// 𝔼 = ∂ cof F/∂F = ∂²J/∂F².
#[inline(always)]
pub fn cofactor_derivative() -> Matrix4<f64> {
    let mut e = Matrix4::zeros();
    (e[(0, 3)], e[(3, 0)], e[(1, 2)], e[(2, 1)]) = (1.0, 1.0, -1.0, -1.0);
    e
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Rotation2};

    use super::*;
    use crate::material::{HyperelasticLaw, NeoHooke};

    /// F = R(α) diag(λ₁, λ₂) R(β)ᵀ: the stretches are λ₁ and λ₂, and τ = 2 C₁₀ (F Fᵀ − λ₃² I).
    #[test]
    fn principal_stretches_and_kirchhoff_stress_are_those_of_the_polar_decomposition() {
        let (c10, stretches) = (0.05, [1.4, 0.8]);
        let turn = |angle: f64| Rotation2::new(angle).into_inner();
        let diagonal = Matrix2::from_diagonal(&stretches.into());
        let f = turn(0.7) * diagonal * turn(-0.3);
        let h = f - Matrix2::identity();
        let state = Kinematics::new(&Vector4::new(h.m11, h.m12, h.m21, h.m22)).unwrap();
        let through = 1.0 / (1.4 * 0.8);
        let computed = state.principal_stretches();
        for (computed, expected) in computed.into_iter().zip([1.4, 0.8]) {
            assert!((computed - expected).abs() < 1e-14, "{computed} {expected}");
        }
        let (_, p) = NeoHooke { c10 }.stress(&state);
        let b = f * f.transpose() - Matrix2::identity() * (through * through);
        let computed = state.kirchhoff_stress(&p);
        for (computed, expected) in computed.into_iter().zip([b.m11, b.m12, b.m22]) {
            assert!((computed - 2.0 * c10 * expected).abs() < 1e-15);
        }
    }
}
