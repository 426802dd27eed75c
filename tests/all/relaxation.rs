//! Relaxation from a record to a card to a motion: the command's words, and the round trip with the module that moves sheets.

use std::fs;
use std::sync::Arc;

use crate::common::{gelbench, words};
use gelbench::calibration::{FitSettings, Terms, TestData, fit_relaxation};
use gelbench::document::Statements;
use gelbench::dynamics::SheetViscosity;
use gelbench::finite_element::{Element, FiniteElements};
use gelbench::material::Card;
use gelbench::material::registry::Law;
use gelbench::material::viscosity::{Relaxation, ViscousMaterial};
use gelbench::mesh::Side;
use gelbench::problem::ClampedPlate;
use gelbench::solve::Potential;
use gelbench_mechanics::dynamics::Viscosity;
use gelbench_mechanics::dynamics::viscosity::{ElementMotion, ViscousLocal};
use tempfile::TempDir;

/// Nominal stresses of a single element that follows a history of stretches as a strip with free edges, step by step as motions do.
fn moved(material: &ViscousMaterial, history: &[[f64; 2]]) -> Vec<f64> {
    let law = Card::load("pva-10-yeoh", std::path::Path::new("."))
        .unwrap()
        .law;
    let plate = ClampedPlate {
        size: [10.0, 5.0],
        thickness: 2.0,
        law: Arc::clone(&law),
        stretches: Vec::new(),
    };
    let elements = FiniteElements::new(&plate, [1, 1], Element::Q1);
    let energy = elements.energy();
    let sheet = SheetViscosity::new(energy, material);
    let mesh = &elements.mesh;
    let unknowns = energy.element_unknowns(0);
    let displacement = |stretch: f64| -> Vec<f64> {
        let across = stretch.powf(-0.5);
        let of = |unknown: &u32| {
            let [x, y] = mesh.nodes[*unknown as usize / 2];
            if unknown.is_multiple_of(2) {
                (stretch - 1.0) * x
            } else {
                (across - 1.0) * y
            }
        };
        unknowns.iter().map(of).collect()
    };
    let still = vec![0.0; unknowns.len()];
    let mut memory = vec![0.0; sheet.memory(0)];
    let long_rest = ElementMotion {
        displacement: &displacement(history[0][1]),
        velocity: &still,
        memory: &memory.clone(),
        elapsed: f64::INFINITY,
    };
    sheet.remember(0, long_rest, &mut memory).unwrap();
    let mut before = history[0][0];
    let mut stresses = Vec::new();
    for [time, stretch] in history {
        let u = displacement(*stretch);
        let motion = ElementMotion {
            displacement: &u,
            velocity: &still,
            memory: &memory,
            elapsed: time - before,
        };
        let mut force = vec![0.0; u.len()];
        let local = ViscousLocal {
            force: &mut force,
            tangents: None,
        };
        sheet.add_element(0, motion, local).unwrap();
        let right = unknowns.iter().zip(&force);
        let right = right
            .filter(|(unknown, _)| unknown.is_multiple_of(2))
            .filter(|(unknown, _)| mesh.on(Side::Right, **unknown as usize / 2));
        let viscous: f64 = right.map(|(_, force)| force).sum();
        stresses.push(viscous / 10.0 + law.tension([1.0, 0.0], stretch - 1.0).nominal_stress);
        let mut next = memory.clone();
        sheet.remember(0, motion, &mut next).unwrap();
        memory = next;
        before = *time;
    }
    stresses
}

/// Cycles, holds and two rates of a sheet that was moved give its law and its series back.
#[test]
fn what_motions_compute_is_what_fits_read() {
    let material = ViscousMaterial {
        relaxation: vec![
            Relaxation {
                share: 0.25,
                time: 0.3,
            },
            Relaxation {
                share: 0.15,
                time: 4.0,
            },
        ],
        ..ViscousMaterial::default()
    };
    let at = |t: f64| match t {
        t if t < 0.5 => 1.0 + 0.6 * t,
        t if t < 4.0 => 1.3,
        t if t < 6.0 => 1.3 + 0.15 * (t - 4.0),
        t if t < 10.0 => 1.6,
        t => (1.6 - 0.3 * (t - 10.0)).max(1.0),
    };
    let history: Vec<[f64; 2]> = (0..=700)
        .map(|i| 0.02 * f64::from(i))
        .map(|t| [t, at(t)])
        .collect();
    let stresses = moved(&material, &history);
    let rows: String = history
        .iter()
        .zip(&stresses)
        .map(|([t, l], p)| format!("{t},{l},{p}\n"))
        .collect();
    let text = format!("# test: uniaxial\ntime [s],stretch [-],nominal_stress [MPa]\n{rows}");
    let tests = [TestData::parse("moved.csv", &text, &Statements::new()).unwrap()];
    let law = Law::named("yeoh").unwrap();
    let fit = fit_relaxation(law, &tests, &FitSettings::default(), Terms::Exactly(2)).unwrap();
    let card = Card::load("pva-10-yeoh", std::path::Path::new(".")).unwrap();
    let truth: Vec<f64> = card
        .parameters
        .iter()
        .map(|one| one.value)
        .chain([0.25, 0.3, 0.15, 4.0])
        .collect();
    for (actual, truth) in fit.parameters.iter().zip(truth) {
        // The fit divides steps of the stretch that are longer than 1 %.
        assert!(
            (actual.value / truth - 1.0).abs() < 2e-3,
            "{} {} {truth}",
            actual.key,
            actual.value
        );
    }
    let worst = fit.predicted[0].iter().zip(&stresses);
    let worst = worst.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    let largest = stresses.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
    assert!(worst < 1e-4 * largest, "{worst} of {largest}");
}

/// Ramp in 0.5 s to 20 %, hold to 20 s, as a machine records it.
fn record() -> String {
    let mut text = String::from(
        "# test: uniaxial; length: 20 mm; area: 10 mm^2\nTime [s],Extension [mm],Load [N]\n",
    );
    let material = ViscousMaterial {
        relaxation: vec![Relaxation {
            share: 0.4,
            time: 2.0,
        }],
        ..ViscousMaterial::default()
    };
    let history: Vec<[f64; 2]> = (0..=400)
        .map(|i| 0.05 * f64::from(i))
        .map(|t| [t, 1.0 + 0.2 * (2.0 * t).min(1.0)])
        .collect();
    for (row, ([t, l], p)) in history.iter().zip(moved(&material, &history)).enumerate() {
        let scatter = 2e-4 * ((12.9898 * row as f64).sin() * 43758.5453).fract();
        text += &format!("{t:.3},{:.5},{:.6}\n", 20.0 * (l - 1.0), 10.0 * p + scatter);
    }
    text
}

#[test]
fn a_record_becomes_a_card_that_motions_and_pictures_take() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("hold.csv"), record()).unwrap();
    let arguments = [
        "materials",
        "fit",
        "hold.csv",
        "--law",
        "yeoh",
        "--relaxation",
        "--name",
        "gel",
        "--output",
        ".",
    ];
    let done = gelbench(folder.path(), &arguments).code(0);
    let output = words(&done.get_output().stdout);
    assert!(
        output.contains("terms        1 of a Prony series"),
        "{output}"
    );
    assert!(
        output.contains("0.05000 to 20.00 s are resolved"),
        "{output}"
    );
    gelbench(folder.path(), &["materials", "refit", "gel.toml"]).code(0);
    gelbench(
        folder.path(),
        &["materials", "plot", "gel.toml", "--output", "curves.png"],
    )
    .code(0);
    let shown = gelbench(folder.path(), &["materials", "show", "gel.toml"]).code(0);
    let shown = words(&shown.get_output().stdout);
    assert!(
        shown.contains("rates of the relaxation tests") && shown.contains("  0.4000 to 0.4000 1/s"),
        "{shown}"
    );
    // A motion that lasts longer and is faster than the test.
    let study =
        fs::read_to_string(crate::common::root().join("examples/relaxing_plate.toml")).unwrap();
    let viscosity = study.find("[material.viscosity]").unwrap()..study.find("[plate]").unwrap();
    let study = study
        .replace(&study[viscosity], "")
        .replace("\"pva-10\"", "\"gel.toml\"");
    fs::write(
        folder.path().join("study.toml"),
        study.replace("\"12 s\"", "\"22 s\""),
    )
    .unwrap();
    let done = gelbench(folder.path(), &["check", "study.toml"]).code(0);
    let warned = words(&done.get_output().stderr);
    for message in [
        "the relaxation was measured over 20 s",
        "the stretch rate of the grip is 1.0000 1/s",
    ] {
        assert!(warned.contains(message), "{warned}");
    }
    for (arguments, message) in [
        (["--relaxation", "many"], "not a number of terms"),
        (["--relaxation", "7"], "not a number of terms"),
    ] {
        let refused = ["materials", "fit", "hold.csv", "--law", "yeoh"];
        let refused: Vec<&str> = refused.into_iter().chain(arguments).collect();
        let output = gelbench(folder.path(), &refused).code(2);
        assert!(words(&output.get_output().stderr).contains(message));
    }
}
