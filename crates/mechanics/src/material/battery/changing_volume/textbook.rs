//! The formulas of textbooks, by principal stretches.

use super::*;
use crate::material::volume::lame_modulus;

/// ∂W/∂λᵢ of a body by its principal stretches, in MPa.
pub type Principal = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

/// The textbook's stress of the energies that are sums of one function of each stretch and one of J.
fn separable(
    of_stretch: impl Fn(f64) -> f64 + 'static,
    of_volume: impl Fn(f64) -> f64 + 'static,
) -> Principal {
    Box::new(move |stretches| {
        let j: f64 = stretches.iter().product();
        stretches.map(|stretch| of_stretch(stretch) + of_volume(j) * j / stretch)
    })
}

/// The textbook's stress of Ogden and Hill's foams: μ, α and ν of each term.
fn foam(terms: &'static [[f64; 3]]) -> Principal {
    separable(
        move |l| {
            terms
                .iter()
                .map(|[mu, alpha, _]| 2.0 * mu / alpha * l.powf(alpha - 1.0))
                .sum()
        },
        move |j| {
            let term = |[mu, alpha, nu]: &[f64; 3]| {
                -2.0 * mu / alpha * j.powf(-alpha * nu / (1.0 - 2.0 * nu) - 1.0)
            };
            terms.iter().map(term).sum()
        },
    )
}

/// Textbook formulas of all laws of [`samples::changing_volume`] and of a split law.
pub fn textbook() -> Vec<(&'static str, Arc<dyn HyperelasticLaw>, Principal)> {
    let law = |name: &str| {
        let cards = samples::changing_volume();
        let card = cards.into_iter().find(|card| card.name == name);
        card.expect("a sample").law
    };
    let (mu, simo, ciarlet) = (0.05, lame_modulus(0.05, 0.3), lame_modulus(0.05, 0.4));
    let kirchhoff = lame_modulus(0.05, 0.15);
    let of_cards: Vec<(&'static str, Principal)> = vec![
        (
            "neo-hooke-simo-pister",
            separable(move |l| mu * l, move |j| (simo * j.ln() - mu) / j),
        ),
        (
            "neo-hooke-ciarlet",
            separable(
                move |l| mu * l,
                move |j| 0.5 * ciarlet * (j - 1.0 / j) - mu / j,
            ),
        ),
        (
            "blatz-ko",
            separable(
                move |l| mu * (0.3 * l - 0.7 * l.powi(-3)),
                move |j| mu * (0.7 - 0.3 * j.powi(-2)),
            ),
        ),
        ("ogden-hill-1", foam(&[[0.05, 3.5, 0.0]])),
        ("ogden-hill-2", foam(&[[0.04, 4.0, 0.1], [0.01, -1.5, 0.4]])),
        (
            "ogden-hill-3",
            foam(&[[0.04, 1.3, 0.45], [0.002, 5.0, 0.2], [0.01, -2.5, -0.1]]),
        ),
        (
            "saint-venant-kirchhoff",
            Box::new(move |stretches| {
                let strains = stretches.map(|stretch| 0.5 * (stretch * stretch - 1.0));
                let trace: f64 = strains.iter().sum();
                [0, 1, 2].map(|i| stretches[i] * (kirchhoff * trace + 2.0 * mu * strains[i]))
            }),
        ),
        (
            "linear-elastic",
            Box::new(move |stretches| {
                let trace: f64 = stretches.iter().sum::<f64>() - 3.0;
                stretches.map(|stretch| simo * trace + 2.0 * mu * (stretch - 1.0))
            }),
        ),
        ("flory-rehner", gel()),
    ];
    let of_cards = of_cards.into_iter();
    of_cards
        .map(|(name, stress)| (name, law(name), stress))
        .chain([logarithmic(mu)])
        .collect()
}

/// A law of invariants with the logarithmic energy of the volume, and its textbook formula.
fn logarithmic(mu: f64) -> (&'static str, Arc<dyn HyperelasticLaw>, Principal) {
    let volume = Volume {
        bulk_modulus: 0.2,
        energy: VolumeEnergy::Logarithmic,
        plane: PlaneState::Stress,
    };
    let law = Arc::new(crate::material::NeoHooke { c10: 0.5 * mu }).with_volume(volume);
    let stress = move |stretches: [f64; 3]| {
        let j: f64 = stretches.iter().product();
        let first: f64 = stretches.iter().map(|l| l * l).sum();
        let scale = mu * j.powf(-2.0 / 3.0);
        stretches.map(|l| scale * (l - first / (3.0 * l)) + 0.2 * j.ln() / l)
    };
    let law = law.expect("a law of invariants");
    ("neo-hooke, logarithmic", law, Box::new(stress))
}

/// The gel of the samples by its free energy per volume as prepared: strands stretched by λᵢ⁰ = λₛ λᵢ, and Flory and Huggins' mixing.
/// Per volume of the freely swollen gel, ∂W/∂λᵢ = λₛ/λₛ³ ∂W⁰/∂λᵢ⁰.
fn gel() -> Principal {
    let (modulus, chi, fraction, osmotic) = (0.02, 0.45, 0.1, 8314.462618 * 298.15 / 18070.0);
    let prepared = move |stretches: [f64; 3]| {
        let j: f64 = stretches.iter().product();
        let phi = fraction / j;
        let mixing = osmotic * ((1.0 - phi).ln() + phi + chi * phi * phi);
        stretches.map(|l| modulus * (l - 0.5 / l) + mixing * j / l)
    };
    let swollen = root(|l| prepared([l; 3])[0]);
    Box::new(move |stretches| {
        prepared(stretches.map(|l| swollen * l)).map(|p| p / (swollen * swollen))
    })
}
