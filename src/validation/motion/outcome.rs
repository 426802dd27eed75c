//! What is told about a motion: energies, frequencies, deviations in time.

use super::Moved;
use super::files::{animation, figures, tables, vtk_files};
use super::read::MovingPlate;
use crate::dynamics::lumped_mass;
use crate::mesh::Mesh;
use crate::output::Block;
use crate::validation::{Check, Outcome, Wanted, number};

/// Instants in the table of deviations.
const ROWS: usize = 12;

/// How far springs are from finite elements.
pub struct Deviations {
    /// Of the displacement at each instant, in relative L2 over the largest of all instants, in %.
    pub displacement: Vec<f64>,
    /// Over all instants, in %.
    pub whole: f64,
}

impl Deviations {
    fn new(plate: &MovingPlate, [springs, elements]: &[Moved; 2]) -> Self {
        let lattice = &springs.mesh;
        let weights = lumped_mass(lattice, 1.0, plate.problem.thickness);
        let square = |u: &[f64]| u.iter().zip(&weights).map(|(u, w)| w * u * u).sum::<f64>();
        let expected = expected(lattice, elements);
        let pairs = springs.history.instants.iter().zip(&expected);
        let errors: Vec<f64> = pairs
            .map(|(now, expected)| {
                let both = now.displacement.iter().zip(expected);
                square(&both.map(|(u, v)| u - v).collect::<Vec<_>>())
            })
            .collect();
        let sizes: Vec<f64> = expected.iter().map(|u| square(u)).collect();
        let largest = sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let displacement = errors.iter().map(|error| 100.0 * (error / largest).sqrt());
        let [all, size] = [&errors, &sizes].map(|values| values.iter().sum::<f64>());
        Self {
            displacement: displacement.collect(),
            whole: 100.0 * (all / size.max(f64::MIN_POSITIVE)).sqrt(),
        }
    }
}

/// The finite elements' displacements at the nodes of the lattice at all instants.
pub fn expected(lattice: &Mesh, elements: &Moved) -> Vec<Vec<f64>> {
    let instants = elements.history.instants.iter();
    instants
        .map(|now| elements.mesh.displacement_on(&now.displacement, lattice))
        .collect()
}

/// The outcome of both models.
pub fn outcome(plate: &MovingPlate, models: &[Moved; 2]) -> Outcome {
    let deviations = Deviations::new(plate, models);
    let times = models
        .iter()
        .map(|model| (model.name.to_owned(), model.seconds));
    Outcome {
        checks: checks(plate, models, &deviations),
        blocks: vec![
            Block::Paragraph(introduction(plate)),
            summary(models),
            Block::Paragraph(
                "Deviation of the springs at some instants, over the largest displacement field of the finite \
                 elements, and the force of the right grip:"
                    .into(),
            ),
            in_time(models, &deviations),
        ],
        figures: figures(plate, models),
        vtk: vtk_files(plate, models),
        files: tables(plate, models)
            .into_iter()
            .chain([animation(models)])
            .collect(),
        times: times.collect(),
        ..Outcome::default()
    }
}

fn introduction(plate: &MovingPlate) -> String {
    let [length, width] = plate.problem.size;
    let bar = (plate.problem.law.youngs_modulus() / plate.density).sqrt() / (4.0 * length);
    let (element, _) = plate.element;
    format!(
        "A plate of {length} × {width} × {} mm with a density of {} kg/m³ between grips, by springs with dashpots and by \
         finite elements ({}) with the same lumped mass. A bar of its length, clamped at one end, has its first \
         longitudinal vibration √(E₀/ρ)/(4 L) at {} Hz.",
        plate.problem.thickness,
        number(1e12 * plate.density),
        element.name(),
        number(bar)
    )
}

fn summary(models: &[Moved; 2]) -> Block {
    let head = [
        "model",
        "nodes",
        "steps",
        "taken again",
        "factorisations",
        "first longitudinal frequency at rest [Hz]",
        "energy balance, largest error [%]",
        "largest stored energy [mJ]",
        "dissipated [mJ]",
        "work of grips and loads [mJ]",
    ];
    let row = |model: &Moved| {
        let history = &model.history;
        let energies = history.instants.iter().map(|now| now.energy);
        let stored = energies.fold(0.0, |most: f64, energy| most.max(energy.stored));
        let last = history.instants[history.instants.len() - 1].energy;
        vec![
            model.name.to_owned(),
            model.mesh.nodes.len().to_string(),
            history.steps.to_string(),
            history.halved.to_string(),
            history.factorisations.to_string(),
            number(model.frequency),
            number(100.0 * history.energy_error()),
            number(stored),
            number(last.dissipated),
            number(last.external_work),
        ]
    };
    Block::table(&head, models.iter().map(row))
}

fn in_time([springs, elements]: &[Moved; 2], deviations: &Deviations) -> Block {
    let head = [
        "time [s]",
        "mass-spring: displacement [%]",
        "mass-spring: force [N]",
        "finite elements: force [N]",
    ];
    let count = deviations.displacement.len();
    let every = count.div_ceil(ROWS).max(1);
    let row = |instant: usize| {
        let force = |model: &Moved| model.history.instants[instant].support_forces[1][0];
        vec![
            number(springs.history.instants[instant].time),
            format!("{:.3}", deviations.displacement[instant]),
            number(force(springs)),
            number(force(elements)),
        ]
    };
    Block::table(&head, (0..count).step_by(every).map(row))
}

fn checks(plate: &MovingPlate, models: &[Moved; 2], deviations: &Deviations) -> Vec<Check> {
    let limits = plate.tolerances;
    let check = |quantity: String, limit, value| {
        Check::new(
            quantity,
            "%",
            Wanted::AtMost(limit),
            "the study's tolerance",
            value,
        )
    };
    let energy = |model: &Moved| {
        check(
            format!("{}: error of the energy balance", model.name),
            limits.energy_percent,
            100.0 * model.history.energy_error(),
        )
    };
    let deviation = check(
        "mass-spring: displacement over all instants".into(),
        limits.deviation_percent,
        deviations.whole,
    );
    models.iter().map(energy).chain([deviation]).collect()
}
