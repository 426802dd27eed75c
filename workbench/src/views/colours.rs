//! Colours of values: dark to light, even to the eye and distinguished by most people (viridis); and the bar that shows their scale.

use eframe::egui::{
    Align2, Color32, FontId, Mesh as Triangles, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2,
};
use gelbench_base::statistics::extremes;
use gelbench_report::output::VIRIDIS;

/// The colour of a value that is no number.
const GREY: Color32 = Color32::from_rgb(128, 128, 128);

/// The colour of a value within a range.
pub fn colour(value: f64, [low, high]: [f64; 2]) -> Color32 {
    let share = (value - low) / (high - low).max(f64::MIN_POSITIVE);
    if !share.is_finite() {
        return GREY;
    }
    let last = VIRIDIS.len() - 1;
    let position = share.clamp(0.0, 1.0) * last as f64;
    let before = (position as usize).min(last - 1);
    let part = position - before as f64;
    let [r, g, b] = [0, 1, 2].map(|channel| {
        let [from, to] = [before, before + 1].map(|stop| f64::from(VIRIDIS[stop][channel]));
        (from + part * (to - from)).round() as u8
    });
    Color32::from_rgb(r, g, b)
}

/// The least and the largest of some numbers; nothing where there are none.
pub fn range(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let [low, high] = extremes(values.into_iter().filter(|value| value.is_finite()));
    (low <= high).then_some([low, high])
}

/// What a scale of colours spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The values at its ends.
    pub range: [f64; 2],
    /// Whether there are values below and above.
    pub exceeded: [bool; 2],
}

/// The span of values on 96 % of the area to which they belong, each with its share, and zero where they come near it; nothing where
/// there are none. At corners stresses have no bound, and would leave one colour for all the rest; by area it does not matter how fine
/// the mesh is there.
pub fn most_of(values: impl IntoIterator<Item = (f64, f64)>) -> Option<Span> {
    let values: Vec<(f64, f64)> = values
        .into_iter()
        .filter(|(value, area)| value.is_finite() && *area > 0.0)
        .collect();
    let all = range(values.iter().map(|(value, _)| *value))?;
    let total: f64 = values.iter().map(|(_, area)| area).sum();
    let [low, _] = around(&values, all, 0.02 * total);
    let [_, high] = around(&values, all, 0.98 * total);
    let low = if low > 0.0 && low < 0.1 * high {
        0.0
    } else {
        low
    };
    Some(Span {
        range: [low, high],
        exceeded: [all[0] < low, all[1] > high],
    })
}

/// Bounds of the value up to which an area is reached when values are taken in ascending order: as near to it as a colour needs, in the
/// time of a few sums. A frame has no time for sorting.
fn around(values: &[(f64, f64)], [mut low, mut high]: [f64; 2], mut area: f64) -> [f64; 2] {
    const BINS: usize = 256;
    for _ in 0..3 {
        let width = (high - low) / BINS as f64;
        if width <= 0.0 {
            break;
        }
        let mut bins = [0.0; BINS];
        for (value, share) in values {
            if (low..=high).contains(value) {
                bins[(((value - low) / width) as usize).min(BINS - 1)] += share;
            }
        }
        let mut bin = 0;
        while bin < BINS - 1 && bins[bin] < area {
            area -= bins[bin];
            bin += 1;
        }
        low += bin as f64 * width;
        if bin < BINS - 1 {
            high = low + width;
        }
    }
    [low, high]
}

/// The length of the arrow at an end that values exceed.
const ARROW: f32 = 8.0;

/// Draws the scale of the colours with what it shows, and an arrow at each end that values exceed.
pub fn colour_bar(ui: &Ui, name: &str, span: Span, area: Rect) {
    let bar = Rect::from_min_size(
        area.min + vec2(6.0 + ARROW, 4.0),
        vec2(area.width() - 12.0 - 2.0 * ARROW, 10.0),
    );
    let painter = ui.painter();
    painter.add(Shape::mesh(scale(bar)));
    let ends = [(bar.left(), -ARROW, 0.0), (bar.right(), ARROW, 1.0)];
    for ((end, offset, share), _) in ends.into_iter().zip(span.exceeded).filter(|(_, is)| *is) {
        let tip = pos2(end + offset, bar.center().y);
        let corners = vec![pos2(end, bar.top()), tip, pos2(end, bar.bottom())];
        let ink = colour(share, [0.0, 1.0]);
        painter.add(Shape::convex_polygon(corners, ink, Stroke::NONE));
    }
    let [low, high] = span.range;
    let number = gelbench_base::units::number;
    let [less, more] = span.exceeded;
    let words = |at: f32, anchor: Align2, text: String| {
        let ink: Color32 = ui.visuals().text_color();
        let at: Pos2 = pos2(at, bar.bottom() + 2.0);
        painter.text(at, anchor, text, FontId::proportional(12.0), ink);
    };
    words(
        bar.left(),
        Align2::LEFT_TOP,
        format!("{}{}", if less { "≤ " } else { "" }, number(low)),
    );
    words(bar.center().x, Align2::CENTER_TOP, name.to_owned());
    words(
        bar.right(),
        Align2::RIGHT_TOP,
        format!("{}{}", if more { "≥ " } else { "" }, number(high)),
    );
}

fn scale(bar: Rect) -> Triangles {
    const PARTS: u32 = 32;
    let mut surface = Triangles::default();
    for part in 0..=PARTS {
        let share = part as f32 / PARTS as f32;
        let x = bar.left() + share * bar.width();
        let ink = colour(f64::from(share), [0.0, 1.0]);
        surface.colored_vertex(pos2(x, bar.top()), ink);
        surface.colored_vertex(pos2(x, bar.bottom()), ink);
        if part > 0 {
            let first = 2 * (part - 1);
            surface.add_triangle(first, first + 1, first + 2);
            surface.add_triangle(first + 1, first + 3, first + 2);
        }
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_have_the_ends_of_the_scale_and_no_number_is_grey() {
        assert_eq!(colour(2.0, [2.0, 5.0]), Color32::from_rgb(68, 1, 84));
        assert_eq!(colour(9.0, [2.0, 5.0]), Color32::from_rgb(253, 231, 37));
        assert_eq!(colour(f64::NAN, [2.0, 5.0]), GREY);
        assert_eq!(colour(1.0, [1.0, 1.0]), colour(0.0, [0.0, 1.0]));
    }

    #[test]
    fn a_few_large_values_do_not_take_all_colours() {
        let values = (0..1000).map(|number| {
            let value = if number < 5 {
                1e6
            } else {
                f64::from(number) + 500.0
            };
            (value, 1.0)
        });
        let span = most_of(values).unwrap();
        let [low, high] = span.range;
        assert!(low > 500.0 && high < 1500.0, "{span:?}");
        assert_eq!(span.exceeded, [true, true]);
        let even = [0.01, 1.0, 2.0, 3.0].map(|value| (value, 1.0));
        let span = most_of(even).unwrap();
        assert_eq!(span.range, [0.0, 3.0]);
        assert_eq!(span.exceeded, [false, false]);
        assert_eq!(most_of([(f64::NAN, 1.0)]), None);
    }

    #[test]
    fn a_fine_mesh_in_a_corner_does_not_change_the_scale() {
        let even = (0..1000).map(|number| (f64::from(number), 1.0));
        let corner = (0..5000).map(|number| (1e4 + f64::from(number), 1e-3));
        let coarse = most_of(even.clone()).unwrap();
        let fine = most_of(even.chain(corner)).unwrap();
        assert!(
            (fine.range[1] / coarse.range[1] - 1.0).abs() < 0.01,
            "{fine:?} {coarse:?}"
        );
        assert!((coarse.range[1] - 979.0).abs() < 1e-3, "{coarse:?}");
        assert_eq!(fine.exceeded, [false, true]);
    }

    #[test]
    fn the_range_leaves_out_what_is_no_number() {
        assert_eq!(range([3.0, f64::NAN, 1.0]), Some([1.0, 3.0]));
        assert_eq!(range([f64::NAN]), None);
    }
}
