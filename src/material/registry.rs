//! The laws and the shipped cards by name.

use super::law::HyperelasticLaw;
use super::parameters::Parameters;
use super::{
    ArrudaBoyce, FungDemiray, Gent, MarlowExponential, MooneyRivlin, NeoHooke, Polynomial,
    VerondaWestmann, Yeoh,
};

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
        "mooney-rivlin-3",
        "Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3) + C₁₁ (I₁ − 3)(I₂ − 3)",
        Polynomial::from_card_3,
    ),
    (
        "mooney-rivlin-5",
        "Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3) + C₂₀ (I₁ − 3)² + C₁₁ (I₁ − 3)(I₂ − 3) + C₀₂ (I₂ − 3)²",
        Polynomial::from_card_5,
    ),
    (
        "yeoh",
        "Ψ = C₁₀ (I₁ − 3) + C₂₀ (I₁ − 3)² + C₃₀ (I₁ − 3)³",
        Yeoh::from_card,
    ),
    ("gent", "Ψ = −½ μ Jₘ ln(1 − (I₁ − 3)/Jₘ)", Gent::from_card),
    (
        "arruda-boyce",
        "Ψ = μ Σ Cᵢ λₘ^(2 − 2i) (I₁ⁱ − 3ⁱ), five terms",
        ArrudaBoyce::from_card,
    ),
    (
        "fung-demiray",
        "Ψ = μ/(2 b) (e^(b (I₁ − 3)) − 1)",
        FungDemiray::from_card,
    ),
    (
        "veronda-westmann",
        "Ψ = C (e^(β (I₁ − 3)) − 1) − ½ C β (I₂ − 3)",
        VerondaWestmann::from_card,
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
