//! Pictures, grids and tables of a motion.

use super::between::{PARTS, with_cubics};
use super::corrected::CorrectedInstants;
use super::plates::PlateMotion;
use super::problem::{MovingPlate, Probe};
use super::solution::ModelMotion;
use crate::dynamics::{EnergyBalance, Instant};
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING, ModelStyle};
use crate::results::{
    Animation, Array, Axis, Content, Deformed, Drawing, FieldFigure, Figure, Frame, Grid,
    GridSeries, Line, LineChart, PALETTE, Panel, Series, Sheet, Stroke, csv, sheet_figures,
};
use crate::units::number;

/// How a model's lines are drawn.
const STROKES: [Stroke; 2] = [Stroke::Dashed, Stroke::Solid];
/// The styles of springs and finite elements.
const STYLES: [ModelStyle; 2] = [MASS_SPRING, FINITE_ELEMENTS];

fn chart(title: &str, x: &str, y: &str, lines: Vec<Line>) -> LineChart {
    LineChart::new(title, Axis::linear(x), Axis::linear(y), lines)
}

/// Two charts of the same height, one below the other.
fn pair(upper: LineChart, lower: LineChart) -> Drawing {
    const HEIGHT: u32 = 380;
    Drawing::Charts(vec![(upper, HEIGHT), (lower, HEIGHT)])
}

/// A line for each model through a pair of figures of all instants.
fn lines(
    models: &[ModelMotion; 2],
    point: impl Fn(&ModelMotion, &Instant) -> [f64; 2],
) -> Vec<Line> {
    let models = models
        .iter()
        .zip(STROKES)
        .zip(STYLES.map(|style| style.colour));
    let line = |((model, stroke), colour): ((&ModelMotion, _), _)| {
        let points = model.points(|now| point(model, now));
        Line::new(model.name, points, colour, stroke)
    };
    models.map(line).collect()
}

impl ModelMotion {
    /// Pairs of figures of all instants.
    fn points(&self, pair: impl Fn(&Instant) -> [f64; 2]) -> Vec<[f64; 2]> {
        self.history.instants.iter().map(pair).collect()
    }

    /// Time, displacement along the plate and velocity of a probe, at the instants and between them.
    fn course(&self, probe: &Probe) -> Vec<[f64; 3]> {
        let instants = self.history.instants.iter().map(|now| {
            let [displacement, velocity] =
                [&now.displacement, &now.velocity].map(|field| self.at(field, probe)[0]);
            [now.time, displacement, velocity]
        });
        with_cubics(&instants.collect::<Vec<_>>())
    }

    fn at(&self, values: &[f64], probe: &Probe) -> [f64; 2] {
        self.mesh.displacement_at(values, probe.at)
    }
}

/// Displacement of the probes, phase of the first, energies, force of the grip, and the plates at the end.
pub fn figures(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    corrected: &CorrectedInstants,
    shown: &[PlateMotion],
) -> Vec<Figure> {
    let [springs, elements] = models;
    // The instants of all plates.
    let count = shown.iter().map(|own| own.motion.len()).min().unwrap_or(0);
    let instants = &springs.history.times()[..count];
    let plates = displaced(shown, count.saturating_sub(1));
    let until = brief(instants.last().copied().unwrap_or_default());
    let plates = FieldFigure::new(format!("Plates at t = {until} s"), ALONG, plates);
    let mut figures = vec![
        Figure::new(
            "motion_probes.png",
            "Displacement of the probes along the plate.",
            probes(plate, models, corrected),
        ),
        Figure::new(
            "motion_energy.png",
            "Energies over time: springs above, finite elements below.",
            pair(energy(springs), energy(elements)),
        ),
        Figure::new(
            "motion_plates.png",
            "The plates at the last instant of all models, with their displacement along the plate.",
            plates,
        ),
    ];
    figures.extend(stress_figures(plate, instants, shown));
    if plate.release != Some(0.0) {
        let mut over_time = force(models, "time [s]", |_, now| now.time);
        let corrected = corrected.right_force.iter().zip(&springs.history.instants);
        let points = corrected.map(|(force, now)| [now.time, force[0]]);
        let corrected = Line::new(CORRECTED.name, points, CORRECTED.colour, Stroke::Points);
        over_time
            .lines
            .extend((!corrected.points.is_empty()).then_some(corrected));
        let over_place = force(models, "displacement of the right side [mm]", right_side);
        figures.push(Figure::new(
            "motion_force.png",
            "Force of the right grip along the plate over its displacement and over time.",
            pair(over_time, over_place),
        ));
    }
    figures.extend(plate.probes.first().map(|probe| {
        let caption = "Velocity over displacement of the first probe along the plate, springs above, finite elements below; \
                       later parts of the motion are darker.";
        let charts = pair(phase(springs, probe), phase(elements, probe));
        Figure::new("motion_phase.png", caption, charts)
    }));
    figures
}

/// Stresses and strains at the instants that the study chooses, else at the last one.
fn stress_figures(plate: &MovingPlate, times: &[f64], shown: &[PlateMotion]) -> Vec<Figure> {
    let at_instant = |instant: usize| {
        let deformed = shown.iter().filter_map(|plate| {
            let [displacement, _] = *plate.motion.get(instant)?;
            Some(Deformed {
                viscous: &plate.viscous[instant].at_nodes,
                ..Deformed::elastic(plate.name, plate.mesh, vec![displacement])
            })
        });
        let deformed: Vec<_> = deformed.collect();
        let at = format!("t = {} s", brief(times[instant]));
        let file = |field: &str| format!("motion_{field}_{:05}.png", instant + 1);
        let fields = &plate.pictures.fields;
        sheet_figures(fields, &*plate.problem.law, &deformed, &at, &file)
    };
    let instants = plate.pictures.shown.instants(times);
    instants.into_iter().flat_map(at_instant).collect()
}

/// A time without trailing zeros.
fn brief(time: f64) -> String {
    let text = number(time);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// Velocity over displacement of a probe, part of the motion after part.
fn phase(model: &ModelMotion, probe: &Probe) -> LineChart {
    const SHADES: [[u8; 3]; 4] = [[253, 174, 107], [230, 109, 59], [166, 54, 3], [60, 20, 0]];
    let points = model.course(probe);
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
    let title = format!("Phase of the probe {}, {}", probe.name, model.name);
    chart(
        &title,
        "displacement [mm]",
        "velocity [mm/s]",
        lines.collect(),
    )
}

fn probes(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    corrected: &CorrectedInstants,
) -> LineChart {
    let mut lines = Vec::new();
    let [springs, _] = models;
    let times = springs.history.times();
    for (probe, colour) in plate.probes.iter().zip(PALETTE.into_iter().cycle()) {
        let fields = times.iter().zip(&corrected.displacement);
        let points = fields.map(|(time, field)| [*time, springs.at(field, probe)[0]]);
        let label = format!("{}, corrected", probe.name);
        let between = Line::new(label, points, colour, Stroke::Points);
        lines.extend((!between.points.is_empty()).then_some(between));
        lines.extend(models.iter().zip(STROKES).map(|(model, stroke)| {
            let points = model
                .course(probe)
                .into_iter()
                .map(|[time, x, _]| [time, x]);
            let label = format!("{}, {}", probe.name, model.name);
            Line::new(label, points, colour, stroke)
        }));
    }
    let along = "displacement along the plate [mm]";
    chart("Displacement of the probes", "time [s]", along, lines)
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
    let title = format!("Energies of the {}", model.name);
    chart(&title, "time [s]", "energy [mJ]", lines.collect())
}

/// The displacement of the middle of the right side along the plate in mm.
pub fn right_side(model: &ModelMotion, now: &Instant) -> f64 {
    let [length, width] = model.mesh.grid().size;
    let middle = [length, 0.5 * width];
    model.mesh.displacement_at(&now.displacement, middle)[0]
}

fn force(models: &[ModelMotion; 2], axis: &str, x: fn(&ModelMotion, &Instant) -> f64) -> LineChart {
    let lines = lines(models, |model, now| {
        [x(model, now), now.support_forces[1][0]]
    });
    chart("Force of the right grip", axis, "force [N]", lines)
}

/// What the pictures of the plates show.
const ALONG: &str = "displacement along the plate [mm]";

/// The plates at an instant, with their displacement along x.
fn displaced(plates: &[PlateMotion], instant: usize) -> Vec<Panel> {
    let panel = |plate: &PlateMotion| {
        let [displacement, _] = *plate.motion.get(instant)?;
        let along = |node: usize| displacement[2 * node];
        Some(Panel::at_nodes(
            plate.name,
            plate.mesh,
            displacement,
            &along,
        ))
    };
    plates.iter().filter_map(panel).collect()
}

/// The plates in motion: a picture that plays in every browser.
pub fn animation(times: &[f64], plates: &[PlateMotion]) -> Animation {
    const FRAMES: usize = 60;
    const MILLISECONDS: u16 = 80;
    let every = times.len().div_ceil(FRAMES).max(1);
    let count = plates.iter().map(|plate| plate.motion.len()).min();
    let instants = (0..count.unwrap_or(0)).step_by(every);
    let frame = |instant: usize| Frame {
        time: times[instant],
        panels: displaced(plates, instant),
    };
    Animation {
        title: "Plates in motion".into(),
        quantity: ALONG.into(),
        frames: instants.map(frame).collect(),
        milliseconds: MILLISECONDS,
    }
}

/// The fields of each model and of the corrected motion; those on the lattice hold the difference to the `expected`
/// displacements.
pub fn grids(
    plate: &MovingPlate,
    times: &[f64],
    plates: &[PlateMotion],
    expected: &[Vec<f64>],
) -> Vec<GridSeries> {
    let series = |own: &PlateMotion| {
        let grid = |(instant, [displacement, velocity]): (usize, &[&[f64]; 2])| {
            let velocity = Array::vectors("velocity_mm_per_s", velocity.iter().copied());
            let expected = expected.get(instant).filter(|_| !own.is_reference);
            let difference =
                expected.map(|expected| Array::to_finite_elements(displacement, expected));
            let sheet = Sheet {
                law: &*plate.problem.law,
                thickness: plate.problem.thickness,
                past: &[],
                viscous: Some(&own.viscous[instant]),
            };
            let grid = Grid::sheet(sheet, own.mesh, displacement);
            (times[instant], grid.with([velocity]).with(difference))
        };
        GridSeries::instants(own.file, own.motion.iter().enumerate().map(grid))
    };
    plates.iter().map(series).collect()
}

/// Probes, energies and the grip's force over time, one table for each model.
pub fn tables(
    plate: &MovingPlate,
    models: &[ModelMotion; 2],
    corrected: &CorrectedInstants,
) -> Vec<(String, Content)> {
    let [springs, _] = models;
    let times = springs.history.times();
    let of_model = |model: &ModelMotion| {
        let instants = &model.history.instants;
        type Column = fn(&Instant) -> f64;
        let columns: [(_, _, Column); 6] = [
            ("kinetic energy", "mJ", |now| now.energy.kinetic),
            ("stored energy", "mJ", |now| now.energy.stored),
            ("viscous work", "mJ", |now| now.energy.viscous_work),
            ("external work", "mJ", |now| now.energy.external_work),
            ("grip force x", "N", |now| now.support_forces[1][0]),
            ("grip force y", "N", |now| now.support_forces[1][1]),
        ];
        let columns = columns.into_iter().map(|(name, unit, value)| {
            Series::new(name, unit, instants.iter().map(value).collect())
        });
        let fields = instants
            .iter()
            .map(|now| [&now.displacement, &now.velocity]);
        let columns = columns.chain(of_probes(plate, model, fields)).collect();
        table(model.file, &model.history.times(), columns)
    };
    let mut all: Vec<_> = models.iter().map(of_model).collect();
    if !corrected.displacement.is_empty() {
        let fields = corrected.displacement.iter().zip(&corrected.velocity);
        let forces = [("grip force x", 0), ("grip force y", 1)].map(|(name, axis)| {
            let values = corrected.right_force.iter().map(|force| force[axis]);
            Series::new(name, "N", values.collect())
        });
        let probes = of_probes(plate, springs, fields.map(|(u, v)| [u, v]));
        let columns = forces.into_iter().chain(probes).collect();
        let times = &times[..corrected.displacement.len()];
        all.push(table("corrected", times, columns));
    }
    all
}

fn table(model: &str, times: &[f64], columns: Vec<Series>) -> (String, Content) {
    let text = csv(times, &columns);
    (format!("motion_{model}.csv"), Content::Text(text))
}

/// Displacements and velocities of the probes, from those of all nodes at every instant.
fn of_probes<'a>(
    plate: &MovingPlate,
    model: &ModelMotion,
    fields: impl Iterator<Item = [&'a Vec<f64>; 2]> + Clone,
) -> Vec<Series> {
    let mut columns = Vec::new();
    for probe in &plate.probes {
        for (axis, direction) in ["x", "y"].into_iter().enumerate() {
            for (which, what, unit) in [(0, "displacement", "mm"), (1, "velocity", "mm/s")] {
                let values = fields
                    .clone()
                    .map(|pair| model.at(pair[which], probe)[axis]);
                let head = format!("{} {what} {direction}", probe.name);
                columns.push(Series::new(&head, unit, values.collect()));
            }
        }
    }
    columns
}
