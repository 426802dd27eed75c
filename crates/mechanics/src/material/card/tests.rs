use super::*;
use crate::material::samples;

#[test]
fn every_shipped_card_loads() {
    for (name, _) in CARDS {
        let card = Card::load(name, Path::new(".")).unwrap();
        assert!(card.law.youngs_modulus() > 0.0, "{name}");
        assert!(
            !card.citation.is_empty() && !card.specimen.is_empty(),
            "{name}"
        );
    }
}

#[test]
fn the_law_reproduces_the_published_curve() {
    for name in ["pva-10", "pva-10-cauchy"] {
        let card = Card::load(name, Path::new(".")).unwrap();
        assert!(card.fit_error_percent().unwrap() < 1e-10, "{name}");
        assert!((card.published_nominal_stress(1.0).unwrap() - 0.00187).abs() < 1e-12);
    }
    let card = Card::load("neo-hooke", Path::new(".")).unwrap();
    assert_eq!(card.fit_error_percent(), None);
}

#[test]
fn density_and_viscosity_are_read_and_their_faults_told() {
    let with = |more: &str, viscosity: &str| {
        let text = CARDS[0]
            .1
            .replacen("[parameters]", &format!("{more}\n[parameters]"), 1);
        Card::parse("x", "x.toml", &format!("{text}\n[viscosity]\n{viscosity}"))
    };
    let plain = Card::load(CARDS[0].0, Path::new(".")).unwrap();
    assert!(plain.density.is_none() && plain.viscosity.is_none());
    let viscosity = "shear = \"50 Pa·s\"\nrelaxation = [{ share = 0.3, time = \"2 s\" }]";
    let card = with("density = \"1100 kg/m³\"", viscosity).unwrap();
    assert!((card.density.unwrap() - 1.1e-9).abs() < 1e-24);
    assert!((card.viscosity.shear_viscosity - 5e-5).abs() < 1e-19);
    assert_eq!(card.viscosity.relaxation[0].time, 2.0);
    let fault = with(
        "",
        "relaxation = [{ share = 0.6, time = \"2 s\" }, { share = 0.5, time = \"1 s\" }]",
    );
    assert!(fault.unwrap_err().to_string().contains("less than 1"));
    let fault = with("density = \"1100\"", "shere = \"1 Pa·s\"")
        .unwrap_err()
        .to_string();
    assert!(
        fault.contains("density") && fault.contains("did you mean `shear`"),
        "{fault}"
    );
}

#[test]
fn all_faults_of_a_card_are_told_at_once() {
    let text = CARDS[0]
        .1
        .replace("0.0611 MPa", "0.0611")
        .replace("exponent =", "exponant =");
    let Err(Error::Input(faults)) = Card::parse("x", "x.toml", &text) else {
        panic!("accepted")
    };
    let messages: Vec<_> = faults.iter().map(ToString::to_string).collect();
    assert_eq!(messages.len(), 3, "{messages:#?}");
    assert!(
        messages.iter().any(|line| line.contains("has no unit")),
        "{messages:#?}"
    );
    assert!(
        messages
            .iter()
            .any(|line| line.contains("did you mean `exponent`")),
        "{messages:#?}"
    );
}

#[test]
fn a_law_outside_the_registry_makes_a_card() {
    let law = Arc::new(NeoHooke { c10: 0.05 });
    let card = Card::of_law("mine", law, [0.8, 1.5]);
    assert_eq!((&*card.name, &*card.law_name), ("mine", "mine"));
    assert!((card.law.youngs_modulus() - 0.3).abs() < 1e-15);
    assert!(card.covers(1.5) && !card.covers(1.6));
    assert!(card.density.is_none() && card.viscosity.is_none());
}

#[test]
fn an_unknown_card_is_answered_with_the_nearest_name() {
    let fault = Card::load("pva10", Path::new(".")).unwrap_err();
    assert!(
        fault.to_string().contains("did you mean `pva-10`"),
        "{fault}"
    );
}

#[test]
fn a_sheet_is_told_as_its_card_and_plane_state_make_it() {
    let description = |law, parameters| samples::card(law, parameters).describe_sheet();
    assert_eq!(
        description("neo-hooke", "c10 = \"0.05 MPa\""),
        "an incompressible material in plane stress"
    );
    let card = samples::card(
        "neo-hooke-simo-pister",
        "mu = \"0.1 MPa\"\npoisson_ratio = 0.3",
    );
    let strained = card.in_plane_strain().unwrap().describe_sheet();
    assert_eq!(
        strained,
        "a compressible material (bulk modulus κ = 0.2167 MPa) in plane strain"
    );
    let gel = "modulus = \"0.02 MPa\"\nchi = 0.45\npreparation_fraction = 0.1\nchains = \"affine\"";
    assert!(description("flory-rehner", gel).starts_with("a gel "));
    let softens = "c10 = \"0.05 MPa\"\n[softening]\nr = 2\nm = \"10 kPa\"\nbeta = 0.1\n";
    assert!(description("neo-hooke", softens).ends_with("plane stress, with Mullins softening"));
}

/// A number in a hint would be that of another material.
#[test]
fn a_missing_parameter_is_asked_for_without_a_number() {
    let text = Card::load("pva-10-yeoh", Path::new(".")).unwrap().text;
    let without: String = text
        .split_inclusive('\n')
        .filter(|line| !line.starts_with("c30"))
        .collect();
    let fault = Card::parse("a", "a.toml", &without)
        .unwrap_err()
        .to_string();
    assert!(
        fault.contains("add `c30 = \"… MPa\"` under [parameters]"),
        "{fault}"
    );
}
