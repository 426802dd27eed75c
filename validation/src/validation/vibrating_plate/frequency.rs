//! The first longitudinal vibration of a plate.
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

use super::motion::{
    DENSITY, Run, SIZE, THICKNESS, VERLET, clamped, fault, law, problem, unknowns_of,
};
use crate::dynamics::MovingSupport;
use crate::dynamics::frequency::{Mode, slowest, strongest};
use crate::error::Error;
use crate::finite_element::convergence::{Richardson, richardson};
use crate::finite_element::{Element, FiniteElements};
use crate::mesh::Mesh;
use crate::problem::{BoundaryProblem, Load, Model};
use crate::solve::Newton;
use crate::validation::case::{Block, Check, Outcome, check, largest, number, table};

/// The first longitudinal vibration about the undeformed plate, and how long a rod as stiff as the plate is.
struct Longitudinal {
    mode: Mode,
    /// In mm.
    length: f64,
}

impl Longitudinal {
    /// By inverse iteration, with `supports` held.
    fn new(model: &Model, supports: Vec<usize>) -> Result<Self, Error> {
        let mut motion = clamped(model, vec![0.0; model.energy.unknowns()]);
        motion.supports = vec![MovingSupport::fixed(supports)];
        let held = motion.held(0.0);
        let rest = vec![0.0; held.len()];
        let modes = slowest(&motion, &held, &rest, 6).map_err(|actual| fault("rest", actual))?;
        Ok(Self {
            mode: strongest(modes, &motion.mass, 0).expect("six modes"),
            length: equivalent_length(model, &held)?,
        })
    }

    /// Frequency over that of a rod of some length.
    fn over_rod(&self, length: f64) -> f64 {
        self.mode.frequency / rod(length)
    }
}

/// The length in mm of the rod that a traction stretches as much as the plate: L' = E ū/σ.
fn equivalent_length(model: &Model, held: &[bool]) -> Result<f64, Error> {
    let traction = 1.0;
    let problem = BoundaryProblem {
        loads: vec![("right".into(), Load::Traction([traction, 0.0]))],
        ..BoundaryProblem::supported(THICKNESS, law(), Vec::new())
    };
    let forces = problem.dead_forces(model.mesh)?;
    let rest = vec![0.0; held.len()];
    let field = Newton::new(model.energy, held).and_then(|mut newton| {
        let describe = |_| String::new();
        newton
            .tangent
            .respond(model.energy, &rest, &forces, &describe)
    });
    let field = field.map_err(|actual| fault("rest", actual))?;
    // The displacement that the load works on.
    let work: f64 = field.iter().zip(&forces).map(|(u, f)| u * f).sum();
    let mean = work / (traction * SIZE[1] * THICKNESS);
    Ok(law().youngs_modulus() * mean / traction)
}

/// √(E/ρ)/(4 L) of a rod in Hz.
fn rod(length: f64) -> f64 {
    (law().youngs_modulus() / DENSITY).sqrt() / (4.0 * length)
}

/// Share by which lateral inertia lowers the frequency: ν² (π/2 L)² (W² + t²)/24, ν = ½.
fn lateral_inertia() -> f64 {
    let wave = TAU / (4.0 * SIZE[0]);
    0.25 * wave * wave * (SIZE[1].powi(2) + THICKNESS.powi(2)) / 24.0
}

/// The plate on one mesh.
struct Plate {
    /// Cells along it.
    along: usize,
    clamped: Longitudinal,
    /// Free to contract at its support.
    free: Longitudinal,
}

impl Plate {
    fn new(along: usize) -> Result<Self, Error> {
        let rest = problem(Vec::new());
        let elements = FiniteElements::new(&rest, [along, along / 3], Element::Q2);
        let model = elements.model(&rest);
        Ok(Self {
            along,
            clamped: Longitudinal::new(&model, unknowns_of(model.mesh, "left"))?,
            free: Longitudinal::new(&model, rollers(model.mesh))?,
        })
    }

    fn row(&self) -> Vec<String> {
        let Self { clamped, free, .. } = self;
        let numbers = [
            clamped.mode.frequency,
            clamped.over_rod(clamped.length),
            free.mode.frequency,
            free.over_rod(SIZE[0]),
        ];
        let numbers = numbers.map(|value| format!("{value:.5}"));
        [self.along.to_string()]
            .into_iter()
            .chain(numbers)
            .collect()
    }
}

/// The unknowns of the left side along X, and one across at the axis of symmetry, where no force is needed.
fn rollers(mesh: &Mesh) -> Vec<usize> {
    let side = &mesh.groups()["left"].nodes;
    let middle = side[side.len() / 2];
    let along = side.iter().map(|node| 2 * node);
    along.chain([2 * middle + 1]).collect()
}

/// The plate on three meshes and more, each twice as fine as the one before.
pub fn compare(cells: &[usize], outcome: &mut Outcome) -> Result<(), Error> {
    let plates: Result<Vec<Plate>, Error> = cells.iter().map(|along| Plate::new(*along)).collect();
    let plates = plates?;
    let [.., coarse, middle, fine] = &plates[..] else {
        return Ok(());
    };
    let meshes = [coarse, middle, fine];
    let converged = richardson(meshes.map(|plate| plate.clamped.mode.frequency));
    let head = "Q2 cells along | clamped [Hz] | over a rod of length L' [–] | free to contract [Hz] | over a rod of length L [–]";
    let rows = plates.iter().map(Plate::row);
    outcome
        .blocks
        .extend([explanation(&converged, fine), table(head, rows)]);
    outcome.checks.extend(checks(&converged, fine));
    let what =
        "clamped plate: frequency from its motion over frequency by inverse iteration, same mesh";
    let expected = plates[0].clamped.mode.frequency;
    let actual = from_motion(plates[0].along, expected)?;
    let from_motion = check(what, "–", actual / expected);
    outcome
        .checks
        .push(from_motion.equal(1.0, 0.01, "inverse iteration"));
    Ok(())
}

fn explanation(converged: &Richardson, fine: &Plate) -> Block {
    let length = fine.clamped.length;
    Block::paragraph(format!(
        "First longitudinal vibration of a plate clamped at one end, at small strain, by inverse iteration: {} Hz by \
         Richardson extrapolation, with an observed order of {:.2} (the clamped corners are singular). A rod of the plate's \
         length has {} Hz; the plate is as stiff as a rod of length L' = {} mm, which has {} Hz.",
        number(converged.extrapolated),
        converged.order.unwrap_or(f64::NAN),
        number(rod(SIZE[0])),
        number(length),
        number(rod(length)),
    ))
}

fn checks(converged: &Richardson, fine: &Plate) -> [Check; 2] {
    let clamped =
        "clamped plate: first longitudinal frequency, converged, over that of a rod of length L'";
    let over_rod = converged.extrapolated / rod(fine.clamped.length);
    let free = "plate free to contract at its support: first longitudinal frequency over that of a rod of length L";
    let lowered = 1.0 - lateral_inertia();
    [
        check(clamped, "–", over_rod).equal(
            1.0,
            1.0,
            "√(E/ρ)/(4 L'), a rod as stiff as the clamped plate",
        ),
        check(free, "–", fine.free.over_rod(SIZE[0])).equal(
            lowered,
            0.05,
            "√(E/ρ)/(4 L) and Love § 278",
        ),
    ]
}

/// The frequency of the clamped plate that starts in its mode, from five periods of 4000 steps.
fn from_motion(along: usize, expected: f64) -> Result<f64, Error> {
    let rest = problem(Vec::new());
    let elements = FiniteElements::new(&rest, [along, along / 3], Element::Q2);
    let model = elements.model(&rest);
    let mode = Longitudinal::new(&model, unknowns_of(model.mesh, "left"))?.mode;
    let size = largest(mode.shape.iter().copied());
    let start = mode.shape.iter().map(|u| 1e-6 * SIZE[0] * u / size);
    let motion = clamped(&model, start.collect());
    // Verlet's own limit needs shorter steps than the period.
    let steps = 4000;
    let run = Run {
        integrator: VERLET,
        step: 1.0 / (expected * steps as f64),
        count: 5 * steps + steps / 4,
        every: 10,
    };
    run.frequency(&motion, 2 * model.mesh.groups()["right"].nodes[0])
}
