//! What the report says about a motion: energies, frequencies, deviations in time.

use serde_json::json;

use super::deviations::{Deviations, OwnError};
use super::files::{animation, figures, grids, springs_table, tables};
use super::headline::headline;
use super::problem::MovingSheet;
use super::shown::shown;
use super::solution::{ModelMotion, Motions};
use super::statement;
use super::warnings::warnings;
use crate::compare::judgement::{judge_by_margin, percent};
use crate::dynamics::Instant;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::results::{Block, Check, Content, Drawing, Material, Outcome, Step, Wanted};
use crate::studies::specimen::Outline;
use crate::units::number;

/// Instants in the table of deviations.
const ROWS: usize = 12;

/// The outcome of both models and the corrected motion.
pub fn outcome(sheet: &MovingSheet, motions: &Motions, own_error: Option<&OwnError>) -> Outcome {
    let deviations = Deviations::all(sheet, motions);
    let seconds = motions.models().map(|model| {
        let name = model.style.name.to_owned();
        (name, model.seconds)
    });
    let mut blocks = vec![
        Block::Paragraph(introduction(sheet, &motions.elements)),
        summary(&motions.models()),
        Block::Paragraph(motions.correction.note.clone()),
        Block::Paragraph(compared(sheet, &deviations, own_error)),
        Block::Paragraph(format!(
            "Deviation at some instants, relative to the largest displacement field of the finite elements, and force of the {}:",
            sheet.measured_name()
        )),
        in_time(sheet, motions, &deviations),
    ];
    blocks.extend(statement::blocks(sheet));
    let mut files = tables(sheet, motions);
    files.extend(springs_table(sheet, motions));
    let (shown, times) = (shown(sheet, motions), motions.times());
    let animation = Drawing::Animation(animation(&times, &shown));
    files.push(("motion.png".into(), Content::Picture(animation)));
    let mut outcome = Outcome {
        headline: headline(sheet, motions, &shown),
        checks: checks(sheet, motions, &deviations, own_error),
        blocks,
        problem: statement::json(sheet, own_error),
        material: Some(Material::from(&sheet.specimen.card)),
        along: "time",
        steps: steps(sheet, motions, &deviations),
        figures: figures(sheet, motions, &shown),
        style: sheet.specimen.pictures.style.clone(),
        grids: grids(sheet, motions, &shown),
        warnings: warnings(sheet, &times, &shown),
        files,
        times: seconds.into(),
        ..Outcome::default()
    };
    let ends = motions.models().map(|model| model.end.as_ref());
    for end in ends
        .into_iter()
        .chain([motions.correction.end.as_ref()])
        .flatten()
    {
        outcome.ended(end);
    }
    outcome
}

/// The figures of every instant for machines.
fn steps(
    sheet: &MovingSheet,
    motions: &Motions,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
) -> Vec<Step> {
    let quantities = |now: &Instant, percent: Option<f64>| {
        json!({
            "displacement_percent": percent,
            "grip_force_N": sheet.measured_force(&now.support_forces),
            "kinetic_energy_mJ": now.energy.kinetic,
            "stored_energy_mJ": now.energy.stored,
            "viscous_work_mJ": now.energy.viscous_work,
            "external_work_mJ": now.energy.external_work,
        })
    };
    let corrected = motions
        .correction
        .motion
        .as_ref()
        .zip(of_corrected.as_ref());
    let pairs = motions
        .springs
        .instants()
        .iter()
        .zip(motions.elements.instants());
    let step = |(instant, (springs, elements)): (usize, (&Instant, &Instant))| {
        let corrected = corrected.and_then(|(own, deviations)| {
            let (now, percent) = own
                .instants()
                .get(instant)
                .zip(deviations.displacement.get(instant))?;
            let force = sheet.measured_force(&now.support_forces);
            Some(json!({ "displacement_percent": percent, "grip_force_N": force }))
        });
        let models = [
            (
                MASS_SPRING.key,
                quantities(springs, of_springs.displacement.get(instant).copied()),
            ),
            (CORRECTED.key, json!(corrected)),
            (FINITE_ELEMENTS.key, quantities(elements, None)),
        ];
        Step {
            at: springs.time,
            models: models
                .map(|(name, own)| (name.to_owned(), own))
                .into_iter()
                .collect(),
        }
    };
    pairs.enumerate().map(step).collect()
}

fn introduction(sheet: &MovingSheet, elements: &ModelMotion) -> String {
    let specimen = &sheet.specimen;
    let mut text = format!(
        "A sheet, {}, {} mm thick, with a density of {} kg/m³, modelled by springs with dashpots and by finite elements ({}) with the same \
         lumped mass.",
        specimen.outline.describe(),
        specimen.problem.thickness,
        number(1e12 * sheet.density),
        elements.mesh.element_names(),
    );
    if specimen.grids().is_some() {
        let ends = match sheet.drive.release {
            Some(_) => "one end",
            None => "both ends",
        };
        text += &format!(
            " A bar of this length, clamped at {ends}, has its first longitudinal natural frequency √(E₀/ρ)/({} L) at {} Hz.",
            sheet.bar_waves(),
            number(sheet.bar_frequency())
        );
    }
    text
}

fn summary(models: &[&ModelMotion; 2]) -> Block {
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
    let row = |model: &&ModelMotion| {
        let history = &model.history;
        let energies = history.instants.iter().map(|now| now.energy);
        let stored = energies.fold(0.0, |most: f64, energy| most.max(energy.stored));
        let last = history.instants[history.instants.len() - 1].energy;
        vec![
            model.style.name.to_owned(),
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
fn compared(
    sheet: &MovingSheet,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
    own_error: Option<&OwnError>,
) -> String {
    let mut text = String::new();
    let of_corrected = of_corrected.as_ref().map(|own| ("corrected motion", own));
    for (name, own) in std::iter::once(("springs", of_springs)).chain(of_corrected) {
        let force = own.force.map_or_else(String::new, |force| {
            format!(
                ", and the force of the {} by {} %",
                sheet.measured_name(),
                percent(force)
            )
        });
        text += &format!(
            "The displacement of the {name} deviates from the finite elements' by {} % over all instants{force}. ",
            percent(own.whole)
        );
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
    sheet: &MovingSheet,
    motions: &Motions,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
) -> Block {
    let mut head = vec![
        "time [s]".to_owned(),
        "mass-spring: displacement [%]".into(),
        "corrected: displacement [%]".into(),
    ];
    let axis = sheet.measured_axis(&motions.elements);
    let corrected = motions.correction.motion.as_ref();
    let models = [Some(&motions.springs), corrected, Some(&motions.elements)];
    if axis.is_some() {
        let names = ["mass-spring", "corrected", "finite elements"];
        head.extend(names.map(|name| format!("{name}: force [N]")));
    }
    let count = of_springs.displacement.len();
    let every = count.div_ceil(ROWS).max(1);
    let or_dash = |value: Option<String>| value.unwrap_or_else(|| "–".into());
    let row = |instant: usize| {
        let percents = [Some(of_springs), of_corrected.as_ref()].map(|own| {
            let value = own?.displacement.get(instant)?;
            Some(format!("{value:.3}"))
        });
        let forces = models.iter().filter_map(|model| {
            let axis = axis?;
            let force = |model: &ModelMotion| {
                let now = model.instants().get(instant)?;
                Some(number(sheet.measured_force(&now.support_forces)?[axis]))
            };
            Some(model.and_then(force))
        });
        let time = number(motions.springs.instants()[instant].time);
        std::iter::once(Some(time))
            .chain(percents)
            .chain(forces)
            .map(or_dash)
            .collect::<Vec<_>>()
    };
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    Block::table(&head, (0..count).step_by(every).map(row))
}

/// How the reference becomes a better one.
fn remedy(sheet: &MovingSheet) -> String {
    let cells = match sheet.specimen.outline {
        Outline::Grid(_) => "more `finite_element.cells`",
        Outline::Shape { .. } => "more `specimen.cells`",
        Outline::File { .. } => "a finer mesh",
    };
    format!("take {cells}, or a shorter `time.step`")
}

fn checks(
    sheet: &MovingSheet,
    motions: &Motions,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
    own_error: Option<&OwnError>,
) -> Vec<Check> {
    let limits = sheet.tolerances;
    let check = |quantity: String, limit, value| {
        let wanted = Wanted::AtMost(limit);
        Check::new(quantity, "%", wanted, "the study's tolerance", value)
    };
    let energy = |model: &ModelMotion| {
        let quantity = format!("{}: error of the energy balance", model.style.name);
        check(
            quantity,
            limits.energy_percent,
            100.0 * model.history.energy_error(),
        )
    };
    let energies = motions.models().map(energy).into_iter();
    let corrected = of_corrected.as_ref().map(|own| (CORRECTED.name, own));
    let (name, last) = corrected.unwrap_or((MASS_SPRING.name, of_springs));
    let until = motions.times()[..last.displacement.len()].last().copied();
    let until = until.unwrap_or_default();
    let over = if until < sheet.time.duration * (1.0 - 1e-9) {
        format!("up to {} s", number(until))
    } else {
        "over all instants".to_owned()
    };
    let deviation = |quantity: &str, limit: f64, value: f64, own: Option<f64>| {
        let own = own.unwrap_or(f64::NAN);
        let check = check(format!("{name}: {quantity} {over}"), limit, value);
        check.judged(judge_by_margin(value, own, limit, &remedy(sheet)), own)
    };
    let own = own_error.map(|own| own.displacement);
    let displacement = deviation("displacement", limits.deviation_percent, last.whole, own);
    let force = limits.force_percent.zip(last.force).map(|(limit, value)| {
        let own = own_error.and_then(|own| own.force);
        let quantity = format!("force of the {}", sheet.measured_name());
        deviation(&quantity, limit, value, own)
    });
    energies.chain([displacement]).chain(force).collect()
}
