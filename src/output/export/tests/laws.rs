//! The laws in the words of other codes: the stresses that a code computes from what is exported are those of the law.

use super::*;
use crate::material::curve::Mode;
use crate::material::registry::LAWS;
use crate::material::samples;
use crate::material::{EnergyDerivatives, InvariantLaw, Invariants};

/// What a code reads of a law: keyword, parameters in order (or points of a curve), and directions.
struct Exported {
    keyword: String,
    values: Vec<f64>,
    directions: Vec<[f64; 2]>,
}

impl Exported {
    fn read(code: Code, text: &str) -> Self {
        match code {
            Code::FeBio => Self::of_xml(text),
            _ => Self::of_deck(text),
        }
    }

    fn of_deck(text: &str) -> Self {
        let (_, after) = text.split_once("HYPERELASTIC, ").unwrap();
        let (keyword, _) = after.split_once('\n').unwrap();
        let keyword = keyword.split(", LOCAL").next().unwrap();
        let directions = match text.contains("*ORIENTATION") {
            true => numbers(text, "*ORIENTATION").split_off(2),
            false => Vec::new(),
        };
        let data = match keyword {
            "MARLOW" => numbers(text, "*UNIAXIAL TEST DATA"),
            _ => numbers(text, "HYPERELASTIC, "),
        };
        Self {
            keyword: keyword.into(),
            values: data.concat(),
            directions: directions.iter().map(|row| [row[0], row[1]]).collect(),
        }
    }

    fn of_xml(text: &str) -> Self {
        let (_, material) = text.split_once("name=\"material_1\" type=\"").unwrap();
        let (keyword, rest) = material.split_once("\">").unwrap();
        let (own, _) = rest.split_once("</material>").unwrap();
        let axis = own.split_once("<a>").map(|(_, axis)| row(axis));
        let own = own.split("<mat_axis").next().unwrap();
        let values = own.lines().filter_map(|line| line.split_once('>'));
        Self {
            keyword: keyword.into(),
            values: values.map(|(_, value)| row(value)[0]).collect(),
            directions: axis.iter().map(|row| [row[0], row[1]]).collect(),
        }
    }
}

/// The lines of numbers that follow a keyword.
fn numbers(text: &str, keyword: &str) -> Vec<Vec<f64>> {
    let (_, after) = text.split_once(keyword).unwrap();
    let lines = after.lines().skip(1);
    let own = lines.take_while(|line| !line.starts_with('*'));
    own.map(row).collect()
}

fn row(text: &str) -> Vec<f64> {
    let own = text.split('<').next().unwrap();
    own.split(',')
        .map(|field| field.trim().parse().unwrap())
        .collect()
}

/// An incompressible sheet with F₂₁ = 0.
struct Sheet {
    /// C₁₁, C₁₂, C₂₂.
    c: [f64; 3],
    stretches: [f64; 3],
}

impl Sheet {
    fn new([f11, f12, f22]: [f64; 3]) -> Self {
        let c = [f11 * f11, f11 * f12, f12 * f12 + f22 * f22];
        let mean = (c[0] + c[2]) / 2.0;
        let radius = ((c[0] - c[2]) / 2.0).hypot(c[1]);
        let stretches = [
            (mean + radius).sqrt(),
            (mean - radius).sqrt(),
            1.0 / (f11 * f22),
        ];
        Self { c, stretches }
    }

    fn powers(&self, exponent: f64) -> f64 {
        self.stretches
            .iter()
            .map(|stretch| stretch.powf(exponent))
            .sum()
    }

    /// I₁ − 3 and I₂ − 3.
    fn invariants(&self) -> [f64; 2] {
        [2.0, -2.0].map(|exponent| self.powers(exponent) - 3.0)
    }

    /// The energy of fibres in the form of Holzapfel, Gasser and Ogden.
    fn fibre(&self, [k1, k2, kappa]: [f64; 3], [x, y]: [f64; 2]) -> f64 {
        let [c11, c12, c22] = self.c;
        let i4 = x * x * c11 + 2.0 * x * y * c12 + y * y * c22;
        let strain = kappa * self.invariants()[0] + (1.0 - 3.0 * kappa) * (i4 - 1.0);
        k1 / (2.0 * k2) * ((k2 * strain.max(0.0).powi(2)).exp() - 1.0)
    }
}

/// The energy of an incompressible sheet that the manuals give.
///
/// Abaqus 2016 Analysis User's Guide, 22.5.1 and 22.5.3; CalculiX 2.20, `*HYPERELASTIC`; FEBio User's Manual 4, uncoupled
/// materials.
fn published(law: &Exported, sheet: &Sheet) -> f64 {
    let (v, [x, y]) = (&law.values[..], sheet.invariants());
    let ogden = |mu: f64, alpha: f64| 2.0 * mu / (alpha * alpha) * (sheet.powers(alpha) - 3.0);
    match (&*law.keyword, v) {
        ("NEO HOOKE", [c10, _]) => c10 * x,
        ("MOONEY-RIVLIN" | "Mooney-Rivlin", [c10, c01, _]) => c10 * x + c01 * y,
        ("POLYNOMIAL, N=2" | "polynomial", [c10, c01, c20, c11, c02, ..]) => {
            c10 * x + c01 * y + c20 * x * x + c11 * x * y + c02 * y * y
        }
        ("YEOH", [c10, c20, c30, ..]) => c10 * x + c20 * x * x + c30 * x.powi(3),
        ("ARRUDA-BOYCE", [mu, locking, _]) => {
            let factors = [
                0.5,
                1.0 / 20.0,
                11.0 / 1050.0,
                19.0 / 7000.0,
                519.0 / 673_750.0,
            ];
            let term = |(i, factor): (i32, f64)| {
                factor / locking.powi(2 * i - 2) * ((x + 3.0).powi(i) - 3.0_f64.powi(i))
            };
            mu * (1..).zip(factors).map(term).sum::<f64>()
        }
        // Σ c/m² (…)
        ("Ogden", _) => v
            .chunks_exact(2)
            .map(|term| ogden(term[0] / 2.0, term[1]))
            .sum(),
        ("Gent", [g, jm, _]) => -0.5 * g * jm * (1.0 - x / jm).ln(),
        ("Veronda-Westmann", [c1, c2, _]) => c1 * ((c2 * x).exp() - 1.0) - 0.5 * c1 * c2 * y,
        ("HOLZAPFEL", [c10, _, k1, k2, kappa]) => {
            let fibre = |along: &[f64; 2]| sheet.fibre([*k1, *k2, *kappa], *along);
            c10 * x + law.directions.iter().map(fibre).sum::<f64>()
        }
        // Two families at ±γ from the first material axis.
        ("Holzapfel-Gasser-Ogden", [c, k1, k2, kappa, gamma, _]) => {
            let axis = law.directions.first().map_or(0.0, |[x, y]| y.atan2(*x));
            let fibre = |sign: f64| {
                let (sine, cosine) = (axis + sign * gamma.to_radians()).sin_cos();
                sheet.fibre([*k1, *k2, *kappa], [cosine, sine])
            };
            c / 2.0 * x + fibre(1.0) + fibre(-1.0)
        }
        ("MARLOW", curve) => marlow(curve, x),
        (keyword, _) if keyword.starts_with("OGDEN, N=") => {
            // μᵢ, αᵢ of each term, then its Dᵢ.
            let terms = v[..v.len() / 3 * 2].chunks_exact(2);
            terms.map(|term| ogden(term[0], term[1])).sum()
        }
        (other, _) => panic!("{other} {v:?}"),
    }
}

/// Marlow's energy ∫ T dε to the strain of a strip with the same I₁; T is linear between points of stress and strain.
fn marlow(curve: &[f64], x: f64) -> f64 {
    let excess = |strain: f64| strain * strain * (3.0 + strain) / (1.0 + strain) - x;
    let (mut low, mut high) = (0.0, 1e3);
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        if excess(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let points: Vec<_> = curve.chunks_exact(2).collect();
    let mut energy = 0.0;
    for pair in points.windows(2) {
        let ([from, begin], [to, end]) = ([pair[0][0], pair[0][1]], [pair[1][0], pair[1][1]]);
        let part = (low.min(end) - begin).max(0.0);
        energy += part * (from + (to - from) * part / (end - begin) / 2.0);
    }
    energy
}

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
const WORDS: [(&str, [Option<&str>; 3]); 16] = [
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
    ("marlow-table", [Some("MARLOW"), None, None]),
    (
        "holzapfel-gasser-ogden",
        [Some("HOLZAPFEL"), None, Some("Holzapfel-Gasser-Ogden")],
    ),
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
    cards.extend([fibres("one", "20"), fibres("one", "0"), fibres("two", "60")]);
    for law in LAWS {
        let [.., (_, words)] = WORDS
            .iter()
            .filter(|(name, _)| *name == law.name)
            .collect::<Vec<_>>()[..]
        else {
            panic!("the words for {} are missing", law.name);
        };
        let own: Vec<_> = cards
            .iter()
            .filter(|card| card.law_name == law.name)
            .collect();
        assert!(!own.is_empty(), "{}", law.name);
        for (card, ((_, code), word)) in own.iter().flat_map(|card| {
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
            let found = deviation(card, &|sheet| published(&exported, sheet));
            assert!(
                found < allowed,
                "{} of {} in {}: {found:.1e}",
                law.name,
                card.name,
                code.name()
            );
            if *word != "MARLOW" && *word != "HOLZAPFEL" {
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
    let told = file.expect_err(&card.name).to_string();
    for expected in [
        code.name(),
        &card.law_name,
        "Ogden",
        "gelbench materials fit",
    ] {
        assert!(told.contains(expected), "{told}");
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
