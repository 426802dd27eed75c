//! The laws and the shipped cards by name.

use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use super::{MarlowExponential, MooneyRivlin, NeoHooke};

/// Builds a law from the parameters of a card.
pub type LawReader = fn(&Parameters) -> Box<dyn HyperelasticLaw>;

/// Every law: its name on a card, its formula, and how it is read.
pub const LAWS: &[(&str, &str, LawReader)] = &[
    ("neo-hooke", "Ψ = C₁₀ (I₁ − 3)", NeoHooke::from_card),
    (
        "mooney-rivlin",
        "Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3)",
        MooneyRivlin::from_card,
    ),
    (
        "marlow-exponential",
        "Ψ(I₁) from the tension curve A (e^(b ε) − 1)",
        MarlowExponential::from_card,
    ),
];

/// Every card that gelbench brings along: its name and its text.
pub const CARDS: &[(&str, &str)] = &[
    ("pva-10", include_str!("../../materials/pva-10.toml")),
    (
        "pva-10-cauchy",
        include_str!("../../materials/pva-10-cauchy.toml"),
    ),
    ("neo-hooke", include_str!("../../materials/neo-hooke.toml")),
    (
        "mooney-rivlin",
        include_str!("../../materials/mooney-rivlin.toml"),
    ),
];
