//! Painting straight into the pixels what would be too much for a drawing: shaded triangles, many lines.

use plotters::style::RGBColor;
use resvg::tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform,
};

use crate::statistics::extremes;

/// Paints into a picture at places in points.
pub(super) struct Painter<'a> {
    pub image: &'a mut Pixmap,
    pub pixels_per_point: f32,
    /// Lines above what is shaded, where they are to stay lines; else they become pixels too.
    pub above: Option<Vec<Lines>>,
}

/// Lines that are drawn as one.
pub(super) struct Lines {
    pub lines: Vec<Vec<[f64; 2]>>,
    pub pen: Thin,
}

/// A line's colour, its width in points and how much of it covers what is below, up to 255.
#[derive(Clone, Copy)]
pub(super) struct Thin {
    pub colour: RGBColor,
    pub width: f32,
    pub cover: u8,
}

/// The shade of a triangle whose values are not numbers.
const UNKNOWN: RGBColor = RGBColor(200, 200, 200);

impl Painter<'_> {
    /// Shades a triangle by the values between those at its corners; `share` says where in the table a value's colour is.
    pub fn shade(
        &mut self,
        corners: [[f64; 2]; 3],
        values: [f64; 3],
        share: &dyn Fn(f64) -> f64,
        table: &[RGBColor],
    ) {
        let scale = f64::from(self.pixels_per_point);
        let [a, b, c] = corners.map(|corner| corner.map(|points| points * scale));
        let double = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if double == 0.0 || !double.is_finite() {
            return;
        }
        let [to_b, to_c] = [values[1] - values[0], values[2] - values[0]];
        let along_x = (to_b * (c[1] - a[1]) - to_c * (b[1] - a[1])) / double;
        let along_y = (to_c * (b[0] - a[0]) - to_b * (c[0] - a[0])) / double;
        let rows = extremes([a[1], b[1], c[1]]);
        for row in centres(rows, self.image.height()) {
            let y = row as f64 + 0.5;
            let Some(span) = span([a, b, c], y) else {
                continue;
            };
            let columns = centres(span, self.image.width());
            let first = (row * self.image.width()) as usize;
            let at = |column: u32| {
                let x = f64::from(column) + 0.5;
                share(values[0] + along_x * (x - a[0]) + along_y * (y - a[1]))
            };
            let pixels = self.image.data_mut();
            for column in columns {
                let place = 4 * (first + column as usize);
                let colour = colour(table, at(column));
                pixels[place..place + 4].copy_from_slice(&[colour.0, colour.1, colour.2, 255]);
            }
        }
    }

    /// Draws lines above what is shaded.
    pub fn lines_above<'a>(&mut self, lines: impl IntoIterator<Item = &'a [[f64; 2]]>, pen: Thin) {
        match &mut self.above {
            Some(above) => {
                let lines = lines.into_iter().map(<[_]>::to_vec).collect();
                above.push(Lines { lines, pen });
            }
            None => self.lines(lines, pen),
        }
    }

    /// Draws lines as one, so that they do not darken each other where they cross.
    pub fn lines<'a>(&mut self, lines: impl IntoIterator<Item = &'a [[f64; 2]]>, pen: Thin) {
        let mut path = PathBuilder::new();
        for line in lines {
            for (index, place) in line.iter().enumerate() {
                let [x, y] = place.map(|points| points as f32 * self.pixels_per_point);
                match index {
                    0 => path.move_to(x, y),
                    _ => path.line_to(x, y),
                }
            }
        }
        let stroke = Stroke {
            width: pen.width * self.pixels_per_point,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        let outlines = path.finish().and_then(|path| path.stroke(&stroke, 1.0));
        let Some(outlines) = outlines else {
            return;
        };
        let mut paint = Paint::default();
        let RGBColor(red, green, blue) = pen.colour;
        paint.set_color_rgba8(red, green, blue, pen.cover);
        let whole = Transform::identity();
        self.image
            .fill_path(&outlines, &paint, FillRule::Winding, whole, None);
    }
}

fn colour(table: &[RGBColor], share: f64) -> RGBColor {
    if share.is_nan() {
        UNKNOWN
    } else {
        table[((share * table.len() as f64) as usize).min(table.len() - 1)]
    }
}

/// The pixels of a line of `count` whose centres lie between two places; neighbours share those on their common edge.
fn centres([from, to]: [f64; 2], count: u32) -> std::ops::Range<u32> {
    const ROUNDING: f64 = 1e-6;
    let first = (from - 0.5 - ROUNDING).ceil().max(0.0) as u32;
    let end = (to - 0.5 + ROUNDING).floor() + 1.0;
    first..(end.max(0.0) as u32).min(count)
}

/// Where a horizontal line enters and leaves a triangle.
fn span(corners: [[f64; 2]; 3], y: f64) -> Option<[f64; 2]> {
    let mut found: Option<[f64; 2]> = None;
    for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|corner| corners[corner])) {
        let [low, high] = [from[1].min(to[1]), from[1].max(to[1])];
        if y < low || y > high {
            continue;
        }
        let along = if high > low {
            (y - from[1]) / (to[1] - from[1])
        } else {
            0.0
        };
        let x = from[0] + along * (to[0] - from[0]);
        let [left, right] = found.unwrap_or([x, x]);
        found = Some([left.min(x), right.max(x)]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: [RGBColor; 2] = [RGBColor(10, 20, 30), RGBColor(200, 100, 0)];

    /// A picture of 20 points on each side.
    fn painted(pixels_per_point: f32, paint: impl FnOnce(&mut Painter)) -> Pixmap {
        let size = (20.0 * pixels_per_point) as u32;
        let mut image = Pixmap::new(size, size).unwrap();
        paint(&mut Painter {
            image: &mut image,
            pixels_per_point,
            above: None,
        });
        image
    }

    #[test]
    fn two_triangles_fill_a_square_without_a_gap_and_shade_it_in_halves() {
        let [a, b, c, d] = [[1.3, 1.3], [18.4, 1.3], [18.4, 18.4], [1.3, 18.4]];
        let image = painted(2.0, |painter| {
            painter.shade([a, b, c], [0.0, 5.0, 5.0], &|value| value / 5.0, &TABLE);
            painter.shade([a, c, d], [0.0, 5.0, 0.0], &|value| value / 5.0, &TABLE);
        });
        let at = |x: u32, y: u32| image.pixel(x, y).unwrap();
        let inside = (3..=36).flat_map(|x| (3..=36).map(move |y| (x, y)));
        for (x, y) in inside {
            let expected = if x < 20 { 10 } else { 200 };
            assert_eq!(at(x, y).red(), expected, "{x} {y}");
        }
        assert_eq!(
            (at(1, 20).alpha(), at(38, 20).alpha(), at(20, 1).alpha()),
            (0, 0, 0)
        );
    }

    #[test]
    fn what_is_no_number_is_grey_and_what_has_no_area_or_place_is_left_out() {
        let corners = [[0.0, 0.0], [20.0, 0.0], [0.0, 20.0]];
        let image = painted(1.0, |painter| {
            let mut shade = |corners, first: f64| {
                painter.shade(corners, [first, 0.0, 0.0], &|value| value, &TABLE);
            };
            shade(corners, f64::NAN);
            shade([[9.0, 9.0]; 3], 0.0);
            shade([[f64::NAN; 2]; 3], 0.0);
            shade([[-90.0, -9.0], [-5.0, 3.0], [90.0, -2.0]], 0.0);
        });
        let pixel = image.pixel(5, 5).unwrap();
        assert_eq!((pixel.red(), pixel.green()), (UNKNOWN.0, UNKNOWN.1));
    }
}
