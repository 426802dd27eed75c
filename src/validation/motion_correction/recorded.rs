//! A recorded motion with noise and an unknown start.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::{Body, Settings, corrected_energy, integrate, percent, sheet_model};
use crate::corrector::motion::EquationOfMotion;
use crate::corrector::{CorrectorSettings, Solver};
use crate::document::{Bound, Section};
use crate::dynamics::{Dashpots, SheetViscosity};
use crate::error::Error;
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::DashpotLaw;
use crate::results::Block;
use crate::units::Dimension;
use crate::validation::case::{Check, Outcome, Progress, Wanted, limit, number};
use crate::validation::plate::Plate;

/// What is recorded.
pub struct Recording {
    cells: [usize; 2],
    noise: f64,
    steps: usize,
    instants: usize,
    seeds: u64,
}

impl Recording {
    pub fn read(root: &Section) -> Self {
        let section = root.section("recording");
        let cells = section.count_pair("cells", 2, 400).unwrap_or([2, 2]);
        if cells.iter().any(|count| count % 2 == 1) {
            section.fault(
                "cells",
                "must be even",
                "two by two cells are taken together",
            );
        }
        let recording = Self {
            cells,
            noise: section.quantity("noise", Dimension::Ratio, Bound::Positive),
            steps: section.count("steps", 20, 10_000),
            instants: section.count("instants", 5, 1000),
            seeds: section.count("seeds", 2, 1000) as u64,
        };
        section.unknown_keys();
        recording
    }
}

/// The data decide to this part; a smaller further move is left undone.
const SMOOTHING: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-8,
    movement: 1e-4,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// Noise before and after, over the seeds; the finite elements' motion is the truth, the springs' the first guess.
pub fn compute(
    settings: &Settings,
    progress: Progress,
    outcome: &mut Outcome,
) -> Result<(), Error> {
    let recording = &settings.recording;
    let plate = Plate {
        cells: recording.cells,
        ..settings.plate.clone()
    };
    let lattice = plate.lattice();
    let law = DashpotLaw::Material(settings.material.clone());
    let dashpots = Dashpots::new(&lattice, &law);
    let springs = settings.body(&lattice.model(&plate.problem), &lattice.mesh, &dashpots)?;
    let energy = corrected_energy(&plate.problem, &lattice);
    let sheet = SheetViscosity::new(&energy, &settings.material);
    let scheme = settings.body(
        &sheet_model(&plate.problem, &lattice.mesh, &energy),
        &lattice.mesh,
        &sheet,
    )?;
    let elements = FiniteElements::new(&plate.problem, settings.plate.cells, Element::Q2);
    let viscosity = SheetViscosity::new(elements.energy(), &settings.material);
    let reference = settings.body(&elements.model(&plate.problem), &elements.mesh, &viscosity)?;
    let step = Settings::period(&reference)? / recording.steps as f64;
    let run = |body: &Body, finer| integrate(body, step, recording.instants - 1, 1, finer);
    let exact = run(&reference, 8)?;
    let exact: Vec<Vec<f64>> = exact
        .iter()
        .map(|field| reference.mesh.displacement_on(field, &lattice.mesh))
        .collect();
    let guess = run(&springs, 8)?;
    let equation = EquationOfMotion::new(&scheme.motion, step, 0.25)
        .map_err(|reason| Error::input(reason.to_string(), "change the motion"))?;
    progress("seeds");
    let one = |seed: u64| -> Result<[f64; 2], Error> {
        let data = disturbed(&exact, &scheme, recording.noise, seed);
        let found = equation
            .smooth(&data, &guess, recording.instants, SMOOTHING)
            .map_err(Settings::fault)?;
        Ok([percent(&data, &exact), percent(&found, &exact)])
    };
    let errors: Vec<[f64; 2]> = (1..=recording.seeds)
        .into_par_iter()
        .map(one)
        .collect::<Result<_, _>>()?;
    let mean =
        |which: usize| errors.iter().map(|error| error[which]).sum::<f64>() / errors.len() as f64;
    let (before, after) = (mean(0), mean(1));
    let removed = |[before, after]: &[f64; 2]| 100.0 * (1.0 - after / before);
    let worst = errors.iter().map(removed).fold(f64::INFINITY, f64::min);
    let what = format!(
        "recorded motion of {} instants: noise removed, worst of {} seeds",
        recording.instants, recording.seeds
    );
    outcome.checks.push(Check::new(
        what,
        "%",
        Wanted::AtLeast(50.0),
        "√(2/n) of white noise would be left",
        worst,
    ));
    let head = [
        "recorded motion",
        "deviation from the finite elements, mean [%]",
    ];
    outcome.blocks.push(Block::table(
        &head,
        [
            vec![
                "springs, the first guess".into(),
                number(percent(&guess, &exact)),
            ],
            vec![
                format!("with {} % noise", limit(100.0 * recording.noise)),
                number(before),
            ],
            vec!["corrected, start unknown".into(), number(after)],
        ],
    ));
    Ok(())
}

/// White noise on every unknown that is not held, over the root mean square of all.
fn disturbed(exact: &[Vec<f64>], body: &Body, noise: f64, seed: u64) -> Vec<Vec<f64>> {
    let all = exact.concat();
    let size = noise * (all.iter().map(|u| u * u).sum::<f64>() / all.len() as f64).sqrt();
    let held = body.motion.held(0.0);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = |u: &f64, held: bool| -> f64 {
        let normal: f64 = StandardNormal.sample(&mut random);
        if held { *u } else { u + size * normal }
    };
    exact
        .iter()
        .map(|field| {
            field
                .iter()
                .zip(&held)
                .map(|(u, held)| draw(u, *held))
                .collect()
        })
        .collect()
}
