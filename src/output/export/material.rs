//! The law of a card in the forms that other codes know.

use super::Code;
use crate::error::Error;
use crate::material::Card;

/// A law with its parameters: stresses in MPa, angles in rad.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// C₁₀, C₀₁, C₂₀, C₁₁, C₀₂ of the polynomial of second order; neo-Hooke and Mooney–Rivlin among them.
    Polynomial([f64; 5]),
    /// C₁₀, C₂₀, C₃₀.
    Yeoh([f64; 3]),
    /// μᵢ and αᵢ of Σ 2 μ/α² (…).
    Ogden(Vec<[f64; 2]>),
    /// μ, λₘ.
    ArrudaBoyce([f64; 2]),
    /// μ, Jₘ.
    Gent([f64; 2]),
    /// C, β.
    VerondaWestmann([f64; 2]),
    /// A law of the first invariant alone by its tension curve: λ − 1 and nominal stress.
    TensionCurve(Vec<[f64; 2]>),
    /// Fibres in a neo-Hookean matrix.
    HolzapfelGasserOgden {
        /// μ, k₁, k₂, κ.
        values: [f64; 4],
        /// The angle of the fibres in rad.
        angle: f64,
        /// Fibres at the angle alone, or at its negative too.
        families: usize,
    },
}

/// Points of a tension curve.
const POINTS: u32 = 400;

impl Material {
    /// The law of a card.
    pub fn of(card: &Card) -> Self {
        let value = |key: &str| card.parameter(key).unwrap_or_default();
        let values = |keys: [&str; 2]| keys.map(value);
        let is = |key: &str, choice: &str| {
            let found = card.choices.iter().find(|(known, _)| *known == key);
            found.is_some_and(|(_, name)| name == choice)
        };
        match card.law_name {
            "neo-hooke" | "mooney-rivlin" | "mooney-rivlin-3" | "mooney-rivlin-5" => {
                Self::Polynomial(["c10", "c01", "c20", "c11", "c02"].map(value))
            }
            "yeoh" => Self::Yeoh(["c10", "c20", "c30"].map(value)),
            "ogden-1" | "ogden-2" | "ogden-3" | "ogden-4" => {
                let ogdens = is("convention", "mu/alpha");
                let term = |i| {
                    Some([
                        card.parameter(&format!("mu_{i}"))?,
                        card.parameter(&format!("alpha_{i}"))?,
                    ])
                };
                let terms = (1..=4).map_while(term);
                let terms =
                    terms.map(|[mu, alpha]| [if ogdens { mu * alpha / 2.0 } else { mu }, alpha]);
                Self::Ogden(terms.collect())
            }
            "arruda-boyce" => Self::ArrudaBoyce(values(["mu", "lambda_m"])),
            "gent" => Self::Gent(values(["mu", "jm"])),
            "veronda-westmann" => Self::VerondaWestmann(values(["c", "beta"])),
            "holzapfel-gasser-ogden" => Self::HolzapfelGasserOgden {
                values: ["mu", "k1", "k2", "kappa"].map(value),
                angle: value("angle"),
                families: if is("families", "one") { 1 } else { 2 },
            },
            _ => Self::TensionCurve(tension_curve(card)),
        }
    }

    /// What a user of a code must know about the law as it goes out, in ASCII.
    pub fn remark(&self, code: Code) -> Option<&'static str> {
        match (code, self) {
            (Code::Abaqus, Self::TensionCurve(_) | Self::Gent(_)) => Some(
                "the law depends on the first invariant alone and goes out as Marlow's law with points of its tension curve",
            ),
            _ => None,
        }
    }
}

/// The tension curve from rest to one and a half of the card's range and to a stretch of 3 at least, as far as the
/// law has an energy.
pub fn tension_curve(card: &Card) -> Vec<[f64; 2]> {
    let most = (1.5 * card.stretch_range[1] - 1.0).max(2.0);
    let points = (0..=POINTS).map(|i| most * f64::from(i) / f64::from(POINTS));
    let points = points.map(|strain| (strain, card.law.tension([1.0, 0.0], strain)));
    // Beyond a law's limit the stress may be a number, but the energy is none.
    let points = points.take_while(|(_, test)| (test.energy + test.nominal_stress).is_finite());
    points
        .map(|(strain, test)| [strain, test.nominal_stress])
        .collect()
}

/// A law that a code does not have.
pub fn refused(card: &Card, code: Code, has: &str) -> Error {
    Error::input(
        format!(
            "{} has no law that equals `{}` of the card `{}`",
            code.name(),
            card.law_name,
            card.name
        ),
        format!(
            "it has {has}; fit such a card to the same data, as with `gelbench materials fit DATA.csv --law ogden-2`"
        ),
    )
}
