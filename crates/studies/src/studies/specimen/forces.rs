//! Forces, moments and displacements of all groups, for reports and for machines.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::problem::Specimen;
use super::results::measured::Quantity;
use super::results::models::Models;
use crate::compare::judgement::percent;
use crate::document::write_records;
use crate::problem::{GroupState, Solution};
use crate::results::models::ModelStyle;
use crate::results::{Block, or_dash};
use crate::statistics::larger;
use crate::studies::ModelKind;
use crate::units::number;

/// A table of all groups in all models at all load factors.
pub fn table(specimen: &Specimen, models: &Models, balances: &[Balance]) -> Vec<Block> {
    let head = [
        specimen.along.head(),
        "group",
        "model",
        "force along x [N]",
        "force along y [N]",
        "moment about the group's middle [N·mm]",
        "mean displacement along x [mm]",
        "mean displacement along y [mm]",
    ];
    let scales = scales(specimen, models);
    let mut rows = Vec::new();
    for (step, factor) in specimen.factors.iter().enumerate() {
        for (index, group) in specimen.groups().iter().enumerate() {
            for (model, solution) in models.all() {
                if let Some(groups) = solution.groups(step) {
                    let names = [
                        specimen.along.value(*factor),
                        (*group).to_owned(),
                        model.style().name.to_owned(),
                    ];
                    rows.push(
                        names
                            .into_iter()
                            .chain(cells(&groups[index], scales))
                            .collect(),
                    );
                }
            }
        }
    }
    let text = "Forces of the supports on the specimen, positive along the axes, and their moments about the middle of the deformed group, positive \
                counter-clockwise. A force prescribed on a grip counts as a support force. Values that are zero except for rounding are shown as 0. \
                Displacements and the middle are means over the length of the group's edges at rest.";
    vec![
        Block::Heading(2, "Forces at the groups".into()),
        Block::Paragraph(text.into()),
        Block::table(&head, rows),
        Block::Paragraph(balance_words(balances)),
    ]
}

/// The same as a table for other programs, with all digits: a force-displacement curve is two of its columns. Of a plate with its width at
/// mid length.
pub fn csv(specimen: &Specimen, models: &Models) -> String {
    let mut head = vec![
        specimen.along.column(),
        "group",
        "model",
        "force_x_N",
        "force_y_N",
        "moment_Nmm",
        "displacement_x_mm",
        "displacement_y_mm",
        "strain_energy_mJ",
    ];
    let is_plate = specimen.grids().is_some();
    head.extend(is_plate.then_some("mid_width_mm"));
    let mut records = vec![head.into_iter().map(str::to_owned).collect::<Vec<_>>()];
    for (step, factor) in specimen.factors.iter().enumerate() {
        for (model, solution) in models.all() {
            let Solution { mesh, states, .. } = solution;
            let Some(field) = states.get(step) else {
                continue;
            };
            let width = is_plate.then(|| mesh.mid_width(&field.displacement));
            let groups = solution.groups(step).unwrap_or_default();
            for (group, state) in specimen.groups().iter().zip(groups) {
                let ([fx, fy], [ux, uy]) = (state.force, state.displacement);
                let mut record = vec![
                    factor.to_string(),
                    (*group).to_owned(),
                    model.style().name.to_owned(),
                ];
                let values = [fx, fy, state.moment, ux, uy, field.convergence.energy];
                record.extend(
                    values
                        .into_iter()
                        .chain(width)
                        .map(|value| value.to_string()),
                );
                records.push(record);
            }
        }
    }
    write_records(records)
}

/// How well the forces and moments of a model balance in its worst state.
pub struct Balance {
    model: ModelStyle,
    /// The resultant of all forces and moments relative to the largest of them; `None` where the model has no states.
    unbalanced: Option<f64>,
    /// The largest force left at a node that no support holds over the largest force on a group; `None` where there is none.
    free_nodes: Option<f64>,
}

/// The balance of every model.
pub fn balances(specimen: &Specimen, models: &Models) -> [Balance; 3] {
    models.all().map(|(model, solution)| Balance {
        model: model.style(),
        unbalanced: solution.worst_balance(),
        free_nodes: free_nodes(specimen, solution),
    })
}

/// The worst balance of all models.
pub fn worst_balance(balances: &[Balance]) -> Option<f64> {
    let known = balances.iter().filter_map(|own| own.unbalanced);
    known.reduce(larger)
}

/// See [`Balance::free_nodes`].
fn free_nodes(specimen: &Specimen, solution: &Solution) -> Option<f64> {
    let (mesh, problem) = (&solution.mesh, &specimen.problem);
    let (held, ties) = (problem.held_by(mesh).ok()?, problem.ties(mesh).ok()?);
    let masters: BTreeSet<usize> = ties.values().map(|tie| tie.master).collect();
    let is_free = |unknown: &usize| {
        !held.contains_key(unknown) && !ties.contains_key(unknown) && !masters.contains(unknown)
    };
    let free: Vec<usize> = (0..2 * mesh.nodes.len()).filter(is_free).collect();
    let of_step = |step: usize| {
        let groups = solution.groups(step)?.iter();
        let most = groups.fold(0.0, |most: f64, own| {
            most.max(own.force[0].hypot(own.force[1]))
        });
        let residual = &solution.states[step].residual;
        let left = free
            .iter()
            .fold(0.0, |left: f64, unknown| left.max(residual[*unknown].abs()));
        (most > 0.0).then(|| left / most)
    };
    (0..solution.reached()).filter_map(of_step).reduce(larger)
}

/// The balance of each model in a sentence.
pub fn balance_words(balances: &[Balance]) -> String {
    let balances = balances.iter().filter_map(|own| {
        let unbalanced = own.unbalanced?;
        let free = or_dash(own.free_nodes, |left| format!("{left:.1e}"));
        Some(format!("{} {unbalanced:.1e} and {free}", own.model.name))
    });
    format!(
        "Balance of forces and moments: the unbalanced part of supports and loads relative to the largest force or moment, and the largest force left \
         at a node without a support relative to that on a group, at the worst load: {}.",
        balances.collect::<Vec<_>>().join("; ")
    )
}

/// The warning about moments that nothing compares: where the measured force is none, as of a ring that is turned, the requirement of the
/// force is met by any field.
pub fn unjudged_moment(specimen: &Specimen, models: &Models) -> Option<String> {
    /// A smaller share of the forces on nodes times the specimen's larger side is what meshes leave.
    const LEAST: f64 = 1e-2;
    let (measured, finest) = (&models.reference.measured, &models.reference.finest);
    let corrected = models.of(ModelKind::Corrected);
    let step = corrected.reached().min(finest.reached()).checked_sub(1)?;
    if measured.quantity != Quantity::Force {
        return None;
    }
    measured.none_of(finest, step)?;
    let of = |solution: &Solution| Some(solution.groups(step)?[measured.index]);
    let (expected, found) = (of(finest)?, of(corrected)?);
    let [.., side] = scales(specimen, models);
    let is_moment = expected.moment.abs() > LEAST * expected.size.max(expected.rounding) * side;
    is_moment.then(|| {
        format!(
            "the force of the supports on `{}` is none, so that the requirement of the force compares nothing, but their moment at {} \
             is {} N·mm in the corrected field, {} % from the {} N·mm of the finite elements: no requirement judges it, and the finite elements' own \
             error of it is not known",
            measured.group,
            specimen.along.describe(specimen.factors[step]),
            number(found.moment),
            percent(100.0 * (found.moment / expected.moment - 1.0).abs()),
            number(expected.moment)
        )
    })
}

/// The largest force at any group, its moment over the specimen's larger side, and that side.
fn scales(specimen: &Specimen, models: &Models) -> [f64; 3] {
    let series = models.all();
    let steps = 0..specimen.factors.len();
    let all = steps.flat_map(|step| {
        series
            .iter()
            .filter_map(move |(_, solution)| solution.groups(step))
    });
    let sizes = all
        .flatten()
        .map(|state| state.force[0].hypot(state.force[1]));
    let force = sizes.fold(0.0, f64::max);
    let [low, high] = models.on_lattice.springs.mesh.bounding_box();
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    [force, force * side, side]
}

fn cells(state: &GroupState, [force, moment, side]: [f64; 3]) -> Vec<String> {
    const ROUNDING: f64 = 1e-12;
    let [x, y, turning] = state.carried();
    let [u, v] = state.displacement;
    let shown = |value: f64, scale: f64| {
        if value.abs() < ROUNDING * scale {
            number(0.0)
        } else {
            number(value)
        }
    };
    let forces = [(x, force), (y, force), (turning, moment)];
    let forces = forces.map(|(value, scale)| shown(value, scale));
    let displacements = [u, v].map(|value| shown(value, side));
    forces.into_iter().chain(displacements).collect()
}

/// What happens at all groups in a model at a load factor, for machines; `None` where it has no solution.
pub fn groups(specimen: &Specimen, solution: &Solution, step: usize) -> Option<Value> {
    let states = solution.groups(step)?;
    let group = |(name, state): (&str, &GroupState)| {
        let value = json!({
            "force_N": state.force,
            "moment_Nmm": state.moment,
            "middle_mm": state.place,
            "displacement_mm": state.displacement,
        });
        (name.to_owned(), value)
    };
    let groups = specimen.groups().into_iter().zip(states);
    Some(Value::Object(groups.map(group).collect()))
}

/// The worst balance of every model, for machines.
pub fn balances_json(balances: &[Balance]) -> Map<String, Value> {
    let of_model = |own: &Balance| {
        let value = json!({ "unbalanced": own.unbalanced, "free_nodes": own.free_nodes });
        (own.model.key.to_owned(), value)
    };
    balances.iter().map(of_model).collect()
}
