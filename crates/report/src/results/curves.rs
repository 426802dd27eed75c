//! The curves of material cards as charts.

use super::{Axis, Line, LineChart, PALETTE, Scale, Stroke};
use crate::material::Card;
use crate::material::curve::{Mode, simple_shear};
use crate::material::stability::{SEARCHED, stable_range};

const PUBLISHED: [u8; 3] = PALETTE[1];
const INK: [u8; 3] = [30, 30, 30];

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
        lines.push(Line::new("unstable (Drucker)", [], INK, Stroke::Dashed));
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
