//! The report on parameters that were estimated with all frames together.

use std::iter;

use super::{CorrectedSpecimen, JointResults, JointStudy};
use crate::error::Error;
use crate::estimation::{Direction, FieldEstimate, ForcePrediction, JointEstimate, VAGUE};
use crate::material::Card;
use crate::results::{Block, Table, or_dash};
use crate::statistics::Estimate;
use crate::studies::markers::report::interval;
use crate::units::decimals;

/// A force that was measured: specimen, frame, and its prediction.
pub type ForceRow<'a> = (&'a str, usize, &'a ForcePrediction);

/// All measured forces, specimen after specimen and frame after frame.
pub fn forces<'a>(study: &'a JointStudy, estimate: &'a JointEstimate) -> Vec<ForceRow<'a>> {
    let numbers = study.specimens.iter().flat_map(|(name, specimen)| {
        let frames = specimen.series.frames.iter();
        frames.map(move |frame| (name.as_str(), frame.number))
    });
    let frames = numbers.zip(&estimate.frames);
    frames
        .flat_map(|((name, number), frame)| {
            frame.forces.iter().map(move |force| (name, number, force))
        })
        .collect()
}

/// A table with a row for each force, so far with where it was measured.
pub fn force_table<'a>(rows: &'a [ForceRow<'a>]) -> Table<&'a ForceRow<'a>> {
    Table::of(rows)
        .column("specimen", |(name, ..)| (*name).to_owned())
        .column("frame", |(_, frame, _)| frame.to_string())
        .column("edge", |(.., force)| force.measured.edge.clone())
        .column("axis", |(.., force)| {
            ["x", "y"][force.measured.axis].to_owned()
        })
}

/// Whether the search has converged, and every frame of every specimen is explained with the estimated law, so that intervals are valid.
pub fn is_explained(joint: &JointResults, specimens: &[CorrectedSpecimen]) -> bool {
    let mut all = specimens.iter().flat_map(|specimen| &specimen.estimates);
    joint.estimate.ended.is_none() && all.all(FieldEstimate::is_explained)
}

/// The estimated parameters and the ranking of the laws, for the terminal.
pub fn summary(
    study: &JointStudy,
    joint: &JointResults,
    specimens: &[CorrectedSpecimen],
) -> String {
    let explained = is_explained(joint, specimens);
    let estimate = &joint.estimate;
    let mut lines = vec![format!(
        "{} of {} from {} frames of {}",
        joint.card.law_name,
        joint.card.name,
        estimate.frames.len(),
        study.specimen_words()
    )];
    lines.extend(estimate.with_keys().map(|(parameter, value)| {
        let unit = Some(parameter.unit()).filter(|unit| *unit != "–");
        format!(
            "{:<12} {} {}{}",
            parameter.key,
            decimals(value.value, 6),
            unit.unwrap_or_default(),
            interval(
                value,
                explained,
                " (not determined: the value at which the search ended)"
            )
        )
    }));
    lines.extend(undetermined(estimate).map(|direction| {
        format!(
            "not determined: {}; kept as on the card, except for a common factor of all stresses",
            combination(estimate, direction)
        )
    }));
    lines.extend(estimate.prediction_error().map(|error| {
        let percent = 100.0 * error;
        format!("forces of left-out frames: predicted to {percent:.3} % (root mean square)")
    }));
    if !joint.others.is_empty() {
        lines.push(
            "law           parameters  forces left out [%]  markers left out [mm]       ΔAICc"
                .to_owned(),
        );
        lines.extend(
            ranked(study, joint)
                .into_iter()
                .map(|row| match row.figures {
                    Some([error, residual, criterion]) => format!(
                        "{:<14}{:>9}  {:>19}  {residual:>21.5}  {criterion:>10.1}",
                        row.name,
                        row.parameters,
                        error_words(error),
                    ),
                    None => format!("{:<14}{}", row.name, row.fault),
                }),
        );
    }
    lines.extend(
        estimate
            .ended
            .iter()
            .map(|reason| format!("the search stopped before it converged: {reason}")),
    );
    if !explained {
        let words =
            "no interval: not all frames are explained by this law, thickness and conditions";
        lines.push(words.to_owned());
    }
    lines.join("\n") + "\n"
}

fn error_words(error: f64) -> String {
    if error.is_finite() {
        format!("{error:.3}")
    } else {
        "none".to_owned()
    }
}

/// The combinations of parameters that the data do not determine.
pub fn undetermined(estimate: &JointEstimate) -> impl Iterator<Item = &Direction> {
    let directions = estimate.directions.iter();
    directions.filter(|direction| !direction.is_determined())
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

pub struct RankedLaw {
    /// The card.
    pub name: String,
    /// The number of estimated parameters.
    pub parameters: usize,
    /// Error of the forces left out in percent, residual of the markers of frames left out in mm, AICc above the least.
    pub figures: Option<[f64; 3]>,
    /// Why there is none.
    pub fault: String,
}

/// The laws, the one that predicts the forces left out best first.
pub fn ranked(study: &JointStudy, joint: &JointResults) -> Vec<RankedLaw> {
    let others = joint.others.iter().map(Result::as_ref);
    let all: Vec<Result<&JointEstimate, &Error>> =
        iter::once(Ok(&joint.estimate)).chain(others).collect();
    let estimates: Vec<_> = all.iter().filter_map(|estimate| estimate.ok()).collect();
    let criteria = estimates
        .iter()
        .map(|estimate| estimate.information_criterion(&estimates));
    let least = criteria.fold(f64::INFINITY, f64::min);
    let figures = |estimate: &JointEstimate| {
        let frames = estimate
            .frames
            .iter()
            .map(|frame| frame.residual_rms.powi(2));
        let square = frames.sum::<f64>() / estimate.frames.len() as f64;
        let error = estimate.prediction_error().unwrap_or(f64::NAN);
        let above = estimate.information_criterion(&estimates) - least;
        [100.0 * error, square.sqrt(), above]
    };
    let row = |(card, estimate): (&Card, &Result<&JointEstimate, &Error>)| RankedLaw {
        name: card.name.clone(),
        parameters: estimate.map_or(0, |estimate| estimate.parameters.len()),
        figures: estimate.ok().map(figures),
        fault: estimate.err().map_or(String::new(), ToString::to_string),
    };
    let mut rows: Vec<RankedLaw> = study.cards.iter().zip(&all).map(row).collect();
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
    joint: &JointResults,
    specimens: &[CorrectedSpecimen],
) -> Vec<Block> {
    let explained = is_explained(joint, specimens);
    let estimate = &joint.estimate;
    let mut blocks = vec![
        Block::heading("Parameters"),
        parameters(study, estimate, explained),
        Block::paragraph(intervals(estimate, explained)),
    ];
    blocks.extend(determined(estimate));
    blocks.extend(predictions(study, joint));
    if !joint.others.is_empty() {
        blocks.extend(ranking(study, joint));
    }
    blocks.extend(verdicts(specimens));
    blocks
}

fn parameters(study: &JointStudy, estimate: &JointEstimate, explained: bool) -> Block {
    let uncertain = |value: &Estimate, words: String| {
        let [low, high] = value.interval;
        let shown = explained && low < high;
        if shown { words } else { "–".to_owned() }
    };
    Table::of(estimate.with_keys())
        .column("parameter", |(parameter, _)| parameter.key.to_owned())
        .column("value", |(_, value)| decimals(value.value, 6))
        .column("unit", |(parameter, _)| parameter.unit().to_owned())
        .column("standard error", |(_, value)| {
            uncertain(value, decimals(value.standard_error, 6))
        })
        .column("95 % interval", |(_, value)| {
            let ends = value.interval.map(|end| decimals(end, 6));
            uncertain(value, ends.join(" … "))
        })
        .column("initial value", |(parameter, _)| {
            let stated = study.cards[0].parameter(parameter.key);
            stated.map_or(String::new(), |value| decimals(value, 6))
        })
        .block()
}

fn determined(estimate: &JointEstimate) -> [Block; 3] {
    let table = Table::of(&estimate.directions)
        .column(
            "combination (each parameter relative to its value)",
            |direction| combination(estimate, direction),
        )
        .column("singular value", |direction| {
            decimals(direction.relative_error.recip(), 4)
        })
        .column("relative standard error [%]", |direction| {
            format!("{:.4}", 100.0 * direction.relative_error)
        })
        .column("determined", |direction| {
            let is_determined = direction.is_determined();
            if is_determined { "yes" } else { "no" }.to_owned()
        });
    [
        Block::heading("What the data determine"),
        table.block(),
        Block::paragraph(format!(
            "Singular values of the pooled sensitivity to the parameters (roots of the eigenvalues of their information matrix), edge motions \
             eliminated. A combination with a relative standard error above {:.0} % is treated as undetermined and kept as on the card, \
             except for a common factor of all stresses.",
            100.0 * VAGUE
        )),
    ]
}

fn intervals(estimate: &JointEstimate, explained: bool) -> String {
    if !explained {
        return "There are no intervals: law, thickness and conditions do not explain all frames, see the verdicts.".to_owned();
    }
    let meshes = if estimate.holds_mesh_error {
        "They include the discretisation error of the meshes, from the same equations on cells half as large."
    } else {
        "They do not include the discretisation error, because one mesh has too many cells to be refined: they are too \
         narrow where that error is not small compared with the noise."
    };
    format!(
        "Outlying markers get Tukey's weights, unless the conditions state otherwise. Intervals follow the profile \
         likelihood of all frames, with the noise estimated in each. Residuals of a marker in consecutive frames \
         correlate by {:.2}, and frames count for less accordingly. The intervals include a common error of 1 % of all forces without a stated \
         deviation, a stated error of the picture scale, and a scatter of forces beyond the stated one. {meshes}",
        estimate.common
    )
}

fn predictions(study: &JointStudy, joint: &JointResults) -> [Block; 3] {
    let difference = |force: &ForcePrediction| {
        let difference = 100.0 * (force.predicted? / force.measured.force - 1.0);
        difference.is_finite().then_some(difference)
    };
    let rows = forces(study, &joint.estimate);
    let table = force_table(&rows)
        .column("measured force [N]", |(.., force)| {
            decimals(force.measured.force, 6)
        })
        .column("standard deviation [N]", |(.., force)| {
            decimals(force.measured.standard_deviation, 6)
        })
        .column("predicted by the other frames [N]", |(.., force)| {
            or_dash(force.predicted, |value| format!("{value:.6}"))
        })
        .column("difference [%]", |(.., force)| {
            or_dash(difference(force), |value| format!("{value:.3}"))
        });
    [
        Block::heading("Forces of left-out frames"),
        table.block(),
        Block::paragraph(
            "Frames are left out in groups, one after the other; the law found from the other frames and the markers of the frame predict its \
             force. A dash: no other group has a measured force.",
        ),
    ]
}

fn ranking(study: &JointStudy, joint: &JointResults) -> [Block; 3] {
    let figure = |law: &RankedLaw, index: usize, write: &dyn Fn(f64) -> String| {
        let figures = law.figures;
        figures.map_or(String::new(), |figures| write(figures[index]))
    };
    let table = Table::of(ranked(study, joint))
        .column("card", |law| law.name.clone())
        .column("parameters", |law| match law.figures {
            Some(_) => law.parameters.to_string(),
            None => law.fault.clone(),
        })
        .column("left-out forces, root mean square error [%]", |law| {
            figure(law, 0, &error_words)
        })
        .column("left-out markers, root mean square residual [mm]", |law| {
            figure(law, 1, &|residual| decimals(residual, 5))
        })
        .column("ΔAICc", |law| {
            figure(law, 2, &|above| format!("{above:.1}"))
        });
    [
        Block::heading("Laws"),
        table.block(),
        Block::paragraph(
            "The law that best predicts the left-out forces comes first. AICc uses the number of independent values and is given relative to \
             the smallest.",
        ),
    ]
}

fn verdicts(specimens: &[CorrectedSpecimen]) -> [Block; 2] {
    let rows = specimens.iter().flat_map(|specimen| {
        let frames = specimen.study.frames_with(&specimen.estimates);
        frames.map(|(frame, estimate)| {
            vec![
                specimen.name.clone(),
                frame.number.to_string(),
                estimate.verdict.answer.words().to_owned(),
                decimals(estimate.noise, 5),
            ]
        })
    });
    [
        Block::heading("Verdicts with the law found"),
        Block::table(&["specimen", "frame", "verdict", "noise [mm]"], rows),
    ]
}
