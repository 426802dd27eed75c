//! Pictures, grids and tables of a motion.

use super::between::{PARTS, with_cubics};
use super::problem::MovingSheet;
use super::solution::{ModelMotion, Motions};
use crate::dynamics::{EnergyBalance, Instant};
use crate::mesh::vectors;
use crate::results::models::CORRECTED;
use crate::results::{
    Animation, Content, Drawing, FieldFigure, Figure, Frame, Grid, GridSeries, Line, LineChart,
    PALETTE, Panel, Stroke, Table, springs_csv,
};
use crate::studies::points::Probe;
use crate::studies::series::{ModelSeries, larger_axis, stress_figures};
use crate::studies::{ModelKind, SPRINGS_TABLE};
use crate::units::brief;

/// The strokes of springs and finite elements.
const STROKES: [Stroke; 2] = [Stroke::Dashed, Stroke::Solid];

/// Two charts of the same height, one below the other.
fn pair(upper: LineChart, lower: LineChart) -> Drawing {
    const HEIGHT: u32 = 380;
    Drawing::Charts(vec![(upper, HEIGHT), (lower, HEIGHT)])
}

/// A line for each model through pairs of figures of all instants.
fn lines(models: [&ModelMotion; 2], points: impl Fn(&ModelMotion) -> Vec<[f64; 2]>) -> Vec<Line> {
    let models = models.into_iter().zip(STROKES);
    models
        .map(|(model, stroke)| model.kind.style().line(points(model), stroke))
        .collect()
}

impl Motions {
    /// The axis along which the finite elements are displaced farther.
    pub fn axis(&self) -> usize {
        let instants = self.elements.instants().iter();
        larger_axis(instants.flat_map(|now| vectors(&now.displacement)))
    }
}

impl ModelMotion {
    /// Pairs of figures of all instants.
    fn points(&self, pair: impl Fn(&Instant) -> [f64; 2]) -> Vec<[f64; 2]> {
        self.instants().iter().map(pair).collect()
    }

    /// Time, displacement and velocity of a probe along an axis, at the instants and between them.
    fn course(&self, probe: &Probe, axis: usize) -> Vec<[f64; 3]> {
        let instants = self.instants().iter().map(|now| {
            let [displacement, velocity] =
                [&now.displacement, &now.velocity].map(|field| self.at(field, probe)[axis]);
            [now.time, displacement, velocity]
        });
        with_cubics(&instants.collect::<Vec<_>>())
    }

    fn at(&self, values: &[f64], probe: &Probe) -> [f64; 2] {
        self.mesh.displacement_at(values, probe.at)
    }
}

/// Displacement of the probes, phase of the first, energies, force of the measured group, and the sheets at the end.
pub fn figures(sheet: &MovingSheet, motions: &Motions, series: &[ModelSeries]) -> Vec<Figure> {
    let Motions {
        springs, elements, ..
    } = motions;
    // The instants of all sheets.
    let count = common_instants(series);
    let instants = &springs.history.times()[..count];
    let axis = motions.axis();
    let along = ["x", "y"][axis];
    let sheets = displaced(series, count.saturating_sub(1), axis);
    let until = brief(instants.last().copied().unwrap_or_default());
    let sheets = FieldFigure::new(format!("Sheets at t = {until} s"), ALONG[axis], sheets);
    let file = |what: &str| format!("{}_{what}.png", sheet.specimen.name);
    let mut figures = Vec::new();
    if !sheet.probes.is_empty() {
        figures.push(Figure::new(
            file("probes"),
            format!("Displacement of the probes along {along}."),
            probes(sheet, motions, axis),
        ));
    }
    figures.extend([
        Figure::new(
            file("energy"),
            "Energies over time: springs above, finite elements below.",
            pair(energy(springs), energy(elements)),
        ),
        Figure::new(
            file("sheets"),
            format!("The sheets at the last instant of all models, with their displacement along {along}."),
            sheets,
        ),
    ]);
    let pictures = &sheet.specimen.pictures;
    figures.extend(
        pictures
            .shown
            .instants(instants)
            .into_iter()
            .flat_map(|instant| {
                let at = format!("t = {} s", brief(instants[instant]));
                let file = |field: &str| file(&format!("{field}_{:05}", instant + 1));
                stress_figures(&sheet.specimen, series, instant, &at, &file)
            }),
    );
    figures.extend(force_figure(sheet, motions, file("force")));
    figures.extend(sheet.probes.first().map(|probe| {
        let caption = format!(
            "Velocity over displacement of the first probe along {along}, springs above, finite elements below; later parts of the motion are \
             darker."
        );
        let charts = pair(phase(springs, probe, axis), phase(elements, probe, axis));
        Figure::new(file("phase"), caption, charts)
    }));
    figures
}

/// The force of the measured group over time and over its displacement; `None` where no support holds it.
fn force_figure(sheet: &MovingSheet, motions: &Motions, file: String) -> Option<Figure> {
    let axis = sheet.measured_axis(&motions.elements)?;
    if sheet.drive.release == Some(0.0) {
        return None; // The group is free in the whole motion.
    }
    let along = ["x", "y"][axis];
    let name = sheet.measured_name();
    let moved = sheet.larger_axis(&motions.elements, |state| state.displacement);
    let title = format!("Force of the {}", name.replace('`', ""));
    let chart_of = |label: &str, lines| LineChart::new(&title, label, "force [N]", lines);
    let models = motions.models();
    let in_time = |model: &ModelMotion| {
        let instants = model.instants().iter().zip(&model.groups);
        instants
            .map(|(now, group)| [now.time, group.force[axis]])
            .collect::<Vec<_>>()
    };
    let mut over_time = lines(models, in_time);
    let corrected = motions.correction.motion.as_ref().map(in_time);
    over_time.extend(corrected.map(|points| CORRECTED.line(points, Stroke::Points)));
    let over_displacement = lines(models, |model| {
        let groups = model.groups.iter();
        groups
            .map(|group| [group.displacement[moved], group.force[axis]])
            .collect()
    });
    let label = format!("displacement along {} [mm]", ["x", "y"][moved]);
    let charts = pair(
        chart_of("time [s]", over_time),
        chart_of(&label, over_displacement),
    );
    let caption = format!("Force of the {name} along {along} over its displacement and over time.");
    Some(Figure::new(file, &caption, charts))
}

/// Velocity over displacement of a probe, part of the motion after part.
fn phase(model: &ModelMotion, probe: &Probe, axis: usize) -> LineChart {
    const SHADES: [[u8; 3]; 4] = [[253, 174, 107], [230, 109, 59], [166, 54, 3], [60, 20, 0]];
    let points = model.course(probe, axis);
    // Each part ends with an instant that is kept.
    let instants = (points.len() / PARTS).div_ceil(SHADES.len()).max(1);
    let length = PARTS * instants;
    let starts = (0..points.len().saturating_sub(1)).step_by(length);
    let lines = starts.zip(SHADES).map(|(start, colour)| {
        // Each part begins where the one before ends.
        let end = (start + length).min(points.len() - 1);
        let [from, to] = [start, end].map(|point| brief(points[point][0]));
        let label = format!("{from} – {to} s");
        Line::new(
            label,
            points[start..=end].iter().map(|[_, x, v]| [*x, *v]),
            colour,
            Stroke::Thin,
        )
    });
    let title = format!(
        "Phase of the probe {}, {}",
        probe.name,
        model.kind.style().name
    );
    LineChart::new(
        &title,
        "displacement [mm]",
        "velocity [mm/s]",
        lines.collect(),
    )
}

/// How many instants of the corrected motion are marked on a curve: more of them would hide the line that they are on.
const MARKERS: usize = 60;

fn probes(sheet: &MovingSheet, motions: &Motions, axis: usize) -> LineChart {
    let mut lines = Vec::new();
    for (probe, colour) in sheet.probes.iter().zip(PALETTE.into_iter().cycle()) {
        lines.extend(motions.correction.motion.as_ref().map(|corrected| {
            let points =
                corrected.points(|now| [now.time, corrected.at(&now.displacement, probe)[axis]]);
            let points = points.iter().step_by(points.len().div_ceil(MARKERS).max(1));
            let points: Vec<[f64; 2]> = points.copied().collect();
            let label = format!("{}, corrected", probe.name);
            Line::new(label, points, colour, Stroke::Points)
        }));
        let models = motions.models().into_iter().zip(STROKES);
        lines.extend(models.map(|(model, stroke)| {
            let points = model
                .course(probe, axis)
                .into_iter()
                .map(|[time, x, _]| [time, x]);
            let label = format!("{}, {}", probe.name, model.kind.style().name);
            Line::new(label, points, colour, stroke)
        }));
    }
    LineChart::new("Displacement of the probes", "time [s]", ALONG[axis], lines)
}

fn energy(model: &ModelMotion) -> LineChart {
    type Part = fn(&EnergyBalance) -> f64;
    let parts: [(_, Part); 5] = [
        ("kinetic", |energy| energy.kinetic),
        ("stored", |energy| energy.stored),
        ("viscous work", |energy| energy.viscous_work),
        ("work of grips and loads", |energy| energy.external_work),
        ("balance", EnergyBalance::total),
    ];
    let lines = parts.iter().zip(PALETTE).map(|((name, part), colour)| {
        let points = model.points(|now| [now.time, part(&now.energy)]);
        Line::new(*name, points, colour, Stroke::Solid)
    });
    let title = format!("Energies of the {}", model.kind.style().in_words());
    LineChart::new(&title, "time [s]", "energy [mJ]", lines.collect())
}

/// The quantity that the pictures of the sheets show, by its axis.
const ALONG: [&str; 2] = ["displacement along x [mm]", "displacement along y [mm]"];

/// How many instants all models have.
fn common_instants(series: &[ModelSeries]) -> usize {
    let counts = series.iter().map(|model| model.states.len());
    counts.min().unwrap_or(0)
}

/// The sheets at an instant, with their displacement along an axis.
fn displaced(series: &[ModelSeries], instant: usize, axis: usize) -> Vec<Panel> {
    let panel = |model: &ModelSeries| model.panel(instant, |displacement| displacement[axis]);
    series.iter().filter_map(panel).collect()
}

/// The sheets in motion: a picture that plays in every browser.
pub fn animation(times: &[f64], series: &[ModelSeries], axis: usize) -> Animation {
    const FRAMES: usize = 60;
    const MILLISECONDS: u16 = 80;
    let every = times.len().div_ceil(FRAMES).max(1);
    let instants = (0..common_instants(series)).step_by(every);
    let frame = |instant: usize| Frame {
        time: times[instant],
        panels: displaced(series, instant, axis),
    };
    Animation {
        title: "Sheets in motion".into(),
        quantity: ALONG[axis].into(),
        frames: instants.map(frame).collect(),
        milliseconds: MILLISECONDS,
    }
}

/// The fields of each model and of the corrected motion, and the springs at the last instant.
pub fn grids(sheet: &MovingSheet, motions: &Motions, series: &[ModelSeries]) -> Vec<GridSeries> {
    let of_model = |model: &ModelSeries| {
        let states = model.states.iter().enumerate();
        let grids =
            states.map(|(instant, state)| (state.at, model.grid(sheet.specimen.sheet(), instant)));
        GridSeries::instants(model.kind.style().key, grids)
    };
    let mut all: Vec<GridSeries> = series.iter().map(of_model).collect();
    let last = motions.springs.instants().last();
    all.extend(last.map(|now| {
        let grid = Grid::springs(&sheet.lattice(), &now.displacement, &[]);
        GridSeries::single("springs_end", grid)
    }));
    all
}

/// The springs at the last instant, with the forces of their stretch alone; `None` where there is none.
pub fn springs_table(sheet: &MovingSheet, motions: &Motions) -> Option<(String, Content)> {
    let now = motions.springs.instants().last()?;
    let text = springs_csv(&sheet.lattice(), &now.displacement, &[]);
    Some((SPRINGS_TABLE.to_owned(), Content::Text(text)))
}

/// Probes, energies and the measured group's force over time, one table for each model.
pub fn tables(sheet: &MovingSheet, motions: &Motions) -> Vec<(String, Content)> {
    let of_model = |model: &&ModelMotion| {
        let text = of_model(sheet, model).csv();
        let name = format!("motion_{}.csv", model.kind.style().key);
        (name, Content::Text(text))
    };
    motions.all().iter().map(of_model).collect()
}

/// A table with a row for each instant. `gelbench identify` reads one with the columns `extension` and `force`.
fn of_model<'a>(sheet: &MovingSheet, model: &'a ModelMotion) -> Table<(&'a Instant, [f64; 2])> {
    type Column = fn(&Instant) -> f64;
    const ENERGIES: [(&str, Column); 4] = [
        ("kinetic energy [mJ]", |now| now.energy.kinetic),
        ("stored energy [mJ]", |now| now.energy.stored),
        ("viscous work [mJ]", |now| now.energy.viscous_work),
        ("external work [mJ]", |now| now.energy.external_work),
    ];
    type Field = fn(&Instant) -> &Vec<f64>;
    const FIELDS: [(&str, &str, Field); 2] = [
        ("displacement", "mm", |now| &now.displacement),
        ("velocity", "mm/s", |now| &now.velocity),
    ];
    let forces = sheet.measured_forces(model);
    let [has_energies, has_forces] = [model.kind != ModelKind::Corrected, !forces.is_empty()];
    let forces = forces.into_iter().chain(std::iter::repeat([0.0; 2]));
    let mut table = Table::of(model.instants().iter().zip(forces));
    table = table.column("time [s]", |(now, _)| now.time.to_string());
    for (head, energy) in ENERGIES {
        table = table.column_if(has_energies, head, |(now, _)| written(energy(now)));
    }
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let head = format!("grip force {name} [N]");
        table = table.column_if(has_forces, head, |(_, force)| written(force[axis]));
    }
    for probe in &sheet.probes {
        for (axis, direction) in ["x", "y"].into_iter().enumerate() {
            for (what, unit, field) in FIELDS {
                let head = format!("{} {what} {direction} [{unit}]", probe.name);
                table = table.column(head, |(now, _)| written(model.at(field(now), probe)[axis]));
            }
        }
    }
    table
}

/// A number with all its digits; small ones with an exponent.
fn written(value: f64) -> String {
    match value {
        small if small != 0.0 && small.abs() < 1e-5 => format!("{small:e}"),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_table_are_read_back() {
        for value in [0.0, 0.5, 2.5, -1e-7, 3.2e-5, -12345.678, 1e-300] {
            assert_eq!(written(value).parse::<f64>(), Ok(value));
        }
    }
}
