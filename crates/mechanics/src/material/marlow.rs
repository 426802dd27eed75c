//! Marlow's first-invariant law from a uniaxial curve.
//!
//! The uniaxial test is reproduced exactly, without fitting, and every other state follows from the
//! assumption that the energy depends on the first invariant alone:
//!
//! ```text
//! Ψ(I₁) = ∫₁^λ P dλ,   where   I₁ = λ² + 2/λ,   λ ≥ 1                      [mJ/mm³]
//! Ψ′(I₁) = P(λ) / (2 (λ − λ⁻²))                                            [MPa]
//! ```
//!
//! **Derivation.** With x = λ − 1 and R(x) = P/x, which is regular at rest,
//!
//! ```text
//! Ψ′    = R g,                     g = (1 + x)² / (2 (3 + 3x + x²))
//! dΨ′/dx = R′ g + R g′
//! dI₁/dx = 2 x (3 + 3x + x²) / (1 + x)²
//! Ψ″    = (dΨ′/dx) / (dI₁/dx)      ~ 1/x at rest
//! ```
//!
//! Ψ″ is unbounded at rest, but the tangent multiplies it by (∂I₁/∂F)² ~ x². The stretch is found from
//! I₁ − 3 by the root of x³ + 3x² − (I₁ − 3)(1 + x) = 0, so that no digit is lost near rest.
//!
//! **Not covered.** Dependence on I₂: planar and equibiaxial tension are predictions, and compression follows
//! from the tension curve at the same I₁.
//!
//! # References
//! R. S. Marlow, in: Constitutive Models for Rubber III, Balkema (2003), p. 157, ISBN 90-5809-566-5

use super::code::{Code, CodeLaw};
use super::invariant_law::InvariantLaw;
use super::invariants::{EnergyDerivatives, Invariants};

mod exponential;
mod table;

pub use exponential::ExponentialCurve;
pub use table::{CurveFault, TableCurve};

/// A tension curve P(x) of the strain x = λ − 1 ≥ 0, with P(0) = 0.
pub trait TensionCurve: Send + Sync + std::fmt::Debug {
    /// R = P/x and dR/dx in MPa, at rest their limits.
    fn secant(&self, x: f64) -> (f64, f64);

    /// Ψ = ∫₀ˣ P dx in mJ/mm³.
    fn energy(&self, x: f64) -> f64;
}

/// Marlow's law of a tension curve.
#[derive(Clone, Debug)]
pub struct Marlow<C> {
    /// The curve.
    pub curve: C,
}

impl<C: TensionCurve> InvariantLaw for Marlow<C> {
    #[inline(always)]
    fn evaluate(&self, invariants: Invariants) -> EnergyDerivatives {
        let x = uniaxial_strain(invariants.i1_minus_3);
        let (secant, slope) = self.curve.secant(x);
        let lambda = 1.0 + x;
        let cubic = 3.0 + 3.0 * x + x * x;
        let g = lambda * lambda / (2.0 * cubic);
        let dg = g * (2.0 / lambda - (3.0 + 2.0 * x) / cubic);
        let d1_by_x = slope * g + secant * dg;
        let i1_by_x = x / g;
        EnergyDerivatives {
            energy: self.curve.energy(x),
            d1: secant * g,
            d11: if i1_by_x > f64::MIN_POSITIVE {
                d1_by_x / i1_by_x
            } else {
                0.0
            },
            ..EnergyDerivatives::default()
        }
    }

    fn in_code(&self, code: Code, _: f64) -> Option<CodeLaw> {
        CodeLaw::of_first_invariant(code)
    }
}

/// x = λ − 1 ≥ 0 of the uniaxial state with I₁ − 3 = y: the root of x³ + 3x² − y (1 + x) = 0.
///
/// x/r is a smooth function of r/(1 + r), where r = √(y/3), that runs from 1 at rest to √3 far away; a polynomial
/// that follows it to 8e-6 is improved by one step of Halley's method, of third order.
#[inline(always)]
fn uniaxial_strain(y: f64) -> f64 {
    const GUESS: [f64; 8] = [
        1.0,
        0.332_886_19,
        0.285_442_37,
        0.150_356_96,
        0.090_111_93,
        0.246_593_1,
        -0.666_781_46,
        0.293_455_26,
    ];
    let r = (y.max(0.0) / 3.0).sqrt();
    let t = r / (1.0 + r);
    let [c0, c1, c2, c3, c4, c5, c6, c7] = GUESS;
    let t2 = t * t;
    let low = (c0 + c1 * t) + (c2 + c3 * t) * t2;
    let high = (c4 + c5 * t) + (c6 + c7 * t) * t2;
    let x = r * (low + high * (t2 * t2));
    let value = x * x * (3.0 + x) - y * (1.0 + x);
    let slope = 3.0 * x * (2.0 + x) - y;
    let step = 2.0 * value * slope / (2.0 * slope * slope - value * (6.0 + 6.0 * x));
    if y > 0.0 { x - step } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_uniaxial_strain_is_found_to_the_last_digits() {
        for x in [1e-9, 1e-6, 1e-3, 0.1, 0.5, 1.0, 3.0, 20.0_f64] {
            let y = x * x * (3.0 + x) / (1.0 + x);
            let computed = uniaxial_strain(y);
            assert!((computed / x - 1.0).abs() < 4e-15, "x = {x}: {computed}");
        }
    }
}
