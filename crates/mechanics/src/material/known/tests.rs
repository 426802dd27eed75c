use super::*;
use crate::material::Code;
use crate::material::registry::Law;
use crate::material::samples;
use crate::material::sheet::Kinematics;
use crate::material::{CodeLaw, SmallStrain};
use crate::units::{self, Dimension};

fn parameters(of: &[(&str, &str)]) -> Vec<(String, String)> {
    of.iter()
        .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
        .collect()
}

fn law(name: &str) -> Known {
    Known::of(Law::named(name).unwrap())
}

fn card(known: &Known) -> Card {
    let text = known.card_text("gel").unwrap();
    Card::parse("gel", "gel", &text).unwrap()
}

fn refused(known: &Known) -> String {
    known.card_text("gel").unwrap_err().to_string()
}

/// The parameters of a sample of the law but those that follow from E and ν.
fn sample(name: &str) -> Vec<(String, String)> {
    let text = match name {
        "marlow-exponential" => "exponent = 2.2".to_owned(),
        "neo-hooke" => String::new(),
        "mooney-rivlin" => "c01 = \"1 kPa\"".to_owned(),
        name => samples::parameters(name),
    };
    let pairs = text.lines().filter_map(|line| line.split_once(" = "));
    let is_stress = |value: &str| units::parse(value, Dimension::Stress).is_ok();
    // The first parameter that is a stress follows from E.
    let mut followed = name == "mooney-rivlin";
    let mut stated = Vec::new();
    for (key, value) in pairs {
        let value = value.trim_matches('"');
        let follows = is_stress(value) && !followed;
        followed |= follows;
        if !follows && key != "poisson_ratio" && !key.starts_with("nu_") {
            stated.push((key.to_owned(), value.to_owned()));
        }
    }
    stated
}

/// The tangent at rest of a sheet of E and ν in plane stress, to 1e-10.
fn check_tangent(card: &Card, young: f64, ratio: f64) {
    let tangent = card.law.response(&Kinematics::rest()).tangent;
    let along = young / (1.0 - ratio * ratio);
    let shear = 0.5 * young / (1.0 + ratio);
    for (position, expected) in [
        ((0, 0), along),
        ((3, 3), along),
        ((0, 3), ratio * along),
        ((1, 1), shear),
        ((1, 2), shear),
    ] {
        let computed = tangent[position];
        let context = format!(
            "{}, ν = {ratio}, {position:?}: {computed} {expected}",
            card.text
        );
        assert!((computed - expected).abs() < 1e-10 * young, "{context}");
    }
}

/// Laws of sheets with directions.
const DIRECTED: [&str; 5] = [
    "holzapfel-gasser-ogden",
    "fung",
    "may-newman",
    "lee-sacks",
    "holzapfel-ogden",
];

/// Every law but those that E and ν do not determine.
#[test]
fn a_card_of_young_and_poisson_has_their_tangent_at_rest() {
    let mut count = 0;
    let changing_volume = samples::samples_changing_volume().into_iter();
    let changing_volume: Vec<&str> = changing_volume.map(|(law, _)| law).collect();
    for law in Law::fitted() {
        if [MARLOW_TABLE, SWELLING].contains(&law.name) || DIRECTED.contains(&law.name) {
            continue;
        }
        for (young, ratio) in [
            (0.02, 0.45),
            (3.0, 0.3),
            (5e-4, 0.5),
            (0.1, -0.2),
            (0.05, 0.4999),
        ] {
            let mut known = Known::of(law);
            known.moduli.young = Some(young);
            known.moduli.poisson_ratio = Some(ratio);
            known.parameters = sample(law.name);
            if ratio == 0.5 && changing_volume.contains(&law.name) {
                assert!(
                    refused(&known).contains("changes its volume"),
                    "{}",
                    law.name
                );
                continue;
            }
            let card = card(&known);
            check_tangent(&card, young, ratio);
            let SmallStrain { poisson_ratio, .. } = card.small_strain();
            assert!((poisson_ratio - ratio).abs() < 1e-10, "{}", card.text);
            count += 1;
            if changing_volume.contains(&law.name) {
                // The same ratio as a parameter of the law.
                let computed = card.parameters.iter().filter(|one| is_ratio(one));
                let computed = computed.map(|one| (one.key.to_owned(), ratio.to_string()));
                known.parameters.extend(computed);
                known.moduli.poisson_ratio = None;
                check_tangent(&self::card(&known), young, ratio);
            }
        }
    }
    assert!(count > 80, "{count}");
}

#[test]
fn the_formula_is_the_one_that_is_computed() {
    let mut known = law("ogden-1");
    known.parameters = parameters(&[("mu_1", "20 kPa"), ("alpha_1", "4")]);
    assert!(refused(&known).contains("factor before the sums"));
    for (convention, factor, shear) in [
        ("2mu/alpha^2", "Σ 2 μᵢ/αᵢ²", 0.02),
        ("mu/alpha", "Σ μᵢ/αᵢ ", 0.04),
        ("mu/alpha^2", "Σ μᵢ/αᵢ²", 0.01),
    ] {
        known.convention = Some(convention.to_owned());
        let card = card(&known);
        assert!(card.energy().contains(factor), "{}", card.energy());
        assert!((card.law.shear_modulus() - shear).abs() < 1e-15);
        assert_eq!(card.symbols(), ["μ₁ = 0.02 MPa", "α₁ = 4"]);
    }
    let mut known = law("neo-hooke");
    known.moduli.young = Some(0.02);
    known.moduli.poisson_ratio = Some(0.25);
    let card = card(&known);
    assert_eq!(card.energy(), "W = Ψ + ½ κ (J − 1)², Ψ = C₁₀ (Ī₁ − 3)");
    assert!(
        card.symbols()[1].starts_with("κ = 0.013333 MPa"),
        "{:?}",
        card.symbols()
    );
}

/// What a code is given as parameters comes back from the export to it.
#[test]
fn parameters_by_the_names_of_another_code_are_those_of_its_export() {
    use Code::{Abaqus, CalculiX, FeBio};
    for (code, name, stated) in [
        (FeBio, "neo-hooke", "c1=0.1 MPa, k=5 MPa"),
        (FeBio, "mooney-rivlin", "c1=0.1 MPa, c2=0.02 MPa, k=5 MPa"),
        (
            FeBio,
            "ogden-2",
            "c1=0.1 MPa, m1=3, c2=0.2 MPa, m2=-2, k=5 MPa",
        ),
        (FeBio, "gent", "G=0.1 MPa, Jm=30, k=5 MPa"),
        (FeBio, "veronda-westmann", "c1=0.1 MPa, c2=0.7, k=5 MPa"),
        (Abaqus, "neo-hooke", "C10=0.1 MPa, D1=0.4 1/MPa"),
        (
            Abaqus,
            "yeoh",
            "C10=0.1 MPa, C20=0.01 MPa, C30=0.002 MPa, D1=0.4 mm^2/N",
        ),
        (CalculiX, "ogden-1", "mu_1=0.1 MPa, alpha_1=3, D1=0.4 1/MPa"),
        (
            Abaqus,
            "arruda-boyce",
            "mu=0.1 MPa, lambda_m=2.5, D=0.4 1/MPa",
        ),
    ] {
        let stated = stated.split(", ").map(|one| one.split_once('=').unwrap());
        let stated = parameters(&stated.collect::<Vec<_>>());
        let card = card(&law(name).with_parameters_of(code, &stated).unwrap());
        assert!((card.volume.unwrap().bulk_modulus - 5.0).abs() < 1e-14);
        let isochoric = card.isochoric.as_ref().unwrap();
        let Some(CodeLaw::Named { parameters, .. }) = isochoric.in_code(code, 5.0) else {
            panic!("{name} of {code:?}")
        };
        for (key, text) in &stated {
            let plain = |name: &str| name.to_lowercase();
            let value = parameters
                .iter()
                .find(|(symbol, _)| plain(symbol) == plain(key));
            let number: f64 = text.split(' ').next().unwrap().parse().unwrap();
            let (_, value) = value.unwrap_or_else(|| panic!("{name} {key}: {parameters:?}"));
            assert!((value - number).abs() < 1e-15, "{name} {key}: {value}");
        }
    }
    let stated = parameters(&[("C10", "0.1 MPa"), ("D1", "0 1/MPa")]);
    let incompressible = law("neo-hooke")
        .with_parameters_of(Code::Abaqus, &stated)
        .unwrap();
    assert!(card(&incompressible).bulk_modulus().is_none());
    let stated = parameters(&[("E", "20 kPa"), ("v", "0.3")]);
    let coupled = law("neo-hooke-simo-pister")
        .with_parameters_of(Code::FeBio, &stated)
        .unwrap();
    check_tangent(&card(&coupled), 0.02, 0.3);
}

#[test]
fn what_is_missing_or_contradicts_is_told_with_a_remedy() {
    let young = |name: &str, stated: &[(&str, &str)]| {
        let mut known = law(name);
        known.moduli.young = Some(0.02);
        known.parameters = parameters(stated);
        refused(&known)
    };
    for (message, expected) in [
        (young("gent", &[]), "needs jm too"),
        (young("mooney-rivlin", &[]), "does not determine c10, c01"),
        (
            young("yeoh", &[("c10", "1 kPa"), ("c20", "0 MPa")]),
            "does not depend on c30",
        ),
        (
            young("neo-hooke", &[("c10", "1 kPa")]),
            "a modulus that follows from them",
        ),
        (young("neo-hooke", &[("c1", "1 kPa")]), "did you mean `c10`"),
        (young("gent", &[("jm", "30 MPa")]), "--parameter jm"),
        (young("linear-elastic", &[]), "--poisson"),
        (young("flory-rehner", &[]), "--parameter KEY=VALUE"),
        (young("marlow-table", &[]), "materials fit"),
        (refused(&law("gent")), "add --parameter jm=…"),
    ] {
        assert!(message.contains(expected), "{expected}: {message}");
    }
    for constant in ["0.4", "0"] {
        let stated = parameters(&[("C10", "0.1 MPa"), ("D1", constant)]);
        let fault = law("neo-hooke").with_parameters_of(Code::Abaqus, &stated);
        let message = fault.unwrap_err().to_string();
        for part in ["reciprocal of a stress", "leave D1 out"] {
            assert!(message.contains(part), "{message}");
        }
    }
}
