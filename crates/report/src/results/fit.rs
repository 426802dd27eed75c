//! The picture and the numbers of a fitted law.

use std::path::Path;

use serde_json::{Value, json};

use super::relaxation::relaxation_picture;
use super::softening::{softening_json, softening_picture};
use super::stress_unit::readable;
use super::{Axis, Drawing, Line, LineChart, PALETTE, Stroke};
use crate::calibration::{Fit, Observation, Test, TestData};
use crate::material::curve::{Mode, samples};

const INK: [u8; 3] = [60, 60, 60];
/// The colour of the part of a record that is not fitted.
const LEFT_OUT: [u8; 3] = [190, 190, 190];

/// The observations of one file along one axis.
struct Group<'a> {
    data: &'a TestData,
    axis: usize,
    label: String,
    colour: [u8; 3],
}

fn groups(tests: &[TestData]) -> Vec<Group<'_>> {
    let mut groups: Vec<Group> = Vec::new();
    for data in tests {
        for axis in [0, 1] {
            if !data.observations.iter().any(|one| one.axis == axis) {
                continue;
            }
            let direction = if axis == 1 { ", direction 2" } else { "" };
            let mut label = format!("{}{direction}", data.test.name());
            if groups.iter().any(|other| other.label == label) {
                let stem = Path::new(&data.name).file_stem();
                label = stem.map_or(label, |stem| stem.to_string_lossy().into_owned());
            }
            groups.push(Group {
                data,
                axis,
                label,
                colour: PALETTE[groups.len() % PALETTE.len()],
            });
        }
    }
    groups
}

impl Group<'_> {
    fn observations(&self) -> impl Iterator<Item = &Observation> {
        let axis = self.axis;
        self.data
            .observations
            .iter()
            .filter(move |one| one.axis == axis)
    }

    fn stretch(&self, observation: &Observation) -> f64 {
        1.0 + self.data.drawn_strain(observation)
    }

    /// The stretches within which the fitted law is stable in this test.
    fn stable(&self, fit: &Fit) -> [f64; 2] {
        let mode = match self.data.test {
            Test::Uniaxial => Mode::Uniaxial,
            Test::Planar => Mode::Planar,
            Test::Equibiaxial => Mode::Equibiaxial,
            Test::Biaxial => return [0.0, f64::INFINITY],
        };
        let found = fit.quality.stable.iter().find(|range| range.mode == mode);
        found.map_or([0.0, f64::INFINITY], |range| range.stretches)
    }
}

/// Data with the fitted curve and its 95 % band, and the residuals below.
pub fn fit_picture(fit: &Fit, tests: &[TestData]) -> Drawing {
    if let Some(relaxed) = &fit.relaxed {
        return relaxation_picture(fit, relaxed, tests);
    }
    if let Some(softened) = &fit.softened {
        return softening_picture(fit, softened, tests);
    }
    let zero = fit.quality.stretch_range.map(|stretch| [stretch, 0.0]);
    let mut drawn = Drawn {
        residuals: vec![Line::new("", zero, INK, Stroke::Solid)],
        ..Drawn::default()
    };
    groups(tests).iter().for_each(|group| drawn.add(group, fit));
    let mut lines = drawn.lines();
    let largest = tests.iter().map(|test| test.largest_stress);
    let unit = readable(largest.fold(0.0, f64::max));
    unit.scale(&mut lines);
    let stress = format!("{} stress [{}]", fit.stress_measure().title(), unit.name);
    let mut residuals = drawn.residuals;
    let left = residuals.iter().flat_map(|line| &line.points);
    let unit = readable(left.fold(0.0, |most: f64, point| most.max(point[1].abs())));
    unit.scale(&mut residuals);
    let title = format!("{} fitted to {}", fit.law.name, names(tests));
    let upper = LineChart::new(title, Axis::stretch(), Axis::linear(&stress), lines);
    let title = "Residuals: measured less fitted";
    let stress = Axis::linear(&format!("stress [{}]", unit.name));
    let lower = LineChart::new(title, Axis::stretch(), stress, residuals);
    Drawing::Charts(vec![(upper, 460), (lower, 250)])
}

/// The lines of a picture.
#[derive(Default)]
struct Drawn {
    bands: Vec<Line>,
    points: Vec<Line>,
    curves: Vec<Line>,
    residuals: Vec<Line>,
    any_unstable: bool,
}

impl Drawn {
    fn add(&mut self, group: &Group, fit: &Fit) {
        let path = group.data.path(group.axis, 120);
        let stress = |one: &Observation| group.data.stress_of(&*fit.fitted, one);
        let curve = path.iter().map(|one| [group.stretch(one), stress(one)]);
        let curve: Vec<[f64; 2]> = curve.collect();
        let halves = fit.half_widths(group.data, &path);
        let edge = |sign: f64| {
            let pairs = curve.iter().zip(&halves);
            pairs.map(move |([x, y], half)| [*x, y + sign * half])
        };
        if halves.iter().all(|half| half.is_finite()) && !fit.parameters.is_empty() {
            let outline = edge(1.0).chain(edge(-1.0).rev());
            let band = Line::new("", outline, group.colour, Stroke::Filled);
            self.bands.push(band);
        }
        let [low, high] = group.stable(fit);
        let stable = |[stretch, _]: &[f64; 2]| (low..=high).contains(stretch);
        self.any_unstable |= !curve.iter().all(stable);
        // Darker than the markers that it lies on.
        let colour = group.colour.map(|part| part / 2);
        self.curves
            .extend(Line::within("", &curve, colour, [low, high]));
        let left_out = group.data.left_out.iter();
        let left_out = left_out.filter(|one| one.axis == group.axis).copied();
        let left_out = thinned(left_out.collect());
        if !left_out.is_empty() {
            let points = left_out.iter().map(|one| [group.stretch(one), one.stress]);
            let label = if self.points.is_empty() {
                "left out: slack, holds, other cycles"
            } else {
                ""
            };
            self.bands
                .push(Line::new(label, points, LEFT_OUT, Stroke::Points));
        }
        let shown = thinned(group.observations().copied().collect());
        let measured = shown.iter().map(|one| [group.stretch(one), one.stress]);
        let measured = Line::new(&group.label, measured, group.colour, Stroke::Points);
        self.points.push(measured);
        let left = shown
            .iter()
            .map(|one| [group.stretch(one), one.stress - stress(one)]);
        self.residuals
            .push(Line::new("", left, group.colour, Stroke::Points));
    }

    /// Bands, data and curves, with their names for the legend.
    fn lines(&mut self) -> Vec<Line> {
        let legend = [
            (true, "fitted curve", Stroke::Solid),
            (self.any_unstable, "unstable (Drucker)", Stroke::Dashed),
            (
                self.bands.iter().any(|line| line.stroke == Stroke::Filled),
                "95 % band of the curve",
                Stroke::Filled,
            ),
        ];
        let legend = legend.into_iter().filter(|(shown, ..)| *shown);
        let legend = legend.map(|(_, label, stroke)| Line::new(label, [], INK, stroke));
        let drawn = [&mut self.bands, &mut self.points, &mut self.curves];
        drawn
            .into_iter()
            .flat_map(std::mem::take)
            .chain(legend)
            .collect()
    }
}

/// At most a thousand observations: more markers are not distinguishable.
fn thinned(observations: Vec<Observation>) -> Vec<Observation> {
    let stride = observations.len().div_ceil(1000).max(1);
    observations.into_iter().step_by(stride).collect()
}

fn names(tests: &[TestData]) -> String {
    match tests {
        [test] => Path::new(&test.name)
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        _ => format!("{} tests", tests.len()),
    }
}

/// All numbers of a fit. Numbers that do not exist are `null`.
pub fn fit_json(fit: &Fit, tests: &[TestData]) -> Value {
    let quality = &fit.quality;
    let parameters = fit
        .parameters
        .iter()
        .zip(quality.estimates.iter().zip(&quality.at_bound));
    let rows = quality.correlation.row_iter();
    let told = quality.has_intervals();
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "law": fit.law.name,
        "formula": fit.law.formula,
        "data": tests.iter().map(|test| json!({
            "file": test.name,
            "test": test.test.name(),
            "specimen": test.specimen,
            "stress_measure": test.stress_measure.name(),
            "points": test.observations.len(),
            "columns": test.table.columns.iter().map(|own| json!({
                "quantity": own.quantity,
                "column": own.column,
                "unit": own.unit,
                "divided_by": own.divided_by,
            })).collect::<Vec<_>>(),
            "columns_not_read": test.table.unread,
            "lines": test.table.lines,
            "remarks": test.remarks,
            "points_left_out": test.left_out.len(),
        })).collect::<Vec<_>>(),
        "weighting": fit.settings.weighting.name(),
        "residuals": fit.settings.weighting.describe(),
        "verdict": quality.verdict.map(|verdict| json!({
            "answer": verdict.answer.words(),
            "durbin_watson": verdict.durbin_watson.map(|test| test.statistic),
            "durbin_watson_probability": verdict.durbin_watson.map(|test| test.probability),
            "correlation_of_neighbours": verdict.of_neighbours,
            "pattern_probability": verdict.pattern_probability,
            "effective_points": verdict.effective_points,
            "noise_ratio": verdict.noise_ratio,
        })),
        "parameters": parameters.map(|(parameter, (estimate, at_bound))| json!({
            "key": parameter.key,
            "value": parameter.value,
            "unit": parameter.unit(),
            "standard_error": told.then_some(estimate.standard_error),
            "interval_95_percent": told.then_some(estimate.interval),
            "at_bound": at_bound,
        })).collect::<Vec<_>>(),
        "relaxation": fit.relaxed.as_ref().map(|relaxed| json!({
            "shares": relaxed.material.relaxation.iter().map(|term| term.share).collect::<Vec<_>>(),
            "times_s": relaxed.material.relaxation.iter().map(|term| term.time).collect::<Vec<_>>(),
            "terms_and_aicc": relaxed.tried,
            "resolved_times_s": relaxed.material.covered.times,
            "rates_per_s": relaxed.material.covered.rates,
        })),
        "softening": fit.softened.as_ref().map(softening_json),
        "correlation": rows.map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>(),
        "points": quality.points,
        "sum_of_squares_MPa2": quality.sum_of_squares,
        "rmse_MPa": quality.rmse,
        "nmad_percent": quality.nmad_percent,
        "r_squared": quality.r_squared,
        "aicc": quality.aicc,
        "largest_relative_error_percent": quality.largest_relative_error_percent,
        "initial_shear_modulus_MPa": fit.fitted.shear_modulus(),
        "initial_youngs_modulus_MPa": fit.fitted.youngs_modulus(),
        "stretch_range": quality.stretch_range,
        "stable": quality.stable.iter().map(|range| json!({
            "test": range.mode.name(),
            "stretches": range.stretches,
        })).collect::<Vec<_>>(),
        "curves": samples(&*fit.fitted, quality.stretch_range).iter().map(|sample| json!({
            "test": sample.name(),
            "supported_by_data": sample.mode.is_some_and(|mode| !quality.untested.contains(&mode)),
            "stretch_and_nominal_stress_MPa": sample.points,
        })).collect::<Vec<_>>(),
        "warnings": quality.warnings,
    })
}
