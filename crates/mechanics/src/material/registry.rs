//! The laws and the shipped cards by name.

use super::energy;
use super::law::HyperelasticLaw;
use super::marlow::{ExponentialCurve, TableCurve};
use super::ogden::Convention;
use super::parameters::{CardEntries, Parameters, StrainMeasure, StressMeasure};
use super::{
    ArrudaBoyce, CompressibleNeoHooke, Fung, FungDemiray, Gent, HolzapfelGasserOgden,
    HolzapfelOgden, LeeSacks, LinearElastic, MayNewman, MooneyRivlin, NeoHooke, Network, Ogden,
    OgdenHill, Polynomial, SaintVenantKirchhoff, VerondaWestmann, Yeoh,
};

/// A file of test data by its stem.
macro_rules! data {
    ($stem:literal) => {
        (
            concat!("data/", $stem, ".csv"),
            include_str!(concat!("../../../../materials/data/", $stem, ".csv")),
        )
    };
}

/// A card by its name.
macro_rules! card {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../../materials/", $name, ".toml")),
        )
    };
}

/// A law by name.
#[derive(Debug)]
pub struct Law {
    /// Its name on a card.
    pub name: &'static str,
    /// Its energy.
    pub formula: &'static str,
    /// Builds the law from the parameters of a card.
    pub read: fn(&Parameters) -> Box<dyn HyperelasticLaw>,
}

impl Law {
    /// The law with a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        LAWS.iter().find(|law| law.name == name)
    }

    /// The same law with a choice of its cards where values alone are given, such as `families` `one`; `None` where it has none such.
    pub fn choosing(&self, key: &str, choice: &str) -> Option<&'static Self> {
        let all = LAWS.iter().chain(CHOSEN);
        let has_choice = |law: &&'static Self| {
            let choices = law.unknown().1.choices;
            let is_choice = |(known, name): &(&str, String)| *known == key && name == choice;
            choices.iter().any(is_choice)
        };
        all.filter(|law| law.name == self.name).find(has_choice)
    }

    /// The law of a card by its name and choices.
    pub fn of_card(name: &str, choices: &[(&'static str, String)]) -> Option<&'static Self> {
        let law = Self::named(name)?;
        let mut chosen = choices.iter();
        let chosen = chosen.find_map(|(key, choice)| law.choosing(key, choice));
        Some(chosen.unwrap_or(law))
    }

    /// The laws that have parameters, or take the curve of a test: those that are fitted.
    pub fn fitted() -> impl Iterator<Item = &'static Self> + Clone {
        LAWS.iter().filter(|law| law.name != ENERGY)
    }

    /// Whether the law is the curve of a test, whose measures belong to it.
    pub fn is_measured_curve(&self) -> bool {
        [MARLOW_EXPONENTIAL, MARLOW_TABLE].contains(&self.name)
    }

    /// Its energy in the convention that a card chooses.
    pub fn formula_of(&self, choices: &[(&'static str, String)]) -> &'static str {
        let named = choices.iter().find(|(key, _)| *key == "convention");
        let convention = named.and_then(|(_, name)| {
            let mut known = Convention::NAMES.iter();
            known.find(|(known, _)| known == name)
        });
        convention.map_or(self.formula, |(_, convention)| convention.formula())
    }

    /// The law with parameter values in internal units, and the entries that it read.
    pub fn with_values(
        &self,
        values: &[f64],
        stress_measure: StressMeasure,
        strain_measure: StrainMeasure,
    ) -> (Box<dyn HyperelasticLaw>, CardEntries) {
        let parameters = Parameters::of_values(values, stress_measure, strain_measure);
        let law = (self.read)(&parameters);
        (law, parameters.finish())
    }

    /// The law with unknown parameters, and the entries that a card of it has.
    pub fn unknown(&self) -> (Box<dyn HyperelasticLaw>, CardEntries) {
        self.with_values(&[], StressMeasure::Nominal, StrainMeasure::Nominal)
    }
}

/// The law that is a formula.
const ENERGY: &str = "energy";

/// A row of the table.
const fn law(
    name: &'static str,
    formula: &'static str,
    read: fn(&Parameters) -> Box<dyn HyperelasticLaw>,
) -> Law {
    Law {
        name,
        formula,
        read,
    }
}

/// Every law.
pub const LAWS: &[Law] = &[
    law("neo-hooke", "Ψ = C₁₀ (I₁ − 3)", NeoHooke::from_card),
    law(
        "mooney-rivlin",
        "Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3)",
        MooneyRivlin::from_card,
    ),
    law(
        "mooney-rivlin-3",
        "Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3) + C₁₁ (I₁ − 3)(I₂ − 3)",
        Polynomial::from_card_3,
    ),
    law(
        "mooney-rivlin-5",
        "Ψ = C₁₀ (I₁ − 3) + C₀₁ (I₂ − 3) + C₂₀ (I₁ − 3)² + C₁₁ (I₁ − 3)(I₂ − 3) + C₀₂ (I₂ − 3)²",
        Polynomial::from_card_5,
    ),
    law(
        "yeoh",
        "Ψ = C₁₀ (I₁ − 3) + C₂₀ (I₁ − 3)² + C₃₀ (I₁ − 3)³",
        Yeoh::from_card,
    ),
    law("ogden-1", OGDEN, Ogden::from_card::<1>),
    law("ogden-2", OGDEN, Ogden::from_card::<2>),
    law("ogden-3", OGDEN, Ogden::from_card::<3>),
    law("ogden-4", OGDEN, Ogden::from_card::<4>),
    law("gent", "Ψ = −½ μ Jₘ ln(1 − (I₁ − 3)/Jₘ)", Gent::from_card),
    law(
        "arruda-boyce",
        "Ψ = μ Σ Cᵢ λₘ^(2 − 2i) (I₁ⁱ − 3ⁱ), five terms",
        ArrudaBoyce::from_card,
    ),
    law(
        "fung-demiray",
        "Ψ = μ/(2 b) (e^(b (I₁ − 3)) − 1)",
        FungDemiray::from_card,
    ),
    law(
        "veronda-westmann",
        "Ψ = C (e^(β (I₁ − 3)) − 1) − ½ C β (I₂ − 3)",
        VerondaWestmann::from_card,
    ),
    law(
        ENERGY,
        "Ψ(I₁, I₂) or Ψ(C₁₁, C₁₂, C₂₂) as the card writes it",
        energy::from_card,
    ),
    law(
        MARLOW_EXPONENTIAL,
        "Ψ(I₁) from the tension curve A (e^(b ε) − 1)",
        ExponentialCurve::from_card,
    ),
    law(
        MARLOW_TABLE,
        "Ψ(I₁) from a measured tension curve",
        TableCurve::from_card,
    ),
    law(
        HOLZAPFEL_GASSER_OGDEN,
        FIBRES,
        HolzapfelGasserOgden::from_card,
    ),
    law(
        "fung",
        "Ψ = c/2 (e^Q − 1), Q = a₁ E₁₁² + a₂ E₂₂² + 2 a₃ E₁₁ E₂₂ + a₄ (2 E₁₂)²",
        Fung::from_card,
    ),
    law(
        "may-newman",
        "Ψ = μ/2 (I₁ − 3) + c₀ (e^(c₁ (I₁ − 3)² + c₂ (√I₄ − 1)⁴) − 1)",
        MayNewman::from_card,
    ),
    law(
        "lee-sacks",
        "Ψ = c₁₀/2 (I₁ − 3) + c₀/2 (δ e^(c₁ (I₁ − 3)²) + (1 − δ) e^(c₂ ⟨I₄ − 1⟩²) − 1)",
        LeeSacks::from_card,
    ),
    law(
        "holzapfel-ogden",
        "Ψ = a/(2b) (e^(b (I₁ − 3)) − 1) + Σ aᵢ/(2bᵢ) (e^(bᵢ ⟨I₄ᵢ − 1⟩²) − 1) + a_fs/(2b_fs) (e^(b_fs I₈²) − 1), i = f, s",
        HolzapfelOgden::from_card,
    ),
    law(
        "neo-hooke-simo-pister",
        "W = μ/2 (I₁ − 3 − 2 ln J) + Λ/2 ln² J, Λ = 2μν/(1 − 2ν)",
        CompressibleNeoHooke::<true>::from_card,
    ),
    law(
        "neo-hooke-ciarlet",
        "W = μ/2 (I₁ − 3 − 2 ln J) + Λ/4 (J² − 1 − 2 ln J), Λ = 2μν/(1 − 2ν)",
        CompressibleNeoHooke::<false>::from_card,
    ),
    law(
        "blatz-ko",
        "W = μ/2 f (I₁ − 3 + (J^(−2β) − 1)/β) + μ/2 (1 − f) (I₂/J² − 3 + (J^(2β) − 1)/β), β = ν/(1 − 2ν)",
        OgdenHill::blatz_ko_from_card,
    ),
    law("ogden-hill-1", OGDEN_HILL, OgdenHill::from_card::<1>),
    law("ogden-hill-2", OGDEN_HILL, OgdenHill::from_card::<2>),
    law("ogden-hill-3", OGDEN_HILL, OgdenHill::from_card::<3>),
    law(
        "saint-venant-kirchhoff",
        "W = Λ/2 (tr E)² + μ E : E, E = (FᵀF − 1)/2, Λ = 2μν/(1 − 2ν)",
        SaintVenantKirchhoff::from_card,
    ),
    law(
        "linear-elastic",
        "W = Λ/2 (tr ε)² + μ ε : ε, ε = (H + Hᵀ)/2, Λ = 2μν/(1 − 2ν)",
        LinearElastic::from_card,
    ),
    law(
        SWELLING,
        "W/φ = G₀/(2φ₀) (λ₁² + λ₂² + λ₃² − 3 − B ln J₀) + RT/V₁ ((Q − 1) ln(1 − 1/Q) + χ (1 − 1/Q) − Q ln a)",
        Network::from_card,
    ),
];

/// Laws of the table above with another choice where values alone are given, as in fits.
const CHOSEN: &[Law] = &[law(
    HOLZAPFEL_GASSER_OGDEN,
    FIBRES,
    HolzapfelGasserOgden::one_family_from_card,
)];

/// The law with one or two families of fibres.
const HOLZAPFEL_GASSER_OGDEN: &str = "holzapfel-gasser-ogden";

const FIBRES: &str =
    "Ψ = μ/2 (I₁ − 3) + Σ k₁/(2 k₂) (e^(k₂ ⟨E⟩²) − 1), E = κ (I₁ − 3) + (1 − 3κ)(I₄ − 1)";

const OGDEN_HILL: &str =
    "W = Σ 2 μᵢ/αᵢ² (λ₁^αᵢ + λ₂^αᵢ + λ₃^αᵢ − 3 + (J^(−αᵢ βᵢ) − 1)/βᵢ), βᵢ = νᵢ/(1 − 2νᵢ)";

/// Ogden's law in the first convention.
const OGDEN: &str = Convention::TwoMuByAlphaSquared.formula();

/// The law that is the exponential tension curve of a test.
const MARLOW_EXPONENTIAL: &str = "marlow-exponential";

/// The law of a swollen network, of which tests alone determine too little.
pub const SWELLING: &str = "flory-rehner";

/// The law that takes a measured curve as it is, without parameters to fit.
pub const MARLOW_TABLE: &str = "marlow-table";

/// The test data behind the shipped cards: path as the cards name it, and text.
pub const DATA: &[(&str, &str)] = &[
    data!("pva_10_uniaxial"),
    data!("treloar_1944_uniaxial"),
    data!("treloar_1944_planar"),
    data!("treloar_1944_equibiaxial"),
    data!("meunier_2008_uniaxial"),
    data!("meunier_2008_planar"),
    data!("meunier_2008_equibiaxial"),
    data!("katashima_2012_equibiaxial"),
    data!("katashima_2012_planar_direction1"),
    data!("katashima_2012_planar_direction2"),
    data!("katashima_2012_unequal-biaxial_direction1"),
    data!("katashima_2012_unequal-biaxial_direction2"),
];

/// Every shipped card: its name and its text.
pub const CARDS: &[(&str, &str)] = &[
    card!("pva-10"),
    card!("pva-10-cauchy"),
    card!("pva-10-ogden-1"),
    card!("pva-10-yeoh"),
    card!("treloar-ogden-3"),
    card!("meunier-yeoh"),
    card!("katashima-ogden-2"),
    card!("neo-hooke"),
    card!("mooney-rivlin"),
];
