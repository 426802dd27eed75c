//! Forces, moments and displacements of all groups, for reports and for machines.

use serde_json::{Map, Value, json};

use super::problem::Specimen;
use super::results::models::Models;
use crate::problem::{GroupState, Solution};
use crate::results::Block;
use crate::results::number;

/// A table of all groups in all models at all load factors.
pub fn table(specimen: &Specimen, models: &Models) -> Vec<Block> {
    let head = [
        "load factor [–]",
        "group",
        "model",
        "force along x [N]",
        "force along y [N]",
        "moment about the group's middle [N·mm]",
        "mean displacement along x [mm]",
        "mean displacement along y [mm]",
    ];
    let mut rows = Vec::new();
    for (step, factor) in specimen.factors.iter().enumerate() {
        for (index, group) in specimen.groups().iter().enumerate() {
            for model in models.named() {
                if let Some(groups) = model.solution.groups(step) {
                    let names = [
                        factor.to_string(),
                        (*group).to_owned(),
                        model.name.to_owned(),
                    ];
                    rows.push(names.into_iter().chain(cells(&groups[index])).collect());
                }
            }
        }
    }
    let text = "Forces of the supports on the specimen, with the signs of the axes, and their moments about the middle of \
                the group's deformed nodes, counter-clockwise; the force that a grip is given counts as one of its \
                support. Displacements are means over the length of the group's edges.";
    vec![
        Block::Heading(2, "Forces at the groups".into()),
        Block::Paragraph(text.into()),
        Block::table(&head, rows),
        Block::Paragraph(balance(models)),
    ]
}

/// Balances above this are worth a warning.
const UNBALANCED: f64 = 1e-9;

/// The worst balance of all models.
pub fn worst_balance(models: &Models) -> Option<f64> {
    let balances = models.named().into_iter();
    balances
        .filter_map(|model| model.solution.worst_balance())
        .reduce(f64::max)
}

/// The balance of each model in a sentence.
fn balance(models: &Models) -> String {
    let balances = models.named().into_iter();
    let told = balances.filter_map(|model| {
        let balance = model.solution.worst_balance()?;
        Some(format!("{} {balance:.1e}", model.name))
    });
    format!(
        "Balance: supports and loads together leave, at the worst load factor and over the largest force or moment: {}.",
        told.collect::<Vec<_>>().join(", ")
    )
}

/// The warning about forces or moments that do not balance.
pub fn unbalanced(models: &Models) -> Option<String> {
    worst_balance(models).filter(|worst| worst.is_nan() || *worst > UNBALANCED)?;
    Some(format!(
        "Warning: forces or moments do not balance. {}",
        balance(models)
    ))
}

fn cells(state: &GroupState) -> Vec<String> {
    let [x, y] = state.force;
    let [u, v] = state.displacement;
    let all = [x, y, state.moment, u, v];
    all.map(number).to_vec()
}

/// What happens at all groups in a model at a load factor, for machines; `None` where it has no solution.
pub fn groups(specimen: &Specimen, solution: &Solution, step: usize) -> Option<Value> {
    let states = solution.groups(step)?;
    let group = |(name, state): (&str, &GroupState)| {
        let value = json!({
            "force_N": state.force,
            "moment_Nmm": state.moment,
            "displacement_mm": state.displacement,
        });
        (name.to_owned(), value)
    };
    let groups = specimen.groups().into_iter().zip(states);
    Some(Value::Object(groups.map(group).collect()))
}

/// The worst balance of every model, for machines.
pub fn balances(models: &Models) -> Map<String, Value> {
    let named = models.named().into_iter();
    let balances = named.map(|own| {
        let unbalanced = own.solution.worst_balance();
        (own.file.to_owned(), json!({ "unbalanced": unbalanced }))
    });
    balances.collect()
}
