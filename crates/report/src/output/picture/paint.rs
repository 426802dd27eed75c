//! Pictures as pixels: shaded triangles, and the marks above them.

use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, Pixmap, Stroke, StrokeDash, Transform};

use super::marks::{Colour, DrawResult, Mark, Pen, Size};
use crate::statistics::extremes;

/// Paints into a picture at places in points.
pub(super) struct Painter {
    pub image: Pixmap,
    pixels_per_point: f32,
    /// Lines above what is shaded, where they are to stay lines; else they become pixels too.
    pub above: Option<Vec<Mark>>,
}

/// The shade of a triangle whose values are not numbers.
const UNKNOWN: Colour = [200; 3];

impl Painter {
    /// An empty picture of a size in points.
    ///
    /// # Errors
    /// Where it has no size, or one that no memory holds.
    pub fn new(size: Size, paper: Colour, pixels_per_point: f32) -> DrawResult<Self> {
        let pixels = |points: u32| (points as f32 * pixels_per_point) as u32;
        let image = Pixmap::new(pixels(size.0), pixels(size.1));
        let mut image =
            image.ok_or_else(|| format!("it would have {} × {} points", size.0, size.1))?;
        let [red, green, blue] = paper;
        image.fill(tiny_skia::Color::from_rgba8(red, green, blue, 255));
        Ok(Self {
            image,
            pixels_per_point,
            above: None,
        })
    }

    /// Shades a triangle by the values between those at its corners; `share` says where in the table a value's colour is.
    pub fn shade(
        &mut self,
        corners: [[f64; 2]; 3],
        values: [f64; 3],
        share: &dyn Fn(f64) -> f64,
        table: &[Colour],
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
                let position = 4 * (first + column as usize);
                let colour = colour(table, at(column));
                pixels[position..position + 4]
                    .copy_from_slice(&[colour[0], colour[1], colour[2], 255]);
            }
        }
    }

    /// Draws lines above what is shaded.
    pub fn lines_above<'a>(&mut self, lines: impl IntoIterator<Item = &'a [[f64; 2]]>, pen: Pen) {
        let Some(mark) = Mark::lines(lines, pen) else {
            return;
        };
        match &mut self.above {
            Some(above) => above.push(mark),
            None => self.draw(&mark),
        }
    }

    /// Draws a mark.
    pub fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Lines(path, pen) => {
                let dashed = pen.dashes.and_then(|[dash, gap]| {
                    let dashes = StrokeDash::new(vec![dash, gap], 0.0)?;
                    path.dash(&dashes, self.pixels_per_point)
                });
                let path = dashed.as_ref().unwrap_or(path);
                // As one area: they do not darken each other where they cross.
                if let Some(outlines) = path.stroke(&stroke(*pen), self.pixels_per_point) {
                    self.fill(&outlines, pen.colour, pen.opacity);
                }
            }
            Mark::Area(path, colour) => self.fill(path, *colour, 255),
            Mark::Words(words) => {
                if let Some(curves) = words.curves() {
                    self.fill(&curves, words.colour, 255);
                }
            }
        }
    }

    fn fill(&mut self, path: &Path, [red, green, blue]: Colour, opacity: u8) {
        let mut paint = Paint::default();
        paint.set_color_rgba8(red, green, blue, opacity);
        let scale = Transform::from_scale(self.pixels_per_point, self.pixels_per_point);
        self.image
            .fill_path(path, &paint, FillRule::Winding, scale, None);
    }
}

/// Round ends, but not of dashes, which would close their gaps.
fn stroke(pen: Pen) -> Stroke {
    Stroke {
        width: pen.width,
        line_cap: if pen.dashes.is_some() {
            LineCap::Butt
        } else {
            LineCap::Round
        },
        line_join: LineJoin::Round,
        ..Stroke::default()
    }
}

fn colour(table: &[Colour], share: f64) -> Colour {
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
    let mut extent: Option<[f64; 2]> = None;
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
        let [left, right] = extent.unwrap_or([x, x]);
        extent = Some([left.min(x), right.max(x)]);
    }
    extent
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: [Colour; 2] = [[10, 20, 30], [200, 100, 0]];

    /// A picture of 20 points on each side.
    fn painted(pixels_per_point: f32, paint: impl FnOnce(&mut Painter)) -> Pixmap {
        let mut painter = Painter::new((20, 20), [0; 3], pixels_per_point).unwrap();
        painter.image.fill(tiny_skia::Color::TRANSPARENT);
        paint(&mut painter);
        painter.image
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
        assert_eq!((pixel.red(), pixel.green()), (UNKNOWN[0], UNKNOWN[1]));
    }
}
