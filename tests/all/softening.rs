//! Softening from a record to a card to a study: the command's words, and what refuses such a card.

use std::fs;

use crate::common::{gelbench, machine_report, words};
use serde_json::Value;
use tempfile::TempDir;

/// A folder with the example's record and study, and a card fitted to the record.
fn fitted() -> TempDir {
    let folder = TempDir::new().unwrap();
    let examples = crate::common::root().join("examples");
    for file in ["cyclic_loading.csv", "softening_strip.toml"] {
        fs::copy(examples.join(file), folder.path().join(file)).unwrap();
    }
    let fit = "materials fit cyclic_loading.csv --law neo-hooke --softening --name softening_gel --output .";
    let arguments: Vec<&str> = fit.split(' ').collect();
    let done = gelbench(folder.path(), &arguments).code(0);
    let message = words(&done.get_output().stdout);
    for part in [
        "softening.r",
        "softening.m",
        "softening.beta",
        "cycle 4",
        "closed form",
    ] {
        assert!(message.contains(part), "{message}");
    }
    folder
}

#[test]
fn a_record_becomes_a_card_that_is_shown_drawn_and_fitted_again() {
    let folder = fitted();
    let figures = fs::read_to_string(folder.path().join("softening_gel.json")).unwrap();
    let figures: Value = serde_json::from_str(&figures).unwrap();
    for (key, truth) in [
        ("c10", 0.12),
        ("softening.r", 1.9),
        ("softening.m", 0.006),
        ("softening.beta", 0.12),
    ] {
        let all = figures["parameters"].as_array().unwrap();
        let actual = all.iter().find(|one| one["key"] == key).unwrap();
        let ends = actual["interval_95_percent"].as_array().unwrap();
        let [low, high] = [0, 1].map(|end| ends[end].as_f64().unwrap());
        // A 95 % interval of one record, doubled.
        let (middle, half) = (0.5 * (low + high), high - low);
        assert!((truth - middle).abs() < half, "{actual}");
    }
    let cycles = figures["softening"]["cycles"].as_array().unwrap();
    assert_eq!(cycles.len(), 4);
    for cycle in &cycles[..3] {
        let [measured, fitted, closed] = [
            "measured_work_mJ_per_mm3",
            "fitted_work_mJ_per_mm3",
            "closed_form_mJ_per_mm3",
        ]
        .map(|key| cycle[key].as_f64().unwrap());
        assert!((measured / fitted - 1.0).abs() < 0.05, "{cycle}");
        assert!((fitted / closed - 1.0).abs() < 0.02, "{cycle}");
    }
    assert_eq!(cycles[3]["dissipated_by_softening_mJ_per_mm3"], 0.0);
    gelbench(folder.path(), &["materials", "refit", "softening_gel.toml"]).code(0);
    let shown = gelbench(folder.path(), &["materials", "show", "softening_gel.toml"]).code(0);
    let shown = words(&shown.get_output().stdout);
    assert!(
        shown.contains("kJ/m³ are dissipated, η falls to"),
        "{shown}"
    );
    let plot = [
        "materials",
        "plot",
        "softening_gel.toml",
        "--output",
        "loops.png",
    ];
    gelbench(folder.path(), &plot).code(0);
    // On top of a card: its law stays as it is.
    let fit = "materials fit cyclic_loading.csv --softening --card neo-hooke --name top --output .";
    gelbench(folder.path(), &fit.split(' ').collect::<Vec<_>>()).code(0);
    let card = fs::read_to_string(folder.path().join("top.toml")).unwrap();
    assert!(
        card.contains("c10 = \"0.05 MPa\"") && card.contains("base_card = \"neo-hooke\""),
        "{card}"
    );
    gelbench(folder.path(), &["materials", "refit", "top.toml"]).code(0);
}

#[test]
fn a_strip_is_loaded_unloaded_and_loaded_again() {
    let folder = fitted();
    let file = folder.path().join("softening_strip.toml");
    let study = fs::read_to_string(&file).unwrap();
    fs::write(&file, study.replace("cells = 8", "cells = 4")).unwrap();
    let done = gelbench(folder.path(), &["run", "softening_strip.toml"]).code(0);
    let message = words(&done.get_output().stdout);
    let report = machine_report(&folder.path().join("output/softening_strip"));
    let steps = report["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 9, "{message}");
    for model in ["mass_spring", "corrected", "finite_element"] {
        let of = |step: usize, key: &str| steps[step][model][key].as_f64().unwrap();
        let (force, lost) = (
            |step| of(step, "measured_N"),
            |step| of(step, "dissipated_mJ"),
        );
        // Back at 30 %: softer; at 60 % again: where it was; beyond: more is lost.
        assert!(force(2) < 0.95 * force(0), "{model}");
        assert!((force(4) / force(2) - 1.0).abs() < 1e-6, "{model}");
        assert!((force(5) / force(1) - 1.0).abs() < 1e-6, "{model}");
        assert!(
            (lost(5) / lost(1) - 1.0).abs() < 1e-6 && lost(6) > 1.5 * lost(5),
            "{model}"
        );
        assert!(force(8) < force(2), "{model}");
        assert!(of(3, "stored_mJ") > 0.0);
        // The strain energy is what can be recovered, as in the grids.
        assert_eq!(of(8, "energy_mJ"), of(8, "stored_mJ"), "{model}");
    }
    let page = fs::read_to_string(folder.path().join("output/softening_strip/report.md")).unwrap();
    assert!(page.contains("Stored and dissipated energy"));
    // ParaView shows every step, and how soft each cell is.
    let vtk = folder.path().join("output/softening_strip/vtk");
    let steps = fs::read_to_string(vtk.join("corrected.pvd")).unwrap();
    for step in 1..=9 {
        assert!(steps.contains(&format!("timestep=\"{step}\"")), "{steps}");
    }
    let grid = fs::read(vtk.join("finite_element_004.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&grid).contains("softening_factor"));
}

#[test]
fn a_history_that_ends_at_rest_is_told_how_to_unload() {
    let folder = fitted();
    let study = fs::read_to_string(folder.path().join("softening_strip.toml")).unwrap();
    for (end, code) in [("0.0", 2), ("0.001", 0)] {
        let factors = format!("1.0, {end}");
        let study = study.replace("0.3, 0.6, 0.3, 0.1, 0.3, 0.6, 1.0, 0.6, 0.3", &factors);
        fs::write(folder.path().join("study.toml"), study).unwrap();
        let done = gelbench(folder.path(), &["check", "study.toml"]).code(code);
        let message = words(&done.get_output().stderr);
        assert_eq!(message.contains("such as 0.001"), code == 2, "{message}");
    }
}

#[test]
fn what_has_no_memory_refuses_the_card() {
    let folder = fitted();
    let example =
        |name: &str| fs::read_to_string(crate::common::root().join("examples").join(name)).unwrap();
    let card = "\"softening_gel.toml\"";
    let motion = example("relaxing_plate.toml").replace("\"pva-10\"", card);
    fs::write(folder.path().join("motion.toml"), motion).unwrap();
    let adaptive =
        example("softening_strip.toml") + "\n[finite_element]\nelement = \"T2\"\nadaptive = true\n";
    fs::write(folder.path().join("adaptive.toml"), adaptive).unwrap();
    for study in ["motion.toml", "adaptive.toml"] {
        let message = gelbench(folder.path(), &["check", study]).code(2);
        let message = words(&message.get_output().stderr);
        assert!(
            message.contains("softens") && message.contains("no memory"),
            "{message}"
        );
    }
    let strip = example("softening_strip.toml")
        .replace("0.3, 0.6, 0.3, 0.1, 0.3, 0.6, 1.0, 0.6, 0.3", "0.5, 1.0");
    fs::write(folder.path().join("strip.toml"), strip).unwrap();
    let export = [
        "export",
        "strip.toml",
        "--to",
        "abaqus",
        "--output",
        "strip.inp",
    ];
    gelbench(folder.path(), &export).code(0);
    let deck = fs::read_to_string(folder.path().join("strip.inp")).unwrap();
    let mullins = deck
        .lines()
        .skip_while(|line| *line != "*MULLINS EFFECT")
        .nth(1);
    let numbers: Vec<f64> = mullins
        .unwrap()
        .split(", ")
        .map(|part| part.parse().unwrap())
        .collect();
    assert!(
        (numbers[0] / 1.9 - 1.0).abs() < 0.1 && (numbers[2] / 0.12 - 1.0).abs() < 0.5,
        "{numbers:?}"
    );
    for (code, exit, part) in [("calculix", 2, "*MULLINS EFFECT"), ("febio", 2, "Abaqus")] {
        let done = gelbench(folder.path(), &["export", "strip.toml", "--to", code]).code(exit);
        let message = words(&done.get_output().stderr);
        assert!(message.contains(part), "{message}");
    }
}
