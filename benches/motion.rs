//! The time of an implicit step of a plate in motion, by springs and by finite elements, compared with the 9.0 ms that SOFA
//! states for 4,000 nodes on one CPU.
//!
//! ```text
//! cargo bench --bench motion
//! ```
//!
//! A plate of 150 × 50 × 2 mm of 10 % PVA hydrogel (`pva-10`), stretched by 10 %, is shaken by its right grip by ±5 % once
//! a second and swings under gravity; generalised-α with ρ∞ = 0.5 keeps the factor of its tangent as long as it converges
//! quickly. Sixty frames a second are one step each; a frame is interactive when it takes less than its sixtieth.

use std::cell::RefCell;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use gelbench::dynamics::{
    Integrator, Motion, MovingForce, MovingSupport, Start, TimeFunction, TimeSettings, follow,
    lumped_mass,
};
use gelbench::error::Error;
use gelbench::finite_element::{Element, FiniteElements};
use gelbench::mass_spring::{LatticeSettings, MassSpring};
use gelbench::material::Card;
use gelbench::mesh::Side;
use gelbench::problem::{ClampedPlate, Model};
use gelbench::solve::NewtonSettings;
use gelbench_mechanics::dynamics::Step;

/// SOFA's time of an implicit step over its nodes, in ms.
const SOFA: f64 = 9.0 / 4000.0;
const STRETCH: f64 = 0.1;
const FRAMES: usize = 120;
/// Cells along and across: about 1,000, 4,000 and 10,000 nodes.
const GRIDS: [[usize; 2]; 3] = [[54, 18], [108, 36], [172, 57]];

fn main() -> ExitCode {
    match bench() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn bench() -> Result<(), Error> {
    let problem = ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law: Card::load("pva-10", Path::new("."))?.law,
        stretches: vec![STRETCH],
    };
    println!(
        "{:<32} {:>6} {:>9} {:>10} {:>10} {:>8} {:>8} {:>9} {:>9}",
        "model",
        "nodes",
        "tolerance",
        "median ms",
        "worst ms",
        "steps",
        "factors",
        "SOFA ms",
        "gain"
    );
    for cells in GRIDS {
        let springs = MassSpring::new(&problem, cells, LatticeSettings { area_term: false });
        let elements = FiniteElements::new(&problem, cells, Element::Q1);
        for tolerance in [1e-2, 1e-4] {
            for model in [springs.model(&problem), elements.model(&problem)] {
                measure(&problem, &model, tolerance)?;
            }
        }
    }
    Ok(())
}

fn unknowns(model: &Model, side: Side) -> Vec<usize> {
    let nodes = (0..model.mesh.nodes.len()).filter(|node| model.mesh.on(side, *node));
    nodes.flat_map(|node| [2 * node, 2 * node + 1]).collect()
}

/// Prints the time of a frame.
fn measure(problem: &ClampedPlate, model: &Model, tolerance: f64) -> Result<(), Error> {
    let newton = NewtonSettings {
        tolerance: 1e-10,
        max_iterations: 40,
    };
    let start = model.reach(&problem.stretches, newton)?;
    let mass = lumped_mass(model.mesh, 1.02e-9, problem.thickness);
    let right = unknowns(model, Side::Right);
    let weight = (0..mass.len()).map(|i| if i % 2 == 1 { -9810.0 * mass[i] } else { 0.0 });
    let motion = Motion {
        energy: model.energy,
        viscosity: None,
        supports: vec![
            MovingSupport::fixed(unknowns(model, Side::Left)),
            MovingSupport {
                displacement: right
                    .iter()
                    .map(|unknown| {
                        if unknown % 2 == 0 {
                            problem.size[0]
                        } else {
                            0.0
                        }
                    })
                    .collect(),
                unknowns: right,
                time: TimeFunction::Sine {
                    mean: STRETCH,
                    amplitude: 0.05,
                    frequency: 1.0,
                },
                until: None,
            },
        ],
        forces: vec![MovingForce {
            force: weight.collect(),
            time: TimeFunction::Constant(1.0),
        }],
        start: Start::held_at(start.displacement),
        describe: Box::new(|element| (model.describe)(element)),
        mass,
    };
    let frame = 1.0 / 60.0;
    let settings = TimeSettings {
        duration: FRAMES as f64 * frame,
        interval: frame,
        step: Step::AtMost(frame),
        integrator: Integrator::GeneralisedAlpha {
            spectral_radius: 0.5,
            tolerance,
        },
        most_steps: gelbench::budget::Budget::USUAL.steps,
    };
    let clock = RefCell::new(vec![Instant::now()]);
    let record = |_| clock.borrow_mut().push(Instant::now());
    let history = follow(&motion, settings, &record).map_err(|end| Error::Solve {
        model: model.name.clone(),
        step: end.describe(),
        fault: end.fault,
    })?;
    // The first frames analyse the pattern and factorise the first tangents.
    let clock = clock.into_inner();
    let pairs = clock.windows(2).skip(4);
    let mut times: Vec<f64> = pairs
        .map(|pair| 1e3 * (pair[1] - pair[0]).as_secs_f64())
        .collect();
    times.sort_by(f64::total_cmp);
    let nodes = model.mesh.nodes.len();
    let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
    let sofa = SOFA * nodes as f64;
    println!(
        "{:<32} {nodes:>6} {tolerance:>9.0e} {median:>10.2} {worst:>10.2} {:>8} {:>8} {sofa:>9.1} {:>8.1}×",
        model.name,
        history.steps,
        history.factorisations,
        sofa / median
    );
    Ok(())
}
