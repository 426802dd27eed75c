//! The report of a correction.

use super::force_words::{basis, newtons};
use super::{noise, reading, refined, scale, verdict};
use crate::error::Diagnostic;
use crate::estimation::{Answer, EdgeCondition, EdgeOutcome, FieldEstimate};
use crate::results::Block;
use crate::statistics::Estimate;
use crate::studies::markers::MarkerStudy;
use crate::units::decimals;

/// How many frames are shown in the terminal at the begin and at the end.
const SHOWN: usize = 12;

/// The figures of the frames with what makes them doubtful, for the terminal.
pub fn summary(field: &MarkerStudy, estimates: &[FieldEstimate], doubts: &[Diagnostic]) -> String {
    let mut text = format!(
        "{}; {}; mesh {}: {}\n",
        reading::short(&field.understood),
        field.card.name,
        field.mesh_origin,
        field.mesh.describe()
    );
    text += match field.coarse {
        None => {
            "frame  markers  outliers  noise [mm]  residual [mm]  parameters  largest standard error [mm]\n"
        }
        Some(_) => "frame    nodes  correction, root mean square [mm]  largest [mm]\n",
    };
    text += &rows(field, estimates);
    for remark in noise::remarks(field, estimates) {
        text += &format!("{remark}\n");
    }
    for (frame, estimate) in field.series.frames.iter().zip(estimates) {
        for (key, unit, found) in &estimate.parameters {
            let interval = interval(found, estimate.has_intervals(), 6);
            text += &format!(
                "{key} in frame {}: {} {unit}{interval}\n",
                frame.number,
                decimals(found.value, 6)
            );
        }
    }
    if let (Some(frame), Some(last)) = (field.series.frames.last(), estimates.last()) {
        for force in &last.forces {
            let [x, y] = &force.force;
            text += &format!(
                "force on {} in frame {}: x {}, y {}\n",
                force.edge,
                frame.number,
                newtons(field, last, x),
                newtons(field, last, y)
            );
        }
        text += &basis(field, last).map_or(String::new(), |words| format!("{words}\n"));
        let deviation = field.conditions.scale_deviation;
        text += &scale::line(frame.number, last, deviation).unwrap_or_default();
    }
    // The verdict has lines of its own.
    let verdict = Answer::NotExplained.words();
    let others = doubts.iter();
    for doubt in others.filter(|doubt| !doubt.message.contains(verdict)) {
        let hint = doubt.hint.as_deref().map(|hint| format!("  {hint}\n"));
        text += &format!("doubtful: {}\n{}", doubt.message, hint.unwrap_or_default());
    }
    text + &verdict::summary(field, estimates)
}

/// A row for each of the first and last frames.
fn rows(field: &MarkerStudy, estimates: &[FieldEstimate]) -> String {
    let mut text = String::new();
    let left_out = SHOWN..estimates.len().saturating_sub(SHOWN);
    for (index, (frame, estimate)) in field.series.frames.iter().zip(estimates).enumerate() {
        if left_out.contains(&index) {
            if index == left_out.start {
                text += &format!("    …  {} frames, see the report\n", left_out.len());
            }
            continue;
        }
        text += &match field.coarse {
            None => format!(
                "{:>5}  {:>7}  {:>8}  {:>10.4}  {:>13.4}  {:>10.1}  {:>27.4}\n",
                frame.number,
                used(estimate),
                outliers(estimate),
                estimate.noise,
                residual_rms(estimate),
                estimate.effective_parameters,
                largest_error(estimate)
            ),
            Some(_) => format!(
                "{:>5}  {:>7}  {:>33.4}  {:>12.4}\n",
                frame.number,
                used(estimate),
                residual_rms(estimate),
                largest_correction(estimate)
            ),
        };
    }
    text
}

/// The interval behind a value, which only an explained field has.
fn interval(found: &Estimate, explained: bool, digits: usize) -> String {
    let [low, high] = found.interval;
    let written = [low, high].map(|end| decimals(end, digits));
    match (explained, low < high) {
        (true, true) => format!(" ({})", written.join(" … ")),
        (false, true) => " (no interval: not explained)".to_owned(),
        _ => String::new(),
    }
}

/// How many markers lie on the mesh.
pub(super) fn used(estimate: &FieldEstimate) -> usize {
    estimate.markers.iter().flatten().count()
}

pub(super) fn outliers(estimate: &FieldEstimate) -> usize {
    let markers = estimate.markers.iter().flatten();
    markers.filter(|marker| marker.outlier).count()
}

/// Root mean square of the components of what is left of the markers.
pub(super) fn residual_rms(estimate: &FieldEstimate) -> f64 {
    let residuals = estimate
        .markers
        .iter()
        .flatten()
        .flat_map(|marker| marker.residual);
    let squares: f64 = residuals.map(|r| r * r).sum();
    (squares / (2 * used(estimate).max(1)) as f64).sqrt()
}

/// The largest distance of the given field from the corrected one at its nodes.
pub(super) fn largest_correction(estimate: &FieldEstimate) -> f64 {
    let markers = estimate.markers.iter().flatten();
    let lengths = markers.map(|marker| marker.residual[0].hypot(marker.residual[1]));
    lengths.fold(0.0, f64::max)
}

pub(super) fn largest_error(estimate: &FieldEstimate) -> f64 {
    let pairs = estimate.displacement_error.chunks_exact(2);
    pairs.map(|pair| pair[0].hypot(pair[1])).fold(0.0, f64::max)
}

fn condition(condition: &EdgeCondition) -> String {
    match condition {
        EdgeCondition::Free => "free".into(),
        EdgeCondition::Rigid => "rigid, unknown motion".into(),
        EdgeCondition::Unknown => "unknown smooth motion".into(),
        EdgeCondition::Known([x, y]) => {
            let along = |axis: &str, value: &Option<f64>| match value {
                Some(value) => format!("u{axis} = {value} mm"),
                None => format!("free along {axis}"),
            };
            format!("known: {}, {}", along("x", x), along("y", y))
        }
    }
}

/// The tables of a correction.
pub fn blocks(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<Block> {
    let (frames, explanation) = match field.coarse {
        None => (frames(field, estimates), EXPLANATION),
        Some(_) => (transferred_frames(field, estimates), TRANSFERRED),
    };
    let mut blocks = vec![
        Block::paragraph(format!(
            "{} frames, read as {}. Material {} ({}), {} mm thick. Mesh {}: {}.",
            estimates.len(),
            field.understood.layout,
            field.card.name,
            field.card.title,
            field.thickness,
            field.mesh_origin,
            field.mesh.describe()
        )),
        Block::heading("Frames"),
        frames,
        Block::paragraph(explanation),
    ];
    let understood = reading::blocks(&field.understood);
    blocks.splice(1..1, understood);
    blocks.extend(refined::told(field, estimates).map(Block::paragraph));
    let remarks = noise::remarks(field, estimates);
    blocks.extend(remarks.into_iter().map(Block::paragraph));
    if field.coarse.is_none() {
        blocks.extend(verdict::blocks(field, estimates));
    }
    blocks.extend([
        Block::heading("Forces on the edges"),
        forces(field, estimates),
    ]);
    let basis = estimates.last().and_then(|last| basis(field, last));
    blocks.extend(basis.map(Block::paragraph));
    let deviation = field.conditions.scale_deviation;
    let scale = estimates
        .last()
        .and_then(|last| scale::paragraph(last, deviation));
    blocks.extend(scale.map(Block::paragraph));
    blocks.extend(field.unknown_gap.map(|gap| {
        let free = estimates.iter().any(|estimate| estimate.growth > 0.0);
        let then = if free { format!(
            "intervals of forces and moduli, and errors of displacement and stress, include an edge up to {} mm farther out than the mesh",
            decimals(gap, 4)
        ) } else { "no edge is free, so forces and their intervals are those through the outline of the mesh".to_owned() };
        Block::paragraph(format!("The specimen's edge is known only from the markers: {then}."))
    }));
    if field.regressed.is_some() {
        blocks.push(Block::heading("Parameters of the law"));
        blocks.push(parameters(field, estimates));
    }
    if let Some(last) = estimates.last() {
        blocks.push(Block::heading("Edges of the last frame"));
        blocks.extend(edges(field, last));
    }
    blocks
}

const EXPLANATION: &str = "Noise is the standard deviation of each component of a marker's displacement; residual is the root \
    mean square of measured minus corrected displacements. Standard errors and intervals (95 %) include the noise \
    and the discretisation error of the mesh, estimated from the same equations on cells half as large (left out on meshes of more \
    than 25,000 cells); they are valid only where the verdict is that the data are explained. An outlier is a \
    marker whose residual normal noise would exceed with a probability below 0.001.";

const TRANSFERRED: &str = "The given field is assumed to be free of noise: edges that are not free keep its displacements, and \
    the interior and the free edges are brought into equilibrium on the new mesh. The correction is the given field minus the \
    corrected one at the given nodes.";

fn transferred_frames(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
    let head = [
        "frame",
        "given nodes",
        "correction, root mean square [mm]",
        "largest [mm]",
    ];
    let frames = field.series.frames.iter().zip(estimates);
    let rows = frames.map(|(frame, estimate)| {
        vec![
            frame.number.to_string(),
            used(estimate).to_string(),
            decimals(residual_rms(estimate), 5),
            decimals(largest_correction(estimate), 5),
        ]
    });
    Block::table(&head, rows)
}

fn frames(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
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
    let frames = field.series.frames.iter().zip(estimates);
    let rows = frames.map(|(frame, estimate)| {
        vec![
            frame.number.to_string(),
            used(estimate).to_string(),
            outliers(estimate).to_string(),
            decimals(estimate.noise, 5),
            if estimate.known_noise {
                "given"
            } else if estimate.noise_ratio.is_some() {
                "given, scaled"
            } else {
                "estimated"
            }
            .to_owned(),
            decimals(residual_rms(estimate), 5),
            format!("{:.1}", estimate.effective_parameters),
            if estimate.has_intervals() {
                decimals(largest_error(estimate), 5)
            } else {
                "no interval".to_owned()
            },
            estimate.whiteness.as_ref().map_or(String::new(), |found| {
                format!(
                    "{:.2} ({:.2} ± {:.2})",
                    found.correlation, found.expected, found.deviation
                )
            }),
            estimate.steps.to_string(),
        ]
    });
    Block::table(&head, rows)
}

fn forces(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
    let frames = field.series.frames.iter().zip(estimates);
    let rows = frames.flat_map(|(frame, estimate)| {
        estimate.forces.iter().map(move |force| {
            let [x, y] = &force.force;
            vec![
                frame.number.to_string(),
                force.edge.clone(),
                newtons(field, estimate, x),
                newtons(field, estimate, y),
            ]
        })
    });
    Block::table(&["frame", "edge", "force along x", "force along y"], rows)
}

/// The parameters of the law that were found with the field.
fn parameters(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
    let frames = field.series.frames.iter().zip(estimates);
    let rows = frames.flat_map(|(frame, estimate)| {
        estimate.parameters.iter().map(move |(key, unit, found)| {
            let error = if estimate.has_intervals() {
                decimals(found.standard_error, 6)
            } else {
                String::new()
            };
            vec![
                frame.number.to_string(),
                key.to_string(),
                unit.to_string(),
                decimals(found.value, 6),
                error,
                interval(found, estimate.has_intervals(), 6),
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

fn edges(field: &MarkerStudy, last: &FieldEstimate) -> Vec<Block> {
    let known = |known: &EdgeCondition| match (known, &field.coarse) {
        (EdgeCondition::Unknown, Some(_)) => "displacements of the given field".to_owned(),
        (EdgeCondition::Rigid, Some(_)) => "rigid, closest to the given field".to_owned(),
        _ => condition(known),
    };
    let row = |outcome: &EdgeOutcome| {
        let chosen = outcome.probability.map(|p| format!("{p:.3}"));
        vec![
            outcome.edge.clone(),
            if outcome.length > 0.0 {
                format!("{:.3}", outcome.length)
            } else {
                "on the sheet".to_owned()
            },
            known(&outcome.condition),
            chosen.unwrap_or_default(),
        ]
    };
    let conditions = last.edges.iter().map(row);
    let head = [
        "edge",
        "length [mm]",
        "condition",
        "probability of so large a misfit if the edge is free",
    ];
    if field.coarse.is_some() {
        return vec![Block::table(
            &head[..3],
            conditions.map(|row| row[..3].to_vec()),
        )];
    }
    let smooth = last.smoothing.iter().map(|smoothing| {
        vec![
            smoothing.edge.clone(),
            ["x", "y"][smoothing.axis].to_owned(),
            format!("{:.3e}", smoothing.weight),
            format!("{:.2}", smoothing.freedom),
        ]
    });
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
        blocks.push(Block::table(&head, smooth));
    }
    blocks
}
