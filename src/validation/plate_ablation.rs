//! Example 1, Part II: what the plate's correction depends on.
//!
//! Which known conditions T are imposed decides; the springs, their topology and the start do not.

use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::{Check, Claim, Outcome, Prepared, Progress, Wanted, number};
use super::plate::{NEWTON, Plate};
use crate::compare::{departure_percent, displacement_percent};
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::mass_spring::{MassSpring, Spring};
use crate::results::{Axis, Block, Line, LineChart, Stroke};
use crate::solve::Newton;
use crate::units::Dimension;

mod springs_or_affine;

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Prepared {
    let plate = Plate::read(root, folder);
    let section = root.section("springs");
    let disturbance = section.quantity("disturbance", Dimension::Ratio, Bound::Within(0.0, 0.95));
    let seed = section.count("seed", 0, usize::MAX) as u64;
    section.unknown_keys();
    Box::new(move |progress| compute(&plate, disturbance, seed, progress))
}

/// The fields that everything is compared with.
struct Fields {
    lattice: MassSpring,
    uncorrected: Vec<f64>,
    reference: Vec<f64>,
    affine: Vec<f64>,
    corrected: CorrectedState,
}

impl Fields {
    /// Departure from affine in relative L2, in %.
    fn departure(&self, field: &[f64]) -> f64 {
        departure_percent(&self.lattice.mesh, field, &self.reference, &self.affine)
    }

    /// Displacement in relative L2, in %.
    fn displacement(&self, field: &[f64]) -> f64 {
        displacement_percent(&self.lattice.mesh, field, &self.reference)
    }

    /// Distance to the corrected field in relative L2.
    fn far(&self, field: &[f64]) -> f64 {
        displacement_percent(
            &self.lattice.mesh,
            field,
            &self.corrected.state.displacement,
        ) / 100.0
    }
}

fn compute(
    plate: &Plate,
    disturbance: f64,
    seed: u64,
    progress: Progress,
) -> Result<Outcome, Error> {
    progress("reference");
    let lattice = plate.lattice();
    let uncorrected = plate.solve(&lattice)?.displacement;
    let fields = Fields {
        reference: plate.reference(&lattice)?,
        affine: plate.problem.affine(&lattice.mesh, plate.stretch()),
        corrected: plate.corrected(&lattice, &uncorrected)?,
        uncorrected,
        lattice,
    };
    let mut outcome = Outcome::default();
    known_conditions(plate, &fields, progress, &mut outcome)?;
    springs_or_affine::side_by_side(plate, &fields, &mut outcome)?;
    other_lattices(plate, &fields, disturbance, seed, progress, &mut outcome)?;
    plain_newton(plate, &fields, &mut outcome)?;
    Ok(outcome)
}

const ABLATIONS: [(&str, KnownConditions); 4] = [
    (
        "none",
        KnownConditions {
            grips: false,
            free_edges: false,
        },
    ),
    (
        "grips",
        KnownConditions {
            grips: true,
            free_edges: false,
        },
    ),
    (
        "traction-free edges",
        KnownConditions {
            grips: false,
            free_edges: true,
        },
    ),
    ("grips and traction-free edges", KnownConditions::ALL),
];

fn known_conditions(
    plate: &Plate,
    fields: &Fields,
    progress: Progress,
    outcome: &mut Outcome,
) -> Result<(), Error> {
    let corrector = plate.corrector(&fields.lattice);
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    let before = fields.departure(&fields.uncorrected);
    let mut last = before;
    let colours = [[150, 150, 150], [213, 94, 0], [0, 158, 115], [0, 114, 178]];
    for ((name, known), colour) in ABLATIONS.into_iter().zip(colours) {
        progress(&format!("known: {name}"));
        let corrected = corrector.correct(&fields.uncorrected, plate.stretch(), known)?;
        let steps = &corrected.steps;
        let departures: Vec<f64> = steps
            .iter()
            .map(|step| fields.departure(&step.field))
            .collect();
        last = departures[departures.len() - 1];
        let at = |step: usize| {
            departures
                .get(step)
                .map_or("–".into(), |value| number(*value))
        };
        let displacement = fields.displacement(&corrected.state.displacement);
        rows.push(vec![
            name.to_owned(),
            number(before),
            at(1),
            at(2),
            number(last),
            number(displacement),
            (steps.len() - 1).to_string(),
        ]);
        lines.push(Line {
            label: name.to_owned(),
            points: departures
                .iter()
                .enumerate()
                .map(|(step, value)| [step as f64, *value])
                .collect(),
            colour,
            // Two of the lines lie on each other.
            stroke: if name == "grips" {
                Stroke::Dashed
            } else {
                Stroke::Marked
            },
        });
        if known == KnownConditions::ALL {
            outcome.checks.extend([
                Check::new(
                    "corrected displacement beside converged finite elements",
                    "%",
                    Wanted::AtMost(0.1),
                    "publication: below 5 %",
                    displacement,
                ),
                Check::new(
                    "corrected departure from affine",
                    "%",
                    Wanted::AtMost(1.0),
                    "design of the corrector",
                    last,
                ),
            ]);
        }
        if name == "grips" {
            let left = 100.0 * last / before;
            outcome.checks.push(Check::new(
                "departure left over without the traction-free edges",
                "%",
                Wanted::AtLeast(50.0),
                "T decides",
                left,
            ));
        }
    }
    let head = [
        "known conditions T",
        "before [%]",
        "after one step [%]",
        "after two [%]",
        "at the end [%]",
        "displacement at the end [%]",
        "steps",
    ];
    outcome.blocks.push(Block::Paragraph("Departure from affine, relative L2 distance to the converged finite elements, for the known conditions T that are imposed beside equilibrium inside:".into()));
    outcome.blocks.push(Block::table(&head, rows));
    outcome.claims.push(Claim {
        claim: "Example 1, Part II: the corrected plate is within 5 % of non-linear finite elements",
        reproduced: format!("departure from affine {} % before, {} % after; displacement within {} %", number(before), number(last), number(fields.displacement(&fields.corrected.state.displacement))),
    });
    let chart = LineChart {
        title: "What is known decides".into(),
        x: Axis::linear("step"),
        y: Axis::logarithmic("departure from affine, relative L2 [%]"),
        lines,
        band: None,
    };
    outcome.figures.push(super::case::figure(
        "plate_ablation.png",
        "Deviation of each iterate for the known conditions T that are imposed.",
        &chart,
    ));
    Ok(())
}

fn other_lattices(
    plate: &Plate,
    fields: &Fields,
    disturbance: f64,
    seed: u64,
    progress: Progress,
    outcome: &mut Outcome,
) -> Result<(), Error> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut wrong = move |spring: &Spring| {
        spring.area * random.random_range(1.0 - disturbance..=1.0 + disturbance)
    };
    let mesh = &fields.lattice.mesh;
    let step = mesh.cell_size();
    // Rising or falling diagonals, and the parity of their cell.
    let slope = |spring: &Spring| {
        let [from, to] = spring.nodes.map(|node| mesh.nodes[node]);
        (to[0] - from[0]) * (to[1] - from[1])
    };
    let even = |spring: &Spring| {
        let [from, to] = spring.nodes.map(|node| mesh.nodes[node]);
        let cell = [0, 1].map(|axis| (0.5 * (from[axis] + to[axis]) / step[axis]) as usize);
        (cell[0] + cell[1]) % 2 == 0
    };
    let scaled = |spring: &Spring, factor: f64| factor * spring.area;
    type Areas<'a> = Box<dyn FnMut(&Spring) -> f64 + 'a>;
    let lattices: Vec<(&str, Areas)> = vec![
        (
            "cross-sections changed at random",
            Box::new(move |spring| wrong(spring)),
        ),
        (
            "no diagonals",
            Box::new(move |spring| scaled(spring, if slope(spring) == 0.0 { 1.0 } else { 0.0 })),
        ),
        (
            "one diagonal",
            Box::new(move |spring| match slope(spring) {
                0.0 => spring.area,
                slope if slope > 0.0 => 2.0 * spring.area,
                _ => 0.0,
            }),
        ),
        (
            "triangulated",
            Box::new(move |spring| match slope(spring) {
                0.0 => spring.area,
                slope if (slope > 0.0) == even(spring) => 2.0 * spring.area,
                _ => 0.0,
            }),
        ),
    ];
    let corrector = plate.corrector(&fields.lattice);
    let mut rows = Vec::new();
    let mut worst = 0.0_f64;
    for (name, areas) in lattices {
        progress(name);
        let lattice = plate.lattice().with_areas(&plate.problem, areas);
        let field = plate.solve(&lattice)?;
        let corrected =
            corrector.correct(&field.displacement, plate.stretch(), KnownConditions::ALL)?;
        let steps = &corrected.steps;
        let far = fields.far(&corrected.state.displacement);
        worst = worst.max(far);
        rows.push(vec![
            name.to_owned(),
            number(fields.departure(&field.displacement)),
            number(fields.departure(&steps[1].field)),
            number(fields.departure(&steps[2.min(steps.len() - 1)].field)),
            number(fields.departure(&corrected.state.displacement)),
            (steps.len() - 1).to_string(),
        ]);
    }
    let head = [
        "lattice",
        "before [%]",
        "after one step [%]",
        "after two [%]",
        "at the end [%]",
        "steps",
    ];
    outcome.blocks.push(Block::Paragraph(
        "The same correction from wrong springs and from other topologies, departure from affine:"
            .into(),
    ));
    outcome.blocks.push(Block::table(&head, rows));
    outcome.checks.push(Check::new(
        "corrected fields of all lattices beside each other, relative L2",
        "–",
        Wanted::AtMost(1e-6),
        "publication: independent of topology and spring constants",
        worst,
    ));
    outcome.claims.push(Claim {
        claim: "Corrections are independent of the system's topology and spring constants",
        reproduced: format!(
            "springs changed by up to {} %, three other topologies: the same field to {}",
            number(100.0 * disturbance),
            number(worst)
        ),
    });
    Ok(())
}

/// Newton's method on the corrector's own equations from the affine stretch: the honest opponent.
fn plain_newton(plate: &Plate, fields: &Fields, outcome: &mut Outcome) -> Result<(), Error> {
    let corrector = plate.corrector(&fields.lattice);
    let potential = corrector.energy();
    let held = plate.problem.held(&fields.lattice.mesh);
    let mut field = fields.affine.clone();
    let mut residual = vec![0.0; field.len()];
    let names = corrector.names();
    let log = Newton::new(potential, &held)
        .and_then(|mut newton| {
            newton.solve(potential, &mut field, &mut residual, NEWTON, &|cell| {
                names.element(cell)
            })
        })
        .map_err(|fault| plate.fault(fault))?;
    let steps = fields.corrected.steps.len() - 1;
    outcome.blocks.push(Block::Paragraph(format!(
        "With all of T imposed there are as many conditions as unknowns and each step is a Newton step. From the \
         mass-spring field it takes {steps} steps; plain Newton on the same equations from the affine stretch takes {}.",
        log.iterations()
    )));
    let far = fields.far(&field);
    outcome.checks.push(Check::new(
        "plain Newton from the affine stretch, relative L2 distance",
        "–",
        Wanted::AtMost(1e-8),
        "the same equations",
        far,
    ));
    Ok(())
}
