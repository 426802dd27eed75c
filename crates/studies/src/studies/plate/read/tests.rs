use super::*;
use crate::budget::Budget;
use crate::corrector::climb::ClimbSettings;
use crate::error::Error;
use crate::solve::NewtonSettings;
use crate::studies::Loaded;
use crate::studies::plate::{DEFAULT, load};

fn parse(text: &str) -> Result<Loaded<Specimen>, Error> {
    load(Path::new("plate.toml"), text, Budget::USUAL)
}

fn plate(text: &str) -> Specimen {
    parse(text).unwrap().content
}

fn grids(text: &str) -> PlateGrids {
    *plate(text).grids().unwrap()
}

fn faults(text: &str) -> Vec<String> {
    match parse(text).map(|_| ()) {
        Err(Error::Input(faults)) => faults.iter().map(ToString::to_string).collect(),
        other => panic!("accepted: {other:?}"),
    }
}

#[test]
fn an_empty_study_is_the_default_one() {
    let (empty, full) = (plate(""), parse(DEFAULT).unwrap());
    assert_eq!(empty.problem.thickness, 2.0);
    assert_eq!(empty.factors, [0.15, 0.3, 0.5, 0.75, 1.0]);
    let PlateGrids {
        size,
        cells,
        correction,
        elements,
        ..
    } = grids("");
    assert_eq!((size, cells), ([150.0, 50.0], [60, 20]));
    assert_eq!((elements.cells, elements.grading), ([84, 48], 2.0));
    assert_eq!(correction.grading, 2.0);
    let gauss = grids("[corrector]\nscheme = \"gauss\"\n");
    assert_eq!(gauss.correction.grading, 1.5);
    assert_eq!(empty.tolerances, full.content.tolerances);
    assert!(full.warnings.is_empty() && full.output == crate::studies::OutputSettings::default());
}

#[test]
fn studies_and_the_library_have_the_same_defaults() {
    let (study, grids) = (plate(""), grids(""));
    assert_eq!(grids.lattice, LatticeSettings::default());
    assert_eq!(study.springs_newton, NewtonSettings::default());
    assert_eq!(study.elements_newton, NewtonSettings::default());
    assert_eq!(grids.correction.scheme, DifferenceScheme::default());
    assert_eq!(grids.correction.climb, Some(ClimbSettings::default()));
    assert_eq!(grids.correction.direct, CorrectorSettings::default());
    assert_eq!(grids.elements.element, Element::default());
}

#[test]
fn all_faults_are_told_at_once_with_line_key_and_hint() {
    let text = "[plate]\nlenght = \"15 cm\"\nwidth = 50\nthickness = \"-2 mm\"\ncells = [60, 0]\n\
                [material]\ncard = \"pva10\"\n[load]\nstretches = [\"15 mm\"]\n";
    let messages = faults(text);
    let expected = [
        (
            "plate.toml:2: plate.lenght: unknown key",
            "did you mean `length`?",
        ),
        (
            "plate.toml:3: plate.width: a length needs a unit",
            "\"50 mm\"",
        ),
        (
            "plate.toml:4: plate.thickness: must be greater than zero",
            "-2 mm",
        ),
        (
            "plate.toml:5: plate.cells: must be two whole numbers",
            "[60, 0]",
        ),
        (
            "plate.toml:7: material.card: there is no card `pva10`",
            "did you mean `pva-10`?",
        ),
        ("plate.toml:9: load.stretches: \"15 mm\"", "%"),
    ];
    assert_eq!(messages.len(), expected.len(), "{messages:#?}");
    for (line, (start, hint)) in messages.iter().zip(expected) {
        assert!(line.starts_with(start) && line.contains(hint), "{line}");
    }
}

#[test]
fn of_many_faults_the_first_are_told_and_the_others_counted() {
    let keys: String = (0..3000).map(|key| format!("k{key} = 1\n")).collect();
    let messages = faults(&format!("[plate]\n{keys}"));
    assert_eq!(messages.len(), 51);
    assert_eq!(messages[50], "2950 further findings are not listed");
}

#[test]
fn settings_that_contradict_each_other_are_refused() {
    assert!(faults("[plate]\ncells = [60, 10]\n")[0].contains("take [60, 20]"));
    assert!(faults("[plate]\ncells = [2, 2]\n")[0].contains("take [6, 2]"));
    assert!(faults("[plate]\ncells = [3000, 1000]\n")[0].contains(
        "needs about 3,000,000 cells, and 1,000,000 are allowed (take fewer, or use --allow-large)"
    ));
    assert!(faults("[finite_element]\ncells = [121, 40]\n")[0].contains("[124, 40]"));
    assert!(faults("[finite_element]\ngrading = 0.5\n")[0].contains("must be"));
    assert!(faults("[corrector]\ngrading = 0.5\n")[0].contains("must be"));
    assert!(faults("[corrector]\ngrading = \"auto\"\n")[0].contains("must be a number"));
    assert!(faults("[load]\nstretches = []\n")[0].contains("at least one"));
    assert!(faults("[load]\nstretches = [0.5, 0.3]\n")[0].contains("from small to large"));
    assert!(faults("[load]\nstretches = [-0.1, 0.3]\n")[0].contains("the same sign"));
    assert!(faults("[load]\nstretches = [-0.1, -0.05]\n")[0].contains("from small to large"));
    assert!(faults("[load]\nstretches = [0, 0.3]\n")[0].contains("zero"));
    assert!(faults("[load]\nstretches = [-1]\n")[0].contains("must be"));
    for text in ["[1.05, 1.1]", "[\"1.05\", \"1.1\"]", "[1.0, \"2.5\"]"] {
        let fault = &faults(&format!("[load]\nstretches = {text}\n"))[0];
        assert!(fault.contains("or λ"), "{text}: {fault}");
    }
    assert!(faults("[finite_element]\ncells = \"auto\"\n")[0].contains("\"automatic\""));
    assert!(faults("[corrector]\nscheme = \"gaus\"\n")[0].contains("did you mean \"gauss\""));
    assert!(
        faults("[plate\n")
            .iter()
            .any(|line| line.contains("TOML syntax"))
    );
}

/// Equal cells of the reference that are the lattice's own pairs of cells.
#[test]
fn a_plate_that_is_compared_with_itself_is_told_so() {
    let fine = grids("[plate]\ncells = [240, 80]\n").elements;
    assert!(fine.cells[1] >= 40 && fine.grading > 1.0);
    let base = "[plate]\ncells = [48, 16]\n[finite_element]\ncells = [24, 8]\ngrading = 1\n";
    let equal = "[corrector]\ngrading = 1\n";
    let study = parse(&format!("{base}{equal}")).unwrap();
    assert!(study.warnings[0].to_string().contains("own equations"));
    let is_own_reference = |text: &str| grids(text).is_own_reference();
    assert!(is_own_reference(&format!("{base}{equal}")));
    let gauss = "[corrector]\ngrading = 1\nscheme = \"gauss\"\n";
    assert!(!is_own_reference(&format!("{base}{gauss}")));
    let graded = base.replace("grading = 1", "grading = 2");
    assert!(!is_own_reference(&format!("{graded}{equal}")));
    assert!(is_own_reference(&graded));
    let q1 = base.replace("[24, 8]", "[48, 16]\nelement = \"Q1\"");
    assert!(is_own_reference(&format!("{q1}{gauss}")));
}

#[test]
fn compressions_are_a_path_of_their_own() {
    let study = plate("[load]\nstretches = [\"-5 %\", \"-10 %\"]\n");
    assert_eq!(study.factors, [-0.05, -0.1]);
}

#[test]
fn a_stretch_outside_the_range_of_the_card_is_a_warning() {
    let study = parse("[load]\nstretches = [0.5, 1.2]\n").unwrap();
    assert_eq!(study.warnings.len(), 1);
    let warning = study.warnings[0].to_string();
    assert!(
        warning.contains("120 % stretch") && warning.contains("0 to 100 %"),
        "{warning}"
    );
}

#[test]
fn a_stretch_beyond_the_stability_of_the_law_is_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let card = crate::material::registry::CARDS[0].1;
    let card = card.replace("marlow-exponential", "veronda-westmann");
    let (head, _) = card.split_once("amplitude").unwrap();
    let (_, rest) = card.split_once("[data]").unwrap();
    let card = format!("{head}c = \"0.1468 MPa\"\nbeta = 0.31\n[data]{rest}");
    std::fs::write(folder.path().join("vw.toml"), card).unwrap();
    let text = "[material]\ncard = \"vw.toml\"\n[load]\nstretches = [0.5, 0.75]\n";
    let study = load(&folder.path().join("plate.toml"), text, Budget::USUAL).unwrap();
    assert_eq!(study.warnings.len(), 1, "{:?}", study.warnings);
    let warning = study.warnings[0].to_string();
    assert!(
        warning.contains("75 % stretch is beyond the stable range"),
        "{warning}"
    );
}

/// A study of a card that softens, with more text.
fn softening(more: &str) -> Result<Loaded<Specimen>, Error> {
    let card = crate::material::Card::load("neo-hooke", Path::new("."))
        .unwrap()
        .text;
    let card = format!("{card}\n[softening]\nr = 1.6\nm = \"5 kPa\"\nbeta = 0.1\n");
    let files = [("soft.toml".into(), card.into_bytes())];
    let text = format!("[material]\ncard = \"soft.toml\"\n{more}");
    crate::document::with_files(files, || parse(&text))
}

#[test]
fn only_a_material_that_softens_is_unloaded() {
    let history = "[load]\nstretches = [\"30 %\", \"60 %\", \"20 %\", \"60 %\"]\n";
    let messages = faults(history);
    assert!(
        messages[0].contains("from small to large") && messages[0].contains("[softening]"),
        "{messages:?}"
    );
    let direct = "[corrector]\nmethod = \"direct\"\n";
    let study = softening(&format!("{history}{direct}")).unwrap();
    assert_eq!(study.content.factors, [0.3, 0.6, 0.2, 0.6]);
    let refused = |text: &str, words: &[&str]| {
        let fault = softening(text).map(|_| ()).unwrap_err().to_string();
        assert!(words.iter().all(|word| fault.contains(word)), "{fault}");
    };
    refused(history, &["corrector.method", "climb", "direct"]);
    refused(
        &format!("{direct}[mass_spring]\narea_term = true\n"),
        &["area_term", "does not soften"],
    );
    refused(
        &format!("{direct}[load]\nstretches = [\"30 %\", \"30 %\"]\n"),
        &["must differ"],
    );
    refused(
        &format!("{direct}[load]\nstretches = [\"30 %\", \"0 %\"]\n"),
        &["must not contain zero", "to unload", "0.1 %"],
    );
}

#[test]
fn a_study_without_a_title_is_called_after_its_material() {
    let title = |text: &str| parse(text).unwrap().title;
    assert_eq!(
        title("[material]\ncard = \"neo-hooke\""),
        "Clamped plate of neo-Hooke, C10 = 0.05 MPa (verification)"
    );
    assert_eq!(title("title = \"Mine\""), "Mine");
}

/// Finite elements that judge a graded field on a fine lattice at ninety-nine stretches would not fit into memory.
#[test]
fn automatic_finite_elements_are_as_fine_as_can_be_afforded() {
    let stretches: Vec<String> = (1..100)
        .map(|n| (0.01 * f64::from(n)).to_string())
        .collect();
    let many = format!("[load]\nstretches = [{}]\n", stretches.join(", "));
    let fine = "[plate]\ncells = [300, 100]\n";
    let few = grids(fine).elements.cells;
    let all = grids(&format!("{fine}{many}")).elements.cells;
    assert!(
        few[1] == 160 && all[1] < 100 && all[1] >= 60,
        "{few:?} {all:?}"
    );
    let stated = format!("{fine}{many}[finite_element]\ncells = [280, 160]\n");
    assert!(faults(&stated)[0].contains("bytes of memory"));
}
