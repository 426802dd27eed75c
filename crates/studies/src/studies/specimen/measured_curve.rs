//! A measured curve of force, drawn over those of the models.

use std::path::Path;

use super::measured_fields::{MeasuredFields, State};
use super::measurements::{MeasuredCurve, Over};
use super::problem::Specimen;
use crate::document::{
    ColumnNames, MACHINE_DISPLACEMENTS, MACHINE_FORCES, Section, Table, column_meaning,
};
use crate::error::{Error, suggestion};
use crate::results::{Figure, Line, LineChart, Stroke};
use crate::units::Dimension;

/// The quantity of a column.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Signal {
    Displacement,
    Stretch,
    Strain,
    Force,
}

const NAMES: &ColumnNames<Signal> = &[
    (Signal::Displacement, "displacement extension"),
    (Signal::Displacement, MACHINE_DISPLACEMENTS),
    (Signal::Stretch, "stretch lambda λ"),
    (Signal::Strain, "strain dehnung"),
    (Signal::Force, "force load"),
    (Signal::Force, MACHINE_FORCES),
];

const HINT: &str = "a measured curve has a column `force [N]`, and `displacement [mm]`, `stretch [-]` or `strain [%]`";

/// Reads `[measured]` of a study in a folder; `length` is that of a plate, to which stretches refer where no extensometer is named.
pub(crate) fn read_measured_curve(
    root: &Section,
    folder: &Path,
    length: Option<f64>,
) -> Option<MeasuredCurve> {
    if !root.has("measured") {
        return None;
    }
    let section = root.section("measured");
    let file = section.text("file");
    let extensometer = section.stated("extensometer", Section::text);
    section.unknown_keys();
    let table = Table::read(&folder.join(&file), HINT).and_then(|table| curve(&table));
    let (signal, points) = match table {
        Ok(curve) => curve,
        Err(Error::Input(faults)) => {
            faults.into_iter().for_each(|fault| section.add(fault));
            return None;
        }
        Err(fault) => {
            section.fault("file", &fault.to_string(), HINT);
            return None;
        }
    };
    let over = match (signal, extensometer, length) {
        (Signal::Displacement, ..) => Over::Displacement,
        (_, Some(name), _) => Over::Extensometer(name),
        (_, None, Some(length)) => Over::Length(length),
        (_, None, None) => {
            let hint = "name the [[extensometer]] that measured it with extensometer = \"…\"";
            section.fault(
                "file",
                "has stretches, and no length that they are of",
                hint,
            );
            return None;
        }
    };
    Some(MeasuredCurve { file, over, points })
}

/// The quantity over which the force is, and the points in internal units, stretches as λ − 1: a stretch nearer to 1 than to 0 at the least force is λ.
fn curve(table: &Table) -> Result<(Signal, Vec<[f64; 2]>), Error> {
    let column = |signal| column_meaning(NAMES, signal, table);
    let mut motions = [Signal::Displacement, Signal::Stretch, Signal::Strain].into_iter();
    let motion = motions.find_map(|signal| Some((signal, column(signal)?)));
    let (Some((signal, moved)), Some(force)) = (motion, column(Signal::Force)) else {
        let message = "the force, or what it is over, is missing";
        return Err(table.refuse_columns(message, HINT));
    };
    table.check_numbers([moved, force], "every row needs a number in these columns")?;
    let dimension = match signal {
        Signal::Displacement => Dimension::Length,
        _ => Dimension::Ratio,
    };
    let factors = [(moved, dimension), (force, Dimension::Force)].map(|(index, dimension)| {
        let column = &table.columns[index];
        column.factor(dimension).map_err(|fault| {
            table.refuse_columns(format!("the column `{}` {fault}", column.head()), HINT)
        })
    });
    let [scale, newtons] = factors;
    let (scale, newtons) = (scale?, newtons?);
    let rows = table.rows.iter();
    let points = rows.map(|(row, _)| [scale * row[moved], newtons * row[force]]);
    let mut points: Vec<[f64; 2]> = points.collect();
    let unloaded = points
        .iter()
        .min_by(|a, b| a[1].abs().total_cmp(&b[1].abs()));
    if signal == Signal::Stretch && unloaded.is_some_and(|[stretch, _]| *stretch > 0.5) {
        points.iter_mut().for_each(|[stretch, _]| *stretch -= 1.0);
    }
    Ok((signal, points))
}

/// Records an extensometer that the study does not have.
pub(crate) fn check_extensometer(root: &Section, specimen: &Specimen) {
    let Some(Over::Extensometer(name)) = specimen.measured_curve.as_ref().map(|curve| &curve.over)
    else {
        return;
    };
    let all = specimen.measurements.extensometers.iter();
    let known: Vec<&str> = all.map(|extensometer| &*extensometer.name).collect();
    if !known.contains(&&**name) {
        let hint = suggestion(name, &known, "the study has");
        let message = format!("the study has no extensometer `{name}`");
        root.section("measured")
            .fault("extensometer", &message, &hint);
    }
}

impl MeasuredFields<'_> {
    /// The measured curve over those of the models; `None` where the study names none.
    pub(super) fn curve(&self) -> Option<Figure> {
        let specimen = self.specimen;
        let measured = specimen.measured_curve.as_ref()?;
        let axis = self.force_axis();
        let along = ["x", "y"][axis];
        let (x, percent) = match &measured.over {
            Over::Displacement => {
                let group = &specimen.group;
                (format!("displacement of {group} along {along} [mm]"), 1.0)
            }
            Over::Extensometer(name) => (format!("stretch of {name} [%]"), 100.0),
            Over::Length(_) => ("stretch [%]".to_owned(), 100.0),
        };
        let points = measured.points.iter();
        let points = points.map(|[moved, force]| [percent * moved, *force]);
        let mut lines = vec![Line::new("measured", points, [120; 3], Stroke::Points)];
        lines.extend(self.lines(|state| percent * self.moved(state, &measured.over, axis)));
        let y = format!("force along {along} [N]");
        let title = format!("Measured and computed force of {}", specimen.group);
        let chart = LineChart::new(title, &*x, &*y, lines);
        let file = &measured.file;
        let caption = format!("The measured curve of {file} over those of the models.");
        let name = format!("{}_measured.png", specimen.name);
        Some(Figure::new(name, caption, chart))
    }

    /// The displacement or stretch of a model in a state, as on the axis of the measured curve.
    fn moved(&self, state: &State, over: &Over, axis: usize) -> f64 {
        let displacement = self.group_state(state).displacement[axis];
        match over {
            Over::Displacement => displacement,
            Over::Length(length) => displacement / length,
            Over::Extensometer(name) => {
                let mut all = self.specimen.measurements.extensometers.iter();
                let index = all.position(|extensometer| extensometer.name == *name);
                let lengths = index.and_then(|index| state.lengths.get(index));
                lengths.map_or(f64::NAN, |[rest, now]| now / rest - 1.0)
            }
        }
    }
}
