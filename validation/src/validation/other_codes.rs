//! The built-in finite elements compared with dolfinx, scikit-fem and FElupe on the same mesh.

use std::collections::BTreeMap;
use std::path::Path;

use super::case::{Check, Computation, Outcome, Progress, check, section};
use crate::document::Section;
use crate::error::Error;
use crate::finite_element::convergence::richardson;
use crate::finite_element::{Element, FiniteElements};
use crate::material::Card;
use crate::mesh::Mesh;
use crate::problem::{ClampedPlate, Measures};
use crate::solve::State;
use crate::statistics::larger;

/// Converged force in N and width at mid length in mm at the stretches, by Richardson's extrapolation of the same codes.
const CONVERGED: &str = include_str!("../../plate/converged.csv");
const SUMMARY: &str = include_str!("../../plate/summary.csv");
const STRETCHES: [f64; 5] = [0.15, 0.3, 0.5, 0.75, 1.0];

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let finest = section(root, "mesh", |mesh| mesh.count("finest", 30, 120));
    Box::new(move |progress| compute(finest, progress))
}

/// One mesh of one material.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Model {
    material: String,
    /// Cells along the plate.
    along: usize,
    element: String,
}

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
        let model = Model {
            material: cells[0].to_owned(),
            along,
            element: cells[5].to_owned(),
        };
        models.entry(model).or_default().push(Row {
            code: cells[1].to_owned(),
            stretch: number(7).unwrap_or(f64::NAN),
            values: [8, 9, 10].map(number),
        });
    }
    models
}

fn compute(finest: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut worst: BTreeMap<[String; 2], f64> = BTreeMap::new();
    for (model, rows) in published(finest) {
        let (along, across) = (model.along, model.along / 3);
        let (material, element) = (model.material, model.element);
        progress.tell(&format!("{material}, {element}, {along} × {across} cells"));
        let solved = Solved::new(&material, along, &element)?;
        for row in rows {
            let Some(actual) = solved.at(row.stretch) else {
                continue;
            };
            let computed = [actual.force, actual.mid_width, actual.energy];
            let largest = worst.entry([row.code, element.clone()]).or_insert(0.0);
            for (computed, expected) in computed.into_iter().zip(row.values) {
                let error = expected.map_or(0.0, |expected| (computed / expected - 1.0).abs());
                *largest = larger(*largest, error);
            }
        }
    }
    let checks = worst.into_iter().map(|([code, element], error)| {
        let what = format!(
            "force, width, energy compared with {code}, {element}: largest relative difference"
        );
        check(what, "–", error).at_most(1e-6, "validation/plate/summary.csv")
    });
    let mut checks: Vec<Check> = checks.collect();
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

/// Richardson's extrapolation of Q2 elements on three meshes compared with the published converged values.
fn converged(material: &str, finest: usize, progress: Progress) -> Result<[Check; 2], Error> {
    progress.tell(&format!("{material}, converged"));
    let meshes = [finest / 4, finest / 2, finest].map(|along| Solved::new(material, along, "Q2"));
    let [coarse, middle, fine] = meshes;
    let meshes = [coarse?, middle?, fine?];
    let (mut force, mut width) = (0.0, 0.0);
    let lines = CONVERGED.lines().skip(1);
    for line in lines.filter(|line| line.starts_with(&format!("{material},"))) {
        let numbers = line.split(',').skip(1).filter_map(|cell| cell.parse().ok());
        let numbers: Vec<f64> = numbers.collect();
        let measures = meshes.each_ref().map(|solved| {
            let actual = solved.at(numbers[0]);
            actual.expect("the published stretches are computed")
        });
        let error = |value: fn(&Measures) -> f64, expected: f64| {
            let actual = richardson(measures.each_ref().map(value)).extrapolated;
            (actual / expected - 1.0).abs()
        };
        force = larger(force, error(|actual| actual.force, numbers[1]));
        width = larger(width, error(|actual| actual.mid_width, numbers[2]));
    }
    let check = |quantity: &str, error: f64| {
        let what = format!("{material}: converged {quantity}, largest relative difference");
        check(what, "–", error).at_most(1e-4, "validation/plate/converged.csv")
    };
    Ok([check("force", force), check("width at mid length", width)])
}

/// A mesh of the plate, and its state at each stretch.
struct Solved {
    mesh: Mesh,
    states: Vec<State>,
}

impl Solved {
    fn new(material: &str, along: usize, element: &str) -> Result<Self, Error> {
        let card = match material {
            "nh" => "neo-hooke",
            _ => "pva-10",
        };
        let element = match element {
            "Q1" => Element::Q1,
            _ => Element::Q2,
        };
        let problem = ClampedPlate {
            size: [150.0, 50.0],
            thickness: 2.0,
            law: Card::load(card, Path::new("."))?.law,
            stretches: STRETCHES.to_vec(),
        };
        let model = FiniteElements::new(&problem, [along, along / 3], element);
        let states = model.solve(&problem, super::plate::NEWTON, &|_| ())?;
        Ok(Self {
            mesh: model.mesh,
            states,
        })
    }

    fn at(&self, stretch: f64) -> Option<Measures> {
        let state = self.states.iter().find(|state| state.factor == stretch)?;
        Some(Measures::of(&self.mesh, state))
    }
}
