//! Simple shear together with tension: the shear stress of a block between two plates.

use super::helpers::{assert_parameters, fitted, parsed, uniaxial};
use crate::calibration::{FitSettings, Memory, Terms, TestData};
use crate::material::registry::Law;

const C10: f64 = 0.03;
const C01: f64 = 0.01;

/// τ = 2 (C₁₀ + C₀₁) γ of Mooney and Rivlin's law, over γ or over the displacement of a block 5 mm high with 200 mm².
fn sheared(is_machine: bool, sign: f64) -> TestData {
    let rows = (0..40).map(|row| {
        let amount = sign * 0.02 * f64::from(row);
        let stress = 2.0 * (C10 + C01) * amount;
        if is_machine {
            format!("{:.9},{:.9}\n", 5.0 * amount, 200.0 * stress)
        } else {
            format!("{amount:.9},{:.9}\n", 1e3 * stress)
        }
    });
    let rows: String = rows.collect();
    let head = if is_machine {
        "# test: simple-shear; length: 5 mm; area: 200 mm^2; zero: none\nDisplacement (mm),Force (N)\n"
    } else {
        "# test: simple-shear\nshear_strain [-],shear_stress [kPa]\n"
    };
    parsed(&format!("{head}{rows}"))
}

/// P = 2 (λ − λ⁻²)(C₁₀ + C₀₁/λ).
fn pulled() -> TestData {
    let rows = (0..40).map(|row| {
        let stretch = 1.0 + 0.02 * f64::from(row);
        let stress = 2.0 * (stretch - stretch.powi(-2)) * (C10 + C01 / stretch);
        format!("{stretch:.9},{stress:.9}\n")
    });
    let rows: String = rows.collect();
    uniaxial(&rows)
}

#[test]
fn shear_and_tension_together_determine_both_parameters_of_mooney_and_rivlin() {
    for is_machine in [false, true] {
        for sign in [1.0, -1.0] {
            let tests = [sheared(is_machine, sign), pulled()];
            assert_parameters(&fitted("mooney-rivlin", &tests), &[C10, C01], 1e-6);
        }
    }
}

#[test]
fn shear_alone_determines_the_sum_alone_and_its_range_is_that_of_the_principal_stretches() {
    let fit = fitted("neo-hooke", &[sheared(false, 1.0)]);
    assert_parameters(&fit, &[C10 + C01], 1e-6);
    let [low, high] = fit.quality.stretch_range;
    assert!((high - low - 0.78).abs() < 1e-9 && (low * high - 1.0).abs() < 1e-12);
}

#[test]
fn relaxation_is_not_fitted_to_shear() {
    let law = Law::named("neo-hooke").unwrap();
    let tests = [sheared(true, 1.0)];
    let memory = Memory::Relaxation(Terms::Exactly(1));
    let refused = memory
        .fit(law, &tests, &FitSettings::default())
        .unwrap_err();
    assert!(refused.to_string().contains("simple shear"), "{refused}");
}
