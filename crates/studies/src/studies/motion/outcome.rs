//! What the report says about a motion: energies, frequencies, deviations in time.

use serde_json::json;

use super::corrected::CorrectedInstants;
use super::deviations::{Deviations, OwnError, displacements_on};
use super::files::{animation, figures, grids, tables};
use super::headline::headline;
use super::plates::{shown, times};
use super::problem::MovingPlate;
use super::solution::ModelMotion;
use super::statement;
use super::warnings::warnings;
use crate::compare::judgement::{judge_by_margin, percent};
use crate::dynamics::Instant;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::results::{Block, Check, Content, Drawing, Material, Outcome, Step, Wanted};
use crate::units::number;

/// Instants in the table of deviations.
const ROWS: usize = 12;

/// The outcome of both models and the corrected motion.
pub fn outcome(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    own_error: Option<&OwnError>,
    corrected: &CorrectedInstants,
) -> Outcome {
    let [springs, elements] = models;
    let expected = displacements_on(&springs.mesh, elements);
    let deviations = Deviations::both(models, corrected, &expected);
    let seconds = models
        .iter()
        .map(|model| (model.name.to_owned(), model.seconds));
    let mut blocks = vec![
            Block::Paragraph(introduction(plate)),
            summary(models),
            Block::Paragraph(corrected.note.clone()),
            Block::Paragraph(compared(&deviations, own_error)),
            Block::Paragraph(
                "Deviation at some instants, relative to the largest displacement field of the finite elements, and force of the right grip:"
                    .into(),
            ),
            in_time(models, corrected, &deviations),
        ];
    blocks.extend(statement::blocks(plate));
    let mut files = tables(plate, models, corrected);
    let (plates, instants) = (shown(plate, models, corrected), times(models));
    let animation = Drawing::Animation(animation(&instants, &plates));
    files.push(("motion.png".into(), Content::Picture(animation)));
    let mut outcome = Outcome {
        headline: headline(plate, elements, &plates),
        checks: checks(plate, models, &deviations, own_error),
        blocks,
        problem: statement::json(plate, own_error),
        material: Some(Material::from(&plate.card)),
        along: "time",
        steps: steps(models, corrected, &deviations),
        figures: figures(plate, models, corrected, &plates),
        style: plate.pictures.style.clone(),
        grids: grids(plate, &instants, &plates, &expected),
        warnings: warnings(plate, &instants, &plates),
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
fn steps(
    [springs, elements]: &[ModelMotion; 2],
    corrected: &CorrectedInstants,
    deviations: &[Deviations; 2],
) -> Vec<Step> {
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
        let percent = of_corrected.displacement.get(instant);
        let of_corrected = percent.zip(corrected.right_force.get(instant)).map(
            |(percent, force)| json!({ "displacement_percent": percent, "grip_force_N": force }),
        );
        let models = [
            (
                MASS_SPRING.key,
                quantities(springs, Some(of_springs), instant),
            ),
            (CORRECTED.key, json!(of_corrected)),
            (FINITE_ELEMENTS.key, quantities(elements, None, instant)),
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
    let ends = match plate.release {
        Some(_) => "one end",
        None => "both ends",
    };
    let waves = plate.bar_waves();
    let (element, _) = plate.element;
    format!(
        "A plate of {length} × {width} × {} mm with a density of {} kg/m³ between grips, modelled by springs with dashpots and by finite elements \
         ({}) with the same lumped mass. A bar of this length, clamped at {ends}, has its first longitudinal natural frequency √(E₀/ρ)/({waves} L) \
         at {} Hz.",
        plate.problem.thickness,
        number(1e12 * plate.density),
        element.name(),
        number(plate.bar_frequency())
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
            model.frequency.map_or("–".to_owned(), number),
            number(100.0 * history.energy_error()),
            number(stored),
            number(last.viscous_work),
            number(last.external_work),
        ]
    };
    Block::table(&head, models.iter().map(row))
}

/// Deviations over all instants in a sentence, beside the finite elements' own error.
fn compared([of_springs, of_corrected]: &[Deviations; 2], own_error: Option<&OwnError>) -> String {
    let told = |name: &str, own: &Deviations| {
        let force = own.force.map_or_else(String::new, |force| {
            format!(", and the force of the right grip by {} %", percent(force))
        });
        format!(
            "The displacement of the {name} deviates from the finite elements' by {} % over all instants{force}. ",
            percent(own.whole)
        )
    };
    let mut text = told("springs", of_springs);
    if !of_corrected.displacement.is_empty() {
        text += &told("corrected motion", of_corrected);
    }
    text + &own_error.map_or_else(
        || {
            "The finite elements' own error is not known: there is no solution on larger cells."
                .to_owned()
        },
        OwnError::describe,
    )
}

fn in_time(
    [springs, elements]: &[ModelMotion; 2],
    corrected: &CorrectedInstants,
    deviations: &[Deviations; 2],
) -> Block {
    let head = [
        "time [s]",
        "mass-spring: displacement [%]",
        "corrected: displacement [%]",
        "mass-spring: force [N]",
        "corrected: force [N]",
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
            corrected
                .right_force
                .get(instant)
                .map_or("–".into(), |own| number(own[0])),
            number(force(elements)),
        ]
    };
    Block::table(&head, (0..count).step_by(every).map(row))
}

/// How the reference becomes a better one.
const REMEDY: &str = "take more `finite_element.cells`, or a shorter `time.step`";

fn checks(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    deviations: &[Deviations; 2],
    own_error: Option<&OwnError>,
) -> Vec<Check> {
    let limits = plate.tolerances;
    let check = |quantity: String, limit, value| {
        let wanted = Wanted::AtMost(limit);
        Check::new(quantity, "%", wanted, "the study's tolerance", value)
    };
    let energy = |model: &ModelMotion| {
        let quantity = format!("{}: error of the energy balance", model.name);
        check(
            quantity,
            limits.energy_percent,
            100.0 * model.history.energy_error(),
        )
    };
    let [of_springs, of_corrected] = deviations;
    let (name, last) = if of_corrected.displacement.is_empty() {
        (MASS_SPRING.name, of_springs)
    } else {
        (CORRECTED.name, of_corrected)
    };
    let compared = last.displacement.len();
    let until = times(models)[..compared].last().copied();
    let until = until.unwrap_or_default();
    let over = if until < plate.time.duration * (1.0 - 1e-9) {
        format!("up to {} s", number(until))
    } else {
        "over all instants".to_owned()
    };
    let deviation = |quantity: &str, limit: f64, value: f64, own: Option<f64>| {
        let own = own.unwrap_or(f64::NAN);
        let check = check(format!("{name}: {quantity} {over}"), limit, value);
        check.judged(judge_by_margin(value, own, limit, REMEDY), own)
    };
    let own = own_error.map(|own| own.displacement);
    let displacement = deviation("displacement", limits.deviation_percent, last.whole, own);
    let force = limits.force_percent.zip(last.force).map(|(limit, value)| {
        let own = own_error.and_then(|own| own.force);
        deviation("force of the right grip", limit, value, own)
    });
    let energies = models.iter().map(energy);
    energies.chain([displacement]).chain(force).collect()
}
