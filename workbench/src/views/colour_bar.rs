//! The colour bar below the sheets.

use eframe::egui::{
    Align2, Color32, FontId, Mesh as Triangles, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2,
};

use super::colours::{Span, colour};

/// The length of the arrow at an end that values exceed.
const ARROW: f32 = 8.0;

/// Draws the scale of the colours with what it shows, and an arrow at each end that values exceed.
pub fn colour_bar(ui: &Ui, name: &str, span: Span, area: Rect) {
    let bar = Rect::from_min_size(
        area.min + vec2(6.0 + ARROW, 4.0),
        vec2(area.width() - 12.0 - 2.0 * ARROW, 10.0),
    );
    let painter = ui.painter();
    painter.add(Shape::mesh(colours(bar)));
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

fn colours(bar: Rect) -> Triangles {
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
