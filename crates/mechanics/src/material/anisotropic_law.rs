//! Laws of the first invariant and of the strain in the axes of the material.

use nalgebra::Matrix4;

use super::code::{Code, CodeLaw};
use super::curve;
use super::jet::Jet;
use super::law::{HyperelasticLaw, TensionResponse};
use super::sheet::{Kinematics, PlaneTensor, SheetResponse};

/// A law Ψ(I₁, C₁₁, C₁₂, C₂₂) of an incompressible sheet whose directions differ, C = FᵀF in the axes of the material.
///
/// [`AnisotropicSheet`] is the sheet made of it.
pub trait AnisotropicLaw: Clone + Send + Sync + std::fmt::Debug {
    /// Ψ in mJ/mm³ of I₁ − 3, C₁₁ − 1, C₁₂ and C₂₂ − 1, which are zero at rest.
    fn energy(&self, strains: [Jet; 4]) -> Jet;

    /// As [`HyperelasticLaw::is_isotropic`].
    fn is_isotropic(&self) -> bool;

    /// As [`HyperelasticLaw::in_code`], with the first axis of the material.
    fn in_code(&self, _code: Code, _bulk_modulus: f64, _axis: [f64; 2]) -> Option<CodeLaw> {
        None
    }
}

/// A sheet of an anisotropic law.
///
/// ```text
/// P = ∂Ψ/∂F = Σ Ψᵢ ∂xᵢ/∂F,   𝔸 = Σ Ψᵢⱼ ∂xᵢ/∂F ⊗ ∂xⱼ/∂F + Σ Ψᵢ ∂²xᵢ/∂F²                 [MPa]
/// C_ab = (F a)·(F b),   ∂C_ab/∂F = F a ⊗ b + F b ⊗ a
/// ```
///
/// Contraction and shear of a strip cut from the sheet follow from equilibrium: its curve has no closed form and is the
/// result of Newton's method.
#[derive(Clone, Debug)]
pub struct AnisotropicSheet<L> {
    /// The law in the axes of the material.
    pub law: L,
    /// The unit vector along the first of them.
    pub axis: [f64; 2],
}

impl<L> AnisotropicSheet<L> {
    /// The axes a, b of C₁₁, C₁₂ and C₂₂.
    #[inline(always)]
    fn axes(&self) -> [[[f64; 2]; 2]; 3] {
        let [x, y] = self.axis;
        let (first, second) = ([x, y], [-y, x]);
        [[first, first], [first, second], [second, second]]
    }
}

impl<L: AnisotropicLaw> AnisotropicSheet<L> {
    /// The sheet of a card whose first material axis is turned by an angle in rad.
    pub(super) fn boxed(law: L, angle: f64) -> Box<dyn HyperelasticLaw>
    where
        L: 'static,
    {
        let (sine, cosine) = angle.sin_cos();
        let axis = [cosine, sine];
        Box::new(Self { law, axis })
    }

    #[inline(always)]
    fn energy(&self, kinematics: &Kinematics) -> Jet {
        let [e11, e12, e22] = kinematics.twice_green_lagrange;
        let [c11, c12, c22] = self.axes().map(|[a, b]| {
            a[0] * b[0] * e11 + (a[0] * b[1] + a[1] * b[0]) * e12 + a[1] * b[1] * e22
        });
        let i1 = kinematics.invariants.i1_minus_3;
        self.law.energy(Jet::variables([i1, c11, c12, c22]))
    }

    /// ∂xᵢ/∂F.
    #[inline(always)]
    fn gradients(&self, kinematics: &Kinematics) -> Matrix4<f64> {
        let f = &kinematics.deformation_gradient;
        let along = |[x, y]: [f64; 2]| [f[0] * x + f[1] * y, f[2] * x + f[3] * y];
        let [d11, d12, d22] = self.axes().map(|[a, b]| {
            let (fa, fb) = (along(a), along(b));
            let entry = |i: usize, j: usize| fa[i] * b[j] + fb[i] * a[j];
            PlaneTensor::new(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1))
        });
        Matrix4::from_columns(&[2.0 * kinematics.half_d1, d11, d12, d22])
    }
}

impl<L: AnisotropicLaw> HyperelasticLaw for AnisotropicSheet<L> {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        let w = self.energy(kinematics);
        (w.value, self.gradients(kinematics) * w.gradient)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let (w, gradients) = (self.energy(kinematics), self.gradients(kinematics));
        let mut tangent = gradients * w.hessian * gradients.transpose()
            + 2.0 * w.gradient[0] * kinematics.second_derivative_1();
        for ([a, b], slope) in self.axes().iter().zip(w.gradient.iter().skip(1)) {
            for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let entry = slope * (a[row] * b[column] + b[row] * a[column]);
                tangent[(row, column)] += entry;
                tangent[(2 + row, 2 + column)] += entry;
            }
        }
        SheetResponse {
            energy: w.value,
            first_piola_kirchhoff_stress: gradients * w.gradient,
            tangent,
        }
    }

    fn tension(&self, [c, s]: [f64; 2], strain: f64) -> TensionResponse {
        let [x, y] = self.axis;
        let turned = Self {
            axis: [c * x + s * y, c * y - s * x],
            ..self.clone()
        };
        curve::tension(&|kinematics| turned.response(kinematics), strain)
    }

    fn is_isotropic(&self) -> bool {
        self.law.is_isotropic()
    }

    fn in_code(&self, code: Code, bulk_modulus: f64) -> Option<CodeLaw> {
        self.law.in_code(code, bulk_modulus, self.axis)
    }

    fn statements(&self) -> Vec<(&'static str, String)> {
        let soft = "the law has no stiffness at rest, and no study can begin with it";
        let is_soft = self.shear_modulus() == 0.0;
        is_soft
            .then(|| ("at rest", soft.to_owned()))
            .into_iter()
            .collect()
    }

    /// Zero where nothing resists the first strain.
    fn youngs_modulus(&self) -> f64 {
        match self.shear_modulus() {
            0.0 => 0.0,
            _ => self.tension([1.0, 0.0], 0.0).slope,
        }
    }
}
