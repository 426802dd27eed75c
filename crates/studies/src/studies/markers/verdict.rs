//! The verdict on every frame, for the terminal, the report and machines.

use serde_json::{Value, json};

use super::MarkerStudy;
use super::finding::span;
use crate::estimation::{
    Alternative, Answer, FieldEstimate, MovedPart, NoiseCorrelation, Reason, Trial, Verdict,
};
use crate::markers::{Frame, Understood};
use crate::results::{Block, Table};
use crate::statistics::extremes;
use crate::units::decimals;

/// The largest number of alternatives that are shown in the terminal.
const SHOWN: usize = 5;

/// The answers that frames have, the worst first.
const ANSWERS: [Answer; 4] = [
    Answer::NotExplained,
    Answer::Undecided,
    Answer::Correlated,
    Answer::Explained,
];

/// The worst answer of all frames.
pub fn worst(estimates: &[FieldEstimate]) -> Answer {
    let answers = estimates.iter().map(|estimate| estimate.verdict.answer);
    answers.max().unwrap_or_default()
}

fn last_with<'a>(
    study: &'a MarkerStudy,
    estimates: &'a [FieldEstimate],
    answer: Answer,
) -> Option<(&'a Frame, &'a FieldEstimate)> {
    let mut frames = study.frames_with(estimates);
    frames.rfind(|(_, estimate)| estimate.verdict.answer == answer)
}

/// The verdict on all frames, and what would explain the last one that is not.
pub fn lines(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<String> {
    if study.coarse.is_some() {
        return Vec::new();
    }
    let mut lines = answers(study, estimates);
    for answer in [Answer::Undecided, Answer::NotExplained] {
        let last = last_with(study, estimates, answer);
        lines.extend(last.map(|(frame, estimate)| {
            format!(
                "frame {}: {}",
                frame.number,
                reasons(&estimate.verdict).join("; ")
            )
        }));
    }
    let Some((_, estimate)) = last_with(study, estimates, Answer::NotExplained) else {
        return lines;
    };
    lines.extend(estimate.verdict.worst.map(|worst| {
        let [x, y] = worst.position.map(|position| decimals(position, 4));
        let [ux, uy] = worst.misfit.map(|misfit| decimals(misfit, 5));
        format!("largest misfit near ({x}, {y}) mm: mean residual ({ux}, {uy}) mm")
    }));
    let trials = &estimate.verdict.trials;
    if trials.is_empty() {
        let words = if estimate.holds_mesh_error {
            "no alternative tried (edges, forces, stiffness, law) improves the fit"
        } else {
            "no alternative tried (edges, forces, stiffness, law) improves the fit; the mesh's discretisation error could not be estimated"
        };
        lines.push(words.to_owned());
    }
    let shown = &trials[..trials.len().min(SHOWN)];
    let has_residual = shown.iter().any(|trial| trial.residual_rms.is_finite());
    let residual_rms = estimate.verdict.residual_rms.filter(|_| has_residual);
    lines.extend(residual_rms.map(|residual_rms| {
        format!(
            "without outliers the residual is {} mm; in one linearised step it would be",
            decimals(residual_rms, 5)
        )
    }));
    lines.extend(shown.iter().map(|trial| {
        let words = trial_words(study, trial);
        match residual(trial.residual_rms) {
            Some(residual) => format!("{residual} mm with {words}"),
            None => format!("the measured force would agree with {words}"),
        }
    }));
    lines
}

/// A line for each answer that frames have, with their numbers.
fn answers(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<String> {
    let frames = study.frames_with(estimates);
    let all: Vec<(usize, &Verdict)> = frames
        .map(|(frame, estimate)| (frame.number, &estimate.verdict))
        .collect();
    let line = |answer: Answer| {
        let runs = all.chunk_by(|(_, a), (_, b)| a.answer == b.answer);
        let runs: Vec<_> = runs.filter(|run| run[0].1.answer == answer).collect();
        let count: usize = runs.iter().map(|run| run.len()).sum();
        let frames = if count == 1 { "frame" } else { "frames" };
        let words: Vec<String> = runs.into_iter().map(|run| run_words(run, answer)).collect();
        (count > 0).then(|| format!("verdict, {frames} {}: {}", words.join(", "), answer.words()))
    };
    ANSWERS.into_iter().filter_map(line).collect()
}

/// Frames with one answer, one after the other: `4`, `4, 9`, `4 to 34`, and over which lengths their noise correlates.
fn run_words(run: &[(usize, &Verdict)], answer: Answer) -> String {
    let numbers = span(&run.iter().map(|(number, _)| *number).collect::<Vec<_>>());
    let lengths = run.iter().filter_map(|(_, verdict)| verdict.correlation);
    let [low, high] = extremes(lengths.map(|one| one.length));
    match (answer, low < high) {
        (Answer::Correlated, true) => format!("{numbers} (over {low:.3} to {high:.3} mm)"),
        (Answer::Correlated, false) => format!("{numbers} (over {low:.3} mm)"),
        _ => numbers,
    }
}

pub(super) fn reasons(verdict: &Verdict) -> Vec<String> {
    verdict.reasons.iter().copied().map(Reason::words).collect()
}

/// A residual in mm; `None` where it is not known.
fn residual(rms: f64) -> Option<String> {
    rms.is_finite().then(|| decimals(rms, 5))
}

/// An alternative in words, with the edge gap to state where it moves an outline that was made from markers.
fn trial_words(study: &MarkerStudy, trial: &Trial) -> String {
    let words = trial.alternative.words();
    let places = may_hold_places_in_frame(&trial.alternative, &study.understood);
    match other_gap(study, &trial.alternative) {
        Some(gap) => format!("{words} (about --edge-gap \"{gap} mm\")"),
        None if places => format!("{words} (or positions in the frame: --places frame)"),
        None => words,
    }
}

/// Whether an alternative may stand for positions of a table that are those in the frame instead of those at rest: strains relative to them
/// are too small where they are positive and too large where they are negative, as of a material that contracts more along one axis.
fn may_hold_places_in_frame(alternative: &Alternative, understood: &Understood) -> bool {
    let is_of_table = !understood.columns.is_empty();
    matches!(alternative, Alternative::Direction) && is_of_table && !understood.taken_to_rest
}

/// The edge gap to state instead, where an alternative moves the outline.
pub(super) fn other_gap(study: &MarkerStudy, alternative: &Alternative) -> Option<String> {
    let Alternative::MovedEdge {
        part: MovedPart::Outline,
        outwards,
    } = alternative
    else {
        return None;
    };
    let stated = study.conditions.edge_gap.or(study.unknown_gap.map(|_| 0.0));
    let gap = (stated? + outwards).max(0.0);
    // One decimal, or the first digit of a smaller gap.
    let decimals = if gap > 1e-6 {
        (-gap.log10().floor()).max(1.0) as usize
    } else {
        1
    };
    Some(format!("{gap:.decimals$}"))
}

const EXPLANATION: &str = "Explained: the residuals of the markers are white noise. Explained with correlated noise: they correlate \
    between neighbours as noise of image correlation does, with the length at which the correlation has fallen to 1/e; the \
    intervals include that. The data cannot judge: the residuals correlate so far that they are worth fewer than a hundred independent \
    values, too few to tell noise from a misfit; intervals take them for noise of the widest correlation that they allow. Or gross errors \
    make up the noise, or only the markers show the free edges, which they contradict; then there are no intervals. Not explained: an alternative model reduces the misfit by more than noise could, \
    the residuals correlate between neighbours and are similar from frame to frame, or a measured force is contradicted. Standard \
    errors and intervals are then meaningless and are not given.";

/// The verdict on every frame, and what would explain the last one that is not.
pub fn blocks(study: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<Block> {
    let mut verdicts = estimates.iter().map(|estimate| &estimate.verdict);
    let is_correlated = verdicts
        .clone()
        .any(|verdict| verdict.correlation.is_some());
    let has_reasons = verdicts.any(|verdict| !verdict.reasons.is_empty());
    let of = |estimate: &FieldEstimate, words: fn(NoiseCorrelation) -> String| {
        estimate.verdict.correlation.map_or(String::new(), words)
    };
    let table = Table::of(study.frames_with(estimates))
        .column("frame", |(frame, _)| frame.number.to_string())
        .column("verdict", |(_, one)| one.verdict.answer.words().to_owned())
        .column_if(is_correlated, "correlation length [mm]", |(_, estimate)| {
            of(estimate, |one| decimals(one.length, 4))
        })
        .column_if(
            is_correlated,
            "correlated share of the variance",
            |(_, estimate)| of(estimate, |one| format!("{:.2}", one.share)),
        )
        .column_if(
            is_correlated,
            "equivalent independent markers",
            |(_, estimate)| of(estimate, |one| format!("{:.1}", one.independent)),
        )
        .column_if(has_reasons, "reason", |(_, estimate)| {
            reasons(&estimate.verdict).join("; ")
        });
    let mut blocks = vec![
        Block::heading("Verdict"),
        table.block(),
        Block::paragraph(EXPLANATION),
    ];
    if let Some((frame, estimate)) = last_with(study, estimates, Answer::NotExplained) {
        blocks.push(Block::paragraph(format!(
            "What would improve the fit of frame {}, best first, each computed in one linearised step; the probability is that of \
             noise alone reducing the misfit by as much.",
            frame.number
        )));
        let as_it_is = estimate
            .verdict
            .residual_rms
            .map(|rms| vec!["as it is".to_owned(), decimals(rms, 5), String::new()]);
        let trials = estimate.verdict.trials.iter().map(|trial| {
            vec![
                trial_words(study, trial),
                residual(trial.residual_rms).unwrap_or_default(),
                format!("{:.1e}", trial.probability),
            ]
        });
        let head = [
            "alternative",
            "residual without outliers [mm]",
            "probability",
        ];
        blocks.push(Block::table(&head, as_it_is.into_iter().chain(trials)));
    }
    blocks
}

/// The verdict for machines.
pub fn json(estimate: &FieldEstimate) -> Value {
    let verdict = &estimate.verdict;
    let trials = verdict.trials.iter().map(|trial| {
        json!({
            "freedom": trial.alternative.words(),
            "left_mm": trial.residual_rms,
            "probability": trial.probability,
        })
    });
    let worst = verdict.worst;
    json!({
        "answer": verdict.answer.words(),
        "correlation_length_mm": verdict.correlation.map(|one| one.length),
        "correlated_share": verdict.correlation.map(|one| one.share),
        "independent_markers": verdict.correlation.map(|one| one.independent),
        "evidence_of_correlation": verdict.correlation.map(|one| one.evidence),
        "reasons": reasons(verdict),
        "mends": trials.collect::<Vec<_>>(),
        "left_without_outliers_mm": verdict.residual_rms,
        "worst": worst.map(|worst| json!({ "place_mm": worst.position, "misfit_mm": worst.misfit })),
        "stated_noise_is_off_by": estimate.noise_ratio,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markers::ColumnTaken;

    #[test]
    fn a_stiffness_by_direction_may_be_positions_in_the_frame_of_a_table() {
        let of_table = |taken_to_rest: bool| Understood {
            columns: vec![ColumnTaken {
                holds: "x",
                head: "x [mm]".to_owned(),
                unit: Some(1.0),
                unit_source: "the file",
            }],
            taken_to_rest,
            ..Understood::of("columns")
        };
        for (alternative, understood, expected) in [
            (Alternative::Direction, of_table(false), true),
            (Alternative::Law, of_table(false), false),
            (Alternative::Direction, of_table(true), false),
            (Alternative::Direction, Understood::of("positions"), false),
        ] {
            assert_eq!(
                may_hold_places_in_frame(&alternative, &understood),
                expected,
                "{alternative:?}"
            );
        }
    }
}
