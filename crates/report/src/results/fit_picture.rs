//! Pictures of fits: measured and fitted stresses with the residuals below, over the stretch, over time, or row by row.

use std::path::Path;

use super::chart::stress_chart;
use super::fit::{notes, title_case};
use super::{Axis, Drawing, Line, LineChart, PALETTE, Scale, Stroke};
use crate::calibration::{Fit, Test, TestData, Times};
use crate::material::curve::Mode;
use crate::statistics::{extremes, farthest};

const INK: [u8; 3] = [60, 60, 60];
/// The colour of the part of a record that is not fitted.
const LEFT_OUT: [u8; 3] = [190, 190, 190];
/// Most markers: more are not distinguishable.
const MOST_MARKERS: usize = 1000;
/// Times that span more than this factor are drawn on a logarithmic scale.
const WIDE: f64 = 300.0;

/// Time since the first row in s, stretch, measured and fitted stress in MPa.
type Row = [f64; 4];
const TIME: usize = 0;
const STRETCH: usize = 1;
const MEASURED: usize = 2;
const FITTED: usize = 3;

/// The observations of one file along one axis, in the order of the file.
struct Course<'a> {
    data: &'a TestData,
    axis: usize,
    label: String,
    colour: [u8; 3],
    rows: Vec<Row>,
}

impl<'a> Course<'a> {
    fn all(tests: &'a [(TestData, &'a [f64], String)]) -> Vec<Self> {
        let mut courses: Vec<Self> = Vec::new();
        for (data, predicted, name) in tests {
            for axis in [0, 1] {
                let rows = rows(data, predicted, axis);
                if rows.is_empty() {
                    continue;
                }
                let direction = if axis == 1 { ", direction 2" } else { "" };
                let mut label = format!("{name}{direction}");
                if courses.iter().any(|other| other.label == label) {
                    let stem = Path::new(&data.name).file_stem();
                    label = stem.map_or(label, |stem| format!("{}{direction}", stem.display()));
                }
                courses.push(Self {
                    data,
                    axis,
                    label,
                    colour: PALETTE[courses.len() % PALETTE.len()],
                    rows,
                });
            }
        }
        courses
    }

    fn points(&self, x: usize, y: impl Fn(&Row) -> f64) -> Vec<[f64; 2]> {
        self.rows.iter().map(|row| [row[x], y(row)]).collect()
    }

    fn markers(&self, label: &str, points: Vec<[f64; 2]>) -> Line {
        Line::new(label, points, self.colour, Stroke::Points)
    }

    /// Darker than the markers that it lies on.
    fn dark(&self) -> [u8; 3] {
        self.colour.map(|part| part / 2)
    }

    /// Measured stresses as markers.
    fn measured(&self, x: usize, scale: Scale) -> Line {
        let measured = spread(self.points(x, |row| row[MEASURED]), scale);
        self.markers(&self.label, measured)
    }

    /// The fitted stresses as a curve; of a law with softening over the stretch also between the rows.
    fn fitted(&self, fit: &Fit, x: usize, scale: Scale) -> Line {
        /// From one row to the next.
        const STEPS: u32 = 8;
        let points = match &fit.softened {
            Some(softened) if x == STRETCH => {
                let path = softened.path(self.data, &*fit.fitted, self.axis, STEPS);
                path.into_iter().map(|[x, y]| [1.0 + x, y]).collect()
            }
            _ => self.points(x, |row| row[FITTED]),
        };
        Line::new("", shown(points, scale), self.dark(), Stroke::Solid)
    }

    fn residuals(&self, x: usize, scale: Scale) -> Line {
        let residuals = self.points(x, |row| row[MEASURED] - row[FITTED]);
        self.markers("", spread(residuals, scale))
    }

    /// The stretches within which the fitted law is stable in this test.
    fn stable(&self, fit: &Fit) -> [f64; 2] {
        let mode = match self.data.test {
            Test::Uniaxial => Mode::Uniaxial,
            Test::Planar => Mode::Planar,
            Test::Equibiaxial => Mode::Equibiaxial,
            Test::Biaxial | Test::SimpleShear => return [0.0, f64::INFINITY],
        };
        let range = fit.quality.stable.iter().find(|range| range.mode == mode);
        range.map_or([0.0, f64::INFINITY], |range| range.stretches)
    }

    /// Whether the stretch comes back by a fifth of its range.
    fn turns_back(&self) -> bool {
        let [low, high] = extremes(self.rows.iter().map(|row| row[STRETCH]));
        let far = |row: &Row| (row[STRETCH] - self.rows[0][STRETCH]).abs();
        let furthest = self.rows.iter().map(far).fold(0.0, f64::max);
        furthest - self.rows.last().map_or(0.0, far) > 0.2 * (high - low)
    }
}

fn rows(data: &TestData, predicted: &[f64], axis: usize) -> Vec<Row> {
    let time = |row: usize| match &data.times {
        Times::Known(times) => times[row] - times[0],
        _ => f64::NAN,
    };
    let rows = data.observations.iter().zip(predicted).enumerate();
    let rows = rows.filter(|(_, (one, _))| one.axis == axis);
    rows.map(|(row, (one, fitted))| {
        let stretch = 1.0 + data.drawn_strain(one);
        [time(row), stretch, one.stress, *fitted]
    })
    .collect()
}

/// The points that a scale can show.
fn shown(mut points: Vec<[f64; 2]>, scale: Scale) -> Vec<[f64; 2]> {
    points.retain(|point| scale != Scale::Logarithmic || point[0] > 0.0);
    points
}

/// A limited number of points, on a logarithmic scale evenly distributed along it.
fn spread(points: Vec<[f64; 2]>, scale: Scale) -> Vec<[f64; 2]> {
    let points = shown(points, scale);
    if points.len() <= MOST_MARKERS || scale != Scale::Logarithmic {
        let stride = points.len().div_ceil(MOST_MARKERS).max(1);
        return points.into_iter().step_by(stride).collect();
    }
    let [low, high] = extremes(points.iter().map(|point| point[0].ln()));
    let width = (high - low) / MOST_MARKERS as f64;
    let mut last = f64::NEG_INFINITY;
    let mut kept = Vec::new();
    for point in points {
        if point[0].ln() - last >= width {
            last = point[0].ln();
            kept.push(point);
        }
    }
    kept
}

fn residual_chart(x: Axis, lines: Vec<Line>) -> LineChart {
    let points = lines.iter().flat_map(|line| &line.points);
    let largest = farthest(points.map(|point| point[1])).abs();
    // Below the stresses, whose axis it shares.
    stress_chart("", x, "measured − fitted", largest, lines)
}

/// Data with the fitted stresses, and the residuals below.
pub fn fit_picture(fit: &Fit, tests: &[TestData]) -> Drawing {
    let drawn = drawn(fit, tests);
    let courses = Course::all(&drawn);
    let largest = tests.iter().map(|test| test.largest_stress);
    let largest = largest.fold(0.0, f64::max);
    let stress = format!("{} stress", fit.stress_measure.title());
    let over = |title: String, x, lines| stress_chart(title, x, &stress, largest, lines);
    let softening = fit.softened.as_ref().map_or("", |_| " with softening");
    let law = title_case(fit.law.name);
    let title = format!("{law}{softening} fitted to {}", names(tests));
    let mut charts = if let Some(relaxed) = &fit.relaxed {
        let times = courses.iter().flat_map(|course| &course.rows);
        let [shortest, longest] = extremes(times.map(|row| row[TIME]).filter(|time| *time > 0.0));
        let cyclic = courses.iter().any(Course::turns_back);
        let scale = if longest / shortest > WIDE && !cyclic {
            Scale::Logarithmic
        } else {
            Scale::Linear
        };
        let time = || Axis::new("time since the first row [s]", scale);
        let terms = relaxed.material.relaxation.len();
        let title = format!("{title}, with {terms} Prony terms");
        let residuals = courses.iter().map(|course| course.residuals(TIME, scale));
        let mut charts = vec![
            (over(title, time(), lines(fit, &courses, TIME, scale)), 380),
            (residual_chart(time(), residuals.collect()), 220),
        ];
        if cyclic {
            let title = "Over the stretch".to_owned();
            let lines = lines(fit, &courses, STRETCH, Scale::Interval);
            charts.push((over(title, Axis::stretch(), lines), 320));
        }
        charts
    } else {
        let lines = if fit.softened.is_some() {
            lines(fit, &courses, STRETCH, Scale::Interval)
        } else {
            curves_with_bands(fit, &courses)
        };
        let residuals = courses.iter();
        let residuals = residuals.map(|course| course.residuals(STRETCH, Scale::Interval));
        // As long as the curve's axis, with the slack that the residuals do not have.
        let stretches = lines.iter().flat_map(|line| &line.points);
        let zero = extremes(stretches.map(|[x, _]| *x)).map(|x| [x, 0.0]);
        let residuals = [Line::new("", zero, INK, Stroke::Thin)]
            .into_iter()
            .chain(residuals);
        let axis = deformation(tests);
        vec![
            (over(title, axis.clone(), lines), 460),
            (residual_chart(axis, residuals.collect()), 250),
        ]
    };
    charts[0].0.notes = notes(fit);
    Drawing::Charts(charts)
}

/// Tests alone, as they were read, before any law is fitted to them.
pub fn tests_chart(tests: &[TestData]) -> LineChart {
    let stresses = |data: &TestData| data.observations.iter().map(|one| one.stress).collect();
    let stresses: Vec<Vec<f64>> = tests.iter().map(stresses).collect();
    let named = tests.iter().zip(&stresses);
    let named: Vec<_> = named
        .map(|(data, stress)| (data.clone(), &stress[..], data.test.name().to_owned()))
        .collect();
    let courses = Course::all(&named);
    let points = courses.iter();
    let points = points.map(|course| course.measured(STRETCH, Scale::Linear));
    let largest = tests.iter().map(|test| test.largest_stress);
    let measure = tests.first().map_or("", |test| test.stress_measure.title());
    stress_chart(
        "The tests as they were read",
        deformation(tests),
        &format!("{measure} stress"),
        largest.fold(0.0, f64::max),
        points.collect(),
    )
}

/// The tests with the fitted stresses and their names in the legend: the law alone has a curve for each protocol of a biaxial test.
fn drawn<'a>(fit: &'a Fit, tests: &[TestData]) -> Vec<(TestData, &'a [f64], String)> {
    let has_memory = fit.relaxed.is_some() || fit.softened.is_some();
    let mut drawn = Vec::new();
    for (data, predicted) in tests.iter().zip(&fit.predicted) {
        let parts = Some(data.by_protocol()).filter(|parts| parts.len() > 1 && !has_memory);
        let Some(parts) = parts else {
            drawn.push((data.clone(), &predicted[..], data.test.name().to_owned()));
            continue;
        };
        let mut rest = &predicted[..];
        for (part, number) in parts.into_iter().zip(1..) {
            let (first, others) = rest.split_at(part.observations.len().min(rest.len()));
            rest = others;
            drawn.push((part, first, format!("protocol {number}")));
        }
    }
    drawn
}

/// The axis of what the tests were deformed by.
fn deformation(tests: &[TestData]) -> Axis {
    let sheared = tests.iter().filter(|data| data.test == Test::SimpleShear);
    let label = match sheared.count() {
        0 => return Axis::stretch(),
        count if count == tests.len() => "1 + amount of shear γ [–]",
        _ => "stretch λ, or 1 + amount of shear γ [–]",
    };
    Axis::new(label, Scale::Interval)
}

/// Measured and fitted stresses of all courses, with an entry in the legend.
fn lines(fit: &Fit, courses: &[Course], x: usize, scale: Scale) -> Vec<Line> {
    let curves = courses.iter().map(|course| course.fitted(fit, x, scale));
    let points = courses.iter().map(|course| course.measured(x, scale));
    let legend = Line::new("fitted", [], curve_colour(courses), Stroke::Solid);
    curves.chain(points).chain([legend]).collect()
}

/// The colour of the curves in the legend: that of the only one, or else none of theirs.
fn curve_colour(courses: &[Course]) -> [u8; 3] {
    match courses {
        [only] => only.dark(),
        _ => INK,
    }
}

/// 95 % bands, data and the curve of the law, which is dashed where it is unstable, with their names for the legend.
fn curves_with_bands(fit: &Fit, courses: &[Course]) -> Vec<Line> {
    let (mut bands, mut points, mut curves) = (Vec::new(), Vec::new(), Vec::new());
    let mut any_unstable = false;
    for course in courses {
        let data = course.data;
        let path = data.path(course.axis, 120);
        let curve: Vec<[f64; 2]> = path
            .iter()
            .map(|one| {
                let stress = data.stress_of(&*fit.fitted, one);
                [1.0 + data.drawn_strain(one), stress]
            })
            .collect();
        let halves = fit.half_widths(data, &path);
        if halves.iter().all(|half| half.is_finite()) && !fit.parameters.is_empty() {
            let edge = |sign: f64| {
                let pairs = curve.iter().zip(&halves);
                pairs.map(move |([x, y], half)| [*x, y + sign * half])
            };
            let outline = edge(1.0).chain(edge(-1.0).rev());
            bands.push(Line::new("", outline, course.colour, Stroke::Filled));
        }
        let [low, high] = course.stable(fit);
        any_unstable |= !curve.iter().all(|[x, _]| (low..=high).contains(x));
        curves.extend(Line::within("", &curve, course.dark(), [low, high]));
        let left_out = data.left_out.iter().filter(|one| one.axis == course.axis);
        let left_out = left_out.map(|one| [1.0 + data.drawn_strain(one), one.stress]);
        let left_out = spread(left_out.collect(), Scale::Interval);
        if !left_out.is_empty() {
            let label = if points.is_empty() {
                "left out: slack, holds, other cycles"
            } else {
                ""
            };
            bands.push(Line::new(label, left_out, LEFT_OUT, Stroke::Points));
        }
        points.push(course.measured(STRETCH, Scale::Interval));
    }
    let has_bands = bands.iter().any(|line| line.stroke == Stroke::Filled);
    let legend = [
        (true, "fitted curve", Stroke::Solid),
        (any_unstable, "unstable (Drucker)", Stroke::Dashed),
        (has_bands, "95 % band of the curve", Stroke::Filled),
    ];
    let legend = legend.into_iter().filter(|(shown, ..)| *shown);
    let band = match courses {
        [only] => only.colour,
        _ => INK,
    };
    let legend = legend.map(|(_, label, stroke)| {
        let colour = if stroke == Stroke::Filled {
            band
        } else {
            curve_colour(courses)
        };
        Line::new(label, [], colour, stroke)
    });
    let drawn = [bands, curves, points].into_iter().flatten();
    drawn.chain(legend).collect()
}

fn names(tests: &[TestData]) -> String {
    match tests {
        [test] => Path::new(&test.name)
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        _ => format!("{} tests", tests.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::{FitSettings, fit};
    use crate::document::Statements;
    use crate::material::registry::Law;

    /// A record of 20 mm that hangs loose over 2 mm, where the curve's axis has stretches below 1.
    #[test]
    fn residuals_have_the_axis_of_the_curve() {
        let force = |u: f64| 0.5 * (u - 2.0).max(0.0);
        let rows = (0..100).map(|row| 0.1 * f64::from(row));
        let rows: String = rows.map(|u| format!("{u},{}\n", force(u))).collect();
        let head = "# test: uniaxial; length: 20 mm; area: 10 mm^2\nextension [mm],load [N]";
        let test = TestData::parse("a.csv", &format!("{head}\n{rows}"), &Statements::new());
        let tests = [test.unwrap()];
        let law = Law::named("neo-hooke").unwrap();
        let fit = fit(law, &tests, &FitSettings::default()).unwrap();
        let Drawing::Charts(charts) = fit_picture(&fit, &fit.fitted_tests(&tests)) else {
            panic!("a fit is drawn by charts");
        };
        let axes = charts.iter().map(|(chart, _)| {
            let points = chart.lines.iter().flat_map(|line| &line.points);
            extremes(points.map(|point| point[0]))
        });
        let axes: Vec<[f64; 2]> = axes.collect();
        assert!(axes[0] == axes[1] && axes[0][0] < 0.95, "{axes:?}");
    }
}
