//! One material of every kind: the shipped cards, and parameters typical of a soft material for the laws that no card uses.
//!
//! Tests and validation cases that cover all laws run over these.

use std::path::Path;
use std::sync::Arc;

use super::Card;
use super::law::HyperelasticLaw;
use super::registry::CARDS;

/// Laws that no shipped card uses, and parameters of a usual soft material as a card states them.
pub const SAMPLES: &[(&str, &str)] = &[
    (
        "mooney-rivlin-3",
        "c10 = \"0.04 MPa\"\nc01 = \"0.01 MPa\"\nc11 = \"2 kPa\"",
    ),
    (
        "mooney-rivlin-5",
        "c10 = \"0.04 MPa\"\nc01 = \"0.01 MPa\"\nc20 = \"3 kPa\"\nc11 = \"2 kPa\"\nc02 = \"1 kPa\"",
    ),
    (
        "yeoh",
        "c10 = \"0.03 MPa\"\nc20 = \"-2 kPa\"\nc30 = \"1 kPa\"",
    ),
    ("gent", "mu = \"0.05 MPa\"\njm = 30"),
    ("arruda-boyce", "mu = \"0.05 MPa\"\nlambda_m = 2.5"),
    ("fung-demiray", "mu = \"0.05 MPa\"\nb = 0.4"),
    ("veronda-westmann", "c = \"0.05 MPa\"\nbeta = 0.4"),
    (
        "ogden-1",
        "mu_1 = \"0.05 MPa\"\nalpha_1 = 5.781\nconvention = \"2mu/alpha^2\"",
    ),
    (
        "ogden-2",
        "mu_1 = \"0.04 MPa\"\nalpha_1 = 2\nmu_2 = \"-0.01 MPa\"\nalpha_2 = -2\nconvention = \"mu/alpha\"",
    ),
    (
        "ogden-3",
        "mu_1 = \"0.04 MPa\"\nalpha_1 = 1.3\nmu_2 = \"0.001 MPa\"\nalpha_2 = 5\nmu_3 = \"0.01 MPa\"\nalpha_3 = -2.5\nconvention = \"2mu/alpha^2\"",
    ),
    (
        "ogden-4",
        "mu_1 = \"0.04 MPa\"\nalpha_1 = 1\nmu_2 = \"1 kPa\"\nalpha_2 = 4\nmu_3 = \"3 kPa\"\nalpha_3 = -1\nmu_4 = \"0.1 kPa\"\nalpha_4 = 7\nconvention = \"2mu/alpha^2\"",
    ),
    (
        "marlow-table",
        "strain = [\"0 %\", \"10 %\", \"25 %\", \"60 %\", \"130 %\", \"400 %\", \"20000 %\"]\nstress = [\"0 kPa\", \"18 kPa\", \"38 kPa\", \"100 kPa\", \"320 kPa\", \"3 MPa\", \"300 MPa\"]\nextrapolation = \"linear\"",
    ),
    (
        "holzapfel-gasser-ogden",
        "mu = \"0.02 MPa\"\nk1 = \"0.03 MPa\"\nk2 = 0.3\nkappa = 0.1\nangle = \"35 deg\"\nfamilies = \"two\"",
    ),
    (
        "fung",
        "c = \"0.02 MPa\"\na1 = 0.9\na2 = 0.5\na3 = 0.3\na4 = 0.4\nangle = \"25 deg\"",
    ),
    (
        "may-newman",
        "mu = \"0.02 MPa\"\nc0 = \"0.01 MPa\"\nc1 = 0.05\nc2 = 0.8\nangle = \"-50 deg\"",
    ),
    (
        "lee-sacks",
        "c10 = \"0.02 MPa\"\nc0 = \"0.03 MPa\"\nc1 = 0.05\nc2 = 0.2\ndelta = 0.4\nangle = \"25 deg\"",
    ),
    (
        "holzapfel-ogden",
        "a = \"0.02 MPa\"\nb = 0.3\na_f = \"0.03 MPa\"\nb_f = 0.2\na_s = \"0.01 MPa\"\nb_s = 0.3\na_fs = \"5 kPa\"\nb_fs = 0.4\nangle = \"35 deg\"",
    ),
    (
        "energy",
        "energy = \"0.03*(I1 - 3) + 0.004*(I1 - 3)^2 + 0.01*log1p((I2 - 3)/3)\"",
    ),
    (
        "energy",
        "energy = \"0.02*(I1 - 3) + 0.01*expm1(max(0.8*(C11 - 1) + 0.2*(C22 - 1) + 0.3*C12, 0)^2)\"",
    ),
];

/// Laws of bodies that change their volume, as [`SAMPLES`].
pub const CHANGING_VOLUME: &[(&str, &str)] = &[
    (
        "neo-hooke-simo-pister",
        "mu = \"0.05 MPa\"\npoisson_ratio = 0.3",
    ),
    (
        "neo-hooke-ciarlet",
        "mu = \"0.05 MPa\"\npoisson_ratio = 0.4",
    ),
    (
        "blatz-ko",
        "mu = \"0.05 MPa\"\nshare = 0.3\npoisson_ratio = 0.25",
    ),
    (
        "ogden-hill-1",
        "mu_1 = \"0.05 MPa\"\nalpha_1 = 3.5\nnu_1 = 0",
    ),
    (
        "ogden-hill-2",
        "mu_1 = \"0.04 MPa\"\nalpha_1 = 4\nnu_1 = 0.1\nmu_2 = \"0.01 MPa\"\nalpha_2 = -1.5\nnu_2 = 0.4",
    ),
    (
        "ogden-hill-3",
        "mu_1 = \"0.04 MPa\"\nalpha_1 = 1.3\nnu_1 = 0.45\nmu_2 = \"2 kPa\"\nalpha_2 = 5\nnu_2 = 0.2\nmu_3 = \"0.01 MPa\"\nalpha_3 = -2.5\nnu_3 = -0.1",
    ),
    (
        "saint-venant-kirchhoff",
        "mu = \"0.05 MPa\"\npoisson_ratio = 0.15",
    ),
    ("linear-elastic", "mu = \"0.05 MPa\"\npoisson_ratio = 0.3"),
    (
        "flory-rehner",
        "modulus = \"0.02 MPa\"\nchi = 0.45\npreparation_fraction = 0.1\nchains = \"affine\"",
    ),
];

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

/// All shipped cards and a card of each of [`SAMPLES`].
pub fn cards() -> Vec<Card> {
    let shipped =
        |(name, _): &(&str, &str)| Card::load(name, Path::new(".")).expect("a shipped card");
    let samples = SAMPLES
        .iter()
        .map(|(law, parameters)| card(law, parameters));
    CARDS.iter().map(shipped).chain(samples).collect()
}

/// The laws of all [`cards`] by name.
pub fn all() -> Vec<(&'static str, Arc<dyn HyperelasticLaw>)> {
    let names = CARDS.iter().chain(SAMPLES).map(|(name, _)| *name);
    names
        .zip(cards().into_iter().map(|card| card.law))
        .collect()
}

/// A card of each of [`CHANGING_VOLUME`].
pub fn changing_volume() -> Vec<Card> {
    let samples = CHANGING_VOLUME.iter();
    samples
        .map(|(law, parameters)| card(law, parameters))
        .collect()
}
