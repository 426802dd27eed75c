//! Pictures and grids of a specimen.

use super::problem::Specimen;
use super::results::measured::Quantity;
use super::results::models::Models;
use crate::mesh::Mesh;
use crate::problem::{GroupState, Solution};
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING, MODELS};
use crate::results::{
    Array, Axis, Deformed, Drawing, FieldFigure, Figure, Grid, GridSeries, Line, LineChart, Panel,
    Stroke, from_rest, mesh_outlines, sheet_figures,
};
use crate::studies::pictures::Shown;

/// The largest load factor that most can be shown of: both corrected field and finite elements, or any model.
fn shown(models: &Models) -> Option<usize> {
    let corrected = models.on_lattice.corrected.reached();
    let both = models.reference.reached().min(corrected);
    let shown = if both > 0 { both } else { models.reached() };
    shown.checked_sub(1)
}

/// Pictures of the largest load factor of which most can be shown; `expected` are the finite elements' displacements at
/// the nodes of springs and corrected field.
pub fn figures(specimen: &Specimen, models: &Models, expected: &[Vec<Vec<f64>>; 2]) -> Vec<Figure> {
    let lattice = &models.on_lattice.springs.mesh;
    let figure = |what: &str, caption: String, drawing| {
        Figure::new(format!("{}_{what}.png", specimen.name), caption, drawing)
    };
    let cells = mesh_outlines("Lattice", lattice);
    let mesh = figure("mesh", "The cells of the lattice.".into(), cells);
    let Some(step) = shown(models) else {
        return vec![mesh];
    };
    let at = format!("load factor {}", specimen.factors[step]);
    let named = models.named();
    let fields = |models: usize| {
        named[..models].iter().filter_map(|model| {
            let u = model.solution.displacement(step)?;
            Some((model.name, &model.solution.mesh, u))
        })
    };
    let size = |(name, mesh, u): (&str, &Mesh, &[f64])| {
        Panel::at_nodes(name, mesh, u, &|node| u[2 * node].hypot(u[2 * node + 1]))
    };
    let title = format!("Displacement at {at}");
    let caption = format!("{title}, on one colour scale.");
    let displacement = FieldFigure::new(title, "displacement [mm]", fields(3).map(size));
    let mut figures = vec![figure("displacement", caption, displacement.into())];
    figures.extend(stress_figures(specimen, models, step));
    let compared = named.iter().zip(expected);
    let compared = compared.filter_map(|(model, expected)| {
        let u = model.solution.displacement(step)?;
        let v = expected.get(step)?;
        Some(Panel::distance(model.name, &model.solution.mesh, u, v))
    });
    let distances: Vec<Panel> = compared.collect();
    if !distances.is_empty() {
        let title = format!("Distance to the finite elements at {at}");
        let caption = format!("{title}.");
        let distance = FieldFigure::new(title, "distance [mm]", distances).logarithmic();
        figures.push(figure("error", caption, distance.into()));
    }
    figures.extend(displacement_over_factors(specimen, models).map(|drawing| {
        let what = models.reference.measured.describe();
        let caption = format!("Over the load factor: {what}; computed at the markers only.");
        figure("displacement_over_load", caption, drawing)
    }));
    figures.extend(forces(specimen, models).map(|drawing| {
        let caption = "Forces of the supports over the load factor: of each group along the axis of its larger force; computed at the markers only.";
        figure("forces", caption.into(), drawing)
    }));
    figures.push(mesh);
    figures.extend(estimated_error(models, step, &at).map(|drawing| {
        let caption = format!(
            "Estimated error of every finite element at {at}, in % of the solution's energy norm."
        );
        figure("estimated_error", caption, drawing.into())
    }));
    figures
}

/// Stresses and strains at the load factors that the study chooses, else at the last one.
fn stress_figures(specimen: &Specimen, models: &Models, last: usize) -> Vec<Figure> {
    let pictures = &specimen.pictures;
    let named = models.named();
    let at_step = |step: usize| {
        let deformed = named.iter().filter_map(|model| {
            let u = model.solution.displacement(step)?;
            let mut fields = model.solution.past(step);
            fields.push(u);
            Some(Deformed::elastic(model.name, &model.solution.mesh, fields))
        });
        let deformed: Vec<_> = deformed.collect();
        let number = match pictures.shown {
            Shown::Last => String::new(),
            Shown::All | Shown::At(_) => format!("_{:03}", step + 1),
        };
        let at = format!("load factor {}", specimen.factors[step]);
        let file = |field: &str| format!("{}_{field}{number}.png", specimen.name);
        sheet_figures(
            &pictures.fields,
            specimen.sheet().law,
            &deformed,
            &at,
            &file,
        )
    };
    let steps = pictures.shown.steps(&specimen.factors, Some(last));
    steps.into_iter().flat_map(at_step).collect()
}

/// Forces below this share of the largest are those of supports that carry nothing.
const NO_FORCE: f64 = 1e-6;

/// What the groups do in each state of one of the three models, over the load factor, beginning at rest.
fn over_factors(
    specimen: &Specimen,
    models: &Models,
    model: usize,
    value: impl Fn(&[GroupState]) -> f64,
) -> Vec<[f64; 2]> {
    let steps = specimen.factors.iter().enumerate();
    let named = models.named();
    let values = steps.filter_map(|(step, factor)| {
        let groups = named[model].solution.groups(step)?;
        Some([*factor, value(groups)])
    });
    from_rest(values)
}

/// A chart of the three models over the load factor.
fn chart_over_factors(
    title: String,
    y: &str,
    points: impl Fn(usize) -> Vec<[f64; 2]>,
) -> LineChart {
    const STROKES: [Stroke; 3] = [Stroke::Marked, Stroke::Ringed, Stroke::Marked];
    let line = |model: usize| {
        let points = points(model);
        let (style, stroke) = (MODELS[model], STROKES[model]);
        (points.len() > 1).then(|| Line::new(style.name, points, style.colour, stroke))
    };
    let lines = [2, 0, 1].into_iter().filter_map(line).collect();
    let x = Axis::linear("load factor [–]");
    LineChart::new(title, x, Axis::linear(y), lines)
}

/// The displacement that is measured over the load factor; `None` where it is a force.
fn displacement_over_factors(specimen: &Specimen, models: &Models) -> Option<Drawing> {
    let measured = &models.reference.measured;
    (measured.quantity == Quantity::Displacement).then(|| {
        let title = format!("Displacement of {}", measured.group);
        let y = format!("displacement along {} [mm]", measured.axis_name());
        let chart = chart_over_factors(title, &y, |model| {
            over_factors(specimen, models, model, |groups| measured.of(groups))
        });
        Drawing::Charts(vec![(chart, 340)])
    })
}

/// The forces of all groups that carry one, over the load factor; `None` where there is none.
fn forces(specimen: &Specimen, models: &Models) -> Option<Drawing> {
    let points = |model: usize, group: usize, axis: usize| {
        over_factors(specimen, models, model, |groups| groups[group].force[axis])
    };
    let largest = |group: usize, axis: usize| {
        let all = (0..3).flat_map(|model| points(model, group, axis));
        all.fold(0.0, |most: f64, point| most.max(point[1].abs()))
    };
    let groups = specimen.groups();
    let axes: Vec<(usize, f64)> = (0..groups.len())
        .map(|group| [largest(group, 0), largest(group, 1)])
        .map(|[x, y]| if y > x { (1, y) } else { (0, x) })
        .collect();
    let most = axes
        .iter()
        .fold(0.0, |most: f64, (_, force)| most.max(*force));
    let carrying = axes.into_iter().enumerate();
    let carrying = carrying.filter(|(_, (_, force))| *force > NO_FORCE * most);
    let chart = |(group, (axis, _)): (usize, (usize, f64))| {
        let y = format!("force along {} [N]", ["x", "y"][axis]);
        let title = format!("Force of {}", groups[group]);
        let lines = |model: usize| points(model, group, axis);
        (chart_over_factors(title, &y, lines), 340)
    };
    let charts: Vec<_> = carrying.map(chart).collect();
    (!charts.is_empty()).then_some(Drawing::Charts(charts))
}

fn estimated_error(models: &Models, step: usize, at: &str) -> Option<FieldFigure> {
    let reference = &models.reference;
    let energy = &reference.estimates.get(step)?.as_ref()?.energy;
    let displacement = &reference.finest.states.get(step)?.displacement;
    Some(FieldFigure::estimated_error(
        at,
        &reference.finest.mesh,
        displacement,
        energy,
    ))
}

/// The fields of each model, as far as it goes; `expected` are the finite elements' displacements at the nodes of springs and
/// corrected field.
pub fn grids(
    specimen: &Specimen,
    models: &Models,
    expected: &[Vec<Vec<f64>>; 2],
) -> Vec<GridSeries> {
    let (on_lattice, reference) = (&models.on_lattice, &models.reference);
    let field = |solution: &Solution, step: usize| {
        let (past, u) = (solution.past(step), &solution.states[step].displacement);
        Grid::sheet(specimen.sheet().after(&past), &solution.mesh, u)
    };
    let series = |name: &str, reached: usize, grid: &dyn Fn(usize) -> Grid| {
        let steps = specimen.factors.iter().take(reached).enumerate();
        let steps = steps.map(|(step, factor)| (*factor, grid(step)));
        (reached > 0).then(|| GridSeries::steps(name, steps))
    };
    let (uncorrected, corrected) = (&on_lattice.uncorrected, &on_lattice.corrected);
    let compared = |name, model: &Solution, expected: &[Vec<f64>]| {
        series(name, model.reached(), &|step| {
            let u = &model.states[step].displacement;
            let difference = expected.get(step).map(|v| Array::to_finite_elements(u, v));
            field(model, step).with(difference)
        })
    };
    let springs = series("springs", uncorrected.reached(), &|step| {
        let state = &uncorrected.states[step];
        Grid::springs(&on_lattice.springs, &state.displacement, &state.history)
    });
    let elements = series(FINITE_ELEMENTS.key, reference.reached(), &|step| {
        let error = reference.estimates[step].as_ref();
        let error = error.map(|estimate| Array::estimated_error(&estimate.energy));
        field(&reference.finest, step).with_in_cells(error)
    });
    let all = [
        compared(MASS_SPRING.key, uncorrected, &expected[0]),
        compared(CORRECTED.key, corrected, &expected[1]),
        springs,
        elements,
    ];
    all.into_iter().flatten().collect()
}
