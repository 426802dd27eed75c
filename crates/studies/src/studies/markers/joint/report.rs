//! The report on parameters that were found with all frames together.

use super::{CorrectedSpecimen, JointResults, JointStudy};
use crate::error::Error;
use crate::estimation::{Direction, FieldEstimate, ForcePrediction, JointEstimate, VAGUE};
use crate::material::Card;
use crate::results::Block;
use crate::statistics::Estimate;
use crate::units::decimals;

/// A force that was measured: specimen, frame, and what was predicted.
pub type ForceRow<'a> = (&'a str, usize, &'a ForcePrediction);

/// All measured forces, specimen after specimen and frame after frame.
pub fn forces<'a>(study: &'a JointStudy, estimate: &'a JointEstimate) -> Vec<ForceRow<'a>> {
    let places = study.specimens.iter().flat_map(|(name, own)| {
        let frames = own.series.frames.iter();
        frames.map(move |frame| (name.as_str(), frame.number))
    });
    let frames = places.zip(&estimate.frames);
    frames
        .flat_map(|((name, number), frame)| {
            frame.forces.iter().map(move |force| (name, number, force))
        })
        .collect()
}

/// Whether the search has reached its goal, and every frame of every specimen is explained with the law found, so that intervals mean
/// something.
pub fn is_explained(found: &JointResults, specimens: &[CorrectedSpecimen]) -> bool {
    let mut all = specimens.iter().flat_map(|specimen| &specimen.estimates);
    found.estimate.ended.is_none() && all.all(FieldEstimate::is_explained)
}

/// For the terminal.
pub fn summary(
    study: &JointStudy,
    found: &JointResults,
    specimens: &[CorrectedSpecimen],
) -> String {
    let explained = is_explained(found, specimens);
    let estimate = &found.estimate;
    let mut text = format!(
        "{} of {} from {} frames of {}\n",
        found.card.law_name,
        found.card.name,
        estimate.frames.len(),
        study.told_specimens()
    );
    for (parameter, estimate) in estimate.with_keys() {
        text += &format!(
            "{:<12} {}\n",
            parameter.key,
            value(estimate, unit(parameter.unit()), explained)
        );
    }
    for direction in estimate
        .directions
        .iter()
        .filter(|one| !one.is_determined())
    {
        text += &format!(
            "not determined: {}; kept as on the card, except for a common factor of all stresses\n",
            combination(estimate, direction)
        );
    }
    if let Some(error) = estimate.prediction_error() {
        text += &format!(
            "forces of left-out frames: predicted to {:.3} % (root mean square)\n",
            100.0 * error
        );
    }
    text += &ranking_lines(study, found);
    if let Some(ended) = &estimate.ended {
        text += &format!("the search stopped before it converged: {ended}\n");
    }
    if !explained {
        text += "no interval: not all frames are explained by this law, thickness and conditions\n";
    }
    text
}

/// The laws for the terminal; nothing where there is only one.
fn ranking_lines(study: &JointStudy, found: &JointResults) -> String {
    let mut text = String::new();
    if !found.others.is_empty() {
        text +=
            "law           parameters  forces left out [%]  markers left out [mm]       ΔAICc\n";
        for row in ranked(study, found) {
            text += &match row.figures {
                Some([error, left, criterion]) => format!(
                    "{:<14}{:>9}  {:>19}  {:>21.5}  {:>10.1}\n",
                    row.name,
                    row.parameters,
                    error_words(error),
                    left,
                    criterion
                ),
                None => format!("{:<14}{}\n", row.name, row.fault),
            };
        }
    }
    text
}

fn error_words(error: f64) -> String {
    if error.is_finite() {
        format!("{error:.3}")
    } else {
        "none".to_owned()
    }
}

fn unit(unit: &str) -> &str {
    if unit == "–" { "" } else { unit }
}

fn value(estimate: &Estimate, unit: &str, explained: bool) -> String {
    let [low, high] = estimate.interval;
    let interval = match (explained, low < high) {
        (true, true) => format!(" ({} … {})", decimals(low, 6), decimals(high, 6)),
        (false, true) => " (no interval: not explained)".to_owned(),
        _ => " (not determined: initial value)".to_owned(),
    };
    format!("{} {unit}{interval}", decimals(estimate.value, 6))
}

/// A combination of parameters, in words.
pub fn combination(estimate: &JointEstimate, direction: &Direction) -> String {
    const LITTLE: f64 = 0.05;
    let parameters = estimate.law.parameters().iter().zip(&direction.weights);
    let parts: Vec<String> = parameters
        .filter(|(_, weight)| weight.abs() > LITTLE)
        .map(|(parameter, weight)| format!("{weight:+.2} {}", parameter.key))
        .collect();
    parts.join(" ")
}

/// A law in the ranking.
pub struct RankedLaw {
    /// The card.
    pub name: String,
    /// How many parameters were found.
    pub parameters: usize,
    /// Error of the forces left out in percent, what is left of markers of frames left out in mm, AICc above the least.
    pub figures: Option<[f64; 3]>,
    /// Why there is none.
    pub fault: String,
}

/// The laws, the one that predicts the forces left out best first.
pub fn ranked(study: &JointStudy, found: &JointResults) -> Vec<RankedLaw> {
    let others = found.others.iter();
    let others = others.map(|other| (other.card, other.found.as_ref()));
    let all: Vec<(usize, Result<&JointEstimate, &Error>)> = [(0, Ok(&found.estimate))]
        .into_iter()
        .chain(others)
        .collect();
    let criteria = all.iter().filter_map(|(_, found)| found.ok());
    let least = criteria
        .map(JointEstimate::information_criterion)
        .fold(f64::INFINITY, f64::min);
    let row = |(card, found): &(usize, Result<&JointEstimate, &Error>)| {
        let of = |found: &&JointEstimate| {
            let count = found.frames.len() as f64;
            let square: f64 = found.frames.iter().map(|frame| frame.left.powi(2)).sum();
            let error = found
                .prediction_error()
                .map_or(f64::NAN, |error| 100.0 * error);
            let above = found.information_criterion() - least;
            [error, (square / count).sqrt(), above]
        };
        RankedLaw {
            name: study.cards[*card].name.clone(),
            parameters: found.map_or(0, |found| found.parameters.len()),
            figures: found.as_ref().ok().map(of),
            fault: found.err().map_or(String::new(), ToString::to_string),
        }
    };
    let mut rows: Vec<RankedLaw> = all.iter().map(row).collect();
    let order = |row: &RankedLaw| {
        let [error, _, criterion] = row.figures.unwrap_or([f64::INFINITY; 3]);
        if error.is_finite() { error } else { criterion }
    };
    rows.sort_by(|a, b| order(a).total_cmp(&order(b)));
    rows
}

/// The report.
pub fn blocks(
    study: &JointStudy,
    found: &JointResults,
    specimens: &[CorrectedSpecimen],
) -> Vec<Block> {
    let explained = is_explained(found, specimens);
    let estimate = &found.estimate;
    let mut blocks = vec![
        Block::heading("Parameters"),
        parameters(study, estimate, explained),
        Block::paragraph(intervals(estimate, explained)),
    ];
    blocks.extend(determined(estimate));
    blocks.extend(predictions(study, found));
    if !found.others.is_empty() {
        blocks.extend(ranking(study, found));
    }
    blocks.extend(verdicts(specimens));
    blocks
}

fn parameters(study: &JointStudy, estimate: &JointEstimate, explained: bool) -> Block {
    Block::table(
        &[
            "parameter",
            "value",
            "unit",
            "standard error",
            "95 % interval",
            "initial value",
        ],
        estimate.with_keys().map(|(parameter, value)| {
            let [low, high] = value.interval;
            let of = |text: String| {
                if explained && low < high {
                    text
                } else {
                    "–".to_owned()
                }
            };
            let first = first_value(&study.cards[0], parameter.key);
            vec![
                parameter.key.to_owned(),
                decimals(value.value, 6),
                parameter.unit().to_owned(),
                of(decimals(value.standard_error, 6)),
                of(format!("{} … {}", decimals(low, 6), decimals(high, 6))),
                first,
            ]
        }),
    )
}

fn determined(estimate: &JointEstimate) -> [Block; 3] {
    [
        Block::heading("What the data determine"),
        Block::table(
            &[
                "combination (each parameter relative to its value)",
                "singular value",
                "relative standard error [%]",
                "determined",
            ],
            estimate.directions.iter().map(|direction| {
                vec![
                    combination(estimate, direction),
                    decimals(direction.relative_error.recip(), 4),
                    format!("{:.4}", 100.0 * direction.relative_error),
                    if direction.is_determined() {
                        "yes"
                    } else {
                        "no"
                    }
                    .to_owned(),
                ]
            }),
        ),
        Block::paragraph(format!(
            "Singular values of the pooled sensitivity to the parameters (roots of the eigenvalues of their information matrix), edge motions \
             eliminated. A combination with a relative standard error above {:.0} % is treated as undetermined and kept as on the card, \
             except for a common factor of all stresses.",
            100.0 * VAGUE
        )),
    ]
}

/// The value of a parameter on the card.
fn first_value(card: &Card, key: &str) -> String {
    let stated = card.parameter(key);
    stated.map_or(String::new(), |value| decimals(value, 6))
}

fn intervals(estimate: &JointEstimate, explained: bool) -> String {
    if explained {
        format!(
            "Outlying markers get Tukey's weights, unless the conditions state otherwise. Intervals follow the profile \
         likelihood of all frames, with the noise estimated in each. Residuals of a marker in consecutive frames \
         correlate by {:.2}, and frames count for less accordingly. The intervals include a common error of 1 % of all forces without a stated \
         deviation, a stated error of the picture scale, and a scatter of forces beyond the stated one. {}",
            estimate.common,
            if estimate.holds_mesh_error {
                "They include the discretisation error of the meshes, from the same equations on cells half as large."
            } else {
                "They do not include the discretisation error, because one mesh has too many cells to be refined: they are too \
        narrow where that error is not small compared with the noise."
            }
        )
    } else {
        "There are no intervals: law, thickness and conditions do not explain all frames, see the verdicts.".to_owned()
    }
}

fn predictions(study: &JointStudy, found: &JointResults) -> Vec<Block> {
    let rows = forces(study, &found.estimate);
    let rows = rows.into_iter().map(|(name, frame, force)| {
        let measured = &force.measured;
        let off = force
            .predicted
            .map(|there| 100.0 * (there / measured.force - 1.0));
        let of = |value: Option<f64>, digits: usize| {
            value.map_or("–".to_owned(), |value| format!("{value:.digits$}"))
        };
        vec![
            name.to_owned(),
            frame.to_string(),
            measured.edge.clone(),
            ["x", "y"][measured.axis].to_owned(),
            decimals(measured.force, 6),
            decimals(measured.standard_deviation, 6),
            of(force.predicted, 6),
            of(off, 3),
        ]
    });
    let head = [
        "specimen",
        "frame",
        "edge",
        "axis",
        "measured force [N]",
        "standard deviation [N]",
        "predicted by the other frames [N]",
        "difference [%]",
    ];
    vec![
        Block::heading("Forces of left-out frames"),
        Block::table(&head, rows),
        Block::paragraph(
            "Frames are left out in groups, one after the other; the law found from the other frames and the markers of the frame predict its \
             force. A dash: no other group has a measured force.",
        ),
    ]
}

fn ranking(study: &JointStudy, found: &JointResults) -> [Block; 3] {
    let rows = ranked(study, found)
        .into_iter()
        .map(|law| match law.figures {
            Some([error, left, criterion]) => vec![
                law.name,
                law.parameters.to_string(),
                error_words(error),
                decimals(left, 5),
                format!("{criterion:.1}"),
            ],
            None => vec![
                law.name,
                law.fault,
                String::new(),
                String::new(),
                String::new(),
            ],
        });
    let head = [
        "card",
        "parameters",
        "left-out forces, root mean square error [%]",
        "left-out markers, root mean square residual [mm]",
        "ΔAICc",
    ];
    [
        Block::heading("Laws"),
        Block::table(&head, rows),
        Block::paragraph(
            "The law that best predicts the left-out forces comes first. AICc uses the number of independent values and is given relative to \
             the smallest.",
        ),
    ]
}

fn verdicts(specimens: &[CorrectedSpecimen]) -> [Block; 2] {
    let rows = specimens.iter().flat_map(|specimen| {
        let frames = specimen.study.series.frames.iter().zip(&specimen.estimates);
        frames.map(|(frame, found)| {
            vec![
                specimen.name.clone(),
                frame.number.to_string(),
                found.verdict.answer.words().to_owned(),
                decimals(found.noise, 5),
            ]
        })
    });
    [
        Block::heading("Verdicts with the law found"),
        Block::table(&["specimen", "frame", "verdict", "noise [mm]"], rows),
    ]
}
