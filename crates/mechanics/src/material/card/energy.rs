//! The energy of a card as a formula, and what it amounts to at rest.

use super::Card;
use crate::material::volume::{SmallStrain, VolumeEnergy};
use crate::units::brief;

impl Card {
    /// The energy that is computed, in the convention of the card and with its change of volume:
    /// `W = Ψ + ½ κ (J − 1)², Ψ = C₁₀ (Ī₁ − 3)`.
    pub fn energy(&self) -> String {
        let Some(volume) = self.volume else {
            return self.formula.to_owned();
        };
        let energy = match volume.energy {
            VolumeEnergy::Quadratic => "½ κ (J − 1)²",
            VolumeEnergy::Logarithmic => "½ κ ln² J",
            VolumeEnergy::SimoTaylor => "¼ κ (J² − 1 − 2 ln J)",
        };
        let without_volume = [
            ("I₁", "Ī₁"),
            ("I₂", "Ī₂"),
            ("λ₁", "λ̄₁"),
            ("λ₂", "λ̄₂"),
            ("λ₃", "λ̄₃"),
        ];
        let mut formula = self.formula.to_owned();
        for (symbol, isochoric) in without_volume {
            formula = formula.replace(symbol, isochoric);
        }
        format!("W = Ψ + {energy}, {formula}")
    }

    /// The symbols of the formula with their numbers: `C₁₀ = 0.003 MPa`.
    pub fn symbols(&self) -> Vec<String> {
        let parameters = self.parameters.iter().map(|parameter| {
            let (symbol, value) = (symbol(parameter.key), brief(parameter.value));
            match parameter.unit() {
                "–" => format!("{symbol} = {value}"),
                unit => format!("{symbol} = {value} {unit}"),
            }
        });
        let bulk = self
            .volume
            .map(|volume| format!("κ = {} MPa", brief(volume.bulk_modulus)));
        parameters.chain(bulk).collect()
    }

    /// E, ν, μ and K at small strain.
    pub fn small_strain(&self) -> SmallStrain {
        let (shear, bulk) = (self.law.shear_modulus(), self.bulk_modulus());
        let ratio = |bulk: f64| (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        SmallStrain {
            youngs_modulus: self.youngs_modulus(),
            poisson_ratio: bulk.map_or(0.5, ratio),
            shear_modulus: shear,
            bulk_modulus: bulk.unwrap_or(f64::INFINITY),
        }
    }
}

/// The symbol in formulas of a key of a card; the key itself where it has none.
fn symbol(key: &str) -> String {
    let named = match key {
        "jm" => "Jₘ",
        "lambda_m" => "λₘ",
        "mu" => "μ",
        "kappa" => "κ",
        "beta" => "β",
        "c" => "C",
        "amplitude" => "A",
        "exponent" => "b",
        "poisson_ratio" => "ν",
        "share" => "f",
        "modulus" => "G₀",
        "chi" => "χ",
        _ => "",
    };
    if !named.is_empty() {
        return named.to_owned();
    }
    let digits = key.len() - key.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    let (name, number) = key.split_at(key.len() - digits);
    let letter = match name {
        "c" => "C",
        "mu_" => "μ",
        "alpha_" => "α",
        "nu_" => "ν",
        "k" => "k",
        _ => return key.to_owned(),
    };
    let subscript = number
        .bytes()
        .filter_map(|digit| char::from_u32('₀' as u32 + u32::from(digit - b'0')));
    letter.chars().chain(subscript).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_the_symbols_of_the_formulas() {
        for (key, expected) in [
            ("c10", "C₁₀"),
            ("mu_3", "μ₃"),
            ("k1", "k₁"),
            ("angle", "angle"),
        ] {
            assert_eq!(symbol(key), expected);
        }
    }
}
