//! Measured data that are corrected, fitted and identified to the end, small ones.

use std::fmt::Write;
use std::path::PathBuf;

use gelbench::budget::Budget;
use gelbench::calibration::{FitSettings, TestData, Weighting, fit as fit_law};
use gelbench::document::{Statements, Table};
use gelbench::error::Error;
use gelbench::estimation::{EdgeCondition, Physics, Robust};
use gelbench::identification::{
    Argument, Form, IdentificationSettings, Recording, Shape, identify as identify_spring, law_text,
};
use gelbench::markers::ReadSettings;
use gelbench::material::Card;
use gelbench::material::registry::LAWS;
use gelbench::mesh::CellShape;
use gelbench::studies::markers::{Conditions, MarkerStudy, MeshSource, Request};
use gelbench_estimation::estimation::Unnamed;
use gelbench_report::results::{
    fit_json, fit_picture, identification_json, identification_picture,
};
use gelbench_studies::studies::markers::{measured_force, written};
use gelbench_studies::studies::pictures::Pictures;

use super::choices::Choices;
use super::{Became, with_file};

/// What a correction of the campaign may ask for.
const SMALL: Budget = Budget {
    cells: 300.0,
    instants: 4.0,
    unknowns: 1500.0,
    ..Budget::USUAL
};

/// Bytes as a text where they are one of a table, and choices beside it; else the table that the bytes choose.
fn table<'a>(bytes: &'a [u8], of_choices: fn(&mut Choices) -> String) -> (String, Choices<'a>) {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.starts_with('#') => (text.to_owned(), Choices::new(&[])),
        _ => {
            let mut choices = Choices::new(bytes);
            (of_choices(&mut choices), choices)
        }
    }
}

/// Markers are corrected.
pub fn correct(bytes: &[u8]) -> Became {
    let (text, mut choices) = table(bytes, markers);
    with_file("markers.csv", text.as_bytes(), |file| {
        let request = request(file.to_owned(), &mut choices);
        let field = MarkerStudy::prepare(request, &|_| ());
        let result = field.and_then(|mut field| Ok((field.estimate(&|_| ())?, field)));
        match result {
            Ok((estimates, field)) => {
                let _ = field.all_doubts(&estimates);
                let (pictures, name) = (Pictures::default(), "markers".to_owned());
                let _ = written::results(&pictures, &field, &estimates, name, String::new(), 0.0);
                Became::Complete
            }
            Err(Error::Solve { .. }) => Became::Unsolved,
            Err(fault) => {
                if std::env::var_os("GELBENCH_FUZZ_SHOW").is_some() {
                    eprintln!("{text}\n{fault}");
                }
                Became::Refused
            }
        }
    })
}

/// A field between homogeneous and strange on a grid that lacks some points.
fn markers(choices: &mut Choices) -> String {
    let mut text = "# a table\nx [mm],y [mm],ux [mm],uy [mm]\n".to_owned();
    let [nx, ny] = [2 + choices.below(6), 2 + choices.below(5)];
    let spacing = choices.between(2.0, 10.0);
    let stretch = choices.between(0.02, 0.4);
    let noise = choices.between(0.0, 0.3);
    for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
        let (x, y) = (spacing * i as f64, spacing * j as f64);
        if choices.rarely() {
            continue;
        }
        let [dx, dy] = [0, 1].map(|_| noise * (choices.between(0.0, 1.0) - 0.5));
        let _ = writeln!(
            text,
            "{x},{y},{},{}",
            stretch * x + dx,
            dy - 0.4 * stretch * y
        );
    }
    text
}

fn request(file: PathBuf, choices: &mut Choices) -> Request {
    let condition = |choices: &mut Choices| match choices.below(5) {
        0 => EdgeCondition::Rigid,
        1 => EdgeCondition::Free,
        2 => EdgeCondition::Unknown,
        3 => EdgeCondition::Known([Some(0.0), None]),
        _ => EdgeCondition::Known([Some(choices.between(-1.0, 5.0)), Some(0.0)]),
    };
    let mut edges = Vec::new();
    for (edge, usual) in [
        ("left", EdgeCondition::Rigid),
        ("right", EdgeCondition::Rigid),
        ("top", EdgeCondition::Free),
        ("bottom", EdgeCondition::Free),
    ] {
        match choices.below(4) {
            0 | 1 => edges.push((edge.to_owned(), usual)),
            2 => edges.push((edge.to_owned(), condition(choices))),
            _ => {}
        }
    }
    let force = choices
        .maybe()
        .then(|| measured_force("right", 0, choices.between(0.05, 2.0), None));
    let fitted = force.is_some() && choices.maybe();
    let material = choices.one(&["neo-hooke", "pva-10", "mooney-rivlin", "treloar-ogden-3"]);
    let first = Card::load(material, "".as_ref()).ok().and_then(|card| {
        let first = card.parameters.first()?;
        Some(first.key.to_owned())
    });
    Request {
        files: vec![file],
        reading: ReadSettings::default(),
        images: Default::default(),
        material: material.to_owned(),
        thickness: choices.between(0.5, 2.0),
        mesh: MeshSource::Data,
        cell_size: (!choices.rarely()).then(|| choices.between(4.0, 16.0)),
        shape: [
            CellShape::Triangle6,
            CellShape::Triangle3,
            CellShape::Quad4,
            CellShape::Quad9,
        ][choices.below(4)],
        holes: choices.maybe(),
        conditions: Conditions {
            edges,
            noise: choices.rarely().then(|| choices.between(0.01, 0.5)),
            robust: [
                None,
                Some(Robust::No),
                Some(Robust::Huber),
                Some(Robust::Tukey),
            ][choices.below(4)],
            physics: [Physics::Exact, Physics::Weighted][choices.below(2)],
            unnamed: Unnamed::NAMES[choices.below(Unnamed::NAMES.len())].1,
            forces: force.into_iter().map(|force| (None, force)).collect(),
            fit: first.filter(|_| fitted).into_iter().collect(),
            edge_gap: choices.maybe().then(|| choices.between(0.0, 2.0)),
            ..Conditions::default()
        },
        forces: None,
        budget: SMALL,
    }
}

/// A law is fitted to test data.
pub fn fit(bytes: &[u8]) -> Became {
    let (text, mut choices) = table(bytes, test_data);
    let Ok(data) = TestData::parse("test.csv", &text, &Statements::new()) else {
        return Became::Refused;
    };
    let settings = FitSettings {
        weighting: Weighting::NAMES[choices.below(Weighting::NAMES.len())].1,
        starts: 1 + choices.below(3),
        ..FitSettings::default()
    };
    let law = &LAWS[choices.below(LAWS.len())];
    let tests = [data];
    match fit_law(law, &tests, &settings) {
        Ok(result) => {
            let _ = (fit_json(&result, &tests), fit_picture(&result, &tests));
            Became::Complete
        }
        Err(Error::Solve { .. }) => Became::Unsolved,
        Err(_) => Became::Refused,
    }
}

fn test_data(choices: &mut Choices) -> String {
    let mut text = format!(
        "# test: {}\n# stress measure: {}\n# strain measure: {}\nstrain [-],stress [MPa]\n",
        choices.one(&["uniaxial", "planar", "equibiaxial", "compression"]),
        choices.one(&["nominal", "cauchy"]),
        choices.one(&["nominal", "logarithmic"]),
    );
    let (modulus, bend) = (choices.between(0.01, 1.0), choices.between(-0.2, 0.5));
    let count = 2 + choices.below(10);
    for i in 1..=count {
        let strain = if choices.rarely() {
            choices.between(-0.5, 3.0)
        } else {
            0.1 * i as f64
        };
        let stress = modulus * strain * (1.0 + bend * strain) + choices.between(-0.001, 0.001);
        let _ = writeln!(text, "{strain},{stress}");
    }
    text
}

/// Spring and dashpot are found in a recording.
pub fn identify(bytes: &[u8]) -> Became {
    let (text, mut choices) = table(bytes, recording);
    let table = Table::parse("spring.csv", &text);
    let recording = table.and_then(|table| Recording::of_table(&table, &Statements::new()));
    let Ok(recording) = recording else {
        return Became::Refused;
    };
    let form = |choices: &mut Choices| {
        let known = [
            "constant",
            "spline",
            "polynomial-1",
            "polynomial-3",
            "spline-5",
            "spline-12",
        ];
        Form::parse(choices.one(&known)).expect("a known form")
    };
    let known = |choices: &mut Choices| {
        [Shape::Free, Shape::Increasing, Shape::Decreasing][choices.below(3)]
    };
    let settings = IdentificationSettings {
        forms: [form(&mut choices), form(&mut choices)],
        shapes: [known(&mut choices), known(&mut choices)],
        argument: [Argument::Extension, Argument::Rate][choices.below(2)],
    };
    match identify_spring(&recording, settings, &|_| ()) {
        Ok(result) => {
            let _ = identification_json(&result, &recording, "spring.csv");
            let _ = identification_picture(&result, &recording);
            let _ = law_text(&result, &recording, "spring.csv");
            Became::Complete
        }
        Err(Error::Solve { .. }) => Became::Unsolved,
        Err(_) => Became::Refused,
    }
}

fn recording(choices: &mut Choices) -> String {
    let mut text = String::from("# a recording\n");
    if choices.maybe() {
        let _ = writeln!(text, "# mass: {} g", choices.between(1.0, 300.0));
    }
    let _ = writeln!(text, "# length: 50 mm\ntime [s],extension [mm],force [N]");
    let count = 30 + choices.below(120);
    let (frequency, stiffness) = (choices.between(0.2, 3.0), choices.between(0.0, 0.5));
    let (damping, noise) = (choices.between(0.0, 0.1), choices.between(0.0, 0.05));
    let mut time = 0.0;
    for _ in 0..count {
        time += if choices.rarely() {
            choices.between(0.001, 1.0)
        } else {
            0.02
        };
        let angle = std::f64::consts::TAU * frequency * time;
        let (x, rate) = (5.0 * angle.sin(), 5.0 * frequency * angle.cos());
        let noise = noise * choices.between(-1.0, 1.0);
        let _ = writeln!(
            text,
            "{time},{},{}",
            x + noise,
            stiffness * x + damping * rate + noise
        );
    }
    text
}
