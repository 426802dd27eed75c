//! The verdict on every frame, for the terminal, the report and machines.

use serde_json::{Value, json};

use super::MarkerStudy;
use crate::estimation::{Answer, FieldEstimate, Trial, Verdict};
use crate::markers::Frame;
use crate::results::Block;
use crate::statistics::extremes;
use crate::units::decimals;

/// Freedoms that are told in the terminal.
const TOLD: usize = 5;

/// The answers that frames have, the worst first.
const ANSWERS: [Answer; 4] = [
    Answer::NotExplained,
    Answer::Undecided,
    Answer::Correlated,
    Answer::Explained,
];

/// The worst answer of all frames.
pub fn worst(estimates: &[FieldEstimate]) -> Answer {
    let of = |answer: &Answer| {
        estimates
            .iter()
            .any(|found| found.verdict.answer == *answer)
    };
    ANSWERS.into_iter().find(of).unwrap_or_default()
}

/// The verdict on all frames, and what would explain the last one that is not.
pub fn summary(field: &MarkerStudy, estimates: &[FieldEstimate]) -> String {
    if field.coarse.is_some() {
        return String::new();
    }
    let frames = || field.series.frames.iter().zip(estimates);
    let mut text = String::new();
    let all: Vec<(usize, &FieldEstimate)> =
        frames().map(|(frame, own)| (frame.number, own)).collect();
    for answer in ANSWERS {
        let runs = all.chunk_by(|(_, a), (_, b)| a.verdict.answer == b.verdict.answer);
        let own: Vec<_> = runs
            .filter(|run| run[0].1.verdict.answer == answer)
            .collect();
        if !own.is_empty() {
            let count: usize = own.iter().map(|run| run.len()).sum();
            let frames = if count == 1 { "frame" } else { "frames" };
            let runs: Vec<String> = own.into_iter().map(|run| run_words(run, answer)).collect();
            text += &format!(
                "verdict, {frames} {}: {}\n",
                runs.join(", "),
                answer.words()
            );
        }
    }
    for answer in [Answer::Undecided, Answer::NotExplained] {
        let last = frames().rfind(|(_, found)| found.verdict.answer == answer);
        text += &last.map_or(String::new(), |(frame, found)| {
            format!("frame {}: {}\n", frame.number, reasons(&found.verdict))
        });
    }
    if let Some((_, found)) = not_explained(field, estimates) {
        text += &found.verdict.worst.map_or(String::new(), |worst| {
            let [x, y] = worst.place.map(|place| decimals(place, 4));
            let [ux, uy] = worst.misfit.map(|misfit| decimals(misfit, 5));
            format!("largest misfit near ({x}, {y}) mm: mean residual ({ux}, {uy}) mm\n")
        });
        if found.verdict.trials.is_empty() {
            text += if found.holds_mesh_error {
                "no alternative tried (edges, forces, stiffness, law, finer mesh) improves the fit\n"
            } else {
                "no alternative tried (edges, forces, stiffness, law) improves the fit; a finer mesh could not be tried: use smaller cells\n"
            };
        }
        text +=
            &finer_mesh(field, &found.verdict).map_or(String::new(), |told| format!("{told}\n"));
        for trial in found.verdict.trials.iter().take(TOLD) {
            text += &format!("one linearised step with {}\n", words(trial));
        }
    }
    text
}

/// Frames with one answer, one after the other: `4`, `4, 9`, `4 to 34`, and over which lengths their noise correlates.
fn run_words(run: &[(usize, &FieldEstimate)], answer: Answer) -> String {
    let numbers = match run {
        [(one, _)] => one.to_string(),
        [(first, _), (second, _)] => format!("{first}, {second}"),
        [(first, _), .., (last, _)] => format!("{first} to {last}"),
        [] => String::new(),
    };
    let lengths = run
        .iter()
        .filter_map(|(_, found)| found.verdict.correlation);
    let [low, high] = extremes(lengths.map(|one| one.length));
    match (answer, low < high) {
        (Answer::Correlated, true) => format!("{numbers} (over {low:.3} to {high:.3} mm)"),
        (Answer::Correlated, false) => format!("{numbers} (over {low:.3} mm)"),
        _ => numbers,
    }
}

/// What is said where the cells are why data are not explained.
fn finer_mesh(field: &MarkerStudy, verdict: &Verdict) -> Option<String> {
    let remedy = match field.cell_size {
        Some(size) => format!(
            "use cells smaller than {} mm (--refine or --cell-size)",
            decimals(size, 4)
        ),
        None => "use a finer one".to_owned(),
    };
    verdict.asks_for_finer_mesh().then(|| {
        format!("the mesh is too coarse for data of this precision, which is no evidence against the law and the conditions: {remedy}")
    })
}

fn reasons(verdict: &Verdict) -> String {
    let words: Vec<String> = verdict
        .reasons
        .iter()
        .map(|reason| reason.words())
        .collect();
    words.join("; ")
}

fn words(trial: &Trial) -> String {
    if trial.left.is_finite() {
        format!(
            "{}: the residual would be {} mm",
            trial.alternative.words(),
            decimals(trial.left, 5)
        )
    } else {
        trial.alternative.words()
    }
}

const EXPLANATION: &str = "Explained: the residuals of the markers are white noise. Explained with correlated noise: they correlate \
    between neighbours as noise of image correlation does, with the length at which the correlation has fallen to 1/e; the \
    intervals include that. The data cannot judge: the residuals correlate so far that they are worth fewer than a hundred independent \
    values, too few to tell noise from a misfit; intervals take them for noise of the widest correlation that they allow. Or gross errors \
    make up the noise; then there are no intervals. Not explained: an alternative model reduces the misfit by more than noise could, \
    the residuals correlate between neighbours and are similar from frame to frame, or a measured force is contradicted. Standard \
    errors and intervals are then meaningless and are not given.";

/// The last frame that is not explained.
fn not_explained<'a>(
    field: &'a MarkerStudy,
    estimates: &'a [FieldEstimate],
) -> Option<(&'a Frame, &'a FieldEstimate)> {
    let mut frames = field.series.frames.iter().zip(estimates);
    frames.rfind(|(_, found)| found.verdict.answer == Answer::NotExplained)
}

/// The verdict on every frame, and what would explain the last one that is not.
pub fn blocks(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<Block> {
    let frames = || field.series.frames.iter().zip(estimates);
    let rows = frames().map(|(frame, found)| {
        let correlation = found.verdict.correlation;
        let of = |value: fn(&crate::estimation::NoiseCorrelation) -> String| {
            correlation.as_ref().map_or(String::new(), value)
        };
        vec![
            frame.number.to_string(),
            found.verdict.answer.words().to_owned(),
            of(|one| decimals(one.length, 4)),
            of(|one| format!("{:.2}", one.share)),
            of(|one| format!("{:.1}", one.independent)),
            reasons(&found.verdict),
        ]
    });
    let head = [
        "frame",
        "verdict",
        "correlation length [mm]",
        "correlated share of the variance",
        "equivalent independent markers",
        "reason",
    ];
    let mut blocks = vec![
        Block::heading("Verdict"),
        Block::table(&head, rows),
        Block::paragraph(EXPLANATION),
    ];
    if let Some((_, last)) = frames().next_back() {
        blocks.extend(variogram(last));
    }
    if let Some((frame, found)) = not_explained(field, estimates) {
        blocks.push(Block::paragraph(format!(
            "What would improve the fit of frame {}, best first, each computed in one linearised step; the probability is that of \
             noise alone reducing the misfit by as much.",
            frame.number
        )));
        let rows = found.verdict.trials.iter().map(|trial| {
            let left = if trial.left.is_finite() {
                decimals(trial.left, 5)
            } else {
                String::new()
            };
            vec![
                trial.alternative.words(),
                left,
                format!("{:.1e}", trial.probability),
            ]
        });
        blocks.push(Block::table(
            &["alternative", "residual [mm]", "probability"],
            rows,
        ));
        blocks.extend(finer_mesh(field, &found.verdict).map(Block::paragraph));
    }
    blocks
}

/// Half the mean squared difference of what is left, by distance.
fn variogram(found: &FieldEstimate) -> Option<Block> {
    let whiteness = found.whiteness.as_ref()?;
    let rows = whiteness.variogram.iter().map(|bin| {
        vec![
            decimals(bin.distance, 4),
            bin.pairs.to_string(),
            format!("{:.3}", bin.of_components[0]),
            format!("{:.3}", bin.of_components[1]),
        ]
    });
    let head = [
        "distance [mm]",
        "pairs",
        "variogram of ux",
        "variogram of uy",
    ];
    Some(Block::table(&head, rows))
}

/// The verdict for machines.
pub fn json(found: &FieldEstimate) -> Value {
    let verdict = &found.verdict;
    let trials = verdict.trials.iter().map(|trial| {
        json!({
            "freedom": trial.alternative.words(),
            "left_mm": trial.left,
            "probability": trial.probability,
        })
    });
    let worst = verdict
        .worst
        .map(|worst| json!({ "place_mm": worst.place, "misfit_mm": worst.misfit }));
    let reasons: Vec<String> = verdict
        .reasons
        .iter()
        .map(|reason| reason.words())
        .collect();
    json!({
        "answer": verdict.answer.words(),
        "correlation_length_mm": verdict.correlation.map(|one| one.length),
        "correlated_share": verdict.correlation.map(|one| one.share),
        "independent_markers": verdict.correlation.map(|one| one.independent),
        "evidence_of_correlation": verdict.correlation.map(|one| one.evidence),
        "reasons": reasons,
        "mends": trials.collect::<Vec<_>>(),
        "worst": worst,
        "stated_noise_is_off_by": found.noise_ratio,
    })
}
