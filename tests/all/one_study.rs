//! One study of a sheet: the same strip as a plate and as a specimen; models, outputs and supports that every study has.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::{folder_with, gelbench};
use gelbench::budget::Budget;
use gelbench::kinds::read_given;
use gelbench::results::Results;
use gelbench::studies::Progress;

fn computed(text: &str) -> Results {
    let read = read_given(Path::new("sheet.toml"), text.to_owned(), Budget::USUAL);
    let read = read.unwrap_or_else(|fault| panic!("{fault}"));
    read.compute(Progress::silent()).unwrap()
}

const PLATE: &str = "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"2 mm\"\ncells = [24, 8]\n\
    [material]\ncard = \"pva-10\"\n[load]\nstretches = [\"15 %\", \"30 %\"]\n\
    [corrector]\ngrading = 1\nmethod = \"direct\"\n[finite_element]\ncells = [48, 16]\ngrading = 1\n";

const STRIP: &str = "kind = \"specimen\"\n[specimen]\nshape = \"strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"2 mm\"\n\
    cells = 8\n[material]\ncard = \"pva-10\"\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"30 mm\"\ny = \"0 mm\"\n\
    [path]\nfactors = [0.15, 0.3]\nmeasured_group = \"right\"\n";

fn force(results: &Results, step: usize, model: &str) -> f64 {
    let of_model = &results.outcome.steps[step].models[model];
    of_model["groups"]["right"]["force_N"][0].as_f64().unwrap()
}

#[test]
fn a_plate_and_the_same_strip_have_the_same_forces_findings_and_files() {
    // So that the finite elements of neither are refined once more.
    let tolerant =
        "[tolerances]\ndisplacement = \"50 %\"\nforce = \"50 %\"\ncorrection = \"10 %\"\n";
    let [plate, strip] = [PLATE, STRIP].map(|text| computed(&format!("{text}{tolerant}")));
    for step in [0, 1] {
        for (model, digits) in [
            ("mass_spring", 1e-11),
            ("corrected", 1e-9),
            ("finite_element", 1e-9),
        ] {
            let [one, other] = [&plate, &strip].map(|results| force(results, step, model));
            assert!((one / other - 1.0).abs() < digits, "{model}: {one} {other}");
        }
    }
    let names = |results: &Results| {
        let prefix = format!("{}_", results.kind.replace("specimen", "strip"));
        let figures = results.outcome.figures.iter();
        let figures = figures.map(|figure| figure.name.replacen(&prefix, "", 1));
        let grids = results
            .outcome
            .grids
            .iter()
            .map(|series| series.name.clone());
        let files = results.outcome.files.iter().map(|(name, _)| name.clone());
        figures
            .chain(grids)
            .chain(files)
            .collect::<BTreeSet<String>>()
    };
    assert_eq!(names(&plate), names(&strip));
    let findings = |results: &Results| {
        let warnings = results.outcome.warnings();
        let at = |text: String| {
            text.replace("15 % stretch", "load factor 0.15")
                .replace("30 % stretch", "load factor 0.3")
                // Only plates have this remedy.
                .replace(
                    "; an area term (`mass_spring.area_term`) gives them the sheet's ν",
                    "",
                )
        };
        warnings.map(at).collect::<Vec<_>>()
    };
    assert_eq!(findings(&plate), findings(&strip));
    let quantities = |results: &Results| {
        let checks = results.outcome.checks.iter();
        let names = checks.map(|check| check.quantity.clone());
        names
            .filter(|name| !name.contains("departure"))
            .collect::<Vec<_>>()
    };
    assert_eq!(quantities(&plate), quantities(&strip));
    for (model, of_strip) in &strip.outcome.steps[0].models {
        let of_plate = plate.outcome.steps[0].models[model].as_object().unwrap();
        for key in of_strip.as_object().unwrap().keys() {
            assert!(of_plate.contains_key(key), "{model}.{key}");
        }
    }
}

#[test]
fn a_model_that_a_study_leaves_out_is_not_computed() {
    let tolerant = "[tolerances]\ndisplacement = \"5 %\"\nforce = \"5 %\"\ncorrection = \"10 %\"\n";
    for text in [PLATE, STRIP].map(|text| format!("{text}{tolerant}")) {
        let text = &text;
        let alone = computed(&format!("models = [\"finite-element\"]\n{text}"));
        let models = &alone.outcome.steps[1].models;
        assert!(models["mass_spring"].is_null() && models["corrected"].is_null());
        let whole = force(&computed(text), 1, "finite_element");
        assert_eq!(force(&alone, 1, "finite_element"), whole);
        assert!(alone.passed() && alone.outcome.checks.is_empty());
        assert!(!alone.outcome.headline.is_empty());
        let others = computed(&format!(
            "models = [\"mass-spring\", \"corrected\"]\n{text}"
        ));
        assert!(others.outcome.steps[1].models["finite_element"].is_null());
        assert!(force(&others, 1, "corrected") > 0.0 && others.passed());
    }
    let none = folder_with(&format!("models = []\n{PLATE}"));
    gelbench(none.path(), &["check", "small.toml"]).code(2);
}

#[test]
fn every_study_says_what_it_writes_and_where() {
    let output = "\n[output]\nfolder = \"there\"\nvtk = false\nplots = false\n";
    let motion = "kind = \"motion\"\n[material]\ncard = \"neo-hooke\"\ndensity = \"1000 kg/m^3\"\n\
        [plate]\nlength = \"20 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = [8, 4]\n\
        [start]\nstretch = 0.1\n[grip]\nmotion = \"release\"\ntime = \"0 s\"\n[time]\nduration = \"1 ms\"\ninterval = \"0.5 ms\"\n\
        [finite_element]\ncells = [4, 2]\n";
    for text in [PLATE, STRIP, motion] {
        let folder = folder_with(&format!("{text}{output}"));
        gelbench(folder.path(), &["run", "small.toml"]);
        let there = folder.path().join("there");
        assert!(there.join("report.html").exists(), "{text}");
        let names = std::fs::read_dir(&there).unwrap();
        let names: Vec<String> = names
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        let is_drawn = |name: &String| name.ends_with(".png") && name != "motion.png";
        assert!(
            !names.iter().any(|name| is_drawn(name) || name == "vtk"),
            "{names:?}"
        );
    }
}

/// A sector of a ring between two symmetry lines is the ring, whatever its angle: under pressure inside it widens alike.
#[test]
fn a_sector_of_any_angle_between_symmetry_lines_is_the_ring() {
    let widened = |angle: f64| {
        let text = format!(
            "kind = \"specimen\"\n[specimen]\nshape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\n\
             angle = \"{angle} deg\"\nthickness = \"1 mm\"\ncells = 8\n[material]\ncard = \"neo-hooke\"\n\
             [[support]]\ngroup = \"start\"\nkind = \"symmetry\"\n[[support]]\ngroup = \"end\"\nkind = \"symmetry\"\n\
             [[load]]\ngroup = \"inside\"\nkind = \"pressure\"\npressure = \"5 kPa\"\n\
             [path]\nfactors = [1.0]\nmeasured_group = \"start\"\n"
        );
        let results = computed(&text);
        let models = &results.outcome.steps[0].models;
        let force = |model: &str| {
            let force = &models[model]["groups"]["start"]["force_N"];
            force[0].as_f64().unwrap().hypot(force[1].as_f64().unwrap())
        };
        let balance = results.outcome.balance.unwrap();
        assert!(balance < 1e-8, "{balance}");
        [force("corrected"), force("finite_element")]
    };
    let [_, right_angle] = widened(90.0);
    for angle in [37.0, 61.3, 120.0] {
        let [corrected, elements] = widened(angle);
        assert!(
            (elements / right_angle - 1.0).abs() < 1e-4,
            "{angle}: {elements} {right_angle}"
        );
        assert!(
            (corrected / right_angle - 1.0).abs() < 5e-3,
            "{angle}: {corrected} {right_angle}"
        );
    }
}

/// A line that is parallel to no axis is one to slide along, unless another support moves a node of it off that line.
#[test]
fn a_support_that_leaves_the_line_of_another_one_is_a_fault() {
    let text = "kind = \"specimen\"\n[specimen]\nshape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\n\
        angle = \"37 deg\"\nthickness = \"1 mm\"\ncells = 4\n[material]\ncard = \"neo-hooke\"\n\
        [[support]]\ngroup = \"end\"\nkind = \"roller\"\n\
        [[support]]\ngroup = \"outside\"\nkind = \"displacement\"\nx = \"1 mm\"\ny = \"0 mm\"\n\
        [path]\nfactors = [1.0]\nmeasured_group = \"outside\"\n";
    let folder = folder_with(text);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let told = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(told.contains("slides along a line"), "{told}");
}
