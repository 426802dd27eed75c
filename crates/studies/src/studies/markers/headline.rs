//! What a correction is computed for, at a glance: forces on the edges, parameters of the law, and where stress and stretch are largest.

use std::collections::BTreeSet;

use super::MarkerStudy;
use super::forces::{basis, farther_out, interval, largest, reason};
use super::report::parameters;
use crate::error::Diagnostic;
use crate::estimation::{EdgeForce, FieldEstimate};
use crate::markers::Frame;
use crate::problem::singular_points;
use crate::results::{Block, Deformed, LoadedSheet, Table, or_dash};
use crate::statistics::Estimate;
use crate::units::{decimals, number};

/// Most rows of the table of forces; of more, those of the last frames are listed.
const MOST_ROWS: usize = 12;

/// Forces below this share of a frame's largest are shown as zero.
const NEGLIGIBLE: f64 = 1e-4;

/// Forces with their intervals, the law's parameters, and the largest stress and stretch of the last frame.
pub fn headline(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<Block> {
    let Some((frame, last)) = study.frames_with(estimates).next_back() else {
        return Vec::new();
    };
    let mut blocks: Vec<Block> = study.mistake.iter().map(mistaken).collect();
    blocks.push(forces(study, estimates));
    if study.regressed.is_some() {
        blocks.push(parameters(study, estimates));
    }
    let laws = study.laws(last);
    let sheet = LoadedSheet {
        at: format!("frame {}", frame.number),
        laws: (&laws).into(),
        deformed: Deformed::elastic("corrected", &study.mesh, vec![&last.displacement]),
        singular: singular_points(&study.mesh, &fixed_nodes(last)),
        gauge: None,
    };
    blocks.extend(sheet.largest());
    let notes: Vec<String> = [
        forces_note(study, estimates),
        sheet.note(),
        basis(study, last),
    ]
    .into_iter()
    .flatten()
    .collect();
    blocks.extend((!notes.is_empty()).then(|| Block::Paragraph(notes.join(" "))));
    blocks
}

/// A mistake in the files, which is stated before the figures that follow from it.
pub(in crate::studies) fn mistaken(mistake: &Diagnostic) -> Block {
    let hint = mistake.hint.as_deref().unwrap_or_default();
    Block::Paragraph(format!("Doubtful: {}. Remedy: {hint}.", mistake.message))
}

/// The nodes that are held along both axes: those with reactions.
fn fixed_nodes(estimate: &FieldEstimate) -> BTreeSet<usize> {
    let reactions = estimate.reactions.chunks_exact(2).enumerate();
    let fixed = reactions.filter(|(_, reaction)| reaction.iter().all(|along| *along != 0.0));
    fixed.map(|(node, _)| node).collect()
}

/// The forces of the frames that are listed.
fn listed<'a>(
    study: &'a MarkerStudy,
    estimates: &'a [FieldEstimate],
) -> Vec<(&'a Frame, &'a FieldEstimate, &'a EdgeForce)> {
    let frames = study.frames_with(estimates);
    let all = frames.flat_map(|(frame, estimate)| {
        let forces = estimate.forces.iter();
        forces.map(move |force| (frame, estimate, force))
    });
    let mut all: Vec<_> = all.collect();
    all.split_off(all.len().saturating_sub(MOST_ROWS))
}

fn forces(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Block {
    let listed = listed(study, estimates);
    let has_intervals = listed
        .iter()
        .any(|(_, estimate, _)| estimate.has_intervals());
    let mut table = Table::of(listed)
        .column("frame", |(frame, ..)| frame.number.to_string())
        .column("edge", |(.., force)| force.edge.clone());
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        table = table
            .column(format!("force along {name} [N]"), |(_, estimate, force)| {
                figure(estimate, &force.force[axis])
            })
            .column_if(
                has_intervals,
                "95 % interval [N]",
                |(_, estimate, force)| interval(estimate, &force.force[axis]),
            );
    }
    if let Some(gap) = study.unknown_gap.filter(|_| has_intervals) {
        let head = format!("up to, if the edge lies {} mm farther out [N]", number(gap));
        table = table.column(head, |(_, estimate, force)| {
            let along_axes = force.force.iter();
            let ends = along_axes.filter_map(|along| farther_out(estimate, along));
            or_dash(ends.max_by(|a, b| a.abs().total_cmp(&b.abs())), number)
        });
    }
    table.block()
}

/// A force; zero where it is negligible beside the frame's largest and its interval contains zero.
fn figure(estimate: &FieldEstimate, force: &Estimate) -> String {
    let [low, high] = force.interval;
    let may_be_zero = !estimate.has_intervals() || low * high <= 0.0;
    match force.value {
        small if small.abs() <= NEGLIGIBLE * largest(estimate) && may_be_zero => number(0.0),
        value => decimals(value, 4),
    }
}

fn forces_note(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Option<String> {
    let shown = listed(study, estimates);
    let all: usize = estimates.iter().map(|estimate| estimate.forces.len()).sum();
    let mut notes = Vec::new();
    if shown.len() < all {
        notes.push("Forces of the last frames; `forces.csv` has all.".to_owned());
    }
    let mut without = shown
        .iter()
        .filter(|(_, estimate, _)| !estimate.has_intervals());
    let count = without.clone().count();
    notes.extend(without.next_back().map(|(frame, estimate, _)| {
        let reason = reason(estimate);
        if count == shown.len() {
            format!("No force has an interval: {reason}.")
        } else {
            format!("Frame {} has no interval: {reason}.", frame.number)
        }
    }));
    (!notes.is_empty()).then(|| notes.join(" "))
}
