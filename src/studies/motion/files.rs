//! Pictures, VTK files and tables of a motion.

use super::Moved;
use super::corrected::Corrected;
use super::read::{MovingPlate, Probe};
use crate::dynamics::{EnergyBalance, Instant};
use crate::mesh::Mesh;
use crate::output::picture::lines::{Axis, Line, LineChart, Stroke};
use crate::output::picture::{PALETTE, Scale};
use crate::output::series::{self, Series};
use crate::output::{self, vtk};
use crate::results::Figure;

/// How a model's lines are drawn.
const STROKES: [Stroke; 2] = [Stroke::Dashed, Stroke::Solid];

fn line(label: String, points: Vec<[f64; 2]>, colour: usize, stroke: Stroke) -> Line {
    Line {
        label,
        points,
        colour: PALETTE[colour % PALETTE.len()],
        stroke,
    }
}

fn chart(title: &str, x: &str, y: &str, lines: Vec<Line>) -> LineChart {
    LineChart {
        title: title.to_owned(),
        x: Axis::linear(x),
        y: Axis::linear(y),
        lines,
        band: None,
    }
}

impl Moved {
    /// Pairs of figures of all instants.
    fn points(&self, pair: impl Fn(&Instant) -> [f64; 2]) -> Vec<[f64; 2]> {
        self.history.instants.iter().map(pair).collect()
    }

    fn at(&self, values: &[f64], probe: &Probe) -> [f64; 2] {
        self.mesh.displacement_at(values, probe.at)
    }
}

/// Displacement of the probes, phase of the first, energies, force of the grip, and the plates at the end.
pub fn figures(plate: &MovingPlate, models: &[Moved; 2], corrected: &Corrected) -> Vec<Figure> {
    let mut figures = vec![
        Figure::new(
            "motion_probes.png",
            "Displacement of the probes along the plate.",
            probes(plate, models, corrected).png(),
        ),
        Figure::new(
            "motion_energy.png",
            "Where the energy is: springs above, finite elements below.",
            output::picture::lines::stacked(&[
                (energy(&models[0]), 380),
                (energy(&models[1]), 380),
            ]),
        ),
        Figure::new(
            "motion_plates.png",
            "The plates at the last instant, with the size of their velocity.",
            plates(models, corrected),
        ),
    ];
    if plate.release != Some(0.0) {
        figures.push(Figure::new(
            "motion_force.png",
            "Force of the right grip along the plate over its displacement and over time.",
            output::picture::lines::stacked(&[
                (force(models, "time [s]", |_, now| now.time), 380),
                (
                    force(models, "displacement of the right side [mm]", right_side),
                    380,
                ),
            ]),
        ));
    }
    if let Some(probe) = plate.probes.first() {
        let phase = models
            .iter()
            .zip(STROKES)
            .zip(0..)
            .map(|((model, stroke), colour)| {
                let points = model.points(|now| {
                    [
                        model.at(&now.displacement, probe)[0],
                        model.at(&now.velocity, probe)[0],
                    ]
                });
                line(model.name.to_owned(), points, colour, stroke)
            });
        let title = format!("Phase of the probe `{}`", probe.name);
        let chart = chart(
            &title,
            "displacement [mm]",
            "velocity [mm/s]",
            phase.collect(),
        );
        let caption = "Velocity over displacement of the first probe along the plate.";
        figures.push(Figure::new("motion_phase.png", caption, chart.png()));
    }
    figures
}

fn probes(plate: &MovingPlate, models: &[Moved; 2], corrected: &Corrected) -> LineChart {
    let mut lines = Vec::new();
    let [springs, _] = models;
    for (colour, probe) in plate.probes.iter().enumerate() {
        let times = springs.history.times();
        let fields = corrected.displacement.iter();
        let points = times
            .iter()
            .zip(fields)
            .map(|(time, field)| [*time, springs.at(field, probe)[0]]);
        let points: Vec<_> = points.collect();
        if !points.is_empty() {
            let label = format!("{}, corrected", probe.name);
            lines.push(line(label, points, colour, Stroke::Marked));
        }
        for (model, stroke) in models.iter().zip(STROKES) {
            let points = model.points(|now| [now.time, model.at(&now.displacement, probe)[0]]);
            lines.push(line(
                format!("{}, {}", probe.name, model.name),
                points,
                colour,
                stroke,
            ));
        }
    }
    chart(
        "Displacement of the probes",
        "time [s]",
        "displacement along the plate [mm]",
        lines,
    )
}

fn energy(model: &Moved) -> LineChart {
    let names = [
        "kinetic",
        "stored",
        "dissipated",
        "work of grips and loads",
        "balance",
    ];
    let parts = |energy: &EnergyBalance| {
        let EnergyBalance {
            kinetic,
            stored,
            dissipated,
            external_work,
        } = *energy;
        [kinetic, stored, dissipated, external_work, energy.total()]
    };
    let lines = names.iter().enumerate().map(|(part, name)| {
        let points = model.points(|now| [now.time, parts(&now.energy)[part]]);
        line((*name).to_owned(), points, part, Stroke::Solid)
    });
    let title = format!("Energies of the {}", model.name);
    chart(&title, "time [s]", "energy [mJ]", lines.collect())
}

fn right_side(model: &Moved, now: &Instant) -> f64 {
    let [length, width] = model.mesh.grid().size;
    model
        .mesh
        .displacement_at(&now.displacement, [length, 0.5 * width])[0]
}

fn force(models: &[Moved; 2], axis: &str, x: fn(&Moved, &Instant) -> f64) -> LineChart {
    let lines = models
        .iter()
        .zip(STROKES)
        .zip(0..)
        .map(|((model, stroke), colour)| {
            let points = model.points(|now| [x(model, now), now.support_forces[1][0]]);
            line(model.name.to_owned(), points, colour, stroke)
        });
    chart(
        "Force of the right grip",
        axis,
        "force [N]",
        lines.collect(),
    )
}

/// A plate whose motion is shown.
struct Shown<'a> {
    name: &'static str,
    file: &'static str,
    mesh: &'a Mesh,
    /// Displacement and velocity at the first instants.
    motion: Vec<[&'a [f64]; 2]>,
}

/// All plates; the corrected one between the models, where there is one.
fn shown<'a>(models: &'a [Moved; 2], corrected: &'a Corrected) -> Vec<Shown<'a>> {
    let model = |model: &'a Moved| {
        let instants = model.history.instants.iter();
        Shown {
            name: model.name,
            file: model.file,
            mesh: &model.mesh,
            motion: instants
                .map(|now| [&now.displacement[..], &now.velocity])
                .collect(),
        }
    };
    let [springs, elements] = models;
    let fields = corrected.displacement.iter().zip(&corrected.velocity);
    let between = Shown {
        name: "corrected",
        file: "corrected",
        mesh: &springs.mesh,
        motion: fields.map(|(u, v)| [&u[..], &v[..]]).collect(),
    };
    let mut all = vec![model(springs), between, model(elements)];
    all.retain(|plate| !plate.motion.is_empty());
    all
}

/// The plates at an instant, with the size of their velocity.
fn speeds<'a>(plates: &[Shown<'a>], instant: usize) -> Vec<output::Field<'a>> {
    let field = |plate: &Shown<'a>| {
        let [displacement, velocity] = *plate.motion.get(instant)?;
        let speeds = velocity.chunks_exact(2).map(|v| v[0].hypot(v[1]));
        Some((plate.name, plate.mesh, displacement, speeds.collect()))
    };
    plates.iter().filter_map(field).collect()
}

/// The plates in motion: a picture that plays in every browser.
pub fn animation(models: &[Moved; 2], corrected: &Corrected) -> (String, Vec<u8>) {
    const FRAMES: usize = 60;
    const MILLISECONDS: u16 = 80;
    let times = models[0].history.times();
    let every = times.len().div_ceil(FRAMES).max(1);
    let plates = shown(models, corrected);
    let count = plates.iter().map(|plate| plate.motion.len()).min();
    let frames: Vec<_> = (0..count.unwrap_or(0))
        .step_by(every)
        .map(|instant| (times[instant], speeds(&plates, instant)))
        .collect();
    let png = output::field_animation("Plates in motion", "speed [mm/s]", &frames, MILLISECONDS);
    ("motion.png".into(), png)
}

fn plates(models: &[Moved; 2], corrected: &Corrected) -> Vec<u8> {
    let last = models[0].history.instants.len() - 1;
    output::field_figure(
        "Plates at the last instant",
        "speed [mm/s]",
        Scale::Linear,
        &speeds(&shown(models, corrected), last),
    )
}

/// A series of VTK files for each model and the corrected motion; those on the lattice hold the difference to the
/// `expected` displacements.
pub fn vtk_files(
    plate: &MovingPlate,
    models: &[Moved; 2],
    corrected: &Corrected,
    expected: &[Vec<f64>],
) -> Vec<(String, Vec<u8>)> {
    let [springs, elements] = models;
    let sheet = vtk::Sheet {
        law: &*plate.problem.law,
        thickness: plate.problem.thickness,
    };
    let times = springs.history.times();
    let plates = shown(models, corrected);
    let series = plates.iter().flat_map(|plate| {
        let (sheet, times) = (&sheet, &times);
        let file = move |instant: usize| {
            let reference = (plate.file != elements.file).then(|| &expected[instant][..]);
            let title = format!("{} at {} s", plate.name, times[instant]);
            vtk::moving_file(&title, sheet, plate.mesh, plate.motion[instant], reference)
        };
        series::vtk_files(plate.file, &times[..plate.motion.len()], file)
    });
    series.collect()
}

/// Probes, energies and the grip's force over time, one table for each model.
pub fn tables(
    plate: &MovingPlate,
    models: &[Moved; 2],
    corrected: &Corrected,
) -> Vec<(String, Vec<u8>)> {
    let table = |model: &Moved| {
        let column = |name: &str, unit: &str, value: &dyn Fn(&Instant) -> f64| {
            let values = model.history.instants.iter().map(value);
            Series::new(name, unit, values.collect())
        };
        let mut columns = vec![
            column("kinetic energy", "mJ", &|now| now.energy.kinetic),
            column("stored energy", "mJ", &|now| now.energy.stored),
            column("dissipated energy", "mJ", &|now| now.energy.dissipated),
            column("external work", "mJ", &|now| now.energy.external_work),
            column("grip force x", "N", &|now| now.support_forces[1][0]),
            column("grip force y", "N", &|now| now.support_forces[1][1]),
        ];
        for probe in &plate.probes {
            for (axis, direction) in ["x", "y"].into_iter().enumerate() {
                let place = |now: &Instant| model.at(&now.displacement, probe)[axis];
                let speed = |now: &Instant| model.at(&now.velocity, probe)[axis];
                let head = |what: &str| format!("{} {what} {direction}", probe.name);
                columns.push(column(&head("displacement"), "mm", &place));
                columns.push(column(&head("velocity"), "mm/s", &speed));
            }
        }
        let text = series::csv(&model.history.times(), &columns);
        (format!("motion_{}.csv", model.file), text.into_bytes())
    };
    let own =
        (!corrected.displacement.is_empty()).then(|| corrected_table(plate, models, corrected));
    models.iter().map(table).chain(own).collect()
}

/// The probes of the corrected motion over time.
fn corrected_table(
    plate: &MovingPlate,
    [springs, _]: &[Moved; 2],
    corrected: &Corrected,
) -> (String, Vec<u8>) {
    let mut columns = Vec::new();
    for probe in &plate.probes {
        for (axis, direction) in ["x", "y"].into_iter().enumerate() {
            for (what, unit, fields) in [
                ("displacement", "mm", &corrected.displacement),
                ("velocity", "mm/s", &corrected.velocity),
            ] {
                let values = fields.iter().map(|field| springs.at(field, probe)[axis]);
                let head = format!("{} {what} {direction}", probe.name);
                columns.push(Series::new(&head, unit, values.collect()));
            }
        }
    }
    let times = &springs.history.times()[..corrected.displacement.len()];
    (
        "motion_corrected.csv".into(),
        series::csv(times, &columns).into_bytes(),
    )
}
