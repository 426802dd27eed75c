//! The pictures of a plate.

use super::results::{MODELS, Results};
use super::study::Study;
use crate::compare::{Deviation, StepComparison};
use crate::mesh::Mesh;
use crate::output::picture::fields::{Colours, FieldFigure, Panel};
use crate::output::picture::lines::{Axis, Line, LineChart, Stroke};
use crate::output::picture::{PALETTE, Scale};
use crate::output::{cell_figure, cells, material_chart};
use crate::problem::plate::{Problem, Solution};
use crate::results::Figure;

const CORRECTED: [u8; 3] = PALETTE[0];
const MASS_SPRING: [u8; 3] = PALETTE[1];
const FINITE_ELEMENT: [u8; 3] = [30, 30, 30];

/// All pictures of a run, in the order of the report.
pub fn figures(study: &Study, results: &Results) -> Vec<Figure> {
    let mut all = vec![Figure::new(
        "material.png",
        "The material: nominal stress over stretch.",
        material_chart(&study.card).png(),
    )];
    for (step, stretch) in study.problem.stretches.iter().enumerate() {
        all.extend(step_figures(
            results,
            step,
            &Problem::describe_step(*stretch),
        ));
    }
    all.extend([
        Figure::new(
            "errors.png",
            "Deviation from the finite elements over stretch.",
            errors(results).png(),
        ),
        Figure::new(
            "force.png",
            "Grip force over stretch.",
            force(results).png(),
        ),
        Figure::new(
            "residuals.png",
            "Residual over iteration, at the last stretch with a solution.",
            residuals(results).png(),
        ),
    ]);
    all.extend(estimated_error(results).map(|png| {
        let caption = "Estimated error of every finite element at the last stretch, in % of the solution's energy norm.";
        Figure::new("estimated_error.png", caption, png)
    }));
    all
}

/// The pictures of one stretch, of those models that have a solution there.
fn step_figures(results: &Results, step: usize, at: &str) -> Vec<Figure> {
    let mut all = Vec::new();
    let plates = plates(results, step, at);
    if !plates.panels.is_empty() {
        let models = match plates.panels.len() {
            3 => "in all three models",
            _ => "in the models that have a solution there",
        };
        let caption = format!("The plate at {at} {models}, on one colour scale.");
        let name = format!("plates_{:03}.png", step + 1);
        all.push(Figure::new(&name, &caption, plates.png()));
    }
    let error = error_map(results, step, at);
    if !error.panels.is_empty() {
        let models = match error.panels.len() {
            2 => ", before and after the correction",
            _ => "",
        };
        let caption = format!("Distance to the finite elements at {at}{models}.");
        let name = format!("error_{:03}.png", step + 1);
        all.push(Figure::new(&name, &caption, error.png()));
    }
    all
}

fn plates(results: &Results, step: usize, at: &str) -> FieldFigure {
    let labels = [
        MODELS[0].to_owned(),
        MODELS[1].to_owned(),
        format!("{} ({})", MODELS[2], results.finest().model.describe()),
    ];
    let models = labels
        .into_iter()
        .zip(results.meshes())
        .zip(results.models(step));
    let panel = |((label, mesh), solution): ((String, &Mesh), Option<&Solution>)| {
        let u = &solution?.displacement;
        let cells = cells(mesh, u, &|node| u[2 * node + 1]);
        Some(Panel { label, cells })
    };
    FieldFigure {
        title: format!("Plate at {at}"),
        quantity: "transverse displacement [mm]".into(),
        scale: Scale::Linear,
        colours: Colours::Diverging,
        panels: models.filter_map(panel).collect(),
    }
}

fn error_map(results: &Results, step: usize, at: &str) -> FieldFigure {
    let mesh = &results.springs.mesh;
    let [springs, corrected, _] = results.models(step);
    let distance = |(label, solution): (&str, Option<&Solution>)| {
        let (u, v) = (
            &solution?.displacement,
            results.reference_on_lattice.get(step)?,
        );
        let distance =
            |node: usize| (u[2 * node] - v[2 * node]).hypot(u[2 * node + 1] - v[2 * node + 1]);
        Some(Panel {
            label: label.to_owned(),
            cells: cells(mesh, u, &distance),
        })
    };
    let models = [(MODELS[0], springs), (MODELS[1], corrected)];
    FieldFigure {
        title: format!("Distance to the finite elements at {at}"),
        quantity: "distance [mm]".into(),
        scale: Scale::Logarithmic,
        colours: Colours::Sequential,
        panels: models.into_iter().filter_map(distance).collect(),
    }
}

fn estimated_error(results: &Results) -> Option<Vec<u8>> {
    let finest = results.finest();
    let (last, estimate) = results.estimates.iter().enumerate().next_back()?;
    let at = Problem::describe_step(finest.solutions[last].stretch);
    Some(cell_figure(
        (&format!("Estimated error at {at}"), "error of a cell [%]"),
        Scale::Logarithmic,
        &finest.model.mesh,
        &finest.solutions[last].displacement,
        &estimate.as_ref()?.energy.cell_percents(),
    ))
}

fn errors(results: &Results) -> LineChart {
    type OfStep = fn(&StepComparison) -> Option<Deviation>;
    type Measure = fn(&Deviation) -> f64;
    let before: (OfStep, _) = (|step| step.mass_spring, MASS_SPRING);
    let after: (OfStep, _) = (|step| step.corrected, CORRECTED);
    let departure: Measure = |deviation| deviation.departure_percent;
    let displacement: Measure = |deviation| deviation.displacement_percent;
    let line = |(label, (deviation, colour), stroke, value): (&str, (OfStep, _), _, Measure)| {
        let point = |step: &StepComparison| Some([100.0 * step.stretch, value(&deviation(step)?)]);
        let points: Vec<[f64; 2]> = results.comparison.iter().filter_map(point).collect();
        Line {
            label: label.to_owned(),
            // A single point has no line to be seen by.
            stroke: if points.len() == 1 {
                Stroke::Points
            } else {
                stroke
            },
            points,
            colour,
        }
    };
    let lines = [
        (
            "mass-spring: departure from affine",
            before,
            Stroke::Marked,
            departure,
        ),
        (
            "mass-spring: displacement",
            before,
            Stroke::Dashed,
            displacement,
        ),
        (
            "corrected: departure from affine",
            after,
            Stroke::Marked,
            departure,
        ),
        (
            "corrected: displacement",
            after,
            Stroke::Dashed,
            displacement,
        ),
    ];
    LineChart {
        title: "Deviation from the finite elements".into(),
        x: Axis::linear("stretch of the plate [%]"),
        y: Axis::logarithmic("deviation, relative L2 [%]"),
        lines: with_points(lines.map(line), 1),
        band: None,
    }
}

/// The lines with so many points at least: a model without solutions has no place in a legend.
fn with_points(lines: impl IntoIterator<Item = Line>, fewest: usize) -> Vec<Line> {
    let lines = lines.into_iter();
    lines.filter(|line| line.points.len() >= fewest).collect()
}

fn force(results: &Results) -> LineChart {
    let line = |model: usize, colour, stroke| {
        let steps = 0..results.comparison.len();
        let solutions = steps.filter_map(|step| results.models(step)[model]);
        let points = solutions.map(|solution| [100.0 * solution.stretch, solution.force]);
        Line {
            label: MODELS[model].to_owned(),
            points: std::iter::once([0.0, 0.0]).chain(points).collect(),
            colour,
            stroke,
        }
    };
    let lines = [
        line(2, FINITE_ELEMENT, Stroke::Solid),
        line(0, MASS_SPRING, Stroke::Marked),
        line(1, CORRECTED, Stroke::Points),
    ];
    LineChart {
        title: "Grip force".into(),
        x: Axis::linear("stretch of the plate [%]"),
        y: Axis::linear("force [N]"),
        lines: with_points(lines, 2),
        band: None,
    }
}

/// The residuals of the models that have a solution at the last stretch that one of them has reached.
fn residuals(results: &Results) -> LineChart {
    let last = results.last_step().unwrap_or_default();
    let colours = [MASS_SPRING, CORRECTED, FINITE_ELEMENT];
    let models = MODELS.into_iter().zip(colours).zip(results.models(last));
    let line = |((label, colour), solution): ((&str, _), Option<&Solution>)| {
        let residuals = solution?.convergence.residuals.iter().enumerate();
        Some(Line {
            label: label.to_owned(),
            points: residuals.map(|(i, r)| [i as f64, *r]).collect(),
            colour,
            stroke: Stroke::Marked,
        })
    };
    let at = Problem::describe_step(results.comparison[last].stretch);
    LineChart {
        title: format!("Residual at {at}"),
        x: Axis::linear("iteration"),
        y: Axis::logarithmic("relative residual [–]"),
        lines: models.filter_map(line).collect(),
        band: None,
    }
}
