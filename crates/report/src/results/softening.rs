//! Pictures of softening: a fit to loading and unloading, and the loops of a card.

use std::path::Path;

use serde_json::{Value, json};

use super::stress_unit::readable;
use super::{Axis, Line, LineChart, PALETTE, Stroke};
use super::{Drawing, Scale};
use crate::calibration::{Fit, Softened, TestData};
use crate::material::Card;
use crate::material::curve::far_end;

const INK: [u8; 3] = [60, 60, 60];
/// Most markers: more are not distinguishable.
const MOST_MARKERS: usize = 800;
/// Points of a branch of a loop.
const POINTS: usize = 101;

/// Measured and fitted stresses over the stretch in the order of the rows, and the residuals.
pub(super) fn softening_picture(fit: &Fit, softened: &Softened, tests: &[TestData]) -> Drawing {
    let (mut upper, mut lower) = (Vec::new(), Vec::new());
    for (data, predicted) in tests.iter().zip(&softened.predicted) {
        for axis in [0, 1] {
            let rows = data.observations.iter().zip(predicted);
            let rows: Vec<[f64; 3]> = rows
                .filter(|(one, _)| one.axis == axis)
                .map(|(one, own)| [1.0 + data.drawn_strain(one), one.stress, *own])
                .collect();
            if rows.is_empty() {
                continue;
            }
            let colour = PALETTE[lower.len() % PALETTE.len()];
            let name = Path::new(&data.name).file_stem().unwrap_or_default();
            let direction = if axis == 1 { ", direction 2" } else { "" };
            let label = format!("{}{direction}", name.to_string_lossy());
            let stride = rows.len().div_ceil(MOST_MARKERS).max(1);
            let shown = || rows.iter().step_by(stride);
            let measured = shown().map(|[stretch, measured, _]| [*stretch, *measured]);
            upper.push(Line::new(label, measured, colour, Stroke::Points));
            let fitted = rows.iter().map(|[stretch, _, fitted]| [*stretch, *fitted]);
            upper.push(Line::new(
                "",
                fitted,
                colour.map(|part| part / 2),
                Stroke::Solid,
            ));
            let numbered = rows.iter().enumerate().step_by(stride);
            let left = numbered.map(|(row, [_, measured, fitted])| [row as f64, measured - fitted]);
            lower.push(Line::new("", left, colour, Stroke::Points));
        }
    }
    upper.push(Line::new("fitted", [], INK, Stroke::Solid));
    let largest = tests.iter().map(|test| test.largest_stress);
    let unit = readable(largest.fold(0.0, f64::max));
    unit.scale(&mut upper);
    let stress = format!("{} stress [{}]", fit.stress_measure().title(), unit.name);
    let title = format!("{} with softening after Ogden and Roxburgh", fit.law.name);
    let chart = LineChart::new(title, Axis::stretch(), Axis::linear(&stress), upper);
    let left = lower.iter().flat_map(|line| &line.points);
    let unit = readable(left.fold(0.0, |most: f64, point| most.max(point[1].abs())));
    unit.scale(&mut lower);
    let stress = Axis::linear(&format!("stress [{}]", unit.name));
    let residuals = LineChart::new(
        "Residuals: measured less fitted",
        Axis::linear("row of the test"),
        stress,
        lower,
    );
    Drawing::Charts(vec![(chart, 460), (residuals, 250)])
}

/// The numbers of softening.
pub(super) fn softening_json(softened: &Softened) -> Value {
    json!({
        "r": softened.softening.r,
        "m_MPa": softened.softening.m,
        "beta": softened.softening.beta,
        "cycles": softened.cycles.iter().map(|cycle| json!({
            "file": cycle.test,
            "stretch": cycle.stretch,
            "measured_work_mJ_per_mm3": cycle.measured,
            "fitted_work_mJ_per_mm3": cycle.fitted,
            "closed_form_mJ_per_mm3": cycle.closed_form,
            "dissipated_by_softening_mJ_per_mm3": cycle.dissipated,
        })).collect::<Vec<_>>(),
    })
}

/// Loading and unloading of a card in uniaxial tension from a third, two thirds and all of its range; `None` where it does not
/// soften.
pub(super) fn loops(card: &Card) -> Option<LineChart> {
    let softening = card.law.softening()?;
    let far = far_end(card.stretch_range) - 1.0;
    let along =
        |share: f64| (0..POINTS).map(move |point| share * far * point as f64 / (POINTS - 1) as f64);
    let virgin = |x: f64| card.law.tension([1.0, 0.0], x);
    let mut lines: Vec<Line> = [1.0 / 3.0, 2.0 / 3.0, 1.0]
        .into_iter()
        .enumerate()
        .map(|(index, share)| {
            let most = virgin(share * far).energy;
            let back = along(share).map(|x| {
                let stress = softening.tension(virgin(x), most).nominal_stress;
                [1.0 + x, stress]
            });
            let percent = 100.0 * softening.dissipated(most) / most;
            let label = format!(
                "unloading from {:.3}: {percent:.1} % dissipated",
                1.0 + share * far
            );
            Line::new(label, back, PALETTE[index + 2], Stroke::Solid)
        })
        .collect();
    let first = along(1.0).map(|x| [1.0 + x, virgin(x).nominal_stress]);
    lines.insert(
        0,
        Line::new("first loading", first, PALETTE[0], Stroke::Solid),
    );
    let largest = lines[0].points.iter();
    let unit = readable(largest.fold(0.0, |most: f64, point| most.max(point[1].abs())));
    unit.scale(&mut lines);
    let y = Axis::linear(&format!("nominal stress [{}]", unit.name));
    let x = Axis::new("stretch λ [–]", Scale::Interval);
    Some(LineChart::new(
        "Uniaxial loading and unloading",
        x,
        y,
        lines,
    ))
}
