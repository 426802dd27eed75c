//! The curves of a card: the usual tests, loading and unloading, and the master curves of its relaxation.

use std::f64::consts::TAU;

use super::chart::stress_chart;
use super::{Axis, Drawing, Line, LineChart, PALETTE, Stroke, material_chart};
use crate::material::Card;
use crate::material::curve::far_end;
use crate::statistics::{extremes, farthest};

const INK: [u8; 3] = [60, 60, 60];
/// Points of a master curve.
const POINTS: usize = 241;
/// Points of a branch of a loop.
const BRANCH_POINTS: usize = 101;

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
    let times = material.relaxation.iter().map(|term| term.time);
    let covered = material.covered.times.into_iter().flatten();
    match extremes(times.chain(covered)) {
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
            "E(t) [MPa]",
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
            Axis::logarithmic("frequency [Hz]"),
            Axis::logarithmic("modulus [MPa]"),
            lines,
        )
    }
}

/// Loading and unloading of a card in uniaxial tension from a third, two thirds and all of its range; `None` where it does not
/// soften.
fn loops(card: &Card) -> Option<LineChart> {
    let softening = card.law.softening()?;
    let far = far_end(card.stretch_range) - 1.0;
    let along = |share: f64| {
        (0..BRANCH_POINTS).map(move |point| share * far * point as f64 / (BRANCH_POINTS - 1) as f64)
    };
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
    let largest = farthest(lines[0].points.iter().map(|point| point[1])).abs();
    let (title, x) = ("Uniaxial loading and unloading", Axis::stretch());
    Some(stress_chart(title, x, "nominal stress", largest, lines))
}
