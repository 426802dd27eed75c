//! What a plate is computed for at a glance, and how far its models agree.

use super::problem::Study;
use super::results::{MODELS, Results};
use crate::compare::{Deviation, StepComparison};
use crate::problem::{ClampedPlate, GroupState};
use crate::results::{Block, Deformed, Gauge, Headline, LoadedSheet, or_dash};

/// The force of the moving grip at every stretch and the largest values at the largest one, by the finite elements, or else by the corrected field or
/// the springs.
pub fn headline(study: &Study, results: &Results) -> Vec<Block> {
    let reached = |model: &usize| !results.reached(*model).is_empty();
    let Some(model) = [2, 1, 0].into_iter().find(reached) else {
        return Vec::new();
    };
    let [length, width] = study.problem.size;
    let steps = 0..results.comparison.len();
    let solved = steps.filter_map(|step| Some((step, results.measures(step)[model]?)));
    let states = solved.clone().map(|(step, measures)| {
        let stretch = results.comparison[step].stretch;
        let grip = GroupState {
            force: [measures.force, 0.0],
            displacement: [stretch * length, 0.0],
            ..GroupState::default()
        };
        (ClampedPlate::percent(stretch), vec![grip])
    });
    let size = |step: &usize| results.comparison[*step].stretch.abs();
    let largest = solved.map(|(step, _)| step);
    let largest = largest
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .unwrap_or_default();
    let mesh = results.meshes()[model];
    let mut fields = results.past(model, largest);
    fields.extend(results.models(largest)[model].map(|state| &state.displacement[..]));
    let headline = Headline {
        model: MODELS[model],
        along: "stretch [%]",
        groups: vec!["right grip"],
        steps: states.collect(),
        state: LoadedSheet {
            at: ClampedPlate::describe_step(results.comparison[largest].stretch),
            law: &*study.problem.law,
            deformed: Deformed::elastic(MODELS[model], mesh, fields),
            singular: [[0.0, 0.0], [0.0, width], [length, 0.0], [length, width]].to_vec(),
            gauge: Some(Gauge::middle_half(
                mesh,
                length,
                "the middle half of the length",
            )),
        },
    };
    headline.blocks()
}

/// The deviations of springs and corrected field from the finite elements as a table for a terminal.
pub fn agreement(results: &Results) -> String {
    let head = [
        "stretch [%]",
        "mass-spring: displacement",
        "mass-spring: departure",
        "mass-spring: force",
        "corrected: displacement",
        "corrected: departure",
        "corrected: force",
    ];
    let row = |step: &StepComparison| {
        let at = [ClampedPlate::percent(step.stretch)].into_iter();
        let springs = figures(step.mass_spring.as_ref(), [3, 2, 2]);
        let corrected = figures(step.corrected.as_ref(), [4, 3, 3]);
        at.chain(springs).chain(corrected).collect()
    };
    let table = Block::table(&head, results.comparison.iter().map(row));
    format!("deviation from the finite elements [%]\n{}", table.plain())
}

/// Displacement, departure and force of a deviation with some decimals; dashes where there is none.
fn figures(deviation: Option<&Deviation>, decimals: [usize; 3]) -> [String; 3] {
    let values: [fn(&Deviation) -> f64; 3] = [
        |deviation| deviation.displacement_percent,
        |deviation| deviation.departure_percent,
        |deviation| deviation.force_percent.abs(),
    ];
    [0, 1, 2].map(|which| {
        let digits = decimals[which];
        or_dash(deviation.map(values[which]), |value| {
            format!("{value:.digits$}")
        })
    })
}
