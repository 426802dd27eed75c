//! Exponential tension curves.

use super::{Marlow, TensionCurve};
use crate::document::Bound;
use crate::material::exponential::second_quotient;
use crate::material::law::HyperelasticLaw;
use crate::material::parameters::{Parameters, StrainMeasure, StressMeasure};

/// The exponential tension curve of a hydrogel.
///
/// ```text
/// s(ε) = A (e^{b ε} − 1)                                                   [MPa]
/// P(λ) = s (nominal) or s/λ (Cauchy),   ε = λ − 1 (nominal) or ln λ (logarithmic)
/// ```
///
/// | symbol | card key | unit | admissible | meaning |
/// |---|---|---|---|---|
/// | A | `amplitude` | MPa | > 0 | amplitude of the exponential |
/// | b | `exponent` | – | > 0 | rate of the exponential |
/// | σ₀ | `offset` | MPa | any, may be left out | constant of the published curve σ₀ + A e^{b ε} |
///
/// A published curve σ₀ + A e^{b ε} with σ₀ ≠ −A has a stress at rest. The law always uses the curve less its value
/// at rest; `offset = "keep"` on a card serves to draw the published curve only.
///
/// **Limits.** Small strain: E₀ = A b.
#[derive(Clone, Copy, Debug)]
pub struct ExponentialCurve {
    /// A in MPa.
    pub amplitude: f64,
    /// b.
    pub exponent: f64,
}

impl ExponentialCurve {
    /// Reads the parameters of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let curve = Self {
            amplitude: parameters.stress("amplitude", Bound::Positive),
            exponent: parameters.number("exponent", Bound::Positive, [1e-2, 20.0]),
        };
        parameters.remark("offset");
        match (parameters.stress_measure, parameters.strain_measure) {
            (StressMeasure::Nominal, StrainMeasure::Nominal) => Box::new(Marlow { curve }),
            (stress_measure, strain_measure) => Box::new(Marlow {
                curve: ConvertedCurve {
                    curve,
                    stress_measure,
                    strain_measure,
                },
            }),
        }
    }
}

/// The curve in nominal measures, as most tests are published.
impl TensionCurve for ExponentialCurve {
    #[inline(always)]
    fn secant(&self, x: f64) -> (f64, f64) {
        let modulus = self.amplitude * self.exponent;
        let (phi, dphi, _) = exponential_quotients(self.exponent * x);
        (modulus * phi, modulus * self.exponent * dphi)
    }

    #[inline(always)]
    fn energy(&self, x: f64) -> f64 {
        self.amplitude * self.exponent * x * x * second_quotient(self.exponent * x)
    }
}

/// An exponential curve of true stress or logarithmic strain.
#[derive(Clone, Copy, Debug)]
struct ConvertedCurve {
    curve: ExponentialCurve,
    stress_measure: StressMeasure,
    strain_measure: StrainMeasure,
}

impl TensionCurve for ConvertedCurve {
    fn secant(&self, x: f64) -> (f64, f64) {
        // ε = q x
        let (q, dq) = match self.strain_measure {
            StrainMeasure::Nominal => (1.0, 0.0),
            StrainMeasure::Logarithmic => logarithm_quotient(x),
        };
        // P = c s
        let (c, dc) = match self.stress_measure {
            StressMeasure::Nominal => (1.0, 0.0),
            StressMeasure::Cauchy => (1.0 / (1.0 + x), -1.0 / (1.0 + x).powi(2)),
        };
        let z = self.curve.exponent * q * x;
        let dz = self.curve.exponent * (q + x * dq);
        let (phi, dphi, _) = exponential_quotients(z);
        let modulus = self.curve.amplitude * self.curve.exponent;
        let secant = modulus * phi * q * c;
        let slope = modulus * (dphi * dz * q * c + phi * dq * c + phi * q * dc);
        (secant, slope)
    }

    fn energy(&self, x: f64) -> f64 {
        let panels = (self.curve.exponent * x).ceil().clamp(1.0, 64.0);
        let width = x / panels;
        (0..panels as usize)
            .flat_map(|panel| GAUSS_LEGENDRE.map(|(point, weight)| (panel as f64 + point, weight)))
            .map(|(position, weight)| {
                weight * width * (position * width) * self.secant(position * width).0
            })
            .sum()
    }
}

/// φ = (eᶻ − 1)/z, φ′ and φ₂ = (eᶻ − 1 − z)/z², without cancellation: φ = 1 + z φ₂, φ′ = φ − φ₂.
#[inline(always)]
fn exponential_quotients(z: f64) -> (f64, f64, f64) {
    let phi2 = second_quotient(z);
    let phi = 1.0 + z * phi2;
    (phi, phi - phi2, phi2)
}

/// q = ln(1 + x)/x and dq/dx, without cancellation at rest.
fn logarithm_quotient(x: f64) -> (f64, f64) {
    if x.abs() < 0.05 {
        let series = |derivative: bool| {
            (0..16).rev().fold(0.0, |sum, k| {
                let k = f64::from(k);
                let coefficient = if derivative {
                    -(k + 1.0) / (k + 2.0)
                } else {
                    1.0 / (k + 1.0)
                };
                coefficient - x * sum
            })
        };
        return (series(false), series(true));
    }
    let q = x.ln_1p() / x;
    (q, (1.0 / (1.0 + x) - q) / x)
}

/// Ten-point Gauss–Legendre rule on the unit interval: (point, weight).
const GAUSS_LEGENDRE: [(f64, f64); 10] = {
    const HALF: [(f64, f64); 5] = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    let mut rule = [(0.0, 0.0); 10];
    let mut i = 0;
    while i < 5 {
        rule[2 * i] = (0.5 - 0.5 * HALF[i].0, 0.5 * HALF[i].1);
        rule[2 * i + 1] = (0.5 + 0.5 * HALF[i].0, 0.5 * HALF[i].1);
        i += 1;
    }
    rule
};

#[cfg(test)]
mod tests {
    use super::*;

    /// ½ ln 2 is where the quotients of the exponential change their form.
    #[test]
    fn the_quotients_are_those_of_their_formulas_on_both_sides_of_a_change_of_form() {
        let join = 0.5 * std::f64::consts::LN_2;
        for z in [
            -join - 1e-9,
            -join + 1e-9,
            join - 1e-9,
            join + 1e-9,
            1.0,
            -3.0,
        ] {
            let (phi, dphi, phi2) = exponential_quotients(z);
            let expected = [z.exp_m1() / z, (z.exp_m1() - z) / (z * z)];
            assert!((phi - expected[0]).abs() < 1e-14, "{z}");
            assert!((phi2 - expected[1]).abs() < 1e-14, "{z}");
            assert!((dphi - (expected[0] - expected[1])).abs() < 2e-14, "{z}");
        }
        for x in [
            -0.3,
            -0.05 - 1e-9,
            -0.05 + 1e-9,
            0.05 - 1e-9,
            0.05 + 1e-9,
            2.0,
        ] {
            let (q, dq) = logarithm_quotient(x);
            let expected = x.ln_1p() / x;
            assert!((q - expected).abs() < 1e-15 * (1.0 + expected), "{x}");
            assert!((dq - (1.0 / (1.0 + x) - expected) / x).abs() < 2e-14, "{x}");
        }
    }
}
