//! Invariants of an incompressible body, and an energy's derivatives with respect to them.

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

/// The strain energy per reference volume and its derivatives with respect to the invariants.
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
