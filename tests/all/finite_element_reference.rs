//! The built-in finite elements against dolfinx, scikit-fem and FElupe at equal mesh.

use std::sync::Arc;

use gelbench::finite_element::{Element, FiniteElements};
use gelbench::material::{Card, HyperelasticLaw};
use gelbench::problem::{ClampedPlate, Measures};
use gelbench::solve::NewtonSettings;

const SETTINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 30,
};

fn plate(material: &str) -> ClampedPlate {
    let card = match material {
        "nh" => "neo-hooke",
        _ => "pva-10",
    };
    let law: Arc<dyn HyperelasticLaw> = Card::load(card, ".".as_ref()).unwrap().law;
    ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law,
        stretches: vec![0.15, 0.3, 0.5, 0.75, 1.0],
    }
}

/// Rows of `validation/plate/summary.csv`: (code, stretch, [force N, width mm, energy mJ]);
/// FElupe's rows hold no energy.
fn published(
    material: &str,
    cells: [usize; 2],
    element: Element,
) -> Vec<(String, f64, [Option<f64>; 3])> {
    let text = include_str!("../../validation/plate/summary.csv");
    let rows = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>());
    let number = |text: &str| (!text.is_empty()).then(|| text.parse::<f64>().unwrap());
    rows.filter(|row| {
        row[0] == material
            && row[3] == cells[0].to_string()
            && row[4] == cells[1].to_string()
            && row[5] == element.name()
    })
    .map(|row| {
        (
            row[1].to_owned(),
            number(row[7]).unwrap(),
            [8, 9, 10].map(|column| number(row[column])),
        )
    })
    .collect()
}

fn compare(material: &str, cells: [usize; 2], element: Element) {
    let problem = plate(material);
    let model = FiniteElements::new(&problem, cells, element);
    let solutions = model.solve(&problem, SETTINGS, &|_| ()).unwrap();
    let rows = published(material, cells, element);
    assert!(rows.len() >= 10, "two codes and five stretches");
    for (code, stretch, values) in rows {
        let solution = solutions
            .iter()
            .find(|solution| solution.factor == stretch)
            .unwrap();
        let actual = Measures::of(&model.mesh, solution);
        let computed = [actual.force, actual.mid_width, actual.energy];
        for (name, (computed, expected)) in ["force", "width", "energy"]
            .iter()
            .zip(computed.iter().zip(values))
        {
            let Some(expected) = expected else { continue };
            let error = (computed / expected - 1.0).abs();
            println!("{material} {cells:?} {element:?} {stretch} {code} {name} {error:.1e}");
            assert!(
                error < 1e-6,
                "{material} {cells:?} {element:?} at {stretch}: {name} {computed} {code} {expected}: {error:.1e}"
            );
        }
    }
}

#[test]
fn q1_reproduces_force_width_and_energy_of_other_codes() {
    for material in ["nh", "marlow"] {
        compare(material, [30, 10], Element::Q1);
        compare(material, [60, 20], Element::Q1);
        compare(material, [120, 40], Element::Q1);
    }
}

#[test]
fn q2_reproduces_force_width_and_energy_of_other_codes() {
    for material in ["nh", "marlow"] {
        compare(material, [30, 10], Element::Q2);
        compare(material, [60, 20], Element::Q2);
        compare(material, [120, 40], Element::Q2);
    }
}

/// `validation/plate/displacement_*.csv`: displacements at 31 × 11 material points.
#[test]
fn q2_reproduces_the_displacements_of_another_code() {
    let files = [
        (
            "nh",
            [60, 20],
            include_str!("../../validation/plate/displacement_nh_60x20_Q2.csv"),
        ),
        (
            "nh",
            [120, 40],
            include_str!("../../validation/plate/displacement_nh_120x40_Q2.csv"),
        ),
        (
            "marlow",
            [60, 20],
            include_str!("../../validation/plate/displacement_marlow_60x20_Q2.csv"),
        ),
        (
            "marlow",
            [120, 40],
            include_str!("../../validation/plate/displacement_marlow_120x40_Q2.csv"),
        ),
    ];
    for (material, cells, text) in files {
        let problem = plate(material);
        let model = FiniteElements::new(&problem, cells, Element::Q2);
        let solutions = model.solve(&problem, SETTINGS, &|_| ()).unwrap();
        let (mut worst, mut rows) = (0.0_f64, 0);
        for line in text.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let [stretch, x, y, ux, uy] = row[..] else {
                panic!("five columns: {line}")
            };
            let solution = solutions
                .iter()
                .find(|solution| solution.factor == stretch)
                .unwrap();
            let actual = model.mesh.displacement_at(&solution.displacement, [x, y]);
            let largest = 150.0 * stretch;
            worst = worst.max((actual[0] - ux).abs().max((actual[1] - uy).abs()) / largest);
            rows += 1;
        }
        assert_eq!(rows, 5 * 31 * 11);
        assert!(
            worst < 1e-6,
            "{material} {cells:?}: {worst:.1e} of the largest displacement"
        );
    }
}
