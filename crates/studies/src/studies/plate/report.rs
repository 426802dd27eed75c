//! The tables of a plate's report.

use crate::compare::{Deviation, StepComparison};
use crate::problem::ClampedPlate;
use crate::results::models::{CORRECTED, MASS_SPRING};
use crate::results::{Block, Outcome, pictures, work_blocks};
use crate::studies::plate::problem::Study;
use crate::studies::plate::results::{MODELS, Results};

mod accuracy;
mod words;

use words::{at_stretches, figure, quantity};

/// The tables of a plate, with the pictures of `outcome` among them.
pub fn blocks(study: &Study, results: &Results, outcome: &Outcome) -> Vec<Block> {
    let mut blocks = vec![Block::Paragraph(introduction(study, results))];
    blocks.extend(reached(results));
    blocks.extend(deviations(study, results));
    blocks.extend(pictures("Pictures", outcome));
    blocks.extend(forces(results));
    blocks.extend(work(results));
    blocks.extend(accuracy::error_budget(study, results));
    blocks.extend(accuracy::reference(study, results));
    blocks.extend(accuracy::balance(study, results));
    blocks.extend(accuracy::convergence(study, results));
    blocks.extend(problem(study));
    blocks
}

fn introduction(study: &Study, results: &Results) -> String {
    let [length, width] = study.problem.size;
    let [nx, ny] = study.cells;
    format!(
        "A clamped plate of {length} × {width} × {} mm, {}. The mass-spring model on {nx} × {ny} cells, \
         the corrected field on {}, and the finite elements that both are compared with: {}.",
        study.problem.thickness,
        study.card.title,
        if !study.corrector.is_graded() {
            "the same nodes".to_owned()
        } else {
            format!(
                "as many cells that become smaller towards the clamped corners (graded by {}), to whose nodes the springs' field \
             is interpolated",
                study.corrector.grading
            )
        },
        results.finest().model.describe()
    )
}

/// Which model has a solution where; nothing where all have one everywhere.
fn reached(results: &Results) -> Option<Block> {
    let row = |(name, model): (&str, usize)| {
        let reached = results.reached(model);
        let stretches = if reached.is_empty() {
            "–".to_owned()
        } else {
            at_stretches(reached)
        };
        vec![name.to_owned(), stretches]
    };
    let rows = MODELS.into_iter().zip(0..).map(row);
    let table = || Block::table(&["model", "has a solution at"], rows);
    (!results.ends.is_empty()).then(table)
}

/// What is solved: the plate, its supports and its loads.
fn problem(study: &Study) -> Vec<Block> {
    let [length, width] = study.problem.size;
    let rows = [
        ("sheet", format!("of {}", study.card.describe_sheet())),
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
        Block::heading("Plate, supports and loads"),
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
            (MASS_SPRING.name, &step.mass_spring, None),
            (CORRECTED.name, &step.corrected, correction),
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
        Block::heading("Deviation from the finite elements"),
        Block::table(&head, results.comparison.iter().flat_map(rows).flatten()),
        Block::Paragraph(format!(
            "Displacement and departure are relative L2 norms over the plate, weighted by area; the departure has the affine stretch subtracted from \
             both fields and is the strict measure. The nominal stress is a relative L2 norm over the cells more than {:.0} mm from the corners, \
             where it is singular; for the mass-spring model it is the material's stress at the gradient of its field. Correction is 1 − \
             e(corrected)/e(mass-spring) for the departure.",
            study.problem.size[1] / 5.0
        )),
    ]
}

fn forces(results: &Results) -> Vec<Block> {
    let row = |(index, step): (usize, &StepComparison)| {
        let models = results.measures(index);
        let mut cells = vec![ClampedPlate::percent(step.stretch)];
        cells.extend(models.map(|model| quantity(model.map(|measures| measures.force), 5)));
        cells.extend(models.map(|model| quantity(model.map(|measures| measures.mid_width), 5)));
        cells.extend(models.map(|model| quantity(model.map(|measures| measures.energy), 4)));
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
        Block::heading("Force, width at mid length and strain energy"),
        Block::table(&head, results.comparison.iter().enumerate().map(row)),
    ]
}

/// What is stored and what softening has dissipated; nothing where the material has no memory.
fn work(results: &Results) -> Vec<Block> {
    if !results.remembers {
        return Vec::new();
    }
    let row = |(index, step): (usize, &StepComparison)| {
        let works = results.works(index).to_vec();
        (ClampedPlate::percent(step.stretch), works)
    };
    let rows = results.comparison.iter().enumerate().map(row);
    let mut blocks = work_blocks("stretch [%]", &MODELS, rows).to_vec();
    blocks.push(
        Block::Paragraph(
            "The material softens at every point according to the largest load there so far (Mullins effect). The stretches follow one another as \
             the study lists them, and the largest load is updated at these stretches only. The work of the grips is stored or dissipated; the \
             dissipated part grows with the largest load and is not recovered. The strain energies above are the sum of both."
                .to_owned(),
        ),
    );
    blocks
}
