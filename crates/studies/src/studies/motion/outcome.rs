//! The report of a motion: energies, frequencies, deviations in time.

use serde_json::json;

use super::deviations::{Deviations, DiscretisationError, since_start};
use super::files::{animation, figures, grids, springs_table, tables};
use super::headline::headline;
use super::problem::MovingSheet;
use super::solution::{ModelMotion, Motions};
use super::statement;
use crate::compare::judgement::{judge_by_margin, percent};
use crate::dynamics::Instant;
use crate::mass_spring::SpringLaw;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::results::{
    Block, Check, Content, Drawing, Material, Outcome, Step, Table, Wanted, object, or_dash,
};
use crate::studies::findings::{Examined, findings};
use crate::studies::specimen::Outline;
use crate::units::number;

/// Instants in the table of deviations.
const ROWS: usize = 12;

/// The outcome of both models and the corrected motion.
pub fn outcome(
    sheet: &MovingSheet,
    motions: &Motions,
    own_error: Option<&DiscretisationError>,
) -> Outcome {
    let deviations = Deviations::all(sheet, motions);
    let seconds = motions.models();
    let seconds = seconds.map(|model| (model.kind.style().name.to_owned(), model.seconds));
    let mut files = tables(sheet, motions);
    files.extend(springs_table(sheet, motions));
    let (series, times) = (motions.series(), motions.times());
    let reference = &series[series.len() - 1];
    let animation = Drawing::Animation(animation(&times, &series, motions.axis()));
    files.push((
        format!("{}.png", sheet.specimen.name),
        Content::Picture(animation),
    ));
    let mut outcome = Outcome {
        headline: headline(sheet, motions, reference),
        checks: checks(sheet, motions, &deviations, own_error),
        blocks: blocks(sheet, motions, &deviations, own_error),
        problem: statement::json(sheet, own_error),
        material: Some(Material::from(&sheet.specimen.card)),
        along: "time",
        steps: steps(sheet, motions, &deviations),
        figures: figures(sheet, motions, &series),
        style: sheet.specimen.pictures.style.clone(),
        grids: grids(sheet, motions, &series),
        findings: findings(Examined {
            specimen: &sheet.specimen,
            series: &series,
            models: None,
            has_springs: matches!(sheet.springs, SpringLaw::Material),
            is_motion: true,
        }),
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

/// The parts of the report after its headline.
fn blocks(
    sheet: &MovingSheet,
    motions: &Motions,
    deviations: &(Deviations, Option<Deviations>),
    own_error: Option<&DiscretisationError>,
) -> Vec<Block> {
    let mut blocks = vec![
        Block::Paragraph(introduction(sheet, &motions.elements)),
        summary(motions.models()),
        Block::Paragraph(motions.correction.note.clone()),
        Block::Paragraph(compared(sheet, deviations, own_error)),
        Block::Paragraph(format!(
            "Deviation at some instants, relative to the largest {} of the finite elements, and force of the {}:",
            if since_start(sheet) {
                "change of the displacement field"
            } else {
                "displacement field"
            },
            sheet.measured_name()
        )),
        in_time(sheet, motions, deviations),
    ];
    blocks.extend(statement::blocks(sheet));
    blocks
}

/// The figures of every instant for machines.
fn steps(
    sheet: &MovingSheet,
    motions: &Motions,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
) -> Vec<Step> {
    let force = |now: &Instant| sheet.measured_force(&now.support_forces);
    let quantities = |now: &Instant, percent: Option<&f64>| {
        json!({
            "displacement_percent": percent,
            "grip_force_N": force(now),
            "kinetic_energy_mJ": now.energy.kinetic,
            "stored_energy_mJ": now.energy.stored,
            "viscous_work_mJ": now.energy.viscous_work,
            "external_work_mJ": now.energy.external_work,
        })
    };
    let corrected = |instant: usize| {
        let motion = motions.correction.motion.as_ref()?;
        let percent = of_corrected.as_ref()?.displacement.get(instant)?;
        let force = force(motion.instants().get(instant)?);
        Some(json!({ "displacement_percent": percent, "grip_force_N": force }))
    };
    let step = |(instant, (springs, elements)): (usize, (&Instant, &Instant))| Step {
        at: springs.time,
        models: object(json!({
            (MASS_SPRING.key): quantities(springs, of_springs.displacement.get(instant)),
            (CORRECTED.key): corrected(instant),
            (FINITE_ELEMENTS.key): quantities(elements, None),
        })),
    };
    let pairs = motions.springs.instants().iter();
    let pairs = pairs.zip(motions.elements.instants());
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

fn summary(models: [&ModelMotion; 2]) -> Block {
    let last = |model: &ModelMotion| model.instants()[model.instants().len() - 1].energy;
    let stored = |model: &ModelMotion| {
        let energies = model.instants().iter().map(|now| now.energy.stored);
        energies.fold(0.0, f64::max)
    };
    Table::of(models)
        .column("model", |model| model.kind.style().name.to_owned())
        .column("nodes", |model| model.mesh.nodes.len().to_string())
        .column("steps", |model| model.history.steps.to_string())
        .column("taken again", |model| model.history.halved.to_string())
        .column("factorisations", |model| {
            model.history.factorisations.to_string()
        })
        .column("first longitudinal frequency at rest [Hz]", |model| {
            model.frequency.map_or("–".to_owned(), number)
        })
        .column("energy balance, largest error [%]", |model| {
            number(100.0 * model.history.energy_error())
        })
        .column("largest stored energy [mJ]", |model| number(stored(model)))
        .column("viscous work [mJ]", |model| {
            number(last(model).viscous_work)
        })
        .column("work of grips and loads [mJ]", |model| {
            number(last(model).external_work)
        })
        .block()
}

/// Deviations over all instants in a sentence, beside the finite elements' own error.
fn compared(
    sheet: &MovingSheet,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
    own_error: Option<&DiscretisationError>,
) -> String {
    let mut text = String::new();
    if since_start(sheet) {
        text += "The supports only hold the sheet, so that displacements and forces are compared by their changes since the start. ";
    }
    let of_corrected = of_corrected
        .as_ref()
        .map(|deviations| ("corrected motion", deviations));
    for (name, deviations) in std::iter::once(("springs", of_springs)).chain(of_corrected) {
        let force = deviations.force.map_or_else(String::new, |force| {
            format!(
                ", and the force of the {} by {} %",
                sheet.measured_name(),
                percent(force)
            )
        });
        text += &format!(
            "The displacement of the {name} deviates from the finite elements' by {} % over all instants{force}. ",
            percent(deviations.total)
        );
    }
    text + &own_error.map_or_else(
        || {
            "The finite elements' own error is not known: there is no solution on larger cells."
                .to_owned()
        },
        DiscretisationError::describe,
    )
}

fn in_time(
    sheet: &MovingSheet,
    motions: &Motions,
    (of_springs, of_corrected): &(Deviations, Option<Deviations>),
) -> Block {
    let axis = sheet.measured_axis(&motions.elements);
    let corrected = motions.correction.motion.as_ref();
    let percent = |deviations: Option<&Deviations>, instant: usize| {
        let value = deviations.and_then(|deviations| deviations.displacement.get(instant).copied());
        or_dash(value, |value| format!("{value:.3}"))
    };
    let count = of_springs.displacement.len();
    let every = count.div_ceil(ROWS).max(1);
    let mut table = Table::of((0..count).step_by(every))
        .column("time [s]", |instant| {
            number(motions.springs.instants()[*instant].time)
        })
        .column("mass-spring: displacement [%]", |instant| {
            percent(Some(of_springs), *instant)
        })
        .column("corrected: displacement [%]", |instant| {
            percent(of_corrected.as_ref(), *instant)
        });
    let models = [
        ("mass-spring", Some(&motions.springs)),
        ("corrected", corrected),
        ("finite elements", Some(&motions.elements)),
    ];
    for (name, model) in models.into_iter().filter(|_| axis.is_some()) {
        table = table.column(format!("{name}: force [N]"), |instant| {
            let state = model.and_then(|model| model.groups.get(*instant));
            or_dash(
                state.zip(axis).map(|(state, axis)| state.force[axis]),
                number,
            )
        });
    }
    table.block()
}

/// How the reference becomes more accurate.
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
    own_error: Option<&DiscretisationError>,
) -> Vec<Check> {
    let limits = sheet.tolerances;
    let check = |quantity: String, limit, value| {
        let wanted = Wanted::AtMost(limit);
        Check::new(quantity, "%", wanted, "the study's tolerance", value)
    };
    let energy = |model: &ModelMotion| {
        let quantity = format!("{}: error of the energy balance", model.kind.style().name);
        check(
            quantity,
            limits.energy_percent,
            100.0 * model.history.energy_error(),
        )
    };
    let energies = motions.models().map(energy).into_iter();
    let corrected = of_corrected
        .as_ref()
        .map(|deviations| (CORRECTED.name, deviations));
    let (name, last) = corrected.unwrap_or((MASS_SPRING.name, of_springs));
    let until = motions.times()[..last.displacement.len()].last().copied();
    let until = until.unwrap_or_default();
    let over = if until < sheet.time.duration * (1.0 - 1e-9) {
        format!("up to {} s", number(until))
    } else {
        "over all instants".to_owned()
    };
    let change = if since_start(sheet) {
        " since the start"
    } else {
        ""
    };
    let deviation = |quantity: &str, limit: f64, value: f64, error: Option<f64>| {
        let error = error.unwrap_or(f64::NAN);
        let check = check(format!("{name}: {quantity}{change} {over}"), limit, value);
        check.judged(judge_by_margin(value, error, limit, &remedy(sheet)), error)
    };
    let error = own_error.map(|error| error.displacement);
    let displacement = deviation("displacement", limits.deviation_percent, last.total, error);
    let force = limits.force_percent.zip(last.force).map(|(limit, value)| {
        let error = own_error.and_then(|error| error.force);
        let quantity = format!("force of the {}", sheet.measured_name());
        deviation(&quantity, limit, value, error)
    });
    energies.chain([displacement]).chain(force).collect()
}
