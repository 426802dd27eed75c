//! The pictures of a plate.

use super::problem::Study;
use super::results::{MODELS, Results};
use crate::compare::{Deviation, StepComparison};
use crate::mesh::Mesh;
use crate::problem::ClampedPlate;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING};
use crate::results::{
    Axis, Deformed, Drawing, FieldFigure, Figure, Line, LineChart, Panel, Stroke, from_rest,
    material_chart, sheet_figures,
};

/// All pictures of a run, in the order of the report.
pub fn figures(study: &Study, results: &Results) -> Vec<Figure> {
    let material = material_chart(&study.card);
    let caption = "The material: nominal stress over stretch.";
    let mut all = vec![Figure::new("material.png", caption, material)];
    for (step, stretch) in study.problem.stretches.iter().enumerate() {
        let at = ClampedPlate::describe_step(*stretch);
        all.extend(step_figures(results, step, &at));
    }
    all.extend(stress_figures(study, results));
    let caption = "Deviation from the finite elements over stretch.";
    all.push(Figure::new("errors.png", caption, errors(results)));
    let caption = "Grip force over stretch, and its deviation from the finite elements; computed at the markers only.";
    all.push(Figure::new("force.png", caption, force(results)));
    let caption = "Residual of springs and finite elements, and correction of the corrected field, over iteration at the last \
                   stretch with a solution.";
    all.push(Figure::new("residuals.png", caption, residuals(results)));
    all.extend(estimated_error(results).map(|figure| {
        let caption = "Estimated error of every finite element at the last stretch, in % of the solution's energy norm.";
        Figure::new("estimated_error.png", caption, figure)
    }));
    all.retain(|figure| !figure.drawing.is_empty());
    all
}

/// The pictures of one stretch, of those models that have a solution there.
fn step_figures(results: &Results, step: usize, at: &str) -> Vec<Figure> {
    let plates = plates(results, step, at);
    let models = match plates.panels.len() {
        3 => "in all three models",
        _ => "in the models that have a solution there",
    };
    let plates_caption = format!("The plate at {at} {models}, on one colour scale.");
    let error = error_map(results, step, at);
    let models = match error.panels.len() {
        2 => ", before and after the correction",
        _ => "",
    };
    let error_caption = format!("Distance to the finite elements at {at}{models}.");
    let figures = [
        ("plates", plates_caption, plates),
        ("error", error_caption, error),
    ];
    let drawn = figures
        .into_iter()
        .filter(|(.., figure)| !figure.panels.is_empty());
    let number = step + 1;
    drawn
        .map(|(name, caption, figure)| {
            Figure::new(format!("{name}_{number:03}.png"), caption, figure)
        })
        .collect()
}

/// Stresses and strains at the stretches that the study chooses, else at the last one that most models have reached.
fn stress_figures(study: &Study, results: &Results) -> Vec<Figure> {
    let count = |step: &usize| deformed(results, *step).len();
    let last = (0..results.comparison.len()).max_by_key(count);
    let pictures = &study.pictures;
    let steps = pictures.shown.steps(&study.problem.stretches, last);
    let at_step = |step: usize| {
        let at = ClampedPlate::describe_step(results.comparison[step].stretch);
        let models = (0..MODELS.len()).filter_map(|model| {
            let (label, mesh, u) = deformed_model(results, step, model)?;
            let mut fields = results.past(model, step);
            fields.push(u);
            Some(Deformed::elastic(label, mesh, fields))
        });
        let models: Vec<_> = models.collect();
        let file = |name: &str| format!("{name}_{:03}.png", step + 1);
        sheet_figures(&pictures.fields, &*study.problem.law, &models, &at, &file)
    };
    steps.into_iter().flat_map(at_step).collect()
}

/// The models that have a solution at a stretch, with their names and meshes.
fn deformed(results: &Results, step: usize) -> Vec<(String, &Mesh, &[f64])> {
    let models = 0..MODELS.len();
    models
        .filter_map(|model| deformed_model(results, step, model))
        .collect()
}

fn deformed_model(results: &Results, step: usize, model: usize) -> Option<(String, &Mesh, &[f64])> {
    let state = results.models(step)[model]?;
    let label = match model {
        2 => format!("{} ({})", MODELS[2], results.finest().model.describe()),
        _ => MODELS[model].to_owned(),
    };
    Some((label, results.meshes()[model], &state.displacement))
}

fn plates(results: &Results, step: usize, at: &str) -> FieldFigure {
    let panel = |(label, mesh, u): (String, &Mesh, &[f64])| {
        Panel::at_nodes(label, mesh, u, &|node| u[2 * node + 1])
    };
    let panels = deformed(results, step).into_iter().map(panel);
    let quantity = "transverse displacement [mm]";
    FieldFigure::new(format!("Plate at {at}"), quantity, panels)
}

fn error_map(results: &Results, step: usize, at: &str) -> FieldFigure {
    let (meshes, solutions) = (results.meshes(), results.models(step));
    let distance = |model: usize| {
        let reference = results.reference_on[model].get(step)?;
        let u = &solutions[model]?.displacement;
        Some(Panel::distance(MODELS[model], meshes[model], u, reference))
    };
    let title = format!("Distance to the finite elements at {at}");
    FieldFigure::new(title, "distance [mm]", (0..2).filter_map(distance)).logarithmic()
}

fn estimated_error(results: &Results) -> Option<FieldFigure> {
    let finest = results.finest();
    let (last, estimate) = results.estimates.iter().enumerate().next_back()?;
    let solution = &finest.solution.states[last];
    let at = ClampedPlate::describe_step(solution.factor);
    let energy = &estimate.as_ref()?.energy;
    let mesh = &finest.model.mesh;
    Some(FieldFigure::estimated_error(
        &at,
        mesh,
        &solution.displacement,
        energy,
    ))
}

fn errors(results: &Results) -> LineChart {
    type Measure = fn(&Deviation) -> f64;
    let departure: Measure = |deviation| deviation.departure_percent;
    let displacement: Measure = |deviation| deviation.displacement_percent;
    let measures = [
        ("departure from affine", departure, Stroke::Marked),
        ("displacement", displacement, Stroke::Ringed),
    ];
    type OfStep = fn(&StepComparison) -> Option<Deviation>;
    let before: OfStep = |step| step.mass_spring;
    let after: OfStep = |step| step.corrected;
    let models = [
        (MODELS[0], before, MASS_SPRING.colour),
        (MODELS[1], after, CORRECTED.colour),
    ];
    let lines = models.into_iter().flat_map(|(model, deviation, colour)| {
        measures.map(|(name, value, stroke)| {
            let point =
                |step: &StepComparison| Some([100.0 * step.stretch, value(&deviation(step)?)]);
            let points = results.comparison.iter().filter_map(point);
            Line::new(format!("{model}: {name}"), points, colour, stroke)
        })
    });
    LineChart::new(
        "Deviation from the finite elements",
        Axis::linear("stretch of the plate [%]"),
        Axis::logarithmic("deviation, relative L2 [%]"),
        with_points(lines, 1),
    )
}

/// The lines with so many points at least: a model without solutions has no place in a legend.
fn with_points(lines: impl IntoIterator<Item = Line>, fewest: usize) -> Vec<Line> {
    let lines = lines.into_iter();
    lines.filter(|line| line.points.len() >= fewest).collect()
}

fn force(results: &Results) -> Drawing {
    let line = |(model, colour, stroke): (usize, _, _)| {
        let steps = 0..results.comparison.len();
        let solutions =
            steps.filter_map(|step| results.models(step)[model].zip(results.measures(step)[model]));
        let points = solutions.map(|(state, measures)| [100.0 * state.factor, measures.force]);
        Line::new(MODELS[model], from_rest(points), colour, stroke)
    };
    let lines = [
        (2, FINITE_ELEMENTS.colour, Stroke::Marked),
        (0, MASS_SPRING.colour, Stroke::Marked),
        (1, CORRECTED.colour, Stroke::Ringed),
    ];
    let forces = LineChart::new(
        "Grip force",
        Axis::linear("stretch of the plate [%]"),
        Axis::linear("force [N]"),
        with_points(lines.map(line), 2),
    );
    let differences = force_differences(results);
    if differences.lines.is_empty() {
        forces.into()
    } else {
        Drawing::Charts(vec![(forces, 400), (differences, 320)])
    }
}

/// How far the force of springs and corrected field is from the finite elements'.
fn force_differences(results: &Results) -> LineChart {
    let line = |(model, colour): (usize, _)| {
        let point = |step: usize| {
            let measures = results.measures(step);
            let [own, reference] = [measures[model]?.force, measures[2]?.force];
            let stretch = 100.0 * results.comparison[step].stretch;
            Some([stretch, 100.0 * ((own - reference) / reference).abs()])
        };
        let points = (0..results.comparison.len()).filter_map(point);
        Line::new(MODELS[model], points, colour, Stroke::Marked)
    };
    let lines = [(0, MASS_SPRING.colour), (1, CORRECTED.colour)].map(line);
    LineChart::new(
        "Difference of the grip force from the finite elements'",
        Axis::linear("stretch of the plate [%]"),
        Axis::logarithmic("size of the difference [%]"),
        with_points(lines, 1),
    )
}

/// How the models that have a solution at the last stretch that one of them has reached have come to it: the residuals of
/// those that look for an equilibrium of forces, and the corrections of the corrected field, which is another quantity.
fn residuals(results: &Results) -> Drawing {
    let last = results.last_step().unwrap_or_default();
    let line = |(model, colour): (usize, _)| {
        let solution = results.models(last)[model]?;
        let residuals = solution.convergence.residuals.iter().enumerate();
        let points = residuals.map(|(iteration, size)| [iteration as f64, *size]);
        Some(Line::new(MODELS[model], points, colour, Stroke::Marked))
    };
    let at = ClampedPlate::describe_step(results.comparison[last].stretch);
    let chart = |title: &str, quantity: &str, lines: &[(usize, [u8; 3])]| {
        let lines = lines.iter().copied().filter_map(line);
        let lines = with_points(lines, 1);
        let y = Axis::logarithmic(quantity);
        let title = format!("{title} at {at}");
        let chart = LineChart::new(title, Axis::linear("iteration"), y, lines);
        (!chart.lines.is_empty()).then_some((chart, 340))
    };
    let forces = [(0, MASS_SPRING.colour), (2, FINITE_ELEMENTS.colour)];
    let charts = [
        chart("Residual forces", "relative residual [–]", &forces),
        chart(
            "Corrections",
            "relative correction [–]",
            &[(1, CORRECTED.colour)],
        ),
    ];
    Drawing::Charts(charts.into_iter().flatten().collect())
}
