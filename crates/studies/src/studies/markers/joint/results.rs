//! What is written of parameters that were found with all frames together: report, card, forces, and a picture of them.

use serde_json::{Map, Value, json};

use super::report::{self, ForceRow};
use super::{CorrectedSpecimen, JointResults, JointStudy, card};
use crate::document::write_records;
use crate::estimation::{ForceScatter, JointEstimate};
use crate::results::{
    Axis, Content, Figure, Line, LineChart, Material, Outcome, PALETTE, Results, Scale, Stroke,
};
use crate::statistics::{extremes, larger};

/// The `kind` of these results.
pub const KIND: &str = "parameters";

/// The results of a joint search after so many `seconds`.
pub fn results(
    study: &JointStudy,
    found: &JointResults,
    specimens: &[CorrectedSpecimen],
    seconds: f64,
) -> Results {
    let rows = report::forces(study, &found.estimate);
    let warnings = specimens.iter().flat_map(|specimen| {
        let told = specimen.study.warnings.iter();
        told.map(|warning| format!("{}: {warning}", specimen.name))
    });
    let warnings = warnings.chain(undetermined(&found.estimate));
    let ended = found.estimate.ended.iter().map(|ended| {
        format!("the search for the parameters stopped before it converged: {ended}; frames, forces and thickness contradict each other")
    });
    let scattered = forces_scatter(&found.estimate);
    let doubts = ended
        .chain(scattered)
        .chain(specimens.iter().filter_map(doubt));
    let estimates = specimens.iter().flat_map(|specimen| &specimen.estimates);
    let outcome = Outcome {
        problem: problem(study, found, specimens),
        material: Some(Material::from(&found.card)),
        along: "frame",
        blocks: report::blocks(study, found, specimens),
        figures: figure(&rows).into_iter().collect(),
        files: vec![
            (
                card::FILE.to_owned(),
                Content::Text(found.card.text.clone()),
            ),
            ("forces.csv".to_owned(), Content::Text(table(&rows))),
        ],
        doubts: doubts.collect(),
        balance: estimates.map(|found| found.imbalance).reduce(larger),
        summary: report::summary(study, found, specimens),
        ..Outcome::default()
    };
    Results {
        name: "parameters".to_owned(),
        title: format!(
            "Parameters of {} from displacement fields",
            found.card.law_name
        ),
        kind: KIND,
        text: String::new(),
        defaults: Vec::new(),
        read_warnings: warnings.collect(),
        outcome,
        seconds,
    }
}

/// Forces that scatter more than they are said to.
fn forces_scatter(estimate: &JointEstimate) -> Option<String> {
    let ForceScatter { misfit, freedom } = estimate.force_scatter;
    estimate.force_scatter.is_too_large().then(|| {
        format!(
            "the measured forces differ from those of the fields by {:.1} times their standard deviations (χ² = {misfit:.1} for {freedom:.0} \
             degrees of freedom): standard deviations, thickness or law are wrong; intervals assume forces less certain by this factor",
            (misfit / freedom).sqrt()
        )
    })
}

/// What the data do not tell of the parameters, and the intervals of the others do not hold.
pub fn undetermined(estimate: &JointEstimate) -> Option<String> {
    let open = estimate
        .directions
        .iter()
        .filter(|own| !own.is_determined());
    let open: Vec<String> = open.map(|own| report::combination(estimate, own)).collect();
    (!open.is_empty()).then(|| {
        format!(
            "not determined by these frames, and kept as on the card: {}; the other parameters and their intervals assume that this is known: start \
             from a card close to the material, add frames with larger strains or other loading modes, or leave the parameter out of --fit",
            open.join("; ")
        )
    })
}

/// What makes the figures of a specimen doubtful, in one sentence.
fn doubt(specimen: &CorrectedSpecimen) -> Option<String> {
    let off = specimen
        .estimates
        .iter()
        .filter(|found| !found.is_explained());
    let (off, all) = (off.count(), specimen.estimates.len());
    let name = &specimen.name;
    match (off, specimen.doubts) {
        (0, 0) => None,
        (0, count) => Some(format!(
            "{name}: {count} doubts, see specimens/{name}/report.html"
        )),
        (off, _) => Some(format!(
            "{name}: {off} of {all} frames are not explained by this law, thickness and conditions, see specimens/{name}/report.html"
        )),
    }
}

/// For machines.
fn problem(
    study: &JointStudy,
    found: &JointResults,
    specimens: &[CorrectedSpecimen],
) -> Map<String, Value> {
    let explained = report::is_explained(found, specimens);
    let estimate = &found.estimate;
    let parameters = estimate.with_keys().map(|(parameter, value)| {
        let determined = explained && value.standard_error > 0.0;
        json!({
            "key": parameter.key,
            "unit": parameter.unit(),
            "value": value.value,
            "standard_error": determined.then_some(value.standard_error),
            "interval": determined.then_some(value.interval),
        })
    });
    let directions = estimate.directions.iter().map(|direction| {
        json!({
            "weights": direction.weights,
            "relative_standard_error": direction.relative_error,
            "is_determined": direction.is_determined(),
        })
    });
    let laws = report::ranked(study, found).into_iter().map(|law| {
        let [error, left, criterion] = law.figures.map_or([None; 3], |figures| figures.map(Some));
        json!({
            "card": law.name,
            "parameters": law.parameters,
            "force_error_percent": error,
            "left_mm": left,
            "aicc_above_least": criterion,
            "fault": (!law.fault.is_empty()).then_some(law.fault),
        })
    });
    let forces = report::forces(study, estimate);
    let forces = forces.iter().map(|(name, frame, force)| {
        json!({
            "specimen": name,
            "frame": frame,
            "edge": force.measured.edge,
            "axis": (["x", "y"][force.measured.axis]),
            "measured_N": force.measured.force,
            "predicted_N": force.predicted,
        })
    });
    let answers = specimens.iter().map(|specimen| {
        let answers = specimen
            .estimates
            .iter()
            .map(|found| found.verdict.answer.words());
        json!({ "name": specimen.name, "verdicts": answers.collect::<Vec<_>>() })
    });
    let all = json!({
        "is_explained": explained,
        "parameters": parameters.collect::<Vec<_>>(),
        "errors_hold_the_mesh": estimate.holds_mesh_error,
        "combinations": directions.collect::<Vec<_>>(),
        "laws": laws.collect::<Vec<_>>(),
        "forces": forces.collect::<Vec<_>>(),
        "specimens": answers.collect::<Vec<_>>(),
        "correlation_between_frames": estimate.common,
        "aicc": estimate.information_criterion(),
        "steps": estimate.steps,
    });
    all.as_object().cloned().unwrap_or_default()
}

fn table(rows: &[ForceRow]) -> String {
    let head = [
        "specimen",
        "frame",
        "edge",
        "axis",
        "measured_force [N]",
        "standard_deviation [N]",
        "predicted_by_others [N]",
    ];
    let line = |(name, frame, force): &ForceRow| {
        let measured = &force.measured;
        vec![
            (*name).to_owned(),
            frame.to_string(),
            measured.edge.clone(),
            ["x", "y"][measured.axis].to_owned(),
            measured.force.to_string(),
            measured.standard_deviation.to_string(),
            force
                .predicted
                .map_or(String::new(), |there| there.to_string()),
        ]
    };
    let head = head.map(str::to_owned).to_vec();
    write_records(std::iter::once(head).chain(rows.iter().map(line)))
}

/// Predicted over measured forces; `None` where none was predicted.
fn figure(rows: &[ForceRow]) -> Option<Figure> {
    let mut lines: Vec<Line> = Vec::new();
    let pairs: Vec<(&str, [f64; 2])> = rows
        .iter()
        .filter_map(|(name, _, force)| Some((*name, [force.measured.force, force.predicted?])))
        .collect();
    let [low, high] = extremes(pairs.iter().flat_map(|(_, pair)| *pair));
    if low >= high {
        return None;
    }
    let grey = [150, 150, 150];
    lines.push(Line::new(
        "equal",
        [[low, low], [high, high]],
        grey,
        Stroke::Dashed,
    ));
    for (index, group) in pairs.chunk_by(|a, b| a.0 == b.0).enumerate() {
        let colour = PALETTE[index % PALETTE.len()];
        let points = group.iter().map(|(_, pair)| *pair);
        lines.push(Line::new(group[0].0, points, colour, Stroke::Points));
    }
    let axis = |label: &str| Axis::new(label, Scale::Linear);
    let chart = LineChart::new(
        "Forces of left-out frames",
        axis("measured force [N]"),
        axis("predicted force [N]"),
        lines,
    );
    Some(Figure::new(
        "forces.png",
        "Forces predicted by the other frames, over the measured ones.",
        chart,
    ))
}
