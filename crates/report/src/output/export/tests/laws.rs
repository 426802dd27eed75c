//! The laws in the keywords of other codes: the stresses that a code computes from the exported file are those of the law.

use super::published::{Exported, Sheet, published};
use super::*;
use crate::material::curve::Mode;
use crate::material::registry::LAWS;
use crate::material::samples;
use crate::material::{EnergyDerivatives, InvariantLaw, Invariants};

/// ∂Ψ/∂Fᵢ by central differences.
fn slope(energy: &dyn Fn([f64; 3]) -> f64, at: [f64; 3], i: usize) -> f64 {
    let h = 1e-5;
    let moved = |step: f64| {
        let mut moved = at;
        moved[i] += step;
        energy(moved)
    };
    (moved(h) - moved(-h)) / (2.0 * h)
}

/// The nominal stress along the first axis; the edges of a strip find their place by Newton's method.
fn nominal(energy: &dyn Fn([f64; 3]) -> f64, mode: Mode, strain: f64) -> f64 {
    let stretch = 1.0 + strain;
    let mut f = match mode {
        Mode::Uniaxial => [stretch, 0.0, stretch.powf(-0.5)],
        Mode::Planar => [stretch, 0.0, 1.0],
        Mode::Equibiaxial => [stretch, 0.0, stretch],
    };
    for _ in 0..if mode == Mode::Uniaxial { 20 } else { 0 } {
        let residual = |f: [f64; 3]| [slope(energy, f, 1), slope(energy, f, 2)];
        let h = 1e-4;
        let column = |i: usize| {
            let (mut more, mut less) = (f, f);
            more[i] += h;
            less[i] -= h;
            let (more, less) = (residual(more), residual(less));
            [0, 1].map(|row| (more[row] - less[row]) / (2.0 * h))
        };
        let ([a, c], [b, d], [r, s]) = (column(1), column(2), residual(f));
        let determinant = a * d - b * c;
        f[1] -= (d * r - b * s) / determinant;
        f[2] -= (a * s - c * r) / determinant;
    }
    slope(energy, f, 0)
}

/// The largest deviation of stresses from the law's own, relative to the stress, over the usual tests.
fn deviation(card: &Card, energy: &dyn Fn(&Sheet) -> f64) -> f64 {
    let energy = |f: [f64; 3]| energy(&Sheet::new(f));
    let strains = [-0.15, 0.1, 0.4, 0.9];
    let states = Mode::ALL
        .into_iter()
        .flat_map(|(_, mode)| strains.map(|strain| (mode, strain)));
    let errors = states.map(|(mode, strain)| {
        let expected = mode.nominal_stress(&*card.law, strain);
        (nominal(&energy, mode, strain) / expected - 1.0).abs()
    });
    errors.fold(0.0, f64::max)
}

/// The words of Abaqus, CalculiX and FEBio for every law of the registry; `None` where the code lacks it.
const WORDS: [(&str, [Option<&str>; 3]); 30] = [
    (
        "neo-hooke",
        [Some("NEO HOOKE"), Some("NEO HOOKE"), Some("Mooney-Rivlin")],
    ),
    (
        "mooney-rivlin",
        [
            Some("MOONEY-RIVLIN"),
            Some("MOONEY-RIVLIN"),
            Some("Mooney-Rivlin"),
        ],
    ),
    (
        "mooney-rivlin-3",
        [
            Some("POLYNOMIAL, N=2"),
            Some("POLYNOMIAL, N=2"),
            Some("polynomial"),
        ],
    ),
    (
        "mooney-rivlin-5",
        [
            Some("POLYNOMIAL, N=2"),
            Some("POLYNOMIAL, N=2"),
            Some("polynomial"),
        ],
    ),
    ("yeoh", [Some("YEOH"), Some("YEOH"), None]),
    (
        "ogden-1",
        [Some("OGDEN, N=1"), Some("OGDEN, N=1"), Some("Ogden")],
    ),
    (
        "ogden-2",
        [Some("OGDEN, N=2"), Some("OGDEN, N=2"), Some("Ogden")],
    ),
    (
        "ogden-3",
        [Some("OGDEN, N=3"), Some("OGDEN, N=3"), Some("Ogden")],
    ),
    ("ogden-4", [Some("OGDEN, N=4"), None, Some("Ogden")]),
    ("gent", [Some("MARLOW"), None, Some("Gent")]),
    (
        "arruda-boyce",
        [Some("ARRUDA-BOYCE"), Some("ARRUDA-BOYCE"), None],
    ),
    ("fung-demiray", [Some("MARLOW"), None, None]),
    ("veronda-westmann", [None, None, Some("Veronda-Westmann")]),
    ("marlow-exponential", [Some("MARLOW"), None, None]),
    ("energy", [None; 3]),
    ("marlow-table", [Some("MARLOW"), None, None]),
    (
        "holzapfel-gasser-ogden",
        [Some("HOLZAPFEL"), None, Some("Holzapfel-Gasser-Ogden")],
    ),
    ("fung", [Some("FUNG-ORTHOTROPIC"), None, None]),
    ("may-newman", [None; 3]),
    ("lee-sacks", [None; 3]),
    ("holzapfel-ogden", [None; 3]),
    ("neo-hooke-simo-pister", [None; 3]),
    ("neo-hooke-ciarlet", [None; 3]),
    ("blatz-ko", [None; 3]),
    ("ogden-hill-1", [None; 3]),
    ("ogden-hill-2", [None; 3]),
    ("ogden-hill-3", [None; 3]),
    ("saint-venant-kirchhoff", [None; 3]),
    ("linear-elastic", [None; 3]),
    ("flory-rehner", [None; 3]),
];

/// The stresses that a code's published formula gives for what is exported are the law's own to 1e-6; those of a curve of
/// 400 points with straight lines between them to 1e-4.
#[test]
fn every_law_has_its_own_stresses_in_every_code_or_is_refused() {
    let fibres = |families: &str, angle: &str| {
        let rest = "mu = \"0.02 MPa\"\nk1 = \"0.05 MPa\"\nk2 = 0.4\nkappa = 0.1";
        let text = format!("{rest}\nangle = \"{angle} deg\"\nfamilies = \"{families}\"");
        samples::card("holzapfel-gasser-ogden", &text)
    };
    let mut cards = samples::cards();
    cards.extend(samples::changing_volume());
    cards.extend([fibres("one", "20"), fibres("one", "0"), fibres("two", "60")]);
    for law in LAWS {
        let [.., (_, words)] = WORDS
            .iter()
            .filter(|(name, _)| *name == law.name)
            .collect::<Vec<_>>()[..]
        else {
            panic!("the words for {} are missing", law.name);
        };
        let cards_of_law: Vec<_> = cards
            .iter()
            .filter(|card| card.law_name == law.name)
            .collect();
        assert!(!cards_of_law.is_empty(), "{}", law.name);
        for (card, ((_, code), word)) in cards_of_law.iter().flat_map(|card| {
            Code::NAMES
                .into_iter()
                .zip(words)
                .map(move |pair| (card, pair))
        }) {
            let file = written(card, code, CellShape::Quad4);
            let Some(word) = word else {
                assert_refused(card, code, file);
                continue;
            };
            let exported = Exported::read(code, &file.unwrap().text);
            assert_eq!(exported.keyword, *word, "{}", card.name);
            let allowed = if *word == "MARLOW" { 1e-4 } else { 1e-6 };
            let error = deviation(card, &|sheet| published(&exported, sheet));
            assert!(
                error < allowed,
                "{} of {} in {}: {error:.1e}",
                law.name,
                card.name,
                code.name()
            );
            if !["MARLOW", "HOLZAPFEL"].contains(word) {
                assert_compressibility(card, code, &exported);
            }
        }
    }
}

/// K = 2/D₁ in CalculiX, `k` or twice `D1` in FEBio, no compressibility in Abaqus.
fn assert_compressibility(card: &Card, code: Code, exported: &Exported) {
    let last = exported.values[exported.values.len() - 1];
    let bulk = 1000.0 * card.law.shear_modulus();
    let expected = match code {
        Code::Abaqus => 0.0,
        Code::CalculiX => 2.0 / bulk,
        Code::FeBio if exported.keyword == "polynomial" => bulk / 2.0,
        Code::FeBio => bulk,
    };
    let error = (last - expected).abs();
    assert!(
        error <= 1e-10 * expected,
        "{}: {last} for {expected}",
        card.name
    );
}

fn assert_refused(card: &Card, code: Code, file: Result<InputFile, Error>) {
    let message = file.expect_err(&card.name).to_string();
    if card.bulk_modulus().is_some() {
        assert!(message.contains("is compressible"), "{message}");
        return;
    }
    for expected in [
        code.name(),
        &card.law_name,
        "Ogden",
        "gelbench materials fit",
    ] {
        assert!(message.contains(expected), "{message}");
    }
}

/// μ/α for 2 μ/α² is seen, and so is a curve of the first invariant for a law of the second.
#[test]
fn a_wrong_convention_is_seen_in_the_stresses() {
    let cards = samples::cards();
    let named = |name: &str| cards.iter().find(|card| card.name == name).unwrap();
    let ogden = named("ogden-3");
    let text = written(ogden, Code::Abaqus, CellShape::Quad4).unwrap().text;
    let mut exported = Exported::read(Code::Abaqus, &text);
    assert!(deviation(ogden, &|sheet| published(&exported, sheet)) < 1e-6);
    for term in exported.values[..6].chunks_exact_mut(2) {
        term[0] *= 2.0 / term[1];
    }
    assert!(deviation(ogden, &|sheet| published(&exported, sheet)) > 0.1);
    let veronda = named("veronda-westmann");
    let point = |i: i32| {
        let strain = 0.005 * f64::from(i);
        [
            veronda.law.tension([1.0, 0.0], strain).nominal_stress,
            strain,
        ]
    };
    let curve = (0..=400).flat_map(point).collect();
    let marlow = Exported {
        keyword: "MARLOW".into(),
        values: curve,
        directions: Vec::new(),
    };
    assert!(deviation(veronda, &|sheet| published(&marlow, sheet)) > 0.1);
}

/// Ψ = C (I₁ − 3)(I₂ − 3) + C (I₁ − 3), a law that gelbench does not know.
#[derive(Debug)]
struct Unknown;

impl InvariantLaw for Unknown {
    fn evaluate(&self, at: Invariants) -> EnergyDerivatives {
        let (c, x, y) = (0.1, at.i1_minus_3, at.i2_minus_3);
        EnergyDerivatives {
            energy: c * x * (1.0 + y),
            d1: c * (1.0 + y),
            d2: c * x,
            d12: c,
            ..EnergyDerivatives::default()
        }
    }
}

#[test]
fn a_law_that_states_no_form_is_refused_by_every_code() {
    let card = Card::of_law("product", std::sync::Arc::new(Unknown), [1.0, 2.0]);
    for (_, code) in Code::NAMES {
        assert_refused(&card, code, written(&card, code, CellShape::Quad4));
    }
}
