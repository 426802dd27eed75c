//! The report of a correction.

use super::findings::{MISTAKE, NOT_EXPLAINED, remarks};
use super::forces::{scale_line, scale_paragraph};
use super::quantities::{largest_correction, largest_error, outliers, residual_rms, used};
use super::{MarkerStudy, refined, verdict};
use crate::estimation::{EdgeCondition, FieldEstimate};
use crate::markers::Understood;
use crate::results::{Block, Finding, Table};
use crate::statistics::Estimate;
use crate::units::decimals;

/// How many frames are shown in the terminal at the beginning and at the end.
const SHOWN: usize = 12;

/// The figures of the frames with their doubts, for the terminal.
pub fn summary(study: &MarkerStudy, estimates: &[FieldEstimate], doubts: &[Finding]) -> String {
    let mut lines = vec![format!(
        "{}; {}; mesh {}: {}",
        layout(&study.understood),
        study.cards().words(&study.mesh, |card| card.name.clone()),
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
    let listed_elsewhere = |doubt: &&Finding| [NOT_EXPLAINED, MISTAKE].contains(&doubt.rule);
    for doubt in doubts.iter().filter(|doubt| !listed_elsewhere(doubt)) {
        lines.push(format!("doubtful: {}", doubt.message));
        lines.extend((!doubt.remedy.is_empty()).then(|| format!("  {}", doubt.remedy)));
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
        "{} frames, read as {}. Material {}, {} mm thick. Mesh {}: {}.",
        estimates.len(),
        study.understood.layout,
        study.cards().words(&study.mesh, |card| {
            format!("{} ({}): {}", card.name, card.title, card.describe_sheet())
        }),
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
    let scale = last.and_then(|last| scale_paragraph(last, deviation));
    let words = scale.into_iter().chain(unknown_edge(study, estimates));
    blocks.extend(words.map(Block::paragraph));
    blocks.extend(reading_blocks(&study.understood));
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
    marker whose residual normal noise and that error would exceed with a probability below 0.001.";

const TRANSFERRED: &str = "The given field is assumed to be free of noise: edges that are not free keep its displacements, and \
    the interior and the free edges are brought into equilibrium on the new mesh. The correction is the given field minus the \
    corrected one at the given nodes.";

fn frames(study: &MarkerStudy, estimates: &[FieldEstimate]) -> [Block; 2] {
    let frames = study.frames_with(estimates);
    if study.coarse.is_some() {
        let table = Table::of(frames)
            .column("frame", |(frame, _)| frame.number.to_string())
            .column("given nodes", |(_, estimate)| used(estimate).to_string())
            .column("correction, root mean square [mm]", |(_, estimate)| {
                decimals(residual_rms(estimate), 5)
            })
            .column("largest [mm]", |(_, estimate)| {
                decimals(largest_correction(estimate), 5)
            });
        return [table.block(), Block::paragraph(TRANSFERRED)];
    }
    let noise = |estimate: &FieldEstimate| match estimate.noise_ratio {
        _ if estimate.known_noise => "given",
        Some(_) => "given, scaled",
        None => "estimated",
    };
    let table = Table::of(frames)
        .column("frame", |(frame, _)| frame.number.to_string())
        .column("markers", |(_, estimate)| used(estimate).to_string())
        .column("outliers", |(_, estimate)| outliers(estimate).to_string())
        .column("noise [mm]", |(_, estimate)| decimals(estimate.noise, 5))
        .column("noise is", |(_, estimate)| noise(estimate).to_owned())
        .column("residual [mm]", |(_, estimate)| {
            decimals(residual_rms(estimate), 5)
        })
        .column("effective parameters", |(_, estimate)| {
            format!("{:.1}", estimate.effective_parameters)
        })
        .column("largest standard error [mm]", |(_, estimate)| {
            let error = estimate.has_intervals().then(|| largest_error(estimate));
            error.map_or("no interval".to_owned(), |error| decimals(error, 5))
        })
        .column("steps", |(_, estimate)| estimate.steps.to_string());
    [table.block(), Block::paragraph(EXPLANATION)]
}

/// The parameters of the law that were estimated with the field.
pub fn parameters(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
    let rows = study.frames_with(estimates).flat_map(|(frame, estimate)| {
        let parameters = estimate.parameters.iter();
        parameters.map(move |parameter| (frame.number, estimate.has_intervals(), parameter))
    });
    Table::of(rows)
        .column("frame", |(frame, ..)| frame.to_string())
        .column("parameter", |(.., (key, ..))| key.to_string())
        .column("unit", |(.., (_, unit, _))| unit.to_string())
        .column("value", |(.., (.., value))| decimals(value.value, 6))
        .column("standard error", |(_, explained, (.., value))| {
            let error = explained.then(|| decimals(value.standard_error, 6));
            error.unwrap_or_default()
        })
        .column("95 % interval", |(_, explained, (.., value))| {
            interval(value, *explained, "")
        })
        .block()
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
    let is_transferred = study.coarse.is_some();
    let conditions = Table::of(&last.edges)
        .column("edge", |edge| edge.edge.clone())
        .column("length [mm]", |edge| match edge.length {
            length if length > 0.0 => format!("{length:.3}"),
            _ => "on the sheet".to_owned(),
        })
        .column("condition", |edge| {
            condition(&edge.condition, is_transferred)
        })
        .column_if(
            !is_transferred,
            "probability of so large a misfit if the edge is free",
            |edge| {
                edge.probability
                    .map_or(String::new(), |p| format!("{p:.3}"))
            },
        );
    let mut blocks = vec![conditions.block()];
    if is_transferred {
        return blocks;
    }
    blocks.push(Block::Paragraph(format!(
        "Data and physics: {}.",
        last.rule
    )));
    let smoothing = Table::of(&last.smoothing)
        .column("edge", |smoothing| smoothing.edge.clone())
        .column("axis", |smoothing| ["x", "y"][smoothing.axis].to_owned())
        .column("weight λ [1/mm²]", |smoothing| {
            format!("{:.3e}", smoothing.weight)
        })
        .column("effective parameters beyond a straight line", |smoothing| {
            format!("{:.2}", smoothing.freedom)
        });
    blocks.extend((!smoothing.is_empty()).then(|| smoothing.block()));
    blocks
}

/// Columns, units, origin and axes of files, as far as there is something to say.
fn reading_blocks(understood: &Understood) -> Vec<Block> {
    if understood.columns.is_empty() && !understood.turned_up {
        return Vec::new();
    }
    let encoding = understood.encoding.map(|name| format!("Text in {name}. "));
    let table = understood.part.as_ref();
    let part = table.map(|name| format!("The table `{name}` of the file. "));
    let mut words = encoding.or(part).unwrap_or_default();
    words += understood.axes();
    if let Some(positions) = understood.positions() {
        words += &format!(" {positions}");
    }
    let mut blocks = vec![
        Block::heading("How the file was read"),
        Block::paragraph(words),
    ];
    if !understood.columns.is_empty() {
        let table = Table::of(&understood.columns)
            .column("quantity", |taken| taken.holds.to_owned())
            .column("column", |taken| taken.head.clone())
            .column("unit [mm]", |taken| {
                taken.unit.map_or(String::new(), |unit| unit.to_string())
            })
            .column("source of the unit", |taken| taken.unit_source.to_owned());
        blocks.push(table.block());
    }
    let sketch = understood.sketch();
    blocks.extend(sketch.map(|sketch| Block::Code("text", sketch.to_owned())));
    blocks
}

/// The layout, for the terminal.
fn layout(understood: &Understood) -> String {
    let turned = if understood.turned_up {
        ", y turned up"
    } else {
        ""
    };
    let table = understood.part.as_ref();
    let part = table.map_or(String::new(), |name| format!(" of `{name}`"));
    format!("{}{part}{turned}", understood.layout)
}
