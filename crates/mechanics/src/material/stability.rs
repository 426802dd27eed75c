//! The stretches up to which a law is stable in the sense of Drucker.
//!
//! A sheet is stable where every small increment of strain takes positive work:
//!
//! ```text
//! dτ : dε > 0,   τ = P Fᵀ,   dF = dε F,   dε symmetric
//! dτ = (𝔸 : (dε F)) Fᵀ + P (dε F)ᵀ = D : dε,   𝔸 = ∂P/∂F                              [MPa]
//! ```
//!
//! D is the tangent of the sheet's Kirchhoff stress without spin, with the thickness from the law; where the axes of
//! strain are fixed, it is ∂τᵢ/∂εⱼ with εᵢ = ln λᵢ. It has to be positive definite, which is a stricter condition
//! than a rising curve in one test.
//!
//! # References
//! D. C. Drucker, J. Appl. Mech. 26, 101 (1959), doi:10.1115/1.4011929

use nalgebra::{Matrix2, Matrix3, Vector4};

use super::curve::Mode;
use super::law::HyperelasticLaw;
use super::sheet::{Kinematics, PlaneTensor};
use crate::statistics::bisect;

/// The stretches within which stability is checked.
pub const SEARCHED: [f64; 2] = [0.1, 10.0];

/// The stretches λ₁ around rest within which the law is stable in a test; an end of [`SEARCHED`] where it is stable that far.
pub fn stable_range(law: &dyn HyperelasticLaw, mode: Mode) -> [f64; 2] {
    SEARCHED.map(|end| stable_until(law, mode, end.ln()).exp())
}

/// Rounding of a tangent with a unit diagonal.
const ROUNDING: f64 = 1e-13;

/// A sheet's ν in its plane at small strain: that of the material in plane stress, ν/(1 − ν) in plane strain.
pub fn in_plane_poisson_ratio(law: &dyn HyperelasticLaw) -> f64 {
    let tangent = law.response(&Kinematics::rest()).tangent;
    tangent[(0, 3)] / tangent[(0, 0)]
}

/// The strain of the first state between rest and `end` that is not stable.
fn stable_until(law: &dyn HyperelasticLaw, mode: Mode, end: f64) -> f64 {
    const STEPS: i32 = 1000;
    // Logarithmic strain along the first axis.
    let stable = |strain: f64| {
        mode.gradient(law, strain.exp_m1())
            .and_then(|gradient| Kinematics::new(&gradient).ok())
            .is_some_and(|kinematics| is_stable(law, &kinematics))
    };
    let strain = |step: i32| end * f64::from(step) / f64::from(STEPS);
    let Some(first) = (1..=STEPS).find(|step| !stable(strain(*step))) else {
        return end;
    };
    bisect([first - 1, first].map(strain), 40, stable)[0]
}

/// Whether D is positive definite in a state, judged by D scaled to a unit diagonal because its entries may span more than the precision of numbers.
pub fn is_stable(law: &dyn HyperelasticLaw, kinematics: &Kinematics) -> bool {
    let Some(tangent) = tangent(law, kinematics) else {
        return false;
    };
    let diagonal = tangent.diagonal();
    if diagonal.iter().any(|entry| *entry <= 0.0) {
        return false;
    }
    let scales = diagonal.map(f64::sqrt);
    let scaled = tangent.component_div(&(scales * scales.transpose()));
    // Where the thickness is far stiffer than the plane, rounding may make a positive pivot negative.
    (scaled + Matrix3::from_diagonal_element(ROUNDING))
        .cholesky()
        .is_some()
}

/// D in the components ε₁₁, ε₂₂ and √2 ε₁₂; `None` where it is not finite.
fn tangent(law: &dyn HyperelasticLaw, kinematics: &Kinematics) -> Option<Matrix3<f64>> {
    let response = law.response(kinematics);
    let matrix = |v: &PlaneTensor| Matrix2::new(v[0], v[1], v[2], v[3]);
    let f = matrix(&kinematics.deformation_gradient);
    let p = matrix(&response.first_piola_kirchhoff_stress);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let strains = [
        Matrix2::new(1.0, 0.0, 0.0, 0.0),
        Matrix2::new(0.0, 0.0, 0.0, 1.0),
        Matrix2::new(0.0, half, half, 0.0),
    ];
    let columns = strains.map(|strain| {
        let df = strain * f;
        let dp = response.tangent * Vector4::new(df[(0, 0)], df[(0, 1)], df[(1, 0)], df[(1, 1)]);
        matrix(&dp) * f.transpose() + p * df.transpose()
    });
    let tangent =
        Matrix3::from_fn(|row, column| columns[column].component_mul(&strains[row]).sum());
    tangent
        .iter()
        .all(|entry| entry.is_finite())
        .then_some(tangent)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::material::{Card, MooneyRivlin, NeoHooke, Polynomial, VerondaWestmann};

    /// Ψ at principal logarithmic strains.
    fn energy(law: &dyn HyperelasticLaw, strains: [f64; 2]) -> f64 {
        let [first, second] = strains.map(f64::exp_m1);
        let kinematics = Kinematics::new(&Vector4::new(first, 0.0, 0.0, second)).unwrap();
        law.stress(&kinematics).0
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
        let [first, second] = at.map(f64::exp_m1);
        let state = Kinematics::new(&Vector4::new(first, 0.0, 0.0, second)).unwrap();
        let computed = tangent(&law, &state).unwrap();
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let value = |a: f64, b: f64| {
                let mut strains = at;
                strains[i] += a * step;
                strains[j] += b * step;
                energy(&law, strains)
            };
            let mixed = value(1.0, 1.0) - value(1.0, -1.0) - value(-1.0, 1.0) + value(-1.0, -1.0);
            let expected = mixed / (4.0 * step * step);
            crate::assert_near(computed[(i, j)], expected, 1e-5, &(&i, &j, &computed));
        }
    }

    /// τ = 2 C₁₀ (B − λ₃² I), B = F Fᵀ: a shear gives dτ : dε = 2 C₁₀ (B₁₁ + B₂₂), and all of D follows from B alone.
    #[test]
    fn the_tangent_of_an_isotropic_law_depends_on_the_left_stretch_alone() {
        let law = NeoHooke { c10: 0.05 };
        let of = |f: Matrix2<f64>| {
            let h = f - Matrix2::identity();
            let state = Kinematics::new(&Vector4::new(h.m11, h.m12, h.m21, h.m22)).unwrap();
            tangent(&law, &state).unwrap()
        };
        let left = Matrix2::new(1.3, 0.2, 0.2, 0.9);
        let turned = left * nalgebra::Rotation2::new(0.6).into_inner();
        assert!((of(left) - of(turned)).amax() < 1e-14);
        let shear = 0.1 * (left * left).trace();
        assert!((of(left)[(2, 2)] - shear).abs() < 1e-14);
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
        let slope = law.tension([1.0, 0.0], high - 1.0).slope;
        assert!(slope > 0.0, "{slope}");
        // The end of the range is sharp.
        let stable = |stretch: f64| {
            let gradient = Mode::Uniaxial.gradient(&law, stretch - 1.0);
            let state = gradient.and_then(|gradient| Kinematics::new(&gradient).ok());
            state.is_some_and(|state| is_stable(&law, &state))
        };
        assert!(stable(high * (1.0 - 1e-9)) && !stable(high * (1.0 + 1e-9)));
    }
}
