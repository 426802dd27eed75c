//! The built-in finite elements at equal mesh beside dolfinx, scikit-fem and FElupe.

use std::collections::BTreeMap;
use std::path::Path;

use super::case::{Check, Outcome, Prepared, Progress, Wanted};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::finite_element::{Element, FiniteElements};
use crate::material::Card;
use crate::mesh::Mesh;
use crate::problem::{ClampedPlate, Measures};
use crate::solve::State;

/// Converged force in N and width at mid length in mm at the stretches, by Richardson's extrapolation of the same codes.
const CONVERGED: &str = include_str!("../../validation/plate/converged.csv");
const SUMMARY: &str = include_str!("../../validation/plate/summary.csv");
const STRETCHES: [f64; 5] = [0.15, 0.3, 0.5, 0.75, 1.0];

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let finest = section.count("finest", 30, 120);
    section.unknown_keys();
    Box::new(move |progress| compute(finest, progress))
}

/// One mesh of one material: (material, cells along the plate, element).
type Model = (String, usize, String);

/// Force, width and energy of one code at one stretch, where it gives them.
struct Row {
    code: String,
    stretch: f64,
    values: [Option<f64>; 3],
}

fn published(finest: usize) -> BTreeMap<Model, Vec<Row>> {
    let mut models: BTreeMap<Model, Vec<Row>> = BTreeMap::new();
    for line in SUMMARY.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |column: usize| cells[column].parse::<f64>().ok();
        let along = number(3).unwrap_or(f64::NAN) as usize;
        if along > finest {
            continue;
        }
        let model = (cells[0].to_owned(), along, cells[5].to_owned());
        models.entry(model).or_default().push(Row {
            code: cells[1].to_owned(),
            stretch: number(7).unwrap_or(f64::NAN),
            values: [8, 9, 10].map(number),
        });
    }
    models
}

fn compute(finest: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut worst: BTreeMap<(String, String), f64> = BTreeMap::new();
    for ((material, along, element), rows) in published(finest) {
        progress(&format!(
            "{material}, {element}, {along} × {} cells",
            along / 3
        ));
        let (mesh, solutions) = solve(&material, along, &element)?;
        for row in rows {
            let Some(solution) = solutions
                .iter()
                .find(|solution| solution.factor == row.stretch)
            else {
                continue;
            };
            let found = Measures::of(&mesh, solution);
            let computed = [found.force, found.mid_width, found.energy];
            let largest = worst.entry((row.code, element.clone())).or_insert(0.0);
            for (computed, expected) in computed.into_iter().zip(row.values) {
                let error = expected.map_or(0.0, |expected| (computed / expected - 1.0).abs());
                *largest = largest.max(error);
            }
        }
    }
    let check = |((code, element), error): ((String, String), f64)| {
        let quantity =
            format!("force, width, energy beside {code}, {element}: largest relative difference");
        Check::new(
            quantity,
            "–",
            Wanted::AtMost(1e-6),
            "validation/plate/summary.csv",
            error,
        )
    };
    let mut checks: Vec<Check> = worst.into_iter().map(check).collect();
    // Three meshes, each twice as fine as the one before, with as many cells across as a third of those along.
    let is_fine = finest >= 60 && finest.is_multiple_of(12);
    for material in ["marlow", "nh"].into_iter().filter(|_| is_fine) {
        checks.extend(converged(material, finest, progress)?);
    }
    Ok(Outcome {
        checks,
        ..Outcome::default()
    })
}

/// Richardson's extrapolation of Q2 elements on three meshes beside the published converged values.
fn converged(material: &str, finest: usize, progress: Progress) -> Result<[Check; 2], Error> {
    progress(&format!("{material}, converged"));
    let meshes = [finest / 4, finest / 2, finest].map(|along| solve(material, along, "Q2"));
    let [coarse, middle, fine] = meshes;
    let (coarse, middle, fine) = (coarse?, middle?, fine?);
    let mut worst = [0.0_f64; 2];
    for line in CONVERGED
        .lines()
        .skip(1)
        .filter(|line| line.starts_with(&format!("{material},")))
    {
        let numbers: Vec<f64> = line
            .split(',')
            .skip(1)
            .filter_map(|cell| cell.parse().ok())
            .collect();
        let at = |(mesh, solutions): &Solved| {
            let solution = solutions
                .iter()
                .find(|solution| solution.factor == numbers[0]);
            let solution = solution.expect("the published stretches are computed");
            let found = Measures::of(mesh, solution);
            [found.force, found.mid_width]
        };
        let (coarse, middle, fine) = (at(&coarse), at(&middle), at(&fine));
        for (quantity, worst) in worst.iter_mut().enumerate() {
            let values = [coarse[quantity], middle[quantity], fine[quantity]];
            let error = richardson(values).extrapolated / numbers[1 + quantity] - 1.0;
            *worst = worst.max(error.abs());
        }
    }
    let [force, width] = worst;
    Ok(
        [("force", force), ("width at mid length", width)].map(|(quantity, error)| {
            Check::new(
                format!("{material}: converged {quantity}, largest relative difference"),
                "–",
                Wanted::AtMost(1e-4),
                "validation/plate/converged.csv",
                error,
            )
        }),
    )
}

/// A mesh, and the state at each stretch.
type Solved = (Mesh, Vec<State>);

fn solve(material: &str, along: usize, element: &str) -> Result<Solved, Error> {
    let card = if material == "nh" {
        "neo-hooke"
    } else {
        "pva-10"
    };
    let problem = ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law: Card::load(card, Path::new("."))?.law,
        stretches: STRETCHES.to_vec(),
    };
    let element = if element == "Q1" {
        Element::Q1
    } else {
        Element::Q2
    };
    let model = FiniteElements::new(&problem, [along, along / 3], element);
    let states = model.solve(&problem, super::plate::NEWTON, &|_| ())?;
    Ok((model.mesh, states))
}
