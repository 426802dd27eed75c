//! Motion in time against closed forms.
//!
//! ```text
//! f = √(E/ρ)/(4 L')                                                                       [Hz]
//! ```
//!
//! is the first longitudinal vibration of a rod that is clamped at one end. The clamp keeps the plate from becoming
//! narrower: in a static test it is stiffer than a rod of its length and as stiff as a shorter one, of the length L'. Its
//! lateral inertia lowers the frequency by ν² (π/2 L)² (W² + t²)/24, 0.29 % here.
//!
//! # References
//! A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity, 4th ed., Cambridge (1927), § 278

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

use crate::document::{Bound, Section};
use crate::dynamics::frequency::{Mode, slowest, strongest};
use crate::dynamics::{
    History, Integrator, Motion, MovingSupport, SheetViscosity, Start, Step, TimeFunction,
    TimeSettings, follow, lumped_mass,
};
use crate::error::{Error, SolveFault};
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::material::viscosity::{Relaxation, ViscousMaterial};
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::Mesh;
use crate::problem::{BoundaryProblem, Load};
use crate::problem::{ClampedPlate, Measures, Model};
use crate::results::Block;
use crate::solve::{Connectivity, Inadmissible, Local, Newton, Potential};
use crate::units::Dimension;
use crate::validation::case::{Check, Outcome, Prepared, Progress, Wanted, number};
use crate::validation::plate::NEWTON;

const SIZE: [f64; 2] = [150.0, 50.0];
const THICKNESS: f64 = 2.0;
/// In tonne/mm³.
const DENSITY: f64 = 1.02e-9;
const VERLET: Integrator = Integrator::VelocityVerlet;
const NEWMARK: Integrator = Integrator::GeneralisedAlpha {
    spectral_radius: 1.0,
    tolerance: 1e-11,
};

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let cells = section.quantities("cells", Dimension::Ratio, Bound::Within(3.0, 96.0));
    let whole = |cells: &f64| cells.fract() == 0.0 && (*cells as usize).is_multiple_of(3);
    let doubled = cells.windows(2).all(|pair| pair[1] == 2.0 * pair[0]);
    if cells.len() < 3 || !cells.iter().all(whole) || !doubled {
        section.fault(
            "cells",
            "must be three or more numbers, each twice the one before and a multiple of 3",
            "such as [6, 12, 24]",
        );
    }
    section.unknown_keys();
    let cells = cells
        .into_iter()
        .map(|cells| cells as usize)
        .collect::<Vec<_>>();
    Box::new(move |progress| compute(&cells, progress))
}

fn law() -> Arc<dyn HyperelasticLaw> {
    Arc::new(NeoHooke { c10: 0.05 })
}

fn problem(stretches: Vec<f64>) -> ClampedPlate {
    ClampedPlate {
        size: SIZE,
        thickness: THICKNESS,
        law: law(),
        stretches,
    }
}

fn compute(cells: &[usize], progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    progress("spring");
    spring(&mut outcome)?;
    progress("energy");
    energy(&mut outcome)?;
    progress("frequency");
    frequency(cells, &mut outcome)?;
    progress("relaxation");
    relaxation(&mut outcome)?;
    Ok(outcome)
}

fn fault(step: &str, fault: SolveFault) -> Error {
    Error::Solve {
        model: "motion".into(),
        step: step.to_owned(),
        fault,
    }
}

/// A motion in equal steps, all of them instants or every `every`th.
fn run(
    motion: &Motion,
    integrator: Integrator,
    step: f64,
    (count, every): (usize, usize),
) -> Result<History, Error> {
    let settings = TimeSettings {
        duration: count as f64 * step,
        interval: every as f64 * step,
        step: Step::AtMost(step * (1.0 + 1e-9)),
        integrator,
    };
    follow(motion, settings, &|_| ()).map_err(|end| fault(&end.describe(), end.fault))
}

/// Frequency in Hz from the first and the last rise of a series through zero, found by inverse interpolation with cubics.
fn measured_frequency(times: &[f64], values: &[f64]) -> f64 {
    let rises = (2..values.len() - 1).filter(|i| values[i - 1] < 0.0 && values[*i] >= 0.0);
    let crossings: Vec<f64> = rises
        .map(|i| {
            let (t, u) = (&times[i - 2..i + 2], &values[i - 2..i + 2]);
            let weight = |a: usize| -> f64 {
                let others = (0..4).filter(|b| *b != a);
                others.map(|b| -u[b] / (u[a] - u[b])).product()
            };
            (0..4).map(|a| t[a] * weight(a)).sum()
        })
        .collect();
    match crossings[..] {
        [first, .., last] => (crossings.len() - 1) as f64 / (last - first),
        _ => f64::NAN,
    }
}

/// One unknown with the energy ½ k u², k = 4 N/mm.
struct Spring;

impl Potential for Spring {
    fn connectivity(&self) -> &Connectivity {
        Connectivity::single()
    }

    fn evaluate_element(&self, _: usize, u: &[f64], local: Local<'_>) -> Result<f64, Inadmissible> {
        local.residual[0] = 4.0 * u[0];
        if let Some(stiffness) = local.stiffness {
            stiffness[0] = 4.0;
        }
        Ok(2.0 * u[0] * u[0])
    }
}

/// ω = √(k/m) = 2 rad/s, and the order of its error in the step.
fn spring(outcome: &mut Outcome) -> Result<(), Error> {
    let exact = 2.0 / TAU;
    let motion = Motion {
        energy: &Spring,
        viscosity: None,
        mass: vec![1.0],
        supports: Vec::new(),
        forces: Vec::new(),
        start: Start::held_at(vec![1.0]),
        describe: Box::new(|_| "the spring".into()),
    };
    for (name, integrator) in [("velocity Verlet", VERLET), ("generalised-α", NEWMARK)] {
        let error = |steps: usize| {
            let step = 1.0 / (exact * steps as f64);
            let history = run(&motion, integrator, step, (10 * steps + steps / 4, 1))?;
            let found = measured_frequency(&history.times(), &history.displacement(0));
            Ok::<f64, Error>((found / exact - 1.0).abs())
        };
        let [coarse, fine, finest] = [error(100)?, error(200)?, error(4000)?];
        outcome.checks.push(Check::new(
            format!("{name}: frequency of a linear spring, 4000 steps in a period, relative error"),
            "–",
            Wanted::AtMost(1e-6),
            "√(k/m)",
            finest,
        ));
        outcome.checks.push(Check::new(
            format!("{name}: order of that error in the step"),
            "–",
            Wanted::Equal(2.0, 2.0),
            "both methods are of second order",
            (coarse / fine).log2(),
        ));
    }
    Ok(())
}

/// A motion of a model without loads, clamped on the left.
fn clamped<'a>(model: &'a Model<'a>, start: Vec<f64>) -> Motion<'a> {
    Motion {
        energy: model.energy,
        viscosity: None,
        mass: lumped_mass(model.mesh, DENSITY, THICKNESS),
        supports: vec![MovingSupport::fixed(left(model.mesh))],
        forces: Vec::new(),
        start: Start::held_at(start),
        describe: Box::new(|element| (model.describe)(element)),
    }
}

/// The unknowns of the left side.
fn left(mesh: &Mesh) -> Vec<usize> {
    let nodes = mesh.groups()["left"].nodes.iter();
    nodes.flat_map(|node| [2 * node, 2 * node + 1]).collect()
}

/// The energy of both models over 10⁴ steps after the release from 30 %.
fn energy(outcome: &mut Outcome) -> Result<(), Error> {
    const STEPS: usize = 10_000;
    let problem = problem(vec![0.3]);
    let springs = MassSpring::new(&problem, [15, 5], LatticeSettings { area_term: false });
    let elements = FiniteElements::new(&problem, [9, 3], Element::Q2);
    let models = [
        ("springs", springs.model(&problem)),
        ("finite elements", elements.model(&problem)),
    ];
    for (name, model) in models {
        let start = model.reach(&problem.stretches, NEWTON)?;
        let motion = clamped(&model, start.displacement);
        for (method, integrator) in [("velocity Verlet", VERLET), ("generalised-α", NEWMARK)] {
            let history = run(&motion, integrator, 1e-5, (STEPS, 100))?;
            outcome.checks.push(Check::new(
                format!("{name}, {method}: largest error of the energy in {STEPS} steps, relative"),
                "–",
                Wanted::AtMost(1e-4),
                "energy is conserved",
                history.energy_error(),
            ));
        }
    }
    Ok(())
}

/// The first longitudinal vibration about the undeformed plate, and how long a rod as stiff as the plate is.
struct Longitudinal {
    mode: Mode,
    length: f64,
}

/// By inverse iteration; with `supports` held.
fn longitudinal(model: &Model, supports: Vec<usize>) -> Result<Longitudinal, Error> {
    let mut motion = clamped(model, vec![0.0; model.energy.unknowns()]);
    motion.supports = vec![MovingSupport::fixed(supports)];
    let held = motion.held(0.0);
    let rest = vec![0.0; held.len()];
    let modes = slowest(&motion, &held, &rest, 6).map_err(|found| fault("rest", found))?;
    let mode = strongest(modes, &motion.mass, 0).expect("six modes");
    let traction = 1.0;
    let problem = BoundaryProblem {
        thickness: THICKNESS,
        law: law(),
        supports: Vec::new(),
        loads: vec![("right".into(), Load::Traction([traction, 0.0]))],
    };
    let forces = problem.dead_forces(model.mesh);
    let forces = forces.map_err(|found| Error::Input(vec![found]))?;
    let respond = |newton: &mut Newton| {
        newton
            .tangent
            .respond(model.energy, &rest, &forces, &|_| String::new())
    };
    let field = Newton::new(model.energy, &held).and_then(|mut newton| respond(&mut newton));
    let field = field.map_err(|found| fault("rest", found))?;
    // The displacement that the load works on: L' = E ū/σ.
    let work: f64 = field.iter().zip(&forces).map(|(u, f)| u * f).sum();
    let mean = work / (traction * SIZE[1] * THICKNESS);
    Ok(Longitudinal {
        mode,
        length: law().youngs_modulus() * mean / traction,
    })
}

/// √(E/ρ)/(4 L) of a rod in Hz.
fn rod(length: f64) -> f64 {
    (law().youngs_modulus() / DENSITY).sqrt() / (4.0 * length)
}

/// Share by which lateral inertia lowers the frequency: ν² (π/2 L)² W²/24, ν = ½.
fn lateral_inertia() -> f64 {
    let wave = TAU / (4.0 * SIZE[0]);
    0.25 * wave * wave * (SIZE[1].powi(2) + THICKNESS.powi(2)) / 24.0
}

fn frequency(cells: &[usize], outcome: &mut Outcome) -> Result<(), Error> {
    let mut found = Vec::new();
    for along in cells {
        let rest = problem(Vec::new());
        let elements = FiniteElements::new(&rest, [*along, along / 3], Element::Q2);
        let (model, mesh) = (elements.model(&rest), &elements.mesh);
        let clamped = longitudinal(&model, left(mesh))?;
        let side = &mesh.groups()["left"].nodes;
        // Held across at its axis of symmetry, where no force is needed.
        let middle = side[side.len() / 2];
        let rollers = side.iter().map(|node| 2 * node);
        let free = longitudinal(&model, rollers.chain([2 * middle + 1]).collect())?;
        found.push((*along, clamped, free));
    }
    let frequencies: Vec<f64> = found.iter().map(|(_, own, _)| own.mode.frequency).collect();
    let [.., coarse, middle, fine] = frequencies[..] else {
        return Ok(());
    };
    let ratio = (middle - coarse) / (fine - middle);
    let converged = fine + (fine - middle) / (ratio - 1.0);
    let (_, clamped, free) = &found[found.len() - 1];
    outcome.blocks.push(Block::Paragraph(format!(
        "First longitudinal vibration of a plate that is clamped at one end, at small strain, by inverse iteration: {} Hz \
         after Richardson, with an observed order of {:.2} (the clamped corners are singular). A rod of the plate's length \
         has {} Hz; the plate is as stiff as a rod of L' = {} mm, which has {} Hz.",
        number(converged),
        ratio.log2(),
        number(rod(SIZE[0])),
        number(clamped.length),
        number(rod(clamped.length)),
    )));
    let head = [
        "Q2 cells along",
        "clamped [Hz]",
        "over a rod of L' [–]",
        "free to contract [Hz]",
        "over a rod of L [–]",
    ];
    let rows = found.iter().map(|(along, clamped, free)| {
        let ratio = |own: &Longitudinal, length| own.mode.frequency / rod(length);
        vec![
            along.to_string(),
            format!("{:.5}", clamped.mode.frequency),
            format!("{:.5}", ratio(clamped, clamped.length)),
            format!("{:.5}", free.mode.frequency),
            format!("{:.5}", ratio(free, SIZE[0])),
        ]
    });
    outcome.blocks.push(Block::table(&head, rows));
    let mut check = |quantity: &str, wanted, source, value| {
        outcome
            .checks
            .push(Check::new(quantity, "–", wanted, source, value));
    };
    check(
        "clamped plate: first longitudinal frequency, converged, over that of a rod of L'",
        Wanted::Equal(1.0, 1.0),
        "√(E/ρ)/(4 L'), a rod as stiff as the clamped plate",
        converged / rod(clamped.length),
    );
    check(
        "plate free to contract at its support: first longitudinal frequency over that of a rod of L",
        Wanted::Equal(1.0 - lateral_inertia(), 0.05),
        "√(E/ρ)/(4 L) and Love § 278",
        free.mode.frequency / rod(SIZE[0]),
    );
    check(
        "clamped plate: frequency from its motion over that of inverse iteration, on the same mesh",
        Wanted::Equal(1.0, 0.01),
        "inverse iteration",
        from_motion(cells[0], frequencies[0])? / frequencies[0],
    );
    Ok(())
}

/// The frequency of the clamped plate that starts in its mode, from five periods of 400 steps, less the error of
/// the step (ω h)²/24.
fn from_motion(along: usize, expected: f64) -> Result<f64, Error> {
    let rest = problem(Vec::new());
    let elements = FiniteElements::new(&rest, [along, along / 3], Element::Q2);
    let model = elements.model(&rest);
    let mode = longitudinal(&model, left(model.mesh))?.mode;
    let largest = mode.shape.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let start = mode.shape.iter().map(|u| 1e-6 * SIZE[0] * u / largest);
    let motion = clamped(&model, start.collect());
    // Verlet's own limit needs shorter steps than the period.
    let steps = 4000;
    let step = 1.0 / (expected * steps as f64);
    let history = run(&motion, VERLET, step, (5 * steps + steps / 4, 10))?;
    let end = model.mesh.groups()["right"].nodes[0];
    let found = measured_frequency(&history.times(), &history.displacement(2 * end));
    Ok(found)
}

/// The force of a plate that is stretched at once by 30 % and held.
fn relaxation(outcome: &mut Outcome) -> Result<(), Error> {
    let (share, time) = (0.3, 2.0);
    let material = ViscousMaterial {
        shear_viscosity: 0.0,
        relaxation: vec![Relaxation { share, time }],
    };
    let problem = problem(vec![0.3]);
    let elements = FiniteElements::new(&problem, [9, 3], Element::Q2);
    let model = elements.model(&problem);
    let solution = model.reach(&problem.stretches, NEWTON)?;
    let sheet = SheetViscosity::new(elements.energy(), &material);
    let right = model.mesh.groups()["right"].nodes.iter();
    let right: Vec<usize> = right.flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let grip = MovingSupport {
        displacement: right
            .iter()
            .map(|unknown| solution.displacement[*unknown])
            .collect(),
        unknowns: right,
        time: TimeFunction::Constant(1.0),
        until: None,
    };
    let mut motion = clamped(&model, solution.displacement.clone());
    motion.viscosity = Some(&sheet);
    motion.supports.push(grip);
    motion.start.relaxed = false;
    let history = run(&motion, NEWMARK, 0.2, (40, 1))?;
    let errors = history.instants.iter().map(|now| {
        let beta = share / (1.0 - share);
        let expected =
            Measures::of(model.mesh, &solution).force * (1.0 + beta * (-now.time / time).exp());
        (now.support_forces[1][0] / expected - 1.0).abs()
    });
    outcome.checks.push(Check::new(
        "relaxation of a one-term Prony series over four relaxation times: largest relative error of the force",
        "–",
        Wanted::AtMost(1e-6),
        "F∞ (1 + g/(1 − g) e^(−t/τ))",
        errors.fold(0.0, f64::max),
    ));
    Ok(())
}
