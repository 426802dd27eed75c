//! One material of every kind: the shipped cards, and parameters typical of a soft material for the laws that no card uses.
//!
//! Tests and validation cases that cover all laws run over these.

use std::path::Path;
use std::sync::Arc;

use super::Card;
use super::law::HyperelasticLaw;
use super::registry::CARDS;

/// Laws that no shipped card uses, and parameters of a usual soft material as a card states them, with semicolons between them.
const SAMPLES: &str = r#"
mooney-rivlin-3 | c10 = "0.04 MPa"; c01 = "0.01 MPa"; c11 = "2 kPa"
mooney-rivlin-5 | c10 = "0.04 MPa"; c01 = "0.01 MPa"; c20 = "3 kPa"; c11 = "2 kPa"; c02 = "1 kPa"
yeoh | c10 = "0.03 MPa"; c20 = "-2 kPa"; c30 = "1 kPa"
gent | mu = "0.05 MPa"; jm = 30
arruda-boyce | mu = "0.05 MPa"; lambda_m = 2.5
fung-demiray | mu = "0.05 MPa"; b = 0.4
veronda-westmann | c = "0.05 MPa"; beta = 0.4
ogden-1 | mu_1 = "0.05 MPa"; alpha_1 = 5.781; convention = "2mu/alpha^2"
ogden-2 | mu_1 = "0.04 MPa"; alpha_1 = 2; mu_2 = "-0.01 MPa"; alpha_2 = -2; convention = "mu/alpha"
ogden-3 | mu_1 = "0.04 MPa"; alpha_1 = 1.3; mu_2 = "0.001 MPa"; alpha_2 = 5; mu_3 = "0.01 MPa"; alpha_3 = -2.5; convention = "2mu/alpha^2"
ogden-4 | mu_1 = "0.04 MPa"; alpha_1 = 1; mu_2 = "1 kPa"; alpha_2 = 4; mu_3 = "3 kPa"; alpha_3 = -1; mu_4 = "0.1 kPa"; alpha_4 = 7; convention = "2mu/alpha^2"
marlow-table | strain = ["0 %", "10 %", "25 %", "60 %", "130 %", "400 %", "20000 %"]; stress = ["0 kPa", "18 kPa", "38 kPa", "100 kPa", "320 kPa", "3 MPa", "300 MPa"]; extrapolation = "linear"
holzapfel-gasser-ogden | mu = "0.02 MPa"; k1 = "0.03 MPa"; k2 = 0.3; kappa = 0.1; angle = "35 deg"; families = "two"
fung | c = "0.02 MPa"; a1 = 0.9; a2 = 0.5; a3 = 0.3; a4 = 0.4; angle = "25 deg"
may-newman | mu = "0.02 MPa"; c0 = "0.01 MPa"; c1 = 0.05; c2 = 0.8; angle = "-50 deg"
lee-sacks | c10 = "0.02 MPa"; c0 = "0.03 MPa"; c1 = 0.05; c2 = 0.2; delta = 0.4; angle = "25 deg"
holzapfel-ogden | a = "0.02 MPa"; b = 0.3; a_f = "0.03 MPa"; b_f = 0.2; a_s = "0.01 MPa"; b_s = 0.3; a_fs = "5 kPa"; b_fs = 0.4; angle = "35 deg"
energy | energy = "0.03*(I1 - 3) + 0.004*(I1 - 3)^2 + 0.01*log1p((I2 - 3)/3)"
energy | energy = "0.02*(I1 - 3) + 0.01*expm1(max(0.8*(C11 - 1) + 0.2*(C22 - 1) + 0.3*C12, 0)^2)"
"#;

/// Laws of bodies that change their volume, likewise.
const CHANGING_VOLUME: &str = r#"
neo-hooke-simo-pister | mu = "0.05 MPa"; poisson_ratio = 0.3
neo-hooke-ciarlet | mu = "0.05 MPa"; poisson_ratio = 0.4
blatz-ko | mu = "0.05 MPa"; share = 0.3; poisson_ratio = 0.25
ogden-hill-1 | mu_1 = "0.05 MPa"; alpha_1 = 3.5; nu_1 = 0
ogden-hill-2 | mu_1 = "0.04 MPa"; alpha_1 = 4; nu_1 = 0.1; mu_2 = "0.01 MPa"; alpha_2 = -1.5; nu_2 = 0.4
ogden-hill-3 | mu_1 = "0.04 MPa"; alpha_1 = 1.3; nu_1 = 0.45; mu_2 = "2 kPa"; alpha_2 = 5; nu_2 = 0.2; mu_3 = "0.01 MPa"; alpha_3 = -2.5; nu_3 = -0.1
saint-venant-kirchhoff | mu = "0.05 MPa"; poisson_ratio = 0.15
linear-elastic | mu = "0.05 MPa"; poisson_ratio = 0.3
flory-rehner | modulus = "0.02 MPa"; chi = 0.45; preparation_fraction = 0.1; chains = "affine"
"#;

/// A card of a law with parameters as a card states them.
///
/// # Panics
/// When the text is none of that law's parameters.
pub fn card(law: &str, parameters: &str) -> Card {
    let card = CARDS[0].1;
    let (head, rest) = card.split_once("[parameters]").unwrap();
    let (_, rest) = rest.split_once("[data]").unwrap();
    let head = head.replace("marlow-exponential", law);
    let text = format!("{head}[parameters]\n{parameters}\n[data]{rest}");
    Card::parse(law, law, &text).unwrap()
}

/// Laws and parameters.
type Samples = Vec<(&'static str, String)>;

fn read(text: &'static str) -> Samples {
    let lines = text.lines().filter_map(|line| line.split_once(" | "));
    lines
        .map(|(law, parameters)| (law, parameters.replace("; ", "\n")))
        .collect()
}

/// Laws that no shipped card uses, with their parameters.
pub fn samples() -> Samples {
    read(SAMPLES)
}

/// Laws of bodies that change their volume, with their parameters.
pub fn samples_changing_volume() -> Samples {
    read(CHANGING_VOLUME)
}

/// The parameters of the first sample of a law.
///
/// # Panics
/// Where there is none.
pub fn parameters(law: &str) -> String {
    let mut all = samples().into_iter().chain(samples_changing_volume());
    let (_, parameters) = all.find(|(name, _)| *name == law).expect("a sample");
    parameters
}

/// All shipped cards and a card of each of [`samples`].
pub fn cards() -> Vec<Card> {
    let shipped =
        |(name, _): &(&str, &str)| Card::load(name, Path::new(".")).expect("a shipped card");
    let samples = samples()
        .into_iter()
        .map(|(law, parameters)| card(law, &parameters));
    CARDS.iter().map(shipped).chain(samples).collect()
}

/// The laws of all [`cards`] by name.
pub fn all() -> Vec<(&'static str, Arc<dyn HyperelasticLaw>)> {
    let names = CARDS.iter().map(|(name, _)| *name);
    let names = names.chain(samples().into_iter().map(|(name, _)| name));
    names
        .zip(cards().into_iter().map(|card| card.law))
        .collect()
}

/// A card of each of [`samples_changing_volume`].
pub fn changing_volume() -> Vec<Card> {
    let samples = samples_changing_volume().into_iter();
    samples
        .map(|(law, parameters)| card(law, &parameters))
        .collect()
}
