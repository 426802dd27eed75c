//! Pictures of relaxation: a fit over time, and the master curves of a card.

use std::f64::consts::TAU;

use super::softening::loops;
use super::stress_unit::{Unit, readable};
use super::{Axis, Drawing, Line, LineChart, PALETTE, Scale, Stroke, material_chart};
use crate::calibration::{Fit, Relaxed, TestData, Times};
use crate::material::Card;
use crate::statistics::extremes;

const INK: [u8; 3] = [60, 60, 60];
/// Most markers: more are not distinguishable.
const MOST_MARKERS: usize = 800;
/// Times that span more than this factor are drawn on a logarithmic scale.
const WIDE: f64 = 300.0;
/// Points of a master curve.
const POINTS: usize = 241;

/// A test over time along one axis: time since its first row in s, stretch, measured and fitted stress in MPa.
struct Course {
    label: String,
    colour: [u8; 3],
    rows: Vec<[f64; 4]>,
}

impl Course {
    fn all(relaxed: &Relaxed, tests: &[TestData]) -> Vec<Self> {
        let mut courses: Vec<Self> = Vec::new();
        for (data, predicted) in tests.iter().zip(&relaxed.predicted) {
            let Times::Known(times) = &data.times else {
                continue;
            };
            for axis in [0, 1] {
                let rows = data.observations.iter().zip(times).zip(predicted);
                let rows = rows.filter(|((one, _), _)| one.axis == axis);
                let rows = rows.map(|((one, time), fitted)| {
                    [
                        time - times[0],
                        1.0 + data.drawn_strain(one),
                        one.stress,
                        *fitted,
                    ]
                });
                let rows: Vec<[f64; 4]> = rows.collect();
                if rows.is_empty() {
                    continue;
                }
                let name = std::path::Path::new(&data.name).file_stem();
                let name =
                    name.map_or_else(String::new, |name| name.to_string_lossy().into_owned());
                let direction = if axis == 1 { ", direction 2" } else { "" };
                courses.push(Self {
                    label: format!("{name}{direction}"),
                    colour: PALETTE[courses.len() % PALETTE.len()],
                    rows,
                });
            }
        }
        courses
    }

    fn points(&self, x: usize, y: &dyn Fn(&[f64; 4]) -> f64) -> Vec<[f64; 2]> {
        self.rows.iter().map(|row| [row[x], y(row)]).collect()
    }
}

/// A limited number of markers, evenly distributed along the axis.
fn markers(points: Vec<[f64; 2]>, logarithmic: bool) -> Vec<[f64; 2]> {
    let place = |point: &[f64; 2]| if logarithmic { point[0].ln() } else { point[0] };
    let [low, high] = extremes(points.iter().map(place).filter(|x| x.is_finite()));
    let width = (high - low) / MOST_MARKERS as f64;
    if points.len() <= MOST_MARKERS || width <= 0.0 {
        return points;
    }
    let mut last = f64::NEG_INFINITY;
    let mut shown = Vec::new();
    for point in points {
        if (place(&point) - last).abs() >= width {
            last = place(&point);
            shown.push(point);
        }
    }
    shown
}

/// The style of courses: their unit, and whether time is on a logarithmic scale.
struct Style {
    unit: Unit,
    logarithmic: bool,
}

/// The lines of the three charts.
#[derive(Default)]
struct Drawn {
    over_time: Vec<Line>,
    over_stretch: Vec<Line>,
    residuals: Vec<Line>,
}

impl Drawn {
    fn add(&mut self, course: &Course, style: &Style) {
        let factor = style.unit.per_mpa;
        let measured = |row: &[f64; 4]| factor * row[2];
        let fitted = |row: &[f64; 4]| factor * row[3];
        let residual = |row: &[f64; 4]| factor * (row[2] - row[3]);
        let later = |mut points: Vec<[f64; 2]>| {
            points.retain(|point| !style.logarithmic || point[0] > 0.0);
            points
        };
        let over_time = |value: &dyn Fn(&[f64; 4]) -> f64| later(course.points(0, value));
        let dark = course.colour.map(|part| part / 2);
        let points = |label: &str, points| Line::new(label, points, course.colour, Stroke::Points);
        let curve = |points| Line::new("", points, dark, Stroke::Solid);
        let shown = markers(over_time(&measured), style.logarithmic);
        self.over_time.push(points(&course.label, shown));
        self.over_time.push(curve(over_time(&fitted)));
        let shown = markers_in_order(course.points(1, &measured));
        self.over_stretch.push(points(&course.label, shown));
        self.over_stretch.push(curve(course.points(1, &fitted)));
        let shown = markers(over_time(&residual), style.logarithmic);
        self.residuals.push(points("", shown));
    }
}

/// Stress over time, and over the stretch where it turns back, with the residuals.
pub(super) fn relaxation_picture(fit: &Fit, relaxed: &Relaxed, tests: &[TestData]) -> Drawing {
    let courses = Course::all(relaxed, tests);
    let largest = tests.iter().map(|test| test.largest_stress);
    let unit = readable(largest.fold(0.0, f64::max));
    let times = courses.iter().flat_map(|course| &course.rows);
    let [shortest, longest] = extremes(times.map(|row| row[0]).filter(|time| *time > 0.0));
    let cyclic = courses.iter().any(|course| turns_back(&course.rows));
    let logarithmic = longest / shortest > WIDE && !cyclic;
    let style = Style { unit, logarithmic };
    let mut drawn = Drawn::default();
    courses.iter().for_each(|course| drawn.add(course, &style));
    drawn
        .over_time
        .push(Line::new("fitted", [], INK, Stroke::Solid));
    let time = || {
        let scale = if logarithmic {
            Scale::Logarithmic
        } else {
            Scale::Linear
        };
        Axis::new("time since the first row [s]", scale)
    };
    let measure = fit.stress_measure().title();
    let stress = || Axis::linear(&format!("{measure} stress [{}]", unit.name));
    let terms = relaxed.material.relaxation.len();
    let title = format!("{} with {terms} terms of a Prony series", fit.law.name);
    let mut charts = vec![(
        LineChart::new(title, time(), stress(), drawn.over_time),
        380,
    )];
    if cyclic {
        let stretch = Axis::stretch();
        let chart = LineChart::new("Over the stretch", stretch, stress(), drawn.over_stretch);
        charts.push((chart, 320));
    }
    let left = Axis::linear(&format!("stress [{}]", unit.name));
    let title = "Residuals: measured less fitted";
    charts.push((LineChart::new(title, time(), left, drawn.residuals), 220));
    Drawing::Charts(charts)
}

/// Every n-th point.
fn markers_in_order(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let stride = points.len().div_ceil(MOST_MARKERS).max(1);
    points.into_iter().step_by(stride).collect()
}

/// Whether the stretch comes back by a fifth of its range.
fn turns_back(rows: &[[f64; 4]]) -> bool {
    let [low, high] = extremes(rows.iter().map(|row| row[1]));
    let far = |row: &&[f64; 4]| (row[1] - rows[0][1]).abs();
    let furthest = rows.iter().map(|row| far(&row)).fold(0.0, f64::max);
    let last = rows.last().map_or(0.0, |row| far(&row));
    furthest - last > 0.2 * (high - low)
}

/// The curves of a card: the usual tests, where it softens loading and unloading, and where it relaxes, its modulus over time and over frequency.
pub fn card_curves(card: &Card) -> Drawing {
    let material = &card.viscosity;
    let loops = loops(card);
    if material.is_none() && loops.is_none() {
        return material_chart(card).into();
    }
    let mut charts = vec![(material_chart(card), 400)];
    charts.extend(loops.map(|loops| (loops, 340)));
    if material.is_none() {
        return Drawing::Charts(charts);
    }
    if !material.relaxation.is_empty() {
        charts.push((over_time(card), 280));
    }
    charts.push((over_frequency(card), 300));
    Drawing::Charts(charts)
}

/// From a tenth of the shortest time to ten times the longest one of the series and the data, in s.
fn span(card: &Card) -> [f64; 2] {
    let material = &card.viscosity;
    let own = material.relaxation.iter().map(|term| term.time);
    let covered = material.covered.times.into_iter().flatten();
    match extremes(own.chain(covered)) {
        [low, high] if low <= high => [0.1 * low, 10.0 * high],
        _ => [1e-3, 1e3],
    }
}

fn logarithmically([low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..POINTS).map(move |i| low * (high / low).powf(i as f64 / (POINTS - 1) as f64))
}

/// Young's modulus at small strain after a sudden stretch.
fn over_time(card: &Card) -> LineChart {
    let modulus = card.law.youngs_modulus();
    let points = logarithmically(span(card))
        .map(|time| [time, modulus * card.viscosity.relaxation_function(time)]);
    let lines = vec![
        Line::new("E(t)", points, PALETTE[0], Stroke::Solid),
        Line::new(
            "long-term",
            span(card).map(|time| [time, modulus]),
            INK,
            Stroke::Dashed,
        ),
    ];
    let band = card.viscosity.covered.times;
    LineChart {
        band: band.map(|times| (times, "times of the data".to_owned())),
        ..LineChart::new(
            "Modulus after a sudden small stretch",
            Axis::logarithmic("time [s]"),
            Axis::linear("E(t) [MPa]"),
            lines,
        )
    }
}

/// Storage and loss modulus at small strain.
fn over_frequency(card: &Card) -> LineChart {
    let modulus = card.law.youngs_modulus();
    let [shortest, longest] = span(card);
    let range = [1.0 / (TAU * longest), 1.0 / (TAU * shortest)];
    let curve = |part: usize| {
        let value = move |frequency: f64| {
            [
                frequency,
                card.viscosity.complex_modulus(modulus, TAU * frequency)[part],
            ]
        };
        logarithmically(range).map(value)
    };
    let lines = vec![
        Line::new("storage modulus", curve(0), PALETTE[0], Stroke::Solid),
        Line::new("loss modulus", curve(1), PALETTE[1], Stroke::Solid),
    ];
    let band = card.viscosity.covered.times;
    let band = band.map(|[low, high]| [1.0 / (TAU * high), 1.0 / (TAU * low)]);
    LineChart {
        band: band.map(|range| (range, "frequencies of the data".to_owned())),
        ..LineChart::new(
            "Storage and loss modulus",
            Axis::new("frequency [Hz]", Scale::Logarithmic),
            Axis::logarithmic("modulus [MPa]"),
            lines,
        )
    }
}
