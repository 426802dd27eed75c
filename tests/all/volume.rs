//! Sheets that change their volume: the clamped plate by another code, the incompressible limit, and whole studies.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use gelbench::finite_element::{Element, FiniteElements};
use gelbench::material::{
    HyperelasticLaw, MooneyRivlin, NeoHooke, PlaneState, Volume, VolumeEnergy, Yeoh,
};
use gelbench::problem::{ClampedPlate, Measures};
use gelbench::solve::NewtonSettings;
use gelbench_mechanics::material::samples;
use gelbench_mechanics::material::volume::bulk_modulus;
use tempfile::TempDir;

use crate::common::{SMALL, gelbench, machine_report, one_line, words};

const SETTINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 30,
};

fn law(name: &str) -> Arc<dyn HyperelasticLaw> {
    match name {
        "neo-hooke" => Arc::new(NeoHooke { c10: 0.05 }),
        "mooney-rivlin" => Arc::new(MooneyRivlin {
            c10: 0.04,
            c01: 0.01,
        }),
        "yeoh" => Arc::new(Yeoh {
            coefficients: [0.03, -0.002, 0.001],
        }),
        other => panic!("no law {other}"),
    }
}

fn sheet(name: &str, poisson_ratio: f64, plane: PlaneState) -> Arc<dyn HyperelasticLaw> {
    let law = law(name);
    let bulk_modulus = bulk_modulus(law.shear_modulus(), poisson_ratio);
    let volume = Volume {
        bulk_modulus,
        energy: VolumeEnergy::Quadratic,
        plane,
    };
    law.with_volume(volume).unwrap()
}

fn plate(law: Arc<dyn HyperelasticLaw>) -> ClampedPlate {
    ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law,
        stretches: vec![0.15, 0.5],
    }
}

/// Force in N, width at mid length in mm and energy in mJ at both stretches.
fn measured(law: Arc<dyn HyperelasticLaw>) -> Vec<[f64; 3]> {
    let plate = plate(law);
    let elements = FiniteElements::new(&plate, [24, 8], Element::Q2);
    let states = elements.solve(&plate, SETTINGS, &|_| ()).unwrap();
    let measures = states.iter().map(|state| {
        let actual = Measures::of(&elements.mesh, state);
        [actual.force, actual.mid_width, actual.energy]
    });
    measures.collect()
}

/// The rows of a table below its remarks and its names.
fn rows(text: &str) -> Vec<Vec<&str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect()
}

#[test]
fn a_clamped_plate_that_changes_its_volume_is_that_of_another_code() {
    let rows = rows(include_str!("../../validation/plate/volume.csv"));
    assert_eq!(rows.len(), 24);
    for pair in rows.chunks(2) {
        let plane = PlaneState::NAMES
            .iter()
            .find(|(name, _)| *name == pair[0][2]);
        let actual = measured(sheet(
            pair[0][0],
            pair[0][1].parse().unwrap(),
            plane.unwrap().1,
        ));
        for (row, actual) in pair.iter().zip(actual) {
            for (actual, expected) in actual.iter().zip(&row[4..]) {
                let off = (actual / expected.parse::<f64>().unwrap() - 1.0).abs();
                assert!(off < 1e-6, "{row:?}: {actual}, {off:.1e}");
            }
        }
    }
}

/// A law of a row of `volume_laws.csv`: its parameters are those of a card, with semicolons between them.
fn law_of_row(row: &[&str]) -> Arc<dyn HyperelasticLaw> {
    let law = samples::card(row[0], &row[1].replace("; ", "\n")).law;
    let choice = |names: &[(&'static str, VolumeEnergy)], name: &str| {
        let actual = names.iter().find(|(known, _)| *known == name);
        actual.map(|(_, choice)| *choice)
    };
    let law = match choice(&VolumeEnergy::NAMES, row[2]) {
        Some(energy) => {
            let volume = Volume {
                bulk_modulus: bulk_modulus(law.shear_modulus(), 0.3),
                energy,
                plane: PlaneState::Stress,
            };
            law.with_volume(volume).unwrap()
        }
        None => law,
    };
    match row[3] {
        "plane-strain" => law.in_plane_strain().unwrap(),
        _ => law,
    }
}

#[test]
fn a_clamped_plate_of_any_law_of_volume_change_is_that_of_two_other_codes() {
    let rows = rows(include_str!("../../validation/plate/volume_laws.csv"));
    let mut plates = BTreeMap::new();
    for row in &rows {
        let actual = plates
            .entry(&row[..4])
            .or_insert_with(|| measured(law_of_row(row)));
        let actual = actual[usize::from(row[5] == "0.5")];
        for (actual, expected) in actual.iter().zip(&row[6..]) {
            if expected.is_empty() {
                continue;
            }
            let off = (actual / expected.parse::<f64>().unwrap() - 1.0).abs();
            assert!(off < 1e-6, "{row:?}: {actual}, {off:.1e}");
        }
    }
    assert_eq!((plates.len(), rows.len()), (21, 90));
}

/// Its difference falls as 1/κ, so 1 − 2 ν times ten is ten times as much.
#[test]
fn the_limit_of_plane_stress_is_the_sheet_that_keeps_its_volume() {
    for name in ["neo-hooke", "mooney-rivlin", "yeoh"] {
        let exact = measured(law(name));
        let far = |poisson_ratio| {
            let actual = measured(sheet(name, poisson_ratio, PlaneState::Stress));
            let pairs = actual.iter().flatten().zip(exact.iter().flatten());
            pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
        };
        let (near, nearer) = (far(0.4995), far(0.49995));
        assert!(nearer < 1e-4, "{name}: {nearer:.1e}");
        assert!(
            (near / nearer - 10.0).abs() < 0.2,
            "{name}: {near:.1e} {nearer:.1e}"
        );
    }
}

fn card(volume: &str) -> String {
    let card = fs::read_to_string(crate::common::root().join("materials/neo-hooke.toml")).unwrap();
    card.replace("[data]", &format!("[volume]\n{volume}\n\n[data]"))
}

fn study(folder: &Path, sheet: &str, volume: &str) {
    fs::write(folder.join("own.toml"), card(volume)).unwrap();
    let material = format!("[material]\ncard = \"own.toml\"\nsheet = \"{sheet}\"\n");
    fs::write(folder.join("small.toml"), material + SMALL).unwrap();
}

#[test]
fn plates_run_in_all_models_in_both_plane_states() {
    let mut reports = Vec::new();
    for sheet in ["plane-stress", "plane-strain"] {
        let folder = TempDir::new().unwrap();
        study(folder.path(), sheet, "poisson_ratio = 0.4");
        let done = gelbench(folder.path(), &["run", "small.toml"]);
        let printed = words(&done.get_output().stdout);
        done.code(0);
        let report = machine_report(&folder.path().join("output/small"));
        assert_eq!(report["material"]["sheet"], sheet);
        let corrected = printed.matches("pass ").count();
        assert_eq!(corrected, 4, "{printed}");
        reports.push(report);
    }
    assert_ne!(reports[0]["steps"], reports[1]["steps"]);
}

/// Cards of laws with a change of volume of their own run in all models, both plane states, and in specimens.
#[test]
fn laws_of_volume_change_run_in_studies() {
    for law in [
        "neo-hooke-simo-pister",
        "blatz-ko",
        "ogden-hill-2",
        "linear-elastic",
    ] {
        for sheet in ["plane-stress", "plane-strain"] {
            let folder = TempDir::new().unwrap();
            study(folder.path(), sheet, "poisson_ratio = 0.4");
            let card = samples::card(law, &samples::parameters(law));
            fs::write(folder.path().join("own.toml"), &card.text).unwrap();
            let done = gelbench(folder.path(), &["run", "small.toml"]);
            let printed = words(&done.get_output().stdout);
            done.code(0);
            assert_eq!(
                printed.matches("pass ").count(),
                4,
                "{law} {sheet}: {printed}"
            );
            let report = machine_report(&folder.path().join("output/small"));
            assert!(report["material"]["bulk_modulus_MPa"].as_f64().unwrap() > 0.0);
            let warnings = report["warnings"].to_string();
            let material = card.law;
            let nu = material.youngs_modulus() / (2.0 * material.shear_modulus()) - 1.0;
            let in_plane = match sheet {
                "plane-strain" => nu / (1.0 - nu),
                _ => nu,
            };
            let equal = (in_plane - 1.0 / 3.0).abs() < 1e-3;
            let message = warnings.contains("ν = ⅓");
            assert_eq!(message, !equal, "{law} {sheet}: {warnings}");
        }
    }
}

#[test]
fn what_cannot_change_its_volume_is_told() {
    let message = |sheet: &str, volume: &str, replace: [&str; 2]| {
        let folder = TempDir::new().unwrap();
        study(folder.path(), sheet, volume);
        let path = folder.path().join("own.toml");
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replace(replace[0], replace[1])).unwrap();
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        one_line(&done.get_output().stderr)
    };
    let none = message("plane-strain", "", ["[volume]", ""]);
    assert!(
        none.contains("is incompressible") && none.contains("poisson_ratio"),
        "{none}"
    );
    let both = message(
        "plane-stress",
        "poisson_ratio = 0.3\nbulk_modulus = \"1 MPa\"",
        ["", ""],
    );
    assert!(both.contains("one of them is enough"), "{both}");
    let half = message("plane-stress", "poisson_ratio = 0.5", ["", ""]);
    assert!(half.contains("between -0.9 and 0.4999"), "{half}");
    let energy = message(
        "plane-stress",
        "poisson_ratio = 0.3\nenergy = \"cubic\"",
        ["", ""],
    );
    assert!(energy.contains("simo-taylor"), "{energy}");
    let compressible = message(
        "plane-stress",
        "poisson_ratio = 0.3",
        ["law = \"neo-hooke\"", "law = \"blatz-ko\""],
    );
    assert!(
        compressible.contains("compressible by itself"),
        "{compressible}"
    );
    let water = message("plane-strain", "bulk_modulus = \"2.2 GPa\"", ["", ""]);
    assert!(
        water.contains("times its shear modulus") && water.contains("`poisson_ratio = 0.4999`"),
        "{water}"
    );
    assert!(!half.contains("unknown key"), "{half}");
    let unknown = message("thick", "poisson_ratio = 0.3", ["", ""]);
    assert!(unknown.contains("plane-strain"), "{unknown}");
}

/// Two terms of a foam whose bulk modulus is negative, Σ 2 μᵢ (⅓ + βᵢ), have a stress without strain.
#[test]
fn a_foam_that_is_not_at_rest_is_refused() {
    let check = |mu_2: &str| {
        let folder = TempDir::new().unwrap();
        study(folder.path(), "plane-stress", "poisson_ratio = 0.4");
        let parameters = format!(
            "mu_1 = \"1 MPa\"\nalpha_1 = 8\nnu_1 = 0\nmu_2 = \"{mu_2}\"\nalpha_2 = 2\nnu_2 = 0.45\n"
        );
        let text = samples::card("ogden-hill-2", &parameters).text;
        fs::write(folder.path().join("own.toml"), text).unwrap();
        let done = gelbench(folder.path(), &["check", "small.toml"]);
        let output = done.get_output();
        (output.status.code(), one_line(&output.stderr))
    };
    let (code, message) = check("-0.5 MPa");
    assert!(
        code == Some(2) && message.contains("unstable from rest"),
        "{message}"
    );
    assert_eq!(check("0.5 MPa").0, Some(0));
}

/// At small strain E = 2 μ (1 + ν) instead of 3 μ; in plane strain the report has E, and not E/(1 − ν²).
#[test]
fn a_volume_that_changes_tension_is_warned_of() {
    for (ratio, message) in [("0.4", true), ("0.4999", false)] {
        let folder = TempDir::new().unwrap();
        study(
            folder.path(),
            "plane-strain",
            &format!("poisson_ratio = {ratio}"),
        );
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(0);
        let warned = one_line(&done.get_output().stderr);
        assert_eq!(warned.contains("constant volume"), message, "{warned}");
    }
    let card = gelbench::material::Card::parse("own", "own.toml", &card("poisson_ratio = 0.4"));
    let card = card.unwrap();
    let shear = card.law.shear_modulus();
    let [stretch, change] = card.tension_by_volume().unwrap();
    assert!((0.5..=3.0).contains(&stretch) && change < 1.4 / 1.5 - 1.0);
    let plane = card.in_plane_strain().unwrap();
    assert!((plane.youngs_modulus() / (2.8 * shear) - 1.0).abs() < 1e-9);
}
