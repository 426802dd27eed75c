//! The report of a run: what is said, in which order. How it looks is left to [`crate::output`].

use crate::compare::{Deviation, StepComparison};
use crate::error::Error;
use crate::problem::ClampedPlate;
use crate::studies::plate::problem::Study;
use crate::studies::plate::results::{MODELS, Results, verdict};

use super::warnings::warnings;
use crate::results::{Block, Check, Figure, Wanted, material_statement};

mod accuracy;

/// The report of a run with `figures`.
pub fn report(study: &Study, results: &Results, figures: &[Figure]) -> Vec<Block> {
    let mut blocks = vec![Block::Heading(1, study.title.clone())];
    blocks.extend(judged(study, results));
    blocks.extend(ends(results));
    let warnings = warnings(study, results).into_iter();
    blocks.extend(warnings.map(Block::Paragraph));
    blocks.extend(deviations(study, results));
    if !figures.is_empty() {
        blocks.push(heading("Pictures"));
    }
    let pictures = figures.iter().enumerate();
    blocks.extend(pictures.map(|(index, figure)| Block::Figure(index, figure.caption.clone())));
    blocks.extend(forces(results));
    blocks.extend(accuracy::error_budget(study, results));
    blocks.extend(accuracy::reference(study, results));
    blocks.extend(accuracy::balance(study, results));
    blocks.extend(accuracy::convergence(study, results));
    blocks.extend(problem(study));
    blocks.extend(material_statement(&study.card));
    blocks.push(heading("Study"));
    blocks.extend(
        study
            .warnings
            .iter()
            .map(|warning| Block::Paragraph(format!("Warning: {warning}"))),
    );
    blocks.push(Block::Code(study.text.clone()));
    blocks.push(Block::Paragraph(format!(
        "gelbench {}",
        env!("CARGO_PKG_VERSION")
    )));
    blocks.extend(times(results));
    blocks
}

fn heading(text: &str) -> Block {
    Block::Heading(2, text.to_owned())
}

/// A figure with so many decimals; a dash where there is none.
fn figure(value: Option<f64>, decimals: usize) -> String {
    let value = value.filter(|value| !value.is_nan());
    value.map_or("–".into(), |value| format!("{value:.decimals$}"))
}

/// A figure as a power of ten; a dash where it is none.
fn power(value: f64) -> String {
    match value.is_nan() {
        true => "–".into(),
        false => format!("{value:.1e}"),
    }
}

/// `15 %, 30 % stretch`, for sentences.
fn at_stretches(stretches: Vec<f64>) -> String {
    let percent = |stretch: f64| format!("{} %", ClampedPlate::percent(stretch));
    let all: Vec<String> = stretches.into_iter().map(percent).collect();
    format!("{} stretch", all.join(", "))
}

fn judged(study: &Study, results: &Results) -> Vec<Block> {
    let [length, width] = study.problem.size;
    let [nx, ny] = study.cells;
    let requirements = results.requirements(study);
    let what = format!(
        "A clamped plate of {length} × {width} × {} mm, {}. The mass-spring model on {nx} × {ny} cells, \
         the corrected field on the same nodes, and the finite elements that both are compared with: {}.",
        study.problem.thickness,
        study.card.title,
        results.finest().model.describe()
    );
    let row = |check: &Check| {
        vec![
            check.quantity.clone(),
            figure(Some(check.computed), 3),
            power(check.own_error.unwrap_or(f64::NAN)),
            match check.wanted {
                Wanted::AtLeast(limit) => format!("≥ {limit}"),
                Wanted::AtMost(limit) | Wanted::Equal(limit, _) => format!("≤ {limit}"),
            },
            check.judgement().word().to_owned(),
        ]
    };
    let head = [
        "requirement",
        "value at the worst stretch [%]",
        "own error of the finite elements in it [%]",
        "wanted [%]",
        "result",
    ];
    let remark = |check: &Check| {
        let remark = check.judgement().remark()?;
        let (name, word) = (&check.quantity, check.judgement().word());
        Some(Block::Paragraph(format!("{name}, {word}: {remark}.")))
    };
    let mut blocks = vec![
        Block::Paragraph(what),
        Block::Paragraph(format!(
            "The corrected field has {}:",
            verdict(&requirements)
        )),
        Block::table(&head, requirements.iter().map(row)),
    ];
    blocks.extend(requirements.iter().filter_map(remark));
    blocks
}

/// Which model ended where, and why.
fn ends(results: &Results) -> Vec<Block> {
    if results.ends.is_empty() {
        return Vec::new();
    }
    let row = |(name, model): (&str, usize)| {
        let reached = results.reached(model);
        let stretches = match reached.is_empty() {
            true => "–".to_owned(),
            false => at_stretches(reached),
        };
        vec![name.to_owned(), stretches]
    };
    let mut blocks = vec![
        heading("Models that ended early"),
        Block::table(
            &["model", "has a solution at"],
            MODELS.into_iter().zip(0..).map(row),
        ),
    ];
    let told = |end: &Error| match end.advice() {
        Some(advice) => Block::Paragraph(format!("{end}. Try: {advice}.")),
        None => Block::Paragraph(format!("{end}.")),
    };
    blocks.extend(results.ends.iter().map(told));
    blocks
}

/// What is solved: the plate, its supports and its loads.
fn problem(study: &Study) -> Vec<Block> {
    let [length, width] = study.problem.size;
    let rows = [
        ("sheet", "incompressible, in plane stress".to_owned()),
        ("length between the grips", format!("{length} mm")),
        ("width", format!("{width} mm")),
        (
            "thickness at rest",
            format!("{} mm", study.problem.thickness),
        ),
        ("left side (X = 0), clamped", "ux = 0, uy = 0".to_owned()),
        (
            "right side (X = length), clamped",
            format!("ux = stretch × {length} mm, uy = 0"),
        ),
        ("long sides", "free of traction".to_owned()),
        ("loads", "none but the motion of the right grip".to_owned()),
        ("stretches", at_stretches(study.problem.stretches.clone())),
    ];
    let rows = rows.map(|(key, value)| vec![key.to_owned(), value]);
    vec![
        heading("Plate, supports and loads"),
        Block::table(&["property", "value"], rows),
    ]
}

fn deviations(study: &Study, results: &Results) -> Vec<Block> {
    let row = |stretch: f64, model: &str, deviation: &Deviation, correction: String| {
        vec![
            ClampedPlate::percent(stretch),
            model.to_owned(),
            format!("{:.4}", deviation.displacement_percent),
            format!("{:.3}", deviation.departure_percent),
            format!("{:.4}", deviation.max_difference),
            format!("{:+.3}", deviation.force_percent),
            format!("{:+.4}", deviation.width_percent),
            format!("{:.3}", deviation.nominal_stress_percent),
            correction,
        ]
    };
    let rows = |step: &StepComparison| {
        let correction = step.correction_percent(|deviation| deviation.departure_percent);
        let models = [
            ("mass-spring", &step.mass_spring, None),
            ("corrected", &step.corrected, correction),
        ];
        models.map(|(model, deviation, correction)| {
            let correction = figure(correction, 2);
            Some(row(step.stretch, model, deviation.as_ref()?, correction))
        })
    };
    let head = [
        "stretch [%]",
        "model",
        "displacement [%]",
        "departure from affine [%]",
        "largest difference [mm]",
        "force [%]",
        "width at mid length [%]",
        "nominal stress [%]",
        "correction [%]",
    ];
    vec![
        heading("Deviation from the finite elements"),
        Block::table(&head, results.comparison.iter().flat_map(rows).flatten()),
        Block::Paragraph(format!(
            "Displacement and departure are relative L2 norms over the plate, weighted by area; the departure \
             has the affine stretch subtracted from both fields and is the strict measure. The nominal stress \
             is a relative L2 norm over the cells more than {:.0} mm from the corners, where it is singular; \
             for the mass-spring model it is the material's stress at the gradient of its field. \
             Correction is 1 − e(corrected)/e(mass-spring) of the departure.",
            study.problem.size[1] / 5.0
        )),
    ]
}

fn forces(results: &Results) -> Vec<Block> {
    let row = |(index, step): (usize, &StepComparison)| {
        let models = results.measures(index);
        let mut cells = vec![ClampedPlate::percent(step.stretch)];
        cells.extend(models.map(|model| figure(model.map(|measures| measures.force), 5)));
        cells.extend(models.map(|model| figure(model.map(|measures| measures.mid_width), 5)));
        cells.extend(models.map(|model| figure(model.map(|measures| measures.energy), 4)));
        cells
    };
    let head = [
        "stretch [%]",
        "force, mass-spring [N]",
        "force, corrected [N]",
        "force, finite elements [N]",
        "width, mass-spring [mm]",
        "width, corrected [mm]",
        "width, finite elements [mm]",
        "energy, mass-spring [mJ]",
        "energy, corrected [mJ]",
        "energy, finite elements [mJ]",
    ];
    vec![
        heading("Force, width at mid length and strain energy"),
        Block::table(&head, results.comparison.iter().enumerate().map(row)),
    ]
}

fn times(results: &Results) -> Vec<Block> {
    let rows = results.times.iter();
    let rows = rows.map(|(what, seconds)| vec![(*what).to_owned(), format!("{seconds:.3}")]);
    vec![
        heading("Times"),
        Block::Paragraph(
            "All stretches one after the other, on one core. Times differ from run to run.".into(),
        ),
        Block::table(&["model", "time [s]"], rows),
    ]
}
