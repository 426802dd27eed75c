//! Pictures. The only folder that knows plotters and resvg.
//!
//! Figures are drawn as SVG and rendered with an embedded font, so that they look the same on every
//! machine, whatever fonts it has.

use crate::results::Drawing;

mod animation;
mod canvas;
mod fields;
mod lines;

/// A drawing as a PNG.
pub fn png(drawing: &Drawing) -> Vec<u8> {
    match drawing {
        Drawing::Charts(charts) => lines::stacked(charts),
        Drawing::Field(figure) => figure.png(),
        Drawing::Animation(animation) => animation.png(),
        Drawing::Outlines(title, cells) => fields::outlines(title, cells),
    }
}
