//! What a hyperelastic law is: a strain energy as a scalar function of the strain invariants.

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

/// An isotropic, incompressible hyperelastic law Ψ(I₁, I₂).
///
/// A law gives scalars. Stress, tangent and the curves of the usual tests are derived from them once
/// for all laws, in [`super::sheet`] and [`super::uniaxial`]. A law whose Ψ₁₁ is unbounded at rest
/// (as Marlow's) returns zero for it there: every use multiplies it by a factor that vanishes faster.
pub trait HyperelasticLaw: Send + Sync + std::fmt::Debug {
    /// Ψ and its derivatives at the given invariants.
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives;

    /// The initial shear modulus μ₀ = 2 (Ψ₁ + Ψ₂) at rest, in MPa.
    fn shear_modulus(&self) -> f64 {
        let rest = self.evaluate(Invariants {
            i1_minus_3: 0.0,
            i2_minus_3: 0.0,
        });
        2.0 * (rest.d1 + rest.d2)
    }

    /// The initial Young's modulus E₀ = 3 μ₀ of the incompressible body, in MPa.
    fn youngs_modulus(&self) -> f64 {
        3.0 * self.shear_modulus()
    }
}
