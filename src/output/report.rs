//! The report of a run: what is said, in which order. How it looks is left to [`super::markdown`] and
//! [`super::html`].

use crate::compare::{Deviation, StepComparison};
use crate::corrector::DifferenceScheme;
use crate::finite_element::convergence::Richardson;
use crate::material::Card;
use crate::material::curve::Mode;
use crate::material::law::HyperelasticLaw;
use crate::material::stability::{SEARCHED, stable_range};
use crate::problem::{Problem, Solution};
use crate::results::{Requirement, Results};
use crate::study::Study;

use super::figures::Figure;
use super::wrinkling;

/// A part of a report.
#[derive(Clone, Debug)]
pub enum Block {
    /// A heading of the given level, 1 to 3.
    Heading(u8, String),
    /// Running text.
    Paragraph(String),
    /// A table: heads with units, and rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// The picture of this index, with its caption.
    Figure(usize, String),
    /// Text shown as it is.
    Code(String),
}

impl Block {
    /// A table with these heads.
    pub fn table(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        let head = head.iter().map(|cell| (*cell).to_owned()).collect();
        Self::Table(head, rows.into_iter().collect())
    }
}

/// The report of a run with `figures`.
pub fn report(study: &Study, results: &Results, figures: &[Figure]) -> Vec<Block> {
    let mut blocks = vec![Block::Heading(1, study.title.clone())];
    blocks.extend(verdict(study, results));
    blocks.extend(compression(study, results).map(Block::Paragraph));
    blocks.extend(deviations(study, results));
    if !figures.is_empty() {
        blocks.push(heading("Pictures"));
    }
    let pictures = figures.iter().enumerate();
    blocks.extend(pictures.map(|(index, figure)| Block::Figure(index, figure.caption.clone())));
    blocks.extend(forces(results));
    blocks.extend(error_budget(study, results));
    blocks.extend(reference(study, results));
    blocks.extend(convergence(study, results));
    blocks.extend(material(study));
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

fn verdict(study: &Study, results: &Results) -> Vec<Block> {
    let [length, width] = study.problem.size;
    let [nx, ny] = study.cells;
    let requirements = results.requirements(&study.tolerances);
    let passed = requirements.iter().all(|requirement| requirement.passed);
    let what = format!(
        "A clamped plate of {length} × {width} × {} mm, {}. The mass-spring model on {nx} × {ny} cells, \
         the corrected field on the same nodes, and the finite elements that both are compared with: {}.",
        study.problem.thickness,
        study.card.title,
        results.finest().model.describe()
    );
    let result = if passed { "passed" } else { "failed" };
    let row = |requirement: &Requirement| {
        vec![
            requirement.name.to_owned(),
            format!("{:.3}", requirement.worst),
            format!(
                "{} {}",
                if requirement.at_most { "≤" } else { "≥" },
                requirement.limit
            ),
            if requirement.passed { "pass" } else { "FAIL" }.to_owned(),
        ]
    };
    vec![
        Block::Paragraph(what),
        Block::Paragraph(format!("The corrected field has {result}:")),
        Block::table(
            &[
                "requirement",
                "value at the worst stretch [%]",
                "wanted [%]",
                "result",
            ],
            requirements.iter().map(row),
        ),
    ]
}

/// The warning about compression in the finite elements.
fn compression(study: &Study, results: &Results) -> Option<String> {
    let finest = results.finest();
    let states = finest.solutions.iter().map(|state| {
        let load = Problem::describe_step(state.stretch);
        (load, &*state.displacement)
    });
    wrinkling::warning(&*study.problem.law, &finest.model.mesh, states)
}

fn deviations(study: &Study, results: &Results) -> Vec<Block> {
    let row = |stretch: f64, model: &str, deviation: &Deviation, correction: String| {
        vec![
            Problem::percent(stretch),
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
        [
            row(step.stretch, "mass-spring", &step.mass_spring, "–".into()),
            row(
                step.stretch,
                "corrected",
                &step.corrected,
                format!("{correction:.2}"),
            ),
        ]
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
        Block::table(&head, results.comparison.iter().flat_map(rows)),
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
        let corrected = &results.corrected[index].solution;
        let models = [
            &results.uncorrected[index],
            corrected,
            &results.finest().solutions[index],
        ];
        let mut cells = vec![Problem::percent(step.stretch)];
        cells.extend(models.map(|solution| format!("{:.5}", solution.force)));
        cells.extend(models.map(|solution| format!("{:.5}", solution.mid_width)));
        cells.extend(models.map(|solution| format!("{:.4}", solution.energy)));
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

fn error_budget(study: &Study, results: &Results) -> Vec<Block> {
    let fit = match study.card.fit_error_percent() {
        Some(error) => format!("{error:.1e}"),
        None => "–".into(),
    };
    let row = |(index, step): (usize, &StepComparison)| {
        let residuals = &results.corrected[index].solution.convergence.residuals;
        vec![
            Problem::percent(step.stretch),
            fit.clone(),
            format!("{:.3}", step.mass_spring.departure_percent),
            format!(
                "{:.1e}",
                100.0 * residuals.last().copied().unwrap_or(f64::NAN)
            ),
            format!("{:.3}", step.corrected.departure_percent),
            format!("{:.4}", step.reference.displacement_percent),
            format!("{:.4}", step.reference.force.error_percent),
        ]
    };
    let head = [
        "stretch [%]",
        "law: distance to the published curve [%]",
        "lattice: departure before the correction [%]",
        "corrector: residual left over [%]",
        "differences: departure after the correction [%]",
        "finite elements: displacement [%]",
        "finite elements: force [%]",
    ];
    vec![
        heading("Error budget"),
        Block::table(&head, results.comparison.iter().enumerate().map(row)),
        Block::Paragraph(format!(
            "The departure before the correction is what the springs cannot do; the correction removes it. What \
             remains is the discretisation error of the corrector's finite differences on the lattice's nodes{}, and \
             the finite elements' own discretisation error, estimated from three meshes.",
            match study.scheme {
                DifferenceScheme::Gauss =>
                    ", whose equations are those of bilinear finite elements there",
                DifferenceScheme::Biquadratic =>
                    ", whose equations are those of biquadratic finite elements there",
                DifferenceScheme::Corners => "",
            }
        )),
    ]
}

fn reference(study: &Study, results: &Results) -> Vec<Block> {
    let order = |order: f64| {
        if order.is_nan() {
            "–".into()
        } else {
            format!("{order:.2}")
        }
    };
    let quantity = |value: &Richardson| {
        [
            format!("{:.5}", value.extrapolated),
            order(value.order),
            format!("{:.5}", value.error_percent),
        ]
    };
    let row = |(index, step): (usize, &StepComparison)| {
        let own = &step.reference;
        let mut cells = vec![Problem::percent(step.stretch)];
        cells.extend(quantity(&own.force));
        cells.extend(quantity(&own.width));
        cells.extend([
            order(own.displacement_order),
            format!("{:.5}", own.displacement_percent),
            format!("{:.4}", results.estimates[index].energy.percent()),
            format!("{:.5}", results.estimated_force_percent(index)),
        ]);
        cells
    };
    let meshes = study.reference_meshes().map(|[x, y]| format!("{x} × {y}"));
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
        "by recovery: energy norm [%]",
        "by recovery: force [%]",
    ];
    vec![
        heading("The finite elements' own error"),
        Block::Paragraph(format!(
            "{} elements on {}, {} and {} cells{}; Richardson's extrapolation with the observed order. The \
             clamped corners are singular, which lowers the order where cells are equal; a grading towards them \
             restores it. The last columns come from the finest mesh alone, by recovery of its gradient; at \
             singular corners they are good for the order of magnitude.",
            study.element.name(),
            meshes[0],
            meshes[1],
            meshes[2],
            match study.grading > 1.0 {
                true => format!(", graded by {} towards the corners", study.grading),
                false => String::new(),
            }
        )),
        Block::table(&head, results.comparison.iter().enumerate().map(row)),
    ]
}

fn convergence(study: &Study, results: &Results) -> Vec<Block> {
    let row = |stretch: f64, model: &str, solution: &Solution| {
        let log = &solution.convergence;
        let cell = |residual: Option<&f64>| residual.map_or("–".into(), |r| format!("{r:.1e}"));
        vec![
            Problem::percent(stretch),
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
        rows.push(row(
            step.stretch,
            "mass-spring",
            &results.uncorrected[index],
        ));
        rows.push(row(
            step.stretch,
            "corrector",
            &results.corrected[index].solution,
        ));
        rows.push(row(
            step.stretch,
            "finite elements",
            &results.finest().solutions[index],
        ));
    }
    let head = [
        "stretch [%]",
        "solver",
        "load steps",
        "iterations",
        "first residual [–]",
        "last residual [–]",
        "steps cut",
        "tangents shifted",
    ];
    vec![
        heading("Convergence"),
        Block::table(&head, rows),
        Block::Paragraph(format!(
            "Mass-spring and finite elements: largest residual force over the largest reaction. Corrector: {}",
            match study.climb {
                Some(_) =>
                    "the correction that is left, root mean square over the nodes of the finest grid, over the \
                         largest displacement; the first is what this grid adds to the one before it.",
                None =>
                    "largest scaled residual over the largest displacement; its equations are as many as its \
                         unknowns, so that each step is a Newton step that starts from the mass-spring field.",
            }
        )),
    ]
}

fn material(study: &Study) -> Vec<Block> {
    let card = &study.card;
    let law: &dyn HyperelasticLaw = &*card.law;
    let [low, high] = card.stretch_range;
    let row = |key: &str, value: String| vec![key.to_owned(), value];
    let mut rows = vec![
        row("card", card.name.clone()),
        row("law", format!("{}: {}", card.law_name, card.formula)),
    ];
    let parameters = card.parameters.iter();
    rows.extend(parameters.map(|parameter| {
        let (value, unit) = (parameter.value, parameter.unit());
        row(parameter.key, format!("{value} {unit}"))
    }));
    rows.extend(
        card.choices
            .iter()
            .map(|(key, name)| row(key, name.clone())),
    );
    rows.extend([
        row(
            "initial Young's modulus E₀",
            format!("{:.6} MPa", law.youngs_modulus()),
        ),
        row(
            "calibrated range",
            format!("λ = {low} … {high} ({} test)", card.test),
        ),
        row(
            "measures",
            format!(
                "{} stress, {} strain; stress at rest: {}",
                card.stress_measure.name(),
                card.strain_measure.name(),
                card.offset.name()
            ),
        ),
        row("stable (Drucker)", stable(card)),
        row("specimen", card.specimen.clone()),
        row("source", card.citation.clone()),
    ]);
    for (key, value) in [("DOI", &card.doi), ("note", &card.note)] {
        rows.extend((!value.is_empty()).then(|| row(key, value.clone())));
    }
    vec![
        heading("Material"),
        Block::table(&["property", "value"], rows),
    ]
}

/// The stable stretches in the usual tests.
fn stable(card: &Card) -> String {
    let range = |(name, mode): (&str, Mode)| {
        let [low, high] = stable_range(&*card.law, mode);
        format!("{name} λ = {low:.3} … {high:.3}")
    };
    let [low, high] = SEARCHED;
    let ranges = Mode::ALL.map(range).join(", ");
    format!("{ranges}; looked for from {low} to {high}")
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
