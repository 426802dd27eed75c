//! What a hyperelastic law is: energy, stress and tangent of an incompressible thin sheet.

use super::sheet::{Gradient, Kinematics, SheetResponse};

/// An incompressible hyperelastic law, as a thin sheet in plane stress sees it.
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

/// The first two invariants of the right Cauchy–Green tensor of an incompressible body,
/// each less its value at rest.
///
/// ```text
/// I₁ = λ₁² + λ₂² + λ₃²,   I₂ = λ₁⁻² + λ₂⁻² + λ₃⁻²,   λ₁ λ₂ λ₃ = 1          [–]
/// ```
///
/// The differences are kept, not the invariants, because I₁ − 3 is of second order in the strain:
/// at λ − 1 = 1e-8 it is 3e-16 and would be lost in I₁ itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Invariants {
    /// I₁ − 3.
    pub i1_minus_3: f64,
    /// I₂ − 3.
    pub i2_minus_3: f64,
}

/// The strain energy per reference volume and its derivatives by the invariants.
///
/// Energies are in mJ/mm³ = MPa; the invariants have no unit, so the derivatives are in MPa too.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyDerivatives {
    /// Ψ.
    pub energy: f64,
    /// ∂Ψ/∂I₁.
    pub d1: f64,
    /// ∂Ψ/∂I₂.
    pub d2: f64,
    /// ∂²Ψ/∂I₁².
    pub d11: f64,
    /// ∂²Ψ/∂I₁∂I₂.
    pub d12: f64,
    /// ∂²Ψ/∂I₂².
    pub d22: f64,
}

/// An isotropic law Ψ(I₁, I₂).
///
/// A law whose Ψ₁₁ is unbounded at rest (as Marlow's) returns zero for it there: every use multiplies it
/// by a factor that vanishes faster.
pub trait InvariantLaw: Send + Sync + std::fmt::Debug {
    /// Ψ and its derivatives at the given invariants.
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives;
}

impl<L: InvariantLaw> HyperelasticLaw for L {
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
