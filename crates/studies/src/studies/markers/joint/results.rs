//! The files of parameters that were estimated with all frames together: report, card, forces, and a picture of them.

use serde_json::{Map, Value, json};

use super::report::{self, ForceRow};
use super::{CorrectedSpecimen, JointResults, JointStudy, card};
use crate::estimation::{ForceScatter, JointEstimate};
use crate::results::{
    Content, Figure, Finding, Line, LineChart, Material, Outcome, PALETTE, Results, Stroke, object,
};
use crate::statistics::{extremes, larger};
use crate::studies::markers::json::of_estimate;

/// The `kind` of these results.
pub const KIND: &str = "parameters";

/// The results of a joint estimation after so many `seconds`.
pub fn results(
    study: &JointStudy,
    joint: &JointResults,
    specimens: &[CorrectedSpecimen],
    seconds: f64,
) -> Results {
    let rows = report::forces(study, &joint.estimate);
    let warnings = specimens.iter().flat_map(|specimen| {
        let warnings = specimen.study.warnings.iter();
        warnings.map(|warning| format!("{}: {warning}", specimen.name))
    });
    let warnings = warnings.chain(undetermined(&joint.estimate));
    let ended = joint.estimate.ended.iter().map(|reason| {
        format!("the search for the parameters stopped before it converged: {reason}; frames, forces and thickness contradict each other")
    });
    let scatter = force_scatter(&joint.estimate).into_iter();
    let of_specimens = specimens.iter().filter_map(doubt);
    let doubts = ended
        .map(|message| ("search-ended", message))
        .chain(scatter.map(|message| ("force-scatter", message)))
        .chain(of_specimens.map(|message| ("specimen", message)));
    let doubts = doubts.map(|(rule, message)| Finding::doubt(rule, (message, String::new())));
    let estimates = specimens.iter().flat_map(|specimen| &specimen.estimates);
    let card = Content::Text(joint.card.text.clone());
    let outcome = Outcome {
        problem: problem(study, joint, specimens),
        material: Some(Material::from(&joint.card)),
        along: "frame",
        blocks: report::blocks(study, joint, specimens),
        figures: figure(&rows).into_iter().collect(),
        files: vec![
            (card::FILE.to_owned(), card),
            ("forces.csv".to_owned(), Content::Text(table(&rows))),
        ],
        findings: doubts.collect(),
        balance: estimates.map(|estimate| estimate.imbalance).reduce(larger),
        summary: report::summary(study, joint, specimens),
        ..Outcome::default()
    };
    Results {
        name: "parameters".to_owned(),
        title: format!(
            "Parameters of {} from displacement fields",
            joint.card.law_name
        ),
        kind: KIND,
        read_warnings: warnings.collect(),
        outcome,
        seconds,
        ..Results::default()
    }
}

/// Forces that scatter more than their stated deviations.
fn force_scatter(estimate: &JointEstimate) -> Option<String> {
    let ForceScatter { misfit, freedom } = estimate.force_scatter;
    estimate.force_scatter.is_too_large().then(|| {
        format!(
            "the measured forces differ from those of the fields by {:.1} times their standard deviations (χ² = {misfit:.1} for {freedom:.0} \
             degrees of freedom): standard deviations, thickness or law are wrong; intervals assume forces less certain by this factor",
            (misfit / freedom).sqrt()
        )
    })
}

/// The combinations of parameters that the data do not determine, and on which the intervals of the others are conditional.
pub fn undetermined(estimate: &JointEstimate) -> Option<String> {
    let open: Vec<String> = report::undetermined(estimate)
        .map(|direction| report::combination(estimate, direction))
        .collect();
    (!open.is_empty()).then(|| {
        format!(
            "not determined by these frames, and kept as on the card, except for a common factor of all stresses: {}; the other parameters \
             and their intervals assume that this is known: start from a card close to the material, add frames with larger strains or other loading modes, or leave the parameter out of --fit",
            open.join("; ")
        )
    })
}

/// What makes the figures of a specimen doubtful, in one sentence.
fn doubt(specimen: &CorrectedSpecimen) -> Option<String> {
    let estimates = &specimen.estimates;
    let refuted = estimates.iter().filter(|estimate| !estimate.is_explained());
    let name = &specimen.name;
    match (refuted.count(), specimen.doubts) {
        (0, 0) => None,
        (0, count) => Some(format!(
            "{name}: {count} doubts, see specimens/{name}/report.html"
        )),
        (count, _) => Some(format!(
            "{name}: {count} of {} frames are not explained by this law, thickness and conditions, see specimens/{name}/report.html",
            estimates.len()
        )),
    }
}

/// The figures for machines.
fn problem(
    study: &JointStudy,
    joint: &JointResults,
    specimens: &[CorrectedSpecimen],
) -> Map<String, Value> {
    let explained = report::is_explained(joint, specimens);
    let estimate = &joint.estimate;
    let parameters = estimate.with_keys().map(|(parameter, value)| {
        let mut entry = of_estimate(value, explained && value.standard_error > 0.0);
        entry["key"] = parameter.key.into();
        entry["unit"] = parameter.unit().into();
        entry
    });
    let directions = estimate.directions.iter().map(|direction| {
        json!({
            "weights": direction.weights,
            "relative_standard_error": direction.relative_error,
            "is_determined": direction.is_determined(),
        })
    });
    let laws = report::ranked(study, joint).into_iter().map(|law| {
        let [error, residual, criterion] = law.figures.map_or([None; 3], |all| all.map(Some));
        json!({
            "card": law.name,
            "parameters": law.parameters,
            "force_error_percent": error,
            "left_mm": residual,
            "aicc_above_least": criterion,
            "fault": (!law.fault.is_empty()).then_some(law.fault),
        })
    });
    let rows = report::forces(study, estimate);
    let forces = rows.iter().map(|(name, frame, force)| {
        json!({
            "specimen": name,
            "frame": frame,
            "edge": force.measured.edge,
            "axis": (["x", "y"][force.measured.axis]),
            "measured_N": force.measured.force,
            "predicted_N": force.predicted,
        })
    });
    let verdicts = specimens.iter().map(|specimen| {
        let estimates = specimen.estimates.iter();
        let answers = estimates.map(|estimate| estimate.verdict.answer.words());
        json!({ "name": specimen.name, "verdicts": answers.collect::<Vec<_>>() })
    });
    object(json!({
        "is_explained": explained,
        "parameters": parameters.collect::<Vec<_>>(),
        "errors_hold_the_mesh": estimate.holds_mesh_error,
        "combinations": directions.collect::<Vec<_>>(),
        "laws": laws.collect::<Vec<_>>(),
        "forces": forces.collect::<Vec<_>>(),
        "specimens": verdicts.collect::<Vec<_>>(),
        "correlation_between_frames": estimate.common,
        "aicc": estimate.information_criterion(&[]),
        "steps": estimate.steps,
    }))
}

fn table(rows: &[ForceRow]) -> String {
    report::force_table(rows)
        .column("measured_force [N]", |(.., force)| {
            force.measured.force.to_string()
        })
        .column("standard_deviation [N]", |(.., force)| {
            force.measured.standard_deviation.to_string()
        })
        .column("predicted_by_others [N]", |(.., force)| {
            force
                .predicted
                .map_or(String::new(), |force| force.to_string())
        })
        .csv()
}

/// Predicted over measured forces; `None` where none was predicted.
fn figure(rows: &[ForceRow]) -> Option<Figure> {
    const GREY: [u8; 3] = [150, 150, 150];
    let pairs: Vec<(&str, [f64; 2])> = rows
        .iter()
        .filter_map(|(name, _, force)| Some((*name, [force.measured.force, force.predicted?])))
        .collect();
    let [low, high] = extremes(pairs.iter().flat_map(|(_, pair)| *pair));
    if low >= high {
        return None;
    }
    let diagonal = [[low, low], [high, high]];
    let mut lines = vec![Line::new("equal", diagonal, GREY, Stroke::Dashed)];
    for (index, group) in pairs.chunk_by(|a, b| a.0 == b.0).enumerate() {
        let colour = PALETTE[index % PALETTE.len()];
        let points = group.iter().map(|(_, pair)| *pair);
        lines.push(Line::new(group[0].0, points, colour, Stroke::Points));
    }
    let chart = LineChart::new(
        "Forces of left-out frames",
        "measured force [N]",
        "predicted force [N]",
        lines,
    );
    Some(Figure::new(
        "forces.png",
        "Forces predicted by the other frames, over the measured ones.",
        chart,
    ))
}
