//! Motion in time against closed forms.

use std::f64::consts::TAU;
use std::path::Path;

use crate::document::{Bound, Section};
use crate::dynamics::spring::Spring;
use crate::dynamics::{Motion, MovingSupport, SheetViscosity, Start, TimeFunction};
use crate::error::Error;
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::material::viscosity::{Relaxation, ViscousMaterial};
use crate::problem::Measures;
use crate::validation::case::{Check, Computation, Outcome, Progress, check, largest, section};
use crate::validation::plate::NEWTON;
use motion::{METHODS, NEWMARK, Run, clamped, problem, unknowns_of};

mod frequency;
mod motion;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| {
        let cells = mesh.multiples("cells", Bound::Within(3.0, 96.0), f64::INFINITY);
        let complete = |cells: &f64| cells.fract() == 0.0 && (*cells as usize).is_multiple_of(3);
        let doubled = cells.windows(2).all(|pair| pair[1] == 2.0 * pair[0]);
        if cells.len() < 3 || !cells.iter().all(complete) || !doubled {
            mesh.fault(
                "cells",
                "must be three or more numbers, each twice the previous one and a multiple of 3",
                "such as [6, 12, 24]",
            );
        }
        cells
    });
    let cells: Vec<usize> = cells.into_iter().map(|cells| cells as usize).collect();
    Box::new(move |progress| compute(&cells, progress))
}

fn compute(cells: &[usize], progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    progress.tell("spring");
    outcome.checks.extend(spring_checks()?);
    progress.tell("energy");
    outcome.checks.extend(energy()?);
    progress.tell("frequency");
    frequency::compare(cells, &mut outcome)?;
    progress.tell("relaxation");
    outcome.checks.push(relaxation()?);
    Ok(outcome)
}

/// A linear spring: ω = √(k/m) = 2 rad/s, and the order of its error in the step, by both methods.
fn spring_checks() -> Result<Vec<Check>, Error> {
    let exact = 2.0 / TAU;
    let spring = Spring {
        k: 4.0,
        q: 0.0,
        c: 0.0,
    };
    let motion = Motion {
        energy: &spring,
        viscosity: None,
        mass: vec![1.0],
        supports: Vec::new(),
        forces: Vec::new(),
        start: Start::held_at(vec![1.0]),
        describe: Box::new(|_| "the spring".into()),
    };
    let mut checks = Vec::new();
    for (name, integrator) in METHODS {
        let error = |steps: usize| {
            let run = Run {
                integrator,
                step: 1.0 / (exact * steps as f64),
                count: 10 * steps + steps / 4,
                every: 1,
            };
            Ok::<f64, Error>((run.frequency(&motion, 0)? / exact - 1.0).abs())
        };
        let [coarse, fine, finest] = [error(100)?, error(200)?, error(4000)?];
        let what = "frequency of a linear spring, 4000 steps in a period, relative error";
        let order = (coarse / fine).log2();
        checks.extend([
            check(format!("{name}: {what}"), "–", finest).at_most(1e-6, "√(k/m)"),
            check(
                format!("{name}: order of that error in the step"),
                "–",
                order,
            )
            .equal(2.0, 2.0, "both methods are of second order"),
        ]);
    }
    Ok(checks)
}

/// The energy of both models over 10⁴ steps after the release from 30 %.
fn energy() -> Result<Vec<Check>, Error> {
    const STEPS: usize = 10_000;
    let problem = problem(vec![0.3]);
    let springs = MassSpring::new(&problem, [15, 5], LatticeSettings { area_term: false });
    let elements = FiniteElements::new(&problem, [9, 3], Element::Q2);
    let models = [
        ("springs", springs.model(&problem)),
        ("finite elements", elements.model(&problem)),
    ];
    let mut checks = Vec::new();
    for (name, model) in models {
        let start = model.reach(&problem.stretches, NEWTON)?;
        let motion = clamped(&model, start.displacement);
        for (method, integrator) in METHODS {
            let run = Run {
                integrator,
                step: 1e-5,
                count: STEPS,
                every: 100,
            };
            let error = run.history(&motion)?.energy_error();
            let what =
                format!("{name}, {method}: largest error of the energy in {STEPS} steps, relative");
            checks.push(check(what, "–", error).at_most(1e-4, "energy is conserved"));
        }
    }
    Ok(checks)
}

/// The force of a plate that is stretched at once by 30 % and held.
fn relaxation() -> Result<Check, Error> {
    let (share, time) = (0.3, 2.0);
    let material = ViscousMaterial {
        relaxation: vec![Relaxation { share, time }],
        ..ViscousMaterial::default()
    };
    let problem = problem(vec![0.3]);
    let elements = FiniteElements::new(&problem, [9, 3], Element::Q2);
    let model = elements.model(&problem);
    let held = model.reach(&problem.stretches, NEWTON)?;
    let sheet = SheetViscosity::new(elements.energy(), &material);
    let right = unknowns_of(model.mesh, "right");
    let mut motion = clamped(&model, held.displacement.clone());
    motion.viscosity = Some(&sheet);
    motion.supports.push(MovingSupport {
        displacement: right
            .iter()
            .map(|unknown| held.displacement[*unknown])
            .collect(),
        unknowns: right,
        time: TimeFunction::Constant(1.0),
        until: None,
    });
    motion.start.relaxed = false;
    let run = Run {
        integrator: NEWMARK,
        step: 0.2,
        count: 40,
        every: 1,
    };
    let force = Measures::of(model.mesh, &held).force;
    let history = run.history(&motion)?;
    let errors = history.instants.iter().map(|now| {
        let beta = share / (1.0 - share);
        let expected = force * (1.0 + beta * (-now.time / time).exp());
        now.support_forces[1][0] / expected - 1.0
    });
    let what = "relaxation of a one-term Prony series over four relaxation times: largest relative error of the force";
    Ok(check(what, "–", largest(errors)).at_most(1e-6, "F∞ (1 + g/(1 − g) e^(−t/τ))"))
}
