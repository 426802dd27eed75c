//! Pictures and grids of a specimen.

use super::forces;
use super::history;
use super::measured_fields::MeasuredFields;
use super::problem::Specimen;
use super::results::measured::Quantity;
use super::results::models::Models;
use super::results::verdict::Deviation;
use crate::problem::GroupState;
use crate::results::{
    Array, Content, Drawing, FieldFigure, Figure, Grid, GridSeries, LineChart, Panel, SheetField,
    Stroke, from_rest, material_chart, mesh_outlines, springs_csv,
};
use crate::statistics::farthest;
use crate::studies::pictures::Shown;
use crate::studies::series::{DRAWN, ModelSeries, stress_figures};
use crate::studies::{ModelKind, SPRINGS_TABLE};

/// The last step that both the corrected field and the finite elements have reached, or else any model.
fn last_shown(models: &Models) -> Option<usize> {
    let reached = |kind| models.of(kind).reached();
    let both = reached(ModelKind::FiniteElement).min(reached(ModelKind::Corrected));
    let shown = if both > 0 { both } else { models.reached() };
    shown.checked_sub(1)
}

/// All pictures: fields at the load factors that the study chooses, then what runs along the path.
pub fn figures(
    specimen: &Specimen,
    models: &Models,
    deviations: &[Option<Deviation>],
    measured: &MeasuredFields,
) -> Vec<Figure> {
    let figure = |what: &str, caption: String, drawing| {
        Figure::new(format!("{}_{what}.png", specimen.name), caption, drawing)
    };
    let last = last_shown(models);
    let steps = specimen.pictures.shown.steps(&specimen.factors, last);
    let mut figures: Vec<Figure> = steps
        .iter()
        .flat_map(|step| fields(specimen, models, *step))
        .collect();
    figures.extend(displacement_over_factors(specimen, models).map(|drawing| {
        let what = models.reference.measured.describe();
        let caption = format!(
            "Over the {}: {what}; computed at the markers only.",
            specimen.along.name()
        );
        figure("displacement_over_load", caption, drawing)
    }));
    figures.extend(forces_over_factors(specimen, models).map(|drawing| {
        let caption = format!(
            "Forces of the supports over the {}: of each group along the axis of its larger force; computed at the markers only.",
            specimen.along.name()
        );
        figure("forces", caption, drawing)
    }));
    let charts = [
        (
            "errors",
            history::deviations_chart(specimen, models, deviations),
        ),
        ("residuals", history::residuals_chart(specimen, models)),
    ];
    for (what, chart) in charts {
        figures.extend(chart.map(|(caption, drawing)| figure(what, caption, drawing)));
    }
    figures.extend(measured.curve());
    figures.extend(measured.figures(&steps));
    let lattice = &models.on_lattice.springs.mesh;
    let cells = mesh_outlines("Lattice", lattice);
    figures.push(figure("mesh", "The cells of the lattice.".into(), cells));
    let errors = steps.iter();
    figures.extend(errors.filter_map(|step| estimated_error(specimen, models, *step)));
    figures.push(materials(specimen, &figure));
    figures
}

/// The curves of the card, or of the card of each region.
fn materials(specimen: &Specimen, figure: &dyn Fn(&str, String, Drawing) -> Figure) -> Figure {
    let regions = specimen.numbered_regions().into_iter();
    let charts = regions.map(|(_, name, card)| {
        let mut chart = material_chart(card);
        chart.title = format!("{name}: {}", chart.title);
        chart
    });
    let (caption, drawing) = match Drawing::charts(charts, 400) {
        Some(drawing) => (
            "The materials of the regions: nominal stress over stretch.",
            drawing,
        ),
        None => (
            "The material: nominal stress over stretch.",
            material_chart(&specimen.card).into(),
        ),
    };
    figure("material", caption.to_owned(), drawing)
}

/// The fields of all models at one load factor: displacement, stresses and strains, distance to the finite elements.
fn fields(specimen: &Specimen, models: &Models, step: usize) -> Vec<Figure> {
    let file = |field: &str| file(specimen, field, step);
    let at = specimen.describe_step(step);
    let mut series: Vec<ModelSeries> = models.all_series().into();
    series.retain(|model| specimen.pictures.models.contains(&model.kind));
    let mut figures = Vec::new();
    if !specimen
        .pictures
        .fields
        .fields
        .contains(&SheetField::Displacement)
    {
        let name = file("displacement");
        figures.push(displacement(specimen, &series, step, &at, name));
    }
    figures.extend(stress_figures(specimen, &series, step, &at, &file));
    let distance = |model: &ModelSeries| {
        let state = model.states.get(step)?;
        let (name, u, v) = (model.kind.style().name, state.displacement, state.expected?);
        Some(Panel::distance(name, model.mesh, u, v))
    };
    let distances: Vec<Panel> = series.iter().filter_map(distance).collect();
    if !distances.is_empty() {
        let title = format!("Distance to the finite elements at {at}");
        let caption = format!("{title}.");
        let distance = FieldFigure::new(title, "distance [mm]", distances).logarithmic();
        figures.push(Figure::new(file("error"), caption, distance));
    }
    figures
}

/// The name of the picture of a field at a load factor, which has a number where several may be shown.
fn file(specimen: &Specimen, field: &str, step: usize) -> String {
    let number = match specimen.pictures.shown {
        Shown::Last => String::new(),
        Shown::All | Shown::At(_) => format!("_{:03}", step + 1),
    };
    format!("{}_{field}{number}.png", specimen.name)
}

/// The displacement of all models on one colour scale; of a plate the transverse one, in which the models differ.
fn displacement(
    specimen: &Specimen,
    series: &[ModelSeries],
    step: usize,
    at: &str,
    file: String,
) -> Figure {
    let is_plate = specimen.grids().is_some();
    let quantity = if is_plate {
        "transverse displacement"
    } else {
        "displacement"
    };
    let value = |[ux, uy]: [f64; 2]| if is_plate { uy } else { ux.hypot(uy) };
    let panels = series.iter().filter_map(|model| model.panel(step, value));
    let title = format!("Displacement at {at}");
    let caption = format!("The {quantity} at {at}, on one colour scale.");
    let drawing = FieldFigure::new(title, format!("{quantity} [mm]"), panels);
    Figure::new(file, caption, drawing)
}

/// Forces below this share of the largest are those of supports that carry nothing.
const NO_FORCE: f64 = 1e-6;

/// What the groups do in each state of one of the models, over the load factor, beginning at rest.
fn over_factors(
    specimen: &Specimen,
    model: &ModelSeries,
    value: impl Fn(&[GroupState]) -> f64,
) -> Vec<[f64; 2]> {
    let states = model.states.iter();
    from_rest(states.map(|state| [specimen.along.coordinate(state.at), value(state.groups)]))
}

/// A chart of the models over the load factor.
fn chart_over_factors(
    specimen: &Specimen,
    models: &Models,
    title: String,
    y: &str,
    value: impl Fn(&[GroupState]) -> f64,
) -> LineChart {
    let line = |(kind, stroke): (ModelKind, Stroke)| {
        let model = models.series(kind);
        let points = over_factors(specimen, &model, &value);
        (points.len() > 1).then(|| model.kind.style().line(points, stroke))
    };
    let lines = DRAWN.into_iter().filter_map(line).collect();
    LineChart::new(title, specimen.along.head(), y, lines)
}

/// The displacement that is measured over the load factor; `None` where it is a force.
fn displacement_over_factors(specimen: &Specimen, models: &Models) -> Option<Drawing> {
    let measured = &models.reference.measured;
    let chart = (measured.quantity == Quantity::Displacement).then(|| {
        let title = format!("Displacement of {}", measured.group);
        let y = format!("displacement along {} [mm]", measured.axis_name());
        let value = |groups: &[GroupState]| measured.of(groups);
        chart_over_factors(specimen, models, title, &y, value)
    });
    Drawing::charts(chart, 340)
}

/// The forces of all groups that carry one, over the load factor; `None` where there is none.
fn forces_over_factors(specimen: &Specimen, models: &Models) -> Option<Drawing> {
    let largest = |group: usize, axis: usize| {
        let force = |groups: &[GroupState]| groups[group].force[axis];
        let series = models.all_series();
        let points = series.iter();
        let points = points.flat_map(|model| over_factors(specimen, model, force));
        farthest(points.map(|point| point[1])).abs()
    };
    let groups = specimen.groups();
    let axes: Vec<(usize, f64)> = (0..groups.len())
        .map(|group| [largest(group, 0), largest(group, 1)])
        .map(|[x, y]| if y > x { (1, y) } else { (0, x) })
        .collect();
    let most = farthest(axes.iter().map(|(_, force)| *force));
    let carrying = axes.into_iter().enumerate();
    let carrying = carrying.filter(|(_, (_, force))| *force > NO_FORCE * most);
    let chart = |(group, (axis, _)): (usize, (usize, f64))| {
        let y = format!("force along {} [N]", ["x", "y"][axis]);
        let title = format!("Force of {}", groups[group]);
        let force = |groups: &[GroupState]| groups[group].force[axis];
        chart_over_factors(specimen, models, title, &y, force)
    };
    Drawing::charts(carrying.map(chart), 340)
}

fn estimated_error(specimen: &Specimen, models: &Models, step: usize) -> Option<Figure> {
    let reference = &models.reference;
    let energy = &reference.estimates.get(step)?.as_ref()?.energy;
    let displacement = &reference.finest.states.get(step)?.displacement;
    let at = specimen.describe_step(step);
    let mesh = &reference.finest.mesh;
    let drawing = FieldFigure::estimated_error(&at, mesh, displacement, energy);
    let caption = format!(
        "Estimated error of every finite element at {at}, in % of the solution's energy norm."
    );
    let name = file(specimen, "estimated_error", step);
    Some(Figure::new(name, caption, drawing))
}

/// The fields of each model at the load factors that it reached.
pub fn grids(specimen: &Specimen, models: &Models) -> Vec<GridSeries> {
    let springs = models.of(ModelKind::MassSpring).states.iter();
    let springs = springs.map(|state| {
        let lattice = &models.on_lattice.springs;
        let grid = Grid::springs(lattice, &state.displacement, &state.history);
        (state.factor, grid)
    });
    let springs = GridSeries::steps("springs", springs);
    let of_model = |model: &ModelSeries| {
        let grid = |step: usize| (model.states[step].at, grid(specimen, models, model, step));
        GridSeries::steps(model.kind.style().key, (0..model.states.len()).map(grid))
    };
    let mut all: Vec<GridSeries> = models.all_series().iter().map(of_model).collect();
    all.insert(1, springs);
    all.retain(|series| !series.grids.is_empty());
    all
}

/// The tables for other programs.
pub fn tables(specimen: &Specimen, models: &Models) -> Vec<(String, Content)> {
    let forces = Content::Text(forces::csv(specimen, models));
    let forces = ("forces.csv".to_owned(), forces);
    [forces].into_iter().chain(springs_table(models)).collect()
}

/// The springs at the last load factor that they reach; `None` where they have no field.
fn springs_table(models: &Models) -> Option<(String, Content)> {
    let state = models.of(ModelKind::MassSpring).states.last()?;
    let springs = &models.on_lattice.springs;
    let text = springs_csv(springs, &state.displacement, &state.history);
    Some((SPRINGS_TABLE.to_owned(), Content::Text(text)))
}

/// The fields of a model at one load factor.
fn grid(specimen: &Specimen, models: &Models, model: &ModelSeries, step: usize) -> Grid {
    let grid = model.grid(specimen.sheet(), step);
    match model.kind {
        ModelKind::MassSpring => grid,
        ModelKind::Corrected => grid.with(history::multipliers(models, step)),
        ModelKind::FiniteElement => {
            let estimates = &models.reference.estimates;
            let error = estimates.get(step).and_then(Option::as_ref);
            grid.with_in_cells(error.map(|estimate| Array::estimated_error(&estimate.energy)))
        }
    }
}
