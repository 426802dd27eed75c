//! Pictures. The only folder that knows plotters, tiny-skia and pdf-writer.
//!
//! A figure is laid out as marks: lines, areas, discs and words of an embedded font, which look the same on every machine. Marks
//! are then pixels, SVG or PDF.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::Diagnostic;
use crate::results::{Drawing, PictureFormat, PictureStyle};
use look::Look;
pub use look::VIRIDIS;

mod animation;
mod backend;
mod bar;
mod canvas;
mod charts;
mod colours;
mod encode;
mod fields;
mod layout;
mod legend;
mod letters;
mod look;
mod marks;
mod numbers;
mod outlines;
mod paint;
mod pdf;
mod thin;
mod vectors;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct PictureFault(String);

/// A picture of a report, or the warning that replaces it.
pub type Drawn = Result<Vec<u8>, Diagnostic>;

/// A drawing as a PNG for a screen.
///
/// # Errors
/// [`PictureFault`] where it cannot be drawn.
pub fn png(drawing: &Drawing) -> Result<Vec<u8>, PictureFault> {
    picture(drawing, PictureFormat::Png, &PictureStyle::default())
}

/// A drawing as a file of a format; what moves is a PNG in any case.
///
/// # Errors
/// [`PictureFault`] where it cannot be drawn, whatever the reason: a study must not fail, and lose its numbers, for a picture.
pub fn picture(
    drawing: &Drawing,
    format: PictureFormat,
    style: &PictureStyle,
) -> Result<Vec<u8>, PictureFault> {
    let look = Look::of(style);
    let drawn = catch_unwind(AssertUnwindSafe(|| match drawing {
        Drawing::Charts(charts) => charts::stacked(charts, look, format),
        Drawing::Field(figure) => figure.drawn(look, format),
        Drawing::Animation(animation) => animation.png(look.on_screen()),
        Drawing::Mesh(figure) => figure.drawn(look, format),
    }));
    match drawn {
        Ok(drawn) => drawn.map_err(|fault| PictureFault(fault.to_string())),
        Err(_) => Err(PictureFault("the drawing libraries gave up on it".into())),
    }
}

/// Red, green and blue of a colour bar from its lower to its upper end, of values of one sign or of both.
pub fn bar_colours(is_signed: bool) -> Vec<[u8; 3]> {
    Look::of(&PictureStyle::default()).bar(is_signed)
}

#[cfg(test)]
mod tests;
