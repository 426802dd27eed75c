//! What the report says about a motion: energies, frequencies, deviations in time.

use serde_json::json;

use super::corrected::CorrectedMotion;
use super::files::{animation, figures, grids, tables};
use super::plates::{compression, shown, times};
use super::problem::MovingPlate;
use super::solution::ModelMotion;
use super::statement;
use crate::dynamics::{Instant, lumped_mass};
use crate::mesh::Mesh;
use crate::results::{Block, Check, Content, Drawing, Material, Outcome, Step, Wanted, number};

/// Instants in the table of deviations.
const ROWS: usize = 12;

/// How far a motion on the lattice is from the finite elements'.
pub struct Deviations {
    /// Of the displacement at each instant, in relative L2 over the largest of all instants, in %.
    pub displacement: Vec<f64>,
    /// Over all instants, in %.
    pub whole: f64,
}

impl Deviations {
    /// Of fields on the lattice, at the first instants, from the `expected` ones.
    fn new<'a>(
        lattice: &Mesh,
        fields: impl Iterator<Item = &'a Vec<f64>>,
        expected: &[Vec<f64>],
    ) -> Self {
        let weights = lumped_mass(lattice, 1.0, 1.0);
        let square = |u: &[f64]| u.iter().zip(&weights).map(|(u, w)| w * u * u).sum::<f64>();
        let errors: Vec<f64> = fields
            .zip(expected)
            .map(|(now, expected)| {
                let both = now.iter().zip(expected);
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
fn expected(lattice: &Mesh, elements: &ModelMotion) -> Vec<Vec<f64>> {
    let instants = elements.history.instants.iter();
    instants
        .map(|now| elements.mesh.displacement_on(&now.displacement, lattice))
        .collect()
}

/// The outcome of both models and the corrected motion.
pub fn outcome(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    corrected: &CorrectedMotion,
) -> Outcome {
    let [springs, elements] = models;
    let expected = expected(&springs.mesh, elements);
    let of_springs = springs.history.instants.iter();
    let of_springs = of_springs.map(|now| &now.displacement);
    let of_corrected = corrected.displacement.iter();
    let deviations = [
        Deviations::new(&springs.mesh, of_springs, &expected),
        Deviations::new(&springs.mesh, of_corrected, &expected),
    ];
    let seconds = models
        .iter()
        .map(|model| (model.name.to_owned(), model.seconds));
    let mut blocks = vec![
            Block::Paragraph(introduction(plate)),
            summary(models),
            Block::Paragraph(corrected.note.clone()),
            Block::Paragraph(
                "Deviation at some instants, over the largest displacement field of the finite elements, and the force \
                 of the right grip:"
                    .into(),
            ),
            in_time(models, &deviations),
        ];
    blocks.extend(statement::blocks(plate));
    let mut files = tables(plate, models, corrected);
    let (plates, instants) = (shown(plate, models, corrected), times(models));
    let animation = Drawing::Animation(animation(&instants, &plates));
    files.push(("motion.png".into(), Content::Picture(animation)));
    let mut outcome = Outcome {
        checks: checks(plate, models, &deviations),
        blocks,
        problem: statement::json(plate),
        material: Some(Material::from(&plate.card)),
        along: "time",
        steps: steps(models, &deviations),
        figures: figures(plate, models, (corrected, &plates)),
        style: plate.pictures.style.clone(),
        grids: grids(plate, &instants, &plates, &expected),
        warnings: compression(plate, &instants, &plates).into_iter().collect(),
        files,
        times: seconds.collect(),
        ..Outcome::default()
    };
    let ends = models.iter().map(|model| &model.end);
    for end in ends.chain([&corrected.end]).flatten() {
        outcome.ended(end);
    }
    outcome
}

/// The figures of every instant for machines.
fn steps([springs, elements]: &[ModelMotion; 2], deviations: &[Deviations; 2]) -> Vec<Step> {
    let quantities = |now: &Instant, deviations: Option<&Deviations>, instant: usize| {
        let deviation = deviations.map(|own| own.displacement.get(instant));
        json!({
            "displacement_percent": deviation,
            "grip_force_N": now.support_forces[1],
            "kinetic_energy_mJ": now.energy.kinetic,
            "stored_energy_mJ": now.energy.stored,
            "viscous_work_mJ": now.energy.viscous_work,
            "external_work_mJ": now.energy.external_work,
        })
    };
    let [of_springs, of_corrected] = deviations;
    let instants = springs
        .history
        .instants
        .iter()
        .zip(&elements.history.instants);
    let step = |(instant, (springs, elements)): (usize, (&Instant, &Instant))| {
        let corrected = of_corrected.displacement.get(instant);
        let models = [
            (
                "mass_spring",
                quantities(springs, Some(of_springs), instant),
            ),
            (
                "corrected",
                json!(corrected.map(|own| json!({ "displacement_percent": own }))),
            ),
            ("finite_element", quantities(elements, None, instant)),
        ];
        Step {
            at: springs.time,
            models: models
                .map(|(name, own)| (name.to_owned(), own))
                .into_iter()
                .collect(),
        }
    };
    instants.enumerate().map(step).collect()
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

fn summary(models: &[ModelMotion; 2]) -> Block {
    let head = [
        "model",
        "nodes",
        "steps",
        "taken again",
        "factorisations",
        "first longitudinal frequency at rest [Hz]",
        "energy balance, largest error [%]",
        "largest stored energy [mJ]",
        "viscous work [mJ]",
        "work of grips and loads [mJ]",
    ];
    let row = |model: &ModelMotion| {
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
            number(last.viscous_work),
            number(last.external_work),
        ]
    };
    Block::table(&head, models.iter().map(row))
}

fn in_time([springs, elements]: &[ModelMotion; 2], deviations: &[Deviations; 2]) -> Block {
    let head = [
        "time [s]",
        "mass-spring: displacement [%]",
        "corrected: displacement [%]",
        "mass-spring: force [N]",
        "finite elements: force [N]",
    ];
    let count = deviations[0].displacement.len();
    let every = count.div_ceil(ROWS).max(1);
    let percent = |own: &Deviations, instant: usize| {
        let value = own.displacement.get(instant);
        value.map_or("–".into(), |value| format!("{value:.3}"))
    };
    let row = |instant: usize| {
        let force = |model: &ModelMotion| model.history.instants[instant].support_forces[1][0];
        vec![
            number(springs.history.instants[instant].time),
            percent(&deviations[0], instant),
            percent(&deviations[1], instant),
            number(force(springs)),
            number(force(elements)),
        ]
    };
    Block::table(&head, (0..count).step_by(every).map(row))
}

fn checks(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    deviations: &[Deviations; 2],
) -> Vec<Check> {
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
    let energy = |model: &ModelMotion| {
        check(
            format!("{}: error of the energy balance", model.name),
            limits.energy_percent,
            100.0 * model.history.energy_error(),
        )
    };
    let [of_springs, of_corrected] = deviations;
    let (name, last) = match of_corrected.displacement.is_empty() {
        true => ("mass-spring", of_springs),
        false => ("corrected", of_corrected),
    };
    let compared = last.displacement.len();
    let until = times(models)[..compared].last().copied();
    let until = until.unwrap_or_default();
    let over = match until < plate.time.duration * (1.0 - 1e-9) {
        true => format!("up to {} s", number(until)),
        false => "over all instants".to_owned(),
    };
    let deviation = check(
        format!("{name}: displacement {over}"),
        limits.deviation_percent,
        last.whole,
    );
    models.iter().map(energy).chain([deviation]).collect()
}
