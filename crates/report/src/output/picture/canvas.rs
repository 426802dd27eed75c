//! What all pictures are drawn with: an area, fonts, numbers on axes.

use plotters::coord::Shift;
use plotters::prelude::*;
use resvg::{tiny_skia, usvg};

use super::design::{DrawResult, FINE};
use super::encode::encode;
use super::letters;
use super::look::Look;
use super::paint::Painter;
use super::vectors::Vectors;
use crate::results::{PictureFormat, Scale};
use crate::statistics::extremes;

/// What draws above a painted area.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Paints on an area of `size` points what is too much to be drawn, draws above it, and returns a file of the format.
pub(super) fn render(
    size: (u32, u32),
    look: Look,
    format: PictureFormat,
    paint: impl FnOnce(&mut Painter<'_>),
    draw: impl FnOnce(&Area<'_>) -> DrawResult<()>,
) -> DrawResult<Vec<u8>> {
    if format == PictureFormat::Png {
        let image = rasterise(size, look, look.pixels(), paint, draw)?;
        return Ok(encode(&image, Some(look))?);
    }
    let mut image = blank(size, look, look.pixels())?;
    let before = image.clone();
    let mut painter = Painter {
        image: &mut image,
        pixels_per_point: look.pixels(),
        above: Some(Vec::new()),
    };
    paint(&mut painter);
    let lines = painter.above.unwrap_or_default();
    let vectors = Vectors {
        size,
        paper: look.paper(),
        image: (image != before).then_some(image),
        lines,
        drawn: drawn(size, draw)?,
    };
    match format {
        PictureFormat::Svg => vectors.svg(),
        PictureFormat::Pdf | PictureFormat::Png => vectors.pdf(),
    }
}

fn blank(size: (u32, u32), look: Look, pixels_per_point: f32) -> DrawResult<tiny_skia::Pixmap> {
    let pixels = |points: u32| (points as f32 * pixels_per_point) as u32;
    let image = tiny_skia::Pixmap::new(pixels(size.0), pixels(size.1));
    let mut image = image.ok_or_else(|| format!("it would have {} × {} points", size.0, size.1))?;
    let RGBColor(red, green, blue) = look.paper();
    image.fill(tiny_skia::Color::from_rgba8(red, green, blue, 255));
    Ok(image)
}

/// What is drawn as SVG, its letters as curves.
fn drawn(size: (u32, u32), draw: impl FnOnce(&Area<'_>) -> DrawResult<()>) -> DrawResult<String> {
    letters::register();
    let mut svg = String::new();
    {
        let area =
            SVGBackend::with_string(&mut svg, (FINE * size.0, FINE * size.1)).into_drawing_area();
        draw(&area)?;
        area.present()?;
    }
    svg.retain(in_xml);
    letters::as_curves(&svg)
}

/// Paints on an area of `size` points with so many pixels a point, then draws above it.
pub(super) fn rasterise(
    size: (u32, u32),
    look: Look,
    pixels_per_point: f32,
    paint: impl FnOnce(&mut Painter<'_>),
    draw: impl FnOnce(&Area<'_>) -> DrawResult<()>,
) -> DrawResult<tiny_skia::Pixmap> {
    let tree = usvg::Tree::from_str(&drawn(size, draw)?, &usvg::Options::default())?;
    let mut image = blank(size, look, pixels_per_point)?;
    paint(&mut Painter {
        image: &mut image,
        pixels_per_point,
        above: None,
    });
    let scale = pixels_per_point / FINE as f32;
    let transform = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut image.as_mut());
    Ok(image)
}

/// Whether XML can hold a character.
fn in_xml(character: char) -> bool {
    matches!(character, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..)
}

/// A line of some width in points.
pub(super) fn stroke(colour: RGBColor, width: u32) -> ShapeStyle {
    colour.stroke_width(FINE * width)
}

/// A number as an axis shows it: no trailing zeros, a true minus sign.
pub(super) fn tick(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        return "0".to_owned();
    }
    text.replace('-', "−")
}

/// A power of ten by its exponent: 10⁻³.
pub(super) fn power_of_ten(exponent: f64) -> String {
    let digits = format!("{exponent:.0}");
    let superscript = digits.chars().map(|digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        other => char::from_u32('⁰' as u32 + other as u32 - '0' as u32).unwrap_or(other),
    });
    format!("10{}", superscript.collect::<String>())
}

impl Scale {
    /// The position of a value; values that a logarithm does not take have none.
    pub(super) fn position(self, value: f64) -> Option<f64> {
        let position = match self {
            Self::Linear | Self::Interval => value,
            Self::Logarithmic => value.log10(),
        };
        position.is_finite().then_some(position)
    }

    /// The value at a position.
    pub(super) fn value(self, position: f64) -> f64 {
        match self {
            Self::Linear | Self::Interval => position,
            Self::Logarithmic => 10f64.powf(position),
        }
    }

    pub(super) fn label(self, position: f64) -> String {
        match self {
            Self::Linear | Self::Interval => tick(position),
            Self::Logarithmic if (position - position.round()).abs() < 1e-6 => {
                power_of_ten(position.round())
            }
            Self::Logarithmic => String::new(),
        }
    }

    /// Limits that hold all positions: whole decades, or a little more than the values take.
    pub(super) fn limits(self, positions: impl Iterator<Item = f64>) -> (f64, f64) {
        let [low, high] = extremes(positions);
        if low > high {
            return (0.0, 1.0);
        }
        match self {
            Self::Logarithmic => (low.floor(), high.ceil().max(low.floor() + 1.0)),
            Self::Linear | Self::Interval => {
                let margin = if high > low {
                    0.05 * (high - low)
                } else {
                    0.5 * high.abs().max(1.0)
                };
                // Zero is shown where it is near.
                let from_zero = self == Self::Linear && low >= 0.0 && low < 0.4 * high;
                (if from_zero { 0.0 } else { low - margin }, high + margin)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_labelled_as_people_write_them() {
        assert_eq!(tick(0.1 + 0.2), "0.3");
        assert_eq!(tick(-40.0), "−40");
        assert_eq!(tick(-1e-9), "0");
        assert_eq!(power_of_ten(-10.0), "10⁻¹⁰");
        assert_eq!(Scale::Logarithmic.label(0.5), "");
        assert_eq!(
            Scale::Logarithmic.limits([-2.3, 0.4].into_iter()),
            (-3.0, 1.0)
        );
    }
}
