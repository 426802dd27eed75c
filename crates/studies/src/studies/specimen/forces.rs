//! Forces, moments and displacements of all groups, for reports and for machines.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::problem::Specimen;
use super::results::measured::Quantity;
use super::results::models::Models;
use crate::compare::judgement::percent;
use crate::problem::{GroupState, Solution};
use crate::results::models::ModelStyle;
use crate::results::{Block, Table, or_dash};
use crate::statistics::{farthest, larger};
use crate::studies::ModelKind;
use crate::units::number;

/// A model's group at a load factor.
struct GroupRow<'a> {
    step: usize,
    group: &'a str,
    model: ModelStyle,
    state: &'a GroupState,
    solution: &'a Solution,
}

/// All groups of all models at a load factor.
fn groups_at<'a>(specimen: &'a Specimen, models: &'a Models, step: usize) -> Vec<GroupRow<'a>> {
    let of_model = |(kind, solution): (ModelKind, &'a Solution)| {
        let groups = specimen.groups().into_iter().zip(solution.groups(step)?);
        let row = move |(group, state)| GroupRow {
            step,
            group,
            model: kind.style(),
            state,
            solution,
        };
        Some(groups.map(row))
    };
    let models = models.all().into_iter();
    models.filter_map(of_model).flatten().collect()
}

/// A value of a group with its head.
type Column = (&'static str, fn(&GroupState) -> f64);

const COLUMNS: [Column; 5] = [
    ("force along x [N]", |state| state.carried()[0]),
    ("force along y [N]", |state| state.carried()[1]),
    ("moment about the group's middle [N·mm]", |state| {
        state.carried()[2]
    }),
    ("mean displacement along x [mm]", |state| {
        state.displacement[0]
    }),
    ("mean displacement along y [mm]", |state| {
        state.displacement[1]
    }),
];

/// Values below this share of the largest force, its moment or the sheet's side are rounding.
const ROUNDING: f64 = 1e-12;

/// A table of all groups in all models at all load factors.
pub fn table(specimen: &Specimen, models: &Models, balances: &[Balance]) -> Vec<Block> {
    let groups = specimen.groups();
    let rows = (0..specimen.factors.len()).flat_map(|step| {
        let mut rows = groups_at(specimen, models, step);
        // Models stand below each other, group after group.
        rows.sort_by_key(|row| groups.iter().position(|group| *group == row.group));
        rows
    });
    let [force, moment, side] = scales(specimen, models);
    let mut table = Table::of(rows)
        .column(specimen.along.head(), |row| {
            specimen.along.value(specimen.factors[row.step])
        })
        .column("group", |row| row.group.to_owned())
        .column("model", |row| row.model.name.to_owned());
    for ((head, value), scale) in COLUMNS.into_iter().zip([force, force, moment, side, side]) {
        table = table.column(head, |row| match value(row.state) {
            rounding if rounding.abs() < ROUNDING * scale => number(0.0),
            value => number(value),
        });
    }
    let text = "Forces of the supports on the specimen, positive along the axes, and their moments about the middle of the deformed group, positive \
                counter-clockwise. A force prescribed on a grip counts as a support force. Values that are zero except for rounding are shown as 0. \
                Displacements and the middle are means over the length of the group's edges at rest.";
    vec![
        Block::Heading(2, "Forces at the groups".into()),
        Block::Paragraph(text.into()),
        table.block(),
        Block::Paragraph(balance_words(balances)),
    ]
}

/// The same as a table for other programs, with all digits: a force-displacement curve is two of its columns. Of a plate with its width at
/// mid length.
pub fn csv(specimen: &Specimen, models: &Models) -> String {
    let steps = 0..specimen.factors.len();
    let is_plate = specimen.grids().is_some();
    Table::of(steps.flat_map(|step| groups_at(specimen, models, step)))
        .column(specimen.along.column(), |row| {
            specimen.factors[row.step].to_string()
        })
        .column("group", |row| row.group.to_owned())
        .column("model", |row| row.model.name.to_owned())
        .column("force_x_N", |row| row.state.force[0].to_string())
        .column("force_y_N", |row| row.state.force[1].to_string())
        .column("moment_Nmm", |row| row.state.moment.to_string())
        .column("displacement_x_mm", |row| {
            row.state.displacement[0].to_string()
        })
        .column("displacement_y_mm", |row| {
            row.state.displacement[1].to_string()
        })
        .column("strain_energy_mJ", |row| {
            row.solution.energies[row.step].to_string()
        })
        .column_if(is_plate, "mid_width_mm", |row| {
            let field = &row.solution.states[row.step];
            let width = row.solution.mesh.mid_width(&field.displacement);
            width.to_string()
        })
        .csv()
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
    let known = balances.iter().filter_map(|balance| balance.unbalanced);
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
        let most = farthest(groups.map(|group| group.force[0].hypot(group.force[1])));
        let residual = &solution.states[step].residual;
        let largest = farthest(free.iter().map(|unknown| residual[*unknown])).abs();
        (most > 0.0).then(|| largest / most)
    };
    (0..solution.reached()).filter_map(of_step).reduce(larger)
}

/// The balance of each model in a sentence.
pub fn balance_words(balances: &[Balance]) -> String {
    let balances = balances.iter().filter_map(|balance| {
        let unbalanced = balance.unbalanced?;
        let free = or_dash(balance.free_nodes, |residual| format!("{residual:.1e}"));
        Some(format!(
            "{} {unbalanced:.1e} and {free}",
            balance.model.name
        ))
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
    /// Smaller shares of the forces on nodes times the specimen's larger side are discretisation errors.
    const LEAST: f64 = 1e-2;
    let (measured, finest) = (&models.reference.measured, &models.reference.finest);
    let corrected = models.of(ModelKind::Corrected);
    let step = corrected.reached().min(finest.reached()).checked_sub(1)?;
    if measured.quantity != Quantity::Force {
        return None;
    }
    measured.negligible_beside(finest, step)?;
    let of = |solution: &Solution| Some(solution.groups(step)?[measured.index]);
    let (expected, computed) = (of(finest)?, of(corrected)?);
    let [.., side] = scales(specimen, models);
    let is_moment = expected.moment.abs() > LEAST * expected.size.max(expected.rounding) * side;
    is_moment.then(|| {
        format!(
            "the force of the supports on `{}` is none, so that the requirement of the force compares nothing, but their moment at {} \
             is {} N·mm in the corrected field, {} % from the {} N·mm of the finite elements: no requirement judges it, and the finite elements' own \
             error of it is not known",
            measured.group,
            specimen.along.describe(specimen.factors[step]),
            number(computed.moment),
            percent(100.0 * (computed.moment / expected.moment - 1.0).abs()),
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
    let [x, y] = models.on_lattice.springs.mesh.size();
    let side = x.max(y);
    [force, force * side, side]
}

/// The states of all groups in a model at a load factor, for machines; `None` where it has no solution.
pub fn groups(specimen: &Specimen, solution: &Solution, step: usize) -> Option<Value> {
    let states = solution.groups(step)?;
    let group = |(name, state): (&str, &GroupState)| {
        let value = json!({
            "force_N": state.force,
            "moment_Nmm": state.moment,
            "middle_mm": state.position,
            "displacement_mm": state.displacement,
        });
        (name.to_owned(), value)
    };
    let groups = specimen.groups().into_iter().zip(states);
    Some(Value::Object(groups.map(group).collect()))
}

/// The worst balance of every model, for machines.
pub fn balances_json(balances: &[Balance]) -> Map<String, Value> {
    let of_model = |balance: &Balance| {
        let value = json!({ "unbalanced": balance.unbalanced, "free_nodes": balance.free_nodes });
        (balance.model.key.to_owned(), value)
    };
    balances.iter().map(of_model).collect()
}
