//! The stretches up to which a law is stable in the sense of Drucker.
//!
//! A sheet is stable where every small increment of strain takes positive work:
//!
//! ```text
//! dτ : dε > 0,   τᵢ = ∂Ψ/∂εᵢ,   εᵢ = ln λᵢ
//! D = ∂τ/∂ε = Ψ₁ I₁″ + Ψ₂ I₂″ + Ψ₁₁ I₁′⊗I₁′ + Ψ₁₂ (I₁′⊗I₂′ + I₂′⊗I₁′) + Ψ₂₂ I₂′⊗I₂′      [MPa]
//! ```
//!
//! D is the 2 × 2 plane-stress tangent by the in-plane principal strains, the thickness following from
//! incompressibility. It has to be positive definite, which says more than a rising curve in one test.
//!
//! # References
//! D. C. Drucker, J. Appl. Mech. 26, 101 (1959), doi:10.1115/1.4011929

use nalgebra::{Matrix2, Vector2};

use super::law::{HyperelasticLaw, Invariants};

/// The usual tests of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// λ₂ = λ₁^(−½).
    Uniaxial,
    /// λ₂ = 1.
    Planar,
    /// λ₂ = λ₁.
    Equibiaxial,
}

impl Mode {
    /// All tests with their names.
    pub const ALL: [(&'static str, Self); 3] = [
        ("uniaxial", Self::Uniaxial),
        ("planar", Self::Planar),
        ("equibiaxial", Self::Equibiaxial),
    ];

    /// ln λ₂ over ln λ₁.
    fn ratio(self) -> f64 {
        match self {
            Self::Uniaxial => -0.5,
            Self::Planar => 0.0,
            Self::Equibiaxial => 1.0,
        }
    }
}

/// Stretches beyond which stability is not looked for.
pub const SEARCHED: [f64; 2] = [0.1, 10.0];

/// The stretches λ₁ around rest within which the law is stable in a test: the ends of [`SEARCHED`] where it
/// is stable that far.
pub fn stable_range(law: &dyn HyperelasticLaw, mode: Mode) -> [f64; 2] {
    SEARCHED.map(|end| stable_until(law, mode, end.ln()).exp())
}

/// The strain of the first state between rest and `end` that is not stable.
fn stable_until(law: &dyn HyperelasticLaw, mode: Mode, end: f64) -> f64 {
    const STEPS: i32 = 1000;
    let stable = |strain: f64| is_stable(law, [strain, mode.ratio() * strain]);
    let strain = |step: i32| end * f64::from(step) / f64::from(STEPS);
    let Some(first) = (1..=STEPS).find(|step| !stable(strain(*step))) else {
        return end;
    };
    let (mut inside, mut outside) = (strain(first - 1), strain(first));
    for _ in 0..40 {
        let middle = 0.5 * (inside + outside);
        if stable(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

fn is_stable(law: &dyn HyperelasticLaw, strains: [f64; 2]) -> bool {
    let tangent = tangent(law, strains);
    tangent[(0, 0)] > 0.0 && tangent.determinant() > 0.0
}

/// D at the principal logarithmic strains ε₁, ε₂.
fn tangent(law: &dyn HyperelasticLaw, [e1, e2]: [f64; 2]) -> Matrix2<f64> {
    // λᵢ² and λᵢ⁻², the last of the thickness.
    let squares = [e1, e2, -e1 - e2].map(|strain| (2.0 * strain).exp());
    let inverses = squares.map(|square| 1.0 / square);
    let sum = |values: [f64; 3]| values.iter().sum::<f64>();
    let w = law.evaluate(Invariants {
        i1_minus_3: sum(squares) - 3.0,
        i2_minus_3: sum(inverses) - 3.0,
    });
    let first = |v: [f64; 3], sign: f64| 2.0 * sign * Vector2::new(v[0] - v[2], v[1] - v[2]);
    let second = |v: [f64; 3]| 4.0 * Matrix2::new(v[0] + v[2], v[2], v[2], v[1] + v[2]);
    let (g1, g2) = (first(squares, 1.0), first(inverses, -1.0));
    w.d1 * second(squares)
        + w.d2 * second(inverses)
        + w.d11 * g1 * g1.transpose()
        + w.d12 * (g1 * g2.transpose() + g2 * g1.transpose())
        + w.d22 * g2 * g2.transpose()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::material::{Card, MooneyRivlin, NeoHooke, Polynomial, VerondaWestmann};

    /// Ψ at principal logarithmic strains.
    fn energy(law: &dyn HyperelasticLaw, [e1, e2]: [f64; 2]) -> f64 {
        let squares = [e1, e2, -e1 - e2].map(|strain| (2.0 * strain).exp());
        let i1_minus_3 = squares.iter().sum::<f64>() - 3.0;
        let i2_minus_3 = squares.iter().map(|square| 1.0 / square).sum::<f64>() - 3.0;
        law.evaluate(Invariants {
            i1_minus_3,
            i2_minus_3,
        })
        .energy
    }

    #[test]
    fn the_tangent_is_the_second_derivative_of_the_energy() {
        let law = Polynomial {
            c10: 0.04,
            c01: 0.01,
            c20: 0.003,
            c11: 0.002,
            c02: 0.001,
        };
        let (at, step) = ([0.3, -0.1], 1e-4);
        let found = tangent(&law, at);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let value = |a: f64, b: f64| {
                let mut strains = at;
                strains[i] += a * step;
                strains[j] += b * step;
                energy(&law, strains)
            };
            let mixed = value(1.0, 1.0) - value(1.0, -1.0) - value(-1.0, 1.0) + value(-1.0, -1.0);
            let expected = mixed / (4.0 * step * step);
            assert!(
                (found[(i, j)] / expected - 1.0).abs() < 1e-5,
                "{i}{j}: {found} {expected}"
            );
        }
    }

    #[test]
    fn neo_hooke_and_the_shipped_cards_are_stable_where_they_are_used() {
        for (_, mode) in Mode::ALL {
            let [low, high] = stable_range(&NeoHooke { c10: 0.05 }, mode);
            assert!((low - 0.1).abs() < 1e-12 && (high - 10.0).abs() < 1e-12);
            for card in ["pva-10", "pva-10-cauchy", "mooney-rivlin"] {
                let card = Card::load(card, Path::new(".")).unwrap();
                let high = stable_range(&*card.law, mode)[1];
                assert!(
                    high >= card.stretch_range[1],
                    "{}: {mode:?} {high}",
                    card.name
                );
            }
        }
    }

    /// Free least squares of Mooney-Rivlin to the PVA curve: C₁₀ = 0.307, C₀₁ = −0.359 MPa.
    #[test]
    fn a_fit_with_a_negative_parameter_is_unstable_from_rest() {
        let law = MooneyRivlin {
            c10: 0.307,
            c01: -0.359,
        };
        for (_, mode) in Mode::ALL {
            assert_eq!(stable_range(&law, mode), [1.0, 1.0], "{mode:?}");
        }
    }

    /// A rising tension curve is not enough. These parameters nearly follow the curve of PVA hydrogel as
    /// Cauchy stress.
    #[test]
    fn a_rising_curve_may_be_unstable() {
        let law = VerondaWestmann {
            c: 0.1468,
            beta: 0.31,
        };
        let [_, high] = stable_range(&law, Mode::Uniaxial);
        assert!(high > 1.58 && high < 1.63, "{high}");
        let slope = crate::material::uniaxial::uniaxial(&law, high - 1.0).slope;
        assert!(slope > 0.0, "{slope}");
    }
}
