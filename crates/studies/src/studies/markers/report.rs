//! The report of a correction.

use super::findings::remarks;
use super::forces::{scale_line, scale_paragraph};
use super::quantities::{largest_correction, largest_error, outliers, residual_rms, used};
use super::{MarkerStudy, reading, refined, verdict};
use crate::error::Diagnostic;
use crate::estimation::{Answer, EdgeCondition, EdgeOutcome, FieldEstimate};
use crate::results::Block;
use crate::statistics::Estimate;
use crate::units::decimals;

/// How many frames are shown in the terminal at the beginning and at the end.
const SHOWN: usize = 12;

/// The figures of the frames with their doubts, for the terminal.
pub fn summary(study: &MarkerStudy, estimates: &[FieldEstimate], doubts: &[Diagnostic]) -> String {
    let mut lines = vec![format!(
        "{}; {}; mesh {}: {}",
        reading::short(&study.understood),
        study.card.name,
        study.mesh_origin,
        study.mesh.describe()
    )];
    lines.extend(frame_lines(study, estimates));
    lines.extend(remarks(study, estimates));
    if let Some((frame, last)) = study.frames_with(estimates).next_back() {
        lines.extend(scale_line(
            frame.number,
            last,
            study.conditions.scale_deviation,
        ));
    }
    // The verdict has lines of its own, and a mistake stands before all figures.
    let verdict = Answer::NotExplained.words();
    for doubt in doubts
        .iter()
        .filter(|doubt| !doubt.message.contains(verdict) && study.mistake.as_ref() != Some(doubt))
    {
        lines.push(format!("doubtful: {}", doubt.message));
        lines.extend(doubt.hint.iter().map(|hint| format!("  {hint}")));
    }
    lines.extend(verdict::lines(study, estimates));
    lines.join("\n") + "\n"
}

/// A head, and a line for each of the first and last frames.
fn frame_lines(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<String> {
    let frames = study.frames_with(estimates);
    let mut lines: Vec<String> = frames
        .map(|(frame, estimate)| match study.coarse {
            None => format!(
                "{:>5}  {:>7}  {:>8}  {:>10.4}  {:>13.4}  {:>10.1}  {:>27.4}",
                frame.number,
                used(estimate),
                outliers(estimate),
                estimate.noise,
                residual_rms(estimate),
                estimate.effective_parameters,
                largest_error(estimate)
            ),
            Some(_) => format!(
                "{:>5}  {:>7}  {:>33.4}  {:>12.4}",
                frame.number,
                used(estimate),
                residual_rms(estimate),
                largest_correction(estimate)
            ),
        })
        .collect();
    let last = lines.len().saturating_sub(SHOWN);
    if last > SHOWN {
        let omitted = format!("    …  {} frames, see the report", last - SHOWN);
        lines.splice(SHOWN..last, [omitted]);
    }
    let head = match study.coarse {
        None => {
            "frame  markers  outliers  noise [mm]  residual [mm]  parameters  largest standard error [mm]"
        }
        Some(_) => "frame    nodes  correction, root mean square [mm]  largest [mm]",
    };
    lines.insert(0, head.to_owned());
    lines
}

/// The interval behind a value, which only an explained field has; `exact` behind a value without uncertainty.
pub(super) fn interval(value: &Estimate, explained: bool, exact: &str) -> String {
    let [low, high] = value.interval;
    match (explained, low < high) {
        (true, true) => format!(" ({} … {})", decimals(low, 6), decimals(high, 6)),
        (false, true) => " (no interval: not explained)".to_owned(),
        _ => exact.to_owned(),
    }
}

/// The tables of a correction.
pub fn blocks(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<Block> {
    let mut blocks = vec![Block::paragraph(format!(
        "{} frames, read as {}. Material {} ({}): {}, {} mm thick. Mesh {}: {}.",
        estimates.len(),
        study.understood.layout,
        study.card.name,
        study.card.title,
        study.card.describe_sheet(),
        study.thickness,
        study.mesh_origin,
        study.mesh.describe()
    ))];
    if study.coarse.is_none() {
        blocks.extend(verdict::blocks(study, estimates));
    }
    blocks.push(Block::heading("Frames"));
    blocks.extend(frames(study, estimates));
    blocks.extend(refined::remark(study, estimates).map(Block::paragraph));
    let remarks = remarks(study, estimates).into_iter();
    blocks.extend(remarks.map(Block::paragraph));
    let last = estimates.last();
    let deviation = study.conditions.scale_deviation;
    let words = last.and_then(|last| scale_paragraph(last, deviation));
    let words = words.into_iter().chain(unknown_edge(study, estimates));
    blocks.extend(words.map(Block::paragraph));
    blocks.extend(reading::blocks(&study.understood));
    if let Some(last) = last {
        blocks.push(Block::heading("Edges of the last frame"));
        blocks.extend(edges(study, last));
    }
    blocks
}

fn unknown_edge(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Option<String> {
    let gap = decimals(study.unknown_gap?, 4);
    let then = if estimates.iter().any(|estimate| estimate.growth > 0.0) {
        format!(
            "intervals of forces and moduli, and errors of displacement and stress, include an edge up to {gap} mm farther out than the mesh"
        )
    } else {
        "no edge is free, so forces and their intervals are those through the outline of the mesh"
            .to_owned()
    };
    Some(format!(
        "The specimen's edge is known only from the markers: {then}."
    ))
}

const EXPLANATION: &str = "Noise is the standard deviation of each component of a marker's displacement; residual is the root \
    mean square of measured minus corrected displacements. Standard errors and intervals (95 %) include the noise \
    and the discretisation error of the mesh, estimated from the same equations on cells half as large (left out on meshes of more \
    than 25,000 cells); they are valid only where the verdict is that the data are explained. An outlier is a \
    marker whose residual normal noise would exceed with a probability below 0.001.";

const TRANSFERRED: &str = "The given field is assumed to be free of noise: edges that are not free keep its displacements, and \
    the interior and the free edges are brought into equilibrium on the new mesh. The correction is the given field minus the \
    corrected one at the given nodes.";

fn frames(study: &MarkerStudy, estimates: &[FieldEstimate]) -> [Block; 2] {
    let frames = study.frames_with(estimates);
    if study.coarse.is_some() {
        let head = [
            "frame",
            "given nodes",
            "correction, root mean square [mm]",
            "largest [mm]",
        ];
        let rows = frames.map(|(frame, estimate)| {
            vec![
                frame.number.to_string(),
                used(estimate).to_string(),
                decimals(residual_rms(estimate), 5),
                decimals(largest_correction(estimate), 5),
            ]
        });
        return [Block::table(&head, rows), Block::paragraph(TRANSFERRED)];
    }
    let head = [
        "frame",
        "markers",
        "outliers",
        "noise [mm]",
        "noise is",
        "residual [mm]",
        "effective parameters",
        "largest standard error [mm]",
        "residual correlation of neighbours (expected for white noise)",
        "steps",
    ];
    let rows = frames.map(|(frame, estimate)| {
        let whiteness = estimate.whiteness.as_ref();
        let correlation = whiteness.map(|white| {
            let (expected, deviation) = (white.expected, white.deviation);
            format!("{:.2} ({expected:.2} ± {deviation:.2})", white.correlation)
        });
        let noise = match estimate.noise_ratio {
            _ if estimate.known_noise => "given",
            Some(_) => "given, scaled",
            None => "estimated",
        };
        let error = estimate
            .has_intervals()
            .then(|| decimals(largest_error(estimate), 5));
        vec![
            frame.number.to_string(),
            used(estimate).to_string(),
            outliers(estimate).to_string(),
            decimals(estimate.noise, 5),
            noise.to_owned(),
            decimals(residual_rms(estimate), 5),
            format!("{:.1}", estimate.effective_parameters),
            error.unwrap_or_else(|| "no interval".to_owned()),
            correlation.unwrap_or_default(),
            estimate.steps.to_string(),
        ]
    });
    [Block::table(&head, rows), Block::paragraph(EXPLANATION)]
}

/// The parameters of the law that were estimated with the field.
pub fn parameters(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
    let rows = study.frames_with(estimates).flat_map(|(frame, estimate)| {
        let explained = estimate.has_intervals();
        estimate.parameters.iter().map(move |(key, unit, value)| {
            let error = explained.then(|| decimals(value.standard_error, 6));
            vec![
                frame.number.to_string(),
                key.to_string(),
                unit.to_string(),
                decimals(value.value, 6),
                error.unwrap_or_default(),
                interval(value, explained, ""),
            ]
        })
    });
    let head = [
        "frame",
        "parameter",
        "unit",
        "value",
        "standard error",
        "95 % interval",
    ];
    Block::table(&head, rows)
}

fn condition(condition: &EdgeCondition, transferred: bool) -> String {
    let words = match (condition, transferred) {
        (EdgeCondition::Free, _) => "free",
        (EdgeCondition::Rigid, false) => "rigid, unknown motion",
        (EdgeCondition::Rigid, true) => "rigid, closest to the given field",
        (EdgeCondition::Unknown, false) => "unknown smooth motion",
        (EdgeCondition::Unknown, true) => "displacements of the given field",
        (EdgeCondition::Known(values), _) => {
            let along = |(axis, value): (&str, &Option<f64>)| match value {
                Some(value) => format!("u{axis} = {value} mm"),
                None => format!("free along {axis}"),
            };
            let [x, y] = values;
            return format!("known: {}, {}", along(("x", x)), along(("y", y)));
        }
    };
    words.to_owned()
}

fn edges(study: &MarkerStudy, last: &FieldEstimate) -> Vec<Block> {
    let row = |outcome: &EdgeOutcome| {
        let probability = outcome.probability.map(|p| format!("{p:.3}"));
        let length = (outcome.length > 0.0).then(|| format!("{:.3}", outcome.length));
        vec![
            outcome.edge.clone(),
            length.unwrap_or_else(|| "on the sheet".to_owned()),
            condition(&outcome.condition, study.coarse.is_some()),
            probability.unwrap_or_default(),
        ]
    };
    let conditions = last.edges.iter().map(row);
    let head = [
        "edge",
        "length [mm]",
        "condition",
        "probability of so large a misfit if the edge is free",
    ];
    if study.coarse.is_some() {
        let rows = conditions.map(|row| row[..3].to_vec());
        return vec![Block::table(&head[..3], rows)];
    }
    let mut blocks = vec![
        Block::table(&head, conditions),
        Block::Paragraph(format!("Data and physics: {}.", last.rule)),
    ];
    if !last.smoothing.is_empty() {
        let head = [
            "edge",
            "axis",
            "weight λ [1/mm²]",
            "effective parameters beyond a straight line",
        ];
        let rows = last.smoothing.iter().map(|smoothing| {
            vec![
                smoothing.edge.clone(),
                ["x", "y"][smoothing.axis].to_owned(),
                format!("{:.3e}", smoothing.weight),
                format!("{:.2}", smoothing.freedom),
            ]
        });
        blocks.push(Block::table(&head, rows));
    }
    blocks
}
