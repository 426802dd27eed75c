//! The pictures of a run.

use super::picture::animation::{Animation, Frame};
use super::picture::fields::{Colours, FieldCell, FieldFigure, Panel, outlines};
use super::picture::lines::{Axis, Line, LineChart, Stroke};
use super::picture::{PALETTE, Scale};
use crate::compare::{Deviation, StepComparison};
use crate::material::Card;
use crate::material::curve::{Mode, simple_shear};
use crate::material::stability::{SEARCHED, stable_range};
use crate::mesh::Mesh;
use crate::problem::{Problem, Solution};
use crate::results::{MODELS, Results};
use crate::study::Study;

/// A picture and its caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name.
    pub name: String,
    /// What it shows, in one sentence.
    pub caption: String,
    /// The picture.
    pub png: Vec<u8>,
}

impl Figure {
    /// A picture with its file name and caption.
    pub fn new(name: &str, caption: &str, png: Vec<u8>) -> Self {
        Self {
            name: name.to_owned(),
            caption: caption.to_owned(),
            png,
        }
    }
}

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

/// The curves of a card in the three usual tests.
pub fn material_chart(card: &Card) -> LineChart {
    let [low, high] = card.stretch_range;
    let (from, to) = (low.min(1.0), high.max(1.0));
    let law = &*card.law;
    let samples = |nominal_stress: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let stretch = |i: i32| from + (to - from) * 1.1 * f64::from(i) / 110.0;
        (0..=110)
            .map(|i| [stretch(i), nominal_stress(stretch(i))])
            .collect()
    };
    let curves = Mode::ALL.map(|(name, mode)| {
        let stress = move |stretch: f64| mode.nominal_stress(law, stretch - 1.0);
        (name, samples(&stress), stable_range(law, mode))
    });
    let shear = samples(&|stretch| simple_shear(law, stretch - 1.0));
    let curves = curves
        .into_iter()
        .chain([("simple shear", shear, SEARCHED)]);
    let curves: Vec<_> = curves.collect();
    // Equibiaxial tension is much stiffer: its curve ends where it would press the others flat.
    let uniaxial = curves[0].1.iter();
    let highest = uniaxial.fold(0.0, |most: f64, point| most.max(1.6 * point[1].abs()));
    let shown = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let points = points.iter().copied();
        points.filter(|point| point[1].abs() <= highest).collect()
    };
    let mut lines = Vec::new();
    for ((name, points, stable), colour) in
        curves.iter().zip([0, 2, 3, 4].map(|index| PALETTE[index]))
    {
        lines.extend(Line::within(name, &shown(points), colour, *stable));
    }
    if lines.iter().any(|line| line.stroke == Stroke::Dashed) {
        lines.push(Line {
            label: "unstable (Drucker)".to_owned(),
            points: Vec::new(),
            colour: FINITE_ELEMENT,
            stroke: Stroke::Dashed,
        });
    }
    if card.published_nominal_stress(1.0).is_some() {
        let published = |stretch| card.published_nominal_stress(stretch).unwrap_or(f64::NAN);
        lines.push(Line {
            label: "published curve (uniaxial)".to_owned(),
            points: shown(&samples(&published)),
            colour: MASS_SPRING,
            stroke: Stroke::Dashed,
        });
    }
    LineChart {
        title: card.title.clone(),
        x: Axis {
            label: "stretch λ, in shear 1 + γ [–]".to_owned(),
            scale: Scale::Interval,
        },
        y: Axis::linear("nominal stress [MPa]"),
        lines,
        band: Some(([low, high], "range of the card".to_owned())),
    }
}

/// The uniaxial curves of several cards, each over its own range.
pub fn comparison_chart(cards: &[Card]) -> LineChart {
    let line = |(index, card): (usize, &Card)| {
        let [low, high] = card.stretch_range;
        let stretch = |i: i32| low + (high - low) * f64::from(i) / 100.0;
        let stress = |stretch: f64| Mode::Uniaxial.nominal_stress(&*card.law, stretch - 1.0);
        Line {
            label: card.name.clone(),
            points: (0..=100)
                .map(|i| [stretch(i), stress(stretch(i))])
                .collect(),
            colour: PALETTE[index % PALETTE.len()],
            // A colour that comes again is dashed.
            stroke: if index < PALETTE.len() {
                Stroke::Solid
            } else {
                Stroke::Dashed
            },
        }
    };
    LineChart {
        title: "Uniaxial tension".into(),
        x: Axis::stretch(),
        y: Axis::linear("nominal stress [MPa]"),
        lines: cards.iter().enumerate().map(line).collect(),
        band: None,
    }
}

/// A mesh; curved edges are drawn through their middles.
pub fn mesh_picture(title: &str, mesh: &Mesh) -> Vec<u8> {
    let outline = |cell: usize| {
        let nodes = mesh.cell(cell);
        let shape = mesh.shape(cell);
        let mut places = Vec::new();
        for edge in shape.edges() {
            let along = [0, 1, 2, 3].map(|i| f64::from(i) / 4.0);
            let [from, to] = [edge[0], edge[1]].map(|node| shape.reference_nodes()[node]);
            for share in along {
                let local = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                let values = shape.values(local);
                places.push([0, 1].map(|axis| {
                    let shares = nodes.iter().zip(&values);
                    shares
                        .map(|(node, value)| value * mesh.nodes[*node][axis])
                        .sum()
                }));
            }
        }
        places.extend(places.first().copied());
        places
    };
    outlines(
        title,
        &(0..mesh.cell_count()).map(outline).collect::<Vec<_>>(),
    )
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

/// A field on a deformed mesh: label, mesh, displacement and a value for each node.
pub type Field<'a> = (&'a str, &'a Mesh, &'a [f64], Vec<f64>);

fn panel((label, mesh, displacement, values): &Field) -> Panel {
    Panel {
        label: (*label).to_owned(),
        cells: cells(mesh, displacement, &|node| values[node]),
    }
}

/// Fields on deformed meshes that move, as an animated PNG of some milliseconds a frame: time in s and fields of each.
pub fn field_animation(
    title: &str,
    quantity: &str,
    frames: &[(f64, Vec<Field>)],
    milliseconds: u16,
) -> Vec<u8> {
    let frame = |(time, fields): &(f64, Vec<Field>)| Frame {
        time: *time,
        panels: fields.iter().map(panel).collect(),
    };
    let animation = Animation {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        colours: Colours::Sequential,
        frames: frames.iter().map(frame).collect(),
        milliseconds,
    };
    animation.png()
}

/// Fields on deformed meshes below each other on one colour scale.
pub fn field_figure(title: &str, quantity: &str, scale: Scale, fields: &[Field]) -> Vec<u8> {
    let figure = FieldFigure {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        scale,
        colours: Colours::Sequential,
        panels: fields.iter().map(panel).collect(),
    };
    figure.png()
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

/// One value a cell on a deformed mesh.
pub fn cell_figure(
    (title, quantity): (&str, &str),
    scale: Scale,
    mesh: &Mesh,
    displacement: &[f64],
    values: &[f64],
) -> Vec<u8> {
    let figure = FieldFigure {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        scale,
        colours: Colours::Sequential,
        panels: vec![Panel {
            label: mesh.describe(),
            cells: deformed(mesh, displacement, &|cell| values[cell]),
        }],
    };
    figure.png()
}

/// Deformed cells with the mean of their corners' values.
pub(super) fn cells(
    mesh: &Mesh,
    displacement: &[f64],
    value: &dyn Fn(usize) -> f64,
) -> Vec<FieldCell> {
    let mean = |cell: usize| {
        let corners = &mesh.cell(cell)[..mesh.shape(cell).corners()];
        let sum: f64 = corners.iter().map(|node| value(*node)).sum();
        sum / corners.len() as f64
    };
    deformed(mesh, displacement, &mean)
}

/// Deformed cells with their values.
pub(super) fn deformed(
    mesh: &Mesh,
    displacement: &[f64],
    value: &dyn Fn(usize) -> f64,
) -> Vec<FieldCell> {
    let place =
        |node: usize| [0, 1].map(|axis| mesh.nodes[node][axis] + displacement[2 * node + axis]);
    let cell = |cell: usize| {
        // A triangle is a quadrilateral whose last two corners are one.
        let last = mesh.shape(cell).corners() - 1;
        let corners: [usize; 4] = std::array::from_fn(|corner| mesh.cell(cell)[corner.min(last)]);
        (corners.map(place), value(cell))
    };
    (0..mesh.cell_count()).map(cell).collect()
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
