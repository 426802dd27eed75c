//! Tables and pictures of the measurements within a sheet.

use super::measurements::{Extensometer, LineCut, Measurements};
use super::problem::Specimen;
use super::results::models::Models;
use crate::document::write_records;
use crate::problem::GroupState;
use crate::results::{
    Content, Deformed, Drawing, Figure, Line, LineChart, Position, SheetField, Stroke, from_rest,
    positions,
};
use crate::studies::file_stem;
use crate::studies::series::{DRAWN, ModelSeries, larger_axis};
use crate::units::Dimension;

/// The values of all fields at a point, in the order of [`SheetField::NAMES`].
type Sample = Option<[f64; SheetField::NAMES.len()]>;

/// The measurements in one state of a model.
pub(super) struct State {
    /// Which of the models it is.
    model: usize,
    step: usize,
    probes: Vec<Sample>,
    lines: Vec<Vec<Sample>>,
    /// The lengths of the extensometers at rest and now, in mm.
    pub lengths: Vec<[f64; 2]>,
    /// The force of supports and loads on the measured group in N.
    force: [f64; 2],
}

/// All measurements, with the models whose sheet they are taken from.
pub struct MeasuredFields<'a> {
    pub(super) specimen: &'a Specimen,
    models: Vec<ModelSeries<'a>>,
    states: Vec<State>,
}

impl<'a> MeasuredFields<'a> {
    /// The measurements in every state of every model.
    pub fn of(specimen: &'a Specimen, models: &'a Models) -> Self {
        let series = Vec::from(models.all_series());
        let wanted = &specimen.measurements;
        let is_empty = *wanted == Measurements::default() && specimen.measured_curve.is_none();
        let count = |model: &ModelSeries| if is_empty { 0 } else { model.states.len() };
        let of_model = |(index, model): (usize, &ModelSeries)| {
            let count = count(model);
            let positions = (count > 0).then(|| positions_in(specimen, model));
            let positions = positions.unwrap_or_default();
            let states = (0..count).map(|step| measure(specimen, model, (index, step), &positions));
            states.collect::<Vec<_>>()
        };
        let states = series.iter().enumerate().flat_map(of_model);
        Self {
            specimen,
            states: states.flatten().collect(),
            models: series,
        }
    }

    /// `probes.csv`, `lines.csv` and `extensometers.csv`, those that have rows.
    pub fn tables(&self) -> Vec<(String, Content)> {
        let fields = SheetField::NAMES.map(|(name, field)| head(name, field));
        let force = [format!("force_{}_N", ["x", "y"][self.force_axis()])];
        let point = ["x_mm", "y_mm"];
        let point_on_line = ["distance_mm", "x_mm", "y_mm"];
        let lengths = ["length_at_rest_mm", "length_mm", "extensometer_stretch"];
        let tables = [
            self.table("probe", &point, &fields, |state| self.probe_rows(state)),
            self.table("line", &point_on_line, &fields, |state| {
                self.line_rows(state)
            }),
            self.table("extensometer", &lengths, &force, |state| {
                self.extensometer_rows(state)
            }),
        ];
        tables.into_iter().flatten().collect()
    }

    /// A table with the rows of all states; `None` where there are none. Its columns are model, position on the path, name and values.
    fn table(
        &self,
        name: &str,
        coordinates: &[&str],
        values: &[String],
        rows: impl Fn(&State) -> Vec<Vec<String>>,
    ) -> Option<(String, Content)> {
        let rows: Vec<Vec<String>> = self.states.iter().flat_map(rows).collect();
        let begin = ["model", self.specimen.along.column(), name];
        let begin = begin
            .iter()
            .chain(coordinates)
            .map(|head| (*head).to_owned());
        let head: Vec<String> = begin.chain(values.iter().cloned()).collect();
        let text = (!rows.is_empty()).then(|| write_records([head].into_iter().chain(rows)))?;
        Some((format!("{name}s.csv"), Content::Text(text)))
    }

    /// A row of a table: the model, the position on the path, a name, and values.
    fn row(&self, state: &State, name: &str, values: &[f64], sample: Vec<String>) -> Vec<String> {
        let factor = self.specimen.factors[state.step].to_string();
        let begin = [self.models[state.model].kind.style().name, &factor, name].map(str::to_owned);
        let values = values.iter().map(ToString::to_string);
        begin.into_iter().chain(values).chain(sample).collect()
    }

    fn probe_rows(&self, state: &State) -> Vec<Vec<String>> {
        let probes = self.specimen.measurements.probes.iter();
        let probes = probes.zip(&state.probes);
        probes
            .map(|(probe, sample)| self.row(state, &probe.name, &probe.at, written(sample)))
            .collect()
    }

    fn line_rows(&self, state: &State) -> Vec<Vec<String>> {
        let lines = self.specimen.measurements.lines.iter().zip(&state.lines);
        let rows = lines.flat_map(|(line, samples)| {
            let points = line.points().into_iter().zip(samples);
            points.map(move |(point, sample)| {
                let coordinates = [line.distance(point), point[0], point[1]];
                self.row(state, &line.name, &coordinates, written(sample))
            })
        });
        rows.collect()
    }

    fn extensometer_rows(&self, state: &State) -> Vec<Vec<String>> {
        let all = self.specimen.measurements.extensometers.iter();
        let all = all.zip(&state.lengths);
        all.map(|(extensometer, [rest, now])| {
            let values = [*rest, *now, now / rest, self.force(state)];
            self.row(state, &extensometer.name, &values, Vec::new())
        })
        .collect()
    }

    /// The axis of the larger force on the measured group.
    pub(super) fn force_axis(&self) -> usize {
        let last = self.states.chunk_by(|a, b| a.model == b.model);
        larger_axis(last.filter_map(|of_model| Some(of_model.last()?.force)))
    }

    /// The state of the measured group.
    pub(super) fn group_state(&self, state: &State) -> &GroupState {
        &self.models[state.model].states[state.step].groups[self.specimen.group_index()]
    }

    fn force(&self, state: &State) -> f64 {
        state.force[self.force_axis()]
    }

    /// The force of the measured group over a quantity, of the models that are drawn.
    pub(super) fn lines(&self, over: impl Fn(&State) -> f64) -> Vec<Line> {
        let line = |(model, stroke): (usize, Stroke)| {
            let states = self.states.iter().filter(|state| state.model == model);
            let points = states.map(|state| [over(state), self.force(state)]);
            self.models[model]
                .kind
                .style()
                .line(from_rest(points), stroke)
        };
        let lines = self.shown().map(line);
        lines.filter(|line| line.points.len() > 1).collect()
    }

    /// Curves of the fields that are drawn: at the probes over the path, along the lines at the steps that are shown, and the force over the
    /// stretch of each extensometer.
    pub fn figures(&self, steps: &[usize]) -> Vec<Figure> {
        let specimen = self.specimen;
        let fields = specimen.pictures.fields.fields.iter();
        let columns: Vec<usize> = fields
            .filter_map(|field| {
                SheetField::NAMES
                    .iter()
                    .position(|(_, other)| other == field)
            })
            .collect();
        let named = |what: &str, caption: String, charts: Vec<LineChart>| {
            let name = format!("{}_{what}.png", specimen.name);
            Some(Figure::new(name, caption, Drawing::charts(charts, 340)?))
        };
        let along = specimen.along.name();
        let mut figures = Vec::new();
        if !specimen.measurements.probes.is_empty() {
            let probes = 0..specimen.measurements.probes.len();
            let charts = probes.flat_map(|probe| {
                columns
                    .iter()
                    .map(move |column| self.probe_chart(probe, *column))
            });
            let caption = format!("At the probes over the {along}; computed at the markers only.");
            figures.extend(named("probes", caption, charts.collect()));
        }
        for (index, line) in specimen.measurements.lines.iter().enumerate() {
            for step in steps {
                let charts = columns.iter();
                let charts = charts.map(|column| self.line_chart(index, *column, *step));
                let at = specimen.describe_step(*step);
                let caption = format!(
                    "Along the line {} at {at}, over the distance at rest.",
                    line.name
                );
                let what = format!("line_{}_{:03}", file_stem(&line.name), step + 1);
                figures.extend(named(&what, caption, charts.collect()));
            }
        }
        let extensometers = specimen.measurements.extensometers.iter().enumerate();
        let charts =
            extensometers.map(|(index, extensometer)| self.extensometer_chart(index, extensometer));
        let caption = format!(
            "Force of {} over the stretch between the ends of each extensometer; computed at the markers only.",
            specimen.group
        );
        figures.extend(named("extensometers", caption, charts.collect()));
        figures
    }

    fn probe_chart(&self, probe: usize, column: usize) -> LineChart {
        let field = SheetField::NAMES[column].1;
        let along = self.specimen.along;
        let lines = self.shown().map(|(model, stroke)| {
            let states = self.states.iter().filter(|state| state.model == model);
            let points = states.filter_map(|state| {
                let value = state.probes[probe]?[column];
                Some([along.coordinate(self.specimen.factors[state.step]), value])
            });
            self.models[model].kind.style().line(points, stroke)
        });
        let lines = lines.filter(|line| !line.points.is_empty()).collect();
        let name = &self.specimen.measurements.probes[probe].name;
        let title = format!("{}: {name}", field.title());
        LineChart::new(title, along.head(), field.quantity(), lines)
    }

    /// The models that are drawn, by their numbers, the corrected field last.
    fn shown(&self) -> impl Iterator<Item = (usize, Stroke)> {
        let shown = &self.specimen.pictures.models;
        let order = DRAWN.into_iter();
        let order = order.filter(|(kind, _)| shown.contains(kind));
        order.filter_map(|(kind, stroke)| {
            let model = self.models.iter().position(|model| model.kind == kind);
            Some((model?, stroke))
        })
    }

    fn line_chart(&self, index: usize, column: usize, step: usize) -> LineChart {
        let field = SheetField::NAMES[column].1;
        let line = &self.specimen.measurements.lines[index];
        let mut lines = Vec::new();
        for (model, _) in self.shown() {
            let mut states = self.states.iter();
            let Some(state) = states.find(|state| state.model == model && state.step == step)
            else {
                continue;
            };
            let style = self.models[model].kind.style();
            for (number, part) in parts(line, &state.lines[index], column)
                .into_iter()
                .enumerate()
            {
                let label = if number == 0 { style.name } else { "" };
                lines.push(Line::new(label, part, style.colour, Stroke::Solid));
            }
        }
        let title = format!("{} at {}", field.title(), self.specimen.describe_step(step));
        let x = format!("distance along {} at rest [mm]", line.name);
        LineChart::new(title, &*x, field.quantity(), lines)
    }

    fn extensometer_chart(&self, index: usize, extensometer: &Extensometer) -> LineChart {
        let lines = self.lines(|state| {
            let [rest, now] = state.lengths[index];
            100.0 * (now / rest - 1.0)
        });
        let title = format!(
            "Force of {} over {}",
            self.specimen.group, extensometer.name
        );
        let y = format!("force along {} [N]", ["x", "y"][self.force_axis()]);
        LineChart::new(title, "stretch of the extensometer [%]", &*y, lines)
    }
}

/// How far outside of its nearest cell a point may lie, in sizes of the cell. Probes may lie beyond the curved sides of a lattice, whose chords
/// are inside of the outline; a line ends where the sheet does.
const MARGINS: [f64; 2] = [0.1, 1e-9];

/// The positions of the probes and of the points of the lines in the mesh of a model.
fn positions_in(specimen: &Specimen, model: &ModelSeries) -> Vec<Position> {
    let wanted = &specimen.measurements;
    let probes: Vec<[f64; 2]> = wanted.probes.iter().map(|probe| probe.at).collect();
    let lines: Vec<[f64; 2]> = wanted.lines.iter().flat_map(LineCut::points).collect();
    let all = [probes, lines].into_iter().zip(MARGINS);
    all.flat_map(|(points, margin)| positions(model.mesh, &points, margin))
        .collect()
}

/// The measurements in a state of a model by its number; `None` where the model has not reached it.
fn measure(
    specimen: &Specimen,
    model: &ModelSeries,
    (index, step): (usize, usize),
    positions: &[Position],
) -> Option<State> {
    let wanted = &specimen.measurements;
    let deformed: Deformed = model.deformed(step)?;
    let mut samples = deformed.sampled(specimen.problem.laws(), positions);
    without_rounding(&mut samples);
    let mut samples = samples.into_iter();
    let u = model.states[step].displacement;
    let lengths = wanted
        .extensometers
        .iter()
        .map(|extensometer| extensometer.lengths(model.mesh, u));
    Some(State {
        model: index,
        step,
        probes: samples.by_ref().take(wanted.probes.len()).collect(),
        lines: wanted
            .lines
            .iter()
            .map(|line| samples.by_ref().take(line.count).collect())
            .collect(),
        lengths: lengths.collect(),
        force: specimen.force_on_group(step, model.mesh, u, model.states[step].groups),
    })
}

/// Sets values to zero that are rounding errors beside others of their dimension.
fn without_rounding(samples: &mut [Sample]) {
    const ROUNDING: f64 = 1e-12;
    let dimensions = SheetField::NAMES.map(|(_, field)| field.dimension());
    for dimension in [Dimension::Length, Dimension::Ratio, Dimension::Stress] {
        let is_of_it = |column: &usize| dimensions[*column] == dimension;
        let columns = (0..dimensions.len()).filter(is_of_it);
        let columns: Vec<usize> = columns.collect();
        let values = samples.iter().flatten();
        let values = values.flat_map(|sample| columns.iter().map(|column| sample[*column].abs()));
        let negligible = ROUNDING * values.fold(0.0, f64::max);
        for sample in samples.iter_mut().flatten() {
            for column in &columns {
                if sample[*column].abs() < negligible {
                    sample[*column] = 0.0;
                }
            }
        }
    }
}

/// The values along a line over the distance in mm, in parts where the line lies on the sheet.
fn parts(line: &LineCut, samples: &[Sample], column: usize) -> Vec<Vec<[f64; 2]>> {
    let points = line.points();
    let points: Vec<_> = points.iter().zip(samples).collect();
    let runs = points.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
    let runs = runs.filter(|run| run[0].1.is_some());
    let value = |(point, sample): &(&[f64; 2], &Sample)| {
        let value = sample.map_or(f64::NAN, |sample| sample[column]);
        [line.distance(**point), value]
    };
    runs.map(|run| run.iter().map(value).collect()).collect()
}

/// The head of a column, with its unit.
fn head(name: &str, field: SheetField) -> String {
    let name = name.replace('-', "_");
    match field.dimension() {
        Dimension::Length => format!("{name}_mm"),
        Dimension::Ratio => name,
        _ if field == SheetField::Energy => format!("{name}_mJ_per_mm3"),
        _ => format!("{name}_MPa"),
    }
}

/// Values as a table has them, empty where a point is not on the sheet.
fn written(sample: &Sample) -> Vec<String> {
    match sample {
        Some(values) => values.iter().map(ToString::to_string).collect(),
        None => vec![String::new(); SheetField::NAMES.len()],
    }
}
