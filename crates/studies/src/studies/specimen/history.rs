//! The convergence of the models, their multipliers, and what runs along the path: deviations, stored and dissipated energy.

use super::problem::Specimen;
use super::results::models::Models;
use super::results::verdict::{Deviation, Measure};
use crate::corrector::Multipliers;
use crate::corrector::plate::{EQUILIBRIUM, FREE_EDGES, GRIPS};
use crate::corrector::specimen::SUPPORTS;
use crate::problem::Work;
use crate::results::{Array, Axis, Block, Drawing, Line, LineChart, Stroke, Table, or_dash};
use crate::studies::ModelKind;
use crate::units::decimals;

/// The deviations from the finite elements over the path, with a caption; `None` where there are none.
pub fn deviations_chart(
    specimen: &Specimen,
    models: &Models,
    deviations: &[Option<Deviation>],
) -> Option<(String, Drawing)> {
    let what = models.reference.measured.name();
    let measures = [
        ("displacement", Measure::Displacement, Stroke::Ringed),
        ("departure", Measure::Departure, Stroke::Marked),
        (what, Measure::Measured, Stroke::Marked),
    ];
    let kinds = [ModelKind::MassSpring, ModelKind::Corrected];
    let charts = measures.into_iter().filter_map(|(name, measure, stroke)| {
        let line = |kind: ModelKind| {
            let point = |(factor, deviation): (&f64, &Option<Deviation>)| {
                let distance = deviation.as_ref()?.of(kind)?;
                let value = distance.by(measure).filter(|value| *value > 0.0)?;
                Some([specimen.along.coordinate(*factor), value])
            };
            let points = specimen.factors.iter().zip(deviations).filter_map(point);
            let points: Vec<_> = points.collect();
            (!points.is_empty()).then(|| kind.style().line(points, stroke))
        };
        let lines: Vec<Line> = kinds.into_iter().filter_map(line).collect();
        let y = Axis::logarithmic(&format!("{name} [%]"));
        let title = format!("Deviation of the {name} from the finite elements");
        let chart = LineChart::new(title, specimen.along.head(), y, lines);
        (!chart.lines.is_empty()).then_some(chart)
    });
    let caption = format!(
        "Deviations from the finite elements over the {}.",
        specimen.along.name()
    );
    Some((caption, Drawing::charts(charts, 320)?))
}

/// The convergence at the last load factor that a model has reached, with a caption: the residual forces of springs and finite elements, and the
/// corrections of the corrected field, which are another quantity.
pub fn residuals_chart(specimen: &Specimen, models: &Models) -> Option<(String, Drawing)> {
    let last = models.reached().checked_sub(1)?;
    let at = specimen.describe_step(last);
    let line = |kind: &ModelKind| {
        let state = models.of(*kind).states.get(last)?;
        let residuals = state.convergence.residuals.iter().enumerate();
        let points = residuals.map(|(iteration, size)| [iteration as f64, *size]);
        let points: Vec<_> = points.collect();
        (!points.is_empty()).then(|| kind.style().line(points, Stroke::Marked))
    };
    let chart = |title: &str, quantity: &str, kinds: &[ModelKind]| {
        let lines: Vec<Line> = kinds.iter().filter_map(line).collect();
        let y = Axis::logarithmic(quantity);
        let title = format!("{title} at {at}");
        let chart = LineChart::new(title, "iteration", y, lines);
        (!chart.lines.is_empty()).then_some(chart)
    };
    let forces = [ModelKind::MassSpring, ModelKind::FiniteElement];
    let charts = [
        chart("Residual forces", "relative residual [–]", &forces),
        chart(
            "Corrections",
            "relative correction [–]",
            &[ModelKind::Corrected],
        ),
    ];
    let caption = format!(
        "Residual of springs and finite elements, and correction of the corrected field, over iteration at {at}."
    );
    let drawing = Drawing::charts(charts.into_iter().flatten(), 340)?;
    Some((caption, drawing))
}

/// The iterations of every model at every load factor, and their explanation.
pub fn convergence(specimen: &Specimen, models: &Models) -> Vec<Block> {
    let rows = (0..models.reached()).flat_map(|step| {
        let states = models.all().into_iter();
        states.filter_map(move |(model, solution)| Some((model, solution.states.get(step)?)))
    });
    let size = |residual: Option<&f64>| or_dash(residual.copied(), |size| format!("{size:.1e}"));
    let table = Table::of(rows)
        .column(specimen.along.head(), |(_, state)| {
            specimen.along.value(state.factor)
        })
        .column("model", |(model, _)| model.style().name.to_owned())
        .column("load steps", |(_, state)| state.load_steps.to_string())
        .column("iterations", |(_, state)| {
            state.convergence.iterations().to_string()
        })
        .column("first residual [–]", |(_, state)| {
            size(state.convergence.residuals.first())
        })
        .column("last residual [–]", |(_, state)| {
            size(state.convergence.residuals.last())
        })
        .column("steps cut", |(_, state)| {
            state.convergence.cut_steps.to_string()
        })
        .column("tangents shifted", |(_, state)| {
            state.convergence.shifted_steps.to_string()
        });
    let mut blocks = vec![
        Block::heading("Convergence"),
        table.block(),
        Block::Paragraph(format!(
            "Mass-spring and finite elements: largest residual force over the largest reaction. Corrector: {}",
            corrections_in_words(specimen)
        )),
    ];
    blocks.extend(climbs(specimen, models));
    blocks
}

/// An explanation of the residuals of the corrected field.
fn corrections_in_words(specimen: &Specimen) -> &'static str {
    let climbs = specimen
        .grids()
        .is_some_and(|grids| grids.correction.climb.is_some());
    if climbs {
        "the remaining correction, root mean square over the nodes of the finest grid, relative to the largest displacement; the first value is what \
         this grid adds to the one before it. The iteration (a climb) stops at a fraction (`climb_tolerance`) of its own discretisation error. It \
         starts from a field of its own on a coarse grid and uses the study's springs for the multipliers only."
    } else {
        "largest scaled residual relative to the largest displacement; it has as many equations as unknowns, so that each step is a Newton step, and \
         the first starts from the springs' field, to which the multipliers belong."
    }
}

/// The starts of the climb at every stretch; `None` without a climb.
fn climbs(specimen: &Specimen, models: &Models) -> Option<Block> {
    let climbs = models
        .on_lattice
        .correction
        .climbs
        .iter()
        .zip(&specimen.factors);
    let table = Table::of(climbs)
        .column(specimen.along.head(), |(_, stretch)| {
            specimen.along.value(**stretch)
        })
        .column("the climb began with", |(climb, _)| climb.to_string())
        .column(
            "root mean square distance of this start to the corrected field on the first grid [mm]",
            |(climb, _)| or_dash(Some(climb.away), |away| format!("{away:.3}")),
        );
    (!table.is_empty()).then(|| table.block())
}

/// The multipliers of every condition of the corrected field at the nodes; zero where the condition does not hold.
pub fn multipliers(models: &Models, step: usize) -> Vec<Array> {
    let size = 2 * models.on_lattice.corrected.mesh.nodes.len();
    let groups = models.on_lattice.correction.multipliers.get(step);
    let groups = groups.into_iter().flatten();
    groups
        .filter_map(|group| multiplier_array(group, size))
        .collect()
}

fn multiplier_array(group: &Multipliers, size: usize) -> Option<Array> {
    let name = match group.name.as_str() {
        EQUILIBRIUM => "multiplier_zeta_equilibrium_mm2_per_N",
        GRIPS => "multiplier_eta_grips_mm",
        SUPPORTS => "multiplier_eta_supports_mm",
        FREE_EDGES => "multiplier_eta_free_edges_mm2_per_N",
        _ => return None,
    };
    let mut values = vec![0.0; size];
    for (unknown, value) in group.unknowns.iter().flatten().zip(&group.values) {
        values[*unknown] = *value;
    }
    Some(Array::vectors(name, values))
}

/// A part of the work on the material with its name.
type Part = (&'static str, fn(Work) -> f64);

const PARTS: [Part; 2] = [
    ("stored", |work| work.stored),
    ("dissipated", |work| work.dissipated),
];

/// A table of all models at all load factors; nothing where the material has no memory.
pub fn work(specimen: &Specimen, models: &Models) -> Vec<Block> {
    if !specimen.problem.laws().soften() {
        return Vec::new();
    }
    let along = specimen.along;
    let mut table = Table::of(specimen.factors.iter().enumerate())
        .column(along.head(), |(_, factor)| along.value(**factor));
    for (what, part) in PARTS {
        for (kind, solution) in models.all() {
            let head = format!("{what}, {} [mJ]", kind.style().name);
            table = table.column(head, |(step, _)| {
                let work = solution.works.get(*step).copied().flatten();
                or_dash(work.map(part), |value| decimals(value, 4))
            });
        }
    }
    vec![
        Block::heading("Stored and dissipated energy"),
        table.block(),
        Block::paragraph(
            "The material softens at every point according to the largest load there so far (Mullins effect). The loads follow one another as the \
             study lists them, and the largest load is updated at these only. Dissipated work is not recovered.",
        ),
    ]
}
