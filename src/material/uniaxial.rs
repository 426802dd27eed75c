//! The curves of the usual tests, for every law.
//!
//! ```text
//! uniaxial     P = 2 (Ψ₁ + Ψ₂/λ) (λ − λ⁻²)      I₁ = λ² + 2/λ         I₂ = 2λ + λ⁻²
//! planar       P = 2 (Ψ₁ + Ψ₂) (λ − λ⁻³)        I₁ = I₂ = λ² + 1 + λ⁻²
//! equibiaxial  P = 2 (Ψ₁ + λ² Ψ₂) (λ − λ⁻⁵)     I₁ = 2λ² + λ⁻⁴        I₂ = λ⁴ + 2λ⁻²
//! ```
//!
//! P is the nominal stress in MPa, λ the stretch in the loaded direction.

use super::law::{HyperelasticLaw, Invariants};

/// Energy, stress and slope of the uniaxial curve at one stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniaxialResponse {
    /// Ψ in mJ/mm³.
    pub energy: f64,
    /// Nominal stress P in MPa.
    pub nominal_stress: f64,
    /// dP/dλ in MPa.
    pub slope: f64,
}

/// The uniaxial curve at λ = 1 + `strain`, tension or compression; `strain` > −1.
pub fn uniaxial(law: &dyn HyperelasticLaw, strain: f64) -> UniaxialResponse {
    let x = strain;
    let lambda = 1.0 + x;
    let cubic = 3.0 + 3.0 * x + x * x;
    let i1_minus_3 = x * x * (3.0 + x) / lambda;
    let i2_minus_3 = x * x * (3.0 + 2.0 * x) / (lambda * lambda);
    let w = law.evaluate(Invariants {
        i1_minus_3,
        i2_minus_3,
    });
    // λ − λ⁻² and its derivative; dI₁/dλ = 2 h, dI₂/dλ = 2 h/λ.
    let h = x * cubic / (lambda * lambda);
    let dh = 1.0 + 2.0 / lambda.powi(3);
    let secant = w.d1 + w.d2 / lambda;
    let secant_slope = 2.0 * h * (w.d11 + 2.0 * w.d12 / lambda + w.d22 / (lambda * lambda))
        - w.d2 / (lambda * lambda);
    UniaxialResponse {
        energy: w.energy,
        nominal_stress: 2.0 * secant * h,
        slope: 2.0 * (secant * dh + secant_slope * h),
    }
}

/// Nominal stress of planar tension (pure shear) at the stretch `lambda`.
pub fn planar(law: &dyn HyperelasticLaw, lambda: f64) -> f64 {
    let x = lambda - 1.0;
    let excess = (x * (2.0 + x) / lambda).powi(2);
    let w = law.evaluate(Invariants {
        i1_minus_3: excess,
        i2_minus_3: excess,
    });
    2.0 * (w.d1 + w.d2) * (lambda - lambda.powi(-3))
}

/// Nominal stress of equibiaxial tension at the stretch `lambda`.
pub fn equibiaxial(law: &dyn HyperelasticLaw, lambda: f64) -> f64 {
    let d = (lambda - 1.0) * (lambda + 1.0); // λ² − 1
    let square = 1.0 + d;
    let w = law.evaluate(Invariants {
        i1_minus_3: d * d * (3.0 + 2.0 * d) / (square * square),
        i2_minus_3: d * d * (3.0 + d) / square,
    });
    2.0 * (w.d1 + square * w.d2) * (lambda - lambda.powi(-5))
}
