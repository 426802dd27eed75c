//! Pictures whose lines and letters stay lines: SVG, and what a PDF is made of.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::style::RGBColor;
use resvg::tiny_skia::Pixmap;

use super::design::{DrawResult, FINE};
use super::encode::encode;
use super::look::MILLIMETRES;
use super::paint::Lines;

/// The parts of a picture, from below.
pub(super) struct Vectors {
    /// Its size in points of the design.
    pub size: (u32, u32),
    pub paper: RGBColor,
    /// What is shaded; `None` where nothing is.
    pub image: Option<Pixmap>,
    /// Lines at places in points.
    pub lines: Vec<Lines>,
    /// What is drawn, as SVG in units of the drawing.
    pub drawn: String,
}

impl Vectors {
    /// The picture as SVG. Letters are curves, so that it looks the same everywhere.
    pub fn svg(&self) -> DrawResult<Vec<u8>> {
        let (width, height) = self.size;
        let [wide, high] = [width, height].map(|points| f64::from(points) * MILLIMETRES);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{wide:.2}mm\" \
             height=\"{high:.2}mm\" viewBox=\"0 0 {width} {height}\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
            hexadecimal(self.paper)
        );
        if let Some(image) = &self.image {
            let png = STANDARD.encode(encode(image, None)?);
            writeln!(
                svg,
                "<image width=\"{width}\" height=\"{height}\" xlink:href=\"data:image/png;base64,{png}\"/>"
            )?;
        }
        for lines in &self.lines {
            svg += &path(lines)?;
        }
        // The drawing stands in units of its own.
        let scale = 1.0 / f64::from(FINE);
        let inner = self.drawn.split_once('>').map_or("", |(_, inner)| inner);
        let inner = inner.trim_end().trim_end_matches("</svg>");
        writeln!(svg, "<g transform=\"scale({scale})\">{inner}</g>\n</svg>")?;
        Ok(svg.into_bytes())
    }
}

fn hexadecimal(RGBColor(red, green, blue): RGBColor) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn path(lines: &Lines) -> DrawResult<String> {
    let mut places = String::new();
    for line in &lines.lines {
        for (index, [x, y]) in line.iter().enumerate() {
            let step = if index == 0 { 'M' } else { 'L' };
            write!(places, "{step}{x:.2} {y:.2}")?;
        }
    }
    let pen = lines.pen;
    let cover = f64::from(pen.cover) / 255.0;
    Ok(format!(
        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{cover:.3}\" stroke-linecap=\"round\" \
         stroke-linejoin=\"round\" d=\"{places}\"/>\n",
        hexadecimal(pen.colour),
        pen.width
    ))
}
