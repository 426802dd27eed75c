//! Softening by the largest load so far: the pseudo-elasticity of Ogden and Roxburgh for the Mullins effect.
//!
//! ```text
//! P = η P₀,   η = 1 − (1/r) erf((Wₘ − W₀)/c),   c = m + β Wₘ,   Wₘ = max W₀ of the past              [MPa]
//! Ψ = W₀ + (c/r) G((Wₘ − W₀)/c),   G(x) = ∫₀ˣ erf = x erf x + (e^(−x²) − 1)/√π                      [mJ/mm³]
//! D = (c/r) G(Wₘ/c) = Ψ at rest
//! ```
//!
//! P₀ and W₀ are stress and energy of the material that was never loaded. Where W₀ exceeds Wₘ, η = 1 and Ψ = W₀. Ψ is
//! the work done on a point: Ψ − D is stored, and D, which grows with Wₘ alone, is dissipated. As long as Wₘ is
//! constant, Ψ is an energy with P = ∂Ψ/∂F, so that one load step is one of a hyperelastic body:
//!
//! ```text
//! ∂P/∂F = η ∂P₀/∂F + η′ P₀ ⊗ P₀,   η′ = ∂η/∂W₀ = 2/(√π r c) e^(−((Wₘ − W₀)/c)²)
//! ```
//!
//! η acts on the whole energy. For a law with a change of volume this is the form for foams; the thickness stretch
//! equals that of the law without softening, because P₃₃ = η P₀₃₃ vanishes with P₀₃₃.
//!
//! | symbol | card key | unit | admissible | meaning |
//! |---|---|---|---|---|
//! | r | `r` | – | > 1 | 1 − 1/r is the least value of η |
//! | m | `m` | MPa | ≥ 0 | width of the transition in energy |
//! | β | `beta` | – | ≥ 0 | the same, relative to Wₘ; m and β are not both zero |
//!
//! **Not covered.** A permanent set, healing with time, softening that continues from cycle to cycle at the same
//! load, and softening that depends on the direction.
//!
//! # References
//! R. W. Ogden, D. G. Roxburgh, Proc. R. Soc. A 455, 2861 (1999), doi:10.1098/rspa.1999.0431 (with m and β = 0);
//! Abaqus Theory Guide, "Mullins effect" (with β, and for foams)

use std::f64::consts::PI;

use libm::erf;

use super::sheet::{PlaneTensor, SheetResponse};
use crate::document::{Bound, Section};
use crate::units::Dimension;

/// The parameters of a material that softens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softening {
    /// r.
    pub r: f64,
    /// m in MPa = mJ/mm³.
    pub m: f64,
    /// β.
    pub beta: f64,
}

impl Softening {
    /// The admissible values of r.
    pub const R: Bound = Bound::Range(1.0 + 1e-6, 1e6, "greater than 1");

    /// Reads the section of a card.
    pub fn read(section: &Section) -> Self {
        let r = section.number("r", Self::R);
        let m = if section.has("m") || !section.has("beta") {
            section.quantity("m", Dimension::Stress, Bound::NonNegative)
        } else {
            0.0
        };
        let beta = section.stated("beta", |_, key| section.number(key, Bound::NonNegative));
        let beta = beta.unwrap_or(0.0);
        if m == 0.0 && beta == 0.0 {
            let hint = "m is the energy over which the softening sets in, such as \"0.01 MPa\"";
            section.fault("m", "and `beta` must not both be zero", hint);
        }
        section.unknown_keys();
        Self { r, m, beta }
    }

    /// c = m + β Wₘ in mJ/mm³.
    fn width(&self, most: f64) -> f64 {
        self.m + self.beta * most
    }

    /// η and ∂η/∂W₀ at the energy W₀ of a point whose largest one so far was `most`, both in mJ/mm³.
    pub fn factor(&self, energy: f64, most: f64) -> [f64; 2] {
        // Rounding makes the energy of a turned point negative, where a point that was never loaded has zero width.
        let energy = energy.max(0.0);
        if energy >= most {
            return [1.0, 0.0];
        }
        let width = self.width(most);
        let x = (most - energy) / width;
        let slope = 2.0 / (PI.sqrt() * self.r * width) * (-x * x).exp();
        [1.0 - erf(x) / self.r, slope]
    }

    /// Ψ: the work that was done on a point, in mJ/mm³.
    pub fn energy(&self, energy: f64, most: f64) -> f64 {
        let energy = energy.max(0.0);
        if energy >= most {
            return energy;
        }
        let width = self.width(most);
        energy + width / self.r * integral((most - energy) / width)
    }

    /// D: the part of it that is dissipated, in mJ/mm³.
    pub fn dissipated(&self, most: f64) -> f64 {
        self.energy(0.0, most)
    }

    /// Energy and stress of a point, from those of the law that was never loaded.
    pub fn stress(&self, (energy, stress): (f64, PlaneTensor), most: f64) -> (f64, PlaneTensor) {
        let [factor, _] = self.factor(energy, most);
        (self.energy(energy, most), factor * stress)
    }

    /// Energy, stress and tangent of a point.
    pub fn response(&self, virgin: SheetResponse, most: f64) -> SheetResponse {
        let [factor, slope] = self.factor(virgin.energy, most);
        let stress = virgin.first_piola_kirchhoff_stress;
        SheetResponse {
            energy: self.energy(virgin.energy, most),
            first_piola_kirchhoff_stress: factor * stress,
            tangent: factor * virgin.tangent + slope * stress * stress.transpose(),
        }
    }
}

/// G(x) = ∫₀ˣ erf, without cancellation where x is small.
fn integral(x: f64) -> f64 {
    x * erf(x) + (-x * x).exp_m1() / PI.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding takes the energy of a rotated point below zero.
    #[test]
    fn a_point_that_was_never_loaded_has_no_softening_without_a_width() {
        let softening = Softening {
            r: 2.0,
            m: 0.0,
            beta: 0.1,
        };
        for energy in [-1e-32, 0.0, 1e-32] {
            assert_eq!(softening.factor(energy, 0.0), [1.0, 0.0]);
            assert_eq!(softening.energy(energy, 0.0), energy.max(0.0));
        }
        assert!(softening.factor(-1e-32, 1e-3)[0] < 1.0);
    }
}
