//! The parts of a report on what its figures are worth: error budget, own errors, balance, convergence.

use super::words::{at_stretches, figure, power};
use crate::compare::{Deviation, StepComparison};
use crate::corrector::DifferenceScheme;
use crate::corrector::plate::CorrectedState;
use crate::finite_element::convergence::Richardson;
use crate::problem::ClampedPlate;
use crate::results::Block;
use crate::solve::State;
use crate::studies::plate::problem::Study;
use crate::studies::plate::results::{MODELS, Results};

pub fn error_budget(study: &Study, results: &Results) -> Vec<Block> {
    let fit = match study.card.fit_error_percent() {
        Some(error) => format!("{error:.1e}"),
        None => "–".into(),
    };
    let row = |(index, step): (usize, &StepComparison)| {
        let [_, corrected, _] = results.models(index);
        let left = corrected.and_then(|state| state.convergence.residuals.last());
        let departure = |deviation: Option<Deviation>| {
            figure(deviation.map(|deviation| deviation.departure_percent), 3)
        };
        let own = step.reference;
        vec![
            ClampedPlate::percent(step.stretch),
            fit.clone(),
            departure(step.mass_spring),
            left.map_or("–".into(), |left| format!("{:.1e}", 100.0 * left)),
            departure(step.corrected),
            figure(own.map(|own| own.displacement_percent), 5),
            figure(own.map(|own| own.departure_percent), 5),
            figure(results.own_force_percent(index), 5),
        ]
    };
    let head = [
        "stretch [%]",
        "law: distance to the published curve [%]",
        "lattice: departure before the correction [%]",
        "corrector: residual left over [%]",
        "differences: departure after the correction [%]",
        "finite elements: displacement [%]",
        "finite elements: departure [%]",
        "finite elements: force [%]",
    ];
    vec![
        Block::heading("Error budget"),
        Block::table(&head, results.comparison.iter().enumerate().map(row)),
        Block::Paragraph(format!(
            "The departure before the correction is the model error of the springs; the correction removes it. What remains is the discretisation \
             error of the corrector's finite differences on {}{}, and the finite elements' own discretisation error, estimated from three meshes. A \
             deviation is judged only where the finite elements' own error is at most a tenth of it, or ten times this error would not change the verdict.",
            if study.corrector.is_graded() {
                "the nodes of its graded cells"
            } else {
                "the lattice's nodes"
            },
            match study.corrector.scheme {
                DifferenceScheme::Gauss =>
                    ", whose equations are those of bilinear finite elements there",
                DifferenceScheme::Biquadratic =>
                    ", whose equations are those of biquadratic finite elements there",
                DifferenceScheme::Bicubic =>
                    ", whose equations are those of bicubic finite elements there",
            }
        )),
    ]
}

pub fn reference(study: &Study, results: &Results) -> Vec<Block> {
    let quantity = |value: Option<Richardson>| {
        [
            figure(value.map(|value| value.extrapolated), 5),
            figure(value.and_then(|value| value.order), 2),
            figure(value.map(|value| value.error_percent), 6),
        ]
    };
    let row = |(index, step): (usize, &StepComparison)| {
        let own = step.reference;
        let energy = results.estimates.get(index).and_then(Option::as_ref);
        let mut cells = vec![ClampedPlate::percent(step.stretch)];
        cells.extend(quantity(own.map(|own| own.force)));
        cells.extend(quantity(own.map(|own| own.width)));
        cells.extend([
            figure(own.and_then(|own| own.displacement_order), 2),
            figure(own.map(|own| own.displacement_percent), 6),
            figure(own.map(|own| own.departure_percent), 6),
            figure(energy.map(|estimate| estimate.energy.percent()), 4),
            figure(results.recovered_force_percent(index), 6),
        ]);
        cells
    };
    let meshes = study.reference.meshes().map(|[x, y]| format!("{x} × {y}"));
    let head = [
        "stretch [%]",
        "force, extrapolated [N]",
        "order",
        "error of the finest mesh [%]",
        "width, extrapolated [mm]",
        "order",
        "error of the finest mesh [%]",
        "displacement: order",
        "error of the finest mesh [%]",
        "departure: error of the finest mesh [%]",
        "by recovery: energy norm [%]",
        "by recovery: force [%]",
    ];
    vec![
        Block::heading("The finite elements' own error"),
        Block::Paragraph(format!(
            "{} elements on {}, {} and {} cells{}; Richardson's extrapolation with the observed order, at most 4. The clamped corners are singular, \
             which lowers the order on equal cells; grading towards the corners restores it. The last columns come from the finest mesh alone, by \
             recovery of its gradient; with singular corners they give the order of magnitude only, and they are used where the three meshes do not \
             converge.",
            study.reference.element.name(),
            meshes[0],
            meshes[1],
            meshes[2],
            graded(study.reference.grading),
        )),
        Block::table(&head, results.comparison.iter().enumerate().map(row)),
    ]
}

fn graded(grading: f64) -> String {
    if grading > 1.0 {
        format!(", graded by {grading} towards the corners")
    } else {
        String::new()
    }
}

/// The worst balance of the grips' forces of every model.
pub fn balance(study: &Study, results: &Results) -> Vec<Block> {
    let row = |(model, name): (usize, &str)| {
        let (relative, stretch) = results.worst_balance(model)?;
        Some(vec![
            name.to_owned(),
            format!("{relative:.1e}"),
            ClampedPlate::percent(stretch),
            power(results.worst_residual(model)?),
        ])
    };
    let rows = MODELS.into_iter().enumerate().filter_map(row);
    let head = [
        "model",
        "largest unbalanced force or moment, over the largest one [–]",
        "at a stretch of [%]",
        "largest force left at a free node, over that on a grip [–]",
    ];
    let climb = match study.corrector.climb {
        Some(_) => {
            " The iteration of the corrected field (a climb) stops at a fraction (`climb_tolerance`) of its own discretisation error, which explains \
             the residual forces at its nodes."
        }
        None => "",
    };
    vec![
        Block::heading("Balance of forces and moments"),
        Block::table(&head, rows),
        Block::Paragraph(format!(
            "The sum of the reactions of both grips along both axes, relative to the sum of their magnitudes, and the sum of their moments about the \
             deformed plate's centre, relative to the same times half of its diagonal; the worst of all stretches. Because a plate is symmetric, \
             residual forces at its free nodes cancel in these sums: they have a column of their own.{climb}"
        )),
    ]
}

pub fn convergence(study: &Study, results: &Results) -> Vec<Block> {
    let row = |stretch: f64, model: &str, solution: &State| {
        let log = &solution.convergence;
        let cell = |residual: Option<&f64>| residual.map_or("–".into(), |r| format!("{r:.1e}"));
        vec![
            ClampedPlate::percent(stretch),
            model.to_owned(),
            solution.load_steps.to_string(),
            log.iterations().to_string(),
            cell(log.residuals.first()),
            cell(log.residuals.last()),
            log.cut_steps.to_string(),
            log.shifted_steps.to_string(),
        ]
    };
    let mut rows = Vec::new();
    for (index, step) in results.comparison.iter().enumerate() {
        for (name, solution) in MODELS.into_iter().zip(results.models(index)) {
            rows.extend(solution.map(|solution| row(step.stretch, name, solution)));
        }
    }
    let head = [
        "stretch [%]",
        "model",
        "load steps",
        "iterations",
        "first residual [–]",
        "last residual [–]",
        "steps cut",
        "tangents shifted",
    ];
    let mut blocks = vec![
        Block::heading("Convergence"),
        Block::table(&head, rows),
        Block::Paragraph(format!(
            "Mass-spring and finite elements: largest residual force over the largest reaction. Corrector: {}",
            match study.corrector.climb {
                Some(_) =>
                    "the remaining correction, root mean square over the nodes of the finest grid, relative to the largest displacement; the first \
                     value is what this grid adds to the one before it.",
                None =>
                    "largest scaled residual relative to the largest displacement; it has as many equations as unknowns, so that each step is a \
                     Newton step, and the first starts from the mass-spring field.",
            }
        )),
    ];
    blocks.push(Block::Paragraph(role_of_springs(study)));
    blocks.extend(starts(results));
    let without = results.stretches_without_springs();
    if !without.is_empty() {
        blocks.push(Block::Paragraph(format!(
            "The springs have no field at {}: there the affine stretch takes the place of ū.",
            at_stretches(without)
        )));
    }
    blocks
}

/// How the climb came to the corrected field at every stretch; nothing where the method was direct.
fn starts(results: &Results) -> Option<Block> {
    let row = |(step, state): (&StepComparison, &Option<CorrectedState>)| {
        let way = state.as_ref()?.way.as_ref()?;
        let stretch = ClampedPlate::percent(step.stretch);
        Some(vec![stretch, way.to_string(), figure(Some(way.away), 3)])
    };
    let steps = results.comparison.iter().zip(&results.corrected);
    let rows: Vec<_> = steps.filter_map(row).collect();
    let head = [
        "stretch [%]",
        "the climb began with",
        "root mean square distance of this start to the corrected field on the first grid [mm]",
    ];
    (!rows.is_empty()).then(|| Block::table(&head, rows))
}

/// What the springs do, and what they do not.
fn role_of_springs(study: &Study) -> String {
    let start = match study.corrector.climb {
        Some(_) => {
            "The climb starts from a field of its own on a coarse grid (see the table) and uses the study's springs for the multipliers only."
        }
        None => {
            "The direct method starts from the springs' field, and the multipliers belong to that field."
        }
    };
    format!(
        "The corrector projects the mass-spring field ū onto the fields that satisfy equilibrium at the inner nodes, the motion of the grips and the \
         free long sides. There are as many equations as unknowns: one field satisfies them whatever ū is, each step of the projection is a step of \
         Newton's method, and the springs do not influence the result. They provide only the start and the multipliers. {start} Where fewer \
         conditions than unknowns are imposed, as with measured points, noise or unknown grips, the result depends on both ū and the physics."
    )
}
