//! The curves of cards: the usual tests, loading and unloading, and the master curves of relaxation.

use std::f64::consts::TAU;

use super::chart::stress_chart;
use super::{Axis, Drawing, Line, LineChart, PALETTE, Scale, Stroke};
use crate::material::Card;
use crate::material::curve::{Mode, far_end, simple_shear};
use crate::material::stability::{SEARCHED, stable_range};
use crate::statistics::{extremes, farthest};

const INK: [u8; 3] = [60, 60, 60];
/// The colour of the published curve, and of a line in the legend that stands for several.
const PUBLISHED: [u8; 3] = PALETTE[1];
const LEGEND: [u8; 3] = [30, 30, 30];
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

/// The curves of a card in the three usual tests and in simple shear.
pub fn material_chart(card: &Card) -> LineChart {
    let [low, high] = card.stretch_range;
    let (from, to) = (low.min(1.0), high.max(1.0));
    let law = &*card.law;
    let samples = |nominal_stress: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let stretches = (0..=110).map(|i| from + (to - from) * 1.1 * f64::from(i) / 110.0);
        stretches
            .map(|stretch| [stretch, nominal_stress(stretch)])
            .collect()
    };
    let in_mode = |(name, mode): (&'static str, Mode)| {
        let stress = move |stretch: f64| mode.nominal_stress(law, stretch - 1.0);
        (name, samples(&stress), stable_range(law, mode))
    };
    let shear = samples(&|stretch| simple_shear(law, stretch - 1.0));
    let shear = ("simple shear", shear, SEARCHED);
    let curves: Vec<_> = Mode::ALL.map(in_mode).into_iter().chain([shear]).collect();
    // Equibiaxial tension is much stiffer: its curve ends where it would flatten the others.
    let uniaxial = curves[0].1.iter();
    let highest = uniaxial.fold(0.0, |most: f64, point| most.max(1.6 * point[1].abs()));
    let shown = |mut points: Vec<[f64; 2]>| {
        points.retain(|point| point[1].abs() <= highest);
        points
    };
    let mut lines = Vec::new();
    for ((name, points, stable), colour) in curves.into_iter().zip([0, 2, 3, 4]) {
        lines.extend(Line::within(name, &shown(points), PALETTE[colour], stable));
    }
    if lines.iter().any(|line| line.stroke == Stroke::Dashed) {
        lines.push(Line::new("unstable (Drucker)", [], LEGEND, Stroke::Dashed));
    }
    if card.published_nominal_stress(1.0).is_some() {
        let published = |stretch| card.published_nominal_stress(stretch).unwrap_or(f64::NAN);
        let points = shown(samples(&published));
        lines.push(Line::new(
            "published curve (uniaxial)",
            points,
            PUBLISHED,
            Stroke::Dashed,
        ));
    }
    let x = Axis::new("stretch λ, in shear 1 + γ [–]", Scale::Interval);
    LineChart {
        band: card
            .range_is_stated
            .then(|| ([low, high], "range of the card".to_owned())),
        ..LineChart::new(&card.title, x, "nominal stress [MPa]", lines)
    }
}

/// The uniaxial curves of several cards, each over its own range.
pub fn comparison_chart(cards: &[Card]) -> LineChart {
    let line = |(index, card): (usize, &Card)| {
        let [low, high] = card.stretch_range;
        let stretches = (0..=100).map(|i| low + (high - low) * f64::from(i) / 100.0);
        let stress = |stretch: f64| Mode::Uniaxial.nominal_stress(&*card.law, stretch - 1.0);
        let points = stretches.map(|stretch| [stretch, stress(stretch)]);
        // A colour that is used again is dashed.
        let stroke = if index < PALETTE.len() {
            Stroke::Solid
        } else {
            Stroke::Dashed
        };
        Line::new(&card.name, points, PALETTE[index % PALETTE.len()], stroke)
    };
    let lines = cards.iter().enumerate().map(line).collect();
    let y = "nominal stress [MPa]";
    LineChart::new("Uniaxial tension", Axis::stretch(), y, lines)
}
