//! The style of all pictures.

use serde::{Deserialize, Serialize};

/// Formats, width and colours of pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureStyle {
    /// The formats that are written.
    pub formats: Vec<PictureFormat>,
    /// Their width.
    pub width: PictureWidth,
    /// Their colours.
    pub palette: Palette,
    /// The size of the letters of numbers in a printer's points; lines and gaps grow with it.
    pub font_size: f64,
}

impl PictureStyle {
    /// The usual size of letters.
    pub const FONT_SIZE: f64 = 7.2;
}

impl Default for PictureStyle {
    fn default() -> Self {
        Self {
            formats: vec![PictureFormat::Png],
            width: PictureWidth::Screen,
            palette: Palette::Default,
            font_size: Self::FONT_SIZE,
        }
    }
}

/// The format of a picture. Animations are always PNG.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum PictureFormat {
    /// A bitmap.
    Png,
    /// Lines as curves and words as text with their font, shaded fields as pixels among them.
    Svg,
    /// The same as a document.
    Pdf,
}

impl PictureFormat {
    /// All formats by their names, which are also the extensions of files.
    pub const NAMES: [(&'static str, Self); 3] =
        [("png", Self::Png), ("svg", Self::Svg), ("pdf", Self::Pdf)];
}

/// The width of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureWidth {
    /// For a screen: about 200 mm.
    Screen,
    /// One column of a journal: 85 mm.
    OneColumn,
    /// Two columns: 180 mm.
    TwoColumns,
}

impl PictureWidth {
    /// All widths by their names.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("screen", Self::Screen),
        ("one-column", Self::OneColumn),
        ("two-columns", Self::TwoColumns),
    ];
}

/// The colours of pictures, which can be distinguished with every colour vision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// On white.
    Default,
    /// On black, for slides.
    Dark,
    /// Colours that differ in lightness alone, as for a printer with one ink.
    Print,
}

impl Palette {
    /// All palettes by their names.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("default", Self::Default),
        ("dark", Self::Dark),
        ("print", Self::Print),
    ];
}
